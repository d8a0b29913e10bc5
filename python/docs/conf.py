"""Settings of Sphinx for the pages of the Python package; `.ci/python-docs` builds them."""

from __future__ import annotations

import warnings

import hydrostat

# The gallery says what it shows; a page is no place for warnings on standard error.
warnings.filterwarnings("ignore", category=hydrostat.ModelWarning)

project = "Hydrostat for Python"
author = "The Hydrostat project"
release = version = hydrostat.__version__
extensions = ["sphinx.ext.autodoc", "sphinx.ext.autosummary", "sphinx.ext.napoleon", "matplotlib.sphinxext.plot_directive"]
html_theme = "alabaster"
html_theme_options = {"description": "The static shape of soft arms under water", "page_width": "1080px"}
html_copy_source = False

default_role = "code"
# Docstrings have types in their own sections; signatures stay readable.
autodoc_typehints = "none"
autodoc_member_order = "bysource"
autodoc_class_signature = "separated"
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True
# Extras that need not be here to be described.
autodoc_mock_imports = ["gymnasium", "jax", "torch", "ipywidgets"]

# The words of shapes, such as `cables`, are no references.
suppress_warnings = ["ref.python"]

plot_include_source = True
plot_html_show_source_link = False
plot_html_show_formats = False
plot_formats = [("svg", 100)]
plot_rcparams = {"figure.figsize": (6.4, 4.0), "svg.hashsalt": "hydrostat", "svg.fonttype": "path"}
plot_apply_rcparams = True
