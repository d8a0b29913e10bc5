"""Arguments as the extension module takes them; what is wrong is a `ValueError` that names the argument."""

from __future__ import annotations

import math
import operator
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

_ESCAPES = {ord('"'): '\\"', ord("\\"): "\\\\", **{code: f"\\u{code:04x}" for code in [*range(32), 127]}}


def numbers(name: str, value: ArrayLike, dimensions: int | None = None) -> NDArray[np.float64]:
    """Real numbers, contiguous, with so many dimensions."""
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise ValueError(f"{name}: expected an array of numbers, found one that is not regular") from error
    if array.dtype.kind not in "iuf":
        raise ValueError(f"{name}: expected real numbers, found an array of dtype {array.dtype}")
    if dimensions is not None and array.ndim != dimensions:
        raise ValueError(f"{name}: expected an array of {dimensions} dimension(s), found shape {array.shape}")
    if array.dtype == np.float64 and array.flags.c_contiguous:
        return array
    # What is made contiguous gets a dimension if it had none.
    return np.ascontiguousarray(array, dtype=np.float64).reshape(array.shape)


def finite(name: str, value: ArrayLike, *, negative: bool = True) -> NDArray[np.float64]:
    """Finite real numbers of any shape, none below zero unless `negative`."""
    array = numbers(name, value)
    wrong = ~np.isfinite(array) if negative else ~(np.isfinite(array) & (array >= 0.0))
    if wrong.any():
        index = tuple(int(i) for i in np.argwhere(wrong)[0])
        expected = "finite numbers" if negative else "finite numbers that are not negative"
        raise ValueError(f"{name}: expected {expected}, found {array[index]} at index {index}")
    return array


def number(name: str, value: float, *, negative: bool = True) -> float:
    """One finite number, not below zero unless `negative`."""
    try:
        out = float(value)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name}: expected a number, found {value!r}") from error
    if not math.isfinite(out):
        raise ValueError(f"{name}: expected a finite number, found {out}")
    if out < 0.0 and not negative:
        raise ValueError(f"{name}: expected a number that is not negative, found {out}")
    return out


def count(name: str, value: int) -> int:
    """A whole number that is not negative."""
    try:
        out = operator.index(value)
    except TypeError as error:
        raise ValueError(f"{name}: expected a whole number, found {value!r}") from error
    if not 0 <= out < 1 << 63:
        raise ValueError(f"{name}: expected a whole number that is not negative, found {out}")
    return out


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
