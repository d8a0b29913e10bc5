"""Arms: what is given."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from hydrostat import _inputs, _native
from hydrostat._saved import Origin
from hydrostat.solution import Solution, warn

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from hydrostat.identification import Fit, Keys, Measured, Priors
    from hydrostat.paths import Equilibria, EquilibriumPath
    from hydrostat.reach import Boundary, Reach, Targets
    from hydrostat.sensitivity import Sensitivities

#: A table of the arm file.
Table = Mapping[str, Any]

_TABLES = ("name", "arm", "material", "reference", "cable", "flow", "gravity", "tip", "distributed", "model")


def arms() -> dict[str, str]:
    """Names and descriptions of the arms that ship with the package."""
    return dict(_native.shipped_names())


class Arm:
    """A soft arm and everything that acts on it; it does not change.

    The keyword arguments are the tables of the arm file, with its keys. Numbers are in SI units, bare angles in degrees, and a
    string with a unit (``"8 mm"``) stands for a number anywhere.

    Parameters
    ----------
    arm : mapping
        ``length``, ``radius`` (a number, ``{"base": ..., "tip": ...}`` or points ``[[s, value], ...]``), ``inner_radius``,
        ``cavity``, ``density``, ``base``.
    material : mapping
        ``young``, ``poisson``, ``shear_factor``, or ``c1``, ``c2``, ``c3``.
    cable : sequence of mapping
        Each with ``name``, ``offset``, ``tension`` or ``stroke``, ``friction``, ``end`` and so on.
    reference, flow, gravity, tip, distributed, model : mapping
        Further tables; left out, their defaults.
    name : str
        For people.

    Raises
    ------
    ArmError
        A `ValueError` whose ``key`` says what is wrong.

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
            ``"paper"``, ``"paper-statements"``, ``"silicone"``, ``"multi-bending"``, ``"octopus"``, or a TOML file. A file
            of a shipped arm's name wins.

        Raises
        ------
        FileNotFoundError
            Neither a file nor a shipped arm.
        ArmError
            The file is no arm; the message has its line, its key, what was expected and what was found.
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

            raise ArmError(f"{path}: expected UTF-8 text, found a byte that is none") from error
        return cls._of(_native.Arm(text, str(path)))

    @classmethod
    def from_toml(cls, text: str, name: str = "arm") -> Arm:
        """The arm that the text of an arm file means."""
        return cls._of(_native.Arm(text, name))

    @classmethod
    def from_dict(cls, tables: Table) -> Arm:
        """The arm that the tables of an arm file mean: what `to_dict` gives, or a file read by ``tomllib``."""
        unknown = [key for key in tables if key not in _TABLES]
        if unknown:
            from hydrostat._errors import ArmError

            raise ArmError(f"{unknown[0]}: expected one of {', '.join(_TABLES)}, found an unknown key", unknown[0])
        missing = [key for key in ("arm", "material") if key not in tables]
        if missing:
            from hydrostat._errors import ArmError

            raise ArmError(f"{missing[0]}: expected a table, found nothing", missing[0])
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
        """This arm with other values.

        Parameters
        ----------
        changes : mapping, optional
            Values by the dotted keys of the arm file, such as ``{"cable[0].friction": 0.1, "model.volume": "none"}``. A table's
            other keys stay as they are: ``{"flow": {"speed": 0.1}}`` is ``{"flow.speed": 0.1}``.
        tensions : sequence of float or str, or ndarray, optional
            One a cable, N, or with a unit; strokes are not commanded any more.
        strokes : sequence of float, str or None, or ndarray, optional
            One a cable, m, or with a unit, in place of its tension; None leaves a cable as it is.
        flow_speed : float or str, optional
            m/s.
        flow_direction : float or str, optional
            Degrees from e1, or a string with a unit.

        Raises
        ------
        ArmError
            A key that the arm file does not have, or a value that makes no arm.
        """
        given: dict[str, object] = {}
        for key, value in _inputs.mapping("changes", changes or {}, '{"flow.speed": 0.1}').items():
            given |= _dotted(str(key), value)
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

    def solve(
        self,
        *,
        tensions: ArrayLike | None = None,
        strokes: Sequence[float | None] | NDArray[Any] | None = None,
        flow_speed: float | None = None,
        tol: float = 1e-8,
        snap_distance: float = 0.01,
        snap_angle: float | str = 2.0,
        follow_snaps: bool = False,
    ) -> Solution:
        """The static shape under the arm's loads, or under these.

        Among several equilibria it is the end of the path on which first all loads but the cables, then the tensions rise from
        zero, through small snaps, which are in `Solution.snaps`. Other threads run meanwhile.

        Parameters
        ----------
        tensions : array_like, shape (cables,), optional
            N, in place of the arm's own.
        strokes : sequence of float or None, optional
            What is reeled in of each cable, m, in place of its tension; None leaves a cable as it is.
        flow_speed : float, optional
            m/s, in place of the arm's own.
        tol : float
            Error of the tip position over the length that is asked for, in [1e-12, 1e-2].
        snap_distance : float
            How far the tip may jump at a snap on the way to the loads, over the length; an arm that snaps further has no answer.
        snap_angle : float or str
            How far it may turn there: degrees, or a string with a unit.
        follow_snaps : bool
            Whether every snap is followed, however far.

        Raises
        ------
        NoEquilibriumError
            With the verdict's fields.
        ValueError
            An argument that cannot be meant, named.
        """
        pulled = None if tensions is None else _inputs.numbers("tensions", tensions, 1)
        speed = None if flow_speed is None else _inputs.number("flow_speed", flow_speed, negative=False)
        reeled = None if strokes is None else _strokes(strokes)
        within = _inputs.number("tol", tol)
        snaps = _inputs.snaps(snap_distance, snap_angle, follow_snaps)

        def origin() -> Origin:
            return Origin("solve", (self._inner.parts(), None if pulled is None else pulled.tolist(), reeled, speed, within, snaps))

        return warn(Solution(self._inner.solve(pulled, reeled, speed, within, snaps), origin), 2)

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
        """The equilibria while one number of the arm runs from `start` towards `stop`, through limit points and bifurcations.

        Ctrl-C interrupts it.

        Parameters
        ----------
        parameter : str
            A key of the arm file, such as ``"arm.base.angle"``, ``"flow.speed"`` or ``"cable[0].tension"``.
        start, stop : float or str
            The range: numbers in SI units and degrees, or strings with units. Of two strings the second's unit holds for both
            where the first has none.
        tol : float
            Error of the tip position over the length at every point, in [1e-7, 1e-3].
        longest : float
            Longest step, in [0.001, 0.4].
        most : int
            Most points.
        branches : bool
            Whether to follow the branches that cross at bifurcations, too.

        Raises
        ------
        NoEquilibriumError
            There is none to start from.
        """
        from hydrostat.paths import EquilibriumPath

        vary = f"{parameter}={':'.join(_inputs.texts(['start', 'stop'], parameter, [start, stop]))}"
        step = _inputs.number("longest", longest)
        points = _inputs.count("most", most)
        asked = (vary, _inputs.number("tol", tol), step, points, branches)
        return EquilibriumPath(_native.path(self._inner, *asked), self._origin("path", asked))

    def equilibria(self, *, tol: float = 1e-8, time_limit: float | None = None) -> Equilibria:
        """All equilibria under the arm's loads, each with its stability, whether `solve` leads to them or not.

        Ctrl-C interrupts it.

        Parameters
        ----------
        tol : float
            Error of the tip position over the length, in [1e-12, 1e-3].
        time_limit : float, optional
            Seconds after which the search is given up, with what was found so far.

        Returns
        -------
        Equilibria
            A sequence of solutions in the order of the tip's angle; ``complete`` says whether these are all.
        """
        from hydrostat.paths import Equilibria

        within = _inputs.number("tol", tol)
        limit = None if time_limit is None else _inputs.number("time_limit", time_limit)
        return Equilibria(_native.equilibria(self._inner, within, limit), self._origin("equilibria", (within, None)))

    def reach(
        self,
        targets: Targets,
        *,
        by: str = "tensions",
        max_tension: float | None = None,
        max_stroke: float | None = None,
        tol: float = 1e-8,
        all: bool = True,
    ) -> Reach:
        """Tensions, from 0 to their largest, that bring the arm to targets; the arm's own tensions and strokes do not count.

        Ctrl-C interrupts it.

        Parameters
        ----------
        targets : Target, sequence of Target, or (x, y)
            Where places of the arm are to be, m and rad; (x, y) is for the tip.
        by : str
            ``"tensions"``, or ``"strokes"``: the lengths are then commanded that the tensions make, and stability is that with
            lengths held.
        max_tension : float, optional
            The largest tension of every cable, N; of this and the cable's own the smaller counts.
        max_stroke : float, optional
            The largest stroke of every cable that pulls, m: how far it can be wound in.
        tol : float
            Distance over the length at which a target is reached, in [1e-10, 1e-2].
        all : bool
            Whether to look from all starts; else the first that reaches the targets ends the search.

        Returns
        -------
        Reach
            A sequence of different solutions, least effort first; where nothing reaches the targets it is empty, and ``closest`` is the
            nearest that was found, with the bounds that its tensions lie on.

        Raises
        ------
        ValueError
            An argument that cannot be meant, named.

        Examples
        --------
        >>> import hydrostat as hs
        >>> arm = hs.Arm.load("silicone")
        >>> best = arm.reach((0.182, 0.078), max_tension=0.6)[0]
        >>> tip = arm.solve(tensions=best.tensions).tip
        >>> round(tip.x, 6), round(tip.y, 6)
        (0.182, 0.078)
        """
        from hydrostat.reach import Reach, most_of, targets_of

        goals = targets_of(targets)
        most = most_of(max_tension, max_stroke)
        if by not in ("tensions", "strokes"):
            raise ValueError(f"by: expected tensions or strokes, found {by!r}")
        asked = (goals, most, _inputs.number("tol", tol), all, by == "strokes")
        return Reach(_native.reach(self._inner, *asked), tuple(goals), self._origin("reach", asked))

    def reachable(self, *, max_tension: float | None = None, spacing: float = 0.01, tol: float = 1e-7) -> Boundary:
        """What bounds the places that the tip reaches with tensions from 0 to their largest.

        Parameters
        ----------
        max_tension : float, optional
            The largest tension of every cable, N; of this and the cable's own the smaller counts.
        spacing : float
            Distance of points over the length, in [1e-3, 0.1].
        tol : float
            Error of tips over the length, in [1e-9, 1e-3].

        Examples
        --------
        >>> import hydrostat as hs
        >>> boundary = hs.Arm.load("silicone").reachable(max_tension=0.2, spacing=0.05)
        >>> [piece.kind for piece in boundary]
        ['edge', 'edge', 'edge', 'edge']
        """
        from hydrostat.reach import Boundary

        most = None if max_tension is None else _inputs.number("max_tension", max_tension)
        asked = (most, _inputs.number("spacing", spacing), _inputs.number("tol", tol))
        return Boundary(_native.reachable(self._inner, *asked), self._origin("reachable", asked))

    def sensitivities(
        self,
        parameters: Sequence[str] | None = None,
        *,
        stations: ArrayLike = (),
        method: str = "best",
        tol: float = 1e-8,
    ) -> Sensitivities:
        """Exact derivatives of the shape that `solve` gives; see `Solver.sensitivities`.

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
        """A CSV table to fill in with what was measured of this arm, for `identify`; it explains itself."""
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
        """The parameters that make this arm agree best with what was measured, and how well the data know them.

        Ctrl-C interrupts it.

        Parameters
        ----------
        data : path, mapping or DataFrame
            A CSV file, or its columns by their heads, such as ``{"case": ..., "s [mm]": ..., "x [mm]": ...}``; NaN and None are not
            measured. `measurements_template` has the columns.
        fit : str, sequence of str, or mapping
            Keys of the arm file, or their last parts (``"young"``), with or without a start and bounds: ``"young=80 kPa:50 kPa:200 kPa"``, or
            ``{"young": ("80 kPa", "50 kPa", "200 kPa")}``.
        prior : sequence of str, or mapping
            What was known before: ``["flow.cn=2.5±0.5"]`` or ``{"flow.cn": (2.5, 0.5)}``.
        sd : str or sequence of str
            Standard deviations of what has none in the data, with their units: ``"0.5 mm"``.
        loss : str
            ``"none"``, ``"huber"`` or ``"cauchy"``: how far-out numbers count.
        rescale : bool
            Whether standard deviations are known up to a common factor only.
        cross_validate : bool
            Whether to fit again without each load case, of at most 200.
        tol : float
            Error of the tip position over the length that every solve is asked for.
        progress : bool, optional
            Whether a line on standard error says how far the search is; by default on a terminal.

        Raises
        ------
        MeasurementsError
            A `ValueError` that names file, row and column.
        NoEquilibriumError
            A load case has none where the search starts; a note names it.
        ValueError
            An argument that cannot be meant, named.

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
        ('the data tell all parameters apart',)
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


def _strokes(strokes: Sequence[float | None] | NDArray[Any]) -> list[float | None]:
    each = _inputs.items("strokes", strokes, "numbers, one a cable")
    return [None if stroke is None else _inputs.number(f"strokes[{i}]", stroke) for i, stroke in enumerate(each)]
