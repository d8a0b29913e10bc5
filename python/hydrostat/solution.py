"""Solutions: shapes with their internal forces."""

from __future__ import annotations

import html
import math
import sys
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, cast

import numpy as np

from hydrostat import _inputs, _memory, _native, _saved, _units
from hydrostat._errors import ModelWarning
from hydrostat._saved import Origin
from hydrostat.figures import Figure, arm_figure

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as MatplotlibFigure
    from matplotlib.typing import ColorType
    from numpy.typing import ArrayLike, NDArray

    from hydrostat.arm import Arm

#: Unit and meaning of each field of `Stations`.
FIELDS: dict[str, tuple[str, str]] = {
    "s": ("m", "length along the undeformed arm, from base to tip"),
    "x": ("m", "centreline along e1"),
    "y": ("m", "centreline along e2"),
    "theta": ("rad", "rotation of the section"),
    "nu": ("1", "stretch"),
    "eta": ("1", "shear strain"),
    "mu": ("1/m", "bending strain"),
    "beta": ("1", "section stretch"),
    "alpha": ("rad", "angle from the section's normal to the centreline's tangent"),
    "n_a": ("N", "contact force along the section's normal"),
    "n_b": ("N", "contact force in the section"),
    "m": ("N m", "contact moment"),
}


#: What the attributes of datasets follow.
CONVENTIONS = "CF-1.11"


class Tip(NamedTuple):
    """The tip: `x`, `y` in m, `theta`, `alpha` in rad; `z` and the directors `a`, `b`, `c` follow, as those of a `SpatialTip`."""

    x: float
    y: float
    theta: float
    alpha: float

    @property
    def z(self) -> float:
        """0 m: the arm is in the plane."""
        return 0.0

    @property
    def a(self) -> tuple[float, float, float]:
        """Director normal to the section."""
        return (math.cos(self.theta), math.sin(self.theta), 0.0)

    @property
    def b(self) -> tuple[float, float, float]:
        """Director in the section."""
        return (-math.sin(self.theta), math.cos(self.theta), 0.0)

    @property
    def c(self) -> tuple[float, float, float]:
        """Director in the section, a x b: e3."""
        return (0.0, 0.0, 1.0)


class Wrench(NamedTuple):
    """A force in space, N, and a moment, N m, counterclockwise."""

    force: tuple[float, float]
    moment: float


class Command(NamedTuple):
    """The command to a cable: its `stroke`, m, the remaining unstretched `length`, m, and whether it is `slack`."""

    stroke: float
    length: float
    slack: bool


class CableState(NamedTuple):
    """The state of a cable: `tension` at the base in N, `length` and `stroke` (positive when reeled in) in m."""

    name: str
    tension: float
    length: float
    stroke: float
    command: Command | None


@dataclass(frozen=True, slots=True)
class Snap:
    """A jump that the arm makes as its loads grow slowly, where the path of its equilibria turns back and then continues.

    Attributes
    ----------
    phase : str
        What was being raised: ``"loads"`` (all but the cables), ``"tension"``, ``"stroke"`` or ``"friction"``.
    load_fraction : float
        The share of that phase's loads at the snap, 0 to 1.
    before, after : Tip
        The tip, m and rad, before the snap and where the arm lands; of an arm in space a `SpatialTip`.
    distance, angle : float
        How far the tip jumps, m, and turns, rad.
    duration : float or None
        Where the motion after the snap was followed (``after_snap=True``): how long it takes until the arm stays within
        0.002 L of where it rests, s.
    lands_elsewhere : bool or None
        Whether that motion ends in another shape than the curve of equilibria; None if this is not known.
    """

    phase: str
    load_fraction: float
    before: Tip
    after: Tip
    distance: float
    angle: float
    duration: float | None = None
    lands_elsewhere: bool | None = None


def snaps_of(fields: Iterable[Sequence[Any]], tip: Callable[..., Tip] = Tip) -> tuple[Snap, ...]:
    """Snaps of what the extension module, a pickle or a file has of them; `tip` makes a tip of its fields."""
    return tuple(
        Snap(phase, load_fraction, tip(*before), tip(*after), distance, angle, *motion)
        for phase, load_fraction, before, after, distance, angle, *motion in fields
    )


class FoldMargin(NamedTuple):
    """The least (nu - beta R abs(mu)) / nu along the arm, and where it is, m; at or below 0 the surface folds."""

    value: float
    s: float


class Note(NamedTuple):
    """A warning about a solution: its `kind`, such as ``"surface_fold"``, and the `message`."""

    kind: str
    message: str


class Result:
    """What does not change: a copy is the same, and equal is what has the same bits."""

    __slots__ = ()

    def __copy__(self) -> Any:
        return self

    def __deepcopy__(self, memo: object) -> Any:
        return self


class Stations(Result):
    """States along an arm, base to tip: twelve read-only arrays of shape (n,), which share memory with what solved them.

    They stay valid after this object is deleted, and keep the solution in memory (about 45 kB for an arm with two cables).
    `copy_arrays` returns independent arrays.
    """

    __slots__ = ("_inner",)

    _inner: _native.Stations | _native.Solution
    _fields: ClassVar[dict[str, tuple[str, str]]] = FIELDS

    def __init__(self, native: _native.Stations) -> None:
        self._inner = native

    def _field(self, name: str) -> NDArray[np.float64]:
        return self._inner.field(name)

    @property
    def s(self) -> NDArray[np.float64]:
        """Length along the undeformed arm, m, shape (n,)."""
        return self._inner.field("s")

    @property
    def x(self) -> NDArray[np.float64]:
        """Centreline along e1, m, shape (n,)."""
        return self._inner.field("x")

    @property
    def y(self) -> NDArray[np.float64]:
        """Centreline along e2, m, shape (n,)."""
        return self._inner.field("y")

    @property
    def theta(self) -> NDArray[np.float64]:
        """Rotation of the section, rad, continuous along the arm, shape (n,)."""
        return self._inner.field("theta")

    @property
    def nu(self) -> NDArray[np.float64]:
        """Stretch, shape (n,)."""
        return self._inner.field("nu")

    @property
    def eta(self) -> NDArray[np.float64]:
        """Shear strain, shape (n,)."""
        return self._inner.field("eta")

    @property
    def mu(self) -> NDArray[np.float64]:
        """Bending strain, 1/m, shape (n,)."""
        return self._inner.field("mu")

    @property
    def beta(self) -> NDArray[np.float64]:
        """Section stretch, shape (n,)."""
        return self._inner.field("beta")

    @property
    def alpha(self) -> NDArray[np.float64]:
        """Angle from the section's normal to the centreline's tangent, rad, shape (n,)."""
        return self._inner.field("alpha")

    @property
    def n_a(self) -> NDArray[np.float64]:
        """Contact force along the section's normal, N, shape (n,)."""
        return self._inner.field("n_a")

    @property
    def n_b(self) -> NDArray[np.float64]:
        """Contact force in the section, N, shape (n,)."""
        return self._inner.field("n_b")

    @property
    def m(self) -> NDArray[np.float64]:
        """Contact moment, N m, shape (n,)."""
        return self._inner.field("m")

    @property
    def m_c(self) -> NDArray[np.float64]:
        """Contact moment about c, N m, shape (n,): `m` in the plane."""
        return self.m

    @property
    def a(self) -> NDArray[np.float64]:
        """Director normal to the section, shape (n, 3)."""
        return _fixed(np.cos(self.theta), np.sin(self.theta), np.zeros(len(self)))

    @property
    def b(self) -> NDArray[np.float64]:
        """Director in the section, shape (n, 3)."""
        return _fixed(-np.sin(self.theta), np.cos(self.theta), np.zeros(len(self)))

    @property
    def c(self) -> NDArray[np.float64]:
        """Director in the section, a x b, shape (n, 3): e3 in the plane."""
        return _fixed(np.zeros(len(self)), np.zeros(len(self)), np.ones(len(self)))

    @property
    def z(self) -> NDArray[np.float64]:
        """Centreline along e3, m, shape (n,): 0 in the plane."""
        return _fixed(np.zeros(len(self)))

    @property
    def zeta(self) -> NDArray[np.float64]:
        """Shear strain along c, shape (n,): 0 in the plane."""
        return _fixed(np.zeros(len(self)))

    @property
    def tau(self) -> NDArray[np.float64]:
        """Twist, 1/m, shape (n,): 0 in the plane."""
        return _fixed(np.zeros(len(self)))

    @property
    def kappa(self) -> NDArray[np.float64]:
        """Bending strain about b, 1/m, shape (n,): 0 in the plane."""
        return _fixed(np.zeros(len(self)))

    @property
    def n_c(self) -> NDArray[np.float64]:
        """Contact force along c, N, shape (n,): 0 in the plane."""
        return _fixed(np.zeros(len(self)))

    @property
    def m_a(self) -> NDArray[np.float64]:
        """Contact moment about a, N m, shape (n,): 0 in the plane."""
        return _fixed(np.zeros(len(self)))

    @property
    def m_b(self) -> NDArray[np.float64]:
        """Contact moment about b, N m, shape (n,): 0 in the plane."""
        return _fixed(np.zeros(len(self)))

    def __len__(self) -> int:
        return len(self.s)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Stations) or type(other) is not type(self):
            return NotImplemented
        return all(_saved.same(self._field(name), other._field(name)) for name in self._fields)

    def __hash__(self) -> int:
        return hash((len(self), float(self.x[-1]), float(self.y[-1])) if len(self) else 0)

    def __reduce__(self) -> tuple[Any, ...]:
        return _stations, (_saved.FORMAT, _native.__version__, self.copy_arrays())

    def __repr__(self) -> str:
        return f"<Stations: {len(self)}, from {self.s[0]:g} to {self.s[-1]:g} m>" if len(self) else "<Stations: none>"

    def copy_arrays(self) -> dict[str, NDArray[np.float64]]:
        """Return all fields by name, as independent arrays that can be changed."""
        return {name: self._field(name).copy() for name in self._fields}

    def to_pandas(self) -> pd.DataFrame:
        """The stations as a table with `s` (m) as its index. Needs pandas."""
        import pandas as pd

        columns = {name: self._field(name) for name in self._fields if name != "s"}
        return pd.DataFrame(columns, index=pd.Index(self.s, name="s"))

    def to_xarray(self) -> xr.Dataset:
        """The stations along the coordinate `s`, each with ``units`` and ``long_name``. Needs xarray."""
        import xarray as xr

        fields = {name: ("s", self._field(name), attributes(self._fields, name)) for name in self._fields}
        coordinate = fields.pop("s")
        return xr.Dataset(fields, coords={"s": coordinate})


def _fixed(*components: NDArray[np.float64]) -> NDArray[np.float64]:
    """Numbers that do not change: one of each station, or components of one."""
    out = components[0] if len(components) == 1 else np.stack(components, axis=1)
    out.flags.writeable = False
    return out


def attributes(fields: Mapping[str, tuple[str, str]], name: str) -> dict[str, str]:
    """What a dataset says of a field."""
    units, meaning = fields[name]
    return {"units": units, "long_name": meaning}


class Solution(Stations):
    """An arm in equilibrium: its stations are the nodes of the solver's mesh, denser where the shape changes quickly.

    The end of a cable appears twice, with the values on either side. `Arm.solve` makes solutions.

    Examples
    --------
    >>> import hydrostat as hs
    >>> sol = hs.Arm.load("silicone").solve(tensions=[0.2, 0], flow_speed=0.1)
    >>> bool(sol.y[-1] > 0)
    True
    >>> sol.x.flags.writeable
    False
    """

    __slots__ = ("__dict__",)

    _inner: _native.Solution  # pyright: ignore[reportIncompatibleVariableOverride]

    def __init__(self, native: _native.Solution, origin: Origin | Callable[[], Origin] | None = None) -> None:
        self._inner = native  # pyright: ignore[reportIncompatibleVariableOverride]
        self._origin = origin

    def __repr__(self) -> str:
        tip = self.tip
        turned = np.degrees(tip.theta)
        kinds = ", ".join(note.kind for note in self.warnings)
        notes = f"; warnings: {kinds}" if kinds else ""
        return f"<Solution of {self.arm.name!r}: tip at ({tip.x:.6g}, {tip.y:.6g}) m, turned by {turned:.4g} deg{notes}>"

    def _repr_html_(self) -> str:
        """A small picture with the tip, the tensions and the warnings, for notebooks."""
        pulls = ", ".join(f"{html.escape(cable.name)} {cable.tension:.4g} N" for cable in self.cables)
        lines = [
            f"<b>{html.escape(self.arm.name)}</b>",
            self._place_in_words(),
            *([pulls] if pulls else []),
            *(f"&#9888; {html.escape(note.message)}" for note in self.warnings),
        ]
        words = "<br>".join(lines)
        return f'<div style="display:flex;gap:1em;align-items:center">{_picture(self)}<div>{words}</div></div>'

    def _place_in_words(self) -> str:
        tip = self.tip
        return f"tip at ({1e3 * tip.x:.2f}, {1e3 * tip.y:.2f}) mm, turned by {np.degrees(tip.theta):.2f}&deg;"

    def _outline(self) -> NDArray[np.float64]:
        """The outline on the page of x and y, m, shape (n, 2)."""
        left, right = self.surfaces(self.s)
        return np.concatenate([left, right[::-1]])

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Solution) or type(other) is not type(self):
            return NotImplemented
        return _saved.same(_numbers(self), _numbers(other)) and self.arm.to_toml() == other.arm.to_toml()

    def __hash__(self) -> int:
        return hash((self.tip, len(self)))

    def _state(self) -> dict[str, Any]:
        origin = self._origin() if callable(self._origin) else self._origin
        origin = origin or _saved.own_origin(self._inner, self._inner.tol)
        return _saved.solution_state(self._inner, origin, self.__dict__.get("_stability"))

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (_saved.FORMAT, _native.__version__, self._state())

    def save(self, path: str | PathLike[str]) -> FilePath:
        """Write this to a netCDF file, `path`, whose name ends in ``.nc``, from which `hydrostat.load` restores it bit by bit.

        The file is that of `to_xarray` and can be opened as such; everything else is in one attribute. Needs xarray and one of
        h5netcdf, netCDF4 and SciPy.

        Examples
        --------
        >>> import hydrostat as hs, tempfile, pathlib
        >>> sol = hs.Arm.load("silicone").solve(tensions=[0.2, 0])
        >>> with tempfile.TemporaryDirectory() as directory:
        ...     again = hs.load(sol.save(pathlib.Path(directory) / "sol.nc"))
        >>> again == sol
        True
        """
        from hydrostat._netcdf import write

        return write(self, FilePath(path))

    @cached_property
    def arm(self) -> Arm:
        """The arm with the loads of this solution."""
        from hydrostat.arm import Arm

        return Arm._of(self._inner.arm)

    @property
    def tip(self) -> Tip:
        """Place and angles of the tip, m and rad."""
        return Tip(*self._inner.tip)

    @property
    def cables(self) -> tuple[CableState, ...]:
        """One entry per cable, in the arm's order."""
        return tuple(
            CableState(name, tension, length, stroke, None if command is None else Command(*command))
            for name, tension, length, stroke, command in self._inner.cables
        )

    @property
    def snaps(self) -> tuple[Snap, ...]:
        """The snaps that the arm makes as its loads grow from nothing to these, in their order; mostly none.

        Examples
        --------
        >>> import hydrostat as hs
        >>> arm = hs.Arm.load("silicone").replace({"model.displaced": "section"}, flow_speed=0.7, flow_direction=90)
        >>> arm = arm.replace({"flow.density": 1022, "gravity": {"acceleration": 9.80665, "direction": -90}})
        >>> [(snap.phase, round(1e3 * snap.distance, 2)) for snap in arm.solve(tensions=[3e-4, 0]).snaps]  # mm
        [('tension', 0.87)]
        """
        return snaps_of(self._inner.snaps)

    @property
    def base_reaction(self) -> Wrench:
        """Force and moment of the support and the cable anchors on the arm at the base, N and N m."""
        return _wrench(*self._inner.base_reaction)

    @property
    def unmet(self) -> Wrench | None:
        """With ``support = "unstrained-base"``, the unbalanced force and moment at the tip, N and N m."""
        unmet = self._inner.unmet
        return None if unmet is None else _wrench(*unmet)

    @property
    def error_estimate(self) -> float:
        """Estimated error of the tip position, m."""
        return self._inner.error_estimate

    @property
    def fold_margin(self) -> FoldMargin:
        """Margin of the surface against folding over itself."""
        return FoldMargin(*self._inner.fold_margin)

    @property
    def strain_energy(self) -> float:
        """1/2 int (C1 (nu-nu_o)^2 + C2 (eta-eta_o)^2 + C3 (mu-mu_o)^2) A ds, J: a measure, not a potential of the law."""
        return self._inner.strain_energy

    @cached_property
    def warnings(self) -> tuple[Note, ...]:
        """The warnings of this solution; empty if there are none."""
        return tuple(Note(kind, message) for kind, message in self._inner.warnings())

    @cached_property
    def _stability(self) -> tuple[str | None, int | None, bool | None]:
        return self._inner.stability()

    @property
    def stability(self) -> str | None:
        """``"stable"``, ``"unstable"``, ``"marginal"``, or None if not established.

        Static divergence under overdamped motion. Computed on first use, in one to two milliseconds.
        """
        return self._stability[0]

    @property
    def unstable_directions(self) -> int | None:
        """Number of directions in which small motions grow."""
        return self._stability[1]

    @property
    def stable(self) -> bool | None:
        """Whether it is stable; None if not established."""
        state, _, known = self._stability
        return {"stable": True, "unstable": False, "marginal": None}[state] if state is not None else known

    def growth(self) -> NDArray[np.complex128] | None:
        """Rates of small overdamped motions, shape (k,), over the slowest decay of the unloaded arm, fastest growth first."""
        rates = self._inner.growth()
        return None if rates is None else np.array([complex(re, im) for re, im in rates])

    @property
    def statistics(self) -> dict[str, int]:
        """The work of the solve: elements, stages, Newton rounds, meshes, load steps, evaluations."""
        return dict(self._inner.statistics)

    def at(self, s: ArrayLike) -> Stations:
        """Evaluate the solution at any places along the arm, as accurately as at the nodes.

        Parameters
        ----------
        s : array_like, shape (n,) or ()
            Lengths along the undeformed arm, m, from 0 to the arm's length.
        """
        return Stations(self._inner.at(places_of(s)))

    def resampled(self, count: int) -> Stations:
        """`count` (at least two) equally spaced stations from base to tip."""
        wanted = _inputs.count("count", count)
        _memory.require(2 * 8 * len(self._fields) * wanted, f"{wanted} stations", "ask for fewer")
        return Stations(self._inner.resampled(wanted))

    def surfaces(self, s: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The deformed surface on the left and on the right, m, each of shape (n, 2), at lengths `s` (m) of shape (n,)."""
        left_x, left_y, right_x, right_y = self._inner.surfaces(places_of(s))
        return np.stack([left_x, left_y], axis=1), np.stack([right_x, right_y], axis=1)

    def surface(self, s: ArrayLike | None = None, sides: int = 24) -> NDArray[np.float64]:
        """Points of the deformed surface of an arm in space; see `SpatialSolution.surface`. In the plane `surfaces` has the two lines.

        Raises
        ------
        ValueError
            The arm is in the plane.
        """
        raise ValueError('surface: for arms with `space = "spatial"`, and this one is in the plane; see `surfaces`')

    def cable_path(self, cable: int, s: ArrayLike) -> NDArray[np.float64]:
        """Points of a cable, m, shape (n, 2), at lengths `s` (m) of shape (n,); NaN past its anchor."""
        return np.stack(self._inner.cable_path(cable, places_of(s)), axis=1)

    def layer_speed(self, s: float | str, y: float | str) -> float:
        """Speed of the water along the arm, m/s, at the length `s` (m) and the distance `y` (m) from the windward surface."""
        return self._inner.layer_speed(_inputs.number("s", s, key=_units.STROKE), _inputs.number("y", y, key=_units.STROKE))

    def to_json(self) -> str:
        """Return the document of ``hydrostat solve --format json``, on one line."""
        return self._inner.to_json()

    def to_csv(self) -> str:
        """The stations as ``hydrostat solve --format csv`` prints them."""
        return self._inner.to_csv()

    def to_xarray(self) -> xr.Dataset:
        """The stations along `s`, with tip, cables and base reaction. Needs xarray.

        Returns
        -------
        xarray.Dataset
            The fields over ``s``; ``tension``, ``cable_length`` and ``stroke`` over ``cable``; ``warnings`` over their kinds,
            ``warning``; ``snap_phase``, ``snap_load_fraction``, ``snap_distance``, ``snap_angle`` over ``snap``, and the tip's ``snap_x``,
            ``snap_y``, ``snap_theta``, ``snap_alpha`` over ``snap`` and ``side`` (before, after), if the arm snaps on its way; the rest
            as attributes.
        """
        return self._described(super().to_xarray())

    def _described(self, out: xr.Dataset) -> xr.Dataset:
        """The stations with all else that is known of the solution."""
        cables = self.cables
        out = out.assign_coords(cable=("cable", [cable.name for cable in cables]))
        out["tension"] = ("cable", np.array([c.tension for c in cables]), {"units": "N", "long_name": "tension at the base"})
        length = {"units": "m", "long_name": "length of the cable in the arm"}
        out["cable_length"] = ("cable", np.array([c.length for c in cables]), length)
        stroke = {"units": "m", "long_name": "stroke, positive when reeled in"}
        out["stroke"] = ("cable", np.array([c.stroke for c in cables]), stroke)
        out = out.assign_coords(warning=("warning", np.array([note.kind for note in self.warnings], dtype=np.str_)))
        messages = np.array([note.message for note in self.warnings], dtype=np.str_)
        out["warnings"] = ("warning", messages, {"long_name": "what should be known about this answer"})
        if self.snaps:
            out = _with_snaps(out, self.snaps, self._fields)
        base = self.base_reaction
        out.attrs = {
            "Conventions": CONVENTIONS,
            "arm": self.arm.name,
            "base_force": list(base.force),
            "base_moment": _attribute(base.moment),
            "error_estimate": self.error_estimate,
            "fold_margin": self.fold_margin.value,
            "hydrostat": _native.__version__,
        }
        return out

    def figure(self, note: str | None = None) -> Figure:
        """The shape to scale, as the program draws it; see `arm_figure`."""
        return arm_figure(self, note)

    def plot(
        self,
        ax: Axes | None = None,
        *,
        color: ColorType = "#d9734e",
        sections: int = 25,
        cables: bool = True,
        flow: bool = True,
        label: str | None = None,
        unit: str | None = None,
    ) -> Axes:
        """Draw the shape to scale on a matplotlib axis: outline, sections, cables and stream. Needs matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axis to draw on; by default that of a new figure.
        color : color
            Of the body.
        sections : int
            How many sections are drawn; 0 for none.
        cables, flow : bool
            Whether cables and the stream are drawn.
        label : str, optional
            For the legend.
        unit : str, optional
            ``"mm"``, ``"cm"`` or ``"m"``; by default that of earlier drawings on these axes, or that of their label, or mm. Earlier
            drawings in another one are converted.

        Returns
        -------
        matplotlib.axes.Axes
            In that unit, with equal scales.

        Raises
        ------
        ValueError
            The unit is none of these, or what is on these axes cannot be converted to it.
        """
        from hydrostat.plotting import plot_shape

        return plot_shape(self, ax, color=color, sections=sections, cables=cables, flow=flow, label=label, unit=unit)

    def plot_strains(self, *, label: str | None = None, figure: MatplotlibFigure | None = None) -> MatplotlibFigure:
        """Stretch, shear, bending and the angle alpha along the arm, in four panels. Needs matplotlib.

        Parameters
        ----------
        label : str, optional
            For the legend.
        figure : matplotlib.figure.Figure, optional
            A figure returned by an earlier call, to draw into.
        """
        from hydrostat.plotting import plot_strains

        return plot_strains(self, label=label, figure=figure)


def animate(
    solutions: Iterable[Solution] | xr.Dataset,
    output: str | PathLike[str] | None = None,
    *,
    fps: float = 20.0,
    unit: str = "mm",
    sections: int = 25,
) -> FuncAnimation | FilePath:
    """Animate shapes, to scale. Needs matplotlib.

    Parameters
    ----------
    solutions : iterable of Solution, or Dataset
        One frame each: a list, a branch of a path and so on; or a motion of `simulate`, one frame a row.
    output : path, optional
        A file ``.gif``, ``.mp4`` (needs ffmpeg) or ``.html``.
    fps : float
        Frames per second.
    unit : str
        ``"mm"``, ``"cm"`` or ``"m"``.
    sections : int
        How many sections are drawn; 0 for none.

    Returns
    -------
    pathlib.Path
        `output`, where that is given.
    matplotlib.animation.FuncAnimation
        What a notebook shows with ``IPython.display.HTML(animation.to_jshtml())``.
    """
    from hydrostat.motion import shapes_of
    from hydrostat.plotting import animate as moving

    shapes: Any = solutions
    if hasattr(solutions, "data_vars"):
        shapes = shapes_of(shapes)
    return moving(shapes, output, fps=fps, unit=unit, sections=sections)


#: What a Python warning says of each kind; the same each time, so that Python's filters show it once.
_WARNINGS = {
    "surface_fold": "the surface folds over itself",
    "strain_range": "the stretch is outside the range of a linear section law",
    "tension_above_max": "a commanded stroke takes more tension than the cable's max_tension",
    "sealed_cavity": "the cavity is sealed, and the pressure of the outside water on its wall is left out",
    "tangential_load": "the shape depends strongly on the tangential load of the momentum law",
    "tolerance_missed": "the estimated error is above the tolerance",
}


def warn(solution: Solution, depth: int) -> Solution:
    """Raise a Python warning for each kind of note on an answer, of the caller `depth` calls up."""
    if not _ignored():
        _raise([note.kind for note in solution.warnings], "`Solution.warnings` has the numbers", depth + 1)
    return solution


def warn_of_all(solutions: Iterable[Solution], depth: int) -> None:
    """The same for several answers, once for each kind."""
    if not _ignored():
        kinds = [note.kind for solution in solutions for note in solution.warnings]
        _raise(list(dict.fromkeys(kinds)), "`warnings` of the solutions has the numbers", depth + 1)


def _raise(kinds: list[str], where: str, depth: int) -> None:
    for kind in kinds:
        if kind == "snap":
            # Within the bounds that were asked for.
            continue
        warnings.warn(ModelWarning(f"{kind}: {_WARNINGS.get(kind, 'see its message')}; {where}", kind), stacklevel=depth + 1)


def _ignored() -> bool:
    """Whether Python's filters drop all of our warnings, so that none needs to be looked for: with a stream that takes 20 us."""
    if getattr(sys.flags, "context_aware_warnings", False):
        # The filters are not those of the module alone.
        return False
    for action, message, category, module, line in warnings.filters:
        if issubclass(ModelWarning, category):
            return action == "ignore" and message is None and module is None and not line
    return False


def _attribute(value: Any) -> Any:
    return list(value) if isinstance(value, tuple) else value


def _with_snaps(dataset: xr.Dataset, snaps: tuple[Snap, ...], fields: Mapping[str, tuple[str, str]]) -> xr.Dataset:
    about = {
        "load_fraction": ("1", "share of that phase's loads at the snap"),
        "distance": ("m", "jump of the tip"),
        "angle": ("rad", "turn of the tip"),
    }
    out = dataset.assign_coords(side=("side", ["before", "after"]))
    out["snap_phase"] = ("snap", np.array([snap.phase for snap in snaps], dtype=np.str_))
    for name, (unit, meaning) in about.items():
        numbers = np.array([getattr(snap, name) for snap in snaps])
        out[f"snap_{name}"] = ("snap", numbers, {"units": unit, "long_name": meaning})
    for name in snaps[0].before._fields:
        sides = np.array([[getattr(snap.before, name), getattr(snap.after, name)] for snap in snaps])
        # Directors have their components along one more axis.
        out[f"snap_{name}"] = (("snap", "side", "axis")[: sides.ndim], sides, attributes(fields, name))
    return out


def _numbers(solution: Solution) -> tuple[Any, ...]:
    inner = solution._inner
    fields = [solution._field(name) for name in solution._fields]
    return inner.tol, inner.cables, inner.base_reaction, inner.error_estimate, inner.snaps, fields


def _stations(version: int, writer: str, fields: Mapping[str, NDArray[np.float64]]) -> Stations:
    _saved.check("Stations", version, writer)
    for array in fields.values():
        array.flags.writeable = False
    native: Any = _saved.SavedStations({"fields": fields}, Origin("none", ()))
    if "z" in fields:
        from hydrostat.spatial import SpatialStations

        return SpatialStations(native)
    return Stations(native)


def _restored(version: int, writer: str, state: dict[str, Any]) -> Solution:
    _saved.check("Solution", version, writer)
    return solution_of(cast("_native.Solution", _saved.solution_of(state)), Origin(*state["origin"]))


def solution_of(
    native: _native.Solution | _native.SpatialSolution, origin: Origin | Callable[[], Origin] | None = None
) -> Solution:
    """The solution that the extension module, or what stands in for it, holds: in the plane or in space."""
    if _saved.is_spatial(native):
        from hydrostat.spatial import SpatialSolution

        return SpatialSolution(cast("_native.SpatialSolution", native), origin)
    return Solution(cast("_native.Solution", native), origin)


def _picture(solution: Solution) -> str:
    """The outline to scale, as a small SVG: of the stations, which are at hand."""
    try:
        outline = 1e3 * solution._outline()
    except RuntimeError:
        # A shape that was saved and cannot be made again has its centreline.
        line = np.stack([solution.x, solution.y], axis=1)
        outline = 1e3 * np.concatenate([line, line[::-1]])
    (x0, y0), (x1, y1) = outline.min(axis=0), outline.max(axis=0)
    margin = 0.04 * max(x1 - x0, y1 - y0, 1e-9)
    points = " ".join(f"{px:.2f},{-py:.2f}" for px, py in outline)
    box = f"{x0 - margin:.2f} {-y1 - margin:.2f} {x1 - x0 + 2 * margin:.2f} {y1 - y0 + 2 * margin:.2f}"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" width="180" height="120" role="img" aria-label="shape to scale">'
        f'<polygon points="{points}" fill="#d9734e" fill-opacity="0.6" stroke="#28323c" stroke-width="{margin / 12:.3f}"/></svg>'
    )


def _wrench(force: list[float], moment: float) -> Wrench:
    return Wrench((force[0], force[1]), moment)


def places_of(s: ArrayLike) -> NDArray[np.float64]:
    """Places along an arm, m, as a vector."""
    return np.atleast_1d(_inputs.numbers("s", s, key=_units.STROKE)).ravel()
