"""Solutions in netCDF files."""

from __future__ import annotations

import json
import os
import tempfile
from os import PathLike
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from hydrostat import _native, _saved
from hydrostat.solution import _restored

if TYPE_CHECKING:
    from hydrostat.solution import Solution

#: The attribute with all that is no variable.
_ATTRIBUTE = "hydrostat_saved"


def write(solution: Solution, path: FilePath) -> FilePath:
    """See `Solution.save`."""
    if path.suffix != ".nc":
        raise ValueError(f"path: expected a name that ends in .nc, found {path.name!r}")
    state = solution._state()
    del state["fields"]
    dataset = solution.to_xarray()
    about = {"kind": "Solution", "format": _saved.FORMAT, "hydrostat": _native.__version__, "state": state}
    dataset.attrs[_ATTRIBUTE] = json.dumps(about)
    # Whole, or not at all.
    handle, name = tempfile.mkstemp(suffix=".nc", prefix=".", dir=path.parent)
    os.close(handle)
    try:
        dataset.to_netcdf(name)
        os.replace(name, path)
    except BaseException:
        FilePath(name).unlink(missing_ok=True)
        raise
    return path


def load(path: str | PathLike[str]) -> Solution:
    """The solution that `Solution.save` wrote, bit by bit. Needs xarray and one of h5netcdf, netCDF4 and SciPy.

    Raises
    ------
    ValueError
        The file is none of these, or of another version of the format.
    """
    import xarray as xr

    with xr.open_dataset(path) as dataset:
        about: dict[str, Any] = json.loads(dataset.attrs.get(_ATTRIBUTE, "{}"))
        if about.get("kind") != "Solution":
            raise ValueError(f"{path}: expected a file that `Solution.save` wrote, found another")
        _saved.check(f"{path}", about["format"], about["hydrostat"])
        names = (*_saved.NUMBERS_IN_SPACE, *_saved.DIRECTORS) if about["state"].get("space") else _saved.FIELDS
        fields = {name: np.array(dataset[name].values, dtype=np.float64) for name in names}
    return _restored(about["format"], about["hydrostat"], {**about["state"], "fields": fields})
