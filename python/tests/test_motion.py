"""The arm in motion: runs, steps of control loops, and pictures."""

from __future__ import annotations

import copy
import math
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hydrostat as hs

xr = pytest.importorskip("xarray")


@pytest.fixture(scope="module")
def arm() -> hs.Arm:
    return hs.Arm.load("silicone").replace({"dynamics.relaxation_time": "2.7 ms"})


def test_a_run_begins_at_rest_in_the_equilibrium(arm: hs.Arm) -> None:
    pulled = arm.replace(tensions=[0.1, 0])
    motion = hs.simulate(pulled, until=0.1, every=0.05, tol=1e-3)
    tip = pulled.solve().tip
    assert motion.tip_x.to_numpy() == pytest.approx(np.full(3, tip.x), abs=2e-3 * arm.length)
    assert float(motion.kinetic_energy.max()) < 1e-12
    assert motion.sizes == {"time": 3, "cable": 2, "node": motion.sizes["node"]}
    assert motion.x[0, -1].item() == pytest.approx(motion.tip_x[0].item(), abs=1e-12)


def test_functions_numbers_and_tables_are_the_same_loads(arm: hs.Arm) -> None:
    key = "cable[0].tension"
    ramp = hs.simulate(arm, {key: [[0, 0], [0.2, 0.1]]}, until=0.2, every=0.1, tol=1e-4)
    function = hs.simulate(arm, {key: lambda t: 0.5 * t}, until=0.2, every=0.1, tol=1e-4)
    pd = pytest.importorskip("pandas")
    table = hs.simulate(arm, pd.DataFrame({"t_s": [0, 0.2], key: [0, 0.1]}), until=0.2, every=0.1, tol=1e-4)
    assert table.tip_y.to_numpy() == pytest.approx(ramp.tip_y.to_numpy(), abs=1e-15)
    assert function.tip_y.to_numpy() == pytest.approx(ramp.tip_y.to_numpy(), abs=1e-4 * arm.length)
    assert ramp.tension[:, 0].to_numpy() == pytest.approx([0, 0.05, 0.1])
    still = hs.simulate(arm, {key: 0.1}, until=0.1, every=0.1, tol=1e-4)
    assert still.tip_y[0].item() == pytest.approx(arm.solve(tensions=[0.1, 0]).tip.y, abs=1e-4 * arm.length)


def test_angles_of_inputs_are_in_degrees(arm: hs.Arm) -> None:
    turned = hs.simulate(arm, {"arm.base.angle": 30}, until=0.1, every=0.1, tol=1e-3)
    assert turned.theta[0, 0].item() == pytest.approx(math.radians(30), abs=1e-9)


def test_loads_along_the_arm_change_in_time(arm: hs.Arm) -> None:
    damped = arm.replace({"dynamics.relaxation_time": "0.3 s"})
    motion = hs.simulate(damped, {"distributed.force[1]": [[0, 0], [2, 0.01]], "distributed.couple": 1e-5}, until=12, every=12)
    still = arm.replace({"distributed.force": [0.0, 0.01], "distributed.couple": 1e-5}).solve().tip
    assert [motion.tip_x[-1].item(), motion.tip_y[-1].item()] == pytest.approx([still.x, still.y], abs=1e-3 * arm.length)
    assert float(motion.load_work[-1]) > 0.0


def test_tension_and_stroke_of_one_cable_are_refused(arm: hs.Arm) -> None:
    with pytest.raises(ValueError, match=r"`cable\[0\]\.stroke`: `cable\[0\]\.tension` is given as well"):
        hs.simulate(arm, {"cable[0].tension": 0.1, "cable[0].stroke": 0.01}, until=0.1)


def test_variables_were_named_with_units(arm: hs.Arm) -> None:
    motion = hs.simulate(arm, until=0.1, every=0.1, tol=1e-3)
    for name, unit in {"base_force_x": "N", "base_moment": "N m", "cable_work": "J", "dissipated": "J"}.items():
        assert motion[name].attrs["units"] == unit
    assert not [name for name in motion.data_vars if str(name).endswith(("_N", "_Nm", "_J", "_m", "_rad"))]


def test_steps_are_a_run_in_pieces(arm: hs.Arm) -> None:
    sim = hs.Simulation(arm, tol=1e-5)
    steps = [sim.step(0.05, tensions=[pull, 0]) for pull in (0.05, 0.1, 0.1, 0.0)]
    times = [0, 0.05, 0.1, 0.15, 0.2]
    rows = np.stack([times, [0, 0.05, 0.1, 0.1, 0.0]], axis=1)
    run = hs.simulate(arm, {"cable[0].tension": rows}, until=0.2, every=0.05, tol=1e-5)
    tips = np.array([[at.tip_x, at.tip_y] for at in steps])
    assert np.abs(tips - np.stack([run.tip_x, run.tip_y], axis=1)[1:]).max() < 2e-5 * arm.length
    assert [at.time for at in steps] == pytest.approx(times[1:])
    assert sim.statistics["steps"] > 4 and sim.error_estimate < 1e-4 * arm.length


def test_a_copy_goes_on_by_itself(arm: hs.Arm) -> None:
    sim = hs.Simulation(arm, tol=1e-3)
    sim.step(0.05, tensions=[0.1, 0])
    other = copy.copy(sim)
    one, two = sim.step(0.05, tensions=[0.2, 0]), other.step(0.05, tensions=[0, 0])
    assert one.tip_y > two.tip_y and sim.time == other.time


def test_other_loads_change_within_a_step(arm: hs.Arm) -> None:
    sim = hs.Simulation(arm, tol=1e-3)
    at = sim.step(0.5, loads={"flow.speed": 0.1, "flow.direction": 90})
    assert at.tip_y > 1e-3
    with pytest.raises(ValueError, match="arm.length"):
        sim.step(0.1, loads={"arm.length": 1.0})
    with pytest.raises(ValueError, match="tensions: expected one for each of 2 cables"):
        sim.step(0.1, tensions=[0.1])
    with pytest.raises(ValueError, match="dt"):
        sim.step(0.0)


def test_a_fold_ends_a_run_with_what_was_before(arm: hs.Arm) -> None:
    with pytest.raises(hs.MotionError, match="to zero length") as caught:
        hs.simulate(arm, {"cable[0].tension": [[0, 0], [0.2, 1.4]]}, until=0.2, every=0.01, tol=1e-3)
    error = caught.value
    assert error.kind == "cable_fold" and 0 < error.time < 0.2
    assert 0 < error.data.sizes["time"] < 21 and "to zero length" in error.data.attrs["verdict"]


def test_other_threads_run_during_a_run(arm: hs.Arm) -> None:
    done, count = threading.Event(), [0]

    def counts() -> None:
        while not done.is_set():
            count[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=counts)
    thread.start()
    start = time.perf_counter()
    hs.simulate(arm, {"cable[0].tension": lambda t: 0.1 * math.sin(6 * t) ** 2}, until=2.0, tol=1e-4)
    took = time.perf_counter() - start
    done.set()
    thread.join()
    assert count[0] > 0.1 * took / 0.001 or took < 0.05


def test_wrong_requests_name_the_argument(arm: hs.Arm) -> None:
    wrong: list[tuple[Any, str]] = [
        ({"arm.length": 1.0}, "arm.length"),
        ({"flow.speed": [1.0, 2.0]}, r"flow.speed: expected a number, a function of time, or rows"),
        ({"flow.speed": lambda t: math.nan}, "flow.speed: expected a finite number"),
        ({"cable[7].tension": 1.0}, "cable"),
    ]
    for inputs, words in wrong:
        with pytest.raises(ValueError, match=words):
            hs.simulate(arm, inputs, until=0.1)
    with pytest.raises(ValueError, match="until"):
        hs.simulate(arm, until=0.0)


def test_figures_and_animations_of_a_motion(arm: hs.Arm, tmp_path: Path) -> None:
    motion = hs.simulate(arm, {"cable[0].tension": [[0, 0], [0.1, 0.1]]}, until=0.1, every=0.02, tol=1e-3)
    strobe, over_time = hs.motion_figures(motion)
    assert "tip trace" in strobe.texts() and "energy (mJ)" in over_time.texts()
    pytest.importorskip("matplotlib").use("agg")
    hs.animate(motion, tmp_path / "motion.gif", sections=5)
    assert (tmp_path / "motion.gif").read_bytes()[:4] == b"GIF8"


def test_a_snap_is_followed_by_its_motion(arm: hs.Arm) -> None:
    against = arm.replace(flow_speed=0.4, flow_direction=math.degrees(3.0))
    with pytest.raises(hs.LimitPointError):
        against.solve()
    sol = against.solve(after_snap=True)
    (snap,) = sol.snaps
    assert snap.phase == "loads" and snap.duration is not None and snap.duration > 1 and snap.lands_elsewhere is False
    assert sol.stable and min(abs(e.tip.theta - sol.tip.theta) for e in against.equilibria()) < 1e-6
    with pytest.raises(ValueError, match="after_snap"):
        against.solve(after_snap=True, follow_snaps=True)
    assert '"duration":' in sol.to_json()


def test_a_history_has_hysteresis(arm: hs.Arm) -> None:
    against = arm.replace(flow_speed=0.2, flow_direction=180)
    both = hs.history(against, {"arm.base.angle": [40, 0, -40, 0, 40]})
    assert len(both) == 5 and both.keys == ("arm.base.angle",)
    assert both[1].tip.y * both[3].tip.y < 0, "between the snaps the shape depends on the way"
    assert both[0].tip.theta == pytest.approx(both[4].tip.theta, abs=1e-6)
    down, up = both.snaps
    assert (down.row, up.row) == (2, 4)
    assert down.loads["arm.base.angle"] == pytest.approx(-up.loads["arm.base.angle"], abs=1e-3)
    assert down.loads["arm.base.angle"] == pytest.approx(-29.643, abs=1e-2)
    assert "the arm snaps" in both.figure("tip.theta").texts()
    assert len(both.to_csv().splitlines()) == 6 and "snaps" in both.to_json()
    assert both.loads("arm.base.angle").tolist() == [40, 0, -40, 0, 40]


def test_a_fold_ends_a_history_with_the_rows_before(arm: hs.Arm) -> None:
    with pytest.raises(hs.MotionError, match="row 2: .*to zero length") as caught:
        hs.history(arm, {"cable[0].tension": [0, 0.2, 1.4]})
    assert len(caught.value.data) == 2
    with pytest.raises(ValueError, match="table"):
        hs.history(arm, {"cable[0].tension": [0, 1], "flow.speed": [0]})


def test_rows_of_a_sweep_may_be_after_their_snaps(arm: hs.Arm) -> None:
    against = arm.replace(flow_direction=math.degrees(3.0))
    rows = hs.sweep(against, {"flow.speed": [0.1, 0.4]}, after_snap=True, columns=["tip", "snaps"])
    one = against.solve(flow_speed=0.4, after_snap=True)
    assert rows.snaps.to_numpy().tolist() == [0, 1]
    assert rows.tip_theta[1].item() == pytest.approx(one.tip.theta, abs=1e-5)
    assert rows.snap_duration[1].item() == pytest.approx(one.snaps[0].duration, rel=1e-2)
