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
        assert name == "solution" or dataset[key].attrs.get("long_name"), key
    for key in dataset.variables:
        assert key in numbers or "units" not in dataset[key].attrs, key


def test_names_and_places_of_a_sweep(silicone: hs.Arm) -> None:
    found = hs.sweep(silicone, {"flow.speed": "0:10 cm/s:2", "cable[0].tension": [0.0, 0.1, 0.2]}, shapes=3)
    assert found.tip_y.dims == ("flow_speed", "cable_0_tension") and found.flow_speed.values.tolist() == [0.0, 10.0]
    assert (found.flow_speed.attrs["long_name"], found.flow_speed.attrs["units"]) == ("flow.speed", "cm/s")
    assert found.s.dims == ("station",) and found.s.values.tolist() == [0.0, 0.1225, 0.245] and found.s.attrs["units"] == "m"
    assert all(variable.attrs["long_name"] for variable in found.data_vars.values())
    assert found.tip_y.sel(flow_speed=10, cable_0_tension=0.2).item() > 0
    drawn = hs.sweep(silicone, {"flow.speed": "0:0.1"}, sample="lhs:3", columns=["verdict"])
    assert drawn.flow_speed.dims == ("row",) and "s" not in drawn.coords and "cable" not in drawn.coords
    space = hs.sweep("silicone-spatial", {"cable[0].tension": [0.0, 0.1]}, shapes=2)
    assert space.tip_a_x.attrs["long_name"] == "director a at the tip, along e1"
    assert "e3" in space.base_moment_z.attrs["long_name"] and "e2" in space.shape_b_y.attrs["long_name"]


def test_units_of_derivatives(silicone: hs.Arm) -> None:
    by_force = hs.solve_many(silicone, tensions=[[0.1, 0.0]], gradients=True).to_xarray()
    assert by_force.d_tip_x.attrs["units"] == by_force.d_stroke.attrs["units"] == "m/N"
    assert by_force.d_tip_theta.attrs["units"] == "rad/N" and by_force.unit.values.tolist() == ["N", "N"]
    mixed = hs.solve_many(silicone, flow_speed=[0.1], gradients=["flow.speed", "flow.direction", "tip.moment"]).to_xarray()
    assert "units" not in mixed.d_tip_x.attrs and mixed.unit.values.tolist() == ["m/s", "rad", "N m"]
    assert mixed.d_tip_x.attrs["long_name"] == "derivative of the tip along e1, a unit of the parameter"
    one = hs.solve_many(silicone, flow_speed=[0.1], gradients=["flow.speed"]).to_xarray()
    assert one.d_tip_x.attrs["units"] == "m/(m/s)"
    pytest.importorskip("pint_xarray")
    assert str(one.pint.quantify().d_tip_x.pint.units) == "second"
    assert mixed.pint.quantify().tip_x.pint.units is not None


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
