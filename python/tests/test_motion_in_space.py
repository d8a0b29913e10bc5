"""Arms in space in motion: the functions and classes of the plane, with z and directors."""

from __future__ import annotations

import copy
import math
import pickle
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import hydrostat as hs

if TYPE_CHECKING:
    import xarray as xr

pytest.importorskip("xarray")


@pytest.fixture(scope="module")
def arm() -> hs.Arm:
    return hs.Arm.load("silicone-spatial").replace({"dynamics.relaxation_time": "2.7 ms"}, tensions=[0, 0, 0])


@pytest.fixture(scope="module")
def motion(arm: hs.Arm) -> xr.Dataset:
    return hs.simulate(arm, {"cable[1].tension": [[0, 0], [0.1, 0.1]]}, until=0.2, every=0.05, tol=1e-3)


def test_a_run_has_z_and_directors(arm: hs.Arm, motion: xr.Dataset) -> None:
    assert motion.sizes["time"] == 5 and motion.sizes["cable"] == 3 and motion.axis.to_numpy().tolist() == ["x", "y", "z"]
    assert abs(motion.tip_z[-1].item()) > 1e-3 and motion.tip_vz.attrs["units"] == "m/s"
    a, b, c = (motion[name].to_numpy() for name in "abc")
    assert a.shape == (5, motion.sizes["node"], 3)
    assert np.cross(a, b) == pytest.approx(c, abs=1e-9)
    for name in "xyz":
        assert motion[name][:, -1].to_numpy() == pytest.approx(motion[f"tip_{name}"].to_numpy(), abs=1e-12)
    assert a[:, -1] == pytest.approx(motion.tip_a.to_numpy(), abs=1e-9)
    assert motion.tension[:, 1].to_numpy() == pytest.approx([0, 0.05, 0.1, 0.1, 0.1])


def test_an_arm_in_a_plane_moves_there_as_in_the_plane() -> None:
    flat = hs.Arm.load("silicone").replace({"dynamics.relaxation_time": "2.7 ms"})
    loads: dict[str, Any] = {"cable[0].tension": [[0, 0], [0.1, 0.1]]}
    plane = hs.simulate(flat, loads, until=0.2, every=0.1, tol=1e-4)
    space = hs.simulate(flat.replace({"arm.space": "spatial"}), loads, until=0.2, every=0.1, tol=1e-4)
    for name in ("tip_x", "tip_y"):
        assert space[name].to_numpy() == pytest.approx(plane[name].to_numpy(), abs=2e-4 * flat.length)
    assert np.abs(space.tip_z).max().item() < 1e-12
    turned = np.arctan2(space.tip_a[:, 1], space.tip_a[:, 0])
    assert turned.to_numpy() == pytest.approx(plane.tip_theta.to_numpy(), abs=1e-3)


def test_steps_and_copies(arm: hs.Arm, motion: xr.Dataset) -> None:
    sim = hs.Simulation(arm, tol=1e-3)
    rest = sim.now()
    assert isinstance(rest, hs.SpatialMoment) and rest.tip_a == pytest.approx((1, 0, 0), abs=0.1)
    for _ in range(2):
        at = sim.step(0.05, tensions=[0, sim.now().tensions[1] + 0.05, 0])
    assert isinstance(at, hs.SpatialMoment)
    assert at.tip_z == pytest.approx(motion.tip_z[2].item(), abs=2e-3 * arm.length)
    x, y, z, a, b, c = sim.shape()
    assert (x[-1], y[-1], z[-1]) == pytest.approx((at.tip_x, at.tip_y, at.tip_z), abs=1e-12)
    assert a.shape == b.shape == c.shape == (len(x), 3)
    other = copy.copy(sim)
    one, two = sim.step(0.05, tensions=[0, 0.2, 0]), other.step(0.05, loads={"flow.direction[2]": 0.1})
    assert one.tensions[1] == pytest.approx(0.2) and two.tensions[1] == pytest.approx(0.1)


def test_pictures(motion: xr.Dataset, tmp_path: Path) -> None:
    strobe, over_time = hs.motion_figures(motion)
    assert "tip trace" in strobe.texts() and "z (mm)" in strobe.texts() and "z of the tip" in over_time.texts()
    pytest.importorskip("matplotlib").use("agg")
    hs.animate(motion, tmp_path / "motion.gif", sections=3)
    assert (tmp_path / "motion.gif").read_bytes()[:4] == b"GIF8"
    with pytest.raises(ValueError, match="^solutions: "):
        hs.animate([hs.Arm.load("silicone").solve(), hs.Arm.load("silicone-spatial").solve()])


def test_a_snap_is_followed_by_its_motion() -> None:
    against = hs.Arm.load("silicone").replace(
        {"dynamics.relaxation_time": "2.7 ms", "arm.space": "spatial", "flow.speed": 0.4, "flow.direction": math.degrees(3.0)}
    )
    with pytest.raises(hs.LimitPointError):
        against.solve()
    sol = against.solve(after_snap=True)
    assert isinstance(sol, hs.SpatialSolution)
    (snap,) = sol.snaps
    assert snap.phase == "loads" and snap.duration is not None and snap.duration > 1 and snap.lands_elsewhere is False
    assert '"duration":' in sol.to_json() and isinstance(snap.after, hs.SpatialTip)
    assert pickle.loads(pickle.dumps(sol)).snaps == sol.snaps
    in_plane = against.replace({"arm.space": "planar"}).solve(after_snap=True)
    assert (sol.tip.x, sol.tip.y) == pytest.approx((in_plane.tip.x, in_plane.tip.y), abs=1e-6)


def test_a_start_without_equilibrium_says_why(arm: hs.Arm) -> None:
    with pytest.raises(hs.NoEquilibriumError):
        hs.simulate(arm.replace(tensions=[1.4, 0, 0]), until=0.1)


def test_a_history_has_the_snaps_of_the_plane() -> None:
    against = hs.Arm.load("silicone").replace({"dynamics.relaxation_time": "2.7 ms", "arm.space": "spatial"}, flow_speed=0.2, flow_direction=180)
    both = hs.history(against, {"arm.base.angle": [40, -40, 40]})
    assert [snap.row for snap in both.snaps] == [1, 2] and isinstance(both[0], hs.SpatialSolution)
    down, up = both.snaps
    assert down.loads["arm.base.angle"] == pytest.approx(-29.643, abs=1e-2)
    assert isinstance(down.after, hs.SpatialTip) and down.lands_elsewhere is not None
    assert (both[0].tip.x, both[0].tip.y) == pytest.approx((both[2].tip.x, both[2].tip.y), abs=1e-6)
    assert "the arm snaps" in both.figure("tip.y").texts() and "tip_z_m" in both.to_csv() and "snaps" in both.to_json()
