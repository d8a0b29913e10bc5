"""Exceptions: a wrong request is a `ValueError`, no equilibrium is a `NoEquilibriumError` with the verdict's fields."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hydrostat import _native
    from hydrostat.solution import Snap, Solution


class ModelWarning(UserWarning):
    """A warning about a solution: its surface folds, its shape depends strongly on an uncertain load, and so on.

    Raised by `Arm.solve`, `Solver.solve` and `Solver.solution`, and by `Arm.path`, `Arm.equilibria` and `Arm.reach` once per kind
    for all their solutions; once per kind and place of the program with Python's usual filters;
    ``warnings.filterwarnings("ignore", category=hydrostat.ModelWarning)`` silences it. `Solution.warnings` has them with their numbers.

    Attributes
    ----------
    kind : str
        ``"surface_fold"``, ``"strain_range"``, ``"tension_above_max"``, ``"sealed_cavity"``, ``"tangential_load"`` or
        ``"tolerance_missed"``. Not a snap: an accepted snap is within the given bounds.
    """

    kind: str

    def __init__(self, message: str, kind: str = "") -> None:
        super().__init__(message)
        self.kind = kind

    def __reduce__(self) -> tuple[type[ModelWarning], tuple[str, str]]:
        return type(self), (str(self), self.kind)


class ArmError(ValueError):
    """The input does not describe an arm.

    Attributes
    ----------
    key : str or None
        The dotted key of the arm file that is wrong, such as ``"arm.length"``.
    """

    key: str | None

    def __init__(self, message: str, key: str | None = None) -> None:
        super().__init__(message)
        self.key = key

    def __reduce__(self) -> tuple[type[ArmError], tuple[str, str | None]]:
        return type(self), (str(self), self.key)


class MeasurementsError(ValueError):
    """A table of measurements is invalid.

    Attributes
    ----------
    row : int or None
        The row that is wrong, from 1 as a spreadsheet counts.
    column : str or None
        The head of its column.
    """

    row: int | None
    column: str | None

    def __init__(self, message: str, row: int | None = None, column: str | None = None) -> None:
        super().__init__(message)
        self.row = row
        self.column = column

    def __reduce__(self) -> tuple[type[MeasurementsError], tuple[str, int | None, str | None]]:
        return type(self), (str(self), self.row, self.column)


class NoEquilibriumError(RuntimeError):
    """The arm has no such equilibrium, or none was found.

    The subclasses say which limit was met: `CableFoldError`, `SectionCrushedError`, `NoSectionSolutionError`, `LimitPointError`, `LoadJumpError`, `NotFoundError`.

    Attributes
    ----------
    kind : str
        The limit: ``"cable_fold"``, ``"section_crushed"``, ``"no_section_solution"``, ``"limit_point"``, ``"load_jump"``
        or ``"not_found"``.
    phase : str
        The loads that were being raised: ``"loads"`` (all but the cables), ``"tension"``, ``"stroke"`` or ``"friction"``.
    load_fraction : float
        The fraction of that phase's loads at which the limit was met, 0 to 1.
    where : float or None
        The place along the arm, m, if the limit is local.
    residual : float
        The last Newton correction when the solver stopped, the largest change of an angle, rad; not a residual of the equations.
    message, advice : str
        The verdict in a sentence, and advice.
    last_good : Solution or None
        The last good shape on the path, with its loads.
    snaps : tuple of Snap
        The snaps on the way; where the arm snaps too far, that snap is the last.
    after_snap : Solution or None
        The shape after such a snap, with the loads of that moment.
    at_full_loads : Solution or None
        The shape at the full loads, if the path continues to them after such a snap: the answer with ``follow_snaps=True``.
    """

    kind: str
    phase: str
    load_fraction: float
    where: float | None
    residual: float
    message: str
    advice: str
    last_good: Solution | None
    snaps: tuple[Snap, ...]
    after_snap: Solution | None
    at_full_loads: Solution | None

    def __init__(
        self,
        kind: str,
        phase: str,
        load_fraction: float,
        where: float | None,
        residual: float,
        message: str,
        advice: str,
        last_good: Solution | None = None,
        snaps: tuple[Snap, ...] = (),
        after_snap: Solution | None = None,
        at_full_loads: Solution | None = None,
    ) -> None:
        super().__init__(f"{message}; {advice}")
        self.kind = kind
        self.phase = phase
        self.load_fraction = load_fraction
        self.where = where
        self.residual = residual
        self.message = message
        self.advice = advice
        self.last_good = last_good
        self.snaps = snaps
        self.after_snap = after_snap
        self.at_full_loads = at_full_loads

    def __reduce__(self) -> tuple[type[NoEquilibriumError], tuple[object, ...]]:
        fields = (self.kind, self.phase, self.load_fraction, self.where, self.residual, self.message, self.advice)
        return type(self), (*fields, self.last_good, self.snaps, self.after_snap, self.at_full_loads)


class CableFoldError(NoEquilibriumError):
    """A cable compresses its side of the arm to zero length."""


class SectionCrushedError(NoEquilibriumError):
    """Net compression crushes the section."""


class NoSectionSolutionError(NoEquilibriumError):
    """No section strains carry the contact force."""


class LimitPointError(NoEquilibriumError):
    """The equilibrium path turns back: beyond this load the arm would snap to another shape."""


class LoadJumpError(NoEquilibriumError):
    """The load of the stream jumps against the motion, so that no shape balances it."""


class NotFoundError(NoEquilibriumError):
    """No limit was established: the solver gave up."""


class MotionError(RuntimeError):
    """A motion ends before its time, or an arm does not come to rest after a snap.

    Attributes
    ----------
    kind : str
        ``"cable_fold"``, ``"section_crushed"``, ``"no_section_solution"``, ``"short_waves"``, ``"not_found"``, ``"too_many_steps"`` or
        ``"no_rest"``.
    time : float
        Up to when the motion is known, s; NaN after a snap.
    where : float or None
        The place along the arm, m, if the limit is local.
    data : object
        What was found before: of `simulate` the dataset, of `history` the history, else None.
    """

    kind: str
    time: float
    where: float | None
    data: Any

    def __init__(self, message: str, kind: str = "", time: float = float("nan"), where: float | None = None, data: Any = None) -> None:
        super().__init__(message)
        self.kind = kind
        self.time = time
        self.where = where
        self.data = data

    def __reduce__(self) -> tuple[type[MotionError], tuple[object, ...]]:
        return type(self), (str(self), self.kind, self.time, self.where, self.data)


class NoDerivativeError(ArithmeticError):
    """The equilibrium has no derivative: it is at a limit point or a bifurcation, or did not converge closely enough."""


_KINDS: dict[str, type[NoEquilibriumError]] = {
    "cable_fold": CableFoldError,
    "section_crushed": SectionCrushedError,
    "no_section_solution": NoSectionSolutionError,
    "limit_point": LimitPointError,
    "load_jump": LoadJumpError,
    "not_found": NotFoundError,
}


def no_equilibrium(
    kind: str,
    phase: str,
    load_fraction: float,
    where: float | None,
    residual: float,
    message: str,
    advice: str,
    last_good: _native.Solution | _native.SpatialSolution | None,
    snaps: list[Any],
    after_snap: _native.Solution | _native.SpatialSolution | None,
    at_full_loads: _native.Solution | _native.SpatialSolution | None,
) -> NoEquilibriumError:
    """The exception of a verdict; called by the extension module."""
    from hydrostat.solution import solution_of, snaps_of
    from hydrostat.spatial import tip_of

    good, after, full = (None if shape is None else solution_of(shape) for shape in (last_good, after_snap, at_full_loads))
    make = _KINDS.get(kind, NoEquilibriumError)
    return make(kind, phase, load_fraction, where, residual, message, advice, good, snaps_of(snaps, tip_of), after, full)


# The names of version 0.1, kept for a version.
NoEquilibrium = NoEquilibriumError
CableFold = CableFoldError
SectionCrushed = SectionCrushedError
NoSectionSolution = NoSectionSolutionError
LimitPoint = LimitPointError
LoadJump = LoadJumpError
NotFound = NotFoundError
NoDerivative = NoDerivativeError
