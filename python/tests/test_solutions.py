"""Solutions: arrays that share memory, what they say, what they become."""

from __future__ import annotations

import gc
import io
import threading

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import hydrostat as hs
from hydrostat.solution import FIELDS


@pytest.fixture(scope="module")
def bent(silicone: hs.Arm) -> hs.Solution:
    return silicone.solve(tensions=[0.2, 0.0], flow_speed=0.1)


def test_arrays_are_read_only_and_share_memory(bent: hs.Solution) -> None:
    for name in FIELDS:
        first, second = getattr(bent, name), getattr(bent, name)
        assert first is not second
        assert np.shares_memory(first, second)
        assert first.base is bent._inner
        assert first.dtype == np.float64 and first.flags.c_contiguous
        with pytest.raises(ValueError, match="read-only"):
            first[0] = 1.0
        with pytest.raises(ValueError, match="WRITEABLE"):
            first.flags.writeable = True


def test_copied_arrays_keep_nothing(bent: hs.Solution) -> None:
    copied = bent.copy_arrays()
    assert list(copied) == list(FIELDS)
    for name, array in copied.items():
        assert array.base is None and array.flags.writeable and array.tobytes() == getattr(bent, name).tobytes()


def test_arrays_outlive_their_solution(silicone: hs.Arm) -> None:
    def arrays() -> list[np.ndarray[tuple[int], np.dtype[np.float64]]]:
        solution = silicone.solve(tensions=[0.3, 0.1])
        return [solution.x, solution.m, solution.at(np.linspace(0.0, 0.2, 50)).theta, solution.resampled(9).nu]

    kept = arrays()
    copies = [array.copy() for array in kept]
    gc.collect()
    # What the freed memory would be filled with, if it were.
    others = [silicone.solve(tensions=[0.01 * k, 0.0]) for k in range(50)]
    gc.collect()
    for array, copy in zip(kept, copies, strict=True):
        assert array.tobytes() == copy.tobytes()
    assert len(others) == 50


@settings(max_examples=30, deadline=None)
@given(share=st.floats(0.0, 1.0))
def test_places_between_stations(bent: hs.Solution, share: float) -> None:
    s = share * bent.arm.length
    here = bent.at(s)
    left, right = bent.surfaces([s])
    # The centreline is halfway between the surfaces, and the cable between it and the left one.
    middle = 0.5 * (left[0] + right[0])
    assert np.allclose(middle, [here.x[0], here.y[0]], rtol=0, atol=1e-15)
    cable = bent.cable_path(0, [s])[0]
    assert np.linalg.norm(cable - middle) < np.linalg.norm(left[0] - middle)
    assert here.s[0] == s
    # Planar: beta = 1/nu.
    assert abs(here.beta[0] * here.nu[0] - 1.0) < 1e-12


def test_what_a_solution_says(bent: hs.Solution) -> None:
    tip = bent.tip
    assert (tip.x, tip.y, tip.theta, tip.alpha) == (bent.x[-1], bent.y[-1], bent.theta[-1], bent.alpha[-1])
    left, right = bent.cables
    assert left.name == "left" and left.tension == 0.2 and left.stroke > right.stroke
    assert left.command is None
    assert bent.stable is True and bent.stability == "stable" and bent.unstable_directions == 0
    growth = bent.growth()
    assert growth is not None and (growth.real < 0).all()
    assert bent.unmet is None
    assert [warning.kind for warning in bent.warnings] == ["tangential_load"]
    assert bent.statistics["elements"] + 1 == len(bent)
    assert 0 < bent.fold_margin.value < 1 and bent.strain_energy > 0
    assert bent.error_estimate < 1e-8 * bent.arm.length
    assert "silicone" in repr(bent)
    # What holds the arm carries the sum of all loads: the drag points down the stream.
    assert bent.base_reaction.force[0] < 0
    # At the wall the water stands still; from h_inf = 5 mm on it has the stream's tangential part.
    assert bent.layer_speed(0.1, 0.0) == 0.0
    angle = float(bent.at(0.1).theta[0] + bent.at(0.1).alpha[0])
    assert bent.layer_speed(0.1, 0.005) == pytest.approx(0.1 * np.cos(angle), rel=1e-12)


def test_unmet_tip_of_the_unstrained_base(silicone: hs.Arm) -> None:
    solution = silicone.replace({"model.support": "unstrained-base"}).solve(tensions=[0.05, 0.0])
    assert solution.unmet is not None and abs(solution.unmet.moment) > 0
    assert solution.stability is None


def test_commands(silicone: hs.Arm) -> None:
    solution = silicone.solve(strokes=[0.012, -0.03])
    left, right = solution.cables
    assert left.command is not None and not left.command.slack and left.tension > 0
    assert left.stroke == pytest.approx(0.012, abs=1e-10)
    assert right.command is not None and right.command.slack and right.tension == 0
    only = silicone.solve(tensions=[0.0, 0.1], strokes=[0.01, None])
    assert only.cables[1].tension == 0.1 and only.cables[1].command is None


def test_the_tables_it_becomes(bent: hs.Solution) -> None:
    dataset = bent.to_xarray()
    assert dataset.x.attrs == {"units": "m", "long_name": "centreline along e1"}
    assert dataset.s.values.tobytes() == bent.s.tobytes()
    assert dataset.stroke.sel(cable="left").item() == bent.cables[0].stroke
    assert dataset.attrs["arm"] == "silicone"
    frame = bent.to_pandas()
    assert list(frame.columns) == [name for name in FIELDS if name != "s"]
    assert np.array_equal(frame.index, bent.s)
    csv = pd.read_csv(io.StringIO(bent.to_csv()))
    assert csv["mu_per_m"].to_numpy().tobytes() == bent.mu.tobytes()
    assert len(bent.resampled(7).to_pandas()) == 7


def test_verdicts(silicone: hs.Arm) -> None:
    with pytest.raises(hs.NoEquilibrium) as caught:
        silicone.solve(tensions=[1.5, 0.0])
    no = caught.value
    assert type(no) is hs.CableFold and no.kind == "cable_fold" and no.phase == "tension"
    assert no.where == pytest.approx(0.245) and 0.62 < no.load_fraction < 0.63
    assert no.last_good is not None
    # The last good shape carries the tension just below the fold.
    assert no.last_good.cables[0].tension == pytest.approx(1.5 * no.load_fraction, rel=1e-3)
    assert no.message in str(no) and no.advice in str(no)
    with pytest.raises(hs.LimitPoint) as caught:
        # A stream almost against it, which turns it round on the way.
        silicone.replace(flow_speed=0.5, flow_direction=170).solve()
    assert caught.value.phase == "loads" and caught.value.where is None


def test_solver_follows_small_changes(silicone: hs.Arm) -> None:
    solver = hs.Solver(silicone)
    for step in range(5):
        solver.set_tensions([0.2 + 0.004 * step, 0.0])
        solver.set_flow_speed(0.1 + 0.002 * step)
        answer = solver.update()
        fresh = silicone.solve(tensions=[0.2 + 0.004 * step, 0.0], flow_speed=0.1 + 0.002 * step)
        assert np.hypot(answer.tip.x - fresh.tip.x, answer.tip.y - fresh.tip.y) < 1e-8
        assert np.allclose(solver.solution().tip, answer.tip, rtol=0, atol=1e-14)
    solver.set_stroke(0, 0.01)
    assert solver.solve().cables[0].stroke == pytest.approx(0.01, abs=1e-10)
    with pytest.raises(ValueError, match="flow_speed"):
        solver.set_flow_speed(-1.0)


def test_other_threads_run_meanwhile(silicone: hs.Arm) -> None:
    started = threading.Event()

    def solve() -> None:
        started.set()
        hs.solve_many(silicone, flow_speed=np.linspace(0.0, 0.5, 4000))

    thread = threading.Thread(target=solve)
    thread.start()
    started.wait()
    turns = 0
    while thread.is_alive():
        turns += 1
    # A call that held the interpreter would let this loop go round a few times at either end only.
    assert turns > 1000
