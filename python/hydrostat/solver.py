"""One arm, again and again as its loads change."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from os import PathLike
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from hydrostat import _inputs, _native
from hydrostat.arm import Arm, arm_of
from hydrostat.solution import Solution, Tip, warn

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from hydrostat.sensitivity import Sensitivities


class Answer(NamedTuple):
    """Where the tip is, m and rad, and the estimated error of its position, m."""

    tip: Tip
    error_estimate: float


class Solver:
    """Solves an arm anew from its last shape, for control loops: a small change of loads takes a few Newton rounds.

    Parameters
    ----------
    arm : Arm, str or path
        The arm, or the name or file of one.
    tol : float
        Error of the tip position over the length, in [1e-12, 1e-2].
    snap_distance : float
        How far the tip may jump at a snap on the way to the loads, over the length; an arm that snaps further has no answer.
    snap_angle : float or str
        How far it may turn there: degrees, or a string with a unit.
    follow_snaps : bool
        Whether every snap is followed, however far.

    A copy goes on from the same shape, by itself.

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
        self._inner = _native.Solver(arm_of(arm)._inner, _inputs.number("tol", tol), snaps)

    def __copy__(self) -> Solver:
        out = Solver.__new__(Solver)
        out._inner = self._inner.copy()
        return out

    def __deepcopy__(self, memo: object) -> Solver:
        return self.__copy__()

    @property
    def tensions(self) -> NDArray[np.float64]:
        """The tensions that were set last, N, shape (cables,); those of cables whose strokes are commanded are in `solution`."""
        return np.array(self._inner.tensions)

    def set_tensions(self, tensions: ArrayLike) -> None:
        """Set all tensions, N, shape (cables,)."""
        self._inner.set_tensions(_inputs.numbers("tensions", tensions, 1))

    def set_stroke(self, cable: int, stroke: float) -> None:
        """Command the stroke of a cable, m, positive when reeled in, in place of its tension."""
        self._inner.set_stroke(_inputs.count("cable", cable), _inputs.number("stroke", stroke))

    def set_flow_speed(self, flow_speed: float) -> None:
        """Set the speed of the stream, m/s."""
        self._inner.set_flow_speed(_inputs.number("flow_speed", flow_speed, negative=False))

    def solve(self) -> Solution:
        """Solve from the unloaded arm."""
        return warn(Solution(self._inner.solve()), 2)

    def resolve(self) -> Solution:
        """Solve from the last shape, or from the unloaded arm where the arm moved too far."""
        return Solution(self._inner.resolve())

    def update(self) -> Answer:
        """Where the tip is now: `resolve` that reads nothing else out."""
        x, y, theta, alpha, error_estimate = self._inner.update()
        return Answer(Tip(x, y, theta, alpha), error_estimate)

    def solution(self) -> Solution:
        """Everything about the last `update`."""
        return Solution(self._inner.configuration())

    def sensitivities(
        self, parameters: Sequence[str] | None = None, *, stations: ArrayLike = (), method: str = "best"
    ) -> Sensitivities:
        """Exact derivatives of tip, strokes and stations about the shape under the present loads.

        They are those of the converged equations; nothing is differenced. At a kink of the load that lies on a station, at a limit
        point and where a cable just goes slack there is no derivative.

        Parameters
        ----------
        parameters : sequence of str, optional
            Keys of the arm file: ``"cable[0].tension"`` (``"cable[0].stroke"`` of a cable whose stroke is commanded), ``"flow.speed"``,
            ``"tip.force[1]"``, ``"material.young"``, ``"cable[0].offset.base"``, ``"arm.radius.tip"``, the third point of a table
            ``"cable[0].offset[2][1]"`` and so on; all that the arm has without it.
        stations : array_like, shape (n,)
            Further places along the arm, m, whose poses are differentiated.
        method : str
            ``"forward"`` solves once a parameter, ``"adjoint"`` once a quantity, ``"best"`` whichever are fewer. All give the same
            numbers to rounding.

        Returns
        -------
        Sensitivities
            Arrays by quantity, a column a parameter, in SI units and radians.

        Raises
        ------
        NoDerivativeError
            At a limit point or a bifurcation.
        NoEquilibriumError
            There is no shape.
        ValueError
            An argument that cannot be meant, named.
        """
        from hydrostat.sensitivity import Sensitivities

        names = None if parameters is None else _names(parameters)
        places = np.atleast_1d(_inputs.finite("stations", stations))
        if places.ndim != 1:
            raise ValueError(f"stations: expected one dimension, found shape {places.shape}")
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
    ) -> NDArray[np.float64]:
        """The gradient of one number that follows the shape, such as an objective, by one adjoint solve.

        What it costs does not grow with the number of stations, and little with that of the parameters.

        Parameters
        ----------
        parameters : sequence of str
            As of `sensitivities`.
        stations : array_like, shape (n,)
            Places along the arm, m; the tip is at its length.
        x, y, theta, alpha : array_like, shape (n,) or ()
            The number's own derivatives by these at the stations, a metre or a radian.

        Returns
        -------
        ndarray, shape (p,)
            Its derivatives, a unit of each parameter.

        Raises
        ------
        NoDerivativeError
            At a limit point or a bifurcation.
        NoEquilibriumError
            There is no shape.
        ValueError
            An argument that cannot be meant, named.

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
        places = np.atleast_1d(_inputs.finite("stations", stations))
        if places.ndim != 1:
            raise ValueError(f"stations: expected one dimension, found shape {places.shape}")
        weights = []
        for name, given in (("x", x), ("y", y), ("theta", theta), ("alpha", alpha)):
            own = _inputs.finite(name, given)
            if own.shape not in ((), places.shape):
                raise ValueError(f"{name}: expected the shape {places.shape} of the stations, found {own.shape}")
            weights.append(np.ascontiguousarray(np.broadcast_to(own, places.shape)))
        return self._inner.gradient(_names(parameters), places, weights)


def _names(parameters: Sequence[str]) -> list[str]:
    if isinstance(parameters, str) or not isinstance(parameters, Iterable):
        raise ValueError(f"parameters: expected a sequence of keys, found {parameters!r}")
    return [_inputs.text("parameters", name, "flow.speed") for name in parameters]
