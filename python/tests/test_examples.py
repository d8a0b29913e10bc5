"""The examples run as notebooks, and draw."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import jupytext
import nbclient
import pytest
from conftest import ROOT, needs_checkout

pytestmark = needs_checkout

#: How many pictures each shows.
PICTURES = {"design": 4, "first_steps": 9, "motion": 4, "network": 2, "policy": 1, "workspace_and_flow": 4, "readings": 6}
#: What some need that `./test` does not install; without it they are skipped.
NEEDS = {"network": "jax", "policy": "gymnasium"}


def test_every_example_is_run() -> None:
    assert {path.stem for path in (ROOT / "examples").glob("*.py")} == set(PICTURES)


@pytest.mark.parametrize("name", sorted(PICTURES))
def test_example(name: str) -> None:
    pytest.importorskip(NEEDS.get(name, "hydrostat"))
    notebook = jupytext.read(ROOT / "examples" / f"{name}.py")
    nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3").execute()
    outputs = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
    assert not [output for output in outputs if output.output_type == "error"]
    kinds = [set(output.get("data", {})) for output in outputs]
    assert sum(bool(kind & {"image/png", "image/svg+xml"}) for kind in kinds) == PICTURES[name]


@pytest.mark.parametrize("name", sorted(PICTURES))
def test_an_example_says_which_warnings_it_lets_be(tmp_path: Path, name: str) -> None:
    pytest.importorskip(NEEDS.get(name, "hydrostat"))
    command = [sys.executable, "-W", "error", str(ROOT / "examples" / f"{name}.py")]
    own = {**os.environ, "MPLBACKEND": "Agg"}
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300, cwd=tmp_path, env=own)
    assert done.returncode == 0, done.stderr
