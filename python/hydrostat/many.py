"""Many solves of one arm with different numbers."""

from __future__ import annotations

import math
import sys
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from hydrostat import _inputs, _memory, _native, _saved, _units
from hydrostat._progress import Progress
from hydrostat.arm import Arm, arm_of
from hydrostat.solution import CONVENTIONS

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from numpy.typing import ArrayLike, NDArray

#: Unit and meaning of what has one.
FIELDS = {
    "tip_x": ("m", "tip along e1"),
    "tip_y": ("m", "tip along e2"),
    "tip_theta": ("rad", "rotation of the section at the tip"),
    "tip_alpha": ("rad", "angle from the section's normal to the centreline's tangent at the tip"),
    "tip_z": ("m", "tip along e3"),
    "base_force_x": ("N", "base reaction along e1"),
    "base_force_y": ("N", "base reaction along e2"),
    "base_force_z": ("N", "base reaction along e3"),
    "base_moment": ("N m", "moment of the base reaction"),
    "error_estimate": ("m", "estimated error of the tip"),
    "tension": ("N", "tension at the base"),
    "stroke": ("m", "stroke, positive when reeled in"),
    "fold_margin": ("1", "margin of the surface against folding"),
    "load_fraction": ("1", "fraction of the loads where there is no equilibrium"),
    "x": ("m", "centreline along e1"),
    "y": ("m", "centreline along e2"),
    "z": ("m", "centreline along e3"),
    "theta": ("rad", "rotation of the section"),
    "d_tip_x": ("m", "derivative of the tip along e1"),
    "d_tip_y": ("m", "derivative of the tip along e2"),
    "d_tip_z": ("m", "derivative of the tip along e3"),
    "d_tip_theta": ("rad", "derivative of the rotation of the section at the tip"),
    "d_tip_alpha": ("rad", "derivative of the angle alpha at the tip"),
    "d_stroke": ("m", "derivative of the stroke"),
    "stability": ("", "stable, unstable or marginal"),
    "unstable_directions": ("1", "number of directions in which small motions grow"),
    "warnings": ("", "kinds of the warnings, with blanks between"),
    "verdict": ("", "why there is no equilibrium; empty where there is one"),
    "reason": ("", "why there is no equilibrium, in a sentence"),
}
_IN_SPACE: dict[str, tuple[str, str]] = {}
for _k, _axis in enumerate("xyz", 1):
    _IN_SPACE[f"base_moment_{_axis}"] = ("N m", f"moment of the base reaction about e{_k}")
    _IN_SPACE[f"d_tip_turn_{_axis}"] = ("rad", f"derivative of the turn of the section at the tip about e{_k}")
    for _director in "abc":
        _IN_SPACE[f"tip_{_director}_{_axis}"] = ("1", f"director {_director} at the tip, along e{_k}")
        _IN_SPACE[f"{_director}_{_axis}"] = ("1", f"director {_director}, along e{_k}")
FIELDS |= _IN_SPACE
#: Columns of stations.
_OF_STATIONS = ("x", "y", "z", "theta", *(f"{director}_{axis}" for director in "ab" for axis in "xyz"))
#: Columns of rows of arms in the plane only, and in space only.
_ONLY_IN_PLANE = ("tip_theta", "base_moment", "theta")
_ONLY_IN_SPACE = ("z", "tip_z", "base_force_z", "d_tip_z", *_IN_SPACE)
#: Dimensions beyond those of the rows.
_DIMS: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(("tension", "stroke"), ("cable",)),
    **dict.fromkeys(_OF_STATIONS, ("station",)),
    **dict.fromkeys((name for name in FIELDS if name.startswith("d_tip_")), ("parameter",)),
    "d_stroke": ("cable", "parameter"),
}


class Many(Mapping[str, "NDArray[np.generic]"]):
    """The answers of `solve_many`, as arrays by name; `shape` is that of the inputs broadcast together.

    ``tip_x``, ``tip_y`` (m), ``tip_theta``, ``tip_alpha`` (rad), ``base_force_x``, ``base_force_y`` (N), ``base_moment`` (N m),
    ``error_estimate`` (m) and ``load_fraction`` have this shape; ``tension`` (N) and ``stroke`` (m) one more dimension, a cable each;
    ``x``, ``y``, ``theta`` one more, a station each. Rows without an equilibrium have NaN, and the verdict's kind in ``verdict``, which is
    the empty string elsewhere (``no_arm`` where the row's numbers make none, ``not_a_number`` where one is NaN); ``reason`` says it in a
    sentence. ``warnings`` has the kinds of `Solution.warnings` with blanks between, as in a sweep.

    Arms in space have ``tip_z``, the directors at the tip by component (``tip_a_x`` and so on; `tip_a`, `tip_b`, `tip_c` put them together),
    ``base_force_z`` and ``base_moment_x`` to ``base_moment_z`` in place of ``tip_theta`` and ``base_moment``; their stations have ``z`` and
    the components of `a` and `b` in place of ``theta``; derivatives of the tip are ``d_tip_x`` to ``d_tip_z`` and the turns about e1, e2, e3,
    ``d_tip_turn_x`` to ``d_tip_turn_z`` (rad).

    With `gradients`, ``d_tip_x``, ``d_tip_y``, ``d_tip_theta`` and ``d_tip_alpha`` have one more dimension, and ``d_stroke`` two, a cable
    and a parameter: derivatives by `parameters`, a unit of each (SI, angles in radians); NaN at a limit point.
    """

    def __init__(
        self,
        shape: tuple[int, ...],
        cables: tuple[str, ...],
        columns: dict[str, NDArray[np.generic]],
        parameters: tuple[str, ...] = (),
        length: float = float("nan"),
    ) -> None:
        self.shape = shape
        self.cables = cables
        self.parameters = parameters
        self.length = length
        self._columns = columns

    def __getitem__(self, name: str) -> NDArray[np.generic]:
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Many):
            return NotImplemented
        mine, theirs = ((one.shape, one.cables, one.parameters, one._columns) for one in (self, other))
        return _saved.same(mine, theirs)

    def __hash__(self) -> int:
        return hash((self.shape, self.cables, self.parameters))

    def __reduce__(self) -> tuple[Any, ...]:
        state = (self.shape, self.cables, self._columns, self.parameters, self.length)
        return _many, (_saved.FORMAT, _native.__version__, state)

    def __repr__(self) -> str:
        return f"<Many of shape {self.shape}: {int(self.answered.sum())} with an answer; {', '.join(self)}>"

    @property
    def answered(self) -> NDArray[np.bool_]:
        """Whether there is an equilibrium, of `shape`."""
        return np.asarray(self["verdict"] == "")

    @property
    def tip_x(self) -> NDArray[np.float64]:
        """m, of `shape`."""
        return self._number("tip_x")

    @property
    def tip_y(self) -> NDArray[np.float64]:
        """m, of `shape`."""
        return self._number("tip_y")

    @property
    def tip_z(self) -> NDArray[np.float64]:
        """m, of `shape`, in space."""
        return self._number("tip_z")

    @property
    def tip_a(self) -> NDArray[np.float64]:
        """Director normal to the section at the tip, of `shape` and (3,), in space."""
        return self._vector("tip_a")

    @property
    def tip_b(self) -> NDArray[np.float64]:
        """Director in the section at the tip, of `shape` and (3,), in space."""
        return self._vector("tip_b")

    @property
    def tip_c(self) -> NDArray[np.float64]:
        """Director in the section at the tip, a x b, of `shape` and (3,), in space."""
        return self._vector("tip_c")

    @property
    def tip_theta(self) -> NDArray[np.float64]:
        """rad, of `shape`, in the plane."""
        return self._number("tip_theta")

    @property
    def tip_alpha(self) -> NDArray[np.float64]:
        """rad, of `shape`."""
        return self._number("tip_alpha")

    @property
    def stroke(self) -> NDArray[np.float64]:
        """The stroke of each cable, m, of `shape` and (cables,)."""
        return self._number("stroke")

    @property
    def verdict(self) -> NDArray[np.str_]:
        """Why there is no equilibrium; empty where there is one; of `shape`."""
        return self._columns["verdict"].astype(np.str_)

    @property
    def reason(self) -> NDArray[np.str_]:
        """Why there is no equilibrium, in a sentence; of `shape`."""
        return self._columns["reason"].astype(np.str_)

    @property
    def tension(self) -> NDArray[np.float64]:
        """The tension of each cable at the base, N, of `shape` and (cables,)."""
        return self._number("tension")

    @property
    def base_force_x(self) -> NDArray[np.float64]:
        """N, of `shape`."""
        return self._number("base_force_x")

    @property
    def base_force_y(self) -> NDArray[np.float64]:
        """N, of `shape`."""
        return self._number("base_force_y")

    @property
    def base_force_z(self) -> NDArray[np.float64]:
        """N, of `shape`, in space."""
        return self._number("base_force_z")

    @property
    def base_moment(self) -> NDArray[np.float64]:
        """N m, of `shape`, in the plane."""
        return self._number("base_moment")

    @property
    def base_moment_x(self) -> NDArray[np.float64]:
        """N m, of `shape`, in space."""
        return self._number("base_moment_x")

    @property
    def base_moment_y(self) -> NDArray[np.float64]:
        """N m, of `shape`, in space."""
        return self._number("base_moment_y")

    @property
    def base_moment_z(self) -> NDArray[np.float64]:
        """N m, of `shape`, in space."""
        return self._number("base_moment_z")

    @property
    def error_estimate(self) -> NDArray[np.float64]:
        """Estimated error of the tip, m, of `shape`."""
        return self._number("error_estimate")

    @property
    def load_fraction(self) -> NDArray[np.float64]:
        """The fraction of the loads at which a row without an equilibrium ends, of `shape`."""
        return self._number("load_fraction")

    @property
    def x(self) -> NDArray[np.float64]:
        """Centreline along e1, m, of `shape` and (stations,), with `stations`."""
        return self._number("x")

    @property
    def y(self) -> NDArray[np.float64]:
        """Centreline along e2, m, of `shape` and (stations,), with `stations`."""
        return self._number("y")

    @property
    def z(self) -> NDArray[np.float64]:
        """Centreline along e3, m, of `shape` and (stations,), with `stations`, in space."""
        return self._number("z")

    @property
    def a(self) -> NDArray[np.float64]:
        """Director normal to the section, of `shape` and (stations, 3), with `stations`, in space."""
        return self._vector("a")

    @property
    def b(self) -> NDArray[np.float64]:
        """Director in the section, of `shape` and (stations, 3), with `stations`, in space."""
        return self._vector("b")

    @property
    def theta(self) -> NDArray[np.float64]:
        """Rotation of the section, rad, of `shape` and (stations,), with `stations`, in the plane."""
        return self._number("theta")

    @property
    def fold_margin(self) -> NDArray[np.float64]:
        """Margin of the surface against folding, of `shape`, with `fold_margin`."""
        return self._number("fold_margin")

    @property
    def stability(self) -> NDArray[np.str_]:
        """``"stable"`` and so on, of `shape`, with `stability`."""
        return self._column("stability").astype(np.str_)

    @property
    def warnings(self) -> NDArray[np.str_]:
        """The kinds of the warnings of each row, with blanks between, of `shape`."""
        return self._column("warnings").astype(np.str_)

    def _number(self, name: str) -> NDArray[np.float64]:
        return self._column(name).astype(np.float64, copy=False)

    def _vector(self, name: str) -> NDArray[np.float64]:
        return np.stack([self._number(f"{name}_{axis}") for axis in "xyz"], axis=-1)

    def _column(self, name: str) -> NDArray[np.generic]:
        if name not in self._columns:
            in_space = "tip_z" in self._columns
            if name in (_ONLY_IN_PLANE if in_space else _ONLY_IN_SPACE):
                raise AttributeError(f"{name}: only for arms in {'the plane' if in_space else 'space'}")
            option = "stations" if name in _OF_STATIONS else name
            raise AttributeError(f"{name}: these rows have none; `solve_many` has the option `{option}`")
        return self._columns[name]

    def to_pandas(self) -> pd.DataFrame:
        """One row for each, in the order of `shape`, whose places are the index where it has several dimensions; a column for each cable
        (``stroke_0``), station and parameter. Needs pandas."""
        import pandas as pd

        columns: dict[str, NDArray[np.generic]] = {}
        for name, column in self._columns.items():
            last = column.shape[len(self.shape) :]
            flat = column.reshape(-1, *last)
            for place in np.ndindex(*last):
                columns["_".join([name, *map(str, place)])] = flat[(slice(None), *place)]
        names = [f"dim_{k}" for k in range(len(self.shape))]
        places = pd.MultiIndex.from_product([range(size) for size in self.shape], names=names) if len(self.shape) > 1 else None
        return pd.DataFrame(columns, index=places)

    def to_xarray(self, *dims: Hashable) -> xr.Dataset:
        """The answers as a dataset over `dims` (``dim_0`` and so on without them), ``cable``, ``station`` (with its
        place ``s``, m) and ``parameter`` (with its ``unit``). Needs xarray."""
        import xarray as xr

        own = dims or tuple(f"dim_{k}" for k in range(len(self.shape)))
        if len(own) != len(self.shape):
            raise ValueError(f"dims: expected {len(self.shape)} names, found {len(own)}")
        variables = {}
        for name, column in self._columns.items():
            variables[name] = ((*own, *_DIMS.get(name, ())), column, self._attributes(name))
        coordinates: dict[str, Any] = {"cable": ("cable", list(self.cables))}
        if self.parameters:
            coordinates["parameter"] = ("parameter", list(self.parameters))
            coordinates["unit"] = ("parameter", [_unit_of(name) for name in self.parameters])
        if "x" in self._columns:
            places = np.linspace(0.0, self.length, self._columns["x"].shape[-1])
            coordinates["s"] = ("station", places, {"units": "m", "long_name": "length along the undeformed arm"})
        return xr.Dataset(variables, coords=coordinates, attrs={"Conventions": CONVENTIONS, "hydrostat": _native.__version__})


    def _attributes(self, name: str) -> dict[str, str]:
        """What a dataset says of an array; a derivative has a unit where all parameters have the same."""
        unit, meaning = FIELDS.get(name, ("", ""))
        if "parameter" in _DIMS.get(name, ()):
            per = {_unit_of(parameter) for parameter in self.parameters}
            unit = (f"{unit}/({per.pop()})" if len(per) == 1 else "").replace("/()", "").replace("/(N)", "/N").replace("/(m)", "/m")
            meaning += ", a unit of the parameter"
        return {key: words for key, words in (("units", unit), ("long_name", meaning)) if words}


def _unit_of(parameter: str) -> str:
    """The unit that derivatives are by: of SI, angles in radians."""
    bare = _native.bare_unit(parameter) or ""
    return "rad" if bare in ("deg", "degrees") else bare


def _many(version: int, writer: str, state: tuple[Any, ...]) -> Many:
    _saved.check("Many", version, writer)
    return Many(*state)


@overload
def solve_many(  # pyright: ignore[reportOverlappingOverload]
    arm: Arm | str | PathLike[str],
    *,
    tensions: xr.DataArray,
    flow_speed: xr.DataArray | float | None = ...,
    vary: Mapping[str, xr.DataArray | float] | None = ...,
    tol: float = ...,
    snap_distance: float = ...,
    snap_angle: float | str = ...,
    follow_snaps: bool = ...,
    tile: int = ...,
    fold_margin: bool = ...,
    stability: bool = ...,
    warnings: bool = ...,
    stations: int = ...,
    gradients: bool | Sequence[str] = ...,
    nan: str = ...,
    threads: int = ...,
    progress: bool | None = ...,
) -> xr.Dataset: ...
@overload
def solve_many(
    arm: Arm | str | PathLike[str],
    *,
    tensions: _inputs.Numbers | None = ...,
    flow_speed: xr.DataArray,
    vary: Mapping[str, xr.DataArray | float] | None = ...,
    tol: float = ...,
    snap_distance: float = ...,
    snap_angle: float | str = ...,
    follow_snaps: bool = ...,
    tile: int = ...,
    fold_margin: bool = ...,
    stability: bool = ...,
    warnings: bool = ...,
    stations: int = ...,
    gradients: bool | Sequence[str] = ...,
    nan: str = ...,
    threads: int = ...,
    progress: bool | None = ...,
) -> xr.Dataset: ...
@overload
def solve_many(  # pyright: ignore[reportOverlappingOverload]
    arm: Arm | str | PathLike[str],
    *,
    tensions: _inputs.Numbers | None = ...,
    flow_speed: ArrayLike | None = ...,
    vary: Mapping[str, xr.DataArray],
    tol: float = ...,
    snap_distance: float = ...,
    snap_angle: float | str = ...,
    follow_snaps: bool = ...,
    tile: int = ...,
    fold_margin: bool = ...,
    stability: bool = ...,
    warnings: bool = ...,
    stations: int = ...,
    gradients: bool | Sequence[str] = ...,
    nan: str = ...,
    threads: int = ...,
    progress: bool | None = ...,
) -> xr.Dataset: ...
@overload
def solve_many(
    arm: Arm | str | PathLike[str],
    *,
    tensions: _inputs.Numbers | None = ...,
    flow_speed: _inputs.Numbers | None = ...,
    vary: Mapping[str, ArrayLike] | None = ...,
    tol: float = ...,
    snap_distance: float = ...,
    snap_angle: float | str = ...,
    follow_snaps: bool = ...,
    tile: int = ...,
    fold_margin: bool = ...,
    stability: bool = ...,
    warnings: bool = ...,
    stations: int = ...,
    gradients: bool | Sequence[str] = ...,
    nan: str = ...,
    threads: int = ...,
    progress: bool | None = ...,
) -> Many: ...
def solve_many(
    arm: Arm | str | PathLike[str],
    *,
    tensions: _inputs.Numbers | xr.DataArray | None = None,
    flow_speed: _inputs.Numbers | xr.DataArray | None = None,
    vary: Mapping[str, ArrayLike] | Mapping[str, xr.DataArray | float] | None = None,
    tol: float = 1e-6,
    snap_distance: float = 0.01,
    snap_angle: float | str = 2.0,
    follow_snaps: bool = False,
    tile: int = 256,
    fold_margin: bool = False,
    stability: bool = False,
    warnings: bool = True,
    stations: int = 0,
    gradients: bool | Sequence[str] = False,
    nan: str = "row",
    threads: int = 0,
    progress: bool | None = False,
) -> Many | xr.Dataset:
    """Solve an arm at many values at once, on all processors.

    Inputs broadcast together as NumPy's do; xarray's DataArrays by their dimensions, together with single numbers. Rows are solved in an order in which
    neighbours are similar, equal rows once; the results keep the order of the inputs. Ctrl-C interrupts it.

    Parameters
    ----------
    arm : Arm, str or path
        The arm, or the name or file of one.
    tensions : array_like, shape (..., cables), optional
        N, or with units; the last dimension is the cables' (of a DataArray the one that is called ``cable``, where there is one).
    flow_speed : array_like, optional
        m/s, or with units.
    vary : mapping of str to array_like, optional
        Other numbers, by the keys that a path can vary: ``"flow.direction"`` (degrees), ``"cable[0].stroke"`` (m),
        ``"tip.force[1]"`` (N), ``"material.young"`` (Pa) and so on. What carries a unit (strings, DataArrays with the attribute
        ``units``, Quantities of pint) is converted; ``"0:20 cm/s:5"`` is a grid.
    tol : float
        Tolerance on the tip position, relative to the arm's length, in [1e-12, 1e-2].
    snap_distance, snap_angle, follow_snaps
        Which snaps are followed; see `Arm.solve`.
    tile : int
        Number of rows that are solved after one another. A row starts warm from the one before if only loads differ and this cannot
        lead to another branch. The rows do not depend on the number of processors.
    fold_margin, stability : bool
        Whether these are computed, too.
    warnings : bool
        Whether the kinds of warnings are computed; this reads the whole shape of each row.
    stations : int
        Number of equally spaced stations of each row, at most 10000; none below 2.
    gradients : bool or sequence of str
        Derivatives of tip and strokes by these parameters (see `Solver.sensitivities`); by the tensions (strokes, where they are
        commanded) and by what `vary` varies, if true.
    nan : str
        How a row with NaN, or with a masked or NA number, is treated: ``"row"``, a row without an answer, or ``"refuse"``, a `ValueError`.
    threads : int
        0 for all processors.
    progress : bool, optional
        Whether to show a bar on standard error; by default on a terminal.

    Returns
    -------
    Many
        Arrays by name.
    xarray.Dataset
        The same over the inputs' dimensions, with their coordinates, where one of them is a DataArray.

    Raises
    ------
    MemoryError
        The rows do not fit in memory; nothing was solved.
    ValueError
        Shapes do not broadcast, a dtype is not numeric, or a tension or speed is negative; the message names the argument.

    Examples
    --------
    >>> import numpy as np, hydrostat as hs
    >>> arm = hs.Arm.load("silicone")
    >>> many = hs.solve_many(arm, tensions=[[0.1, 0.0], [0.2, 0.0], [1.4, 0.0]], flow_speed=np.array([[0.0], [0.1]]))
    >>> many.shape, many.stroke.shape
    ((2, 3), (2, 3, 2))
    >>> many.verdict[0].tolist()
    ['', '', 'cable_fold']
    >>> rows = hs.solve_many(arm, tensions=[[0.1, 0.0], [np.nan, 0.0]], gradients=True)
    >>> rows.parameters
    ('cable[0].tension', 'cable[1].tension')
    >>> rows["d_tip_x"].shape, str(rows["reason"][1])
    ((2, 2), '`cable[0].tension` is not a number')
    """
    arm = arm_of(arm)
    if nan not in ("row", "refuse"):
        raise ValueError(f"nan: expected row or refuse, found {nan!r}")
    tensions, flow_speed, vary = _without_units(arm, tensions, flow_speed, vary)
    labelled = _labelled(tensions, flow_speed, vary)
    if labelled is not None:
        tensions, flow_speed, vary, like = labelled
        options: dict[str, Any] = {"snap_distance": snap_distance, "snap_angle": snap_angle, "follow_snaps": follow_snaps}
        options |= {"tol": tol, "tile": tile, "fold_margin": fold_margin, "stability": stability, "warnings": warnings, "stations": stations}
        options |= {"gradients": gradients, "nan": nan, "threads": threads, "progress": progress}
        many = solve_many(arm, tensions=tensions, flow_speed=flow_speed, vary=vary, **options)
        return many.to_xarray(*like.dims).assign_coords(like.coords)
    cables = arm.cables
    places = _memory.stations("stations", _inputs.count("stations", stations))
    keys = [f"cable[{index}].tension" for index in range(len(cables) if tensions is not None else 0)]
    keys += [*(["flow.speed"] if flow_speed is not None else []), *vary]
    by = _parameters(arm, keys, gradients)
    # Columns, answers and what becomes of them: of a row the library holds all fields of its stations.
    of_row, of_station, of_tip = (72, 36, 6) if arm.is_spatial else (48, 15, 4)
    numbers = 2 * len(keys) + of_row + 4 * len(cables) + of_station * places + 2 * len(by) * (of_tip + len(cables))
    _require(_rows_of(tensions, [flow_speed, *vary.values()]), numbers)
    given, names = _given(arm, tensions, flow_speed, vary, missing=nan == "row")
    try:
        shape = np.broadcast_shapes(*(values.shape for values in given.values()))
    except ValueError as error:
        shapes = ", ".join(f"{name} {given[key].shape}" for key, name in names.items())
        raise ValueError(f"shapes do not broadcast: {shapes} (tensions without their last dimension)") from error
    rows = math.prod(shape)
    _require(rows, numbers)
    columns = [np.ascontiguousarray(np.broadcast_to(values, shape)).ravel() for values in given.values()]
    with Progress(rows, progress) as bar:
        found = _native.solve_many(
            arm._inner,
            list(given),
            columns,
            rows,
            _inputs.number("tol", tol),
            _inputs.snaps(snap_distance, snap_angle, follow_snaps),
            _inputs.count("tile", tile),
            True,
            fold_margin,
            stability,
            warnings,
            places,
            by,
            _inputs.count("threads", threads),
            bar if bar.shown else None,
        )
    out: dict[str, NDArray[np.generic]] = {}
    sizes = {"cable": len(cables), "station": places, "parameter": len(by)}
    for name, column in found.items():
        if isinstance(column, list):
            out[name] = np.array(column, dtype=np.str_).reshape(shape)
        else:
            out[name] = column.reshape(shape + tuple(sizes[dim] for dim in _DIMS.get(name, ())))
    return Many(shape, cables, out, tuple(by), arm.length)


def _require(rows: int, numbers: int) -> None:
    """Raise a `MemoryError` where so many rows of so many numbers do not fit."""
    _memory.require(8 * numbers * rows, f"{rows} rows", "take fewer, or write them to a file with `hydrostat.sweep(..., output=...)`")


def _rows_of(tensions: Any, others: Iterable[Any]) -> int:
    """How many rows inputs make, by the shapes of those that have one; nothing is copied."""
    shapes = [np.shape(values) for values in others if hasattr(values, "shape")]
    shapes += [np.shape(tensions)[:-1]] if hasattr(tensions, "shape") else []
    try:
        return math.prod(np.broadcast_shapes(*shapes))
    except ValueError:
        # What does not broadcast is refused with its name later.
        return 0


def _without_units(arm: Arm, tensions: Any, flow_speed: Any, vary: Any) -> tuple[Any, Any, dict[str, Any]]:
    """Inputs as numbers in the units of bare ones; texts of `vary` as a sweep takes them."""
    pulled = _units.plain("tensions", _inputs.of_cables(tensions, arm), _units.TENSION)
    varied = {}
    for key, values in _inputs.mapping("vary", vary or {}, '{"flow.direction": [0, 90]}').items():
        name = f"vary[{key!r}]"
        several = isinstance(values, str) and (":" in values or "," in values)
        varied[key] = (_units.grid if several else _units.plain)(name, values, key, arm._inner)
    return pulled, _units.plain("flow_speed", flow_speed, _units.SPEED), varied


def _labelled(tensions: Any, flow_speed: Any, vary: Any) -> tuple[Any, Any, Any, xr.DataArray] | None:
    """Inputs as arrays of one shape, and one with all dimensions and coordinates, where some are DataArrays."""
    named = {"tensions": tensions, "flow_speed": flow_speed}
    others = {f"vary[{key!r}]": values for key, values in vary.items()} if isinstance(vary, Mapping) else {}
    given = {name: values for name, values in {**named, **others}.items() if values is not None}
    # Nothing is one whose class was never imported.
    xarray = sys.modules.get("xarray")
    if xarray is None or not any(isinstance(values, xarray.DataArray) for values in given.values()):
        return None
    arrays: dict[str, xr.DataArray] = {}
    for name, values in given.items():
        if isinstance(values, xarray.DataArray):
            arrays[name] = values
        elif name == "tensions" and np.ndim(values) == 1:
            arrays[name] = xarray.DataArray(np.asarray(values), dims="cable")
        elif np.ndim(values) == 0:
            arrays[name] = xarray.DataArray(values)
        else:
            raise ValueError(f"{name}: expected a DataArray, as the others, or one number, found an array of shape {np.shape(values)}")
    cables = None
    if "tensions" in arrays:
        pulled = arrays["tensions"]
        if not pulled.dims:
            raise ValueError("tensions: expected a dimension of the cables, found one number")
        cables = "cable" if "cable" in pulled.dims else pulled.dims[-1]
        arrays["tensions"] = pulled.transpose(..., cables)
    rows = [array.isel({cables: 0}, drop=True) if name == "tensions" else array for name, array in arrays.items()]
    try:
        xarray.align(*rows, join="exact")
    except ValueError as error:
        words = "give them the same, or `xarray.align` them first"
        raise ValueError(f"{', '.join(arrays)}: expected the same coordinates along the same dimensions; {words} ({error})") from error
    like = xarray.broadcast(*rows)[0]
    taken = {"cable", "station", "parameter"} & set(like.dims)
    if taken:
        raise ValueError(f"dims: {taken.pop()!r} is a dimension of the answers; rename that of the inputs")

    def spread(name: str) -> Any:
        array = arrays.get(name)
        if array is None:
            return None
        if name != "tensions":
            return array.broadcast_like(like).transpose(*like.dims).values
        return array.broadcast_like(like, exclude=[cables]).transpose(*like.dims, cables).values

    keys = {f"vary[{key!r}]": key for key in vary} if isinstance(vary, Mapping) else {}
    return spread("tensions"), spread("flow_speed"), {key: spread(name) for name, key in keys.items()}, like


def _given(
    arm: Arm, tensions: Any, flow_speed: Any, vary: Mapping[str, Any], *, missing: bool
) -> tuple[dict[str, NDArray[np.float64]], dict[str, str]]:
    """Values by keys, and the arguments that they come from."""
    count = len(arm.cables)
    given: dict[str, NDArray[np.float64]] = {}
    names: dict[str, str] = {}
    if tensions is not None:
        pulled = _inputs.finite("tensions", tensions, negative=False, missing=missing)
        if pulled.ndim == 0 or pulled.shape[-1] != count:
            raise ValueError(f"tensions: expected the shape (..., {count}), one a cable, found {pulled.shape}")
        for index in range(count):
            given[f"cable[{index}].tension"] = pulled[..., index]
            names[f"cable[{index}].tension"] = "tensions"
    if flow_speed is not None:
        given["flow.speed"] = _inputs.finite("flow_speed", flow_speed, negative=False, missing=missing)
        names["flow.speed"] = "flow_speed"
    for key, values in _inputs.mapping("vary", vary or {}, '{"flow.direction": [0, 90]}').items():
        name = f"vary[{key!r}]"
        if key in given:
            raise ValueError(f"{name}: is given a second time, by {names[key]}")
        positive = key.endswith(("tension", ".speed", ".density"))
        given[key] = _inputs.finite(name, values, negative=not positive, missing=missing)
        names[key] = name
    return given, names


def _parameters(arm: Arm, varied: list[str], gradients: bool | Sequence[str]) -> list[str]:
    """What derivatives are by."""
    if isinstance(gradients, (bool, np.bool_)):
        if not gradients:
            return []
        commanded = [f"cable[{index}].stroke" in varied or stroke for index, stroke in enumerate(arm._inner.commanded)]
        pulls = [f"cable[{index}].{'stroke' if held else 'tension'}" for index, held in enumerate(commanded)]
        return list(dict.fromkeys([*pulls, *varied]))
    if isinstance(gradients, str):
        raise TypeError(f"gradients: expected true, false or a list of keys, found {gradients!r}")
    return [_inputs.text("gradients", name, "flow.speed") for name in _inputs.items("gradients", gradients, "keys")]
