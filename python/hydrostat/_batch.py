"""Solves as functions of arrays with their derivatives, for libraries that differentiate."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike

import numpy as np
from numpy.typing import NDArray

from hydrostat import _inputs
from hydrostat.arm import Arm, arm_of
from hydrostat.many import Many, solve_many

#: Of the tip, in the order of the answers.
TIP = ("tip_x", "tip_y", "tip_theta", "tip_alpha")
#: Keys whose bare numbers are degrees; derivatives are by radians.
_DEGREES = ("flow.direction", "gravity.direction", "arm.base.angle")


class Batch:
    """Tip and strokes of an arm by some of its numbers, rows at a time."""

    def __init__(self, arm: Arm | str | PathLike[str], keys: Sequence[str], tol: float) -> None:
        self.arm = arm_of(arm)
        given = _inputs.items("keys", keys, "keys, such as ['cable[0].tension']")
        self.keys = tuple(_inputs.text("keys", key, "cable[0].tension") for key in given)
        if not self.keys or len(set(self.keys)) < len(self.keys):
            raise ValueError(f"keys: expected different keys, found {list(self.keys)}")
        self.tol = _inputs.number("tol", tol)
        #: How many numbers a row is answered with.
        self.size = len(TIP) + len(self.arm.cables)
        self._per_unit = np.array([np.pi / 180.0 if key in _DEGREES else 1.0 for key in self.keys])
        # What is wrong with the keys is said here.
        self._solved(np.empty((0, len(self.keys))), gradients=True)

    def values(self, x: NDArray[np.floating]) -> NDArray[np.float64]:
        """Of rows of shape (..., p): (..., 4 + cables)."""
        return _stacked(self._solved(x, gradients=False))

    def differentiated(self, x: NDArray[np.floating]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The same with derivatives, (..., 4 + cables, p)."""
        found = self._solved(x, gradients=True)
        tip = np.stack([found[f"d_{name}"] for name in TIP], axis=-2)
        jacobian: NDArray[np.float64] = np.concatenate([tip, found["d_stroke"]], axis=-2, dtype=np.float64)
        return _stacked(found), jacobian * self._per_unit

    def _solved(self, x: NDArray[np.floating], *, gradients: bool) -> Many:
        rows = np.asarray(x, dtype=np.float64)
        # What no arm has is a row without an answer, as a search may ask for it.
        rows = np.where(np.isfinite(rows), rows, np.nan)
        vary = {key: rows[..., k] for k, key in enumerate(self.keys)}
        for key in self.keys:
            if key.endswith(("tension", ".speed", ".density")):
                vary[key] = np.where(vary[key] >= 0.0, vary[key], np.nan)
        by = self.keys if gradients else False
        return solve_many(self.arm, vary=vary, tol=self.tol, gradients=by, warnings=False)


def _stacked(found: Many) -> NDArray[np.float64]:
    tip = np.stack([found[name] for name in TIP], axis=-1)
    return np.concatenate([tip, found.stroke], axis=-1, dtype=np.float64)
