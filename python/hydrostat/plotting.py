"""Drawings on matplotlib's axes."""

from __future__ import annotations

import re
from collections.abc import Iterable
from os import PathLike
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np

from hydrostat import _inputs

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.typing import ColorType
    from numpy.typing import NDArray

    from hydrostat.identification import Fit
    from hydrostat.paths import Equilibria, EquilibriumPath
    from hydrostat.reach import Reach
    from hydrostat.sensitivity import Sensitivities
    from hydrostat.solution import Solution

MM = 1e3
INK = "#28323c"
WATER = "#4a90b8"
_POINTS = 240
TAUT = "#1f3b57"
SLACK = "#8a97a3"
_BODY = "#d9734e"
_MARK = "#c0392b"


def _new_axes(ax: Axes | None) -> Axes:
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    return plt.subplots(figsize=(6.4, 4.2), layout="constrained")[1]


#: How many of a unit of length a metre is.
UNITS = {"mm": 1e3, "cm": 1e2, "m": 1.0}
#: The units of axes on which shapes were drawn.
_DRAWN: WeakKeyDictionary[Axes, str] = WeakKeyDictionary()


_UNIT = re.compile(r"[(\[](mm|cm|m)[)\]]\s*$")


def unit_of(ax: Axes, unit: str | None) -> str:
    """The unit of an axis: what was drawn there before decides, or what its label says; another one converts it."""
    if unit is not None and unit not in UNITS:
        raise ValueError(f"unit: expected one of {', '.join(UNITS)}, found {unit!r}")
    labelled = _UNIT.search(ax.get_xlabel())
    drawn = _DRAWN.get(ax) or (labelled[1] if labelled else None)
    if drawn is not None and unit not in (None, drawn):
        _convert(ax, UNITS[unit] / UNITS[drawn])
        drawn = unit
    _DRAWN[ax] = drawn or unit or "mm"
    return _DRAWN[ax]


def _convert(ax: Axes, factor: float) -> None:
    """Draw what is on an axis in another unit."""
    from matplotlib.patches import Polygon
    from matplotlib.text import Annotation

    if ax.name == "3d" or ax.collections or ax.images:
        raise ValueError("unit: these axes have another one, and what is on them cannot be converted; expected that or none")
    for line in ax.lines:
        if line.get_transform() == ax.transData:
            line.set_data(*(factor * np.asarray(values) for values in line.get_data()))
    for patch in ax.patches:
        if isinstance(patch, Polygon):
            patch.set_xy(factor * np.asarray(patch.get_xy()))
    for text in ax.texts:
        if isinstance(text, Annotation) and text.xycoords == "data":
            text.xy = (factor * text.xy[0], factor * text.xy[1])
    ax.relim()
    ax.autoscale_view()


def plot_shape(
    solution: Solution,
    ax: Axes | None,
    *,
    color: ColorType,
    sections: int,
    cables: bool,
    flow: bool,
    label: str | None,
    unit: str | None = None,
) -> Axes:
    """See `Solution.plot`."""
    ax = _new_axes(ax)
    name = unit_of(ax, unit)
    per_m = UNITS[name]
    arm = solution.arm
    s = np.linspace(0.0, arm.length, _POINTS)
    left, right = (per_m * side for side in solution.surfaces(s))
    outline = np.concatenate([left, right[::-1]])
    ax.fill(outline[:, 0], outline[:, 1], facecolor=color, edgecolor=INK, linewidth=0.8, alpha=0.55, label=label, zorder=2)
    if sections > 0:
        at = np.linspace(0.0, arm.length, sections)
        for one, other in zip(*solution.surfaces(at), strict=True):
            ax.plot(*(per_m * np.stack([one, other])).T, color=INK, linewidth=0.4, alpha=0.6, zorder=3)
    line = solution.at(s)
    ax.plot(per_m * line.x, per_m * line.y, color=INK, linewidth=0.7, linestyle=(0, (6, 3)), zorder=3)
    if cables:
        for index, cable in enumerate(solution.cables):
            taut = cable.tension > 0.0
            points = per_m * solution.cable_path(index, s)
            style = {"color": TAUT, "linewidth": 1.8} if taut else {"color": SLACK, "linewidth": 0.9}
            ax.plot(points[:, 0], points[:, 1], zorder=4, **style)  # type: ignore[arg-type]
    base = per_m * np.stack([left[0], right[0]]) / per_m
    ax.plot(base[:, 0], base[:, 1], color=INK, linewidth=3.0, solid_capstyle="butt", zorder=5)
    # Axes that share their limits can only change their boxes.
    shared = any(len(group.get_siblings(ax)) > 1 for group in (ax.get_shared_x_axes(), ax.get_shared_y_axes()))
    ax.set_aspect("equal", adjustable="box" if shared else "datalim")
    ax.set_xlabel(f"x ({name})")
    ax.set_ylabel(f"y ({name})")
    if flow:
        _stream(solution, ax)
    return ax


def _stream(solution: Solution, ax: Axes) -> None:
    """Arrows of the stream in a corner that the arm leaves free, with its speed."""
    table = solution.arm.to_dict().get("flow", {})
    speed = float(table.get("speed", 0.0))
    if speed <= 0.0:
        return
    angle = radians(table.get("direction", 0.0))
    direction = np.array([np.cos(angle), np.sin(angle)])
    across = np.array([-direction[1], direction[0]])
    line = solution.at(np.linspace(0.0, solution.arm.length, 60))
    middle = 0.5 * np.array([line.x.min() + line.x.max(), line.y.min() + line.y.max()])
    corners = {(i, j): (0.13 + 0.74 * i, 0.12 + 0.76 * j) for i in (0, 1) for j in (0, 1)}
    taken = {corner: 0 for corner in corners}
    for x, y in zip(line.x - middle[0], line.y - middle[1], strict=True):
        taken[int(x > 0), int(y > 0)] += 1
    place = np.array(corners[min(taken, key=lambda corner: taken[corner])])
    for k in (-1.0, 0.0, 1.0):
        tail = place + 0.035 * k * across - 0.06 * direction
        arrow = {"arrowstyle": "-|>", "color": WATER, "linewidth": 1.3}
        head = tail + 0.12 * direction
        ax.annotate("", (head[0], head[1]), (tail[0], tail[1]), xycoords="axes fraction", arrowprops=arrow)
    words = f"{speed:g} m/s"
    ax.annotate(
        words, (place[0], place[1] - 0.085), xycoords="axes fraction", color=WATER, ha="center", va="center", size=9
    )


def radians(angle: object) -> float:
    """An angle of a written arm file: degrees, or a string with its unit."""
    if isinstance(angle, str):
        value, unit = angle.split()
        return float(value) if unit == "rad" else float(np.radians(float(value)))
    return float(np.radians(float(angle)))  # type: ignore[arg-type]


#: Field, title, factor and unit of each panel of strains.
_PANELS = (
    ("nu", "stretch", 1.0, r"$\nu$"),
    ("eta", "shear", 1.0, r"$\eta$"),
    ("mu", "bending", 1.0, r"$\mu$ (1/m)"),
    ("alpha", "angle of the section", 180.0 / np.pi, r"$\alpha$ (deg)"),
)


def plot_strains(solution: Solution, *, label: str | None, figure: Figure | None) -> Figure:
    """See `Solution.plot_strains`."""
    import matplotlib.pyplot as plt

    if figure is None:
        figure, _ = plt.subplots(2, 2, figsize=(7.2, 4.8), sharex=True, layout="constrained")
    stations = solution.resampled(_POINTS)
    for ax, (name, title, factor, text) in zip(figure.axes, _PANELS, strict=True):
        values = factor * getattr(stations, name)
        # What is constant but for rounding is drawn as a constant.
        if np.ptp(values) < 1e-9 * max(float(np.abs(values).max()), 1.0):
            values = np.full_like(values, values.mean())
        ax.plot(MM * stations.s, values, linewidth=1.6, label=label)
        ax.set_title(title, size=10, loc="left")
        ax.set_ylabel(text)
        ax.grid(alpha=0.25)
    for ax in figure.axes[2:]:
        ax.set_xlabel("s (mm)")
    if label is not None:
        figure.axes[0].legend(frameon=False, fontsize=9)
    return figure


_QUANTITIES = {
    "tip_x": (MM, "x of the tip (mm)"),
    "tip_y": (MM, "y of the tip (mm)"),
    "tip_z": (MM, "z of the tip (mm)"),
    "tip_theta": (180.0 / np.pi, "the tip's turn (deg)"),
    "tip_alpha": (180.0 / np.pi, r"$\alpha$ at the tip (deg)"),
}


def plot_path(path: EquilibriumPath, quantity: str, ax: Axes | None) -> Axes:
    """See `Path.plot`."""
    known = [name for name in _QUANTITIES if not (path._inner.in_space and name == "tip_theta")]
    name = quantity.replace("tip.", "tip_") if isinstance(quantity, str) else ""
    if name not in known:
        raise ValueError(f"quantity: expected one of {', '.join(known)}, found {quantity!r}")
    ax = _new_axes(ax)
    factor, words = _QUANTITIES[name]
    for branch in path.branches:
        values = factor * getattr(branch, name)
        stable = np.array([state == "stable" for state in branch.stability])
        # A piece between two points is stable where its points are; events are marginal and belong to both sides.
        event = np.zeros(len(branch), dtype=bool)
        event[[event.point for event in branch.events]] = True
        good = stable | event
        solid = np.where(good, values, np.nan)
        ax.plot(branch.values, values, color=SLACK, linewidth=1.2, linestyle=(0, (4, 2)))
        ax.plot(branch.values, solid, color=TAUT, linewidth=1.8)
        for one in branch.events:
            marker = {"limit_point": "o", "bifurcation": "D"}.get(one.name, "s")
            ax.plot(one.value, values[one.point], marker, color=_MARK, markersize=5)
    ax.set_xlabel(f"{path.parameter} ({path.unit})" if path.unit else path.parameter)
    ax.set_ylabel(words)
    ax.grid(alpha=0.25)
    return ax


def plot_equilibria(equilibria: Equilibria, ax: Axes | None) -> Axes:
    """See `Equilibria.plot`."""
    if equilibria._inner.in_space:
        from hydrostat.plotting_3d import plot_equilibria_in_space

        return plot_equilibria_in_space(equilibria, ax)
    ax = _new_axes(ax)
    per_m = UNITS[unit_of(ax, None)]
    for index, (solution, state) in enumerate(zip(equilibria, equilibria.stability, strict=True)):
        color = _BODY if state == "stable" else "#d8d2c4"
        name = f"{index + 1}: {state or 'not established'}"
        plot_shape(solution, ax, color=color, sections=0, cables=False, flow=index == 0, label=name)
        tip = solution.tip
        away = (9.0 * np.cos(tip.theta), 9.0 * np.sin(tip.theta))
        ax.annotate(
            str(index + 1), (per_m * tip.x, per_m * tip.y), away, textcoords="offset points", ha="center", va="center", size=9
        )
    ax.legend(frameon=False, fontsize=9)
    return ax


def plot_reach(reach: Reach, ax: Axes | None) -> Axes:
    """See `Reach.plot`."""
    import matplotlib.pyplot as plt

    from hydrostat.reach import Target

    targets = [target for target in reach.targets if isinstance(target, Target)]
    if len(targets) < len(reach.targets):
        raise ValueError("plot: of targets in the plane; the solutions of a search in space have `plot`")
    ax = _new_axes(ax)
    per_m = UNITS[unit_of(ax, None)]
    shown = [*reach] or [one for one in (reach.closest,) if one is not None]
    colors = plt.colormaps["viridis"](np.linspace(0.15, 0.85, max(len(shown), 2)))
    for index, (one, color) in enumerate(zip(shown, colors, strict=False)):
        pulls = ", ".join(f"{tension:.3g}" for tension in one.tensions)
        label = f"{pulls} N" if reach.closest is None else f"closest: {pulls} N"
        plot_shape(one.solution, ax, color=color, sections=0, cables=len(shown) == 1, flow=index == 0, label=label)
    for target in targets:
        ax.plot(per_m * target.x, per_m * target.y, "+", color=_MARK, markersize=12, markeredgewidth=1.8, zorder=6)
        if target.angle is not None:
            # Across the section that is asked for.
            reached = 0.04 * per_m * (shown[0].solution.arm.length if shown else 0.0)
            across = np.radians(target.angle)
            step = reached * np.array([np.cos(across), np.sin(across)])
            ends = per_m * np.array([target.x, target.y]) + np.stack([0.0 * step, step])
            ax.plot(ends[:, 0], ends[:, 1], color=_MARK, linewidth=1.8, zorder=6)
    ax.legend(frameon=False, fontsize=9)
    return ax


def plot_fit(fit: Fit, ax: Axes | None) -> Axes:
    """See `Fit.plot`."""
    import matplotlib.pyplot as plt

    if fit.arm.is_spatial:
        from hydrostat.plotting_3d import plot_fit_in_space

        return plot_fit_in_space(fit, ax)
    ax = _new_axes(ax)
    per_m = UNITS[unit_of(ax, None)]
    cases = fit.residuals["case"]
    colors = plt.colormaps["viridis"](np.linspace(0.15, 0.85, max(len(fit.solutions), 2)))
    for (name, solution), color in zip(fit.solutions.items(), colors, strict=False):
        plot_shape(solution, ax, color=color, sections=0, cables=False, flow=False, label=name)
        places = measured_places(fit, cases == name, "xy")
        ax.plot(per_m * places[:, 0], per_m * places[:, 1], "+", color=color, markersize=9, markeredgewidth=1.5, zorder=6)
    ax.legend(frameon=False, fontsize=9)
    return ax


def measured_places(fit: Fit, own: NDArray[np.bool_], axes: str) -> NDArray[np.float64]:
    """Where all of these coordinates of a marker were measured, m."""
    columns = fit.residuals
    markers = np.stack([np.nan_to_num(columns[name]) for name in ("s", "offset_a", "offset_b", "offset_c")], axis=1)

    def measured(name: str) -> dict[tuple[float, ...], float]:
        rows = own & (columns["quantity"] == name)
        return dict(zip(map(tuple, markers[rows].tolist()), columns["measured"][rows].tolist(), strict=True))

    along = [measured(name) for name in axes]
    whole = [marker for marker in along[0] if all(marker in one for one in along)]
    return np.array([[one[marker] for one in along] for marker in whole]).reshape(-1, len(axes))


def plot_manipulability(found: Sensitivities, ax: Axes | None, effort: float | None) -> Axes:
    """See `Sensitivities.plot_manipulability`."""
    ellipse = found.manipulability()
    if ellipse is None:
        raise ValueError("parameters: expected a cable's tension or stroke among them")
    ax = plot_shape(
        found.solution, _new_axes(ax), color=_BODY, sections=0, cables=True, flow=True, label=None
    )
    per_m = UNITS[unit_of(ax, None)]
    longest = ellipse.half_axes[0]
    if effort is None:
        # A round number near a fifth of the length.
        effort = float(f"{0.2 * found.solution.arm.length / longest:.0e}") if longest > 0.0 else 1.0
    tip = found.solution.tip
    points = per_m * (np.array([tip.x, tip.y]) + effort * ellipse.points())
    unit = "m" if any(name.endswith("stroke") for name in found.parameters) else "N"
    label = f"the tip, to first order, by {effort:g} {unit}"
    ax.fill(points[:, 0], points[:, 1], facecolor=_MARK, edgecolor=_MARK, alpha=0.18, zorder=1)
    ax.plot(points[:, 0], points[:, 1], color=_MARK, linewidth=1.4, zorder=6, label=label)
    ax.plot(per_m * tip.x, per_m * tip.y, "o", color=_MARK, markersize=4, zorder=7)
    ax.legend(frameon=False, fontsize=9)
    return ax


def animate(
    solutions: Iterable[Solution], output: str | PathLike[str] | None, *, fps: float, unit: str, sections: int
) -> FuncAnimation | FilePath:
    """See `hydrostat.animate`."""
    import matplotlib.pyplot as plt
    from matplotlib.animation import FFMpegWriter, FuncAnimation, PillowWriter

    if hasattr(solutions, "arm"):
        raise ValueError("solutions: expected a list of solutions, found one; `Solution.plot` draws it")
    shapes = list(_inputs.items("solutions", solutions, "solutions"))
    kinds = {getattr(getattr(shape, "arm", None), "is_spatial", None) for shape in shapes}
    in_space = kinds == {True}
    if not in_space and kinds != {False}:
        raise ValueError("solutions: expected at least one solution, and nothing else, all in the plane or all in space")
    target = None if output is None else FilePath(output)
    ending = "" if target is None else target.suffix.lower()
    if target is not None and ending not in (".gif", ".mp4", ".html"):
        raise ValueError(f"output: expected a name that ends in .gif, .mp4 or .html, found {target.name!r}")
    if ending == ".mp4" and not FFMpegWriter.isAvailable():
        raise FileNotFoundError("output: .mp4 needs the program ffmpeg, which is not there; .gif and .html need none")
    if isinstance(fps, str) or not _inputs.number("fps", fps) > 0.0:
        raise ValueError(f"fps: expected a number above zero, found {fps!r}")
    fps = float(fps)
    in_3d: dict[str, Any] = {"subplot_kw": {"projection": "3d"}} if in_space else {}
    figure, ax = plt.subplots(figsize=(6.4, 5.2 if in_space else 4.2), layout="constrained", **in_3d)
    per_m = UNITS[unit_of(ax, unit)]
    ends = np.concatenate([per_m * places for shape in shapes for places in _surface(shape, in_space)])
    low, high = ends.min(axis=0), ends.max(axis=0)
    margin = 0.05 * float((high - low).max())

    def draw(index: int) -> list[Artist]:
        ax.clear()
        shape: Any = shapes[index]
        if in_space:
            from hydrostat.plotting_3d import plot_in_space

            plot_in_space(shape, ax, color=_BODY, sections=sections, cables=True, flow=False, label=None, unit=unit)
        else:
            plot_shape(shape, ax, color=_BODY, sections=sections, cables=True, flow=False, label=None, unit=unit)
        for axis, least, most in zip("xyz", low, high, strict=False):
            getattr(ax, f"set_{axis}lim")(least - margin, most + margin)
        if in_space:
            ax.set_aspect("equal")
        else:
            ax.set_aspect("equal", adjustable="box")
        return [*ax.lines, *ax.patches, *ax.collections]

    moving = FuncAnimation(figure, draw, frames=len(shapes), interval=1e3 / fps)
    if target is None:
        return moving
    try:
        if ending == ".html":
            target.write_text(moving.to_jshtml(fps=max(round(fps), 1)), encoding="utf-8")
        else:
            writer = PillowWriter if ending == ".gif" else FFMpegWriter
            moving.save(target, writer=writer(fps=max(round(fps), 1)))
    finally:
        plt.close(figure)
    return target


def _surface(shape: Any, in_space: bool) -> list[NDArray[np.float64]]:
    """Places on the surface, m, so many of them that all of it lies between."""
    return list(shape.surface(shape.s, 4)) if in_space else list(shape.surfaces(shape.s))
