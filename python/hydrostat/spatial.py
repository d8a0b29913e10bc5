"""Solutions of arms in space: their shapes with three components."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, NoReturn, cast

import numpy as np

from hydrostat import _inputs, _memory, _native, _saved
from hydrostat.solution import Snap, Solution, Stations, Tip, attributes, places_of, snaps_of

if TYPE_CHECKING:
    from collections.abc import Callable

    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as MatplotlibFigure
    from matplotlib.typing import ColorType
    from numpy.typing import ArrayLike, NDArray

    from hydrostat._saved import Origin

#: Unit and meaning of each field of `SpatialStations`.
FIELDS: dict[str, tuple[str, str]] = {
    "s": ("m", "length along the undeformed arm, from base to tip"),
    "x": ("m", "centreline along e1"),
    "y": ("m", "centreline along e2"),
    "z": ("m", "centreline along e3"),
    "a": ("1", "director normal to the section"),
    "b": ("1", "director in the section"),
    "c": ("1", "director in the section, a x b"),
    "nu": ("1", "stretch"),
    "eta": ("1", "shear strain along b"),
    "zeta": ("1", "shear strain along c"),
    "tau": ("1/m", "twist"),
    "kappa": ("1/m", "bending strain about b"),
    "mu": ("1/m", "bending strain about c"),
    "beta": ("1", "section stretch"),
    "alpha": ("rad", "angle between the section's normal and the centreline's tangent"),
    "n_a": ("N", "contact force along a"),
    "n_b": ("N", "contact force along b"),
    "n_c": ("N", "contact force along c"),
    "m_a": ("N m", "contact moment about a"),
    "m_b": ("N m", "contact moment about b"),
    "m_c": ("N m", "contact moment about c"),
}

#: A place or a direction.
Vector = tuple[float, float, float]


class SpatialTip(NamedTuple):
    """The tip of an arm in space: `x`, `y`, `z` in m, the directors `a`, `b`, `c`, and `alpha`, rad, in [0, pi]."""

    x: float
    y: float
    z: float
    a: Vector
    b: Vector
    c: Vector
    alpha: float

    @classmethod
    def of(cls, x: float, y: float, z: float, a: Any, b: Any, c: Any, alpha: float) -> SpatialTip:
        """The tip of what the extension module or a file has of it."""
        return cls(x, y, z, _vector(a), _vector(b), _vector(c), alpha)


class SpatialWrench(NamedTuple):
    """A force, N, and a moment, N m, each along e1, e2, e3."""

    force: Vector
    moment: Vector


def tip_of(*fields: Any) -> Tip:
    """A tip in the plane or in space, by the number of its fields."""
    return Tip(*fields) if len(fields) == len(Tip._fields) else cast("Tip", SpatialTip.of(*fields))


def _vector(components: Any) -> Vector:
    x, y, z = components
    return (x, y, z)


def _only_in_plane(what: str, instead: str) -> NoReturn:
    raise AttributeError(f'{what}: for arms in the plane, and this arm has `space = "spatial"`; see {instead}')


class _InSpace:
    """The fields that stations in space have beside those in the plane."""

    __slots__ = ()

    _inner: Any
    _fields: ClassVar[dict[str, tuple[str, str]]] = FIELDS

    def _field(self, name: str) -> NDArray[np.float64]:
        read: Callable[[str], NDArray[np.float64]]
        read = self._inner.directors if name in _saved.DIRECTORS else self._inner.field
        return read(name)

    @property
    def z(self) -> NDArray[np.float64]:
        """Centreline along e3, m, shape (n,)."""
        return self._field("z")

    @property
    def a(self) -> NDArray[np.float64]:
        """Director normal to the section, shape (n, 3)."""
        return self._field("a")

    @property
    def b(self) -> NDArray[np.float64]:
        """Director in the section, shape (n, 3)."""
        return self._field("b")

    @property
    def c(self) -> NDArray[np.float64]:
        """Director in the section, a x b, shape (n, 3)."""
        return self._field("c")

    @property
    def zeta(self) -> NDArray[np.float64]:
        """Shear strain along c, shape (n,); `eta` is that along b."""
        return self._field("zeta")

    @property
    def tau(self) -> NDArray[np.float64]:
        """Twist, 1/m, shape (n,)."""
        return self._field("tau")

    @property
    def kappa(self) -> NDArray[np.float64]:
        """Bending strain about b, 1/m, shape (n,); `mu` is that about c."""
        return self._field("kappa")

    @property
    def n_c(self) -> NDArray[np.float64]:
        """Contact force along c, N, shape (n,)."""
        return self._field("n_c")

    @property
    def m_a(self) -> NDArray[np.float64]:
        """Contact moment about a, N m, shape (n,)."""
        return self._field("m_a")

    @property
    def m_b(self) -> NDArray[np.float64]:
        """Contact moment about b, N m, shape (n,)."""
        return self._field("m_b")

    @property
    def m_c(self) -> NDArray[np.float64]:
        """Contact moment about c, N m, shape (n,)."""
        return self._field("m_c")

    @property
    def theta(self) -> NDArray[np.float64]:
        """Only in the plane; in space the directors `a`, `b`, `c` say how a section is turned."""
        _only_in_plane("theta", "the directors a, b, c")

    @property
    def m(self) -> NDArray[np.float64]:
        """Only in the plane; in space `m_a`, `m_b`, `m_c`."""
        _only_in_plane("m", "m_a, m_b, m_c")

    def to_pandas(self) -> pd.DataFrame:
        """The stations as a table with `s` (m) as its index, directors by component: ``a_x`` and so on. Needs pandas."""
        import pandas as pd

        columns: dict[str, NDArray[np.float64]] = {}
        for name in FIELDS:
            if name in _saved.DIRECTORS:
                columns |= {f"{name}_{axis}": self._field(name)[:, k] for k, axis in enumerate("xyz")}
            elif name != "s":
                columns[name] = self._field(name)
        return pd.DataFrame(columns, index=pd.Index(self._field("s"), name="s"))


def _dataset(stations: _InSpace) -> xr.Dataset:
    """The stations along the coordinate `s`, directors along ``axis``, too."""
    import xarray as xr

    fields = {name: (("s", "axis")[: stations._field(name).ndim], stations._field(name), attributes(FIELDS, name)) for name in FIELDS}
    coordinate = fields.pop("s")
    return xr.Dataset(fields, coords={"s": coordinate, "axis": ["x", "y", "z"]})


class SpatialStations(_InSpace, Stations):
    """States along an arm in space, base to tip: read-only arrays of shape (n,), directors of shape (n, 3).

    As with `Stations`, they share memory with what solved them.
    """

    __slots__ = ()

    def to_xarray(self) -> xr.Dataset:
        """The stations along the coordinate `s`, directors along ``axis``, too, each with ``units`` and ``long_name``. Needs xarray."""
        return _dataset(self)


class SpatialSolution(_InSpace, Solution):
    """An arm in space in equilibrium: what `Arm.solve` and `Solver.solve` give for an arm with ``space = "spatial"``.

    It has the attributes of a `Solution`, with three components in place of two; `theta`, `m`, `surfaces` and `layer_speed` are only in the plane.

    Examples
    --------
    >>> import hydrostat as hs
    >>> sol = hs.Arm.load("silicone-spatial").solve(tensions=[0.1, 0.05, 0])
    >>> sol.a.shape == (len(sol), 3)
    True
    >>> tip = sol.tip
    >>> round(1e3 * tip.x, 1), round(1e3 * tip.y, 1), round(1e3 * tip.z, 1)  # mm
    (215.9, 52.9, 30.6)
    >>> sol.stable
    True
    """

    __slots__ = ()

    _inner: _native.SpatialSolution  # type: ignore[assignment]

    def __init__(self, native: _native.SpatialSolution, origin: Origin | Callable[[], Origin] | None = None) -> None:
        super().__init__(cast("_native.Solution", native), origin)

    def __repr__(self) -> str:
        tip = self.tip
        kinds = ", ".join(note.kind for note in self.warnings)
        notes = f"; warnings: {kinds}" if kinds else ""
        return f"<SpatialSolution of {self.arm.name!r}: tip at ({tip.x:.6g}, {tip.y:.6g}, {tip.z:.6g}) m{notes}>"

    def _place_in_words(self) -> str:
        tip = self.tip
        return f"tip at ({1e3 * tip.x:.2f}, {1e3 * tip.y:.2f}, {1e3 * tip.z:.2f}) mm, seen from e3"

    def _outline(self) -> NDArray[np.float64]:
        line = np.stack([self.x, self.y], axis=1)
        # Half as wide as a round section is, across the centreline on the page.
        one_side = self.surface(self.s, 1)[:, 0]
        radius = np.linalg.norm(one_side - np.stack([self.x, self.y, self.z], axis=1), axis=1)
        along = np.gradient(line, axis=0)
        across = np.stack([-along[:, 1], along[:, 0]], axis=1)
        across /= np.maximum(np.linalg.norm(across, axis=1), 1e-12)[:, None]
        off = radius[:, None] * across
        return np.concatenate([line + off, (line - off)[::-1]])

    @property
    def tip(self) -> SpatialTip:  # type: ignore[override]
        """Place of the tip, m, its directors, and alpha, rad."""
        return SpatialTip.of(*self._inner.tip)

    @property
    def snaps(self) -> tuple[Snap, ...]:
        """The snaps that the arm makes as its loads grow from nothing to these, in their order; their tips are `SpatialTip`."""
        return snaps_of(self._inner.snaps, tip_of)

    @property
    def base_reaction(self) -> SpatialWrench:  # type: ignore[override]
        """Force and moment of the support and the cable anchors on the arm at the base, N and N m."""
        return _wrench(self._inner.base_reaction)

    @property
    def unmet(self) -> SpatialWrench | None:  # type: ignore[override]
        """With ``support = "unstrained-base"``, the unbalanced force and moment at the tip."""
        unmet = self._inner.unmet
        return None if unmet is None else _wrench(unmet)

    def at(self, s: ArrayLike) -> SpatialStations:
        """Evaluate the solution at any places along the arm, as accurately as at the nodes.

        Parameters
        ----------
        s : array_like, shape (n,) or ()
            Lengths along the undeformed arm, m, from 0 to the arm's length.
        """
        return SpatialStations(cast("_native.Stations", self._inner.at(places_of(s))))

    def resampled(self, count: int) -> SpatialStations:
        """`count` (at least two) equally spaced stations from base to tip."""
        wanted = _inputs.count("count", count)
        _memory.require(2 * 8 * (len(FIELDS) + 6) * wanted, f"{wanted} stations", "ask for fewer")
        return SpatialStations(cast("_native.Stations", self._inner.resampled(wanted)))

    def surface(self, s: ArrayLike | None = None, sides: int = 24) -> NDArray[np.float64]:
        """Points of the deformed surface, m, shape (n, sides, 3): the arm's body for PyVista, Blender and the like.

        Parameters
        ----------
        s : array_like, shape (n,), optional
            Lengths along the undeformed arm, m; by default 100 equally spaced ones.
        sides : int
            Points round each section, from b towards c.

        Examples
        --------
        >>> import hydrostat as hs
        >>> sol = hs.Arm.load("silicone-spatial").solve()
        >>> sol.surface(sides=12).shape
        (100, 12, 3)
        """
        wanted = _inputs.count("sides", sides)
        if wanted < 1:
            raise ValueError(f"sides: expected at least 1, found {wanted}")
        places = np.linspace(0.0, self.arm.length, 100) if s is None else places_of(s)
        _memory.require(3 * 8 * len(places) * wanted, f"{len(places)} rings of {wanted} points", "ask for fewer")
        return self._inner.surface(places, wanted).reshape(len(places), wanted, 3)

    def surfaces(self, s: ArrayLike) -> NoReturn:
        """Only in the plane; in space `surface`."""
        _only_in_plane("surfaces", "surface")

    def layer_speed(self, s: float | str, y: float | str) -> NoReturn:
        """Only in the plane: a surface in space has no windward side."""
        _only_in_plane("layer_speed", "docs/model.md, the arm in space")

    def to_xarray(self) -> xr.Dataset:
        """The stations along `s`, directors along ``axis``, too, with tip, cables and base reaction as in `Solution.to_xarray`. Needs xarray."""
        return self._described(_dataset(self))

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
        """Draw the shape to scale on matplotlib's axes in three dimensions: surface, cables, directors at the tip, stream.

        Parameters
        ----------
        ax : mpl_toolkits.mplot3d.Axes3D, optional
            Axes to draw on; by default those of a new figure.
        color, sections, cables, flow, label, unit
            As in `Solution.plot`.

        Returns
        -------
        mpl_toolkits.mplot3d.Axes3D
            In that unit, with equal scales.

        Raises
        ------
        ValueError
            The axes are flat, or the unit differs from that of earlier drawings on them.
        """
        from hydrostat.plotting_3d import plot_in_space

        return plot_in_space(self, ax, color=color, sections=sections, cables=cables, flow=flow, label=label, unit=unit)

    def plot_strains(self, *, label: str | None = None, figure: MatplotlibFigure | None = None) -> MatplotlibFigure:
        """Stretch, both shears, twist and both bendings, and the angle alpha along the arm, in four panels. Needs matplotlib.

        Parameters
        ----------
        label : str, optional
            For the legends.
        figure : matplotlib.figure.Figure, optional
            A figure returned by an earlier call, to draw into.
        """
        from hydrostat.plotting_3d import plot_strains_in_space

        return plot_strains_in_space(self, label=label, figure=figure)


def _wrench(fields: tuple[Any, Any]) -> SpatialWrench:
    force, moment = fields
    return SpatialWrench(_vector(force), _vector(moment))
