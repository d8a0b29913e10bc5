"""Units of datasets, as other packages read them."""

from __future__ import annotations

import numpy as np
import pytest

import hydrostat as hs
from hydrostat.solution import CONVENTIONS

xr = pytest.importorskip("xarray")


def datasets(silicone: hs.Arm) -> dict[str, xr.Dataset]:  # type: ignore[name-defined]
    return {
        "solution": silicone.solve(tensions=[0.2, 0.0]).to_xarray(),
        "many": hs.solve_many(silicone, tensions=[[0.2, 0.0], [1.4, 0.0]], stations=3, fold_margin=True).to_xarray("pull"),
        "sweep": hs.sweep(silicone, {"flow.speed": "0:10 cm/s:2", "flow.direction": [0.0, 90.0]}, columns=["tip", "strokes", "base", "fold"]),
    }


@pytest.mark.parametrize("name", ["solution", "many", "sweep"])
def test_every_number_has_its_unit(silicone: hs.Arm, name: str) -> None:
    dataset = datasets(silicone)[name]
    assert dataset.attrs["Conventions"] == CONVENTIONS
    numbers = [key for key, variable in dataset.variables.items() if variable.dtype.kind == "f"]
    assert len(numbers) > 8
    for key in numbers:
        assert dataset[key].attrs.get("units"), key
    for key in dataset.variables:
        assert key in numbers or "units" not in dataset[key].attrs, key


@pytest.mark.parametrize("name", ["solution", "many", "sweep"])
def test_pint_takes_them(silicone: hs.Arm, name: str) -> None:
    pytest.importorskip("pint_xarray")
    dataset = datasets(silicone)[name]
    lengths = {"solution": "x", "many": "tip_x", "sweep": "tip_x"}
    quantities = dataset.pint.quantify()
    short = quantities[[lengths[name]]].pint.to("mm").pint.dequantify()[lengths[name]]
    assert short.attrs["units"] in ("mm", "millimeter")
    assert np.allclose(short, 1e3 * dataset[lengths[name]], rtol=1e-12, equal_nan=True)
    for variable in quantities.data_vars.values():
        assert variable.pint.units is None or variable.attrs.get("units") is None
