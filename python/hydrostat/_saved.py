"""Results that travel: what pickles and files hold, and what stands in for the extension module's objects afterwards.

A result is saved as its numbers, which come back bit by bit, and as how it was made. What the numbers do not hold (the shape between its
stations, drawings, stability) is made again when it is first asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from hydrostat import _native

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: The version of what pickles and files hold. Others are refused by name.
FORMAT = 3

#: How far (over the length) a tip that was made again may be from the one that was saved and still be of the same shape.
_SAME = 1e-6

#: Fields of stations, in the order of the extension module's.
FIELDS = ("s", "x", "y", "theta", "nu", "eta", "mu", "beta", "alpha", "n_a", "n_b", "m")
#: The same of an arm in space: numbers, and directors, which have three components.
NUMBERS_IN_SPACE = (
    *("s", "x", "y", "z", "nu", "eta", "zeta", "tau", "kappa", "mu", "beta", "alpha"),
    *("n_a", "n_b", "n_c", "m_a", "m_b", "m_c"),
)
DIRECTORS = ("a", "b", "c")


class Origin(NamedTuple):
    """How a result was made: a function of `_MAKERS` and its arguments."""

    maker: str
    arguments: tuple[Any, ...]

    def make(self) -> Any:
        """The extension module's object, made again."""
        return _MAKERS[self.maker](*self.arguments)


class Saved:
    """Stands in for an object of the extension module: it has what was stored, and makes the object again for all else."""

    #: What is stored under the name that the object has for it.
    _plain: tuple[str, ...] = ()

    def __init__(self, stored: Mapping[str, Any], origin: Origin) -> None:
        self._stored = dict(stored)
        self._origin = origin
        self._live: Any = None

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__") or name in ("_stored", "_origin", "_live"):
            raise AttributeError(name)
        return self._stored[name] if name in self._plain else getattr(self.live(), name)

    def live(self) -> Any:
        """The object, made again."""
        if self._live is None:
            self._live = self._origin.make()
        return self._live


def live(native: Any) -> Any:
    """The extension module's object itself."""
    return native.live() if isinstance(native, Saved) else native


class SavedStations(Saved):
    """Stations of a solution; all of them are stored."""

    def field(self, name: str) -> NDArray[np.float64]:
        array: NDArray[np.float64] = self._stored["fields"][name]
        return array

    #: Directors are stored beside numbers.
    directors = field


class SavedSolution(SavedStations):
    """An equilibrium."""

    _plain: tuple[str, ...] = (
        *("tol", "bounds", "cables", "base_reaction", "unmet", "error_estimate", "strain_energy", "fold_margin", "statistics"),
        "snaps",
    )

    #: Fields that say where the arm is.
    _place: tuple[str, ...] = ("x", "y")

    @property
    def arm(self) -> _native.Arm:
        return _native.Arm(*self._stored["arm"])

    @property
    def tip(self) -> tuple[float, float, float, float]:
        x, y, theta, alpha = (float(self.field(name)[-1]) for name in ("x", "y", "theta", "alpha"))
        return x, y, theta, alpha

    def warnings(self) -> list[tuple[str, str]]:
        return list(self._stored["warnings"])

    def stability(self) -> tuple[str | None, int | None, bool | None]:
        kept: tuple[str | None, int | None, bool | None] | None = self._stored["stability"]
        return self.live().stability() if kept is None else kept

    def live(self) -> Any:
        if self._live is None:
            made = self._origin.make()
            length = float(self.field("s")[-1])
            one, other = (np.array([native.field(name)[-1] for name in self._place]) for native in (made, self))
            off = float(np.linalg.norm(one - other))
            if not off <= _SAME * length:
                raise RuntimeError(
                    "this shape was saved, and a solve of its arm leads to another one: what was saved of it (stations, tip, cables, "
                    "warnings and so on) is there; places between its stations, drawings and stability are not"
                )
            self._live = made
        return self._live


class SavedSpatialSolution(SavedSolution):
    """An equilibrium of an arm in space."""

    _place = ("x", "y", "z")

    @property
    def tip(self) -> Any:
        x, y, z, alpha = (float(self.field(name)[-1]) for name in ("x", "y", "z", "alpha"))
        a, b, c = (self.directors(name)[-1].tolist() for name in DIRECTORS)
        return x, y, z, a, b, c, alpha


def is_spatial(native: Any) -> bool:
    """Whether a solution, of the extension module or saved, is of an arm in space."""
    return isinstance(native, (_native.SpatialSolution, SavedSpatialSolution))


def _fields(native: Any) -> dict[str, NDArray[np.float64]]:
    if not is_spatial(native):
        return {name: np.array(native.field(name)) for name in FIELDS}
    numbers = {name: np.array(native.field(name)) for name in NUMBERS_IN_SPACE}
    return numbers | {name: np.array(native.directors(name)) for name in DIRECTORS}


def solution_state(native: Any, origin: Origin, stability: tuple[str | None, int | None, bool | None] | None) -> dict[str, Any]:
    """What is stored of a solution, which the extension module or `SavedSolution` holds."""
    state = {name: getattr(native, name) for name in SavedSolution._plain}
    state["fields"] = _fields(native)
    state["space"] = is_spatial(native)
    state["arm"] = native.arm.parts()
    state["warnings"] = native.warnings()
    state["stability"] = native._stored["stability"] if stability is None and isinstance(native, SavedSolution) else stability
    state["origin"] = tuple(origin)
    return state


def solution_of(state: Mapping[str, Any]) -> SavedSolution:
    """What stands in for the solution of a state."""
    for array in state["fields"].values():
        array.flags.writeable = False
    kind = SavedSpatialSolution if state.get("space") else SavedSolution
    return kind(state, Origin(*state["origin"]))


def own_origin(native: Any, tol: float) -> Origin:
    """A solve of the arm that a shape balances."""
    return Origin("solve", (native.arm.parts(), None, None, None, tol, native.bounds))


class SavedPath(Saved):
    """A path and its shapes."""

    @property
    def axis(self) -> tuple[str, str, float]:
        axis: tuple[str, str, float] = self._stored["axis"]
        return axis

    @property
    def range(self) -> list[float]:
        return list(self._stored["range"])

    @property
    def branches(self) -> list[tuple[int, str, str, float | None]]:
        return list(self._stored["branches"])

    @property
    def in_space(self) -> bool:
        return bool(self._stored.get("in_space", False))

    def values(self, branch: int) -> NDArray[np.float64]:
        return _fixed(self._stored["values"][branch])

    def states(self, branch: int) -> Any:
        return _states(self._stored["states"][branch])

    def events(self, branch: int) -> Any:
        return self._stored["events"][branch]

    def solution(self, branch: int, point: int) -> SavedSolution:
        return solution_of(self._stored["solutions"][branch][point])


def path_state(native: Any, origin: Origin) -> dict[str, Any]:
    """What is stored of a path."""
    branches = range(len(native.branches))
    points = [range(count) for count, *_ in native.branches]
    return {
        "axis": native.axis,
        "in_space": native.in_space,
        "range": native.range,
        "branches": native.branches,
        "values": [native.values(branch) for branch in branches],
        "states": [native.states(branch) for branch in branches],
        "events": [native.events(branch) for branch in branches],
        "solutions": [
            [_part(native.solution(branch, point), Origin("point", (origin, branch, point))) for point in points[branch]]
            for branch in branches
        ],
        "origin": tuple(origin),
    }


class SavedEquilibria(Saved):
    """All equilibria of an arm."""

    _plain = ("complete", "misses_some", "in_space", "angles", "steps")

    def __len__(self) -> int:
        return len(self._stored["solutions"])

    def states(self) -> Any:
        return _states(self._stored["states"])

    def solution(self, index: int) -> SavedSolution:
        return solution_of(self._stored["solutions"][index])

    def to_json(self) -> str:
        return str(self._stored["json"])

    def to_csv(self) -> str:
        return str(self._stored["csv"])


def equilibria_state(native: Any, origin: Origin) -> dict[str, Any]:
    """What is stored of equilibria."""
    return {
        "complete": native.complete,
        "misses_some": native.misses_some,
        "in_space": native.in_space,
        "angles": native.angles,
        "steps": native.steps,
        "states": native.states(),
        "solutions": [_part(native.solution(k), Origin("equilibrium", (origin, k))) for k in range(len(native))],
        "json": native.to_json(),
        "csv": native.to_csv(),
        "origin": tuple(origin),
    }


class SavedReach(Saved):
    """Tensions that reach targets."""

    @property
    def counts(self) -> tuple[int, bool]:
        counts: tuple[int, bool] = self._stored["counts"]
        return counts

    def fields(self, index: int) -> Any:
        tensions, *rest = self._stored["fields"][index]
        return (_fixed(tensions), *rest)

    def solution(self, index: int) -> SavedSolution:
        return solution_of(self._stored["solutions"][index])

    def to_json(self) -> str:
        return str(self._stored["json"])

    def to_csv(self) -> str:
        return str(self._stored["csv"])


def reach_state(native: Any, origin: Origin) -> dict[str, Any]:
    """What is stored of what was found for targets."""
    count, closest = native.counts
    indices = range(count + closest)
    return {
        "counts": native.counts,
        "fields": [native.fields(index) for index in indices],
        "solutions": [_part(native.solution(index), Origin("reached", (origin, index))) for index in indices],
        "json": native.to_json(),
        "csv": native.to_csv(),
        "origin": tuple(origin),
    }


class SavedBoundary(Saved):
    """What bounds the places of the tip."""

    def to_json(self) -> str:
        return str(self._stored["json"])

    def to_csv(self) -> str:
        return str(self._stored["csv"])


def boundary_state(native: Any, origin: Origin) -> dict[str, Any]:
    """What is stored of a boundary."""
    return {"json": native.to_json(), "csv": native.to_csv(), "origin": tuple(origin)}


class SavedFit(SavedBoundary):
    """A fit with its shapes."""

    def to_toml(self) -> str:
        return str(self._stored["toml"])

    def shapes(self) -> list[tuple[str, SavedSolution]]:
        return [(name, solution_of(state)) for name, state in self._stored["shapes"]]


def fit_state(native: Any, origin: Origin) -> dict[str, Any]:
    """What is stored of a fit."""
    shapes = enumerate(native.shapes())
    return {
        **boundary_state(native, origin),
        "toml": native.to_toml(),
        "shapes": [(name, _part(shape, Origin("fitted", (origin, k)))) for k, (name, shape) in shapes],
    }


class SavedSensitivities(Saved):
    """Derivatives; all of them are stored."""

    @property
    def parameters(self) -> list[tuple[str, str]]:
        return list(self._stored["parameters"])

    def tip(self) -> Any:
        return [_fixed(array) for array in self._stored["tip"]]

    def strokes(self) -> NDArray[np.float64]:
        return _fixed(self._stored["strokes"])

    def tensions(self) -> NDArray[np.float64]:
        return _fixed(self._stored["tensions"])

    def stations(self) -> Any:
        return [_fixed(array) for array in self._stored["stations"]]

    def compliance(self) -> Any:
        return self._stored["compliance"]

    def manipulability(self) -> Any:
        return self._stored["manipulability"]


def sensitivities_state(native: Any) -> dict[str, Any]:
    """What is stored of derivatives."""
    arrays = {"tip": native.tip(), "strokes": native.strokes(), "tensions": native.tensions(), "stations": native.stations()}
    return {
        **arrays,
        "parameters": native.parameters,
        "compliance": native.compliance(),
        "manipulability": native.manipulability(),
    }


def _part(native: Any, origin: Origin) -> dict[str, Any]:
    return solution_state(native, native._origin if isinstance(native, Saved) else origin, None)


def _fixed(array: NDArray[np.float64]) -> NDArray[np.float64]:
    array.flags.writeable = False
    return array


def _states(states: Any) -> Any:
    tip, state, directions = states
    return [_fixed(array) for array in tip], state, directions


def check(kind: str, version: int, writer: str) -> None:
    """Raise where something was saved in another format."""
    if version != FORMAT:
        raise ValueError(
            f"{kind}: was saved in format {version} by hydrostat {writer}; hydrostat {_native.__version__} reads format {FORMAT} alone"
        )


def same(one: Any, other: Any) -> bool:
    """Whether two states are the same to the last bit, NaN being NaN."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        one, other = np.asarray(one), np.asarray(other)
        numbers = one.dtype.kind == "f" and other.dtype.kind == "f"
        return one.shape == other.shape and bool(np.array_equal(one, other, equal_nan=numbers))
    if isinstance(one, Mapping):
        return isinstance(other, Mapping) and one.keys() == other.keys() and all(same(one[key], other[key]) for key in one)
    if isinstance(one, Sequence) and not isinstance(one, str):
        is_alike = isinstance(other, Sequence) and not isinstance(other, str) and len(one) == len(other)
        return is_alike and all(same(a, b) for a, b in zip(one, other, strict=True))
    return bool(one == other) or (one != one and other != other)


def _arm(parts: tuple[Any, ...]) -> _native.Arm:
    return _native.Arm(*parts)


def _solve(
    arm: tuple[Any, ...],
    tensions: Any,
    strokes: Any,
    flow_speed: float | None,
    tol: float,
    snaps: Sequence[float],
    after_snap: bool = False,
) -> _native.Solution | _native.SpatialSolution:
    pulled = None if tensions is None else np.asarray(tensions, dtype=np.float64)
    return _arm(arm).solve(pulled, strokes, flow_speed, tol, (snaps[0], snaps[1]), after_snap)


def _of_arm(function: Callable[..., Any]) -> Callable[..., Any]:
    """The function of an arm's parts."""
    return lambda arm, *arguments: function(_arm(arm), *arguments)


_MAKERS: dict[str, Callable[..., Any]] = {
    "solve": _solve,
    "path": _of_arm(_native.path),
    "point": lambda origin, branch, point: Origin(*origin).make().solution(branch, point),
    "equilibria": _of_arm(_native.equilibria),
    "equilibrium": lambda origin, index: Origin(*origin).make().solution(index),
    "reach": _of_arm(_native.reach),
    "reached": lambda origin, index: Origin(*origin).make().solution(index),
    "reachable": _of_arm(_native.reachable),
    "identify": _of_arm(_native.identify),
    "fitted": lambda origin, index: Origin(*origin).make().shapes()[index][1],
}
