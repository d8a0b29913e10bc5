"""The examples run as notebooks, and draw."""

from __future__ import annotations

import jupytext
import nbclient
import pytest
from conftest import ROOT

#: How many pictures each shows.
PICTURES = {"design": 4, "first_steps": 9, "workspace_and_flow": 4, "readings": 6}


def test_every_example_is_run() -> None:
    assert {path.stem for path in (ROOT / "examples").glob("*.py")} == set(PICTURES)


@pytest.mark.parametrize("name", sorted(PICTURES))
def test_example(name: str) -> None:
    notebook = jupytext.read(ROOT / "examples" / f"{name}.py")
    nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3").execute()
    outputs = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
    assert not [output for output in outputs if output.output_type == "error"]
    kinds = [set(output.get("data", {})) for output in outputs]
    assert sum(bool(kind & {"image/png", "image/svg+xml"}) for kind in kinds) == PICTURES[name]
