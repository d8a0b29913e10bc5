"""Sweeps over keys of the arm file, here or on a cluster."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from os import PathLike
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, NamedTuple, Union, overload

import numpy as np

from hydrostat import _inputs, _memory, _native, _units
from hydrostat._progress import Progress
from hydrostat.arm import Arm, arm_of
from hydrostat.many import FIELDS
from hydrostat.solution import CONVENTIONS

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from distributed import Client
    from numpy.typing import NDArray

#: Values of a key: a grid ``"0:1:26"``, a range to draw from ``"0:1"``, a list with commas, an array, or one value.
Values = Union[str, float, Sequence[Union[float, str]], "NDArray[np.generic]", "pd.Series[Any]", "xr.DataArray"]

_COLUMN = re.compile(r"(?P<name>.+?)(_(?P<index>\d+))?(_(?P<unit>m|rad|N|Nm|s))?$")
_UNITS = {"Nm": "N m"}
#: Numbers of a row that are not of cables or stations, all columns together.
_NUMBERS = {"plane": 23, "space": 35}
#: What is held of a station, as columns and put together of them.
_OF_STATIONS = {"plane": 6, "space": 18}
#: Meaning of variables that `solve_many` does not have, too.
_MEANINGS = {
    "fold_s": "where the margin against folding is least, along the undeformed arm",
    "phase": "loads that were being raised where there is no equilibrium",
    "verdict_s": "where the limit is met, along the undeformed arm",
    "snaps": "snaps on the way to the loads",
}
_ENDINGS = (".parquet", ".csv")


class Plan(NamedTuple):
    """All that the rows of a sweep follow from, small enough to send anywhere."""

    arm: Arm
    vary: tuple[str, ...]
    sample: str | None
    seed: int
    tol: float
    snaps: tuple[float, float]
    columns: tuple[str, ...] | None
    shapes: int
    after_snap: bool = False

    def native(self) -> _native.Sweep:
        """The sweep, made once a process."""
        text, path, settings = self.arm._inner.parts()
        # Arms that are the same can differ in their texts, and so in what becomes of a key.
        return _made(text, path, tuple(settings), self[1:])


@lru_cache(maxsize=8)
def _made(text: str, path: str, settings: tuple[tuple[str, str, str], ...], asked: tuple[Any, ...]) -> _native.Sweep:
    return _native.Sweep(_native.Arm(text, path, settings), *asked)


class Variable(NamedTuple):
    """A variable of the dataset, made of one column or of several, a cable or a station each."""

    name: str
    columns: tuple[str, ...]
    unit: str
    dimension: str | None
    words: bool


@overload
def sweep(
    arm: Arm | str | PathLike[str],
    vary: Mapping[str, Values],
    *,
    sample: str | None = ...,
    seed: int = ...,
    tol: float = ...,
    snap_distance: float = ...,
    snap_angle: float | str = ...,
    follow_snaps: bool = ...,
    after_snap: bool = ...,
    columns: Sequence[str] | None = ...,
    shapes: int = ...,
    output: None = ...,
    resume: bool = ...,
    threads: int = ...,
    client: Client | None = ...,
    chunk_seconds: float = ...,
    retries: int = ...,
    progress: bool | None = ...,
) -> xr.Dataset: ...
@overload
def sweep(
    arm: Arm | str | PathLike[str],
    vary: Mapping[str, Values],
    *,
    sample: str | None = ...,
    seed: int = ...,
    tol: float = ...,
    snap_distance: float = ...,
    snap_angle: float | str = ...,
    follow_snaps: bool = ...,
    after_snap: bool = ...,
    columns: Sequence[str] | None = ...,
    shapes: int = ...,
    output: str | PathLike[str],
    resume: bool = ...,
    threads: int = ...,
    client: Client | None = ...,
    chunk_seconds: float = ...,
    retries: int = ...,
    progress: bool | None = ...,
) -> FilePath: ...
def sweep(
    arm: Arm | str | PathLike[str],
    vary: Mapping[str, Values],
    *,
    sample: str | None = None,
    seed: int = 0,
    tol: float = 1e-6,
    snap_distance: float = 0.01,
    snap_angle: float | str = 2.0,
    follow_snaps: bool = False,
    after_snap: bool = False,
    columns: Sequence[str] | None = None,
    shapes: int = 0,
    output: str | PathLike[str] | None = None,
    resume: bool = False,
    threads: int = 0,
    client: Client | None = None,
    chunk_seconds: float = 5.0,
    retries: int = 3,
    progress: bool | None = None,
) -> xr.Dataset | FilePath:
    """Solve an arm over all combinations of values of some keys, or over a sample.

    The rows are those of ``hydrostat sweep``, to the last bit, wherever they are solved. Rows without an equilibrium have NaN
    and a verdict. Ctrl-C interrupts it.

    Parameters
    ----------
    arm : Arm, str or path
        The arm, or the name or file of one.
    vary : mapping
        Keys of the arm file with their values: an array or list of numbers (SI units, degrees) or of strings,
        ``"from:to:count"`` for a grid with both ends, ``"from:to"`` with `sample`. A unit behind the last number of a string
        or of a list of strings holds for all without one: ``"5:20 cm/s:4"``.
    sample : str, optional
        ``"lhs:N"`` or ``"sobol:N"``: N rows in place of all combinations.
    seed : int
        Seed of the sample.
    tol : float
        Tolerance on the tip position, relative to the arm's length, in [1e-12, 1e-2].
    snap_distance, snap_angle, follow_snaps, after_snap
        Which snaps are followed, and how; see `Arm.solve`. The column ``snaps`` says what became of them.
    columns : sequence of str, optional
        The outputs: some of ``tip``, ``alpha``, ``strokes``, ``tensions``, ``base``, ``fold``, ``stability``, ``error``,
        ``warnings``, ``verdict``.
    shapes : int
        Number of equally spaced stations of every row; none below 2.
    output : path, optional
        Without a client, a file ``.parquet`` or ``.csv``, written in parts, so that `resume` can continue it; a damaged part
        is solved again, with a warning. With a client, a new directory that all workers see, which becomes a Parquet dataset.
    resume : bool
        Whether to resume an interrupted sweep; not with a client.
    threads : int
        0 for all processors; not with a client, whose workers solve one chunk per thread.
    client : distributed.Client, optional
        Solve on this cluster. Rows of lost workers are solved again.
    chunk_seconds : float
        Approximate time of one task on the cluster; the number of rows per task follows from measured costs.
    retries : int
        How often a chunk is tried again if its workers died.
    progress : bool, optional
        Whether to show a bar on standard error; by default on a terminal.

    Returns
    -------
    xarray.Dataset
        One dimension per key (``row`` with a sample), named after it (``flow_speed``, ``cable_0_tension``), with the values as coordinates in
        their given units; ``reason`` says why the values of a row make no arm (the verdict ``no_arm``). Stations have their place ``s``, m. With a
        client its variables are Dask arrays, whose chunks are in the workers' memory. Needs xarray.
    pathlib.Path
        `output`, if given.

    Raises
    ------
    MemoryError
        Without `output` and client: the rows do not fit in memory; nothing was solved.
    ValueError, TypeError
        An argument is invalid; the message names it.

    Examples
    --------
    >>> import hydrostat as hs
    >>> ds = hs.sweep(hs.Arm.load("silicone"), {"flow.speed": [0.0, 0.1], "cable[0].tension": "0:1.5:4"})
    >>> dict(ds.sizes)
    {'flow_speed': 2, 'cable_0_tension': 4, 'cable': 2}
    >>> ds.verdict.values[0].tolist()
    ['', '', 'cable_fold', 'cable_fold']
    """
    given = _inputs.mapping("vary", vary, '{"flow.speed": "0:1:26"}')
    arm = arm_of(arm)
    given = {key: _without_units(arm, key, values) for key, values in given.items()}
    texts = tuple(f"{key}={_values(key, values)}" for key, values in given.items())
    asked = None if columns is None else _inputs.items("columns", columns, "names, such as ['tip', 'strokes']")
    names = None if asked is None else tuple(_inputs.text("columns", name, "tip") for name in asked)
    _inputs.after_snap(after_snap, snap_distance, snap_angle, follow_snaps)
    plan = Plan(
        arm,
        texts,
        None if sample is None else _inputs.text("sample", sample, "lhs:50"),
        _inputs.count("seed", seed),
        _inputs.number("tol", tol),
        _inputs.snaps(snap_distance, snap_angle, follow_snaps),
        names,
        _memory.stations("shapes", _inputs.count("shapes", shapes)),
        bool(after_snap),
    )
    native = plan.native()
    if output is not None and client is None and FilePath(output).suffix.lower() not in _ENDINGS:
        remedy = "; `sweep(...).to_netcdf(...)` writes netCDF" if FilePath(output).suffix == ".nc" else ""
        raise ValueError(f"output: expected a name that ends in {' or '.join(_ENDINGS)}, found {str(output)!r}{remedy}")
    if output is None and client is None:
        # Row, keys, what is answered, and what is put together of several columns.
        cables, space = len(plan.arm.cables), "space" if plan.arm.is_spatial else "plane"
        numbers = 1 + len(native.axes) + _NUMBERS[space] + 4 * cables + _OF_STATIONS[space] * plan.shapes
        remedy = "write them to a file with output=, or take fewer"
        _memory.require(8 * numbers * native.rows, f"{native.rows} rows", remedy)
    if client is not None:
        from hydrostat import cluster

        if resume or threads:
            raise ValueError(f"{'resume' if resume else 'threads'}: is of sweeps without a client")
        run = cluster.Run(client, plan, chunk_seconds, retries, progress)
        return run.dataset(given) if output is None else run.parquet(FilePath(output))
    threads = _inputs.count("threads", threads)
    with Progress(native.rows, progress) as bar:
        if output is not None:
            *_, damaged = native.run(output, resume, threads, bar)
            if damaged:
                parts = "a part" if damaged == 1 else f"{damaged} parts"
                warnings.warn(f"{output}: {parts} of an earlier run had changed since; solved again", stacklevel=2)
            return FilePath(output)
        found = columns_of(plan, (0, native.tiles), threads, bar)
    values = {variable: assembled(found, variable) for variable in variables(native, found)}
    return dataset(plan, given, values, {axis[1]: assembled(found, _key(axis[1], found)) for axis in native.axes})


def _without_units(arm: Arm, key: str, values: Values) -> Values:
    """Values as numbers in the unit of bare ones; strings stay, because a unit behind the last holds for all."""
    texts = isinstance(values, (list, tuple)) and any(isinstance(value, str) for value in values)
    if isinstance(values, str) or texts:
        return values
    array = np.asarray(values) if isinstance(values, (list, tuple, np.ndarray)) and not _units.pint_is_known() else None
    if array is not None and array.dtype.kind in "US":
        return values
    found: Values = _units.plain(f"vary[{key!r}]", values, key, arm._inner)
    return found


def _values(key: str, values: Values) -> str:
    """The values of a key as the command line takes them."""
    if isinstance(values, str):
        return values
    if isinstance(values, Sequence) and any(isinstance(value, str) for value in values):
        # An array would make texts of the numbers beside texts.
        values = _inputs.texts(f"vary[{key!r}]", key, values)
    # What is masked is no number, and what is missing is refused.
    array: Any = values if isinstance(values, np.ma.MaskedArray) or hasattr(values, "to_numpy") else np.asarray(values)
    if array.dtype.kind in "US" and array.ndim == 1:
        return ",".join(str(word) for word in np.asarray(array))
    flat = np.atleast_1d(_inputs.finite(f"vary[{key!r}]", array))
    if flat.ndim != 1:
        raise ValueError(f"vary[{key!r}]: expected one dimension, found shape {flat.shape}")
    return ",".join(repr(float(number)) for number in flat)


Columns = Mapping[str, Any]


def columns_of(plan: Plan, tiles: tuple[int, int], threads: int, progress: Callable[[int], None] | None) -> Columns:
    """The columns of some tiles."""
    return plan.native().columns(tiles, threads, progress)


def variables(native: _native.Sweep, found: Columns) -> list[Variable]:
    """The variables of some columns of a sweep, without the row and the keys."""
    keys = {column for _, column, *_ in native.axes}
    grouped: dict[str, list[str]] = {}
    parsed: dict[str, re.Match[str]] = {}
    for column in found:
        match = _COLUMN.match(column)
        if column == "row" or column in keys or match is None:
            continue
        grouped.setdefault(match["name"], []).append(column)
        parsed[match["name"]] = match
    out = []
    for name, columns in grouped.items():
        unit = parsed[name]["unit"] or ""
        dimension = None
        if parsed[name]["index"] is not None:
            dimension = "station" if name.startswith("shape_") else "cable"
        words = isinstance(found[columns[0]], tuple)
        out.append(Variable(name, tuple(columns), _UNITS.get(unit, unit), dimension, words))
    return out


def _key(column: str, found: Columns) -> Variable:
    return Variable(column, (column,), "", None, isinstance(found[column], tuple))


def assembled(found: Columns, variable: Variable) -> NDArray[np.generic]:
    """The values of a variable, one row each: numbers, or words with the empty one for none."""
    if variable.words:
        codes, words = found[variable.columns[0]]
        # The code -1 of none is the last place.
        known: NDArray[np.generic] = np.array([*words, ""], dtype=object)
        named: NDArray[np.generic] = known[codes]
        return named
    if variable.dimension is None:
        return np.asarray(found[variable.columns[0]])
    stacked: NDArray[np.generic] = np.stack([found[column] for column in variable.columns], axis=1)
    return stacked


def dataset(
    plan: Plan, vary: Mapping[str, Values], values: Mapping[Variable, Any], keys: Mapping[str, Any]
) -> xr.Dataset:
    """The dataset of variables with a row each, in NumPy's or Dask's arrays; `keys` are the rows' own values."""
    import xarray as xr

    native = plan.native()
    axes = native.axes
    grid = plan.sample is None
    coordinates: dict[str, Any] = {"cable": ("cable", list(plan.arm.cables))}
    shape: tuple[int, ...] = (native.rows,)
    dims: tuple[str, ...] = ("row",)
    if grid:
        dims = tuple(key_name(key) for key, *_ in axes)
        for index, (key, _, unit, per_si) in enumerate(axes):
            own = _shown(vary[key], native.values(index), per_si)
            coordinates[key_name(key)] = (key_name(key), own, _attributes(key, unit))
        shape = tuple(len(coordinates[dim][1]) for dim in dims)
    else:
        for key, column, unit, per_si in axes:
            rows = keys[column]
            shown = rows if rows.dtype.kind == "O" or per_si == 1.0 else rows * per_si
            coordinates[key_name(key)] = ("row", shown, _attributes(key, unit))
    if plan.shapes:
        places = np.linspace(0.0, plan.arm.length, plan.shapes)
        coordinates["s"] = ("station", places, {"units": "m", "long_name": "length along the undeformed arm"})
    out: dict[str, Any] = {}
    for variable, rows in values.items():
        last = () if variable.dimension is None else (variable.dimension,)
        array = rows.reshape(shape + rows.shape[1:])
        attributes = _attributes(meaning(variable.name), "" if variable.words else variable.unit or "1")
        if not variable.words:
            attributes["column"] = variable.columns[0]
        out[variable.name] = ((*dims, *last), array, attributes)
    used = {dim for dims_of, *_ in out.values() for dim in dims_of}
    kept = {name: value for name, value in coordinates.items() if value[0] in used or value[0] not in ("cable", "station")}
    about: dict[str, Any] = {
        "Conventions": CONVENTIONS,
        "arm": plan.arm.to_toml(),
        # One text, because netCDF has no lists of them; no key has a blank.
        "vary": " ".join(key for key, *_ in axes),
        "tol": plan.tol,
        "snap_distance": plan.snaps[0],
        "snap_angle": plan.snaps[1],
        "hydrostat": _native.__version__,
    }
    return xr.Dataset(out, coords=kept, attrs=about)


def key_name(key: str) -> str:
    """The name of a key in a dataset, as its columns in files begin: ``cable_0_tension`` of ``cable[0].tension``."""
    return re.sub(r"\W+", "_", key).strip("_")


def meaning(name: str) -> str:
    """What a variable is, for people."""
    name = name.removeprefix("shape_")
    return FIELDS[name][1] if name in FIELDS else _MEANINGS.get(name, name.replace("_", " "))


def _attributes(words: str, unit: str) -> dict[str, str]:
    return {"long_name": words, **({"units": unit} if unit else {})}


def _shown(given: Values, si: NDArray[np.float64] | list[str] | None, per_si: float) -> Any:
    """Coordinates as they were given where these are numbers, else in the unit that they were given in."""
    if si is None or isinstance(si, list):
        return np.array(si, dtype=object)
    if not isinstance(given, str):
        array = np.atleast_1d(np.asarray(given))
        if array.dtype.kind in "iuf":
            return array
    return si * per_si
