"""Sweeps into files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

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


def test_heads_are_identifiers_and_rows_have_their_warnings(tmp_path: Path) -> None:
    paper = hs.Arm.load("paper")
    vary = {"flow.speed": [0.0, 0.5], "cable[0].tension": [0.0, 40.0]}
    found = hs.sweep(paper, vary, shapes=3)
    assert {"stroke", "shape_x", "warnings", "verdict"} <= set(found.data_vars)
    assert found.stroke.dims[-1] == "cable" and found.shape_x.sizes["station"] == 3
    assert found.stroke.attrs["column"] == "stroke_0_m" and found.tip_y.attrs["units"] == "m"
    for speed, rows in zip(vary["flow.speed"], found.warnings.values.tolist(), strict=True):
        for tension, kinds in zip(vary["cable[0].tension"], rows, strict=True):
            own = paper.replace({"flow.speed": speed, "cable[0].tension": tension}).solve(tol=1e-6)
            assert kinds.split() == [warning.kind for warning in own.warnings]
    output = hs.sweep(paper, vary, output=tmp_path / "out.csv")
    heads = output.read_text(encoding="utf-8").splitlines()[0].split(",")
    assert heads[:3] == ["row", "flow_speed_m_s", "cable_0_tension_N"]
    assert all(head.isidentifier() for head in heads)


def test_points_joined_by_straight_lines() -> None:
    radius = {"points": [[0.0, 0.01], [0.1, 0.01], [0.2, 0.002]], "join": "linear"}
    arm = hs.Arm(arm={"length": 0.2, "radius": radius}, material={"young": 1e5}, tip={"force": [0.0, 1e-3]})
    assert arm.to_dict()["arm"]["radius"] == radius
    cubic = hs.Arm(arm={"length": 0.2, "radius": radius["points"]}, material={"young": 1e5}, tip={"force": [0.0, 1e-3]})
    assert abs(arm.solve().tip.y - cubic.solve().tip.y) > 1e-5


@pytest.mark.parametrize(
    ("vary", "options"),
    [
        ({"flow.speed": [0.0, 0.1]}, {}),
        ({"flow.speed": [0.0, 0.1], "cable[0].tension": "0:1.5:3"}, {"shapes": 3}),
        ({"flow.speed": "0:0.1", "model.volume": "planar,none"}, {"sample": "lhs:4"}),
    ],
)
def test_a_sweep_could_not_be_written_as_netcdf(tmp_path: Path, silicone: hs.Arm, vary: Any, options: Any) -> None:
    xr = pytest.importorskip("xarray")
    pytest.importorskip("scipy")
    found = hs.sweep(silicone, vary, **options)
    found.to_netcdf(tmp_path / "sweep.nc", engine="scipy")
    with xr.open_dataset(tmp_path / "sweep.nc", engine="scipy") as again:
        for name in found.variables:
            assert found[name].values.tolist() == again[name].values.tolist() or found[name].dtype.kind == "f", name
            if found[name].dtype.kind == "f":
                assert found[name].values.tobytes() == again[name].values.astype(found[name].dtype).tobytes(), name
        assert again.attrs["vary"].split() == list(vary) and hs.Arm.from_toml(again.attrs["arm"]) == silicone
        if len(vary) == 2 and not options.get("sample"):
            assert hs.map_figure(again, "tip_y").svg() == hs.map_figure(found, "tip_y").svg()
