"""Parameters from measured shapes: known truth, the program's own document, and requests that cannot be meant."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from conftest import ROOT, Program, needs_checkout

import hydrostat as hs

PULLS = [0.1, 0.2, 0.3]


def tips(arm: hs.Arm) -> dict[str, list[object]]:
    found = [arm.solve(tensions=[pull, 0.0]).tip for pull in PULLS]
    return {
        "case": [f"{pull} N" for pull in PULLS],
        "cable[0].tension [N]": list(PULLS),
        "x [m]": [tip.x for tip in found],
        "y [m]": [tip.y for tip in found],
    }


@needs_checkout
def test_the_document_is_the_programs(program: Program, silicone: hs.Arm) -> None:
    data = ROOT / "docs" / "identification.csv"
    words = ["identify", "silicone", str(data), "--set", "flow.law=quadratic-drag", "--fit", "young=80 kPa,cn=1"]
    status, text = program(*words, "--json")
    arm = silicone.replace({"flow.law": "quadratic-drag"})
    fit = arm.identify(data, "young=80 kPa,cn=1")
    assert status == 0 and fit.converged
    assert fit.to_json() == text.strip()
    assert fit.to_csv() == program(*words, "--format", "csv")[1]


@needs_checkout
def test_every_way_to_give_the_data_is_the_same(silicone: hs.Arm, tmp_path: Path) -> None:
    arm = silicone.replace({"flow.law": "quadratic-drag"})
    path = ROOT / "docs" / "identification.csv"
    table = pd.read_csv(path, comment="#")
    fits = [
        arm.identify(path, ["young=80 kPa", "cn=1"]),
        arm.identify(str(path), {"young": "80 kPa", "cn": 1}),
        arm.identify(table, {"young": 80e3, "cn": 1.0}),
        arm.identify({str(head): table[head].tolist() for head in table}, "young=80 kPa, cn=1"),
    ]
    for fit in fits:
        assert fit.values.tobytes() == fits[0].values.tobytes()
        assert fit.covariance.tobytes() == fits[0].covariance.tobytes()
    young, cn = fits[0].estimates
    assert (young.key, young.unit, young.start) == ("material.young", "Pa", 80e3)
    assert young.interval is not None and young.interval[0] < 110e3 < young.interval[1]
    assert cn.interval is not None and cn.interval[0] < 2.5 < cn.interval[1]
    assert len(fits[0].cross_validation) == 3
    assert fits[0].residuals["residual"].shape == (30,)
    again = fits[0].to_pandas()
    assert (again["residual"] ** 2).sum() == pytest.approx(fits[0].chi_square)


def test_the_truth_comes_back_and_the_arm_with_it(silicone: hs.Arm) -> None:
    fit = silicone.identify(tips(silicone), {"young": ("80 kPa", "50 kPa", "200 kPa")}, sd=["1 mm"])
    assert fit.values == pytest.approx([110e3], rel=1e-6)
    assert fit.estimates[0].bounds == (50e3, 200e3)
    assert fit.arm.replace({"material.young": 110e3}) == silicone
    assert list(fit.solutions) == ["0.1 N", "0.2 N", "0.3 N"]
    assert fit.solutions["0.3 N"].tip.x == pytest.approx(silicone.solve(tensions=[0.3, 0.0]).tip.x, abs=1e-7)
    with pytest.raises(ValueError, match="read-only"):
        fit.values[0] = 1.0


def test_what_the_data_do_not_know_is_said(silicone: hs.Arm) -> None:
    streams: list[object] = [0.05, 0.1, 0.2]
    # The density of the water is then seen in C_n alone.
    across = {"flow.law": "quadratic-drag", "flow.direction": 60, "flow.ct": 0.0, "gravity.acceleration": 0.0}
    arm = silicone.replace(across)  # only the product of C_n and density is seen
    found = [arm.replace({"flow.speed": speed}).solve().tip for speed in streams]
    data: dict[str, list[object]] = {
        "case": ["a", "b", "c"],
        "flow.speed [m/s]": streams,
        "x [m]": [tip.x for tip in found],
        "y [m]": [tip.y for tip in found],
    }
    together = arm.identify(data, {"flow.cn": None, "flow.density": None}, sd="1 mm", cross_validate=False)
    assert any("do not separate" in sentence for sentence in together.verdict)
    assert together.singular_values[0] < 1e-3 * together.singular_values[1]
    known = arm.identify(data, "flow.cn,flow.density", prior={"flow.density": (1022.0, 1.0)}, sd="1 mm", cross_validate=False)
    assert known.estimates[1].prior == (1022.0, 1.0)
    assert known.values == pytest.approx([2.5, 1022.0], rel=1e-4)


def test_outliers_hardly_move_robust_estimates(silicone: hs.Arm) -> None:
    data = tips(silicone)
    data["y [m]"][1] += 0.02  # type: ignore[operator]
    plain = silicone.identify(data, "young", sd="1 mm")
    robust = silicone.identify(data, "young", sd="1 mm", loss="cauchy")
    assert abs(robust.values[0] - 110e3) < 0.1 * abs(plain.values[0] - 110e3)
    assert plain.misfit is not None and "times as large" in plain.misfit


def test_missing_values_are_left_out(silicone: hs.Arm) -> None:
    data = tips(silicone)
    data["y [m]"][0] = float("nan")
    data["x [m]"][2] = None
    fit = silicone.identify(data, "young=90 kPa", sd="1 mm")
    assert fit.residuals["measured"].shape == (4,)
    assert fit.values == pytest.approx([110e3], rel=1e-6)


def test_an_index_with_a_name_was_no_column(silicone: hs.Arm) -> None:
    s = np.array([0.1, 0.2])
    shape = silicone.solve(tensions=[0.2, 0.0]).at(s)
    pull = pd.array([0.2, None], dtype="Float64")
    table = pd.DataFrame({"case": "a", "cable[0].tension [N]": pull, "x [m]": shape.x, "y [m]": shape.y}, index=pd.Index(s, name="s [m]"))
    fit = silicone.identify(table, "young=90 kPa", sd="1 mm")
    assert fit.residuals["s"].tolist() == [0.1, 0.1, 0.2, 0.2]
    assert fit.values == pytest.approx([110e3], rel=1e-6)


def test_residuals_that_are_nothing_were_as_large_as_stated(silicone: hs.Arm) -> None:
    fit = silicone.identify(tips(silicone), "young=90 kPa", sd="1 mm")
    assert fit.chi_square < 1e-6 and fit.dof == fit.freedom == 5 and fit.scale == fit.spread == 1.0
    assert fit.misfit is not None and "far smaller than the standard deviations predict" in fit.misfit


def test_pictures(silicone: hs.Arm, tmp_path: Path) -> None:
    fit = silicone.identify(tips(silicone), "young=90 kPa", sd="1 mm")
    axis = fit.plot()
    texts = [text.get_text() for text in axis.get_legend().get_texts()]  # type: ignore[union-attr]
    assert texts == ["0.1 N", "0.2 N", "0.3 N"]
    plt.close("all")
    assert "fitted minus measured (sd)" in fit.figure().texts()
    assert fit.figure().save(tmp_path / "fit.png").stat().st_size > 5000


def test_the_template_is_a_table_that_can_be_filled_in(silicone: hs.Arm, tmp_path: Path) -> None:
    path = tmp_path / "data.csv"
    path.write_text(silicone.measurements_template(), encoding="utf-8")
    table = pd.read_csv(path, comment="#")
    heads = ["cable_0_tension_N", "cable_1_tension_N", "flow_speed_m_s"]
    # A case gives its loads once.
    table.loc[table["case"] == "b", heads] = [[0.2, 0.0, 0.1], *[[np.nan] * 3] * 3]
    for row in table.index:
        pulls = [0.2, 0.0] if table.loc[row, "case"] == "b" else [0.0, 0.0]
        shape = silicone.solve(tensions=pulls, flow_speed=0.1 if pulls[0] else 0.0)
        place = shape.at([1e-3 * float(table.loc[row, "s_mm"])])
        table.loc[row, ["x_mm", "y_mm"]] = [1e3 * place.x[0], 1e3 * place.y[0]]
    table.to_csv(path, index=False)
    fit = silicone.identify(path, "young=90 kPa", cross_validate=False)
    assert fit.residuals["measured"].shape == (16,)
    assert fit.values == pytest.approx([110e3], rel=1e-6)


def test_wrong_requests_name_the_argument(silicone: hs.Arm, tmp_path: Path) -> None:
    good = tips(silicone)
    with pytest.raises(FileNotFoundError, match="data: there is no file"):
        silicone.identify(tmp_path / "none.csv", "young")
    with pytest.raises(ValueError, match="data: expected columns of one length"):
        silicone.identify({**good, "x [m]": [0.1]}, "young", sd="1 mm")
    with pytest.raises(ValueError, match="fit: "):
        silicone.identify(good, "elasticity", sd="1 mm")
    with pytest.raises(ValueError, match=r"fit\['young'\]: expected a finite number"):
        silicone.identify(good, {"young": float("nan")}, sd="1 mm")
    with pytest.raises(ValueError, match="loss: expected none, huber or cauchy"):
        silicone.identify(good, "young", sd="1 mm", loss="tukey")
    with pytest.raises(ValueError, match="sd: expected a standard deviation with its unit"):
        silicone.identify(good, "young", sd="1")
    with pytest.raises(ValueError, match=r"prior\['young'\]: expected \(mean, standard deviation\)"):
        silicone.identify(good, "young", sd="1 mm", prior={"young": 1e5})  # type: ignore[dict-item]
    with pytest.raises(hs.MeasurementsError) as wrong:
        silicone.identify({**good, "x [N]": [1, 2, 3]}, "young", sd="1 mm")
    assert (wrong.value.row, wrong.value.column) == (1, "x [N]")
    again = pickle.loads(pickle.dumps(wrong.value))
    assert (str(again), again.row) == (str(wrong.value), 1)
    with pytest.raises(hs.CableFold) as fold:
        silicone.identify({**good, "cable[0].tension [N]": [0.1, 0.2, 1.5]}, "young", sd="1 mm")
    assert fold.value.__notes__ == ["load case 0.3 N has no answer where the search starts"]


def test_an_arm_in_space_with_markers_beside_it() -> None:
    arm = hs.Arm.load("tentacle").replace({"reference.kappa": 0.3})
    rows: dict[str, list[object]] = {
        head: []
        for head in (
            "case",
            "cable_0_tension_N",
            "cable_1_tension_N",
            "s_m",
            "offset_a_m",
            "offset_b_m",
            "offset_c_m",
            "x_m",
            "y_m",
            "z_m",
        )
    }
    for tensions in ([3.0, 0.0], [0.0, 2.0], [2.0, 2.0]):
        shape = arm.solve(tensions=[0.9 * tension for tension in tensions])
        for s, offset in ((0.18, (0.0, 0.01, -0.02)), (0.36, (0.008, 0.0, 0.0))):
            at: Any = shape.at([s])
            place = np.array([at.x[0], at.y[0], at.z[0]]) + offset[0] * at.a[0] + offset[1] * at.b[0] + offset[2] * at.c[0]
            for head, value in zip(rows, (str(tensions), *tensions, s, *offset, *place), strict=True):
                rows[head].append(value)
    fit = hs.Arm.load("tentacle").identify(rows, {"young": "400 kPa", "tension_factor": 1.0, "reference.kappa": None}, sd="1 mm")
    np.testing.assert_allclose(fit.values, [505e3, 0.9, 0.3], rtol=1e-5)
    assert [estimate.key for estimate in fit.estimates] == ["material.young", "tension_factor", "reference.kappa"]
    assert len(fit.misses) == 2 and all(miss.cases == 3 and miss.rms < 1e-6 for miss in fit.misses)
    assert fit.misses[0].offset == (0.0, 0.01, -0.02)
    assert set(fit.residuals["quantity"]) == {"x", "y", "z"} and fit.residuals["offset_c"].min() == -0.02
    assert all(isinstance(shape, hs.SpatialSolution) for shape in fit.solutions.values())
    assert fit.arm.is_spatial and fit.figure().svg().startswith("<svg")
    axis: Any = fit.plot()
    assert axis.name == "3d"
    # A centreline and the measured places of each load case.
    assert len(axis.lines) == 2 * len(fit.solutions)
    assert [len(line.get_data_3d()[0]) for line in axis.lines[1::2]] == [2, 2, 2]
