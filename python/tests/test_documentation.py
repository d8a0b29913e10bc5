"""The Python in the documents runs, but for what needs a cluster of its own, which compiles; the README prints what it shows."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
import textwrap
import tomllib
from pathlib import Path

import pytest
from conftest import ROOT, Program, needs_checkout

pytestmark = needs_checkout

BLOCK = re.compile(r"```python\n(.*?)```", re.DOTALL)
ELSEWHERE = ("SLURMCluster", "KubeCluster")


GUIDE = [str(page.relative_to(ROOT)) for page in sorted((ROOT / "guide/src").glob("*.md")) if "```python" in page.read_text(encoding="utf-8")]


@pytest.mark.parametrize("name", ["docs/python.md", "README.md", "python/README.md", *GUIDE])
def test_blocks(tmp_path: Path, name: str) -> None:
    blocks = BLOCK.findall((ROOT / name).read_text(encoding="utf-8"))
    assert blocks
    for block in blocks:
        compile(block, name, "exec")
    # As a script, because workers are started by it, and what is not guarded they would do, too.
    here = "\n".join(block for block in blocks if not any(word in block for word in ELSEWHERE))
    script = tmp_path / "blocks.py"
    script.write_text("if __name__ == '__main__':\n" + textwrap.indent(here, "    "), encoding="utf-8")
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=False, timeout=120, cwd=tmp_path)
    assert done.returncode == 0, done.stderr


def steady(text: str) -> list[str]:
    """The lines that are the same on every processor: not what a solve took, nor its error."""
    return [line.rstrip() for line in text.splitlines() if not line.startswith(("work ", "tip error "))]


def test_readme_shows_what_the_program_prints(tmp_path: Path, program: Program) -> None:
    page = (ROOT / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```console\n\$ hydrostat (.*)\n([^`]*)```", page)
    assert blocks
    for command, shown in blocks:
        words = [str(tmp_path / word) if word.endswith(".png") else word for word in shlex.split(command)]
        status, printed = program(*words)
        assert status == 0, command
        assert steady(printed) == steady(shown), command


def test_readme_shows_what_python_prints() -> None:
    page = (ROOT / "README.md").read_text(encoding="utf-8")
    pairs = re.findall(r"```python\n([^`]*)```\n\n```text\n([^`]*)```", page)
    assert pairs
    for code, shown in pairs:
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, timeout=120)
        assert done.stdout == shown, done.stderr


def test_the_package_says_where_it_is(tmp_path: Path) -> None:
    (tmp_path / "pyproject.toml").write_bytes((ROOT / "pyproject.toml").read_bytes())
    command = [str(ROOT / ".ci" / "project-urls"), "https://example.org/a/b", "v1.2.3"]
    assert subprocess.run(command, cwd=tmp_path, check=False).returncode == 0
    project = tomllib.loads((tmp_path / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project["urls"]["Source"] == "https://example.org/a/b" and project["name"] == "hydrostat"
    for place in ("Documentation", "Changelog"):
        path = project["urls"][place].removeprefix("https://example.org/a/b/blob/v1.2.3/")
        assert (ROOT / path).is_file()
    assert subprocess.run(command, cwd=tmp_path, check=False, capture_output=True).returncode == 1
