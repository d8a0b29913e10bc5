"""The HTTP interface: fuzzed against its own description, and the page's sources checked."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import Viewer

HERE = Path(__file__).parent
NODE_MODULES = HERE / "node_modules"


def test_nothing_that_its_description_allows_breaks_it(viewer: Viewer, tmp_path: Path) -> None:
    """Requests by the description and against it: each gets a status and a body that the description has."""
    checks = "not_a_server_error,status_code_conformance,content_type_conformance,response_schema_conformance,unsupported_method"
    command = [
        Path(sys.executable).with_name("schemathesis"), "run", f"{viewer.url}api/openapi.json", "--checks", checks,
        "--phases", "examples,fuzzing", "--max-examples", "20", "--max-time", "15", "--seed", os.environ.get("HYDROSTAT_SEED", "0"), "--no-shrink",
        "--request-timeout", "30", "--suppress-health-check", "all", "--max-failures", "5",
    ]
    run = subprocess.run(command, capture_output=True, text=True, timeout=170, cwd=tmp_path)
    assert run.returncode == 0, run.stdout[-6000:] + run.stderr[-2000:]
    assert viewer.post("solve", {"arm": "paper", "stations": 2})["converged"] is True, "it is still there"


def node_modules() -> Path:
    """The compiler, installed once."""
    npm = shutil.which("npm")
    if npm is None:
        pytest.skip("there is no npm: the types of the page are not checked")
    if not (NODE_MODULES / "typescript").is_dir():
        command = [npm, "install", "--no-audit", "--no-fund", "--no-package-lock", "--ignore-scripts"]
        run = subprocess.run(command, cwd=HERE, capture_output=True, text=True, timeout=170)
        if run.returncode != 0:
            pytest.skip(f"npm could not install the compiler: {run.stderr[-300:]}")
    return NODE_MODULES


def test_the_types_of_the_page_hold() -> None:
    compiler = node_modules() / "typescript" / "bin" / "tsc"
    node = shutil.which("node")
    assert node is not None
    run = subprocess.run([node, compiler, "--project", HERE], capture_output=True, text=True, timeout=120)
    assert run.returncode == 0, run.stdout
