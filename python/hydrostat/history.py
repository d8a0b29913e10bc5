"""Equilibria along loads that rise and fall."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING, overload

import numpy as np

from hydrostat import _inputs, _native
from hydrostat._errors import MotionError
from hydrostat.arm import Arm, arm_of
from hydrostat.figures import Figure
from hydrostat.solution import Solution, Tip, solution_of
from hydrostat.spatial import tip_of

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True, slots=True)
class HistorySnap:
    """A snap on the way to a row of a history.

    Attributes
    ----------
    row : int
        The row, from 0, on the way to which the arm snaps.
    loads : dict of str to float
        The loads at which it snaps.
    fraction : float
        The fraction of the way from the row before, 0 to 1.
    before, after : Tip
        The tip, m and rad, before the snap and where the arm rests; of an arm in space a `SpatialTip`.
    distance, angle : float
        How far the tip jumps, m, and turns, rad.
    duration : float
        How long it takes until the arm stays within 0.002 L of where it rests, s.
    lands_elsewhere : bool or None
        Whether it ends in another shape than the curve of equilibria; None if the curve does not continue.
    """

    row: int
    loads: dict[str, float]
    fraction: float
    before: Tip
    after: Tip
    distance: float
    angle: float
    duration: float
    lands_elsewhere: bool | None


class History(Sequence[Solution]):
    """Equilibria along a sequence of loads, each reached from the one before; see `history`.

    Attributes
    ----------
    keys : tuple of str
        The loads.
    snaps : tuple of HistorySnap
        In their order.
    """

    def __init__(self, native: _native.History) -> None:
        self._inner = native
        self.keys = tuple(native.keys)
        self.snaps = tuple(
            HistorySnap(
                row, dict(zip(self.keys, loads, strict=True)), fraction, tip_of(*before), tip_of(*after), distance, angle, duration, elsewhere
            )
            for row, loads, fraction, before, after, distance, angle, duration, elsewhere in native.snaps
        )

    def __len__(self) -> int:
        return len(self._inner)

    @overload
    def __getitem__(self, row: int) -> Solution: ...
    @overload
    def __getitem__(self, row: slice) -> Sequence[Solution]: ...
    def __getitem__(self, row: int | slice) -> Solution | Sequence[Solution]:
        if isinstance(row, slice):
            return [self[k] for k in range(*row.indices(len(self)))]
        at = row + len(self) if row < 0 else row
        if not 0 <= at < len(self):
            raise IndexError(f"row {row} of a history of {len(self)}")
        return solution_of(self._inner.solution(at))

    def __repr__(self) -> str:
        return f"<History over {', '.join(self.keys)}: {len(self)} rows, {len(self.snaps)} snap(s)>"

    def loads(self, key: str) -> NDArray[np.float64]:
        """A load at all rows."""
        return self._inner.loads(self._column(key))

    def to_pandas(self) -> pd.DataFrame:
        """All rows: loads, and what ``hydrostat history --format csv`` has of each. Needs pandas."""
        import io

        import pandas as pd

        return pd.read_csv(io.StringIO(self.to_csv()))

    def to_json(self) -> str:
        """The document of ``hydrostat history --format json``."""
        return self._inner.to_json()

    def to_csv(self) -> str:
        """The rows as ``hydrostat history --format csv`` prints them."""
        return self._inner.to_csv()

    def figure(self, quantity: str = "tip.y", over: str | None = None, title: str | None = None) -> Figure:
        """The loading diagram: a line where the load rises, a broken one where it falls, and an arrow for each snap."""
        column = 0 if over is None else self._column(over)
        name = f"{self.keys[column]} up and down" if title is None else title
        return Figure(self._inner.figure(column, _inputs.text("quantity", quantity, "tip.y"), name))

    def _column(self, key: str) -> int:
        try:
            return self.keys.index(key)
        except ValueError:
            raise ValueError(f"key: expected one of {', '.join(self.keys)}, found {key!r}") from None


def history(arm: Arm | str | PathLike[str], table: Mapping[str, ArrayLike] | pd.DataFrame, *, tol: float = 1e-8) -> History:
    """Follow an arm quasi-statically along loads that rise and fall: each row is the equilibrium reached from the row before.

    Between rows the loads change along a straight line. Where the equilibrium ends in a limit point the arm snaps: its motion, with its
    ``[dynamics]``, is followed until it rests, and the way goes on from there. So the answer depends on the way (hysteresis). The first
    row is reached from the unloaded arm as by `Arm.solve` with ``after_snap=True``.

    Parameters
    ----------
    arm : Arm, str or path
        The arm, or the name or file of one, in the plane.
    table : mapping or DataFrame
        Keys of loads with their values, one a row, SI units, angles in degrees; a column ``t_s`` is ignored.
    tol : float
        Tolerance on the tip position, relative to the arm's length, in [1e-12, 1e-2].

    Raises
    ------
    MotionError
        The way to a row ends at a limit of the arm, or the arm does not come to rest after a snap; ``data`` has the rows before.
    NoEquilibriumError
        There is no equilibrium at the first row.

    Examples
    --------
    >>> import hydrostat as hs
    >>> arm = hs.Arm.load("silicone").replace({"dynamics.relaxation_time": "2.7 ms"}, flow_speed=0.2, flow_direction=180)
    >>> both_ways = hs.history(arm, {"arm.base.angle": [40, -40, 40]})
    >>> [(snap.row, round(snap.loads["arm.base.angle"])) for snap in both_ways.snaps]
    [(1, -30), (2, 30)]
    """
    own = arm_of(arm)
    columns = {str(key): table[key] for key in (table.columns if hasattr(table, "columns") else _inputs.mapping("table", table, "{}"))}
    columns.pop("t_s", None)
    values = {key: _inputs.numbers(key, column, 1) for key, column in columns.items()}
    lengths = {len(column) for column in values.values()}
    if len(lengths) != 1 or 0 in lengths:
        raise ValueError("table: expected one or more keys, each with the same number of values, at least one")
    rows = np.stack(list(values.values()), axis=1).tolist()
    native, error = _native.history(own._inner, list(values), rows, _inputs.number("tol", tol))
    found = History(native)
    if error is not None:
        if isinstance(error, MotionError):
            error.data = found
        raise error
    return found
