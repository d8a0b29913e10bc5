"""The Python in the documents runs, but for what needs a cluster of its own, which compiles."""

from __future__ import annotations

import re
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest
from conftest import ROOT, needs_checkout

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
