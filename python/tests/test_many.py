"""Many rows at once: their order, what is no number, threads, derivatives."""

from __future__ import annotations

import time
import warnings
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import hydrostat as hs

TIGHT = 1e-10


@pytest.fixture(scope="module")
def loads() -> tuple[Any, Any]:
    random = np.random.default_rng(5)
    return random.uniform(0.0, 0.4, (60, 2)), random.uniform(0.0, 0.1, 60)


def test_rows_come_in_the_order_asked_for(silicone: hs.Arm, loads: tuple[Any, Any]) -> None:
    tensions, speed = loads
    many = hs.solve_many(silicone, tensions=tensions, flow_speed=speed, tol=TIGHT)
    for k in range(0, 60, 7):
        alone = silicone.solve(tensions=tensions[k], flow_speed=speed[k], tol=TIGHT)
        assert (many.tip_x[k], many.tip_y[k]) == pytest.approx((alone.tip.x, alone.tip.y), abs=1e-9 * silicone.length)
        assert many.stroke[k] == pytest.approx([cable.stroke for cable in alone.cables], abs=1e-8)
    # Material starts a row anew; it comes out in its place all the same.
    stiff = hs.solve_many(silicone, vary={"material.young": [2e5, 1e5, 2e5, 1e5]}, tensions=[0.1, 0.0])
    assert stiff.tip_y[0] == stiff.tip_y[2] < stiff.tip_y[1] == stiff.tip_y[3]


def test_rows_do_not_depend_on_the_number_of_threads(silicone: hs.Arm, loads: tuple[Any, Any]) -> None:
    tensions, speed = loads
    one, two = (
        hs.solve_many(silicone, tensions=tensions, flow_speed=speed, threads=threads, tile=16) for threads in (1, 2)
    )
    assert all(one[name].tobytes() == two[name].tobytes() for name in one)


def test_rows_with_nan_are_rows_without_an_answer(silicone: hs.Arm) -> None:
    nan = np.nan
    many = hs.solve_many(silicone, tensions=[[0.1, 0.0], [nan, 0.0], [0.2, 0.0]], flow_speed=[[0.0], [nan]])
    assert many.verdict.tolist() == [["", "not_a_number", ""], ["not_a_number"] * 3]
    assert many.reason[0, 1] == "`cable[0].tension` is not a number"
    assert many.reason[1, 0] == "`flow.speed` is not a number"
    assert np.isnan(many.tip_x[1]).all() and np.isnan(many.stroke[0, 1]).all() and not np.isnan(many.tip_x[0, [0, 2]]).any()
    masked = np.ma.masked_invalid([0.0, nan])
    nullable = pd.Series([0.0, None], dtype="Float64")
    missing: list[Any] = [masked, nullable, nullable.array]
    for speed in missing:
        assert hs.solve_many(silicone, flow_speed=speed).verdict.tolist() == ["", "not_a_number"]
        with pytest.raises(ValueError, match=r"^flow_speed: expected .*(1,)"):
            hs.solve_many(silicone, flow_speed=speed, nan="refuse")
    with pytest.raises(ValueError, match="^nan: expected row or refuse"):
        hs.solve_many(silicone, nan="drop")
    with pytest.raises(ValueError, match=r"^tensions: .*masked one at index \(1,\)"):
        silicone.solve(tensions=np.ma.masked_invalid([0.0, nan]))


def test_failing_rows_that_are_alike_are_solved_once(silicone: hs.Arm) -> None:
    pulls = np.zeros((2000, 2))
    pulls[:, 0] = 1.4
    start = time.perf_counter()
    one = hs.solve_many(silicone, tensions=pulls[:1])
    alone = time.perf_counter() - start
    start = time.perf_counter()
    many = hs.solve_many(silicone, tensions=pulls)
    assert time.perf_counter() - start < 20.0 * alone + 1.0
    assert set(many.reason.tolist()) == set(one.reason.tolist()) and "to zero length" in one.reason[0]
    assert (many["load_fraction"] == one["load_fraction"][0]).all()


def test_one_mistake_has_its_reason_in_a_row(silicone: hs.Arm) -> None:
    weak = silicone.replace({"cable[0].max_tension": 0.3})
    with pytest.raises(ValueError, match="above its max_tension of 0.3 N"):
        weak.solve(tensions=[0.5, 0.0])
    many = hs.solve_many(weak, tensions=[[0.2, 0.0], [0.5, 0.0]])
    assert many.verdict.tolist() == ["", "no_arm"]
    assert "`cable[0].tension` is 0.5 N, above its max_tension of 0.3 N" in many.reason[1]
    vary = {"cable[0].max_tension": [0.1, 0.3], "cable[0].tension": [0.0, 0.2], "flow.direction": [0.0, 90.0]}
    swept = hs.sweep(silicone, vary)
    assert swept.verdict.values.tolist() == [[["", ""], ["no_arm", "no_arm"]], [["", ""], ["", ""]]]
    words = "`cable[0].tension` is 0.2 N, above its max_tension of 0.1 N"
    assert swept.reason.values[0, 1].tolist() == [words, words] and not swept.reason.values[1].any()
    alone = hs.sweep(weak, {"cable[0].tension": [0.2, 0.5]})
    assert alone.verdict.values.tolist() == many.verdict.tolist() and alone.reason.values.tolist() == many.reason.tolist()


def test_warnings_are_those_of_the_rows(silicone: hs.Arm) -> None:
    speed = np.array([0.0, 0.05, 0.1, 0.2])
    many = hs.solve_many(silicone, tensions=[0.2, 0.0], flow_speed=speed, tol=TIGHT)
    for k, own in enumerate(speed):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", hs.ModelWarning)
            alone = silicone.solve(tensions=[0.2, 0.0], flow_speed=own, tol=TIGHT)
        assert many["warnings"][k].split() == [note.kind for note in alone.warnings]
    assert "tangential_load" in many["warnings"]
    swept = hs.sweep(silicone, {"cable[0].tension": [0.2, 1.4], "flow.speed": speed})
    both = hs.solve_many(silicone, tensions=[[[0.2, 0.0]], [[1.4, 0.0]]], flow_speed=speed).to_xarray("pull", "speed")
    assert both.warnings.values.tolist() == swept.warnings.values.tolist()
    plain = hs.solve_many(silicone, tensions=[0.2, 0.0], flow_speed=speed, tol=TIGHT, warnings=False)
    assert "warnings" not in plain and plain.tip_x == pytest.approx(many.tip_x, abs=1e-12)


def test_gradients_are_those_of_the_solver(silicone: hs.Arm) -> None:
    names = ["cable[0].tension", "cable[1].tension", "material.young", "flow.direction"]
    tensions = np.array([[0.1, 0.02], [0.3, 0.0], [1.4, 0.0], [0.2, 0.1]])
    arm = silicone.replace(flow_speed=0.05)
    many = hs.solve_many(arm, tensions=tensions, gradients=names, tol=TIGHT)
    assert many.parameters == tuple(names)
    assert many["d_stroke"].shape == (4, 2, 4)
    for k in (0, 1, 3):
        found = arm.replace(tensions=tensions[k]).sensitivities(names, tol=TIGHT)
        size = np.abs(found.jacobian()).max(axis=0)
        for name in ("x", "y", "theta", "alpha"):
            assert (np.abs(many[f"d_tip_{name}"][k] - getattr(found.tip, name)) <= 1e-6 * size).all(), name
        assert (np.abs(many["d_stroke"][k] - found.strokes) <= 1e-6 * size).all()
    assert np.isnan(many["d_tip_x"][2]).all()
    own = hs.solve_many(arm, vary={"tip.moment": [0.0, 1e-4]}, gradients=True)
    assert own.parameters == ("cable[0].tension", "cable[1].tension", "tip.moment")
    dataset = own.to_xarray("moment")
    assert dataset.d_stroke.dims == ("moment", "cable", "parameter")
    assert hs.solve_many(arm, vary={"cable[0].stroke": [0.01]}, gradients=True).parameters[0] == "cable[0].stroke"
    with pytest.raises(ValueError, match="^gradients: .*flow.sped"):
        hs.solve_many(arm, gradients=["flow.sped"])
    with pytest.raises(TypeError, match="^gradients: expected true, false or a list"):
        hs.solve_many(arm, gradients="flow.speed")


def test_stations_have_their_places(silicone: hs.Arm) -> None:
    dataset = hs.solve_many(silicone, tensions=[[0.1, 0.0], [0.2, 0.0]], stations=6).to_xarray("pull")
    assert dataset.x.dims == ("pull", "station") and dataset.s.dims == ("station",)
    shape = silicone.solve(tensions=[0.2, 0.0]).resampled(6)
    assert np.allclose(dataset.s, shape.s) and np.allclose(dataset.y[1], shape.y, rtol=0, atol=1e-6)
    assert dataset.s.attrs["units"] == dataset.x.attrs["units"] == "m"


def test_a_bar_is_drawn_where_it_is_asked_for(silicone: hs.Arm, capsys: pytest.CaptureFixture[str]) -> None:
    hs.solve_many(silicone, flow_speed=np.linspace(0.0, 0.1, 30), progress=True)
    assert "30 of 30 rows" in capsys.readouterr().err
    hs.solve_many(silicone, flow_speed=[0.1])
    assert not capsys.readouterr().err


def test_what_does_not_fit_in_memory_is_refused_first(silicone: hs.Arm) -> None:
    one = np.linspace(0.0, 0.1, 1_000_000)
    with pytest.raises(MemoryError, match=r"^1000000000000 rows take about .* TB, .*output="):
        hs.solve_many(silicone, flow_speed=one[:, None], vary={"tip.moment": one})
    with pytest.raises(MemoryError, match=r"^1000000000000 rows take about .* TB, .*output="):
        hs.sweep(silicone, {"flow.speed": "0:0.1:1000000", "cable[0].tension": "0:0.1:1000000"})
    with pytest.raises(MemoryError, match="^1000000000000 stations"):
        silicone.solve().resampled(10**12)
    with pytest.raises(ValueError, match="^stations: expected at most 10000"):
        hs.solve_many(silicone, stations=10**7)
    with pytest.raises(ValueError, match="^shapes: expected at most 10000"):
        hs.sweep(silicone, {"flow.speed": [0.1]}, shapes=10**7)


def test_data_arrays_give_a_dataset_with_their_dimensions(silicone: hs.Arm) -> None:
    pulls = xr.DataArray([0.0, 0.1, 0.2], dims="pull", coords={"pull": [0.0, 0.1, 0.2]})
    speed = xr.DataArray([0.0, 0.05], dims="speed", coords={"speed": [0.0, 0.05]}, attrs={"units": "m/s"})
    tensions = xr.concat([pulls, 0.0 * pulls], dim="cable")
    found = hs.solve_many(silicone, tensions=tensions, flow_speed=speed, vary={"tip.moment": 1e-5})
    assert dict(found.sizes) == {"pull": 3, "speed": 2, "cable": 2}
    plain = hs.solve_many(
        silicone, tensions=np.stack([pulls, 0.0 * pulls], -1)[:, None], flow_speed=[0.0, 0.05], vary={"tip.moment": 1e-5}
    )
    assert found.tip_y.transpose("pull", "speed").values.tobytes() == plain.tip_y.tobytes()
    assert found.tip_y.sel(pull=0.2, speed=0.05).item() == plain.tip_y[2, 1]
    assert found.stroke.sel(cable="left").dims == ("pull", "speed")
    assert hs.solve_many(silicone, flow_speed=speed).tip_x.dims == ("speed",)
    with pytest.raises(ValueError, match="^flow_speed: expected a DataArray"):
        hs.solve_many(silicone, tensions=tensions, flow_speed=[0.0, 0.1])
    with pytest.raises(ValueError, match="^dims: 'station' is a dimension of the answers"):
        hs.solve_many(silicone, flow_speed=speed.rename(speed="station"))


def test_memory_is_refused_before_anything_is_copied(silicone: hs.Arm) -> None:
    import tracemalloc

    tensions = np.broadcast_to([0.1, 0.0], (10**11, 2))
    tracemalloc.start()
    try:
        for options in ({}, {"gradients": True}, {"flow_speed": 0.1, "vary": {"tip.moment": "1 mN m"}}):
            with pytest.raises(MemoryError, match="^100000000000 rows take about"):
                hs.solve_many(silicone, tensions=tensions, **options)
        assert tracemalloc.get_traced_memory()[1] < 2**22
    finally:
        tracemalloc.stop()


def test_rows_in_space_are_their_own_solves() -> None:
    arm = hs.Arm.load("silicone-spatial").replace({"flow.speed": 0.05, "flow.direction": [0, 1, 0]})
    pulls = np.array([[0.1, 0.05, 0.0], [0.2, 0.0, 0.1], [1.4, 0.0, 0.0], [0.0, 0.3, 0.0]])
    upwards = np.array([[-0.5], [0.8]])
    many = hs.solve_many(
        arm, tensions=pulls, vary={"flow.direction[2]": upwards}, tol=TIGHT, stations=4, stability=True, fold_margin=True
    )
    assert many.shape == (2, 4) and many.stroke.shape == (2, 4, 3) and many.tip_a.shape == (2, 4, 3)
    assert many.verdict.tolist() == [["", "", "cable_fold", ""]] * 2
    assert np.isnan(many.tip_z[:, 2]).all() and np.isnan(many.z[:, 2]).all()
    for i, k in [(0, 0), (0, 3), (1, 1), (1, 3)]:
        alone = arm.replace({"flow.direction": [0.0, 1.0, upwards[i, 0]]}).solve(tensions=pulls[k], tol=TIGHT)
        assert isinstance(alone, hs.SpatialSolution)
        tip, reaction = alone.tip, alone.base_reaction
        found = [many.tip_x[i, k], many.tip_y[i, k], many.tip_z[i, k]]
        assert found == pytest.approx([tip.x, tip.y, tip.z], abs=1e-9 * arm.length)
        assert many.tip_a[i, k] == pytest.approx(tip.a, abs=1e-7) and many.tip_c[i, k] == pytest.approx(tip.c, abs=1e-7)
        assert many.base_force_z[i, k] == pytest.approx(np.asarray(reaction.force)[2], abs=1e-9)
        assert many.base_moment_x[i, k] == pytest.approx(np.asarray(reaction.moment)[0], abs=1e-9)
        assert many.stroke[i, k] == pytest.approx([cable.stroke for cable in alone.cables], abs=1e-8)
        stations = alone.resampled(4)
        assert many.z[i, k] == pytest.approx(stations.z, abs=1e-8) and many.b[i, k] == pytest.approx(stations.b, abs=1e-5)
        assert many.fold_margin[i, k] == pytest.approx(alone.fold_margin.value, abs=0.02) and many.stability[i, k] == "stable"
    # The order of the rows changes no answer, and a sweep has columns of the same names.
    back = hs.solve_many(arm, tensions=pulls[::-1], vary={"flow.direction[2]": upwards[::-1]}, tol=TIGHT)
    assert np.allclose(back.tip_z[::-1, ::-1], many.tip_z, rtol=0, atol=1e-9 * arm.length, equal_nan=True)
    dataset = many.to_xarray("up", "pull")
    assert dataset.b_x.dims == ("up", "pull", "station") and dataset.tip_z.attrs["units"] == "m"
    swept = hs.sweep(arm, {"flow.direction[2]": [-0.5, 0.8]}, columns=["tip", "alpha", "base"], tol=TIGHT)
    assert {name for name in swept.data_vars if str(name).startswith(("tip", "base"))} <= set(dataset.data_vars)
    assert {name: swept[name].attrs["long_name"] for name in ("tip_c_y", "base_moment_z")} == {
        "tip_c_y": "director c at the tip, along e2",
        "base_moment_z": "moment of the base reaction about e3",
    }
    with pytest.raises(AttributeError, match="^tip_theta: only for arms in the plane"):
        _ = many.tip_theta
    with pytest.raises(AttributeError, match="^tip_z: only for arms in space"):
        _ = hs.solve_many("silicone").tip_z


def test_gradients_in_space_are_those_of_the_solver() -> None:
    arm = hs.Arm.load("silicone-spatial").replace({"flow.speed": 0.05, "flow.direction": [0, 0, 1]})
    names = ["cable[0].tension", "flow.direction[1]", "material.young"]
    pulls = np.array([[0.1, 0.05, 0.0], [0.3, 0.0, 0.1]])
    many = hs.solve_many(arm, tensions=pulls, gradients=names, tol=TIGHT)
    assert many["d_stroke"].shape == (2, 3, 3) and "d_tip_theta" not in many
    for k in range(2):
        found: Any = arm.replace(tensions=pulls[k]).sensitivities(names, tol=TIGHT)
        size = np.abs(found.jacobian()).max(axis=0)
        for name in ("x", "y", "z", "turn_x", "turn_y", "turn_z"):
            assert (np.abs(many[f"d_tip_{name}"][k] - getattr(found.tip, name)) <= 1e-6 * size).all(), name
        assert (np.abs(many["d_stroke"][k] - found.strokes) <= 1e-6 * size).all()
