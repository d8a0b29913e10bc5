"""One arm, again and again as its loads change."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from hydrostat import _inputs, _native
from hydrostat.solution import Solution, Tip

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from hydrostat.arm import Arm


class Answer(NamedTuple):
    """Where the tip is, m and rad, and the estimated error of its position, m."""

    tip: Tip
    error_estimate: float


class Solver:
    """Solves an arm anew from its last shape, for control loops: a small change of loads takes a few Newton rounds.

    Parameters
    ----------
    arm : Arm
        The arm.
    tol : float
        Error of the tip position over the length, in [1e-12, 1e-2].

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

    def __init__(self, arm: Arm, tol: float = 1e-8) -> None:
        self._inner = _native.Solver(arm._inner, _inputs.number("tol", tol))

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
        return Solution(self._inner.solve())

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
