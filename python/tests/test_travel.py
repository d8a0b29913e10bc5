"""Results that travel: pickles, copies, files, other processes."""

from __future__ import annotations

import copy
import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import joblib
import numpy as np
import pytest
import xarray as xr
from dask.distributed import Client, LocalCluster

import hydrostat as hs
from hydrostat import _saved
from hydrostat.solution import FIELDS


@pytest.fixture(scope="module")
def bent(silicone: hs.Arm) -> hs.Solution:
    return silicone.solve(tensions=[0.2, 0.05], flow_speed=0.03)


def results(silicone: hs.Arm, facing: hs.Arm) -> dict[str, Any]:
    tips = [silicone.solve(tensions=[pull, 0.0]).tip for pull in (0.1, 0.2, 0.3)]
    data: dict[str, list[Any]] = {"case": list("abc"), "cable[0].tension [N]": [0.1, 0.2, 0.3], "x [m]": [t.x for t in tips], "y [m]": [t.y for t in tips]}
    path = facing.path("arm.base.angle", 90, -90)
    reach = silicone.reach((0.182, 0.078), max_tension=0.6)
    return {
        "Solution": silicone.solve(tensions=[0.2, 0.05], flow_speed=0.03),
        "Solution by strokes": silicone.solve(strokes=[0.012, -0.03]),
        "Solution of a path": path.branches[0][20],
        "Stations": silicone.solve(tensions=[0.2, 0.05]).resampled(7),
        "Path": path,
        "Branch": path.branches[0],
        "Equilibria": facing.equilibria(),
        "Reach": reach,
        "Reached": reach[0],
        "far Reach": silicone.reach((0.05, 0.3), max_tension=0.1),
        "Boundary": silicone.reachable(max_tension=0.2, spacing=0.1),
        "Sensitivities": silicone.replace(tensions=[0.2, 0.05]).sensitivities(stations=[0.1, 0.2]),
        "Fit": silicone.identify(data, "young=90 kPa", sd="1 mm"),
        "Many": hs.solve_many(silicone, tensions=[[0.1, 0.0], [1.4, 0.0], [np.nan, 0.0]], gradients=True),
    }


@pytest.fixture(scope="module")
def made(silicone: hs.Arm, facing: hs.Arm) -> dict[str, Any]:
    return results(silicone, facing)


NAMES = [*("Solution", "Solution by strokes", "Solution of a path", "Stations", "Path", "Branch", "Equilibria", "Reach", "Reached")]
NAMES += ["far Reach", "Boundary", "Sensitivities", "Fit", "Many"]


@pytest.mark.parametrize("name", NAMES)
def test_round_trips(made: dict[str, Any], name: str) -> None:
    result = made[name]
    once = pickle.loads(pickle.dumps(result))
    twice = pickle.loads(pickle.dumps(once))
    assert type(once) is type(result)
    assert once == result and twice == result and hash(once) == hash(result)
    assert copy.copy(once) == result and copy.deepcopy(result) == once
    assert repr(once) == repr(result)
    assert result != made["Many" if name != "Many" else "Stations"] and result != "else"


def test_what_pickles_do_not_hold_is_made_again(made: dict[str, Any]) -> None:
    s = np.linspace(0.0, 0.245, 33)
    for name in ("Solution", "Solution by strokes", "Solution of a path"):
        result, again = made[name], pickle.loads(pickle.dumps(made[name]))
        for field in FIELDS:
            assert getattr(again, field).tobytes() == getattr(result, field).tobytes()
            assert getattr(again.at(s), field).tobytes() == getattr(result.at(s), field).tobytes(), (name, field)
            assert not getattr(again, field).flags.writeable
        assert again.to_json() == result.to_json() and again.stability == result.stability
        assert again.figure().svg() == result.figure().svg()
        assert again.cable_path(0, s).tobytes() == result.cable_path(0, s).tobytes()
    for name in ("Path", "Equilibria", "Boundary", "Fit"):
        assert pickle.loads(pickle.dumps(made[name])).figure().svg() == made[name].figure().svg(), name
    assert pickle.loads(pickle.dumps(made["Reach"]))[0].figure().svg() == made["Reach"][0].figure().svg()
    path = pickle.loads(pickle.dumps(made["Path"]))
    assert path.to_csv() == made["Path"].to_csv()
    assert path.branches[0][20] == made["Solution of a path"]
    sens = pickle.loads(pickle.dumps(made["Sensitivities"]))
    assert sens.manipulability() == made["Sensitivities"].manipulability()
    assert sens.jacobian().tobytes() == made["Sensitivities"].jacobian().tobytes()


def test_a_shape_that_no_solve_leads_to_says_so(facing: hs.Arm) -> None:
    """As of a pickle whose branch is not that of its arm's ramp."""
    unstable = facing.equilibria()[1]
    alone = hs.Solution(unstable._inner)
    again = pickle.loads(pickle.dumps(alone))
    assert again == unstable and again.tip == unstable.tip
    with pytest.raises(RuntimeError, match="leads to another"):
        again.at(0.1)
    assert "<svg" in again._repr_html_()


def test_another_format_is_refused_by_name(bent: hs.Solution, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patched:
        patched.setattr(_saved, "FORMAT", 7)
        theirs = pickle.dumps(bent)
    with pytest.raises(ValueError, match=r"^Solution: was saved in format 7 by hydrostat .* reads format 3 alone"):
        pickle.loads(theirs)


def test_exceptions_keep_the_last_good_shape(silicone: hs.Arm) -> None:
    with pytest.raises(hs.CableFold) as caught:
        silicone.solve(tensions=[1.5, 0.0])
    again = pickle.loads(pickle.dumps(caught.value))
    assert type(again) is hs.CableFold and str(again) == str(caught.value)
    assert again.last_good is not None and again.last_good == caught.value.last_good


def pulled(arm: hs.Arm, pull: float) -> hs.Solution:
    return arm.solve(tensions=[pull, 0.0])


def test_other_processes_send_them(silicone: hs.Arm) -> None:
    pulls = [0.1, 0.2, 0.3]
    here = [pulled(silicone, pull) for pull in pulls]
    there = joblib.Parallel(n_jobs=2)(joblib.delayed(silicone.solve)(tensions=[pull, 0.0]) for pull in pulls)
    assert there == here
    assert there[1].at(0.1) == here[1].at(0.1)
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        assert list(pool.map(silicone.__class__.solve, [silicone] * 1)) == [silicone.solve()]
        failed = pool.submit(silicone.solve, tensions=[1.5, 0.0])
        assert isinstance(failed.exception(), hs.CableFold)
    with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=":0") as cluster, Client(cluster) as client:
        futures = [client.submit(silicone.solve, tensions=[pull, 0.0]) for pull in pulls]
        assert client.gather(futures) == here


def test_files(bent: hs.Solution, silicone: hs.Arm, tmp_path: Path) -> None:
    for shape in (bent, silicone.solve(strokes=[0.012, None])):
        file = shape.save(tmp_path / "shape.nc")
        again = hs.load(file)
        assert again == shape and again.to_json() == shape.to_json()
        with xr.open_dataset(file) as dataset:
            assert dataset.x.values.tobytes() == shape.x.tobytes()
            assert dataset.warnings.values.tolist() == [note.message for note in shape.warnings]
    assert [path.name for path in tmp_path.iterdir()] == ["shape.nc"]
    with pytest.raises(ValueError, match="^path: expected a name that ends in .nc"):
        bent.save(tmp_path / "shape.json")
    other = tmp_path / "other.nc"
    bent.to_xarray().to_netcdf(other)
    with pytest.raises(ValueError, match="expected a file that `Solution.save` wrote"):
        hs.load(other)
    with pytest.raises(FileNotFoundError):
        hs.load(tmp_path / "none.nc")
