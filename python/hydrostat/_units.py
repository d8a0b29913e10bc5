"""Numbers that carry a unit: strings, xarray's DataArrays with the attribute ``units``, and Quantities of pint.

All become numbers in the unit that a bare number has: SI, angles in degrees. Units are read by what reads arm files.
"""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from hydrostat import _native

#: A key of the arm file for each unit that arguments have.
TENSION, STROKE, SPEED, TIME, ANGLE = "cable[0].tension", "cable[0].stroke", "flow.speed", "dynamics.relaxation_time", "flow.direction"

#: Types that carry no unit: lists of them are the rule, and are seen at once.
_BARE = {int, float}
_NUMBER = re.compile(r"\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
#: Spellings of pint and of the CF conventions, word by word.
_WORDS = {
    "newton": "N",
    "millinewton": "mN",
    "meter": "m",
    "metre": "m",
    "centimeter": "cm",
    "millimeter": "mm",
    "second": "s",
    "degree": "deg",
    "radian": "rad",
    "pascal": "Pa",
    "kilopascal": "kPa",
    "megapascal": "MPa",
    "kilogram": "kg",
    "dimensionless": "",
}


def plain(name: str, value: Any, key: str, arm: _native.Arm | None = None) -> Any:
    """`value` without units, in the unit of a bare number at `key`; what has none is returned as it is.

    `arm` has that key; without it the key is one of those above.
    """
    if value is None or isinstance(value, (int, float)) or type(value) is np.ndarray and value.dtype.kind in "iufbc":
        return value
    if type(value) in (list, tuple) and _BARE.issuperset(map(type, value)):
        return value
    if isinstance(value, (str, np.str_)):
        return number(name, str(value), key, arm)
    if _is_quantity(value):
        return _of_pint(name, value, key)
    xarray = sys.modules.get("xarray")
    if xarray is not None and isinstance(value, xarray.DataArray):
        return _of_xarray(name, value, key, arm)
    if isinstance(value, np.ma.MaskedArray):
        return value
    if isinstance(value, np.ndarray):
        return plain(name, value.tolist(), key, arm) if value.dtype.kind in "USO" and value.size else value
    if isinstance(value, (list, tuple)) and _some_carry(value):
        return [plain(f"{name}[{index}]", one, key, arm) for index, one in enumerate(value)]
    if hasattr(value, "to_numpy"):
        return _of_pandas(name, value, key, arm)
    return value


def number(name: str, text: str, key: str, arm: _native.Arm | None = None) -> float:
    """The number that a string such as ``"10 cm/s"`` means at `key`, in the unit of a bare number there."""
    found = _NUMBER.match(text)
    if found is not None and found.end() == len(text.rstrip()):
        if not _native.bare_unit(key):
            return float(text)
        raise ValueError(f"{name}: expected a number, or a string with a unit, found {text!r}: it has no unit")
    if found is not None and text[found.end() :].strip() in ("deg", "°") and _is_angle(key):
        # Degrees stay what they are, to the last bit.
        return float(found[0])
    if ":" in text or "," in text:
        raise ValueError(f"{name}: expected one number with its unit, found {text!r}")
    values, _ = _axis(name, text, key, arm)
    return float(values[0])


def grid(name: str, text: str, key: str, arm: _native.Arm) -> Any:
    """The numbers of a text as a sweep takes them, ``"0:20 cm/s:3"`` or ``"5,20 cm/s"``, in the unit of a bare number."""
    return _axis(name, text, key, arm)[0]


def _is_angle(key: str) -> bool:
    return _native.bare_unit(key) in ("deg", "degrees")


def _axis(name: str, text: str, key: str, arm: _native.Arm | None) -> tuple[Any, float]:
    """The values of a text, and how many of its unit are one of SI."""
    try:
        sweep = _native.Sweep(arm or _any_arm(), (f"{key}={text}",), None, 0, 1e-6, (math.inf, math.inf), None, 0, False)
        values, (_, _, unit, per_si) = sweep.values(0), sweep.axes[0]
    except ValueError as error:
        words = str(error)
        raise ValueError(f"{name}: {words.removeprefix(f'{key}: ')}") from None
    if values is None or isinstance(values, list):
        raise ValueError(f"{name}: expected numbers, found {text!r}")
    if _is_angle(key):
        values = values * per_si if unit == "deg" else np.degrees(values)
    return values, per_si


@lru_cache(maxsize=1)
def _any_arm() -> _native.Arm:
    return _native.Arm(_native.shipped("silicone") or "", "silicone")


def _carries(value: object) -> bool:
    return isinstance(value, str) or _is_quantity(value)


def _some_carry(values: Sequence[object]) -> bool:
    """Whether a string or a Quantity is among nested lists."""
    return any(_carries(one) or (isinstance(one, (list, tuple)) and _some_carry(one)) for one in values)


def pint_is_known() -> bool:
    """Whether anything can be a Quantity: none is whose module was never imported."""
    return "pint" in sys.modules


def _is_quantity(value: object) -> bool:
    return pint_is_known() and hasattr(value, "magnitude") and hasattr(value, "units")


def _of_pint(name: str, value: Any, key: str) -> Any:
    bare = _native.bare_unit(key) or ""
    # As pint writes products and powers.
    unit = re.sub(r"([a-z])\^?(\d)", r"\1**\2", bare.replace("degrees", "deg")).replace(" ", "*") or "dimensionless"
    try:
        return value.to(unit).magnitude
    except Exception as error:
        raise ValueError(f"{name}: expected {f'numbers in {bare}' if bare else 'plain numbers'}, found a Quantity in {value.units}") from error


def _of_xarray(name: str, value: Any, key: str, arm: _native.Arm | None) -> Any:
    data = value.variable._data
    if _is_quantity(data):
        return value.copy(data=_of_pint(name, data, key)).drop_attrs(deep=False)
    given = value.attrs.get("units")
    if given is None or value.dtype.kind not in "iuf":
        return value
    unit = _spelled(str(given))
    bare = (_native.bare_unit(key) or "").replace("degrees", "deg")
    if unit == bare:
        return value
    if not unit:
        raise ValueError(f"{name}: expected numbers in {bare}, found the units {given!r}")
    try:
        _, per_si = _axis(name, f"0 {unit}", key, arm)
    except ValueError as error:
        raise ValueError(f"{name}: units: {str(error).removeprefix(f'{name}: ')}") from None
    data = np.asarray(value.values) / per_si
    return value.copy(data=np.degrees(data) if _is_angle(key) else data)


def _spelled(unit: str) -> str:
    """A unit as arm files spell it."""
    words = re.sub(r"[a-zA-Z]+", lambda word: _WORDS.get(word[0].lower().removesuffix("s"), word[0]), unit.strip())
    words = re.sub(r"\s*/\s*", "/", words).replace(" ** ", "").replace("**", "").replace(" * ", " ")
    # m s-1 of the CF conventions.
    words = re.sub(r"[ .](\w+)\^?-1\b", r"/\1", words)
    words = re.sub(r"[ .]([a-z]+)\^?-(\d)\b", r"/\1\2", words)
    return "" if words in ("1", "") else words


def _of_pandas(name: str, value: Any, key: str, arm: _native.Arm | None) -> Any:
    kinds = list(value.dtypes) if getattr(value, "ndim", 1) == 2 else [getattr(value, "dtype", None)]
    if any(str(kind).startswith("pint[") for kind in kinds):
        raise ValueError(f"{name}: expected numbers, found a column of pandas with units; give its magnitudes")
    if any(getattr(kind, "kind", "O") not in "iufb" for kind in kinds):
        return plain(name, np.asarray(value, dtype=object).tolist(), key, arm)
    return value
