"""The library's own figures: to scale, as SVG, PDF and PNG, without matplotlib."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

import numpy as np

from hydrostat import _native, _saved

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    from hydrostat.arm import Arm
    from hydrostat.paths import Equilibria, EquilibriumPath
    from hydrostat.solution import Solution


class Figure:
    """A finished drawing; a notebook shows it."""

    __slots__ = ("_inner",)

    def __init__(self, native: _native.Figure) -> None:
        self._inner = native

    def svg(self, *, text: bool = False) -> str:
        """The drawing as an SVG document.

        Parameters
        ----------
        text : bool
            Write text as text, to edit it; otherwise text is outlines, so that no font is needed.
        """
        return self._inner.svg(text)

    def pdf(self) -> bytes:
        """The drawing as a PDF file's bytes, one page of vectors."""
        return self._inner.pdf()

    def png(self) -> bytes:
        """The drawing as a PNG file's bytes."""
        return self._inner.png()

    def texts(self) -> list[str]:
        """All texts that the drawing shows."""
        return self._inner.texts()

    def save(self, path: str | PathLike[str]) -> FilePath:
        """Write the drawing to `path`, whose name ends in ``.svg``, ``.pdf`` or ``.png``.

        Raises
        ------
        ValueError
            For another ending.
        """
        target = FilePath(path)
        if target.suffix.lower() == ".svg":
            target.write_text(self.svg(), encoding="utf-8")
        elif target.suffix.lower() == ".pdf":
            target.write_bytes(self.pdf())
        elif target.suffix.lower() == ".png":
            target.write_bytes(self.png())
        else:
            raise ValueError(f"path: expected a name that ends in .svg, .pdf or .png, found {target.name!r}")
        return target

    def _repr_svg_(self) -> str:
        return self.svg()


def arm_figure(solution: Solution, note: str | None = None) -> Figure:
    """One shape to scale, with its cables, the stream and the tip; `note` is the text below."""
    return Figure(solution._inner.figure(note))


def path_figure(path: EquilibriumPath, quantity: str = "tip.y", title: str | None = None) -> Figure:
    """A quantity along a path: stable pieces solid, unstable ones dashed, events marked.

    Parameters
    ----------
    quantity : str
        ``"tip.x"``, ``"tip.y"``, ``"tip.z"`` (in space), ``"tip.theta"`` (in the plane), ``"tip.alpha"`` or ``"stroke[0]"`` and so on, or
        the same as names of Python, ``"tip_x"``, ``"stroke_0"``.
    """
    return Figure(path._inner.figure(_dotted(quantity), title or f"equilibria over {path.parameter}"))


def path_shapes_figure(path: EquilibriumPath, title: str | None = None) -> Figure:
    """Shapes along a path, to scale."""
    return Figure(path._inner.shapes_figure(title or f"equilibria over {path.parameter}"))


def equilibria_figure(equilibria: Equilibria, title: str = "all equilibria") -> Figure:
    """All equilibria of an arm, to scale."""
    return Figure(equilibria._inner.figure(title))


def over_figure(
    searches: Mapping[float, Equilibria], name: str, unit: str = "", quantity: str = "tip.y", title: str = "all equilibria"
) -> Figure:
    """A quantity of all equilibria over what varies between the searches.

    Parameters
    ----------
    searches : mapping
        The equilibria at each value.
    name, unit : str
        What varies, for the axis.
    quantity : str
        As in `path_figure`.
    """
    found = [(float(value), _saved.live(all_of._inner)) for value, all_of in searches.items()]
    return Figure(_native.over_figure(found, (name, unit, 1.0), _dotted(quantity), title))


def _dotted(quantity: str) -> str:
    """A quantity of a path as the program names it."""
    if not isinstance(quantity, str):
        raise ValueError(f"quantity: expected a name such as 'tip.x', found {quantity!r}")
    return re.sub(r"^(tip)_(\w+)$", r"\1.\2", re.sub(r"^([a-z]+)_(\d+)$", r"\1[\2]", quantity))


def map_figure(dataset: xr.Dataset, quantity: str = "tip_alpha", title: str = "a sweep") -> Figure:
    """A quantity of a sweep as colours over the two keys that varied."""
    keys, flat = _rows(dataset, 2)
    axes = (_axis(dataset, keys[0]), _axis(dataset, keys[1]))
    values = (_column(flat, _name(keys[0])), _column(flat, _name(keys[1])))
    return Figure(_native.map_figure(axes, values, *_coloured(dataset, flat, quantity), title))


def workspace_figure(dataset: xr.Dataset, quantity: str | None = None, title: str = "a sweep") -> Figure:
    """Where the tip is in the rows of a sweep, to scale, of arms in space from three sides, coloured by a quantity.

    That is by default ``tip_theta``, of arms in space ``tip_alpha``.
    """
    _, flat = _rows(dataset, None)
    x, y = _column(flat, "tip_x"), _column(flat, "tip_y")
    z = _column(flat, "tip_z") if "tip_z" in flat.variables else None
    shown = quantity or ("tip_theta" if z is None else "tip_alpha")
    return Figure(_native.workspace_figure(x, y, z, *_coloured(dataset, flat, shown), title))


def curve_figure(dataset: xr.Dataset, quantity: str = "tip_y", title: str = "a sweep") -> Figure:
    """A quantity of a sweep over the one key that varied."""
    keys, flat = _rows(dataset, 1)
    name = _full_name(dataset, quantity)
    figure = _native.curve_figure(_axis(dataset, keys[0]), _column(flat, _name(keys[0])), name, _column(flat, quantity), title)
    return Figure(figure)


def source_figures(
    arm: Arm, *, at_highest: bool = False, faster: Sequence[float] = (1.0, 2.0)
) -> tuple[dict[str, Figure], list[tuple[str, str, str]]]:
    """The source's Fig. 1a, 1b and 1c for `arm`, and the statements of its text compared with the numbers.

    Parameters
    ----------
    arm : Arm
        Its first cable is pulled, the others are slack.
    at_highest : bool
        Compare streams at the highest tension alone, not at half of it, too.
    faster : sequence of float
        The streams beside still water and 0.5 m/s, m/s, rising.

    Returns
    -------
    figures : dict
        ``"fig1a"`` and so on.
    claims : list of tuple
        Statement, finding and evidence of each.
    """
    figures, claims = _native.source_figures(arm._inner, at_highest, [float(speed) for speed in faster])
    return {name: Figure(figure) for name, figure, _ in figures}, claims


def _rows(dataset: xr.Dataset, count: int | None) -> tuple[list[str], xr.Dataset]:
    """The keys that varied, and the dataset with a row each."""
    keys = str(dataset.attrs.get("vary", "")).split()
    if count is not None and len(keys) != count:
        raise ValueError(f"dataset: expected a sweep over {count} key(s), found one over {keys}")
    names = [_name(key) for key in keys]
    dims = [dim for dim in dataset.dims if dim in names]
    flat = dataset.stack({"__row": dims}).reset_index("__row") if dims else dataset
    return keys, flat


def _column(flat: xr.Dataset, name: str) -> NDArray[np.float64]:
    if name not in flat.variables:
        raise ValueError(f"quantity: the sweep has no {name!r}")
    column = np.asarray(flat[name].values)
    if column.dtype.kind not in "iuf" or column.ndim != 1:
        raise ValueError(f"quantity: expected one number a row, which {name!r} is not")
    return np.ascontiguousarray(column, dtype=np.float64)


def _axis(dataset: xr.Dataset, key: str) -> tuple[str, str, float]:
    return key, str(dataset[_name(key)].attrs.get("units", "")), 1.0


def _name(key: str) -> str:
    from hydrostat.sweep import key_name

    return key_name(key)


def _full_name(dataset: xr.Dataset, quantity: str) -> str:
    """The name of the column in a sweep's file."""
    if quantity not in dataset.variables:
        raise ValueError(f"quantity: the sweep has no {quantity!r}")
    return str(dataset[quantity].attrs.get("column", quantity))


def _coloured(
    dataset: xr.Dataset, flat: xr.Dataset, quantity: str
) -> tuple[str, NDArray[np.float64] | list[str | None]]:
    name = _full_name(dataset, quantity)
    if flat[quantity].dtype.kind == "O":
        words: Sequence[str] = flat[quantity].values.tolist()
        return name, [word or None for word in words]
    return name, _column(flat, quantity)
