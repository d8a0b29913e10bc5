"""What carries a unit is taken wherever numbers are, and converted."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import hydrostat as hs

pd = pytest.importorskip("pandas")
xr = pytest.importorskip("xarray")


def test_strings_with_units(silicone: hs.Arm) -> None:
    want = silicone.solve(tensions=[0.1, 0.0], flow_speed=0.1)
    assert silicone.solve(tensions=["100 mN", 0.0], flow_speed="10 cm/s") == want
    assert silicone.solve(tensions=np.array(["0.1 N", "0 N"]), flow_speed="0.1 m/s") == want
    assert silicone.solve(tensions=("0.1 N", "0 N"), flow_speed=np.str_("10 cm/s")) == want
    assert silicone.solve(strokes=["12 mm", None]) == silicone.solve(strokes=[0.012, None])
    assert want.at("10 cm") == want.at(0.1) and want.at(["10 cm", "20 cm"]) == want.at([0.1, 0.2])
    solver = hs.Solver(silicone)
    solver.set_tensions(["100 mN", 0])
    solver.set_flow_speed("10 cm/s")
    assert solver.solve().tip == pytest.approx(want.tip, abs=1e-9)
    solver.set_stroke(0, "12 mm")
    assert solver.solution().cables[0].command is not None
    many = hs.solve_many(silicone, tensions=[["100 mN", "0 N"], [0.1, 0.0]], flow_speed="10 cm/s")
    assert many.tip_y.tolist() == hs.solve_many(silicone, tensions=[[0.1, 0.0]] * 2, flow_speed=0.1).tip_y.tolist()
    assert silicone.equilibria(time_limit="2 s")


def test_texts_of_a_sweep_in_solve_many(silicone: hs.Arm) -> None:
    for text, values in (("0:1:3", [0.0, 0.5, 1.0]), ("0:10 cm/s:3", [0.0, 0.05, 0.1]), ("5,20 cm/s", [0.05, 0.2]), ("10 cm/s", 0.1)):
        found = hs.solve_many(silicone, vary={"flow.speed": text})
        assert found.shape == np.shape(values)
        assert found.tip_y.tolist() == hs.solve_many(silicone, vary={"flow.speed": values}).tip_y.tolist()
    turned = hs.solve_many(silicone, flow_speed=0.1, vary={"flow.direction": "0:90 deg:3"})
    assert turned.tip_y == pytest.approx(hs.solve_many(silicone, flow_speed=0.1, vary={"flow.direction": [0, 45, 90]}).tip_y, abs=1e-9)
    radians = hs.solve_many(silicone, flow_speed=0.1, vary={"flow.direction": f"{np.pi / 2} rad"})
    assert radians.tip_y == pytest.approx(turned.tip_y[2], abs=1e-9)


def test_targets_with_units_and_degrees(silicone: hs.Arm) -> None:
    plain = silicone.reach((0.182, 0.078), max_tension=0.6)
    several: list[Any] = [("182 mm", "78 mm"), ["18.2 cm", 0.078], [(0.182, 0.078)], np.array([[0.182, 0.078]]), hs.Target("182 mm", "78 mm")]
    for targets in several:
        assert silicone.reach(targets, max_tension="600 mN") == plain
    turn = float(np.degrees(plain[0].solution.tip.theta))
    for angle in (turn, f"{turn!r} deg", f"{float(np.radians(turn))!r} rad"):
        found = silicone.reach(hs.Target(0.182, 0.078, angle=angle), max_tension=0.6)
        assert found[0].tensions == pytest.approx(plain[0].tensions, abs=1e-6)
        assert found.targets[0].angle == pytest.approx(turn, rel=1e-12)  # type: ignore[union-attr]
    follower = hs.Follower(silicone, ("182 mm", "78 mm"), max_tension="0.6 N", max_stroke="40 mm")
    follower.set_flow_speed("1 cm/s")
    follower.set_bounds(max_tension="0.7 N")
    assert follower.follow(["182 mm", 0.078]).reached
    assert silicone.reachable(max_tension="200 mN", spacing=0.1) == silicone.reachable(max_tension=0.2, spacing=0.1)


def test_targets_in_space_with_units() -> None:
    arm = hs.Arm.load("silicone-spatial")
    tip: Any = arm.solve(tensions=[0.1, 0.05, 0]).tip
    plain = arm.reach((tip.x, tip.y, tip.z), max_tension=0.3, find_all=False)
    place: Any = [f"{1e3 * value!r} mm" for value in (tip.x, tip.y, tip.z)]
    for targets in (place, [tuple(place)], hs.SpatialTarget(*place)):
        found = arm.reach(targets, max_tension="0.3 N", find_all=False)
        assert found[0].tensions == pytest.approx(plain[0].tensions, abs=1e-6)


def test_a_largest_tension_for_each_cable(silicone: hs.Arm) -> None:
    found = silicone.reach((0.05, 0.2), max_tension=[0.05, "20 mN"])
    assert found.closest is not None and found.closest.tensions[0] == pytest.approx(0.05)
    assert silicone.replace(tensions=[0.5, 0.5]).reach((0.05, 0.2), max_tension=[0.05, 0.02]).closest is not None
    wide = silicone.replace({"cable[0].max_tension": 0.05}).reach((0.05, 0.2), max_tension=[1.0, 0.02])
    assert wide.closest is not None and wide.closest.tensions[0] == pytest.approx(0.05)
    with pytest.raises(ValueError, match=r"^max_tension: .*2 cables, found shape \(3,\)"):
        silicone.reach((0.05, 0.2), max_tension=[0.1, 0.1, 0.1])


WRONG: list[tuple[Callable[[hs.Arm], object], str]] = [
    (lambda arm: arm.solve(flow_speed="10 N"), r"^flow_speed: expected a speed .*`N` is the unit of a force"),
    (lambda arm: arm.solve(flow_speed="10"), "^flow_speed: .*it has no unit"),
    (lambda arm: arm.solve(tensions=["0.1 N", "2 foo"]), r"^tensions\[1\]: .*`foo` is not known"),
    (lambda arm: arm.solve(strokes=["12 mm", "1 N"]), r"^strokes\[1\]: expected a length"),
    (lambda arm: hs.solve_many(arm, tensions=[["0.1 N", "1"], [0.0, 0.0]]), r"^tensions\[0\]\[1\]: .*no unit"),
    (lambda arm: hs.solve_many(arm, vary={"flow.speed": "0:1 N:3"}), r"^vary\['flow.speed'\]: "),
    (lambda arm: hs.solve_many(arm, vary={"flow.speed": "0:1"}), r"^vary\['flow.speed'\]: "),
    (lambda arm: hs.Target("1 N", 0.1), "^x: expected a length"),
    (lambda arm: hs.Target(0.1, 0.1, angle="1 mm"), "^angle: expected an angle"),
    (lambda arm: arm.reach(("1 N", 0.1)), r"^targets\[0\]: expected a length"),
    (lambda arm: arm.reach("0.1 m"), "^targets: expected targets"),
    (lambda arm: hs.solve_many(arm, flow_speed=xr.DataArray([1.0], dims="v", attrs={"units": "N"})), "^flow_speed: units: expected a speed"),
    (lambda arm: hs.solve_many(arm, flow_speed=xr.DataArray([1.0], dims="v", attrs={"units": "1"})), "^flow_speed: expected numbers in m/s"),
]


@pytest.mark.parametrize(("call", "words"), WRONG)
def test_a_wrong_unit_is_named(silicone: hs.Arm, call: Callable[[hs.Arm], object], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        call(silicone)


@pytest.mark.parametrize("units", ["cm/s", "cm s-1", "cm s^-1", "centimeter / second", "centimeters/second"])
def test_the_units_of_a_dataarray_were_ignored(silicone: hs.Arm, units: str) -> None:
    want = hs.solve_many(silicone, flow_speed=[0.1, 0.2]).tip_y.tolist()
    speed = xr.DataArray([10.0, 20.0], dims="speed", coords={"speed": [10.0, 20.0]}, attrs={"units": units})
    found = hs.solve_many(silicone, flow_speed=speed)
    assert found.tip_y.values.tolist() == pytest.approx(want, abs=1e-12) and found["speed"].values.tolist() == [10.0, 20.0]
    assert hs.solve_many(silicone, vary={"flow.speed": speed}).tip_y.values.tolist() == pytest.approx(want, abs=1e-12)
    swept = hs.sweep(silicone, {"flow.speed": speed}, tol=1e-6)
    assert swept.tip_y.values.tolist() == pytest.approx(want, abs=1e-7)


@pytest.mark.parametrize(("units", "per"), [("rad", np.pi / 180), ("radian", np.pi / 180), ("deg", 1.0), ("degrees", 1.0), (None, 1.0)])
def test_angles_of_a_dataarray(silicone: hs.Arm, units: str | None, per: float) -> None:
    degrees = np.array([0.0, 45.0])
    want = hs.solve_many(silicone, flow_speed=0.1, vary={"flow.direction": degrees}).tip_y
    turned = xr.DataArray(degrees * per, dims="turn", attrs={} if units is None else {"units": units})
    found = hs.solve_many(silicone, flow_speed=0.1, vary={"flow.direction": turned})
    assert found.tip_y.values == pytest.approx(want, abs=1e-10)


def test_quantities_of_pint_were_stripped(silicone: hs.Arm) -> None:
    pint = pytest.importorskip("pint")
    u = pint.UnitRegistry()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", hs.ModelWarning)
        want = silicone.solve(tensions=[0.1, 0.0], flow_speed=0.1)
        for tensions in (np.array([100.0, 0.0]) * u.mN, [100.0 * u.mN, 0.0 * u.N], [100.0 * u.mN, 0.0]):
            found = silicone.solve(tensions=tensions, flow_speed=10 * u.cm / u.s)
            assert found.tip == pytest.approx(want.tip, abs=1e-12)
        many = hs.solve_many(silicone, tensions=np.array([[100.0, 0.0]]) * u.mN, flow_speed=np.array([10.0]) * u.cm / u.s)
        assert many.tip_y == pytest.approx(want.tip.y, abs=1e-6)
        turned = hs.solve_many(silicone, flow_speed=0.1, vary={"flow.direction": np.array([np.pi / 2]) * u.rad})
        assert turned.tip_y == pytest.approx(hs.solve_many(silicone, flow_speed=0.1, vary={"flow.direction": [90.0]}).tip_y, abs=1e-10)
        young = hs.solve_many(silicone, flow_speed=0.1, vary={"material.young": np.array([0.11]) * u.MPa})
        assert young.tip_y == pytest.approx(hs.solve_many(silicone, flow_speed=0.1, vary={"material.young": [110e3]}).tip_y, abs=1e-10)
        density = hs.solve_many(silicone, vary={"arm.density": np.array([1.08]) * u.g / u.cm**3})
        assert density.answered.all()
        swept = hs.sweep(silicone, {"flow.speed": np.array([0.0, 10.0]) * u.cm / u.s, "cable[0].tension": [0.0 * u.N, 100.0 * u.mN]})
        assert swept.tip_y.shape == (2, 2)
        quantified = xr.DataArray(np.array([10.0]) * u.cm / u.s, dims="v")
        assert hs.solve_many(silicone, tensions=[0.1, 0.0], flow_speed=quantified).tip_y.values == pytest.approx(want.tip.y, abs=1e-6)
        assert silicone.reach((182 * u.mm, 78 * u.mm), max_tension=600 * u.mN)
    with pytest.raises(ValueError, match=r"^flow_speed: expected numbers in m/s, found a Quantity in newton"):
        silicone.solve(flow_speed=10 * u.N)
    with pytest.raises(ValueError, match=r"^tensions\[0\]: expected numbers in N, found a Quantity in meter"):
        silicone.solve(tensions=[1 * u.m, 0])


def test_widgets_take_units() -> None:
    pytest.importorskip("ipywidgets")
    from hydrostat.widget import explore

    assert explore("silicone", max_tension="300 mN", max_speed="20 cm/s").solution is not None


def test_times_of_a_motion_carry_units(silicone: hs.Arm) -> None:
    loads = {"cable[0].tension": np.array([[0.0, 0.0], [0.05, 0.05]])}
    want = hs.simulate(silicone, loads, until=0.1, every=0.05, tol=1e-3)
    found = hs.simulate(silicone, loads, until="100 ms", every="0.05 s", tol=1e-3)
    assert list(found.time) == list(want.time) and found.tip_x.values[-1] == want.tip_x.values[-1]
    with pytest.raises(ValueError, match="^until: "):
        hs.simulate(silicone, loads, until="100 mm")
