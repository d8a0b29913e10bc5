"""Tables of pandas, and masked arrays, are taken wherever arrays are."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hydrostat as hs

pd = pytest.importorskip("pandas")

PULLS = [[0.1, 0.0], [0.2, 0.05]]


def tables() -> list[Any]:
    plain = pd.DataFrame(PULLS, columns=["a", "b"])
    mixed = plain.astype({"a": "Float64"})
    return [plain, plain.astype("Float64"), mixed, plain.astype("float32"), plain.convert_dtypes()]


@pytest.mark.parametrize("table", tables())
def test_a_table_of_tensions(silicone: hs.Arm, table: Any) -> None:
    found = hs.solve_many(silicone, tensions=table)
    assert found.tip_y == pytest.approx(hs.solve_many(silicone, tensions=PULLS).tip_y, abs=1e-8)
    speeds = hs.solve_many(silicone, flow_speed=table)
    assert speeds.tip_y == pytest.approx(hs.solve_many(silicone, flow_speed=PULLS).tip_y, abs=1e-8)
    alone = silicone.solve(tensions=table.iloc[0])
    assert alone.tip.y == pytest.approx(silicone.solve(tensions=PULLS[0]).tip.y, abs=1e-8)
    with pytest.raises(ValueError, match=r"^tensions: expected an array of 1 dimension\(s\), found shape \(2, 2\)"):
        silicone.solve(tensions=table)


def test_what_is_missing_in_a_table_is_a_row_without_an_answer(silicone: hs.Arm) -> None:
    table = pd.DataFrame({"a": pd.array([0.1, None], dtype="Float64"), "b": [0.0, 0.0]})
    assert hs.solve_many(silicone, tensions=table).verdict.tolist() == ["", "not_a_number"]
    with pytest.raises(ValueError, match="^tensions"):
        hs.solve_many(silicone, tensions=table, nan="refuse")
    with pytest.raises(ValueError, match="^tensions: expected real numbers, found an array of dtype object"):
        hs.solve_many(silicone, tensions=pd.DataFrame({"a": [0.1, None], "b": [{}, 0.0]}))


def test_columns_with_the_names_of_the_cables_are_theirs(silicone: hs.Arm) -> None:
    table = pd.DataFrame({"right": [0.0, 0.05], "left": [0.1, 0.2]})
    want = hs.solve_many(silicone, tensions=PULLS)
    assert hs.solve_many(silicone, tensions=table).tip_y.tolist() == want.tip_y.tolist()
    assert silicone.solve(tensions=table.iloc[1]) == silicone.solve(tensions=PULLS[1])


@pytest.mark.parametrize(
    "values",
    [
        np.ma.array([0.1, 0.2], mask=[False, True]),
        pd.Series([0.1, None], dtype="Float64"),
        pd.Series([0.1, None]),
    ],
)
def test_a_sweep_refuses_what_is_masked_or_missing(silicone: hs.Arm, values: Any) -> None:
    with pytest.raises(ValueError, match=r"^vary\['flow.speed'\]: .*at index \(?1,?\)?"):
        hs.sweep(silicone, {"flow.speed": values})


@pytest.mark.parametrize("values", [pd.Series([0.05, 0.1]), pd.Series([0.05, 0.1], dtype="Float64"), np.ma.array([0.05, 0.1])])
def test_a_sweep_takes_a_column(silicone: hs.Arm, values: Any) -> None:
    pytest.importorskip("xarray")
    found = hs.sweep(silicone, {"flow.speed": values})
    assert found["flow_speed"].values.tolist() == [0.05, 0.1]
    assert found.tip_y.values.tolist() == hs.sweep(silicone, {"flow.speed": [0.05, 0.1]}).tip_y.values.tolist()


def test_rows_as_a_table(silicone: hs.Arm) -> None:
    many = hs.solve_many(silicone, tensions=PULLS, flow_speed=[[0.0], [0.1]], stations=3, gradients=True)
    table = many.to_pandas()
    assert len(table) == 4 and list(table.index.names) == ["dim_0", "dim_1"]
    assert table.tip_y.tolist() == many.tip_y.ravel().tolist() and table.stroke_1[0, 1] == many.stroke[0, 1, 1]
    assert table.x_2[1, 0] == many.x[1, 0, 2] and table.d_stroke_0_1[0, 0] == many["d_stroke"][0, 0, 0, 1]
    alone = hs.solve_many(silicone, tensions=[0.1, 0.0]).to_pandas()
    assert len(alone) == 1 and alone.verdict.tolist() == [""]
    assert hs.solve_many(silicone, tensions=PULLS).to_pandas().index.tolist() == [0, 1]


def test_all_columns_are_attributes(silicone: hs.Arm) -> None:
    many = hs.solve_many(silicone, tensions=PULLS, stations=3, fold_margin=True, stability=True)
    for name in many:
        assert getattr(many, name).tolist() == many[name].tolist() or name == "load_fraction"
    bare = hs.solve_many(silicone, tensions=PULLS, warnings=False)
    for name, option in {"x": "stations", "warnings": "warnings", "stability": "stability", "fold_margin": "fold_margin"}.items():
        with pytest.raises(AttributeError, match=f"^{name}: these rows have none; .*`{option}`"):
            getattr(bare, name)


def test_dataarrays_with_other_coordinates_were_joined(silicone: hs.Arm) -> None:
    xr = pytest.importorskip("xarray")
    speed = xr.DataArray([0.0, 0.1], dims="v", coords={"v": [0, 1]})
    turn = xr.DataArray([0.0, 90.0], dims="v", coords={"v": [1, 2]})
    with pytest.raises(ValueError, match=r"^flow_speed, vary\['flow.direction'\]: expected the same coordinates"):
        hs.solve_many(silicone, flow_speed=speed, vary={"flow.direction": turn})


def test_a_column_that_is_the_index_too(silicone: hs.Arm) -> None:
    tips = [silicone.solve(tensions=[pull, 0]).tip for pull in (0.1, 0.2, 0.3)]
    columns = {"case": list("abc"), "cable[0].tension [N]": [0.1, 0.2, 0.3], "x [m]": [t.x for t in tips], "y [m]": [t.y for t in tips]}
    table = pd.DataFrame(columns)
    want = silicone.identify(table, "young", sd="1 mm", cross_validate=False)
    for drop in (False, True):
        assert silicone.identify(table.set_index("case", drop=drop), "young", sd="1 mm", cross_validate=False).values == want.values
