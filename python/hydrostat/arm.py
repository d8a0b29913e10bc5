"""Arms: geometry, material, cables and loads."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from hydrostat import _inputs, _native, _units
from hydrostat._saved import Origin
from hydrostat.solution import Solution, solution_of, warn, warn_of_all

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from hydrostat.identification import Fit, Keys, Measured, Priors
    from hydrostat.paths import Equilibria, EquilibriumPath
    from hydrostat.reach import AnyTargets, Boundary, Most, Number, Reach, Targets
    from hydrostat.sensitivity import Sensitivities

#: A table of the arm file.
Table = Mapping[str, Any]

_TABLES = ("name", "arm", "material", "reference", "cable", "flow", "gravity", "tip", "distributed", "model", "dynamics")


def arms() -> dict[str, str]:
    """Names and descriptions of the arms that ship with the package."""
    return dict(_native.shipped_names())


class Arm:
    """A soft arm and everything that acts on it; immutable.

    The keyword arguments are the tables of the arm file, with its keys. Numbers are in SI units, bare angles in degrees, and a
    string with a unit (``"8 mm"``) may replace any number.

    Parameters
    ----------
    arm : mapping
        ``length``, ``radius`` (a number, ``{"base": ..., "tip": ...}`` or points ``[[s, value], ...]``), ``inner_radius``,
        ``cavity``, ``density``, ``base``.
    material : mapping
        ``young``, ``poisson``, ``shear_factor``, or ``c1``, ``c2``, ``c3``.
    cable : sequence of mapping
        Each with ``name``, ``offset``, ``tension`` or ``stroke``, ``friction``, ``end`` and so on.
    reference, flow, gravity, tip, distributed, model, dynamics : mapping
        Further tables; defaults if left out.
    name : str
        A name for people.

    Raises
    ------
    ArmError
        A `ValueError`; its ``key`` is the key that is wrong.

    Examples
    --------
    >>> import hydrostat as hs
    >>> arm = hs.Arm(
    ...     arm={"length": 0.245, "radius": {"base": "10 mm", "tip": "2 mm"}, "density": 1080},
    ...     material={"young": 110e3},
    ...     cable=[{"name": "left", "offset": {"base": 0.005, "tip": 0.001}}],
    ... )
    >>> arm.cables
    ('left',)
    >>> bool(arm.solve(tensions=[0.2]).tip.y > 0)
    True
    """

    __slots__ = ("_inner",)

    _inner: _native.Arm

    def __init__(
        self,
        *,
        arm: Table,
        material: Table,
        cable: Sequence[Table] = (),
        reference: Table | None = None,
        flow: Table | None = None,
        gravity: Table | None = None,
        tip: Table | None = None,
        distributed: Table | None = None,
        model: Table | None = None,
        dynamics: Table | None = None,
        name: str = "arm",
    ) -> None:
        tables = {
            "name": name,
            "arm": arm,
            "material": material,
            "reference": reference,
            "cable": cable or None,
            "flow": flow,
            "gravity": gravity,
            "tip": tip,
            "distributed": distributed,
            "model": model,
            "dynamics": dynamics,
        }
        lines = [f"{key} = {_inputs.toml(key, table)}" for key, table in tables.items() if table is not None]
        self._inner = _native.Arm("\n".join(lines), "arguments")

    @classmethod
    def _of(cls, native: _native.Arm) -> Arm:
        out = cls.__new__(cls)
        out._inner = native
        return out

    @classmethod
    def load(cls, arm: str | PathLike[str]) -> Arm:
        """Read an arm file, or take an arm that ships with the package by its name.

        Parameters
        ----------
        arm : str or path
            ``"paper"``, ``"paper-statements"``, ``"silicone"``, ``"multi-bending"``, ``"octopus"``, ``"octopus-spatial"``,
            ``"silicone-spatial"``, ``"tentacle"``, or a TOML file. A file
            with the name of a shipped arm takes precedence.

        Raises
        ------
        FileNotFoundError
            Neither a file nor a shipped arm.
        ArmError
            The file does not describe an arm; the message has the line, the key, what was expected and what was found.
        """
        path = FilePath(fspath(arm))
        shipped = None if path.is_file() else _native.shipped(str(arm))
        if shipped is not None:
            return cls._of(_native.Arm(shipped, str(arm)))
        if not path.exists():
            names = ", ".join(arms())
            raise FileNotFoundError(f"arm: {str(arm)!r} is neither a file nor an arm that ships with the package ({names})")
        try:
            text = path.read_text(encoding="utf-8-sig")
        except UnicodeDecodeError as error:
            from hydrostat._errors import ArmError

            raise ArmError(f"{path}: not UTF-8 text") from error
        return cls._of(_native.Arm(text, str(path)))

    @classmethod
    def from_toml(cls, text: str, name: str = "arm") -> Arm:
        """Make an arm from the text of an arm file."""
        return cls._of(_native.Arm(text, name))

    @classmethod
    def from_dict(cls, tables: Table) -> Arm:
        """Make an arm from the tables of an arm file: the output of `to_dict`, or a file read by ``tomllib``."""
        unknown = [key for key in tables if key not in _TABLES]
        if unknown:
            from hydrostat._errors import ArmError

            raise ArmError(f"{unknown[0]}: unknown key; expected one of {', '.join(_TABLES)}", unknown[0])
        missing = [key for key in ("arm", "material") if key not in tables]
        if missing:
            from hydrostat._errors import ArmError

            raise ArmError(f"{missing[0]}: missing; expected a table", missing[0])
        return cls(**tables)

    def to_toml(self) -> str:
        """The arm as an arm file, units resolved and defaults filled in."""
        return self._inner.to_toml()

    def to_dict(self) -> dict[str, Any]:
        """The tables of the arm file, units resolved and defaults filled in."""
        return tomllib.loads(self.to_toml())

    @property
    def name(self) -> str:
        """Its name."""
        return self._inner.name

    @property
    def length(self) -> float:
        """Undeformed length, m."""
        return self._inner.length

    @property
    def is_spatial(self) -> bool:
        """Whether it may leave the plane e1-e2: ``space = "spatial"``."""
        return self._inner.is_spatial

    @property
    def cables(self) -> tuple[str, ...]:
        """The cables' names, in the order of tensions."""
        return tuple(self._inner.cables)

    def __repr__(self) -> str:
        return f"<Arm {self.name!r}: {self.length:g} m, cables {list(self.cables)}>"

    def __eq__(self, other: object) -> bool:
        return self._inner.same(other._inner) if isinstance(other, Arm) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.to_toml())

    def __reduce__(self) -> tuple[Any, ...]:
        return _from_parts, self._inner.parts()

    def _origin(self, maker: str, arguments: tuple[Any, ...]) -> Origin:
        return Origin(maker, (self._inner.parts(), *arguments))

    def replace(
        self,
        changes: Mapping[str, object] | None = None,
        *,
        tensions: Sequence[float | str] | NDArray[Any] | None = None,
        strokes: Sequence[float | str | None] | NDArray[Any] | None = None,
        flow_speed: float | str | None = None,
        flow_direction: float | str | None = None,
    ) -> Arm:
        """Return this arm with other values.

        Parameters
        ----------
        changes : mapping, optional
            Values by the dotted keys of the arm file, such as ``{"cable[0].friction": 0.1, "model.volume": "none"}``. A table's
            other keys stay as they are: ``{"flow": {"speed": 0.1}}`` is ``{"flow.speed": 0.1}``, and so with a list of tables for all
            cables.
        tensions : sequence of float or str, or ndarray, optional
            One per cable, N, or with a unit; strokes are then no longer commanded.
        strokes : sequence of float, str or None, or ndarray, optional
            One per cable, m, or with a unit, in place of its tension; None leaves a cable as it is.
        flow_speed : float or str, optional
            m/s.
        flow_direction : float or str, optional
            Degrees from e1, or a string with a unit.

        Raises
        ------
        ArmError
            The arm file does not have that key, or the value does not make an arm.
        """
        given: dict[str, object] = {}
        for key, value in _inputs.mapping("changes", changes or {}, '{"flow.speed": 0.1}').items():
            given |= self._of_cables(value) if key == "cable" else _dotted(str(key), value)
        for name, values, key in (("tensions", tensions, "tension"), ("strokes", strokes, "stroke")):
            if values is None:
                continue
            each = _inputs.items(name, values, "numbers, one a cable")
            if len(each) != len(self.cables):
                raise ValueError(f"{name}: the arm has {len(self.cables)} cables, {len(each)} were given")
            given |= {f"cable[{i}].{key}": value for i, value in enumerate(each) if value is not None}
        if flow_speed is not None:
            given["flow.speed"] = flow_speed
        if flow_direction is not None:
            given["flow.direction"] = flow_direction
        return Arm._of(self._inner.replaced([("replace", key, _inputs.toml(key, value)) for key, value in given.items()]))

    def _of_cables(self, tables: object) -> dict[str, object]:
        """Changes of the list of cables: of each its own, or new cables, which all have an offset."""
        each = _inputs.items("changes['cable']", tables, "tables, one a cable")  # type: ignore[arg-type, var-annotated]
        if len(each) == len(self.cables):
            return {key: item for i, table in enumerate(each) for key, item in _dotted(f"cable[{i}]", table).items()}
        if all(isinstance(table, Mapping) and "offset" in table for table in each):
            return {"cable": each}
        words = 'one alone is changed by {"cable[0]": {...}}, and new cables have an `offset`'
        raise ValueError(f"changes['cable']: the arm has {len(self.cables)} cables, {len(each)} tables were given; {words}")

    def solve(
        self,
        *,
        tensions: _inputs.Numbers | None = None,
        strokes: Sequence[float | str | None] | NDArray[Any] | None = None,
        flow_speed: float | str | None = None,
        tol: float = 1e-8,
        snap_distance: float = 0.01,
        snap_angle: float | str = 2.0,
        follow_snaps: bool = False,
        after_snap: bool = False,
    ) -> Solution:
        """Solve for the static shape under the arm's loads, or under the given ones.

        Several equilibria may exist. The answer is the end of the path on which first all loads but the cables', then the tensions
        rise from zero, through small snaps, which are in `Solution.snaps`. Other threads run meanwhile.

        Parameters
        ----------
        tensions : array_like, shape (cables,), optional
            N, or strings with units, in place of the arm's.
        strokes : sequence of float, str or None, optional
            Stroke of each cable (reeled in), m, or with a unit, in place of its tension; None leaves a cable as it is.
        flow_speed : float or str, optional
            m/s, or with a unit, in place of the arm's.
        tol : float
            Tolerance on the tip position, relative to the arm's length, in [1e-12, 1e-2].
        snap_distance : float
            Largest jump of the tip at a snap, relative to the arm's length; an arm that snaps further has no answer.
        snap_angle : float or str
            Largest turn of the tip at a snap: degrees, or a string with a unit.
        follow_snaps : bool
            Whether to follow every snap along the curve of equilibria, however far.
        after_snap : bool
            Whether to follow the motion after each snap, with the arm's ``[dynamics]``, until the arm rests, and to go on from
            there; `Snap.duration` says how long that takes.

        Returns
        -------
        Solution
            Of an arm with ``space = "spatial"`` a `SpatialSolution`.

        Raises
        ------
        NoEquilibriumError
            There is no equilibrium; the exception has the fields of the verdict.
        MotionError
            With `after_snap`: the arm does not come to rest after a snap.
        ValueError
            An argument is invalid; the message names it.
        """
        pulled = None if tensions is None else _inputs.numbers("tensions", _inputs.of_cables(tensions, self), 1, key=_units.TENSION)
        speed = None if flow_speed is None else _inputs.number("flow_speed", flow_speed, negative=False, key=_units.SPEED)
        reeled = None if strokes is None else _strokes(strokes)
        within = _inputs.number("tol", tol)
        _inputs.after_snap(after_snap, snap_distance, snap_angle, follow_snaps)
        snaps = _inputs.snaps(snap_distance, snap_angle, follow_snaps)

        def origin() -> Origin:
            loads = (None if pulled is None else pulled.tolist(), reeled, speed)
            return Origin("solve", (self._inner.parts(), *loads, within, snaps, bool(after_snap)))

        return warn(solution_of(self._inner.solve(pulled, reeled, speed, within, snaps, bool(after_snap)), origin), 2)

    def path(
        self,
        parameter: str,
        start: float | str,
        stop: float | str,
        *,
        tol: float = 1e-6,
        longest: float = 0.2,
        most: int = 1000,
        branches: bool = False,
    ) -> EquilibriumPath:
        """Follow the equilibria while one number of the arm goes from `start` to `stop`, through limit points and bifurcations.

        Ctrl-C interrupts it.

        Parameters
        ----------
        parameter : str
            A key of the arm file, such as ``"arm.base.angle"``, ``"flow.speed"`` or ``"cable[0].tension"``.
        start, stop : float or str
            The range: numbers in SI units and degrees, or strings with units. The unit of the second
            string holds for both if the first has none.
        tol : float
            Tolerance on the tip position at every point, relative to the arm's length, in [1e-7, 1e-3].
        longest : float
            Largest step, in [0.001, 0.4].
        most : int
            Largest number of points.
        branches : bool
            Whether to follow the branches that cross at bifurcations, too.

        Raises
        ------
        NoEquilibriumError
            There is no equilibrium at the start.
        """
        from hydrostat.paths import EquilibriumPath

        vary = f"{parameter}={':'.join(_inputs.texts(['start', 'stop'], parameter, [start, stop]))}"
        step = _inputs.number("longest", longest)
        points = _inputs.count("most", most)
        asked = (vary, _inputs.number("tol", tol), step, points, branches)
        found = EquilibriumPath(_native.path(self._inner, *asked), self._origin("path", asked))
        warn_of_all((solution for branch in found.branches for solution in branch), 2)
        return found

    def equilibria(self, *, tol: float = 1e-8, time_limit: float | str | None = None) -> Equilibria:
        """Find all equilibria under the arm's loads, each with its stability, whether `solve` gives them or not.

        Ctrl-C interrupts it.

        Parameters
        ----------
        tol : float
            Tolerance on the tip position, relative to the arm's length, in [1e-12, 1e-3].
        time_limit : float or str, optional
            Seconds, or with a unit, after which the search stops and returns what it has found.

        Returns
        -------
        Equilibria
            A sequence of solutions in the order of the tip's angle, in space of its place; ``complete`` says whether these are
            known to be all, which they never are in space.
        """
        from hydrostat.paths import Equilibria

        within = _inputs.number("tol", tol)
        limit = None if time_limit is None else _inputs.number("time_limit", time_limit, key=_units.TIME)
        found = Equilibria(_native.equilibria(self._inner, within, limit), self._origin("equilibria", (within, None)))
        warn_of_all(found, 2)
        return found

    def reach(
        self,
        targets: AnyTargets,
        *,
        by: str = "tensions",
        max_tension: Most | None = None,
        max_stroke: Number | None = None,
        tol: float = 1e-8,
        find_all: bool = True,
    ) -> Reach:
        """Inverse kinematics: find tensions, from 0 to their largest, that bring the arm to targets.

        The arm's own tensions and strokes are ignored.

        Ctrl-C interrupts it.

        Parameters
        ----------
        targets : Target, sequence of Target, or (x, y)
            Targets for places of the arm, m and degrees, or with units; (x, y) is a target for the tip. Of an arm in space `SpatialTarget`
            and (x, y, z).
        by : str
            ``"tensions"``, or ``"strokes"``: then the strokes that belong to the tensions are commanded, and stability is that with
            cable lengths held.
        max_tension : float, str or sequence, optional
            The largest tension of every cable, N, or with a unit, or of each cable; a smaller one of the cable itself holds.
        max_stroke : float or str, optional
            The largest stroke of every taut cable, m, or with a unit: how much can be reeled in.
        tol : float
            Tolerance on the distance to a target, relative to the arm's length, in [1e-10, 1e-2].
        find_all : bool
            Whether to search from all starts; otherwise the first solution ends the search.

        Returns
        -------
        Reach
            A sequence of different solutions, least effort first. If the targets are not reached it is empty, and ``closest`` is the
            nearest shape found, with its active bounds.

        Raises
        ------
        ValueError
            An argument is invalid; the message names it.

        Examples
        --------
        >>> import hydrostat as hs
        >>> arm = hs.Arm.load("silicone")
        >>> best = arm.reach((0.182, 0.078), max_tension=0.6)[0]
        >>> tip = arm.solve(tensions=best.tensions).tip
        >>> round(tip.x, 6), round(tip.y, 6)
        (0.182, 0.078)
        """
        from hydrostat.reach import Reach, bounded, goals_of, spatial_targets_of, targets_of

        arm, most = bounded(self, max_tension, max_stroke)
        if by not in ("tensions", "strokes"):
            raise ValueError(f"by: expected tensions or strokes, found {by!r}")
        options = (most, _inputs.number("tol", tol), find_all, by == "strokes")
        if self.is_spatial:
            there = spatial_targets_of(targets)
            places = [((one.x, one.y, one.z), one.s, one.direction, one.weight) for one in there]
            found = Reach(_native.reach(arm._inner, places, *options), tuple(there), arm._origin("reach", (places, *options)))
        else:
            wanted = targets_of(cast("Targets", targets))
            asked = (goals_of(wanted), *options)
            found = Reach(_native.reach(arm._inner, *asked), tuple(wanted), arm._origin("reach", asked))
        warn_of_all((one.solution for one in found), 2)
        return found

    def reachable(self, *, max_tension: Most | None = None, spacing: float = 0.01, tol: float = 1e-7) -> Boundary:
        """Trace the boundary of the workspace: of the places that the tip reaches with tensions from 0 to their largest.

        Parameters
        ----------
        max_tension : float, str or sequence, optional
            The largest tension of every cable, N, or with a unit, or of each cable; a smaller one of the cable itself holds.
        spacing : float
            Distance between points, relative to the arm's length, in [1e-3, 0.1].
        tol : float
            Tolerance on the tips, relative to the arm's length, in [1e-9, 1e-3].

        Examples
        --------
        >>> import hydrostat as hs
        >>> boundary = hs.Arm.load("silicone").reachable(max_tension=0.2, spacing=0.05)
        >>> [piece.kind for piece in boundary]
        ['edge', 'edge', 'edge', 'edge']
        """
        from hydrostat.reach import Boundary, bounded

        arm, (most, _) = bounded(self, max_tension, None)
        asked = (most, _inputs.number("spacing", spacing), _inputs.number("tol", tol))
        return Boundary(_native.reachable(arm._inner, *asked), arm._origin("reachable", asked))

    def sensitivities(
        self,
        parameters: Sequence[str] | None = None,
        *,
        stations: ArrayLike = (),
        method: str = "best",
        tol: float = 1e-8,
    ) -> Sensitivities:
        """Return exact derivatives of the shape that `solve` gives; see `Solver.sensitivities`.

        Examples
        --------
        >>> import hydrostat as hs
        >>> arm = hs.Arm.load("silicone").replace(tensions=[0.2, 0.05], flow_speed=0.1)
        >>> found = arm.sensitivities(["cable[0].tension", "material.young"])
        >>> bool(found.tip.theta[0] > 0)  # pulling the left cable turns the tip to the left
        True
        """
        from hydrostat.solver import Solver

        return Solver(self, tol).sensitivities(parameters, stations=stations, method=method)

    def measurements_template(self) -> str:
        """Return a CSV table to fill in with measurements of this arm, for `identify`; its comments explain it."""
        from hydrostat.identification import measurements_template

        return measurements_template(self)

    def identify(
        self,
        data: Measured,
        fit: Keys,
        *,
        prior: Priors = (),
        sd: str | Sequence[str] = (),
        loss: str = "none",
        rescale: bool = False,
        cross_validate: bool = True,
        tol: float = 1e-8,
        progress: bool | None = None,
    ) -> Fit:
        """Fit parameters of this arm to measurements, with intervals and identifiability.

        Ctrl-C interrupts it.

        Parameters
        ----------
        data : path, mapping or DataFrame
            A CSV file, or its columns by their heads, such as ``{"case": ..., "s [mm]": ..., "x [mm]": ...}``; NaN and None mean not
            measured. `measurements_template` has the columns; of an arm in space there is ``z``, and a marker beside the centreline has
            ``offset_a``, ``offset_b`` and ``offset_c``.
        fit : str, sequence of str, or mapping
            Keys of the arm file, or their last parts (``"young"``), with or without a start and bounds: ``"young=80 kPa:50 kPa:200 kPa"``, or
            ``{"young": ("80 kPa", "50 kPa", "200 kPa")}``. ``"tension_factor"`` is a factor on all tensions of the data.
        prior : sequence of str, or mapping
            Prior knowledge: ``["flow.cn=2.5±0.5"]`` or ``{"flow.cn": (2.5, 0.5)}``.
        sd : str or sequence of str
            Standard deviations of quantities that have none in the data, with units: ``"0.5 mm"``.
        loss : str
            Outlier loss: ``"none"`` (squares), ``"huber"`` (linear tails) or ``"cauchy"`` (nearly ignored).
        rescale : bool
            Whether standard deviations are known up to a common factor only.
        cross_validate : bool
            Whether to fit again without each load case, of at most 200.
        tol : float
            Tolerance on the tip position in every solve, relative to the arm's length.
        progress : bool, optional
            Whether a line on standard error says how far the search is; by default on a terminal.

        Raises
        ------
        MeasurementsError
            A `ValueError` that names file, row and column.
        NoEquilibriumError
            A load case has no equilibrium at the start of the search; a note names it.
        ValueError
            An argument is invalid; the message names it.

        Examples
        --------
        >>> import hydrostat as hs
        >>> arm = hs.Arm.load("silicone")
        >>> tips = [arm.solve(tensions=[pull, 0]).tip for pull in (0.1, 0.2, 0.3)]
        >>> data = {
        ...     "case": ["a", "b", "c"],
        ...     "cable[0].tension [N]": [0.1, 0.2, 0.3],
        ...     "x [m]": [tip.x for tip in tips],
        ...     "y [m]": [tip.y for tip in tips],
        ... }
        >>> found = arm.identify(data, {"young": "80 kPa"}, sd="1 mm")
        >>> round(found.values[0])
        110000
        >>> found.verdict
        ('the data determine all parameters',)
        """
        from hydrostat.identification import identify

        return identify(self, data, fit, prior, sd, loss, rescale, cross_validate, tol, progress)


def _from_parts(text: str, path: str, settings: list[tuple[str, str, str]]) -> Arm:
    return Arm._of(_native.Arm(text, path, settings))


def arm_of(arm: Arm | str | PathLike[str]) -> Arm:
    """An arm, or what `Arm.load` makes of its name or file."""
    if isinstance(arm, Arm):
        return arm
    if isinstance(arm, (str, PathLike)):
        return Arm.load(arm)
    raise TypeError(f"arm: expected an Arm, or the name or file of one, found {arm!r}")


def _dotted(key: str, value: object) -> dict[str, object]:
    """A table's own keys, so that others stay; what is a value in itself, such as the ends of a radius, is one."""
    is_table = key in _TABLES or key == "arm.base" or (key.startswith("cable[") and key.endswith("]"))
    if not is_table or not isinstance(value, Mapping):
        return {key: value}
    out: dict[str, object] = {}
    for name, item in value.items():
        out |= _dotted(f"{key}.{name}", item)
    return out


def _strokes(strokes: Sequence[float | str | None] | NDArray[Any]) -> list[float | None]:
    each = _inputs.items("strokes", strokes, "numbers, one a cable")
    return [None if one is None else _inputs.number(f"strokes[{i}]", one, key=_units.STROKE) for i, one in enumerate(each)]
