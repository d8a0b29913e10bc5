"""Sweeps into files."""

from __future__ import annotations

from pathlib import Path

import pytest

import hydrostat as hs
from hydrostat._progress import Progress


def test_missing_directories_were_made(tmp_path: Path, silicone: hs.Arm) -> None:
    missing = tmp_path / "no"
    for name in ("out.csv", "out.parquet"):
        with pytest.raises(OSError, match="make the directory"):
            hs.sweep(silicone, {"flow.speed": [0.0, 0.1]}, output=missing / name)
    assert not missing.exists()


def test_cut_parts_were_joined(tmp_path: Path, silicone: hs.Arm, monkeypatch: pytest.MonkeyPatch) -> None:
    vary = {"arm.density": "1000:1100:16", "cable[0].tension": "0:0.5:120"}
    columns = ("tip", "stability")
    whole = hs.sweep(silicone, vary, columns=columns, output=tmp_path / "whole.csv")
    out = tmp_path / "out.csv"
    parts = tmp_path / "out.csv.parts"

    class EndedError(Exception):
        pass

    def end(_: Progress, __: int) -> None:
        if any(parts.glob("*-*.csv")):
            raise EndedError

    with monkeypatch.context() as patched, pytest.raises(EndedError):
        patched.setattr(Progress, "__call__", end)
        hs.sweep(silicone, vary, columns=columns, output=out, threads=1)
    part = min(parts.glob("*-*.csv"))
    text = part.read_text(encoding="utf-8")
    part.write_text(text[: len(text) // 2], encoding="utf-8")
    with pytest.warns(UserWarning, match="a part of an earlier run had changed since; solved again"):
        hs.sweep(silicone, vary, columns=columns, output=out, resume=True)
    assert out.read_bytes() == whole.read_bytes()
