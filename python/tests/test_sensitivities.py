"""Exact derivatives: against differences of solves, forward against adjoint, and under their names."""

from __future__ import annotations

import numpy as np
import pytest

import hydrostat as hs

TIGHT = 1e-11


@pytest.fixture(scope="module")
def loaded() -> hs.Arm:
    """Everything acts at once; one cable runs through the points of a table, one is commanded."""
    changes = {
        "flow.direction": 50,
        "gravity.acceleration": 9.81,
        "tip.force": [1e-4, -2e-4],
        "arm.base.angle": 10,
        "cable[0].offset": [[0, 0.005], [0.1, 0.0035], [0.245, 0.001]],
        "cable[1].stroke": 0.002,
    }
    return hs.Arm.load("silicone").replace({"cable[0].tension": 0.15, "flow.speed": 0.1, **changes})


#: Parameters, the keys that change them, and how much of a unit a number of the key is.
CHANGES: dict[str, tuple[float, float]] = {
    "cable[0].tension": (5e-4, 1.0),
    "cable[1].stroke": (1e-5, 1.0),
    "cable[0].offset[1][1]": (1e-5, 1.0),
    "cable[1].offset.base": (1e-5, 1.0),
    "arm.radius.tip": (2e-6, 1.0),
    "arm.radius.base": (1e-5, 1.0),
    "arm.base.angle": (0.02, np.radians(1.0)),
    "flow.speed": (2e-4, 1.0),
    "flow.direction": (0.05, np.radians(1.0)),
    "tip.force[1]": (1e-6, 1.0),
    "material.young": (200.0, 1.0),
    "arm.density": (2.0, 1.0),
}


def value(arm: hs.Arm, key: str) -> float:
    """The number at a key of the written arm."""
    found: object = arm.to_dict()
    for step in key.replace("]", "").replace("[", ".").split("."):
        found = found[int(step)] if isinstance(found, list) else found[step]  # type: ignore[index]
    assert isinstance(found, (int, float))
    return float(found)


def moved(arm: hs.Arm, key: str, by: float) -> hs.Arm:
    """The arm with another number at a key; in a table or pair, by the whole of it."""
    whole = key.split("[1][1]")[0] if key.endswith("[1][1]") else key.removesuffix("[1]")
    if whole == key:
        return arm.replace({key: value(arm, key) + by})
    table = arm.to_dict()
    list_at = table["cable"][0]["offset"] if key.startswith("cable") else table["tip"]["force"]
    if key.endswith("[1][1]"):
        list_at[1][1] += by
    else:
        list_at[1] += by
    return arm.replace({whole: list_at})


def numbers(arm: hs.Arm, stations: list[float]) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """In the order of `Sensitivities.quantities`."""
    shape = arm.solve(tol=TIGHT)
    at = shape.at(stations)
    poses = np.stack([at.x, at.y, at.theta, at.alpha], axis=1).ravel()
    cables = shape.cables
    return np.concatenate([shape.tip, [c.stroke for c in cables], [c.tension for c in cables], poses])


def test_they_are_limits_of_differences(loaded: hs.Arm) -> None:
    stations = [0.08, 0.19]
    found = loaded.sensitivities(list(CHANGES), stations=stations, tol=TIGHT)
    jacobian = found.jacobian()
    assert jacobian.shape == (len(found.quantities), len(CHANGES)) == (4 + 2 + 2 + 8, len(CHANGES))
    for column, (key, (step, unit)) in zip(jacobian.T, CHANGES.items(), strict=True):
        # To the fourth order.
        one, two = (
            (numbers(moved(loaded, key, h), stations) - numbers(moved(loaded, key, -h), stations)) / (2.0 * h * unit)
            for h in (step, 2.0 * step)
        )
        want = (4.0 * one - two) / 3.0
        scale = np.abs(want).max()
        assert np.abs(want - column).max() < 2e-5 * scale, (key, want, column)


def test_forward_and_adjoint_agree(loaded: hs.Arm) -> None:
    stations = np.linspace(0.05, 0.24, 5)
    forward, adjoint = (
        loaded.sensitivities(stations=stations, method=method).jacobian() for method in ("forward", "adjoint")
    )
    assert np.abs(forward - adjoint).max() < 1e-11 * np.abs(forward).max()
    assert (np.abs(forward - adjoint) <= 1e-10 * np.abs(forward).max(axis=0)).all()


def test_gradient_is_the_chain_rule(loaded: hs.Arm) -> None:
    stations = np.linspace(0.05, loaded.length, 5)
    solver = hs.Solver(loaded)
    found = solver.sensitivities(stations=stations, method="forward")
    x, y, theta = np.random.default_rng(3).normal(size=(3, 5))
    gradient = solver.gradient(found.parameters, stations, x=x, y=y, theta=theta, alpha=0.1)
    poses = found.poses
    want = x @ poses.x + y @ poses.y + theta @ poses.theta + 0.1 * poses.alpha.sum(axis=0)
    size = abs(x) @ abs(poses.x) + abs(y) @ abs(poses.y) + abs(theta) @ abs(poses.theta) + 0.1 * abs(poses.alpha).sum(axis=0)
    assert (abs(gradient - want) <= 1e-10 * size).all()


def test_names_and_axes(loaded: hs.Arm) -> None:
    found = loaded.sensitivities(stations=[0.1, 0.2])
    assert "cable[0].tension" in found.parameters and "cable[1].stroke" in found.parameters
    assert found.units[found.index("flow.direction")] == "rad"
    dataset = found.to_xarray()
    assert dict(dataset.sizes) == {"parameter": len(found.parameters), "cable": 2, "s": 2}
    chosen = dataset.y.sel(s=0.2, parameter="arm.radius.tip").item()
    assert chosen == found.poses.y[1, found.index("arm.radius.tip")]
    assert chosen == found.jacobian(["station[1].y"], ["arm.radius.tip"]).item()
    assert dataset.unit.sel(parameter="material.young").item() == "Pa"
    # Where the cable is given its tension, that is itself.
    assert found.tensions[0, found.index("cable[0].tension")] == 1.0
    tip = found.solution.tip
    assert np.hypot(tip.x - loaded.solve().tip.x, tip.y - loaded.solve().tip.y) < 1e-8 * loaded.length


def test_compliance_of_a_cantilever() -> None:
    """L^3/3EI + L/GA, L^2/2EI, L/EI and L/EA."""
    length, radius, young, poisson = 0.3, 0.01, 2e5, 0.3
    arm = hs.Arm(arm={"length": length, "radius": radius}, material={"young": young, "poisson": poisson})
    area = np.pi * radius**2
    ei, ga = young * area * radius**2 / 4, young / (2 * (1 + poisson)) * area
    compliance = arm.sensitivities(["tip.force[0]", "tip.force[1]", "tip.moment"]).compliance()
    sway, turn = length**3 / (3 * ei) + length / ga, length**2 / (2 * ei)
    want = np.array([[length / (young * area), 0, 0], [0, sway, turn], [0, turn, length / ei]])
    assert compliance is not None and np.allclose(compliance, want, rtol=1e-11, atol=1e-12)
    assert arm.sensitivities(["tip.moment"]).compliance() is None


def test_manipulability_is_the_image_of_the_unit_circle(silicone: hs.Arm) -> None:
    arm = silicone.replace(tensions=[0.2, 0.05])
    pulls = ["cable[0].tension", "cable[1].tension"]
    found = arm.sensitivities()
    ellipse = found.manipulability()
    jacobian = found.tip_jacobian(pulls)
    assert ellipse is not None and ellipse == hs.Ellipse.of(jacobian)
    left, sizes, _ = np.linalg.svd(jacobian)
    assert np.allclose(ellipse.half_axes, sizes, rtol=1e-12)
    direction = np.array([np.cos(ellipse.direction), np.sin(ellipse.direction)])
    assert abs(abs(direction @ left[:, 0]) - 1.0) < 1e-12
    # Every point of it is of a unit effort.
    effort = np.linalg.solve(jacobian, ellipse.points(31).T)
    assert np.allclose(np.linalg.norm(effort, axis=0), 1.0, rtol=1e-9)
    assert arm.sensitivities(["flow.speed"]).manipulability() is None


def test_a_solver_is_differentiated_as_its_loads_change(silicone: hs.Arm) -> None:
    solver = hs.Solver(silicone.replace(tensions=[0.2, 0.05]))
    before = solver.update().tip
    slope = solver.sensitivities(["cable[0].tension"]).tip
    solver.set_tensions([0.2005, 0.05])
    after = solver.update().tip
    middle = 0.5 * (slope.y[0] + solver.sensitivities(["cable[0].tension"]).tip.y[0])
    assert after.y - before.y == pytest.approx(5e-4 * middle, rel=1e-5)
    # A command takes the place of a tension.
    solver.set_stroke(0, 0.01)
    assert "cable[0].stroke" in solver.sensitivities().parameters
