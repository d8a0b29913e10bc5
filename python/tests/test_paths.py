"""Paths, equilibria, and figures of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import hydrostat as hs


@pytest.fixture(scope="module")
def snapping(facing: hs.Arm) -> hs.Path:
    return facing.path("arm.base.angle", 90, "-90 deg")


def test_a_path_through_limit_points(snapping: hs.Path) -> None:
    (branch,) = snapping.branches
    assert (snapping.parameter, snapping.unit, snapping.range) == ("arm.base.angle", "deg", (90.0, -90.0))
    assert [event.name for event in branch.events] == ["limit_point"] * 4
    # The parameter turns back at each of them.
    for event in branch.events:
        before, here, after = branch.values[event.point - 1 : event.point + 2]
        assert (here - before) * (after - here) < 0
        assert event.value == here
    assert branch.end == "reached_end" and branch.values[-1] == pytest.approx(-90.0)
    assert {"stable", "unstable"} <= set(branch.stability)
    # Points are solutions at their own values.
    assert len(branch) == len(branch.values) == len(list(branch))
    for point in (0, 20, -1):
        solution = branch[point]
        assert solution.tip.x == branch.tip_x[point] and solution.tip.theta == branch.tip_theta[point]
        assert solution.arm.to_dict()["arm"]["base"]["angle"] == pytest.approx(branch.values[point])
    with pytest.raises(IndexError):
        branch[len(branch)]
    frame = snapping.to_pandas()
    assert len(frame) == len(branch) and (frame["event"] == "limit_point").sum() == 4


def test_bifurcating_column() -> None:
    """A straight column buckles at P (1 + P (1/GA - 1/EA)) = pi^2 EI / (4 L^2), and branches leave there."""
    radius, length, young = 0.01, 0.5, 1e6
    arm = hs.Arm(
        arm={"length": length, "radius": radius},
        material={"young": young, "poisson": 0.5},
        model={"volume": "none"},
    )
    area = np.pi * radius**2
    ea, ga, ei = young * area, young / 3 * area, young * area * radius**2 / 4
    euler = np.pi**2 * ei / (4 * length**2)
    slope = 1 / ga - 1 / ea
    buckling = (np.sqrt(1 + 4 * slope * euler) - 1) / (2 * slope)
    path = arm.path("tip.force[0]", 0, -1.5 * buckling, branches=True)
    events = [event for event in path.branches[0].events if event.name == "bifurcation"]
    assert [event.value for event in events] == pytest.approx([-buckling], rel=1e-5)
    assert len(path.branches) > 1 and path.branches[1].switched_at == pytest.approx(-buckling, rel=1e-5)


def test_all_equilibria(facing: hs.Arm) -> None:
    found = facing.equilibria()
    assert found.complete and len(found) == 5
    assert found.stability == ("stable", "unstable", "stable", "unstable", "stable")
    thetas = [solution.tip.theta for solution in found]
    assert thetas == sorted(thetas)
    # A mirror image of each is there, too.
    assert np.allclose(thetas, [-theta for theta in reversed(thetas)], atol=1e-7)
    assert found[-1].tip == found[4].tip and [s.tip for s in found[1:3]] == [found[1].tip, found[2].tip]
    part = facing.equilibria(time_limit=0.0)
    assert not part.complete


def test_figures_of_the_library(tmp_path: Path, facing: hs.Arm, snapping: hs.Path) -> None:
    found = facing.equilibria()
    one = hs.sweep(facing, {"cable[0].tension": [0.0, 0.1]})
    two = hs.sweep(facing, {"flow.speed": [0.0, 0.05], "cable[0].tension": "0:0.1:3"})
    figures = {
        "arm": (hs.arm_figure(found[0], "a note"), "a note"),
        "path": (hs.path_figure(snapping, "tip.theta"), "equilibria over arm.base.angle"),
        "shapes": (hs.path_shapes_figure(snapping, "shapes"), "shapes"),
        "equilibria": (hs.equilibria_figure(found, "five"), "five"),
        "over": (hs.over_figure({0.2: found}, "speed", "m/s"), "speed (m/s)"),
        "map": (hs.map_figure(two, "tip_y", "a map"), "a map"),
        "workspace": (hs.workspace_figure(two), "x (mm)"),
        "curve": (hs.curve_figure(one, "tip_theta"), "cable[0].tension (N)"),
    }
    for name, (figure, text) in figures.items():
        assert text in figure.texts(), (name, figure.texts())
        assert figure.save(tmp_path / f"{name}.svg").read_text(encoding="utf-8").startswith("<svg")
        assert figure.save(tmp_path / f"{name}.png").read_bytes()[:4] == b"\x89PNG"
        assert figure.save(tmp_path / f"{name}.pdf").read_bytes().startswith(b"%PDF-")
        assert "<text" in figure.svg(text=True) and "<text" not in figure.svg()
    with pytest.raises(ValueError, match="quantity"):
        hs.path_figure(snapping, "tip.z")
    with pytest.raises(ValueError, match="quantity"):
        hs.map_figure(two, "tip_z")
    with pytest.raises(ValueError, match="2 key"):
        hs.map_figure(one)


def test_the_source_figure() -> None:
    figures, claims = hs.source_figures(hs.Arm.load("paper"))
    assert list(figures) == ["fig1a", "fig1b", "fig1c"]
    assert all(finding in {"holds", "holds in part", "does not hold", "cannot be decided"} for _, finding, _ in claims)
    with pytest.raises(ValueError, match="no cable"):
        hs.source_figures(hs.Arm(arm={"length": 0.1, "radius": 0.01}, material={"young": 1e5}))
    with pytest.raises(ValueError, match=r"expected rising speeds above 0\.5 m/s"):
        hs.source_figures(hs.Arm.load("paper"), faster=[0.2])
    _, claims = hs.source_figures(hs.Arm.load("paper-statements"), at_highest=True, faster=[1.0])
    assert [finding for _, finding, _ in claims[:8]] == ["holds"] * 8


def test_names_of_quantities_in_both_spellings(facing: hs.Arm) -> None:
    pytest.importorskip("matplotlib")
    path = facing.path("cable[0].tension", 0.0, 0.05)
    for quantity in ("tip.x", "tip.y", "tip.theta", "tip.alpha", "stroke[0]"):
        spelled = quantity.replace(".", "_").replace("[", "_").replace("]", "")
        assert path.figure(quantity).svg() == path.figure(spelled).svg()
        if quantity.startswith("tip"):
            drawn, again = (path.plot(name).get_lines()[0].get_xydata() for name in (quantity, spelled))
            assert np.array_equal(np.asarray(drawn), np.asarray(again))
    with pytest.raises(ValueError, match="^quantity: expected one of tip_x, tip_y, tip_z, tip_theta, tip_alpha, found 'tip.w'"):
        path.plot("tip.w")
