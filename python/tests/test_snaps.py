"""Snaps on the way to the loads: small ones are in answers, larger ones verdicts with the shapes beyond."""

from __future__ import annotations

import dataclasses
import json
import pickle
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Program

import hydrostat as hs

#: silicone across a stream that runs against its weight: upright, it leans over in one small snap as a cable is pulled.
LEAN: dict[str, Any] = {
    "arm": {"length": 0.245, "radius": {"base": 0.010, "tip": 0.002}, "density": 1080},
    "material": {"young": 110e3},
    "cable": [
        {"offset": {"base": 0.005, "tip": 0.001}, "tension": 3e-4},
        {"offset": {"base": -0.005, "tip": -0.001}, "tension": 0},
    ],
    "flow": {"speed": 0.7, "direction": 90, "density": 1022},
    "gravity": {"acceleration": 9.80665, "direction": -90},
    "model": {"displaced": "section"},
}


@pytest.fixture(scope="module")
def lean() -> hs.Arm:
    return hs.Arm.from_dict(LEAN)


@pytest.fixture(scope="module")
def leaning(lean: hs.Arm) -> hs.Solution:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", hs.ModelWarning)
        return lean.solve()


@pytest.fixture(scope="module")
def against(silicone: hs.Arm) -> hs.Arm:
    return silicone.replace(flow_speed=0.2, flow_direction=170)


def as_document(snaps: tuple[hs.Snap, ...]) -> list[dict[str, Any]]:
    """As the program's documents have them."""
    of_motion = ("duration", "lands_elsewhere")
    return [
        {
            **{name: value for name, value in dataclasses.asdict(snap).items() if name not in of_motion or value is not None},
            "before": snap.before._asdict(),
            "after": snap.after._asdict(),
        }
        for snap in snaps
    ]


def test_an_answer_with_a_snap(program: Program, lean: hs.Arm, leaning: hs.Solution, tmp_path: Path) -> None:
    file = tmp_path / "lean.toml"
    file.write_text(lean.to_toml(), encoding="utf-8")
    status, text = program("solve", str(file), "--format", "json")
    document = json.loads(text)
    assert status == 0
    assert as_document(leaning.snaps) == document["snaps"]
    assert leaning.x.tolist() == document["stations"]["x"]
    (snap,) = leaning.snaps
    assert snap.phase == "tension" and 0.08 < snap.load_fraction < 0.09
    assert snap.distance == pytest.approx(np.hypot(snap.after.x - snap.before.x, snap.after.y - snap.before.y))
    assert snap.distance < 0.01 * lean.length and np.degrees(snap.angle) < 2.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        snap.angle = 0.0  # type: ignore[misc]
    assert leaning.warnings[0].kind == "snap" and "warnings: snap" in repr(leaning)


def test_snaps_are_no_warnings_of_python(lean: hs.Arm) -> None:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        lean.solve()
    kinds = [warning.message.kind for warning in caught if isinstance(warning.message, hs.ModelWarning)]
    assert "snap" not in kinds


def test_a_snap_travels(lean: hs.Arm, leaning: hs.Solution, tmp_path: Path) -> None:
    again = pickle.loads(pickle.dumps(leaning))
    assert again.snaps == leaning.snaps and again == leaning and again.at(0.1) == leaning.at(0.1)
    kept = hs.load(leaning.save(tmp_path / "lean.nc"))
    assert kept.snaps == leaning.snaps and kept == leaning and kept.at(0.1) == leaning.at(0.1)
    dataset = leaning.to_xarray()
    (snap,) = leaning.snaps
    assert dataset.snap_phase.values.tolist() == ["tension"] and dataset.snap_distance.item() == snap.distance
    assert dataset.snap_angle.attrs["units"] == "rad" and dataset.snap_x.dims == ("snap", "side")
    assert dataset.snap_theta.sel(side="after").item() == snap.after.theta
    assert "snap" not in hs.Arm.load("silicone").solve().to_xarray().sizes


def test_bounds(lean: hs.Arm, leaning: hs.Solution) -> None:
    (snap,) = leaning.snaps
    bounds: list[dict[str, Any]] = [
        {"snap_distance": 0.9 * snap.distance / lean.length},
        {"snap_angle": 0.9 * float(np.degrees(snap.angle))},
        {"snap_angle": f"{0.9 * snap.angle} rad"},
    ]
    for kept in bounds:
        with pytest.raises(hs.LimitPointError) as caught:
            lean.solve(**kept)
        assert caught.value.snaps == leaning.snaps
        with pytest.raises(hs.LimitPointError):
            hs.Solver(lean, **kept).solve()
        assert hs.solve_many(lean, tensions=[3e-4, 0.0], **kept).verdict == "limit_point"
        assert hs.sweep(lean, {"cable[0].tension": [3e-4]}, **kept).verdict.values.tolist() == ["limit_point"]
    assert hs.Solver(lean).solve().snaps == leaning.snaps
    assert hs.solve_many(lean, tensions=[3e-4, 0.0]).answered
    assert hs.sweep(lean, {"cable[0].tension": [3e-4]}).verdict.values.tolist() == [""]


def test_a_snap_that_goes_too_far(program: Program, against: hs.Arm) -> None:
    words = ("solve", "silicone", "--flow-speed", "0.2", "--set", "flow.direction=170", "--format", "json")
    status, text = program(*words)
    verdict = json.loads(text)["verdict"]
    with pytest.raises(hs.LimitPointError) as caught:
        against.solve()
    no = caught.value
    assert status == 3 and as_document(no.snaps) == verdict["snaps"]
    assert no.snaps[-1].distance > 0.1 * against.length
    assert no.after_snap is not None and no.at_full_loads is not None
    for shape, name in ((no.after_snap, "after_snap"), (no.at_full_loads, "at_full_loads")):
        assert shape.x.tolist() == verdict[name]["stations"]["x"]
    assert no.after_snap.tip == pytest.approx(no.snaps[-1].after, abs=1e-6)
    again = pickle.loads(pickle.dumps(no))
    assert type(again) is type(no) and again.snaps == no.snaps
    assert again.after_snap == no.after_snap and again.at_full_loads == no.at_full_loads
    assert again.at_full_loads.at(0.1) == no.at_full_loads.at(0.1)


def test_every_snap_is_followed(program: Program, against: hs.Arm) -> None:
    words = ("solve", "silicone", "--flow-speed", "0.2", "--set", "flow.direction=170", "--follow-snaps", "--format", "json")
    _, text = program(*words)
    followed = against.solve(follow_snaps=True)
    assert followed.to_json() == text.strip()
    with pytest.raises(hs.LimitPointError) as caught:
        against.solve()
    assert caught.value.at_full_loads is not None and followed.tip == caught.value.at_full_loads.tip
    assert hs.Solver(against, follow_snaps=True).solve() == followed
    again = pickle.loads(pickle.dumps(followed))
    assert again == followed and again.at(0.1) == followed.at(0.1)
    wide = against.solve(snap_distance=2.0, snap_angle=180)
    assert wide == followed
    tip = followed.tip
    many = hs.solve_many(against, tensions=[0.0, 0.0], follow_snaps=True, tol=1e-8)
    assert (many.tip_x.item(), many.tip_y.item()) == pytest.approx((tip.x, tip.y), abs=1e-8)
    swept = hs.sweep(against, {"cable[0].tension": [0.0]}, follow_snaps=True, tol=1e-8)
    assert swept.tip_x.item() == pytest.approx(tip.x, abs=1e-8) and swept.attrs["snap_angle"] == np.inf


def test_sweeps_are_the_programs(program: Program, tmp_path: Path, against: hs.Arm) -> None:
    for asked, own in ((["--follow-snaps"], {"follow_snaps": True}), (["--snap-angle", "120"], {"snap_angle": 120})):
        theirs, mine = tmp_path / f"theirs{asked[0]}.csv", tmp_path / f"mine{asked[0]}.csv"
        words = ["--set", "flow.direction=170", "--vary", "flow.speed=0:0.2:5", *asked]
        status, _ = program("sweep", "silicone", *words, "-o", str(theirs))
        assert status == 0
        options: dict[str, Any] = own
        hs.sweep(against, {"flow.speed": "0:0.2:5"}, output=mine, **options)
        assert mine.read_bytes() == theirs.read_bytes()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"snap_distance": -1.0}, "^snap_distance: expected a number that is not negative"),
        ({"snap_distance": "1 mm"}, "^snap_distance: expected a number"),
        ({"snap_angle": -1}, "^snap_angle: expected a number that is not negative"),
        ({"snap_angle": "-1 deg"}, "^snap_angle: expected a number that is not negative"),
        ({"snap_angle": "2 mm"}, "^snap_angle: .*mm"),
        ({"snap_angle": [2]}, "^snap_angle: expected a number"),
        ({"snap_angle": 3, "follow_snaps": True}, "^follow_snaps: expected it without"),
    ],
)
def test_bounds_that_are_none(silicone: hs.Arm, options: dict[str, Any], words: str) -> None:
    for call in (
        lambda: silicone.solve(**options),
        lambda: hs.Solver(silicone, **options),
        lambda: hs.solve_many(silicone, flow_speed=[0.1], **options),
        lambda: hs.sweep(silicone, {"flow.speed": [0.1]}, **options),
    ):
        with pytest.raises(ValueError, match=words):
            call()
