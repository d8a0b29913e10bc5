"""Parameters of an arm from measured shapes: estimates, intervals, and identifiability."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from os import PathLike, fspath
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, NamedTuple, Union, cast

import numpy as np

from hydrostat import _inputs, _native, _saved
from hydrostat._progress import Line
from hydrostat._saved import Origin
from hydrostat.arm import Arm
from hydrostat.figures import Figure
from hydrostat.solution import Result, Solution, solution_of

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

#: A CSV file; or columns by their heads, as a mapping of sequences or a pandas DataFrame.
Measured = Union[str, PathLike[str], Mapping[str, object], "pd.DataFrame"]
#: A number as the arm file reads it.
Number = Union[float, str]
#: Start, or start, lower and upper bound, None for what is left to the program.
Start = Union[Number, None, tuple[Union[Number, None], Number, Number]]
#: Keys as ``hydrostat identify --fit`` takes them, or keys with their starts.
Keys = Union[str, Sequence[str], Mapping[str, Start]]
#: As ``--prior`` takes them, or keys with mean and standard deviation.
Priors = Union[Sequence[str], Mapping[str, tuple[float, float]]]


class Estimate(NamedTuple):
    """A parameter that was fitted, in SI units and radians.

    Attributes
    ----------
    key, unit : str
        Its key of the arm file; the unit is empty for plain numbers.
    value : float
        The estimate.
    sd : float or None
        Standard deviation; None if the parameter is at a bound or the data do not determine it.
    interval : tuple of float, or None
        95 %, cut off at the bounds; infinite if the data do not determine it, None if it is at a bound.
    start : float
        Where the search began.
    bounds : tuple of float
        Lower and upper.
    held_by : str or None
        ``"lower"`` or ``"upper"`` if the estimate is at that bound.
    prior : tuple of float, or None
        Mean and standard deviation of the prior.
    """

    key: str
    unit: str
    value: float
    sd: float | None
    interval: tuple[float, float] | None
    start: float
    bounds: tuple[float, float]
    held_by: str | None
    prior: tuple[float, float] | None


class LeftOut(NamedTuple):
    """Cross-validation of one load case: how well the others predict it.

    Attributes
    ----------
    case : str
        Its name.
    within : float
        Root of the mean square of its residuals in the fit of all cases, in standard deviations.
    predicted : float or None
        The same in a fit without this case; None if there is no answer, and `message` says why.
    shifts : ndarray, shape (p,)
        Change of each parameter without this case, in its standard deviations.
    message : str or None
        Why there is no prediction.
    """

    case: str
    within: float
    predicted: float | None
    shifts: NDArray[np.float64]
    message: str | None


class Miss(NamedTuple):
    """How far the fitted places of a marker are from the measured ones.

    Attributes
    ----------
    s : float
        Where along the arm it is, m.
    offset : tuple of float
        From the centreline there along a, b and c of the section, m.
    cases : int
        Load cases in which it was measured.
    rms : float
        Root of the mean square of its distances, m.
    largest : float
        The largest of them, m.
    """

    s: float
    offset: tuple[float, ...]
    cases: int
    rms: float
    largest: float


class Fit(Result):
    """The result of a fit of p parameters; see `Arm.identify`.

    Attributes
    ----------
    estimates : tuple of Estimate
        The parameters, in the order asked for.
    values : ndarray, shape (p,)
        Their estimates.
    covariance, correlation : ndarray, shape (p, p)
        Of the estimates; NaN where the data do not determine them.
    singular_values : ndarray, shape (p,)
        By how many standard deviations the measured numbers move per unit of each of the `directions`, the least determined first.
    directions : ndarray, shape (p, p)
        Combinations of the parameters relative to their sizes, one per row.
    verdict : tuple of str
        Which parameters the data do not determine, in sentences.
    misfit : str or None
        Whether residuals agree with the standard deviations.
    chi_square : float
        Sum of the squares of all residuals.
    dof : int
        Degrees of freedom.
    scale : float
        The factor on standard deviations; 1 unless `rescale` was asked for.
    cross_validation : tuple of LeftOut
        Cross-validation of every load case; empty for one case, or if not requested.
    converged : bool
        Whether the search converged, in `rounds` steps and `evaluations` solves of all load cases.
    """

    def __init__(self, native: _native.Fit, origin: Origin) -> None:
        self._inner = native
        self._origin = origin
        found = self._found = json.loads(native.to_json())
        self.estimates = tuple(_estimate(one) for one in found["parameters"])
        self.values = _array([one.value for one in self.estimates])
        self.covariance = _array(found["covariance"])
        self.correlation = _array(found["correlation"])
        self.singular_values = _array([one["singular_value"] for one in found["directions"]])
        self.directions = _array([one["weights"] for one in found["directions"]])
        self.verdict: tuple[str, ...] = tuple(found["verdict"])
        self.misfit: str | None = found["misfit"]
        self.chi_square: float = found["chi_square"]
        self.dof: int = found["freedom"]
        self.scale: float = found["spread"]
        self.cross_validation = tuple(
            LeftOut(one["case"], one["within"], one["predicted"], _array(one["shifts"]), one["message"])
            for one in found["cross_validation"]
        )
        self.converged: bool = found["converged"]
        self.rounds: int = found["rounds"]
        self.evaluations: int = found["evaluations"]

    @property
    def freedom(self) -> int:
        """`dof`, under the name of version 0.1, kept for a version."""
        return self.dof

    @property
    def spread(self) -> float:
        """`scale`, under the name of version 0.1, kept for a version."""
        return self.scale

    @cached_property
    def arm(self) -> Arm:
        """The fitted arm, with the loads that it had before."""
        return Arm.from_toml(self._inner.to_toml())

    @cached_property
    def solutions(self) -> dict[str, Solution]:
        """The fitted arm in the load cases, by the names of these; of many cases in the first 200. Of an arm in space `SpatialSolution`."""
        shapes = enumerate(self._inner.shapes())
        return {name: solution_of(shape, Origin("fitted", (self._origin, k))) for k, (name, shape) in shapes}

    @property
    def misses(self) -> tuple[Miss, ...]:
        """How far the fitted places of the markers are from the measured ones."""
        return tuple(Miss(one["s"], tuple(one["offset"]), one["cases"], one["rms"], one["largest"]) for one in self._found["misses"])

    def __eq__(self, other: object) -> bool:
        return self.to_json() == other.to_json() if isinstance(other, Fit) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.to_json())

    def __reduce__(self) -> tuple[Any, ...]:
        return _fit, (_saved.FORMAT, _native.__version__, _saved.fit_state(self._inner, self._origin))

    @cached_property
    def residuals(self) -> dict[str, NDArray[Any]]:
        """Every measured value beside the fit, columns by name: ``case``, ``quantity``, ``s`` (m, NaN for what has no place), ``offset_a``,
        ``offset_b``, ``offset_c`` (m, of a marker beside the centreline), ``unit``,
        ``measured``, ``sd``, ``fitted``, ``residual`` (fitted minus measured, over sd), ``weight`` (its weight under the loss) and
        ``row`` (of the file)."""
        types: dict[str, Any] = {"case": object, "quantity": object, "unit": object, "row": np.int64}
        rows = self._found["residuals"]
        names = ("case", "quantity", "s", "unit", "measured", "sd", "fitted", "residual", "weight", "row")
        out = {name: np.array([row[name] for row in rows], dtype=types.get(name, np.float64)) for name in names}
        offsets = np.array([row["offset"] or (math.nan,) * 3 for row in rows], dtype=np.float64).reshape(-1, 3)
        return out | {f"offset_{director}": offsets[:, k] for k, director in enumerate("abc")}

    def to_pandas(self) -> pd.DataFrame:
        """`residuals` as a table. Needs pandas."""
        import pandas as pd

        return pd.DataFrame(self.residuals)

    def to_json(self) -> str:
        """The document of ``hydrostat identify --json``."""
        return self._inner.to_json()

    def to_csv(self) -> str:
        """One row per measured value, as ``hydrostat identify --format csv`` prints them."""
        return self._inner.to_csv()

    def figure(self) -> Figure:
        """Fitted shapes with the measured places, residuals and correlations, as ``hydrostat identify --plot`` draws them."""
        return Figure(self._inner.figure())

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the fitted shapes with the measured places on one axis, of an arm in space on one in three dimensions. Needs matplotlib."""
        from hydrostat.plotting import plot_fit

        return plot_fit(self, ax)

    def __repr__(self) -> str:
        shown = ", ".join(
            f"{one.key} = {one.value:.6g}{'' if one.sd is None else f' ± {one.sd:.2g}'}" for one in self.estimates
        )
        return f"<Fit: {shown}{'' if self.converged else '; the search did not come to its end'}>"


def measurements_template(arm: Arm) -> str:
    """A CSV table to fill in; see `Arm.measurements_template`."""
    return _native.measurements_template(arm._inner)


def identify(
    arm: Arm,
    data: Measured,
    fit: Keys,
    prior: Priors,
    sd: str | Sequence[str],
    loss: str,
    rescale: bool,
    cross_validate: bool,
    tol: float,
    progress: bool | None,
) -> Fit:
    """See `Arm.identify`."""
    path, text = _table(data)
    deviations = [sd] if isinstance(sd, str) else [_inputs.text("sd", one, "0.5 mm") for one in _inputs.items("sd", sd, "texts")]
    asked = (_keys(fit), _priors(prior), deviations, loss, rescale, cross_validate, _inputs.number("tol", tol))
    with Line(progress) as line:
        native = _native.identify(arm._inner, path, text, *asked, line if line.shown else None)
    if path is not None:
        # The file may go.
        text = FilePath(path).read_text(encoding="utf-8-sig", errors="replace")
    return Fit(native, Origin("identify", (arm._inner.parts(), None, text, *asked, None)))


def _fit(version: int, writer: str, state: dict[str, Any]) -> Fit:
    _saved.check("Fit", version, writer)
    origin = Origin(*state["origin"])
    return Fit(cast("_native.Fit", _saved.SavedFit(state, origin)), origin)


def _array(values: object) -> NDArray[np.float64]:
    """Numbers that do not change; what is not known is NaN."""
    array = np.array(values, dtype=np.float64)
    array.flags.writeable = False
    return array


def _estimate(one: dict[str, Any]) -> Estimate:
    def ends(pair: Sequence[float | None]) -> tuple[float, float]:
        lower, upper = pair
        return (-math.inf if lower is None else lower, math.inf if upper is None else upper)

    interval = None if one["interval"] is None else ends(one["interval"])
    prior = None if one["prior"] is None else (one["prior"]["mean"], one["prior"]["sd"])
    bounds = ends(one["bounds"])
    return Estimate(
        one["key"], one["unit"], one["estimate"], one["sd"], interval, one["start"], bounds, one["held_by"], prior
    )


def _table(data: Measured) -> tuple[str | None, str]:
    """The path of a table, or its text."""
    if isinstance(data, (str, PathLike)):
        path = FilePath(fspath(data))
        if not path.exists():
            raise FileNotFoundError(f"data: there is no file {str(path)!r}")
        return str(path), ""
    columns: dict[str, list[object]] = {}
    frame: Any = data
    named = [name for name in getattr(getattr(data, "index", None), "names", ()) if name is not None and name not in frame]
    if named and hasattr(data, "reset_index"):
        # An index with a name is a column like the others.
        frame = frame.reset_index(level=named)
    for head, column in frame.items():
        if isinstance(column, str) or not isinstance(column, Iterable):
            raise ValueError(f"data[{head!r}]: expected a column of values, found {column!r}")
        columns[str(head)] = list(column)
    if not columns:
        raise ValueError("data: expected columns, found none")
    lengths = {head: len(column) for head, column in columns.items()}
    if len(set(lengths.values())) > 1:
        raise ValueError(f"data: expected columns of one length, found {lengths}")
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(columns)
    for row in zip(*columns.values(), strict=True):
        writer.writerow([_cell(value) for value in row])
    return None, out.getvalue()


def _cell(value: object) -> str:
    """As it stands in a table; nothing for what was not measured."""
    if value is None or value is np.ma.masked or type(value).__name__ == "NAType" or value != value:
        return ""
    return repr(float(value)) if isinstance(value, (int, float, np.integer, np.floating)) else str(value)


def _text(name: str, value: Number) -> str:
    return value if isinstance(value, str) else repr(_inputs.number(name, value))


def _keys(fit: Keys) -> list[str]:
    if isinstance(fit, str):
        return [key.strip() for key in fit.split(",")]
    if not isinstance(fit, Mapping):
        return [str(key) for key in _inputs.items("fit", fit, "keys")]
    out = []
    for key, start in fit.items():
        if start is None:
            out.append(key)
        elif isinstance(start, tuple):
            if len(start) != 3:
                raise ValueError(f"fit[{key!r}]: expected a start, or (start, lower, upper), found {start!r}")
            given = _inputs.texts(f"fit[{key!r}]", key, [value for value in start if value is not None])
            out.append(key + ("=" if start[0] is not None else ":") + ":".join(given))
        else:
            out.append(f"{key}={_text(f'fit[{key!r}]', start)}")
    return out


def _priors(prior: Priors) -> list[str]:
    if not isinstance(prior, Mapping):
        return [prior] if isinstance(prior, str) else list(prior)
    out = []
    for key, pair in prior.items():
        if not isinstance(pair, tuple) or len(pair) != 2:
            raise ValueError(f"prior[{key!r}]: expected (mean, standard deviation), found {pair!r}")
        mean, sd = _inputs.texts(f"prior[{key!r}]", key, pair)
        out.append(f"{key}={mean}±{sd}")
    return out
