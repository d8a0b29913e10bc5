"""Drawings on matplotlib's axes show what they should."""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.patches import Polygon
from PIL import Image

import hydrostat as hs


def lines(ax: Axes) -> list[np.ndarray[tuple[int, ...], np.dtype[np.float64]]]:
    return [np.asarray(line.get_xydata(), dtype=np.float64) for line in ax.get_lines()]


def test_shape(silicone: hs.Arm) -> None:
    solution = silicone.solve(tensions=[0.2, 0.0], flow_speed=0.1)
    ax = solution.plot(sections=11, label="bent")
    (body,) = [patch for patch in ax.patches if isinstance(patch, Polygon)]
    outline = np.asarray(body.get_xy())
    s = np.linspace(0.0, silicone.length, 240)
    left, right = solution.surfaces(s)
    assert np.allclose(outline[:240], 1e3 * left) and np.allclose(outline[240:480], 1e3 * right[::-1])
    drawn = lines(ax)
    # Sections, the centreline, two cables, the base.
    assert len(drawn) == 11 + 1 + 2 + 1
    assert any(np.allclose(line, 1e3 * solution.cable_path(0, s)) for line in drawn if line.shape == (240, 2))
    assert ax.get_aspect() == 1.0
    assert any("0.1 m/s" in text.get_text() for text in ax.texts)
    assert ax.get_legend_handles_labels()[1] == ["bent"]
    bare = silicone.solve().plot(plt.subplots()[1], sections=0, cables=False)
    assert len(lines(bare)) == 2 and not bare.texts
    plt.close("all")


def test_units_of_axes(silicone: hs.Arm) -> None:
    solution = silicone.solve(tensions=[0.2, 0.0])
    ax = solution.plot(unit="m", sections=0, cables=False)
    assert ax.get_xlabel() == "x (m)"
    solution.plot(ax, sections=0, cables=False)
    first, second = (np.asarray(patch.get_xy()) for patch in ax.patches if isinstance(patch, Polygon))
    assert np.allclose(first, second) and np.abs(first).max() < silicone.length * 1.1
    with pytest.raises(ValueError, match="^unit: expected one of mm, cm, m"):
        solution.plot(unit="inch")
    reach = silicone.reach((0.182, 0.078), max_tension=0.6)
    mark = next(line for line in reach.plot(ax).get_lines() if line.get_marker() == "+")
    assert tuple(np.asarray(mark.get_xydata())[0]) == pytest.approx((0.182, 0.078))
    plt.close("all")


def test_animations(silicone: hs.Arm, tmp_path: Path) -> None:
    shapes = [silicone.solve(tensions=[pull, 0.0]) for pull in (0.0, 0.1, 0.2)]
    film = hs.animate(shapes, tmp_path / "bend.gif", sections=0)
    with Image.open(film) as image:  # type: ignore[arg-type]
        assert getattr(image, "n_frames", 1) == 3
    page = hs.animate(shapes[:2], tmp_path / "bend.html", sections=0)
    assert "<script" in Path(str(page)).read_text(encoding="utf-8")
    with pytest.raises(ValueError, match="^output: "):
        hs.animate(shapes, tmp_path / "bend.avi")
    with pytest.raises(ValueError, match="^solutions: "):
        hs.animate([])
    assert not plt.get_fignums()


def test_strains(silicone: hs.Arm) -> None:
    figure = silicone.solve(tensions=[0.1, 0.0]).plot_strains(label="0.1 N")
    solution = silicone.solve(tensions=[0.2, 0.0])
    assert solution.plot_strains(label="0.2 N", figure=figure) is figure
    stretch, _, _, alpha = figure.axes
    assert np.allclose(lines(stretch)[1][:, 1], solution.resampled(240).nu)
    assert np.allclose(lines(alpha)[1][:, 1], np.degrees(solution.resampled(240).alpha))
    plt.close("all")


def test_another_unit_converts_what_is_drawn(silicone: hs.Arm) -> None:
    solution = silicone.solve(tensions=[0.2, 0.0], flow_speed=0.02)
    ax, alone = solution.plot(), solution.plot(unit="m")
    solution.plot(ax, unit="m")
    assert ax.get_xlabel() == "x (m)" and ax.get_xlim() == pytest.approx(alone.get_xlim())
    first, second = (np.asarray(patch.get_xy()) for patch in ax.patches if isinstance(patch, Polygon))
    assert np.allclose(first, second, rtol=1e-12)
    half = len(ax.lines) // 2
    assert all(np.allclose(a.get_xydata(), b.get_xydata(), equal_nan=True) for a, b in zip(ax.lines[:half], ax.lines[half:], strict=True))
    scattered = plt.subplots()[1]
    scattered.scatter([0.1], [0.1])
    scattered.set_xlabel("x (m)")
    with pytest.raises(ValueError, match="^unit: these axes have another one"):
        solution.plot(scattered, unit="mm")
    plt.close("all")


def test_the_label_of_an_axis_says_its_unit(silicone: hs.Arm) -> None:
    """An axis that was labelled by others was drawn on in mm, and labelled anew."""
    ax = plt.subplots()[1]
    ax.plot([0.0, 0.2], [0.0, 0.1])
    ax.set_xlabel("x (m)")
    silicone.solve(tensions=[0.2, 0.0]).plot(ax)
    assert ax.get_xlabel() == "x (m)" and np.abs(np.asarray(ax.patches[0].get_xy())).max() < 1.0  # type: ignore[attr-defined]
    plt.close("all")


def test_animations_say_what_they_need(silicone: hs.Arm, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("PIL")
    solution = silicone.solve(tensions=[0.2, 0.0])
    assert hs.animate([solution], tmp_path / "film.GIF", sections=0) == tmp_path / "film.GIF"
    with pytest.raises(ValueError, match="^solutions: expected a list of solutions, found one"):
        hs.animate(solution)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="^fps: expected a number above zero, found '20'"):
        hs.animate([solution], tmp_path / "film.gif", fps="20")  # type: ignore[arg-type]
    with monkeypatch.context() as patched:
        patched.setattr("matplotlib.animation.FFMpegWriter.isAvailable", lambda: False)
        with pytest.raises(FileNotFoundError, match="^output: .mp4 needs the program ffmpeg"):
            hs.animate([solution], tmp_path / "film.mp4")
    assert solution.figure().save(tmp_path / "shape.SVG").read_text(encoding="utf-8").startswith("<svg")
    plt.close("all")


def test_reach_and_manipulability(silicone: hs.Arm) -> None:
    found = silicone.reach(hs.Target(0.182, 0.078, angle="1 rad"), max_tension=0.6)
    ax = found.plot()
    assert len(ax.patches) == max(len(found), 1)
    marks = [line for line in ax.get_lines() if line.get_marker() == "+"]
    assert [tuple(np.asarray(mark.get_xydata())[0]) for mark in marks] == [(182.0, 78.0)]
    two = silicone.replace(tensions=[0.2, 0.05]).sensitivities(["cable[0].tension", "cable[1].tension"])
    drawn = lines(two.plot_manipulability(effort=0.01))
    ellipse = two.manipulability()
    tip = two.solution.tip
    assert ellipse is not None
    want = 1e3 * (np.array([tip.x, tip.y]) + 0.01 * ellipse.points())
    assert any(np.allclose(line, want) for line in drawn if line.shape == want.shape)
    plt.close("all")


def test_paths_and_equilibria(facing: hs.Arm) -> None:
    path = facing.path("arm.base.angle", 90, -90)
    ax = path.plot("tip_theta")
    whole, solid, *events = lines(ax)
    assert np.allclose(whole[:, 1], np.degrees(path.branches[0].tip_theta))
    unstable = np.array([state == "unstable" for state in path.branches[0].stability])
    assert np.isnan(solid[unstable, 1]).all() and len(events) == 4
    with pytest.raises(ValueError, match="quantity"):
        path.plot("tip_w")
    ax = facing.equilibria().plot()
    assert len(ax.patches) == 5
    plt.close("all")
