"""Many arms that differ in a few numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from hydrostat import _inputs, _native

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike, NDArray

    from hydrostat.arm import Arm

_UNITS = {
    "tip_x": "m",
    "tip_y": "m",
    "tip_theta": "rad",
    "tip_alpha": "rad",
    "base_force_x": "N",
    "base_force_y": "N",
    "base_moment": "N m",
    "error_estimate": "m",
    "tension": "N",
    "stroke": "m",
    "x": "m",
    "y": "m",
    "theta": "rad",
}
_OF_CABLES = ("tension", "stroke")
_OF_STATIONS = ("x", "y", "theta")


class Many(Mapping[str, "NDArray[np.generic]"]):
    """The answers of `solve_many`, as arrays by name; `shape` is that of the inputs broadcast together.

    ``tip_x``, ``tip_y`` (m), ``tip_theta``, ``tip_alpha`` (rad), ``base_force_x``, ``base_force_y`` (N), ``base_moment`` (N m),
    ``error_estimate`` (m) and ``load_fraction`` have this shape; ``tension`` (N) and ``stroke`` (m) one more dimension, a cable each;
    ``x``, ``y``, ``theta`` one more, a station each. Rows without an equilibrium have NaN, and the verdict's kind in ``verdict``, which is
    the empty string elsewhere.
    """

    def __init__(self, shape: tuple[int, ...], cables: tuple[str, ...], columns: dict[str, NDArray[np.generic]]) -> None:
        self.shape = shape
        self.cables = cables
        self._columns = columns

    def __getitem__(self, name: str) -> NDArray[np.generic]:
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

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
    def tip_theta(self) -> NDArray[np.float64]:
        """rad, of `shape`."""
        return self._number("tip_theta")

    @property
    def tip_alpha(self) -> NDArray[np.float64]:
        """rad, of `shape`."""
        return self._number("tip_alpha")

    @property
    def stroke(self) -> NDArray[np.float64]:
        """How far each cable is reeled in, m, of `shape` and (cables,)."""
        return self._number("stroke")

    @property
    def verdict(self) -> NDArray[np.str_]:
        """Why there is no equilibrium; empty where there is one; of `shape`."""
        return self._columns["verdict"].astype(np.str_)

    def _number(self, name: str) -> NDArray[np.float64]:
        return self._columns[name].astype(np.float64, copy=False)

    def to_xarray(self, *dims: str) -> xr.Dataset:
        """The answers as a dataset over `dims` (``dim_0`` and so on without them), ``cable`` and ``station``. Needs xarray."""
        import xarray as xr

        own = dims or tuple(f"dim_{k}" for k in range(len(self.shape)))
        if len(own) != len(self.shape):
            raise ValueError(f"dims: expected {len(self.shape)} names, found {len(own)}")
        variables = {}
        for name, column in self._columns.items():
            last = ("cable",) if name in _OF_CABLES else ("station",) if name in _OF_STATIONS else ()
            attributes = {"units": _UNITS[name]} if name in _UNITS else {}
            variables[name] = ((*own, *last), column, attributes)
        return xr.Dataset(variables, coords={"cable": ("cable", list(self.cables))})


def solve_many(
    arm: Arm,
    *,
    tensions: ArrayLike | None = None,
    flow_speed: ArrayLike | None = None,
    vary: Mapping[str, ArrayLike] | None = None,
    tol: float = 1e-6,
    tile: int = 256,
    fold_margin: bool = False,
    stability: bool = False,
    stations: int = 0,
) -> Many:
    """Solve an arm at many values at once, on all processors.

    Inputs broadcast together as NumPy's do. Ctrl-C interrupts it.

    Parameters
    ----------
    arm : Arm
        The arm.
    tensions : array_like, shape (..., cables), optional
        N; the last dimension is the cables'.
    flow_speed : array_like, optional
        m/s.
    vary : mapping of str to array_like, optional
        Other numbers, by the keys that a path can vary: ``"flow.direction"`` (degrees), ``"cable[0].stroke"`` (m),
        ``"tip.force[1]"`` (N), ``"material.young"`` (Pa) and so on.
    tol : float
        Error of the tip position over the length, in [1e-12, 1e-2].
    tile : int
        Rows that follow from one another; a row starts from the one before where only loads differ, and where that cannot lead to
        another branch. The rows do not depend on the number of processors.
    fold_margin, stability : bool
        Whether these are answered, too.
    stations : int
        So many equally spaced stations of each row, none below 2.

    Returns
    -------
    Many
        Arrays by name.

    Raises
    ------
    ValueError
        Shapes that do not broadcast, dtypes that are no numbers, NaN, negative tensions or speeds; the argument is named.

    Examples
    --------
    >>> import numpy as np, hydrostat as hs
    >>> arm = hs.Arm.load("silicone")
    >>> many = hs.solve_many(arm, tensions=[[0.1, 0.0], [0.2, 0.0], [1.4, 0.0]], flow_speed=np.array([[0.0], [0.1]]))
    >>> many.shape, many.stroke.shape
    ((2, 3), (2, 3, 2))
    >>> many.verdict[0].tolist()
    ['', '', 'cable_fold']
    """
    cables = arm.cables
    given: dict[str, NDArray[np.float64]] = {}
    names: dict[str, str] = {}
    if tensions is not None:
        pulled = _inputs.finite("tensions", tensions, negative=False)
        if pulled.ndim == 0 or pulled.shape[-1] != len(cables):
            raise ValueError(f"tensions: expected the shape (..., {len(cables)}), one a cable, found {pulled.shape}")
        for index in range(len(cables)):
            given[f"cable[{index}].tension"] = pulled[..., index]
            names[f"cable[{index}].tension"] = "tensions"
    if flow_speed is not None:
        given["flow.speed"] = _inputs.finite("flow_speed", flow_speed, negative=False)
        names["flow.speed"] = "flow_speed"
    for key, values in (vary or {}).items():
        name = f"vary[{key!r}]"
        if key in given:
            raise ValueError(f"{name}: is given a second time, by {names[key]}")
        given[key] = _inputs.finite(name, values, negative=not key.endswith(("tension", ".speed", ".density")))
        names[key] = name
    try:
        shape = np.broadcast_shapes(*(values.shape for values in given.values()))
    except ValueError as error:
        shapes = ", ".join(f"{name} {given[key].shape}" for key, name in names.items())
        raise ValueError(f"shapes do not broadcast: {shapes} (tensions without their last dimension)") from error
    columns = [np.ascontiguousarray(np.broadcast_to(values, shape)).ravel() for values in given.values()]
    rows = int(np.prod(shape, dtype=np.int64))
    found = _native.solve_many(
        arm._inner,
        list(given),
        columns,
        rows,
        _inputs.number("tol", tol),
        _inputs.count("tile", tile),
        True,
        fold_margin,
        stability,
        _inputs.count("stations", stations),
    )
    out: dict[str, NDArray[np.generic]] = {}
    for name, column in found.items():
        if isinstance(column, list):
            out[name] = np.array(column, dtype=np.str_).reshape(shape)
        else:
            last = (len(cables),) if name in _OF_CABLES else (stations,) if name in _OF_STATIONS else ()
            out[name] = column.reshape(shape + last)
    return Many(shape, cables, out)
