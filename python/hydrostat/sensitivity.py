"""Exact derivatives of an equilibrium by parameters of the arm and its loads."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, cast

import numpy as np

from hydrostat import _inputs, _native, _saved
from hydrostat._saved import Origin
from hydrostat.solution import Result, Solution

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

_POSE = {"x": "m", "y": "m", "theta": "rad", "alpha": "rad"}


class PoseChange(NamedTuple):
    """Changes of `x`, `y` (m), `theta` and `alpha` (rad) per unit of each parameter; the last dimension is the parameters."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    theta: NDArray[np.float64]
    alpha: NDArray[np.float64]


class SpatialPoseChange(NamedTuple):
    """Changes of `x`, `y`, `z` (m) in space, and turns of the section about e1, e2, e3 (rad), per unit of each parameter; the last
    dimension is the parameters. A director d changes by turn x d."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    z: NDArray[np.float64]
    turn_x: NDArray[np.float64]
    turn_y: NDArray[np.float64]
    turn_z: NDArray[np.float64]


class Ellipsoid(NamedTuple):
    """Manipulability ellipsoid in space: the image of the unit ball of tensions or strokes.

    Attributes
    ----------
    half_axes : ndarray, shape (3,)
        The longest first, m per unit of the parameters.
    directions : ndarray, shape (3, 3)
        The direction of each, one a row.
    """

    half_axes: NDArray[np.float64]
    directions: NDArray[np.float64]


class Ellipse(NamedTuple):
    """Manipulability ellipse: how the tip moves per unit of effort, the image of the unit circle (or ball) of tensions or strokes.

    Attributes
    ----------
    half_axes : tuple of float
        The longer first, m per unit of the parameters.
    direction : float
        The direction of the longer one from e1, rad, in (-pi/2, pi/2].
    """

    half_axes: tuple[float, float]
    direction: float

    @classmethod
    def of(cls, jacobian: ArrayLike) -> Ellipse:
        """Of a jacobian of shape (2, n)."""
        columns = _inputs.finite("jacobian", jacobian)
        if columns.ndim != 2 or columns.shape[0] != 2:
            raise ValueError(f"jacobian: expected the shape (2, n), found {columns.shape}")
        half_axes, direction = _native.ellipse(columns.T.tolist())
        return cls((half_axes[0], half_axes[1]), direction)

    def points(self, count: int = 90) -> NDArray[np.float64]:
        """`count` places on it about the origin, shape (count, 2), m per unit of the parameters."""
        turn = np.linspace(0.0, 2.0 * np.pi, count)
        along, across = self.half_axes[0] * np.cos(turn), self.half_axes[1] * np.sin(turn)
        cos, sin = np.cos(self.direction), np.sin(self.direction)
        return np.stack([cos * along - sin * across, sin * along + cos * across], axis=1)


class Sensitivities(Result):
    """Derivatives of a shape by parameters, in SI units and radians per unit of each parameter.

    They come from the converged equations (implicit function theorem), not from differences; see `Solver.sensitivities`.

    Attributes
    ----------
    parameters : tuple of str
        The p parameters, as keys of the arm file.
    units : tuple of str
        The units of these, in radians for angles, empty for plain numbers.
    solution : Solution
        The shape at which they hold.
    tip : PoseChange
        Of the tip, arrays of shape (p,).
    strokes : ndarray, shape (cables, p)
        Of the stroke of every cable, m.
    tensions : ndarray, shape (cables, p)
        Of the tension of every cable, N: zero unless a stroke is commanded; one by its own tension.
    stations : ndarray, shape (n,)
        The requested places along the arm, m.
    poses : PoseChange
        Of these places, arrays of shape (n, p).
    """

    tip: PoseChange
    strokes: NDArray[np.float64]
    tensions: NDArray[np.float64]
    stations: NDArray[np.float64]
    poses: PoseChange
    #: Units of the changes of a pose.
    _pose: ClassVar[dict[str, str]] = _POSE
    #: What changes of a pose are.
    _change: ClassVar[Any] = PoseChange

    def __init__(self, native: _native.Sensitivities, solution: Solution, stations: NDArray[np.float64]) -> None:
        self._inner = native
        self.solution = solution
        self.parameters = tuple(name for name, _ in native.parameters)
        self.units = tuple(unit for _, unit in native.parameters)
        count = len(self.parameters)
        self.tip = self._change(*native.tip())
        self.strokes = native.strokes().reshape(-1, count)
        self.tensions = native.tensions().reshape(-1, count)
        self.stations = stations
        self.poses = self._change(*(array.reshape(-1, count) for array in native.stations()))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sensitivities):
            return NotImplemented
        states = ((_saved.sensitivities_state(one._inner), one.stations) for one in (self, other))
        return _saved.same(*states) and self.solution == other.solution

    def __hash__(self) -> int:
        return hash((self.parameters, self.solution))

    def __reduce__(self) -> tuple[Any, ...]:
        state = _saved.sensitivities_state(self._inner)
        return self._restored, (_saved.FORMAT, _native.__version__, state, self.solution, self.stations)

    #: What a pickle is read by.
    _restored: ClassVar[Any]

    def __repr__(self) -> str:
        return f"<{type(self).__name__} by {', '.join(self.parameters)}>"

    def index(self, parameter: str) -> int:
        """The place of a parameter in the last dimension of the arrays."""
        if parameter not in self.parameters:
            raise ValueError(f"parameter: expected one of {', '.join(self.parameters)}, found {parameter!r}")
        return self.parameters.index(parameter)

    @property
    def quantities(self) -> tuple[str, ...]:
        """The rows of `jacobian`: ``"tip.x"``, ``"stroke[0]"``, ``"tension[0]"``, ``"station[0].theta"`` and so on."""
        cables = range(len(self.strokes))
        tip = [f"tip.{name}" for name in self._pose]
        ropes = [f"stroke[{c}]" for c in cables] + [f"tension[{c}]" for c in cables]
        return (*tip, *ropes, *(f"station[{k}].{name}" for k in range(len(self.stations)) for name in self._pose))

    def jacobian(
        self, quantities: Sequence[str] | None = None, parameters: Sequence[str] | None = None
    ) -> NDArray[np.float64]:
        """Derivatives as one matrix.

        Parameters
        ----------
        quantities : sequence of str, optional
            The rows, some of `quantities`; all without it.
        parameters : sequence of str, optional
            The columns, some of `parameters`; all without it.

        Returns
        -------
        ndarray, shape (q, p)
        """
        all_of = self.quantities
        stations = np.stack(self.poses, axis=1).reshape(-1, len(self.parameters))
        rows = np.concatenate([np.stack(self.tip), self.strokes, self.tensions, stations])
        for name in quantities or ():
            if name not in all_of:
                raise ValueError(f"quantities: expected some of {', '.join(all_of)}, found {name!r}")
        wanted = range(len(all_of)) if quantities is None else [all_of.index(name) for name in quantities]
        by = range(len(self.parameters)) if parameters is None else [self.index(name) for name in parameters]
        picked: NDArray[np.float64] = rows[np.ix_(list(wanted), list(by))]
        return picked

    def tip_jacobian(self, parameters: Sequence[str]) -> NDArray[np.float64]:
        """d (x, y) of the tip by some parameters, shape (2, k), m per unit."""
        return self.jacobian(("tip.x", "tip.y"), parameters)

    def compliance(self) -> NDArray[np.float64] | None:
        """Compliance of the tip, shape (3, 3): rows x (m), y (m), theta (rad); columns the dead forces along e1 and e2 (N), the moment
        (N m). None if ``"tip.force[0]"``, ``"tip.force[1]"`` or ``"tip.moment"`` is not among the parameters."""
        rows = self._inner.compliance()
        return None if rows is None else np.array(rows)

    def manipulability(self) -> Ellipse | None:
        """The ellipse of the tip by the tensions (m/N) or strokes (m/m) among the parameters; None if there are none."""
        found = self._inner.manipulability()
        return None if found is None else Ellipse((found[0][0], found[0][1]), found[1])

    def to_xarray(self) -> xr.Dataset:
        """The derivatives along ``parameter``, with ``cable`` and ``s`` (m). Needs xarray.

        Returns
        -------
        xarray.Dataset
            ``tip_x`` and so on over ``parameter``, ``stroke`` and ``tension`` over ``cable`` and ``parameter``, ``x``, ``y``, ``theta``,
            ``alpha`` over ``s`` and ``parameter``; ``unit`` of each parameter as a coordinate.
        """
        import xarray as xr

        variables: dict[str, tuple[tuple[str, ...], NDArray[np.float64], dict[str, str]]] = {}
        for name, unit in self._pose.items():
            about = {"units": f"{unit} a unit of the parameter"}
            variables[f"tip_{name}"] = (("parameter",), getattr(self.tip, name), about)
            if len(self.stations):
                variables[name] = (("s", "parameter"), getattr(self.poses, name), about)
        variables["stroke"] = (("cable", "parameter"), self.strokes, {"units": "m a unit of the parameter"})
        variables["tension"] = (("cable", "parameter"), self.tensions, {"units": "N a unit of the parameter"})
        coordinates = {
            "parameter": ("parameter", list(self.parameters)),
            "unit": ("parameter", list(self.units)),
            "cable": ("cable", [cable.name for cable in self.solution.cables]),
        }
        if len(self.stations):
            coordinates["s"] = ("s", self.stations, {"units": "m"})  # type: ignore[assignment]
        return xr.Dataset(variables, coords=coordinates)

    def plot_manipulability(self, ax: Axes | None = None, *, effort: float | None = None) -> Axes:
        """Draw the shape with its manipulability ellipse about the tip. Needs matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axis to draw on; by default that of a new figure.
        effort : float, optional
            The change that the ellipse represents, N (m for strokes): root of the sum of squares. By default, such that the ellipse is a
            fifth of the arm long.

        Raises
        ------
        ValueError
            No tension or stroke is among the parameters.
        """
        from hydrostat.plotting import plot_manipulability

        return plot_manipulability(self, ax, effort)


class SpatialSensitivities(Sensitivities):
    """Derivatives of a shape in space by parameters; see `Sensitivities`.

    `tip` and `poses` are `SpatialPoseChange`: motions in space, and turns of the sections.
    """

    tip: SpatialPoseChange  # type: ignore[assignment]
    poses: SpatialPoseChange  # type: ignore[assignment]
    _pose: ClassVar[dict[str, str]] = {"x": "m", "y": "m", "z": "m", "turn_x": "rad", "turn_y": "rad", "turn_z": "rad"}
    _change: ClassVar[Any] = SpatialPoseChange

    def tip_jacobian(self, parameters: Sequence[str]) -> NDArray[np.float64]:
        """d (x, y, z) of the tip by some parameters, shape (3, k), m a unit."""
        return self.jacobian(("tip.x", "tip.y", "tip.z"), parameters)

    def compliance(self) -> NDArray[np.float64] | None:
        """Compliance of the tip, shape (6, 6): rows x, y, z (m) and turns about e1, e2, e3 (rad); columns the dead forces (N) and moments
        (N m) along and about them. None if one of ``"tip.force[0]"`` to ``"tip.force[2]"``, ``"tip.moment[0]"``, ``"tip.moment[1]"``
        and ``"tip.moment"`` is not among the parameters."""
        return super().compliance()

    def manipulability(self) -> Ellipsoid | None:  # type: ignore[override]
        """The ellipsoid of the tip by the tensions (m/N) or strokes (m/m) among the parameters; None if there are none."""
        found: Any = self._inner.manipulability()
        return None if found is None else Ellipsoid(np.array(found[0]), np.array(found[1]))

    def plot_manipulability(self, ax: Axes | None = None, *, effort: float | None = None) -> Axes:
        """Of arms in the plane."""
        raise ValueError('plot_manipulability: for arms in the plane, and this arm has `space = "spatial"`')


def _sensitivities(
    version: int, writer: str, state: dict[str, Any], solution: Solution, stations: NDArray[np.float64]
) -> Sensitivities:
    _saved.check("Sensitivities", version, writer)
    saved = _saved.SavedSensitivities(state, Origin("none", ()))
    return Sensitivities(cast("_native.Sensitivities", saved), solution, stations)


def _spatial_sensitivities(
    version: int, writer: str, state: dict[str, Any], solution: Solution, stations: NDArray[np.float64]
) -> SpatialSensitivities:
    _saved.check("SpatialSensitivities", version, writer)
    saved = _saved.SavedSensitivities(state, Origin("none", ()))
    return SpatialSensitivities(cast("_native.Sensitivities", saved), solution, stations)


Sensitivities._restored = staticmethod(_sensitivities)
SpatialSensitivities._restored = staticmethod(_spatial_sensitivities)
