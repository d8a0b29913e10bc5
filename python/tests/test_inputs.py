"""What is wrong with an argument is a ValueError that names it."""

from __future__ import annotations

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import hydrostat as hs

BAD_TENSIONS: list[tuple[Any, str]] = [
    ([1.0], "1 tension was given"),
    ([1.0, 2.0, 3.0], "3 tensions were given"),
    ([[1.0, 2.0]], r"shape \(1, 2\)"),
    (1.0, r"shape \(\)"),
    ([np.nan, 0.0], r"\[0\]: expected a finite number"),
    ([0.0, np.inf], r"\[1\]: expected a finite number"),
    ([0.0, -0.1], r"\[1\]: expected a number that is not negative"),
    (["1", "2"], r"\[0\]: expected a number, or a string with a unit, found '1'"),
    ([1j, 0], "dtype complex128"),
    ([True, False], "dtype bool"),
    ([None, 0], "dtype object"),
    ([[1.0], [1.0, 2.0]], "not regular"),
]


@pytest.mark.parametrize(("tensions", "words"), BAD_TENSIONS)
def test_tensions(silicone: hs.Arm, tensions: Any, words: str) -> None:
    with pytest.raises(ValueError, match=f"^tensions.*{words}"):
        silicone.solve(tensions=tensions)
    with pytest.raises(ValueError, match=f"^tensions.*{words}"):
        hs.Solver(silicone).set_tensions(tensions)


@pytest.mark.parametrize("kind", [np.float32, np.int8, np.uint64, np.int64])
def test_numbers_of_any_kind_and_layout(silicone: hs.Arm, kind: type) -> None:
    paper = hs.Arm.load("paper")
    want = paper.solve(tensions=[20.0, 4.0]).tip
    spread: np.ndarray[tuple[int, ...], np.dtype[Any]] = np.zeros((2, 5), dtype=kind)
    spread[:, 3] = [20, 4]
    assert paper.solve(tensions=spread[:, 3]).tip == want
    assert paper.solve(tensions=(20, 4)).tip == want
    assert paper.solve(tensions=spread[::-1, 3][::-1]).tip == want
    assert silicone.solve(tensions=np.zeros(2, dtype=kind)).tip.y == 0.0


@given(number=st.floats().filter(lambda x: not 0.0 <= x < np.inf))
def test_no_speed_that_is_none(silicone: hs.Arm, number: float) -> None:
    for call in (
        lambda: silicone.solve(flow_speed=number),
        lambda: hs.solve_many(silicone, flow_speed=[0.1, number], nan="refuse"),
    ):
        with pytest.raises(ValueError, match="^flow_speed"):
            call()


CALLS: list[tuple[Callable[[hs.Arm], object], str]] = [
    (lambda arm: arm.solve(flow_speed="fast"), "^flow_speed: expected a speed .*does not start with a number"),
    (lambda arm: arm.solve(flow_speed=[0.1]), "^flow_speed: expected a number"),  # type: ignore[arg-type]
    (lambda arm: arm.solve(tol=0.1), "`tol`"),
    (lambda arm: arm.solve(tol=float("nan")), "^tol"),
    (lambda arm: arm.solve(strokes=[0.01]), "^strokes.*1 strokes were given"),
    (lambda arm: arm.solve(strokes=[float("nan"), None]), r"^strokes\[0\]"),
    (lambda arm: arm.solve(strokes=[3.0, None]), r"cable\[0\].stroke"),
    (lambda arm: arm.replace(tensions=[1.0]), "^tensions"),
    (lambda arm: arm.solve().at([0.3]), "^s: expected places"),
    (lambda arm: arm.solve().at(np.nan), "^s: expected places"),
    (lambda arm: arm.solve().resampled(1), "^count"),
    (lambda arm: arm.solve().resampled(-1), "^count"),
    (lambda arm: arm.solve().resampled(2.5), "^count"),  # type: ignore[arg-type]
    (lambda arm: hs.Solver(arm).set_stroke(-1, 0.01), "^cable"),
    (lambda arm: hs.Solver(arm).set_stroke(2, 0.01), "`cable`"),
    (lambda arm: hs.solve_many(arm, tensions=[0.1, 0.2, 0.3]), r"^tensions: expected the shape \(..., 2\)"),
    (lambda arm: hs.solve_many(arm, tensions=[[0.1, -0.2]]), r"^tensions: .*\(0, 1\)"),
    (lambda arm: hs.solve_many(arm, vary={"tip.moment": [np.nan]}, nan="refuse"), r"^vary\['tip.moment'\]"),
    (lambda arm: hs.solve_many(arm, vary={"tip.momint": [0.0]}), "tip.momint"),
    (lambda arm: hs.solve_many(arm, vary={"cable[4].tension": [0.0]}), r"cable\[4\].tension"),
    (lambda arm: hs.solve_many(arm, flow_speed=0.1, vary={"flow.speed": 0.2}), "second time, by flow_speed"),
    (lambda arm: hs.solve_many(arm, flow_speed=[0.1], tol=1.0), "`tol`"),
    (lambda arm: hs.solve_many(arm, flow_speed=[0.1], tile=0), "`tile`"),
    (
        lambda arm: hs.solve_many(arm, flow_speed=[0.1, 0.2], vary={"tip.moment": [0.0, 0.0, 0.0]}),
        r"broadcast: flow_speed \(2,\), vary\['tip.moment'\] \(3,\)",
    ),
    (lambda arm: arm.path("flow.sped", 0, 1), "did you mean `flow.speed`"),
    (lambda arm: arm.path("flow.speed", 0, np.nan), "^stop"),
    (lambda arm: arm.path("flow.speed", 0, 0.1, tol=1.0), "`tol`"),
    (lambda arm: arm.path("cable[2].tension", 0, 1), "2 cables"),
    (lambda arm: arm.equilibria(time_limit=-1.0), "^time_limit"),
    (lambda arm: arm.equilibria(tol=1.0), "`tol`"),
    (lambda arm: arm.reach((np.nan, 0.1)), r"^targets\[0\]: expected a finite number"),
    (lambda arm: arm.reach((0.1, 0.1, 0.1)), "^targets: expected targets"),
    (lambda arm: arm.reach(0.1), "^targets: expected targets"),  # type: ignore[arg-type]
    (lambda arm: arm.reach([]), "^targets: expected targets"),
    (lambda arm: arm.reach([hs.Target(0.1, 0.1), hs.Target(0.1, np.inf)]), r"^targets\[1\].y"),
    (lambda arm: arm.reach(hs.Target(0.1, 0.1, s=0.3)), "^targets: .*0.245 m long"),
    (lambda arm: arm.reach(hs.Target(0.1, 0.1, weight=0.0)), "^targets: .*with weights from 1e-9 to 1e9"),
    (lambda arm: arm.reach((0.1, 0.1), max_tension=-1.0), "^max_tension"),
    (lambda arm: arm.reach((0.1, 0.1), tol=0.1), "^tol"),
    (lambda arm: hs.Follower(arm, (0.1, np.nan)), r"^targets\[1\]"),
    (lambda arm: hs.Follower(arm, (0.2, 0.05)).follow(hs.Target(0.1, 0.1, s=0.2)), "^targets"),
    (lambda arm: arm.sensitivities(["flow.sped"]), "^parameters: .*flow.sped"),
    (lambda arm: arm.sensitivities("flow.speed"), "^parameters: expected a sequence"),
    (lambda arm: arm.sensitivities(["cable[2].tension"]), "^parameters: .*2 cables"),
    (lambda arm: arm.sensitivities(["cable[0].stroke"]), "^parameters: .*follows from the tension"),
    (lambda arm: arm.sensitivities(["arm.radius[1][1]"]), "^parameters: .*`arm.radius.base` to `arm.radius.tip`"),
    (lambda arm: arm.sensitivities(stations=[0.3]), "^stations: .*0.245 m long"),
    (lambda arm: arm.sensitivities(stations=[np.nan]), "^stations"),
    (lambda arm: arm.sensitivities(stations=[[0.1]]), r"^stations: .*shape \(1, 1\)"),
    (lambda arm: arm.sensitivities(method="backward"), "^method"),
    (lambda arm: arm.replace({"cable[0].friction": 0.1}).sensitivities(), "friction. is above 0"),
    (lambda arm: arm.sensitivities().jacobian(["tip.z"]), "^quantities"),
    (lambda arm: arm.sensitivities(["flow.speed"]).jacobian(None, ["arm.density"]), "^parameter"),
    (lambda arm: hs.Solver(arm).gradient("flow.speed", [0.1]), "^parameters: expected a sequence"),
    (lambda arm: hs.Solver(arm).gradient(["flow.speed"], [0.1], x=[1.0, 2.0]), r"^x: .*\(1,\).*\(2,\)"),
    (lambda arm: hs.Solver(arm).gradient(["flow.speed"], [0.1], theta=np.nan), "^theta"),
    (lambda arm: hs.Solver(arm).gradient(["flow.speed"], [0.3]), "^stations: .*0.245 m long"),
    (lambda arm: arm.sensitivities(["flow.speed"]).plot_manipulability(), "^parameters"),
    (lambda arm: hs.Ellipse.of([[1.0, 2.0, 3.0]]), r"^jacobian.*\(1, 3\)"),
    (lambda arm: hs.sweep(arm, {}), "^vary: .*at least one key"),
    (lambda arm: hs.sweep(arm, {"flow.sped": [1.0]}), "did you mean `flow.speed`"),
    (lambda arm: hs.sweep(arm, {"flow.speed": [0.1, np.nan]}), r"^vary\['flow.speed'\]"),
    (lambda arm: hs.sweep(arm, {"flow.speed": np.array([[0.1]])}), r"^vary\['flow.speed'\].*shape \(1, 1\)"),
    (lambda arm: hs.sweep(arm, {"flow.speed": [-0.1]}), "flow.speed"),
    (lambda arm: hs.sweep(arm, {"flow.speed": "0:1"}), "^vary: .*FROM:TO:COUNT"),
    (lambda arm: hs.sweep(arm, {"flow.speed": "0:1"}, sample="lhs"), "^sample"),
    (lambda arm: hs.sweep(arm, {"flow.speed": [0.1]}, columns=["tips"]), "^columns"),
    (lambda arm: hs.sweep(arm, {"flow.speed": [0.1]}, tol=1.0), "tol"),
    (lambda arm: hs.sweep(arm, {"flow.speed": [0.1]}, output="q.nc"), "^output: .* ends in .parquet or .csv.*to_netcdf"),
    (lambda arm: hs.sweep(arm, {"flow.speed": [0.1]}, output="q"), "^output: .* ends in .parquet or .csv"),
    (lambda arm: arm.solve().figure().save("shape.jpg"), "^path: .*svg, .pdf or .png"),
]


#: Of another type than what is meant.
TYPES: list[tuple[Callable[[hs.Arm], object], str]] = [
    (lambda arm: arm.solve(strokes=0.01), "^strokes: expected a list of numbers, one a cable, found 0.01"),  # type: ignore[arg-type]
    (lambda arm: arm.replace(tensions=0.2), "^tensions: expected a list"),  # type: ignore[arg-type]
    (lambda arm: arm.replace(0.2), "^changes: expected a mapping"),  # type: ignore[arg-type]
    (lambda arm: hs.sweep(arm, {"flow.speed": "0:1"}, sample=50), "^sample: expected text such as 'lhs:50', found 50"),  # type: ignore[call-overload]
    (lambda arm: hs.sweep(arm, {"flow.speed": [0.1]}, columns="tip"), "^columns: expected a list of names"),
    (lambda arm: hs.sweep(arm, {"flow.speed": [0.1]}, columns=[1]), "^columns: expected text"),  # type: ignore[list-item]
    (lambda arm: hs.sweep(arm, ["flow.speed"]), "^vary: expected a mapping"),  # type: ignore[call-overload]
    (lambda arm: hs.solve_many(arm, vary=[1.0]), "^vary: expected a mapping"),  # type: ignore[call-overload]
    (lambda _: hs.solve_many(3.0), "^arm: expected an Arm, or the name or file of one, found 3.0"),  # type: ignore[call-overload]
    (lambda _: hs.sweep(None, {"flow.speed": [0.1]}), "^arm: expected an Arm"),  # type: ignore[call-overload]
    (lambda arm: hs.Solver(arm._inner), "^arm: expected an Arm"),  # type: ignore[arg-type]
    (lambda arm: arm.sensitivities([1]), "^parameters: expected text"),  # type: ignore[list-item]
    (lambda arm: hs.solve_many(arm, progress="yes"), "^progress: expected True, False or None, found 'yes'"),  # type: ignore[call-overload]
    (lambda arm: hs.sweep(arm, {"flow.speed": [0.1]}, progress=1), "^progress: expected True, False or None, found 1"),  # type: ignore[call-overload]
]


@pytest.mark.parametrize(("call", "words"), TYPES)
def test_types(silicone: hs.Arm, call: Callable[[hs.Arm], object], words: str) -> None:
    with pytest.raises(TypeError, match=words):
        call(silicone)


@pytest.mark.parametrize(("call", "words"), CALLS)
def test_calls(silicone: hs.Arm, call: Callable[[hs.Arm], object], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        call(silicone)


def test_modules_say_what_was_meant(silicone: hs.Arm) -> None:
    with pytest.raises(TypeError, match=r"^hydrostat.reach is a module; expected a call of `hydrostat.Arm.reach"):
        hs.reach((0.1, 0.1))  # type: ignore[operator]
    for name in ("figures", "spatial"):
        with pytest.raises(TypeError, match=rf"^hydrostat.{name} is a module; expected a call of `hydrostat.*figure|Arm.solve"):
            getattr(hs, name)(1)
    for name in ("solve", "path", "equilibria", "identify"):
        with pytest.raises(AttributeError, match=rf"^module 'hydrostat' has no attribute '{name}'; expected `hydrostat.Arm.{name}`"):
            getattr(hs, name)
    with pytest.raises(AttributeError, match=r"^module 'hydrostat' has no attribute 'sole'$"):
        hs.sole  # type: ignore[attr-defined]  # noqa: B018
    assert not {"many", "reach", "paths", "cluster"} & set(dir(hs))
    assert set(hs.__all__) == set(dir(hs)) and all(hasattr(hs, name) for name in hs.__all__)


def test_arrays_are_taken_where_lists_are(silicone: hs.Arm) -> None:
    pulls = np.array([0.2, 0.05])
    arm = silicone.replace(tensions=pulls)
    assert arm == silicone.replace(tensions=[0.2, 0.05]) == silicone.replace(tensions=["200 mN", 0.05])
    tip = arm.solve().tip
    found = silicone.reach(np.array([tip.x, tip.y]), max_tension=0.9)
    assert len(found)
    strokes = np.array([0.012, -0.03])
    assert silicone.solve(strokes=strokes) == silicone.solve(strokes=[0.012, -0.03])


def test_an_arms_name_is_an_arm(silicone: hs.Arm, tmp_path: Path) -> None:
    file = tmp_path / "own.toml"
    file.write_text(silicone.to_toml(), encoding="utf-8")
    tip = silicone.solve(tensions=[0.2, 0.0]).tip
    for arm in ("silicone", file, str(file)):
        solver = hs.Solver(arm)
        solver.set_tensions([0.2, 0.0])
        assert solver.update().tip == pytest.approx(tip)
        assert hs.solve_many(arm, tensions=[0.2, 0.0]).tip_x == pytest.approx(tip.x)
        assert hs.sweep(arm, {"cable[0].tension": [0.2]}).tip_x.item() == pytest.approx(tip.x)
        assert hs.Follower(arm, (tip.x, tip.y), max_tension=0.6).follow((tip.x, tip.y)).reached
    with pytest.raises(FileNotFoundError, match="^arm: "):
        hs.solve_many("silicon")


def test_copies_went_on_together(silicone: hs.Arm) -> None:
    """They shared the solver: what one was told, the other solved."""
    solver = hs.Solver(silicone)
    solver.set_tensions([0.2, 0.0])
    before = solver.update().tip
    follower = hs.Follower(silicone.replace(tensions=[0.2, 0.0]), (before.x, before.y))
    for copied in (copy.copy, copy.deepcopy):
        other = copied(solver)
        other.set_tensions([0.3, 0.0])
        assert other.update().tip.theta > before.theta
        assert solver.update().tip == pytest.approx(before, abs=1e-9)
        ahead = copied(follower)
        moved = ahead.follow((before.x, before.y - 2e-3))
        still = follower.follow((before.x, before.y))
        assert (still.tip.x, still.tip.y) == pytest.approx((before.x, before.y), abs=1e-7)
        assert moved.tip.y == pytest.approx(before.y - 2e-3, abs=1e-7)
        assert ahead.follow((before.x, before.y - 2e-3)).solves <= 2


def test_nothing_to_vary_is_one_row(silicone: hs.Arm) -> None:
    many = hs.solve_many(silicone, tensions=[0.1, 0.0])
    assert many.shape == () and many.tip_y.shape == () and many.stroke.shape == (2,)
    assert hs.solve_many(silicone, flow_speed=[]).tip_x.shape == (0,)


def test_a_unit_behind_a_range_was_that_of_its_end_alone(silicone: hs.Arm) -> None:
    pytest.importorskip("xarray")
    given: list[Any] = ["5:20 cm/s:2", "5,20 cm/s", ["5", "20 cm/s"], ["5 cm/s", "20 cm/s"], [0.05, "20 cm/s"]]
    for values in given:
        found = hs.sweep(silicone, {"flow.speed": values}, columns=["tip"])
        assert found["flow_speed"].values.tolist() == pytest.approx([5.0, 20.0], rel=1e-12) or values == [0.05, "20 cm/s"]
        alone = hs.sweep(silicone, {"flow.speed": [0.05, 0.2]}, columns=["tip"])
        assert found.tip_y.values.tolist() == alone.tip_y.values.tolist()
    assert silicone.path("flow.speed", "5", "20 cm/s").range == (5.0, 20.0)
    # A number that is no string is in SI units, as ever.
    assert silicone.path("flow.speed", 0.05, "20 cm/s").branches[0].values[[0, -1]].tolist() == [0.05, 0.2]
    with pytest.raises(ValueError, match=r"\"5:20 cm/s\".*\"5 cm/s:20 m/s\""):
        silicone.path("flow.speed", "5 cm/s", "20")
    with pytest.raises(ValueError, match=r"\"5:20 cm/s\""):
        hs.sweep(silicone, {"flow.speed": "5 cm/s:20:2"})
