"""Arguments as the extension module takes them; what is wrong is a `ValueError` that names the argument."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar, Union

import numpy as np

from hydrostat import _native, _units

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from hydrostat.arm import Arm

T = TypeVar("T")
K = TypeVar("K")
V = TypeVar("V")

#: An array of numbers, or lists in which some have units.
Numbers = Union["ArrayLike", Sequence[object]]

#: How far the tip may jump, over the length, and turn, rad, at a snap unless something else is asked for.
SNAPS = (0.01, _native.angle("2 deg"))

_ESCAPES = {ord('"'): '\\"', ord("\\"): "\\\\", **{code: f"\\u{code:04x}" for code in [*range(32), 127]}}


def numbers(
    name: str,
    value: Numbers,
    dimensions: int | None = None,
    *,
    missing: bool = False,
    key: str | None = None,
    arm: _native.Arm | None = None,
) -> NDArray[np.float64]:
    """Real numbers, contiguous, with so many dimensions. What is masked, or NA in pandas, is NaN where `missing` allows it.

    Of what carries a unit, the numbers in the unit of a bare number at `key` of the arm file (of `arm`, if it is its own)."""
    if key is not None:
        value = _units.plain(name, value, key, arm)
    if _is_nullable(value):
        value = value.to_numpy(dtype=np.float64, na_value=np.nan)  # type: ignore[union-attr]
    elif isinstance(value, np.ma.MaskedArray) and value.dtype.kind in "iuf":
        if value.mask.any() and not missing:
            index = tuple(int(i) for i in np.argwhere(np.ma.getmaskarray(value))[0])
            raise ValueError(f"{name}: expected numbers, found a masked one at index {index}")
        value = np.ma.filled(value.astype(np.float64), np.nan)
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise ValueError(f"{name}: expected an array of numbers, found one that is not regular") from error
    if array.dtype.kind not in "iuf":
        if array.size == 0 and array.dtype.kind == "O":
            return np.empty(array.shape)
        raise ValueError(f"{name}: expected real numbers, found an array of dtype {array.dtype}")
    if dimensions is not None and array.ndim != dimensions:
        raise ValueError(f"{name}: expected an array of {dimensions} dimension(s), found shape {array.shape}")
    if array.dtype == np.float64 and array.flags.c_contiguous:
        return array
    # What is made contiguous gets a dimension if it had none.
    return np.ascontiguousarray(array, dtype=np.float64).reshape(array.shape)


def _is_nullable(value: object) -> bool:
    """Whether these are numbers of pandas, some of which may be NA."""
    if isinstance(value, np.ndarray) or not hasattr(value, "to_numpy"):
        return False
    kinds = list(getattr(value, "dtypes", ())) if getattr(value, "ndim", 1) == 2 else [getattr(value, "dtype", None)]
    known = all(getattr(kind, "kind", "O") in "iuf" for kind in kinds)
    return known and any(not isinstance(kind, np.dtype) for kind in kinds)


def finite(
    name: str,
    value: Numbers,
    *,
    negative: bool = True,
    missing: bool = False,
    key: str | None = None,
    arm: _native.Arm | None = None,
) -> NDArray[np.float64]:
    """Finite real numbers of any shape, none below zero unless `negative`; NaN among them where `missing` allows it."""
    array = numbers(name, value, missing=missing, key=key, arm=arm)
    wrong = ~np.isfinite(array) if negative else ~(np.isfinite(array) & (array >= 0.0))
    if missing:
        wrong &= ~np.isnan(array)
    if wrong.any():
        index = tuple(int(i) for i in np.argwhere(wrong)[0])
        expected = "finite numbers" if negative else "finite numbers that are not negative"
        raise ValueError(f"{name}: expected {expected}, found {array[index]} at index {index}")
    return array


def number(name: str, value: float | str, *, negative: bool = True, key: str | None = None) -> float:
    """One finite number, not below zero unless `negative`; with `key` also what carries a unit, see `numbers`."""
    if key is not None:
        value = _units.plain(name, value, key)
    try:
        out = float(value)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name}: expected a number, found {value!r}") from error
    if not math.isfinite(out):
        raise ValueError(f"{name}: expected a finite number, found {out}")
    if out < 0.0 and not negative:
        raise ValueError(f"{name}: expected a number that is not negative, found {out}")
    return out


def snaps(distance: float, angle: float | str, follow: bool) -> tuple[float, float]:
    """How far the tip may jump, over the length, and turn, rad, at a snap: no end where every snap is followed."""
    if distance == 0.01 and angle == 2.0:
        return (math.inf, math.inf) if follow else SNAPS
    if follow:
        raise ValueError("follow_snaps: expected it without snap_distance and snap_angle, which bound the snaps that are followed")
    if isinstance(angle, str):
        try:
            turn = _native.angle(angle)
        except ValueError as error:
            raise ValueError(f"snap_angle: {error}") from error
        number("snap_angle", turn, negative=False)
    else:
        own = number("snap_angle", angle, negative=False)
        turn = SNAPS[1] if own == 2.0 else _native.angle(repr(own))
    return number("snap_distance", distance, negative=False), turn


def after_snap(after: bool, distance: float, angle: float | str, follow: bool) -> None:
    """Refuse what bounds or follows snaps along the curve where their motions are asked for."""
    if after and (follow or distance != 0.01 or angle != 2.0):
        raise ValueError("after_snap: expected it without follow_snaps, snap_distance and snap_angle, which are for snaps along the curve")


def count(name: str, value: int) -> int:
    """A whole number that is not negative."""
    try:
        out = operator.index(value)
    except TypeError as error:
        raise ValueError(f"{name}: expected a whole number, found {value!r}") from error
    if not 0 <= out < 1 << 63:
        raise ValueError(f"{name}: expected a whole number that is not negative, found {out}")
    return out


def items(name: str, value: Iterable[T], what: str) -> list[T]:
    """The items of a list or array; `what` they are, for the message."""
    if isinstance(value, (str, bytes, Mapping)) or not isinstance(value, Iterable) or getattr(value, "ndim", 1) == 0:
        raise TypeError(f"{name}: expected a list of {what}, found {value!r}")
    return list(value)


def text(name: str, value: str, such_as: str) -> str:
    """Text."""
    if not isinstance(value, str):
        raise TypeError(f"{name}: expected text such as {such_as!r}, found {value!r}")
    return value


def mapping(name: str, value: Mapping[K, V], such_as: str) -> dict[K, V]:
    """A mapping."""
    if not isinstance(value, Mapping):
        raise TypeError(f"{name}: expected a mapping such as {such_as}, found {value!r}")
    return dict(value)


def texts(name: str | Sequence[str], key: str, values: Sequence[float | str]) -> list[str]:
    """Numbers of a key that stand together, as the command line takes them; `name` is that of all, or one for each.

    There a unit behind the last number holds for all; here a number that is no string keeps its own, of SI or degrees.
    """
    strings = any(isinstance(value, str) for value in values)
    unit = (_native.bare_unit(key) or "") if strings else ""
    names = [name] * len(values) if isinstance(name, str) else name
    return [
        value if isinstance(value, str) else f"{number(own, value)!r} {unit}".strip()
        for own, value in zip(names, values, strict=True)
    ]


def toml(name: str, value: object) -> str:
    """A value as it stands in an arm file."""
    if isinstance(value, str):
        return f'"{value.translate(_ESCAPES)}"'
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, float, np.integer, np.floating)):
        return repr(float(value))
    if isinstance(value, Mapping):
        fields = (f"{toml(name, str(key))} = {toml(f'{name}.{key}', item)}" for key, item in value.items())
        return "{ " + ", ".join(fields) + " }"
    if isinstance(value, np.ndarray):
        return toml(name, value.tolist())
    if isinstance(value, Sequence):
        return "[" + ", ".join(toml(f"{name}[{index}]", item) for index, item in enumerate(value)) + "]"
    raise ValueError(f"{name}: expected a number, a string, a list or a mapping, found {type(value).__name__}")


def of_cables(value: Any, arm: Arm) -> Any:
    """A table or row of pandas whose labels are the cables' names, in the order of the cables; anything else as it is."""
    if isinstance(value, (np.ndarray, list, tuple)) or not hasattr(value, "to_numpy") or not hasattr(value, "loc"):
        return value
    cables = arm.cables
    labels = getattr(value, "columns", None) if getattr(value, "ndim", 0) == 2 else getattr(value, "index", None)
    if labels is None or list(labels) == list(cables) or sorted(map(str, labels)) != sorted(cables):
        return value
    return value[list(cables)]
