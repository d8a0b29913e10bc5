"""Paths over a parameter, and all equilibria under the same loads."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, cast, overload

import numpy as np

from hydrostat import _native, _saved
from hydrostat._saved import Origin
from hydrostat.figures import Figure, equilibria_figure, path_figure, path_shapes_figure
from hydrostat.solution import Result, Solution, solution_of

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from numpy.typing import NDArray


class Event(NamedTuple):
    """An event at a point of a branch: its index, ``"limit_point"``, ``"bifurcation"``, ``"slack"`` or ``"taut"``, the
    parameter there, and the cable that goes slack or taut."""

    point: int
    name: str
    value: float
    cable: int | None


class Branch(Result, Sequence[Solution]):
    """One branch of a path: equilibria in order, as a sequence of solutions.

    Attributes
    ----------
    values : ndarray, shape (n,)
        The parameter, in the path's unit.
    tip_x, tip_y, tip_z, tip_theta, tip_alpha : ndarray, shape (n,)
        The tip, m and rad: `tip_z` is 0 in the plane, `tip_theta` not a number in space.
    stability : tuple of str or None
        Of each point.
    unstable_directions : tuple of int or None
        Of each point.
    events : tuple of Event
        Limit points and so on, in their order.
    end : str
        Why the branch ends: ``"reached_end"``, ``"reached_start"``, ``"most_points"``, or the limit beyond which there is no equilibrium.
    message : str
        The same in a sentence.
    switched_at : float or None
        Value at the bifurcation where this branch starts.
    """

    values: NDArray[np.float64]
    tip_x: NDArray[np.float64]
    tip_y: NDArray[np.float64]
    tip_z: NDArray[np.float64]
    tip_theta: NDArray[np.float64]
    tip_alpha: NDArray[np.float64]
    stability: tuple[str | None, ...]
    unstable_directions: tuple[int | None, ...]
    events: tuple[Event, ...]

    def __init__(self, path: _native.Path, index: int, origin: Origin) -> None:
        self._path = path
        self._origin = origin
        self._index = index
        self._count, self.end, self.message, self.switched_at = path.branches[index]
        self.values = path.values(index)
        tip, state, directions = path.states(index)
        self.tip_x, self.tip_y, third, self.tip_alpha = tip
        if path.in_space:
            self.tip_z, self.tip_theta = third, np.full_like(third, np.nan)
        else:
            self.tip_z, self.tip_theta = np.zeros_like(third), third
        self.stability = tuple(state)
        self.unstable_directions = tuple(directions)
        self.events = tuple(
            Event(point, event[0], float(self.values[point]), event[1])
            for point, event in enumerate(path.events(index))
            if event is not None
        )

    def __len__(self) -> int:
        return self._count

    @overload
    def __getitem__(self, point: int) -> Solution: ...
    @overload
    def __getitem__(self, point: slice) -> Sequence[Solution]: ...
    def __getitem__(self, point: int | slice) -> Solution | Sequence[Solution]:
        if isinstance(point, slice):
            return [self[k] for k in range(*point.indices(self._count))]
        at = point + self._count if point < 0 else point
        if not 0 <= at < self._count:
            raise IndexError(f"point {point} of a branch of {self._count}")
        return solution_of(self._path.solution(self._index, at), Origin("point", (self._origin, self._index, at)))

    def __repr__(self) -> str:
        return f"<Branch: {len(self)} points, {self.end}>"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Branch):
            return NotImplemented
        return self._index == other._index and _of(self) == _of(other)

    def __hash__(self) -> int:
        return hash((self._index, len(self)))

    def __reduce__(self) -> tuple[Any, ...]:
        return _branch, (_of(self), self._index)


def _of(branch: Branch) -> EquilibriumPath:
    return EquilibriumPath(branch._path, branch._origin)


def _branch(path: EquilibriumPath, index: int) -> Branch:
    return path.branches[index]


class EquilibriumPath(Result):
    """Equilibria over a range of one parameter (continuation); see `Arm.path`.

    Attributes
    ----------
    parameter : str
        The parameter that varies.
    unit : str
        The unit of its values.
    range : tuple of float
        From and to.
    branches : tuple of Branch
        The branch of the solve at the start, then those switched to.
    """

    def __init__(self, native: _native.Path, origin: Origin) -> None:
        self._inner = native
        self._origin = origin
        self.parameter, self.unit, _ = native.axis
        self.range = tuple(native.range)
        self.branches = tuple(Branch(native, index, origin) for index in range(len(native.branches)))

    def __repr__(self) -> str:
        points = sum(len(branch) for branch in self.branches)
        return f"<EquilibriumPath over {self.parameter}: {points} points on {len(self.branches)} branch(es)>"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, EquilibriumPath):
            return NotImplemented
        return _saved.same(_saved.path_state(self._inner, self._origin), _saved.path_state(other._inner, other._origin))

    def __hash__(self) -> int:
        return hash((self.parameter, self.range, len(self.branches)))

    def __reduce__(self) -> tuple[Any, ...]:
        return _path, (_saved.FORMAT, _native.__version__, _saved.path_state(self._inner, self._origin))

    def to_pandas(self) -> pd.DataFrame:
        """All points, one row each: branch, parameter, tip, stability, event. Needs pandas."""
        import pandas as pd

        frames = []
        for index, branch in enumerate(self.branches):
            events = {event.point: event.name for event in branch.events}
            columns = {
                "branch": index,
                self.parameter: branch.values,
                "tip_x": branch.tip_x,
                "tip_y": branch.tip_y,
                **({"tip_z": branch.tip_z} if self._inner.in_space else {"tip_theta": branch.tip_theta}),
                "tip_alpha": branch.tip_alpha,
                "stability": branch.stability,
                "event": [events.get(point) for point in range(len(branch))],
            }
            frames.append(pd.DataFrame(columns))
        return pd.concat(frames, ignore_index=True)

    def to_json(self) -> str | None:
        """The document of ``hydrostat path --format json``; None of a path without points."""
        return self._inner.to_json()

    def to_csv(self) -> str:
        """The points as ``hydrostat path --format csv`` prints them."""
        return self._inner.to_csv()

    def figure(self, quantity: str = "tip.y", title: str | None = None) -> Figure:
        """The chart that the program draws; see `path_figure`."""
        return path_figure(self, quantity, title)

    def shapes_figure(self, title: str | None = None) -> Figure:
        """Shapes to scale; see `path_shapes_figure`."""
        return path_shapes_figure(self, title)

    def plot(self, quantity: str = "tip_y", ax: Axes | None = None) -> Axes:
        """Draw ``tip_x``, ``tip_y``, ``tip_z``, ``tip_theta`` (in the plane) or ``tip_alpha``, or ``tip.x`` and so on, over the parameter: stable solid, others dashed. Needs
        matplotlib."""
        from hydrostat.plotting import plot_path

        return plot_path(self, quantity, ax)


class Equilibria(Result, Sequence[Solution]):
    """All equilibria of an arm under its loads, in the order of the tip's angle, in space of its place; see `Arm.equilibria`.

    Attributes
    ----------
    complete : bool
        Whether these are known to be all: the closed curve of equilibria was followed completely. Never so in space.
    misses_some : bool
        Whether it is known that some are missing, in space.
    tip_angles, base_angles : tuple of float or None
        Angles over which the curve was followed, rad; None in space.
    stability : tuple of str or None
        Of each equilibrium.
    unstable_directions : tuple of int or None
        Of each equilibrium.
    """

    def __init__(self, native: _native.Equilibria, origin: Origin) -> None:
        self._inner = native
        self._origin = origin
        self.complete = native.complete
        self.misses_some = native.misses_some
        self.tip_angles: tuple[float, float] | None = None
        self.base_angles: tuple[float, float] | None = None
        if native.angles is not None:
            tip, base = native.angles
            self.tip_angles = (tip[0], tip[1])
            self.base_angles = (base[0], base[1])
        _, state, directions = native.states()
        self.stability = tuple(state)
        self.unstable_directions = tuple(directions)

    def __len__(self) -> int:
        return len(self._inner)

    @overload
    def __getitem__(self, index: int) -> Solution: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Solution]: ...
    def __getitem__(self, index: int | slice) -> Solution | Sequence[Solution]:
        if isinstance(index, slice):
            return [self[k] for k in range(*index.indices(len(self)))]
        at = index + len(self) if index < 0 else index
        if not 0 <= at < len(self):
            raise IndexError(f"equilibrium {index} of {len(self)}")
        return solution_of(self._inner.solution(at), Origin("equilibrium", (self._origin, at)))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Equilibria):
            return NotImplemented
        states = (_saved.equilibria_state(one._inner, one._origin) for one in (self, other))
        return _saved.same(*states)

    def __hash__(self) -> int:
        return hash((len(self), self.complete))

    def __reduce__(self) -> tuple[Any, ...]:
        return _equilibria, (_saved.FORMAT, _native.__version__, _saved.equilibria_state(self._inner, self._origin))

    def __repr__(self) -> str:
        stable = sum(state == "stable" for state in self.stability)
        return f"<Equilibria: {len(self)}, {stable} of them stable, {'complete' if self.complete else 'not complete'}>"

    def to_json(self) -> str:
        """The document of ``hydrostat equilibria --format json``."""
        return self._inner.to_json()

    def to_csv(self) -> str:
        """One row each, as ``hydrostat equilibria --format csv`` prints them."""
        return self._inner.to_csv()

    def figure(self, title: str = "all equilibria") -> Figure:
        """All shapes to scale; see `equilibria_figure`."""
        return equilibria_figure(self, title)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw all shapes on one axis, unstable ones pale. Needs matplotlib."""
        from hydrostat.plotting import plot_equilibria

        return plot_equilibria(self, ax)


def _path(version: int, writer: str, state: dict[str, Any]) -> EquilibriumPath:
    _saved.check("Path", version, writer)
    origin = Origin(*state["origin"])
    return EquilibriumPath(cast("_native.Path", _saved.SavedPath(state, origin)), origin)


def _equilibria(version: int, writer: str, state: dict[str, Any]) -> Equilibria:
    _saved.check("Equilibria", version, writer)
    origin = Origin(*state["origin"])
    return Equilibria(cast("_native.Equilibria", _saved.SavedEquilibria(state, origin)), origin)


# The name of version 0.1, kept for a version.
Path = EquilibriumPath
