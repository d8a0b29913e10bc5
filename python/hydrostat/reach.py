"""Inverse kinematics: tensions that bring an arm to targets, and along a path of targets."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import cached_property
from os import PathLike
from typing import TYPE_CHECKING, Any, NamedTuple, Union, cast, overload

import numpy as np

from hydrostat import _inputs, _native, _saved, _units
from hydrostat._saved import Origin
from hydrostat.arm import Arm, arm_of
from hydrostat.figures import Figure
from hydrostat.solution import Result, Solution, Stations, Tip, solution_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

#: A number, or a string with a unit.
Number = Union[float, str]


class _Target(NamedTuple):
    x: float
    y: float
    s: float | None = None
    angle: float | None = None
    weight: float = 1.0


class Target(_Target):
    """A target for one place of the arm.

    Attributes
    ----------
    x, y : float
        The target, m, or a string with a unit.
    s : float or None
        The place of the arm, m along it, or a string with a unit; None for the tip.
    angle : float or None
        Angle of the section from e1, degrees, or a string with a unit, if it matters. In distances, one radian counts as one length
        of the arm.
    weight : float
        Weight of its distance among several targets.

    Examples
    --------
    >>> import hydrostat as hs
    >>> hs.Target("182 mm", 0.078, angle="0.5 rad").x
    0.182
    """

    __slots__ = ()

    def __new__(cls, x: Number, y: Number, s: Number | None = None, angle: Number | None = None, weight: float = 1.0) -> Target:
        along, across = _units.plain("x", x, _units.STROKE), _units.plain("y", y, _units.STROKE)
        return super().__new__(cls, along, across, _units.plain("s", s, _units.STROKE), _units.plain("angle", angle, _units.ANGLE), weight)


class _SpatialTarget(NamedTuple):
    x: float
    y: float
    z: float
    s: float | None = None
    direction: tuple[float, float, float] | None = None
    weight: float = 1.0


class SpatialTarget(_SpatialTarget):
    """A target for one place of an arm in space.

    Attributes
    ----------
    x, y, z : float
        The target, m, or a string with a unit.
    s : float or None
        The place of the arm, m along it, or a string with a unit; None for the tip.
    direction : tuple of float or None
        Direction of the section's normal a, of any length, if it matters. In distances, one radian counts as one length of the arm.
    weight : float
        Weight of its distance among several targets.
    """

    __slots__ = ()

    def __new__(
        cls,
        x: Number,
        y: Number,
        z: Number,
        s: Number | None = None,
        direction: tuple[float, float, float] | None = None,
        weight: float = 1.0,
    ) -> SpatialTarget:
        one, two, three, at = (_units.plain(name, value, _units.STROKE) for name, value in (("x", x), ("y", y), ("z", z), ("s", s)))
        return super().__new__(cls, one, two, three, at, direction, weight)


#: One target, several, or the tip's ``(x, y)``, m, a pair, a list or an array of two.
Targets = Union[Target, Sequence[Union[Number, Target, Sequence[Number]]], "NDArray[Any]"]

#: The same of an arm in space: ``(x, y, z)``.
SpatialTargets = Union[SpatialTarget, Sequence[Union[Number, SpatialTarget, Sequence[Number]]], "NDArray[Any]"]

#: Either.
AnyTargets = Union[Target, SpatialTarget, Sequence[Union[Number, Target, SpatialTarget, Sequence[Number]]], "NDArray[Any]"]

#: The largest tension of all cables, or of each.
Most = Union[Number, Sequence[Number], "NDArray[Any]"]


class Bound(NamedTuple):
    """A bound that tensions lie on: of the `cable` (its index) that is ``"slack"`` and would have to push, has the ``"most"`` tension, or its
    largest ``"stroke"``."""

    kind: str
    cable: int


class Reached(Result):
    """Tensions and their shape.

    Attributes
    ----------
    tensions : ndarray, shape (cables,)
        N.
    effort : float
        Sum of their squares, N^2.
    distance : float
        Root of the weighted sum of squared distances to the targets, relative to the arm's length.
    bounds : tuple of Bound
        The bounds that its tensions lie on.
    on_the_path : bool
        Whether `Arm.solve` gives this shape at these tensions.
    stability : str or None
        ``"stable"``, ``"unstable"``, ``"marginal"``, or None if not established.
    unstable_directions : int or None
        Number of directions in which small motions grow.
    """

    tensions: NDArray[np.float64]

    def __init__(self, native: _native.Reach, index: int, targets: tuple[Target, ...] | tuple[SpatialTarget, ...], origin: Origin) -> None:
        self._native = native
        self._origin = origin
        self._index = index
        self._targets = targets
        self.tensions, self.effort, self.distance, bounds, self.on_the_path, state = native.fields(index)
        self.bounds = tuple(Bound(*bound) for bound in bounds)
        self.stability, self.unstable_directions = state

    @cached_property
    def solution(self) -> Solution:
        """The shape."""
        return solution_of(self._native.solution(self._index), Origin("reached", (self._origin, self._index)))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Reached):
            return NotImplemented
        mine, theirs = ((one._native.fields(one._index), one._targets) for one in (self, other))
        return _saved.same(mine, theirs) and self.solution == other.solution

    def __hash__(self) -> int:
        return hash((self.tensions.tobytes(), self._targets))

    def __reduce__(self) -> tuple[Any, ...]:
        return _reached, (Reach(self._native, self._targets, self._origin), self._index)

    @cached_property
    def places(self) -> Stations:
        """The arm at the places of targets that have an `s`, in the order of the targets."""
        return self.solution.at([target.s for target in self._targets if target.s is not None])

    def figure(self, note: str | None = None) -> Figure:
        """The shape to scale with the targets, as ``hydrostat reach --plot`` draws it; `note` is the text below."""
        return Figure(self._native.figure(self._index, note))

    def __repr__(self) -> str:
        pulls = ", ".join(f"{tension:.6g}" for tension in self.tensions)
        return f"<Reached with ({pulls}) N, off by {self.distance:.2g} of the length>"


class BoundaryPiece(NamedTuple):
    """One piece of the boundary: places of the tip in order.

    Attributes
    ----------
    kind : str
        ``"edge"``: all cables but one are at a bound; ``"fold"``: a singularity, two cables move the tip along the same line; ``"limit"``: two pulled further
        have no equilibrium.
    cables : tuple of int
        The cables that are between their bounds.
    tensions : ndarray, shape (n, cables)
        N.
    x, y : ndarray, shape (n,)
        The tip, m.
    theta, alpha : ndarray, shape (n,)
        Its angles, rad.
    """

    kind: str
    cables: tuple[int, ...]
    tensions: NDArray[np.float64]
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    theta: NDArray[np.float64]
    alpha: NDArray[np.float64]


class Boundary(Result, Sequence[BoundaryPiece]):
    """The boundary of the workspace, with pieces inside it where the workspace covers itself; see `Arm.reachable`. A sequence of
    `BoundaryPiece`: edges first, then singularities (kind ``fold``), then limits."""

    def __init__(self, native: _native.Boundary, origin: Origin) -> None:
        self._inner = native
        self._origin = origin
        self._pieces = tuple(_piece(one) for one in json.loads(native.to_json())["pieces"])

    def __len__(self) -> int:
        return len(self._pieces)

    @overload
    def __getitem__(self, index: int) -> BoundaryPiece: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[BoundaryPiece]: ...
    def __getitem__(self, index: int | slice) -> BoundaryPiece | Sequence[BoundaryPiece]:
        return self._pieces[index]

    def __eq__(self, other: object) -> bool:
        return self.to_json() == other.to_json() if isinstance(other, Boundary) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.to_json())

    def __reduce__(self) -> tuple[Any, ...]:
        return _boundary, (_saved.FORMAT, _native.__version__, _saved.boundary_state(self._inner, self._origin))

    def __repr__(self) -> str:
        return f"<Boundary: {len(self)} piece(s)>"

    def to_json(self) -> str:
        """The document of ``hydrostat reach --boundary --format json``."""
        return self._inner.to_json()

    def to_csv(self) -> str:
        """One row per point, as ``hydrostat reach --boundary --format csv`` prints them."""
        return self._inner.to_csv()

    def figure(self) -> Figure:
        """The boundary to scale with the slack arm, as ``hydrostat reach --boundary --plot`` draws it."""
        return Figure(self._inner.figure())


def _piece(one: dict[str, Any]) -> BoundaryPiece:
    def column(name: str) -> NDArray[np.float64]:
        return np.array([point["tip"][name] for point in one["points"]], dtype=np.float64)

    tensions = np.array([point["tensions"] for point in one["points"]], dtype=np.float64)
    return BoundaryPiece(
        one["kind"], tuple(one["cables"]), tensions, column("x"), column("y"), column("theta"), column("alpha")
    )


class Reach(Result, Sequence[Reached]):
    """The solutions of an inverse-kinematics search, least effort first, as a sequence; see `Arm.reach`.

    Attributes
    ----------
    targets : tuple of Target or SpatialTarget
        The targets.
    closest : Reached or None
        If nothing reaches them, the nearest shape found.
    """

    def __init__(self, native: _native.Reach, targets: tuple[Target, ...] | tuple[SpatialTarget, ...], origin: Origin) -> None:
        self._inner = native
        self._origin = origin
        count, closest = native.counts
        self._all = tuple(Reached(native, index, targets, origin) for index in range(count))
        self.targets = targets
        self.closest = Reached(native, count, targets, origin) if closest else None

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Reach):
            return NotImplemented
        states = ((_saved.reach_state(one._inner, one._origin), one.targets) for one in (self, other))
        return _saved.same(*states)

    def __hash__(self) -> int:
        return hash((len(self), self.targets))

    def __reduce__(self) -> tuple[Any, ...]:
        return _reach, (_saved.FORMAT, _native.__version__, self.targets, _saved.reach_state(self._inner, self._origin))

    @property
    def solutions(self) -> tuple[Reached, ...]:
        """The same as a tuple."""
        return self._all

    def __len__(self) -> int:
        return len(self._all)

    @overload
    def __getitem__(self, index: int) -> Reached: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Reached]: ...
    def __getitem__(self, index: int | slice) -> Reached | Sequence[Reached]:
        return self._all[index]

    def __repr__(self) -> str:
        if self.closest is not None:
            return f"<Reach: not reached, the closest shape misses by {self.closest.distance:.2g} of the length>"
        return f"<Reach: {len(self)} solution(s)>"

    def to_json(self) -> str:
        """The document of ``hydrostat reach --format json``."""
        return self._inner.to_json()

    def to_csv(self) -> str:
        """One row per solution, as ``hydrostat reach --format csv`` prints them."""
        return self._inner.to_csv()

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw all solutions, or the closest, with the targets on one axis. Needs matplotlib."""
        from hydrostat.plotting import plot_reach

        return plot_reach(self, ax)


def _reached(reach: Reach, index: int) -> Reached:
    found = reach.solutions if reach.closest is None else (*reach.solutions, reach.closest)
    return found[index]


def _reach(
    version: int, writer: str, targets: tuple[Target, ...] | tuple[SpatialTarget, ...], state: dict[str, Any]) -> Reach:
    _saved.check("Reach", version, writer)
    origin = Origin(*state["origin"])
    return Reach(cast("_native.Reach", _saved.SavedReach(state, origin)), targets, origin)


def _boundary(version: int, writer: str, state: dict[str, Any]) -> Boundary:
    _saved.check("Boundary", version, writer)
    origin = Origin(*state["origin"])
    return Boundary(cast("_native.Boundary", _saved.SavedBoundary(state, origin)), origin)


class Followed(NamedTuple):
    """The result of one step of a follower.

    Attributes
    ----------
    tensions : ndarray, shape (cables,)
        N.
    tip : Tip
        m and rad.
    distance : float
        Root of the weighted sum of squared distances to the targets, relative to the arm's length.
    reached : bool
        Whether the distance is within the tolerance.
    jumped : bool
        Whether the arm jumped to another branch of equilibria.
    solves : int
        Number of solves.
    """

    tensions: NDArray[np.float64]
    tip: Tip
    distance: float
    reached: bool
    jumped: bool
    solves: int


class Follower:
    """Follows a path of targets with warm starts, for control loops.

    It starts from the tensions of the arm if they reach the first targets, otherwise from the solution of least effort. A copy
    continues from the same shape, independently.

    Parameters
    ----------
    arm : Arm, str or path
        The arm, or the name or file of one.
    targets : Target, sequence of Target, or (x, y)
        The first targets, m and degrees, or with units.
    max_tension : float, str or sequence, optional
        The largest tension of every cable, N, or of each; a smaller `max_tension` of the cable itself holds.
    max_stroke : float, optional
        The largest stroke of every taut cable, m: how much can be reeled in.
    tol : float
        Tolerance on the distance to a target, relative to the arm's length, in [1e-10, 1e-2].

    Raises
    ------
    NoEquilibriumError
        The arm has no equilibrium to start from.
    ValueError
        An argument is invalid; the message names it.

    Examples
    --------
    >>> import hydrostat as hs
    >>> arm = hs.Arm.load("silicone").replace(tensions=[0.3, 0.1])
    >>> tip = arm.solve().tip
    >>> follower = hs.Follower(arm, (tip.x, tip.y))
    >>> steps = [follower.follow((tip.x, tip.y - 2e-4 * k)) for k in range(1, 11)]
    >>> all(step.reached and not step.jumped for step in steps)
    True
    """

    __slots__ = ("_inner",)

    def __init__(
        self,
        arm: Arm | str | PathLike[str],
        targets: Targets,
        *,
        max_tension: Most | None = None,
        max_stroke: Number | None = None,
        tol: float = 1e-8,
    ) -> None:
        own, most = bounded(arm_of(arm), max_tension, max_stroke)
        goals, within = goals_of(targets_of(targets)), _inputs.number("tol", tol)
        self._inner = _native.Follower(own._inner, goals, most, within, True)

    def __copy__(self) -> Follower:
        out = Follower.__new__(Follower)
        out._inner = self._inner.copy()
        return out

    def __deepcopy__(self, memo: object) -> Follower:
        return self.__copy__()

    def follow(self, targets: Targets) -> Followed:
        """Go to the next targets. They must be for the same places of the arm as the first ones.

        If they cannot be reached, the arm stays at the nearest shape, and ``reached`` is false.

        Parameters
        ----------
        targets : Target, sequence of Target, or (x, y)
            m and degrees, or with units.
        """
        tensions, tip, distance, reached, jumped, solves = self._inner.follow(goals_of(targets_of(targets)))
        return Followed(tensions, Tip(*tip), distance, reached, jumped, solves)

    @property
    def tensions(self) -> NDArray[np.float64]:
        """The present tensions, N, shape (cables,)."""
        return self._inner.tensions

    @property
    def strokes(self) -> NDArray[np.float64]:
        """The stroke of each cable there, m, shape (cables,)."""
        return np.array([cable.stroke for cable in self.solution().cables])

    def solution(self) -> Solution:
        """The present shape in full.

        Raises
        ------
        RuntimeError
            The follower is on a branch that `Arm.solve` does not give.
        """
        return Solution(self._inner.solution())

    def set_flow_speed(self, flow_speed: Number) -> None:
        """Set another speed of the stream, m/s, or with a unit. The tensions stay, the shape changes; the next targets are followed from there.

        Raises
        ------
        NoEquilibriumError
            The arm has no equilibrium in that stream; nothing changes.
        """
        self._inner.set_flow_speed(_inputs.number("flow_speed", flow_speed, negative=False, key=_units.SPEED))

    def set_bounds(self, *, max_tension: Number | None = None, max_stroke: Number | None = None) -> None:
        """Set other bounds, N and m, or with units, at the present shape; None leaves the cables' own bounds only."""
        self._inner.set_bounds(most_of(max_tension, max_stroke))


def most_of(max_tension: Number | None, max_stroke: Number | None) -> tuple[float | None, float | None]:
    """Bounds as numbers; what is wrong is a `ValueError`."""
    given = (("max_tension", max_tension, _units.TENSION), ("max_stroke", max_stroke, _units.STROKE))
    tension, stroke = (None if value is None else _inputs.number(name, value, key=key) for name, value, key in given)
    return tension, stroke


def bounded(arm: Arm, max_tension: Most | None, max_stroke: Number | None) -> tuple[Arm, tuple[float | None, float | None]]:
    """The arm whose cables have bounds of their own, where one is given for each, and the bounds of all cables."""
    if max_tension is None or isinstance(max_tension, str) or np.ndim(max_tension) == 0:
        return arm, most_of(cast("Number | None", max_tension), max_stroke)
    given = _inputs.finite("max_tension", max_tension, negative=False, key=_units.TENSION)
    if given.shape != (len(arm.cables),):
        raise ValueError(f"max_tension: expected one number, or one for each of {len(arm.cables)} cables, found shape {given.shape}")
    tables = arm.to_dict().get("cable", [])
    own = [float(table.get("max_tension", np.inf)) for table in tables]
    changes = {f"cable[{k}].max_tension": min(float(most), own[k]) for k, most in enumerate(given)}
    # Its own tensions, which do not count, may be above.
    pulls = [min(float(table.get("tension", 0.0)), most) for table, most in zip(tables, changes.values(), strict=True)]
    held = {f"cable[{k}].tension": pull for k, pull in enumerate(pulls) if "tension" in tables[k]}
    return arm.replace({**held, **changes}), most_of(None, max_stroke)


def targets_of(targets: Targets) -> list[Target]:
    """Targets as a list, angles in degrees; what is wrong is a `ValueError`."""
    if isinstance(targets, Target):
        return [_checked("targets", targets)]
    given = _several("targets or (x, y)", targets, 2)
    if given is None:
        x, y = (_inputs.number(f"targets[{k}]", value, key=_units.STROKE) for k, value in enumerate(cast("Sequence[Number]", targets)))
        return [Target(x, y)]
    return [
        _checked(f"targets[{k}]", one if isinstance(one, Target) else Target(*_placed(f"targets[{k}]", one))) for k, one in enumerate(given)
    ]


def goals_of(targets: list[Target]) -> list[tuple[float, float, float | None, float | None, float]]:
    """Targets as the extension module takes them, angles in radians."""
    return [
        (one.x, one.y, one.s, None if one.angle is None else _native.angle(repr(one.angle)), one.weight) for one in targets
    ]


def spatial_targets_of(targets: Any) -> list[SpatialTarget]:
    """Targets of an arm in space as a list; what is wrong is a `ValueError`."""
    if isinstance(targets, SpatialTarget):
        return [_checked_in_space("targets", targets)]
    given = _several("SpatialTarget or (x, y, z) of an arm in space", targets, 3)
    if given is None:
        x, y, z = (_inputs.number(f"targets[{k}]", value, key=_units.STROKE) for k, value in enumerate(targets))
        return [SpatialTarget(x, y, z)]
    return [
        _checked_in_space(f"targets[{k}]", one if isinstance(one, SpatialTarget) else _in_space(f"targets[{k}]", one))
        for k, one in enumerate(given)
    ]


def _several(what: str, targets: Any, count: int) -> list[Any] | None:
    """Several targets, each one or a place of `count` numbers; None where `targets` is one place."""
    try:
        given: list[Any] = [] if isinstance(targets, str) else list(targets)
    except TypeError as error:
        raise ValueError(f"targets: expected {what}, found {targets!r}") from error
    kind = Target if count == 2 else SpatialTarget

    def is_place(one: Any) -> bool:
        return isinstance(one, (list, tuple, np.ndarray)) and not isinstance(one, (Target, SpatialTarget)) and len(one) == count

    if given and all(isinstance(one, kind) or is_place(one) for one in given):
        return given
    if len(given) != count or any(np.ndim(one) for one in given):
        raise ValueError(f"targets: expected {what}, found {targets!r}")
    return None


def _in_space(name: str, place: Sequence[Number]) -> SpatialTarget:
    x, y, z = _placed(name, place)
    return SpatialTarget(x, y, z)


def _placed(name: str, place: Sequence[Number]) -> list[float]:
    return [_inputs.number(f"{name}[{k}]", value, key=_units.STROKE) for k, value in enumerate(place)]


def _checked_in_space(name: str, target: SpatialTarget) -> SpatialTarget:
    x, y, z, s, direction, weight = target
    along = None
    if direction is not None:
        if len(direction) != 3:
            raise ValueError(f"{name}.direction: expected three numbers, found {direction!r}")
        one, two, three = (_inputs.number(f"{name}.direction[{k}]", value) for k, value in enumerate(direction))
        along = (one, two, three)
    return SpatialTarget(
        _inputs.number(f"{name}.x", x),
        _inputs.number(f"{name}.y", y),
        _inputs.number(f"{name}.z", z),
        None if s is None else _inputs.number(f"{name}.s", s),
        along,
        _inputs.number(f"{name}.weight", weight),
    )


def _checked(name: str, target: Target) -> Target:
    x, y, s, angle, weight = target
    return Target(
        _inputs.number(f"{name}.x", x),
        _inputs.number(f"{name}.y", y),
        None if s is None else _inputs.number(f"{name}.s", s),
        None if angle is None else _inputs.number(f"{name}.angle", angle),
        _inputs.number(f"{name}.weight", weight),
    )
