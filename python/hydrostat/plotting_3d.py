"""Drawings of arms in space on matplotlib's axes in three dimensions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from hydrostat.plotting import INK, MM, SLACK, TAUT, UNITS, WATER, measured_places, unit_of

if TYPE_CHECKING:
    from hydrostat.identification import Fit
    from hydrostat.paths import Equilibria
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.typing import ColorType
    from numpy.typing import NDArray

    from hydrostat.spatial import SpatialSolution

_POINTS = 120
_SIDES = 24


def _new_axes(ax: Axes | None) -> Any:
    if ax is None:
        import matplotlib.pyplot as plt

        return plt.subplots(figsize=(6.4, 5.2), layout="constrained", subplot_kw={"projection": "3d"})[1]
    if getattr(ax, "name", None) != "3d":
        raise ValueError('ax: expected axes in three dimensions, such as `plt.subplots(subplot_kw={"projection": "3d"})[1]`')
    return ax


def plot_in_space(
    solution: SpatialSolution,
    ax: Axes | None,
    *,
    color: ColorType,
    sections: int,
    cables: bool,
    flow: bool,
    label: str | None,
    unit: str | None,
) -> Axes:
    """See `SpatialSolution.plot`."""
    drawn = _new_axes(ax)
    name = unit_of(drawn, unit)
    per_m = UNITS[name]
    length = solution.arm.length
    s = np.linspace(0.0, length, _POINTS)
    ring = per_m * solution.surface(s, _SIDES)
    body = np.concatenate([ring, ring[:, :1]], axis=1)
    drawn.plot_surface(*np.moveaxis(body, -1, 0), color=color, alpha=0.45, linewidth=0.0, shade=True, rcount=_POINTS, ccount=_SIDES)
    if label is not None:
        # A surface has no entry in a legend.
        drawn.plot([], [], [], color=color, linewidth=6.0, alpha=0.6, label=label)
    if sections > 0:
        for one in per_m * solution.surface(np.linspace(0.0, length, sections), _SIDES):
            drawn.plot(*np.concatenate([one, one[:1]]).T, color=INK, linewidth=0.4, alpha=0.6)
    line = solution.at(s)
    drawn.plot(per_m * line.x, per_m * line.y, per_m * line.z, color=INK, linewidth=0.7, linestyle=(0, (6, 3)))
    if cables:
        for index, cable in enumerate(solution.cables):
            style: dict[str, Any] = {"color": TAUT, "linewidth": 1.8} if cable.tension > 0.0 else {"color": SLACK, "linewidth": 0.9}
            drawn.plot(*(per_m * solution.cable_path(index, s)).T, **style)
    tip = solution.tip
    place = per_m * np.array([tip.x, tip.y, tip.z])
    for director, text in ((tip.a, "a"), (tip.b, "b"), (tip.c, "c")):
        arrow = 0.1 * per_m * length * np.array(director)
        drawn.quiver(*place, *arrow, color=INK, linewidth=1.0, arrow_length_ratio=0.25)
        drawn.text(*(place + 1.25 * arrow), text, size=9, style="italic", ha="center", va="center")
    if flow:
        _stream(solution, drawn, per_m)
    for axis in "xyz":
        getattr(drawn, f"set_{axis}label")(f"{axis} ({name})")
    # From e3, from above and a little from the right; e2 is up, as in drawings of arms in the plane.
    drawn.view_init(elev=25.0, azim=25.0, vertical_axis="y")
    drawn.set_aspect("equal")
    shown: Axes = drawn
    return shown


def plot_equilibria_in_space(equilibria: Equilibria, ax: Axes | None) -> Axes:
    """See `Equilibria.plot`: centrelines, stable ones solid."""
    drawn = _new_axes(ax)
    name = unit_of(drawn, None)
    per_m = UNITS[name]
    for index, (solution, state) in enumerate(zip(equilibria, equilibria.stability, strict=True)):
        line: Any = solution.at(np.linspace(0.0, solution.arm.length, _POINTS))
        points = per_m * np.array([line.x, line.y, line.z])
        style = "-" if state == "stable" else "--"
        drawn.plot(*points, linestyle=style, color=f"C{index % 10}", linewidth=2.0, label=f"{index + 1}: {state or 'not established'}")
        drawn.text(*points[:, -1], f" {index + 1}", size=9)
    return _finished(drawn, name)


def plot_fit_in_space(fit: Fit, ax: Axes | None) -> Axes:
    """See `Fit.plot`: centrelines, and crosses where markers were measured."""
    import matplotlib.pyplot as plt

    drawn = _new_axes(ax)
    name = unit_of(drawn, None)
    per_m = UNITS[name]
    cases = fit.residuals["case"]
    colors = plt.colormaps["viridis"](np.linspace(0.15, 0.85, max(len(fit.solutions), 2)))
    for (case, solution), color in zip(fit.solutions.items(), colors, strict=False):
        line: Any = solution.at(np.linspace(0.0, solution.arm.length, _POINTS))
        drawn.plot(*(per_m * np.array([line.x, line.y, line.z])), color=color, linewidth=2.0, label=case)
        places = per_m * measured_places(fit, cases == case, "xyz")
        drawn.plot(*places.T, "+", color=color, markersize=9, markeredgewidth=1.5)
    return _finished(drawn, name)


def _finished(drawn: Any, unit: str) -> Axes:
    """With labels and a legend, seen as drawings of one arm are."""
    for axis in "xyz":
        getattr(drawn, f"set_{axis}label")(f"{axis} ({unit})")
    drawn.view_init(elev=25.0, azim=25.0, vertical_axis="y")
    drawn.set_aspect("equal")
    drawn.legend(frameon=False, fontsize=9)
    shown: Axes = drawn
    return shown


def _stream(solution: SpatialSolution, ax: Any, per_m: float) -> None:
    """An arrow of the stream beside the base, with its speed."""
    table = solution.arm.to_dict().get("flow", {})
    speed = float(table.get("speed", 0.0))
    if speed <= 0.0:
        return
    direction = _direction(table.get("direction", 0.0))
    length = solution.arm.length
    aside = _aside(direction, np.array(solution.a[0]))
    middle = per_m * (np.array([solution.x[0], solution.y[0], solution.z[0]]) + 0.2 * length * aside)
    arrow = 0.2 * per_m * length * direction
    ax.quiver(*(middle - 0.5 * arrow), *arrow, color=WATER, linewidth=1.3, arrow_length_ratio=0.2)
    ax.text(*(middle - 0.5 * arrow), f"{speed:g} m/s ", color=WATER, size=9, ha="right", va="bottom")


def _direction(written: object) -> NDArray[np.float64]:
    """The direction of a written arm file: an angle in the plane e1-e2, or three numbers of any length."""
    if isinstance(written, list):
        vector = np.array(written, dtype=np.float64)
        return vector / np.linalg.norm(vector)
    from hydrostat.plotting import radians

    angle = radians(written)
    return np.array([np.cos(angle), np.sin(angle), 0.0])


def _aside(direction: NDArray[np.float64], along: NDArray[np.float64]) -> NDArray[np.float64]:
    """A direction off the arm: against the stream, as far as that is not along the arm, else e2 or e3."""
    for wish in (-direction, np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])):
        off = wish - (wish @ along) * along
        size = np.linalg.norm(off)
        if size > 0.3:
            return np.asarray(off / size)
    return np.array([0.0, 0.0, 1.0])


#: Title, label of the axis, factor, and the fields with their symbols of each panel of strains.
_PANELS: tuple[tuple[str, str, float, tuple[tuple[str, str], ...]], ...] = (
    ("stretch", r"$\nu$", 1.0, (("nu", r"$\nu$"),)),
    ("shear", r"$\eta$, $\zeta$", 1.0, (("eta", r"$\eta$"), ("zeta", r"$\zeta$"))),
    ("twist and bending", "1/m", 1.0, (("tau", r"$\tau$"), ("kappa", r"$\kappa$"), ("mu", r"$\mu$"))),
    ("angle of the section", r"$\alpha$ (deg)", 180.0 / np.pi, (("alpha", r"$\alpha$"),)),
)


def plot_strains_in_space(solution: SpatialSolution, *, label: str | None, figure: Figure | None) -> Figure:
    """See `SpatialSolution.plot_strains`."""
    import matplotlib.pyplot as plt

    if figure is None:
        figure, _ = plt.subplots(2, 2, figsize=(7.2, 4.8), sharex=True, layout="constrained")
    stations = solution.resampled(2 * _POINTS)
    for ax, (title, text, factor, fields) in zip(figure.axes, _PANELS, strict=True):
        for name, symbol in fields:
            words = symbol if label is None else f"{symbol}, {label}"
            ax.plot(MM * stations.s, factor * getattr(stations, name), linewidth=1.6, label=words)
        ax.set_title(title, size=10, loc="left")
        ax.set_ylabel(text)
        ax.grid(alpha=0.25)
        if len(fields) > 1 or label is not None:
            ax.legend(frameon=False, fontsize=9)
    for ax in figure.axes[2:]:
        ax.set_xlabel("s (mm)")
    return figure
