"""Python and the program give the same numbers to the last bit: their documents are the same text."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from conftest import Program
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import hydrostat as hs

#: Largest tensions of the first cable that are tried, N; some arms fold before.
LARGEST = {"paper": 100.0, "paper-statements": 120.0, "silicone": 1.4, "multi-bending": 2.0, "octopus": 0.02}


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    name=st.sampled_from(sorted(LARGEST)),
    pull=st.floats(0.0, 1.0),
    speed=st.floats(0.0, 1.0),
    cable=st.integers(0, 1),
)
def test_solves(program: Program, name: str, pull: float, speed: float, cable: int) -> None:
    arm = hs.Arm.load(name)
    tensions = [0.0] * len(arm.cables)
    tensions[cable] = pull * LARGEST[name]
    words = ",".join(repr(tension) for tension in tensions)
    status, text = program("solve", name, "--tension", words, "--flow-speed", repr(speed), "--format", "json")
    try:
        solution = arm.solve(tensions=tensions, flow_speed=speed)
    except hs.NoEquilibrium as no:
        assert status == 3
        verdict = json.loads(text)["verdict"]
        mine = (no.kind, no.phase, no.load_fraction, no.where, no.residual, no.message, no.advice)
        keys = ("kind", "phase", "load_fraction", "s", "residual", "message", "advice")
        assert mine == tuple(verdict[key] for key in keys)
        last = json.loads(text)["last_good"]
        # Right at a limit of the sections there can be none that is told to the end.
        assert (no.last_good is None) == (last is None)
        if no.last_good is not None:
            assert no.last_good.x.tolist() == last["stations"]["x"]
    else:
        assert status == 0
        assert solution.to_json() == text.strip()
        stations = json.loads(text)["stations"]
        for field, values in stations.items():
            assert getattr(solution, field).tobytes() == np.array(values).tobytes(), field


def test_strokes_and_friction(program: Program, silicone: hs.Arm) -> None:
    _, text = program(
        "solve", "silicone", "--set", "cable[0].stroke=0.012", "--set", "cable[1].stroke=-0.03", "--format", "json"
    )
    assert silicone.solve(strokes=[0.012, -0.03]).to_json() == text.strip()
    rubbing = silicone.replace({"cable[0].friction": 0.1}, tensions=[0.3, 0.0])
    _, text = program("solve", "silicone", "--tension", "0.3,0", "--set", "cable[0].friction=0.1", "--format", "json")
    assert rubbing.solve().to_json() == text.strip()


def test_paths_and_equilibria(program: Program, facing: hs.Arm) -> None:
    loads = ("--flow-speed", "0.2", "--set", "flow.direction=180")
    _, text = program("path", "silicone", *loads, "--vary", "arm.base.angle=90:-90", "--format", "csv")
    assert facing.path("arm.base.angle", 90, -90).to_csv() == text
    _, text = program("equilibria", "silicone", *loads, "--format", "csv")
    assert facing.equilibria().to_csv() == text


@pytest.mark.parametrize(
    ("target", "more"), [((0.182, 0.078), {}), ((0.3, 0.0), {"tol": 1e-6}), ((0.2, 0.08), {"angle": 51.5, "s": 0.22})]
)
def test_reach(program: Program, silicone: hs.Arm, target: tuple[float, float], more: dict[str, float]) -> None:
    words = ["reach", "silicone", "--target", f"{target[0]},{target[1]}", "--max-tension", "0.6"]
    tol = more.pop("tol", 1e-8)
    words += ["--tol", repr(tol)]
    if more:
        words += ["--angle", f"{more['angle']} deg", "--station", repr(more["s"])]
    found = silicone.reach(hs.Target(*target, **more), max_tension=0.6, tol=tol)
    status, text = program(*words, "--format", "json")
    assert status == (0 if found else 3)
    assert found.to_json() == text.strip()
    assert found.to_csv() == program(*words, "--format", "csv")[1]


@pytest.mark.parametrize("sample", [None, "sobol:90"])
def test_sweeps(program: Program, tmp_path: Path, silicone: hs.Arm, sample: str | None) -> None:
    count = "" if sample else ":9"
    vary = {"flow.speed": f"0:0.4{count}", "cable[0].tension": f"0:1.2{count}", "flow.direction": "0,45 deg"}
    words = [part for key, values in vary.items() for part in ("--vary", f"{key}={values}")]
    words += ["--sample", sample, "--seed", "7"] if sample else []
    theirs, mine = tmp_path / "theirs.csv", tmp_path / "mine.csv"
    status, _ = program("sweep", "silicone", *words, "-o", str(theirs))
    assert status == 0
    seed = 7 if sample else 0
    hs.sweep(silicone, vary, sample=sample, seed=seed, output=mine)
    assert mine.read_bytes() == theirs.read_bytes()
    table = np.genfromtxt(theirs, delimiter=",", names=True, dtype=None, encoding="utf-8", deletechars="")
    found = hs.sweep(silicone, vary, sample=sample, seed=seed)
    for name in ("tip_x", "tip_y", "tip_theta", "tip_alpha"):
        column = next(column for column in table.dtype.names or () if column.startswith(name))
        assert found[name].values.ravel().tobytes() == table[column].tobytes(), name
    assert set(found["verdict"].values.ravel()) == {"", "cable_fold"}


def test_many_rows_are_single_solves_to_their_tolerance(silicone: hs.Arm) -> None:
    pulls = np.linspace(0.0, 0.9, 19)
    tensions = np.stack([pulls, np.zeros_like(pulls)], axis=-1)
    many = hs.solve_many(silicone, tensions=tensions, flow_speed=[[0.0], [0.05]], tol=1e-9)
    assert many.shape == (2, 19)
    assert many.answered.all()
    for row, speed in enumerate([0.0, 0.05]):
        for k, pull in enumerate(pulls):
            tip = silicone.solve(tensions=[pull, 0.0], flow_speed=speed, tol=1e-9).tip
            distance = np.hypot(many.tip_x[row, k] - tip.x, many.tip_y[row, k] - tip.y)
            assert distance < 1e-8 * silicone.length


def test_arms_alike_with_other_texts_are_swept_by_their_own() -> None:
    """The written arm has every reading by itself, above which a closure says nothing any more."""
    arm = hs.Arm.load("paper").replace(tensions=[20, 0])
    written = hs.Arm.from_toml(arm.to_toml())
    assert written == arm
    vary = {"model.closure": ["default", "literal"]}
    default, literal = hs.sweep(arm, vary).tip_x.values
    assert abs(default - literal) > 1e-4 * arm.length
    # The second row starts from the first one's shape, and differs by rounding and tolerance.
    assert np.allclose(hs.sweep(written, vary).tip_x.values, default, rtol=0.0, atol=1e-7 * arm.length)
