"""Arms in space: the calls are those of arms in the plane, the answers have three components."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest

import hydrostat as hs
from hydrostat import spatial


@pytest.fixture(scope="module")
def arm() -> hs.Arm:
    return hs.Arm.load("silicone-spatial").replace({"flow.speed": 0.05, "flow.direction": [0, 0, 1]})


@pytest.fixture(scope="module")
def solution(arm: hs.Arm) -> hs.SpatialSolution:
    found = arm.solve()
    assert isinstance(found, hs.SpatialSolution)
    return found


def test_a_solution_has_three_components(arm: hs.Arm, solution: hs.SpatialSolution) -> None:
    assert arm.is_spatial and not hs.Arm.load("silicone").is_spatial
    n = len(solution)
    for name in spatial.FIELDS:
        array = getattr(solution, name)
        assert array.shape == ((n, 3) if name in "abc" else (n,)), name
        assert not array.flags.writeable and array.dtype == np.float64
    assert np.allclose(np.cross(solution.a, solution.b), solution.c, atol=1e-9)
    tip = solution.tip
    assert (tip.x, tip.y, tip.z, tip.alpha) == (solution.x[-1], solution.y[-1], solution.z[-1], solution.alpha[-1])
    assert tip.a == tuple(solution.a[-1]) and tip.y > 0 and tip.z > 0
    assert len(solution.base_reaction.force) == 3
    assert solution.unmet is None and solution.stable and solution.unstable_directions == 0
    assert 0 < solution.error_estimate < 1e-8 * arm.length
    assert [cable.name for cable in solution.cables] == ["top", "left", "right"]
    assert not solution.warnings and not solution.snaps and solution.growth() is not None
    assert repr(solution).startswith("<SpatialSolution of 'silicone-spatial': tip at (")
    assert "mm" in solution._repr_html_() and "<polygon" in solution._repr_html_()
    assert '"space":"spatial"' in solution.to_json().replace(" ", "")
    assert solution.to_csv().splitlines()[0].startswith("s_m,x_m,y_m,z_m,a_x")


def test_places_between_stations(arm: hs.Arm, solution: hs.SpatialSolution) -> None:
    stations = solution.at([0.0, 0.1, arm.length])
    assert isinstance(stations, hs.SpatialStations) and stations.b.shape == (3, 3)
    assert stations.z[-1] == pytest.approx(solution.z[-1], abs=1e-12)
    assert len(solution.resampled(7)) == 7
    rings = solution.surface(stations.s, sides=8)
    centre = np.stack([stations.x, stations.y, stations.z], axis=1)
    off = np.linalg.norm(rings - centre[:, None], axis=2)
    assert np.allclose(off, off[:, :1]) and off[0, 0] == pytest.approx(stations.beta[0] * 0.010)
    path = solution.cable_path(0, stations.s)
    assert path.shape == (3, 3) and np.allclose(path[0] - centre[0], stations.beta[0] * 0.005 * stations.b[0])
    with pytest.raises(ValueError, match="^s: expected places in"):
        solution.at(-1.0)
    for name in ("theta", "m"):
        with pytest.raises(AttributeError, match='space = "spatial"'):
            getattr(solution, name)
    with pytest.raises(AttributeError, match='space = "spatial"'):
        solution.surfaces([0.0])


@pytest.mark.filterwarnings("ignore::hydrostat.ModelWarning")
def test_a_planar_arm_in_space_has_its_planar_shape() -> None:
    plane = hs.Arm.load("silicone").replace(tensions=[0.3, 0.0], flow_speed=0.1)
    flat, space = plane.solve(), plane.replace({"arm.space": "spatial"}).solve()
    assert isinstance(space, hs.SpatialSolution)
    assert (space.tip.x, space.tip.y) == pytest.approx((flat.tip.x, flat.tip.y), abs=1e-9)
    assert abs(space.tip.z) < 1e-12 and space != flat


def test_what_is_kept_comes_back(solution: hs.SpatialSolution, tmp_path: Path) -> None:
    assert copy.copy(solution) is solution
    restored = pickle.loads(pickle.dumps(solution))
    assert isinstance(restored, hs.SpatialSolution) and restored == solution and restored.tip == solution.tip
    assert restored.stability == "stable" and restored.at(0.1).z[0] == solution.at(0.1).z[0]
    again = pickle.loads(pickle.dumps(restored))
    assert again == solution
    stations = solution.at([0.0, 0.2])
    assert pickle.loads(pickle.dumps(stations)) == stations
    loaded = hs.load(solution.save(tmp_path / "arm.nc"))
    assert isinstance(loaded, hs.SpatialSolution) and loaded == solution


def test_tables(solution: hs.SpatialSolution) -> None:
    frame = solution.to_pandas()
    assert {"z", "a_x", "c_z", "kappa", "m_c"} <= set(frame.columns) and "a" not in frame
    dataset = solution.to_xarray()
    assert dataset["a"].dims == ("s", "axis") and dataset["z"].attrs["units"] == "m"
    assert list(dataset["cable"].values) == ["top", "left", "right"]
    assert len(dataset.attrs["base_force"]) == len(dataset.attrs["base_moment"]) == 3
    assert solution.at([0.0, 0.1]).to_xarray()["b"].shape == (2, 3)


def test_a_verdict_has_the_last_good_shape(arm: hs.Arm) -> None:
    with pytest.raises(hs.CableFoldError) as caught:
        arm.solve(tensions=[1.4, 0, 0])
    assert caught.value.phase == "tension" and isinstance(caught.value.last_good, hs.SpatialSolution)
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.last_good == caught.value.last_good and again.load_fraction == caught.value.load_fraction


def test_a_solver_goes_on(arm: hs.Arm) -> None:
    solver = hs.Solver(arm)
    first = solver.solve()
    solver.set_tensions([0.11, 0.05, 0])
    tip, estimate = solver.update()
    assert isinstance(tip, hs.SpatialTip) and 0 < estimate < 1e-8 * arm.length
    assert tip.y > first.tip.y
    assert isinstance(solver.solution(), hs.SpatialSolution) and list(solver.tensions) == [0.11, 0.05, 0]
    other = copy.copy(solver)
    other.set_flow_speed(0.0)
    assert other.solution().tip.z < tip.z
    solver.set_stroke(0, 0.004)
    held = solver.solve()
    assert held.cables[0].stroke == pytest.approx(0.004, abs=1e-9) and held.cables[0].tension > 0
    assert held.tip.y == pytest.approx(arm.solve(strokes=[0.004, None, None]).tip.y, abs=1e-9)
    solver.set_tensions([0.11, 0.05, 0])
    assert solver.solve().tip.y == pytest.approx(tip.y, abs=1e-8)
    with pytest.raises(ValueError, match="index"):
        solver.set_stroke(7, 0.01)


def test_derivatives_are_those_of_differences(arm: hs.Arm) -> None:
    solver = hs.Solver(arm, tol=1e-10)
    names = ["cable[0].tension", "flow.direction[2]", "tip.force[2]"]
    found = solver.sensitivities(names, stations=[0.1])
    assert isinstance(found, hs.SpatialSensitivities) and isinstance(found.solution, hs.SpatialSolution)
    assert found.parameters == tuple(names) and found.tip.z.shape == (3,) and found.poses.turn_x.shape == (1, 3)
    step = 1e-4
    tensions = np.array(solver.tensions)
    tips: list[Any] = [arm.solve(tensions=tensions + [by, 0, 0], tol=1e-11).tip for by in (-step, step)]
    for axis in "xyz":
        difference = (getattr(tips[1], axis) - getattr(tips[0], axis)) / (2 * step)
        assert getattr(found.tip, axis)[0] == pytest.approx(difference, rel=1e-5, abs=1e-6)
    turn = np.array([found.tip.turn_x[0], found.tip.turn_y[0], found.tip.turn_z[0]])
    difference = (np.array(tips[1].a) - np.array(tips[0].a)) / (2 * step)
    assert np.allclose(np.cross(turn, found.solution.a[-1]), difference, rtol=1e-4, atol=1e-6)
    assert found.tip_jacobian(names).shape == (3, 3) and found.compliance() is None
    ellipsoid = found.manipulability()
    assert ellipsoid is not None and ellipsoid.half_axes[0] >= ellipsoid.half_axes[1] >= ellipsoid.half_axes[2]
    assert pickle.loads(pickle.dumps(found)) == found
    gradient = solver.gradient(names, [arm.length], z=2.0, turn=[0.0, 1.0, 0.0])
    assert np.allclose(gradient, 2.0 * found.tip.z + found.tip.turn_y, rtol=1e-6)
    with pytest.raises(ValueError, match="theta"):
        solver.gradient(names, [0.1], theta=1.0)
    with pytest.raises(ValueError, match="in the plane"):
        found.plot_manipulability()


def test_a_path_varies_a_part_of_a_direction(arm: hs.Arm) -> None:
    path = arm.path("flow.direction[1]", -1, 1)
    branch = path.branches[0]
    assert branch.end == "reached_end" and set(branch.stability) == {"stable"}
    assert isinstance(branch[0], hs.SpatialSolution) and branch[-1].tip[2] == branch.tip_z[-1]
    assert np.all(np.isnan(branch.tip_theta)) and "tip_z" in path.to_pandas()
    assert pickle.loads(pickle.dumps(path)) == path
    assert "tip_z_m" in path.to_csv() and len(path.plot("tip_z").lines) > 0
    with pytest.raises(ValueError, match="tip.theta"):
        path.figure("tip.theta")


def test_places_in_space_are_reached(arm: hs.Arm) -> None:
    pulled: Any = arm.solve(tensions=[0.12, 0.03, 0.07])
    target = (pulled.tip.x, pulled.tip.y, pulled.tip.z)
    found = arm.reach(target, max_tension=0.5, find_all=False)
    assert isinstance(found[0].solution, hs.SpatialSolution) and found.targets == (hs.SpatialTarget(*target),)
    assert np.allclose(found[0].tensions, [0.12, 0.03, 0.07], atol=1e-4)
    place = pulled.at(0.15)
    there = hs.SpatialTarget(place.x.item(), place.y.item(), place.z.item(), s=0.15)
    along = arm.reach(there, max_tension=0.5, find_all=False)
    places: Any = along[0].places
    assert places.z[0] == pytest.approx(place.z.item(), abs=1e-7)
    missed = arm.reach((0.4, 0, 0), max_tension=0.5, find_all=False)
    assert len(missed) == 0 and missed.closest is not None and missed.closest.distance > 0.1
    assert pickle.loads(pickle.dumps(found)) == found
    with pytest.raises(ValueError, match=r"\(x, y, z\)"):
        arm.reach((0.2, 0.05))


def test_commanded_strokes_take_the_tensions_that_make_them(arm: hs.Arm) -> None:
    pulled = arm.solve(tensions=[0.11, 0.05, 0.02])
    held = arm.solve(strokes=[cable.stroke for cable in pulled.cables])
    assert isinstance(pulled, hs.SpatialSolution) and isinstance(held, hs.SpatialSolution)
    assert abs(held.tip.x - pulled.tip.x) + abs(held.tip.z - pulled.tip.z) < 1e-7 * arm.length


def test_equilibria_in_space_hold_those_of_the_plane() -> None:
    planar = hs.Arm.load("silicone").replace(flow_speed=0.2, flow_direction=175)
    found = planar.replace({"arm": {"space": "spatial"}}).equilibria()
    assert not found.complete and not found.misses_some and found.tip_angles is None
    tips = np.array([(one.tip.x, one.tip.y) for one in found])
    for one in planar.equilibria():
        assert np.hypot(*(tips - (one.tip.x, one.tip.y)).T).min() < 1e-7 * planar.length
    again = pickle.loads(pickle.dumps(found))
    assert again == found and isinstance(again[0], hs.SpatialSolution)
    assert "z (mm)" in found.figure().texts()
    assert found.plot().name == "3d"


def test_what_is_for_arms_in_the_plane_says_so(arm: hs.Arm, solution: hs.SpatialSolution) -> None:
    calls: list[Any] = [
        lambda: arm.path("flow.speed", 0, 0.1).shapes_figure(),
        lambda: arm.reachable(max_tension=0.2),
    ]
    for call in calls:
        with pytest.raises(ValueError, match="space"):
            call()


def test_sweeps(arm: hs.Arm) -> None:
    swept = hs.sweep(arm, {"cable[0].tension": [0.0, 0.2, 1.4], "flow.direction[2]": [-1.0, 1.0]}, shapes=3)
    assert swept["tip_z"].shape == (3, 2) and swept["tip_z"].attrs["units"] == "m"
    assert float(swept["tip_z"][1, 0]) < float(swept["tip_z"][1, 1])
    assert swept["verdict"].values[2].tolist() == ["cable_fold", "cable_fold"]
    assert swept["shape_a_x"].dims[-1] == "station" and swept["base_moment_x"].attrs["units"] == "N m"
    solved = arm.replace({"flow.direction[2]": -1.0}).solve(tensions=[0.2, 0.05, 0.0], tol=1e-6)
    assert isinstance(solved, hs.SpatialSolution)
    assert float(swept["tip_z"][1, 0]) == pytest.approx(solved.z[-1], abs=1e-12)
    assert "z (mm)" in hs.workspace_figure(swept).texts()


def test_drawings(solution: hs.SpatialSolution) -> None:
    texts = solution.figure("a note").texts()
    assert {"a note", "z (mm)", "stream 0.05 m/s"} <= set(texts)
    ax: Any = solution.plot(label="bent", sections=5)
    assert ax.name == "3d" and [ax.get_xlabel(), ax.get_zlabel()] == ["x (mm)", "z (mm)"]
    assert ax.get_legend_handles_labels()[1] == ["bent"]
    # Sections, the centreline, three cables, and what stands for the surface in the legend.
    assert len(ax.get_lines()) == 5 + 1 + 3 + 1
    assert any("0.05 m/s" in text.get_text() for text in ax.texts)
    with pytest.raises(ValueError, match="three dimensions"):
        solution.plot(plt.subplots()[1])
    figure = solution.plot_strains(label="bent")
    assert [len(panel.get_lines()) for panel in figure.axes] == [1, 2, 3, 1]
    plt.close("all")
