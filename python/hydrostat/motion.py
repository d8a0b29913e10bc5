"""The arm in motion: whole runs with time, and steps for control loops."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any, NamedTuple, Union, cast

import numpy as np

from hydrostat import _inputs, _native, _units
from hydrostat._errors import MotionError
from hydrostat.arm import Arm, arm_of
from hydrostat.figures import Figure
from hydrostat.spatial import SpatialTip, Vector

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from numpy.typing import ArrayLike, NDArray

    Course = Union[Callable[[float], float], float, Sequence[Sequence[float]], NDArray[np.floating[Any]]]

#: Columns that are functions of cables, and what they are called.
_OF_CABLES = {"stroke": ("m", "length reeled in"), "tension": ("N", "tension at the base")}

#: What the other columns are called and mean.
_COLUMNS = {
    "tip_x_m": ("tip_x", "m", "place of the tip"),
    "tip_y_m": ("tip_y", "m", "place of the tip"),
    "tip_z_m": ("tip_z", "m", "place of the tip"),
    "tip_theta_rad": ("tip_theta", "rad", "turn of the tip section"),
    "tip_vx_m_s": ("tip_vx", "m/s", "velocity of the tip"),
    "tip_vy_m_s": ("tip_vy", "m/s", "velocity of the tip"),
    "tip_vz_m_s": ("tip_vz", "m/s", "velocity of the tip"),
    "tip_alpha_rad": ("tip_alpha", "rad", "angle between the normal of the tip section and the centreline"),
    "kinetic_energy_J": ("kinetic_energy", "J", "kinetic energy of the arm"),
    "strain_energy_J": ("strain_energy", "J", "energy of strain"),
    "base_force_x_N": ("base_force_x", "N", "base reaction along e1"),
    "base_force_y_N": ("base_force_y", "N", "base reaction along e2"),
    "base_force_z_N": ("base_force_z", "N", "base reaction along e3"),
    "base_moment_Nm": ("base_moment", "N m", "base reaction, about the base"),
    "base_moment_x_Nm": ("base_moment_x", "N m", "base reaction about e1, about the base"),
    "base_moment_y_Nm": ("base_moment_y", "N m", "base reaction about e2, about the base"),
    "base_moment_z_Nm": ("base_moment_z", "N m", "base reaction about e3, about the base"),
    "cable_work_J": ("cable_work", "J", "work of the cables since the start"),
    "water_work_J": ("water_work", "J", "work of the water since the start"),
    "gravity_work_J": ("gravity_work", "J", "work of gravity since the start"),
    "load_work_J": ("load_work", "J", "work of loads on the tip and along the arm since the start"),
    "base_work_J": ("base_work", "J", "work of the base since the start"),
    "volume_work_J": ("volume_work", "J", "work beside all loads where sections swell, since the start"),
    "dissipated_J": ("dissipated", "J", "energy dissipated by the material since the start"),
}

#: What there is at a node, with how many components: in the plane, and in space.
_AT_NODES: tuple[tuple[tuple[str, int, str, str], ...], ...] = (
    (("x", 1, "m", "centreline"), ("y", 1, "m", "centreline"), ("theta", 1, "rad", "turn of the section")),
    (
        ("x", 1, "m", "centreline"),
        ("y", 1, "m", "centreline"),
        ("z", 1, "m", "centreline"),
        ("a", 3, "1", "director normal to the section"),
        ("b", 3, "1", "director in the section"),
        ("c", 3, "1", "director in the section, a x b"),
    ),
)

#: Numbers at a node in the plane.
_PLANE = 3

#: How far (over its range) a smooth line through samples may be from a function of time.
_SAMPLED = 1e-5
#: The most pieces that such a line has.
_MOST = 20_000


class Moment(NamedTuple):
    """The arm at one time, s: the tip, m and rad, its velocity, m/s, `tensions`, N, and `strokes`, m, of the cables, and energies, J."""

    time: float
    tip_x: float
    tip_y: float
    tip_theta: float
    tip_vx: float
    tip_vy: float
    tensions: tuple[float, ...]
    strokes: tuple[float, ...]
    kinetic_energy: float
    strain_energy: float


class SpatialMoment(NamedTuple):
    """A `Moment` in space: the directors of the tip in place of its turn, and three components."""

    time: float
    tip_x: float
    tip_y: float
    tip_z: float
    tip_a: Vector
    tip_b: Vector
    tip_c: Vector
    tip_vx: float
    tip_vy: float
    tip_vz: float
    tensions: tuple[float, ...]
    strokes: tuple[float, ...]
    kinetic_energy: float
    strain_energy: float


class Simulation:
    """An arm in motion, step by step: for control loops. It begins at rest in the equilibrium of its loads.

    Parameters
    ----------
    arm : Arm, str or path
        The arm, or the name or file of one. Its table ``[dynamics]`` has added mass, viscosity and whether there is inertia.
    tol : float
        Tolerance on the tip position, relative to the arm's length, in [1e-9, 1e-2]. Steps in time follow from it.
    elements : int, optional
        Elements of the mesh along the arm; by the tolerance if not given.

    A copy continues from the same motion, independently.

    Examples
    --------
    >>> import hydrostat as hs
    >>> arm = hs.Arm.load("silicone").replace({"dynamics.relaxation_time": "2.7 ms"})
    >>> sim = hs.Simulation(arm, tol=1e-3)
    >>> for _ in range(10):
    ...     at = sim.step(0.02, tensions=[0.1, 0])
    >>> round(at.time, 3), at.tip_y > 0.01, at.tensions[0]
    (0.2, True, 0.1)
    """

    __slots__ = ("_arm", "_columns", "_inner")

    def __init__(self, arm: Arm | str | PathLike[str], *, tol: float = 1e-4, elements: int | None = None) -> None:
        self._arm = arm_of(arm)
        self._inner = _made(self._arm, [], tol, elements)
        self._columns = {name: k for k, name in enumerate(self._inner.columns)}

    def __copy__(self) -> Simulation:
        out = Simulation.__new__(Simulation)
        out._arm, out._inner, out._columns = self._arm, self._inner.copy(), self._columns
        return out

    def __deepcopy__(self, memo: object) -> Simulation:
        return self.__copy__()

    def __repr__(self) -> str:
        return f"<Simulation of {self._arm.name} at {self.time:g} s>"

    @property
    def time(self) -> float:
        """The present time, s."""
        return self._inner.time

    def now(self) -> Moment:
        """The arm at the present time; of an arm in space a `SpatialMoment`."""
        return self._moment(self._inner.now())

    def step(self, dt: float, tensions: ArrayLike | None = None, *, loads: Mapping[str, float] | None = None) -> Moment:
        """Move on by `dt`, s, while loads change along straight lines, and keep them from then on. Other threads run meanwhile.

        Parameters
        ----------
        dt : float
            s. What happens within it is resolved to the tolerance, whatever its length.
        tensions : array_like, shape (cables,), optional
            Those at the end of the step, N.
        loads : mapping, optional
            Keys of the arm file with their values at the end of the step, SI units, angles in degrees: ``{"flow.speed": 0.1}``.

        Returns
        -------
        Moment
            Of an arm with ``space = "spatial"`` a `SpatialMoment`.

        Raises
        ------
        MotionError
            The motion ends before, because a cable folds its side of the arm shut, say.
        """
        wanted: list[tuple[str, float]] = []
        if tensions is not None:
            pulls = _inputs.finite("tensions", tensions, negative=False)
            if pulls.shape != (len(self._arm.cables),):
                raise ValueError(f"tensions: expected one for each of {len(self._arm.cables)} cables, found shape {pulls.shape}")
            wanted += [(f"cable[{i}].tension", float(pull)) for i, pull in enumerate(pulls)]
        for key, value in _inputs.mapping("loads", loads or {}, '{"flow.speed": 0.1}').items():
            wanted.append((key, float(_si(key, np.array([_inputs.number(key, value)]))[0])))
        return self._moment(self._inner.step(_inputs.number("dt", dt), wanted))

    def shape(self) -> tuple[NDArray[np.float64], ...]:
        """x and y, m, and theta, rad, at the nodes of the mesh, base to tip; in space x, y and z, m, and the directors a, b, c, shape (n, 3)."""
        return tuple(values for _, values, _ in _at_nodes(self._inner, self._inner.shape(), 0))

    @property
    def statistics(self) -> dict[str, int]:
        """What the motion took: steps in time, those taken back, solves, rounds, elements."""
        return dict(self._inner.statistics)

    @property
    def error_estimate(self) -> float:
        """Sum of the estimated errors of all steps at the tip, m."""
        return self._inner.error_estimate

    def _moment(self, row: list[float]) -> Moment:
        at = {name: row[k] for name, k in self._columns.items()}
        cables = range(len(self._arm.cables))
        energies = (at["kinetic_energy_J"], at["strain_energy_J"])
        pulls = (tuple(at[f"tension_{c}_N"] for c in cables), tuple(at[f"stroke_{c}_m"] for c in cables))
        if not self._arm._inner.is_spatial:
            tip = (at["tip_x_m"], at["tip_y_m"], at["tip_theta_rad"], at["tip_vx_m_s"], at["tip_vy_m_s"])
            return Moment(at["t_s"], *tip, *pulls, *energies)
        a, b, c = ((at[f"tip_{name}_x"], at[f"tip_{name}_y"], at[f"tip_{name}_z"]) for name in "abc")
        place = (at["tip_x_m"], at["tip_y_m"], at["tip_z_m"])
        velocity = (at["tip_vx_m_s"], at["tip_vy_m_s"], at["tip_vz_m_s"])
        return cast("Moment", SpatialMoment(at["t_s"], *place, a, b, c, *velocity, *pulls, *energies))


def simulate(
    arm: Arm | str | PathLike[str],
    inputs: Mapping[str, Course] | pd.DataFrame | None = None,
    *,
    until: float | str,
    every: float | str | None = None,
    tol: float = 1e-4,
    elements: int | None = None,
) -> xr.Dataset:
    """Move an arm in time under loads that change. It begins at rest in the equilibrium of the loads at t = 0. Needs xarray.

    Parameters
    ----------
    arm : Arm, str or path
        The arm, or the name or file of one. Its table ``[dynamics]`` has added mass, viscosity and whether there is inertia.
    inputs : mapping or DataFrame, optional
        Keys of the arm file with what they are over time, SI units, angles in degrees: a number; a function of the time in s, which is
        sampled until a smooth line through the samples is within 1e-5 of its range; or rows ``[time, value]`` joined by straight lines,
        where two rows at one time are a jump. Or a table with a column ``t_s`` and one for each key.
    until : float or str
        End, s, or with a unit: ``"200 ms"``.
    every : float or str, optional
        Time between rows, s, or with a unit; a hundredth of the whole if not given.
    tol : float
        Tolerance on the tip position, relative to the arm's length, in [1e-9, 1e-2].
    elements : int, optional
        Elements of the mesh along the arm; by the tolerance if not given.

    Returns
    -------
    xarray.Dataset
        Over ``time``: the tip and its velocity, energies, and over ``cable`` strokes and tensions; over ``node`` the whole shape. Of an arm
        in space there are ``z``, and over ``axis`` the directors ``a``, ``b``, ``c`` and those of the tip, in place of ``theta``.

    Raises
    ------
    MotionError
        The motion ends before its time; ``data`` has what was before.

    Examples
    --------
    >>> import hydrostat as hs
    >>> arm = hs.Arm.load("silicone").replace({"dynamics.relaxation_time": "2.7 ms"})
    >>> motion = hs.simulate(arm, {"cable[0].tension": [[0, 0], [0.1, 0.2]]}, until=0.2, every=0.05, tol=1e-3)
    >>> motion.sizes["time"], float(motion.tension[-1, 0])
    (5, 0.2)
    """
    own = arm_of(arm)
    end = _inputs.number("until", until, negative=False, key=_units.TIME)
    apart = 0.01 * end if every is None else _inputs.number("every", every, negative=False, key=_units.TIME)
    if not (end > 0.0 and apart > 0.0):
        raise ValueError("until, every: expected times above 0")
    courses = [_course(key, course, end) for key, course in _keyed(inputs)]
    native = _made(own, courses, tol, elements)
    rows, shapes, ended = native.run(end, apart)
    data = _dataset(own, native, rows, shapes)
    if ended is not None:
        kind, time, where, message = ended
        data.attrs["verdict"] = message
        raise MotionError(message, kind, time, where, data)
    return data


def motion_figures(motion: xr.Dataset, *, shapes: int = 24, title: str | None = None) -> tuple[Figure, Figure]:
    """The figures of `simulate`: shapes at equal times, from pale to dark, with the tip trace; and tip and energies over time.

    Shapes in space are seen from four sides.
    """
    axes = [name for name in ("x", "y", "z") if name in motion.data_vars]
    places = np.stack([motion[name].to_numpy() for name in axes], axis=-1).ravel()
    energies = (_plain(motion["kinetic_energy"]), _plain(motion["strain_energy"]))
    name = str(motion.attrs.get("arm", "arm")) + " in motion" if title is None else title
    times, count = _plain(motion["time"]), _inputs.count("shapes", shapes)
    strobe, over_time = _native.motion_figures(times, places, energies, len(axes), count, name)
    return Figure(strobe), Figure(over_time)


class MovingShape:
    """An arm at one time of a motion, as `hydrostat.animate` draws it: its width is that of the unloaded arm."""

    is_spatial = False

    def __init__(self, s: NDArray[np.float64], half_width: NDArray[np.float64], x: ArrayLike, y: ArrayLike, theta: ArrayLike) -> None:
        self.s = s
        self._half_width = half_width
        self._fields = {"x": np.asarray(x), "y": np.asarray(y), "theta": np.asarray(theta)}
        self.cables: tuple[object, ...] = ()
        self.arm = self
        self.length = float(s[-1])

    def at(self, s: ArrayLike) -> MovingShape:
        """The same at other places along the arm, m."""
        places = np.asarray(s, dtype=np.float64)
        x, y, theta = (_cubic(self.s, values, places) for values in self._fields.values())
        return MovingShape(places, np.interp(places, self.s, self._half_width), x, y, theta)

    @property
    def x(self) -> NDArray[np.float64]:
        """m."""
        return self._fields["x"]

    @property
    def y(self) -> NDArray[np.float64]:
        """m."""
        return self._fields["y"]

    def surfaces(self, s: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The surface on the left and on the right, m, shape (n, 2)."""
        at = self.at(s)
        middle = np.stack([at.x, at.y], axis=-1)
        across = at._half_width[:, None] * np.stack([-np.sin(at._fields["theta"]), np.cos(at._fields["theta"])], axis=-1)
        return middle + across, middle - across


class MovingShapeInSpace:
    """An arm in space at one time of a motion, as `hydrostat.animate` draws it, with the width of the unloaded arm."""

    is_spatial = True

    def __init__(self, s: NDArray[np.float64], half_width: NDArray[np.float64], *fields: ArrayLike) -> None:
        self.s = s
        self._half_width = half_width
        self._fields = tuple(np.asarray(field, dtype=np.float64) for field in fields)
        self.cables: tuple[object, ...] = ()
        self.arm = self
        self.length = float(s[-1])

    @property
    def tip(self) -> SpatialTip:
        """Place of the tip, m, and its directors."""
        x, y, z, a, b, c = (field[-1] for field in self._fields)
        return SpatialTip.of(float(x), float(y), float(z), a, b, c, math.nan)

    def at(self, s: ArrayLike) -> MovingShapeInSpace:
        """The same at other places along the arm, m."""
        places = np.asarray(s, dtype=np.float64)
        width = np.interp(places, self.s, self._half_width)
        return MovingShapeInSpace(places, width, *(_cubic(self.s, field, places) for field in self._fields))

    @property
    def x(self) -> NDArray[np.float64]:
        """m."""
        return self._fields[0]

    @property
    def y(self) -> NDArray[np.float64]:
        """m."""
        return self._fields[1]

    @property
    def z(self) -> NDArray[np.float64]:
        """m."""
        return self._fields[2]

    def surface(self, s: ArrayLike, sides: int) -> NDArray[np.float64]:
        """Places on the surface, m, shape (n, sides, 3)."""
        at = self.at(s)
        x, y, z, _, b, c = at._fields
        angles = 2.0 * np.pi * np.arange(sides) / sides
        across = np.cos(angles)[:, None] * b[:, None, :] + np.sin(angles)[:, None] * c[:, None, :]
        out: NDArray[np.float64] = np.stack([x, y, z], axis=-1)[:, None, :] + at._half_width[:, None, None] * across
        return out


def shapes_of(motion: xr.Dataset) -> list[MovingShape] | list[MovingShapeInSpace]:
    """The shapes of a motion, one a time."""
    s, width = _plain(motion["s"]), _plain(motion["half_width"])
    in_space = "z" in motion.data_vars
    fields = zip(*(motion[name].to_numpy() for name, *_ in _AT_NODES[in_space]), strict=True)
    if in_space:
        return [MovingShapeInSpace(s, width, *own) for own in fields]
    return [MovingShape(s, width, *own) for own in fields]


def _cubic(s: NDArray[np.float64], values: NDArray[np.float64], at: NDArray[np.float64]) -> NDArray[np.float64]:
    """A smooth line through values at places, the first axis."""
    slopes = np.gradient(values, s, axis=0, edge_order=2)
    k = np.clip(np.searchsorted(s, at, side="right") - 1, 0, len(s) - 2)
    over = (...,) + (np.newaxis,) * (values.ndim - 1)
    h = (s[k + 1] - s[k])[over]
    t = (at - s[k])[over] / h
    rise = t * t * (3.0 - 2.0 * t)
    bend = h * t * (1.0 - t) * ((1.0 - t) * slopes[k] - t * slopes[k + 1])
    out: NDArray[np.float64] = values[k] + rise * (values[k + 1] - values[k]) + bend
    return out


def _made(arm: Arm, courses: list[_native.Given], tol: float, elements: int | None) -> _native.Simulation:
    count = None if elements is None else _inputs.count("elements", elements)
    return _native.Simulation(arm._inner, courses, _inputs.number("tol", tol), 0.0, count)


def _keyed(inputs: Mapping[str, Course] | pd.DataFrame | None) -> Iterable[tuple[str, Course]]:
    if inputs is None:
        return ()
    if hasattr(inputs, "columns"):
        if "t_s" not in inputs.columns:
            raise ValueError("inputs: expected a column t_s with times in s")
        times = np.asarray(inputs["t_s"], dtype=np.float64)
        keys = [str(key) for key in inputs.columns if key != "t_s"]
        return [(key, np.stack([times, np.asarray(inputs[key], dtype=np.float64)], axis=1)) for key in keys]
    given = _inputs.mapping("inputs", inputs, '{"flow.speed": 0.1}')
    return [(str(key), course) for key, course in given.items()]


def _course(key: str, course: Course, until: float) -> _native.Given:
    """Times and values of a key, and whether a smooth line joins them."""
    if callable(course):
        times, values = _sampled(key, course, until)
        return key, times, _si(key, values), True
    rows = _inputs.numbers(key, course)
    if rows.ndim == 0:
        rows = np.array([[0.0, float(rows)]])
    if rows.ndim != 2 or rows.shape[1] != 2 or len(rows) == 0:
        raise ValueError(f"{key}: expected a number, a function of time, or rows [time, value], found an array of shape {rows.shape}")
    return key, np.ascontiguousarray(rows[:, 0]), _si(key, np.ascontiguousarray(rows[:, 1])), False


def _sampled(key: str, course: Callable[[float], float], until: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Samples of a function, so many that halving them would change what is between by little."""
    pieces = 64
    while True:
        times = np.linspace(0.0, until, 2 * pieces + 1)
        values = np.array([_inputs.number(key, course(float(t))) for t in times])
        off = np.abs(_cubic(times[::2], values[::2], times[1::2]) - values[1::2]).max()
        if off <= _SAMPLED * max(float(np.ptp(values)), 1e-300) or 2 * pieces >= _MOST or not math.isfinite(off):
            return times, values
        pieces *= 2


def _si(key: str, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Values in SI units: angles are in degrees."""
    return np.radians(values) if _native.bare_unit(key) in ("deg", "degrees") else values


def _plain(array: xr.DataArray) -> NDArray[np.float64]:
    return np.ascontiguousarray(array.to_numpy(), dtype=np.float64)


def _dataset(arm: Arm, native: _native.Simulation, rows: NDArray[np.float64], shapes: NDArray[np.float64]) -> xr.Dataset:
    import xarray as xr

    columns = native.columns
    table = rows.reshape(-1, len(columns))
    at = {name: table[:, k] for k, name in enumerate(columns)}
    s, width = native.nodes()
    data: dict[str, Any] = {}
    for name, (unit, meaning) in _OF_CABLES.items():
        each = [at.pop(f"{name}_{c}_{unit}") for c in range(len(arm.cables))]
        values = np.stack(each, axis=1) if each else np.empty((len(table), 0))
        data[name] = (("time", "cable"), values, {"units": unit, "long_name": meaning})
    time = at.pop("t_s")
    for name in "abc" if arm._inner.is_spatial else "":
        director = np.stack([at.pop(f"tip_{name}_{axis}") for axis in "xyz"], axis=1)
        data[f"tip_{name}"] = (("time", "axis"), director, {"units": "1", "long_name": "director of the tip section"})
    for name, values in at.items():
        short, unit, meaning = _COLUMNS[name]
        data[short] = ("time", values, {"units": unit, "long_name": meaning})
    for name, values, about in _at_nodes(native, shapes, len(table)):
        data[name] = (("time", "node", "axis")[: values.ndim], values, about)
    data["half_width"] = ("node", width, {"units": "m", "long_name": "radius of the unloaded arm"})
    coordinates: dict[str, Any] = {
        "time": ("time", time, {"units": "s"}),
        "cable": ("cable", list(arm.cables)),
        "s": ("node", s, {"units": "m", "long_name": "place along the unloaded arm"}),
    }
    if arm._inner.is_spatial:
        coordinates["axis"] = ("axis", ["x", "y", "z"])
    attributes = {"arm": arm.name, "error_estimate": native.error_estimate, **dict(native.statistics)}
    return xr.Dataset(data, coordinates, attributes)


def _at_nodes(
    native: _native.Simulation, shapes: NDArray[np.float64], rows: int
) -> Iterable[tuple[str, NDArray[np.float64], dict[str, str]]]:
    """What there is at the nodes, with its name and what it is; over the rows first, where there are any."""
    whole = shapes.reshape(*([rows] if rows else []), -1, native.width)
    first = 0
    for name, count, unit, meaning in _AT_NODES[native.width > _PLANE]:
        own = whole[..., first] if count == 1 else whole[..., first : first + count]
        first += count
        yield name, np.ascontiguousarray(own), {"units": unit, "long_name": meaning}
