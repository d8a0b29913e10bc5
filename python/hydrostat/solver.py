"""Repeated solves of one arm as its loads change."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from os import PathLike
from typing import TYPE_CHECKING, NamedTuple, cast

import numpy as np

from hydrostat import _inputs, _native, _units
from hydrostat.arm import Arm, arm_of
from hydrostat.solution import Solution, Tip, solution_of, warn
from hydrostat.spatial import SpatialTip

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from hydrostat.sensitivity import Sensitivities


class Answer(NamedTuple):
    """Where the tip is, m and rad (a `SpatialTip` of an arm in space), and the estimated error of its position, m."""

    tip: Tip
    error_estimate: float


class Solver:
    """Solves an arm repeatedly, starting from its last shape: for control loops. A small change of loads takes a few Newton rounds.

    Parameters
    ----------
    arm : Arm, str or path
        The arm, or the name or file of one.
    tol : float
        Tolerance on the tip position, relative to the arm's length, in [1e-12, 1e-2].
    snap_distance, snap_angle, follow_snaps
        Which snaps are followed; see `Arm.solve`.

    A copy continues from the same shape, independently.

    Examples
    --------
    >>> import hydrostat as hs
    >>> solver = hs.Solver(hs.Arm.load("silicone"))
    >>> solver.set_tensions([0.2, 0])
    >>> before = solver.update().tip
    >>> solver.set_tensions([0.21, 0])
    >>> solver.update().tip.theta > before.theta
    True
    """

    __slots__ = ("_inner",)

    def __init__(
        self,
        arm: Arm | str | PathLike[str],
        tol: float = 1e-8,
        *,
        snap_distance: float = 0.01,
        snap_angle: float | str = 2.0,
        follow_snaps: bool = False,
    ) -> None:
        snaps = _inputs.snaps(snap_distance, snap_angle, follow_snaps)
        native = arm_of(arm)._inner
        kind = _native.SpatialSolver if native.is_spatial else _native.Solver
        self._inner: _native.Solver | _native.SpatialSolver = kind(native, _inputs.number("tol", tol), snaps)

    def __copy__(self) -> Solver:
        out = Solver.__new__(Solver)
        out._inner = self._inner.copy()
        return out

    def __deepcopy__(self, memo: object) -> Solver:
        return self.__copy__()

    @property
    def tensions(self) -> NDArray[np.float64]:
        """The tensions that were set last, N, shape (cables,). For cables with a commanded stroke, see `solution`."""
        return np.array(self._inner.tensions)

    def set_tensions(self, tensions: _inputs.Numbers) -> None:
        """Set all tensions, N, or with units, shape (cables,)."""
        self._inner.set_tensions(_inputs.numbers("tensions", tensions, 1, key=_units.TENSION))

    def set_stroke(self, cable: int, stroke: float | str) -> None:
        """Command the stroke of a cable, m, or with a unit, positive when reeled in, in place of its tension."""
        self._inner.set_stroke(_inputs.count("cable", cable), _inputs.number("stroke", stroke, key=_units.STROKE))

    def set_flow_speed(self, flow_speed: float | str) -> None:
        """Set the speed of the stream, m/s, or with a unit."""
        self._inner.set_flow_speed(_inputs.number("flow_speed", flow_speed, negative=False, key=_units.SPEED))

    def solve(self) -> Solution:
        """Solve from the unloaded arm."""
        return warn(solution_of(self._inner.solve()), 2)

    def update(self) -> Answer:
        """Solve from the last shape (warm start), or from the unloaded arm if the arm moved too far. Returns the tip only."""
        if isinstance(self._inner, _native.SpatialSolver):
            fields, estimate = self._inner.update()
            return Answer(cast("Tip", SpatialTip.of(*fields)), estimate)
        x, y, theta, alpha, error_estimate = self._inner.update()
        return Answer(Tip(x, y, theta, alpha), error_estimate)

    def solution(self) -> Solution:
        """The full solution under the present loads, solved as `update` does where they changed since the last solve."""
        return warn(solution_of(self._inner.configuration()), 2)

    def sensitivities(
        self, parameters: Sequence[str] | None = None, *, stations: ArrayLike = (), method: str = "best"
    ) -> Sensitivities:
        """Return exact derivatives of tip, strokes and stations at the shape under the present loads.

        They follow from the converged equations, without finite differences. There is no derivative at a limit point, at a kink of
        the load that lies on a station, and where a cable just becomes slack.

        Parameters
        ----------
        parameters : sequence of str, optional
            Keys of the arm file: ``"cable[0].tension"`` (``"cable[0].stroke"`` of a cable whose stroke is commanded), ``"flow.speed"``,
            ``"tip.force[1]"``, ``"material.young"``, ``"cable[0].offset.base"``, ``"arm.radius.tip"``, the third point of a table
            ``"cable[0].offset[2][1]"`` and so on. By default, all that the arm has.
        stations : array_like, shape (n,)
            Further places along the arm, m, whose poses are differentiated; by ``"arm.length"``, places that keep their fraction of it.
        method : str
            ``"forward"`` solves once per parameter, ``"adjoint"`` once per quantity, ``"best"`` takes the cheaper one. All agree to
            rounding.

        Returns
        -------
        Sensitivities
            Arrays by quantity, one column per parameter, in SI units and radians; `SpatialSensitivities` of an arm in space.

        Raises
        ------
        NoDerivativeError
            At a limit point or a bifurcation.
        NoEquilibriumError
            There is no equilibrium.
        ValueError
            An argument is invalid; the message names it.
        """
        from hydrostat.sensitivity import Sensitivities, SpatialSensitivities

        names = None if parameters is None else _names(parameters)
        places = np.atleast_1d(_inputs.finite("stations", stations, key=_units.STROKE))
        if places.ndim != 1:
            raise ValueError(f"stations: expected one dimension, found shape {places.shape}")
        if isinstance(self._inner, _native.SpatialSolver):
            found, shape = self._inner.sensitivities(names, places, method)
            return SpatialSensitivities(cast("_native.Sensitivities", found), solution_of(shape), places)
        native, solution = self._inner.sensitivities(names, places, method)
        return Sensitivities(native, Solution(solution), places)

    def gradient(
        self,
        parameters: Sequence[str],
        stations: ArrayLike,
        *,
        x: ArrayLike = 0.0,
        y: ArrayLike = 0.0,
        theta: ArrayLike = 0.0,
        alpha: ArrayLike = 0.0,
        z: ArrayLike = 0.0,
        turn: ArrayLike = (0.0, 0.0, 0.0),
    ) -> NDArray[np.float64]:
        """Return the gradient of one number that depends on the shape, such as an objective, from one adjoint solve.

        The cost does not grow with the number of stations, and little with the number of parameters.

        Parameters
        ----------
        parameters : sequence of str
            As in `sensitivities`.
        stations : array_like, shape (n,)
            Places along the arm, m; the tip is at its length.
        x, y, theta, alpha : array_like, shape (n,) or ()
            Derivatives of the number by these quantities at the stations, per metre or radian; `theta` and `alpha` of arms in the
            plane.
        z : array_like, shape (n,) or ()
            The same of an arm in space.
        turn : array_like, shape (n, 3) or (3,)
            The same by turns of the sections about e1, e2, e3 of an arm in space.

        Returns
        -------
        ndarray, shape (p,)
            The derivatives, per unit of each parameter.

        Raises
        ------
        NoDerivativeError
            At a limit point or a bifurcation.
        NoEquilibriumError
            There is no equilibrium.
        ValueError
            An argument is invalid; the message names it.

        Examples
        --------
        The square of the distance of three places from a line.

        >>> import numpy as np, hydrostat as hs
        >>> arm = hs.Arm.load("silicone").replace(tensions=[0.2, 0.0])
        >>> solver = hs.Solver(arm)
        >>> s = np.array([0.1, 0.2, 0.245])
        >>> off = solver.solution().at(s).y - 0.02
        >>> gradient = solver.gradient(["cable[0].tension", "cable[0].offset.base"], s, y=2 * off)
        >>> gradient.shape
        (2,)
        """
        places = np.atleast_1d(_inputs.finite("stations", stations, key=_units.STROKE))
        if places.ndim != 1:
            raise ValueError(f"stations: expected one dimension, found shape {places.shape}")
        turns = _inputs.finite("turn", turn)
        if turns.shape not in ((3,), (*places.shape, 3)):
            raise ValueError(f"turn: expected the shape {(*places.shape, 3)}, found {turns.shape}")
        given = {"x": x, "y": y, "z": z, "theta": theta, "alpha": alpha}
        own = {name: _inputs.finite(name, value) for name, value in given.items()}
        for name, value in own.items():
            if value.shape not in ((), places.shape):
                raise ValueError(f"{name}: expected the shape {places.shape} of the stations, found {value.shape}")
        own |= {f"turn {axis}": np.broadcast_to(turns, (*places.shape, 3))[:, axis] for axis in range(3)}

        def picked(names: Sequence[str]) -> list[NDArray[np.float64]]:
            for name in own.keys() - set(names):
                if np.any(own[name] != 0.0):
                    raise ValueError(f"{name}: not of an arm {'in space' if spatial else 'in the plane'}")
            return [np.ascontiguousarray(np.broadcast_to(own[name], places.shape)) for name in names]

        inner, spatial = self._inner, isinstance(self._inner, _native.SpatialSolver)
        if isinstance(inner, _native.SpatialSolver):
            return inner.gradient(_names(parameters), places, picked(["x", "y", "z", "turn 0", "turn 1", "turn 2"]))
        return inner.gradient(_names(parameters), places, picked(["x", "y", "theta", "alpha"]))


def _names(parameters: Sequence[str]) -> list[str]:
    if isinstance(parameters, str) or not isinstance(parameters, Iterable):
        raise ValueError(f"parameters: expected a sequence of keys, found {parameters!r}")
    return [_inputs.text("parameters", name, "flow.speed") for name in parameters]
