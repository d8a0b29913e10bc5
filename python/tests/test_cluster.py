"""Sweeps on a scheduler and worker processes of this machine, which speak TCP."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import dask
import numpy as np
import pyarrow.dataset
import pytest
import xarray as xr
from distributed import Client, LocalCluster

import hydrostat as hs

VARY = {"flow.speed": "0:1:60", "cable[0].tension": "0:80:100"}


@pytest.fixture(scope="module")
def paper() -> hs.Arm:
    return hs.Arm.load("paper")


@pytest.fixture(scope="module")
def here(paper: hs.Arm) -> xr.Dataset:
    return hs.sweep(paper, VARY)


@pytest.fixture
def client(request: pytest.FixtureRequest) -> Iterator[Client]:
    """Two worker processes; a worker may die so often before its tasks are given up."""
    failures = getattr(request, "param", 3)
    with (
        dask.config.set({"distributed.scheduler.allowed-failures": failures}),
        LocalCluster(n_workers=2, threads_per_worker=1, protocol="tcp://", dashboard_address=":0") as cluster,
        Client(cluster) as client,
    ):
        assert client.scheduler.address.startswith("tcp://127.0.0.1")
        yield client


def same(there: xr.Dataset, here: xr.Dataset) -> None:
    """To the last bit."""
    assert there.identical(here)
    for name, variable in here.variables.items():
        if variable.dtype != object:
            assert there[name].values.tobytes() == variable.values.tobytes(), name


def written(directory: Path) -> Any:
    return pyarrow.dataset.dataset(directory, format="parquet").to_table().to_pandas()


def test_same_rows_as_here(client: Client, paper: hs.Arm, here: xr.Dataset, tmp_path: Path) -> None:
    there = hs.sweep(paper, VARY, client=client)
    assert all(dask.is_dask_collection(there[name]) for name in there.data_vars)
    assert there.tip_x.data.npartitions >= 16
    same(there.compute(), here)
    # Dask's own work on it goes on on the cluster.
    assert float(there.tip_y.max().compute()) == float(here.tip_y.max())

    vary = {"arm.radius.tip": "0.8 mm:2 mm", "flow.speed": "0:1", "model.volume": ["planar", "none"]}
    sampled = hs.sweep(paper, vary, sample="lhs:600", seed=3, shapes=3, client=client)
    same(sampled.compute(), hs.sweep(paper, vary, sample="lhs:600", seed=3, shapes=3))

    directory = hs.sweep(paper, VARY, client=client, output=tmp_path / "rows")
    whole = tmp_path / "whole.parquet"
    hs.sweep(paper, VARY, output=whole)
    assert written(directory).equals(written(whole))
    with pytest.raises(FileExistsError, match="not empty"):
        hs.sweep(paper, VARY, client=client, output=directory)
    with pytest.raises(ValueError, match="chunk_seconds"):
        hs.sweep(paper, VARY, client=client, chunk_seconds=0.0)
    with pytest.raises(ValueError, match="resume"):
        hs.sweep(paper, VARY, client=client, resume=True, output=tmp_path / "other")


def finished(client: Client) -> int:
    """Chunks that are in the workers' memory."""
    held = client.run(lambda dask_worker: [str(key) for key in dask_worker.data])
    return sum("hydrostat-" in key and "-_" in key and "cost" not in key for keys in held.values() for key in keys)


# With no failure allowed the scheduler gives up what the dead worker had, and the sweep asks again.
@pytest.mark.parametrize(("client", "kind"), [(0, "dataset"), (3, "parquet")], indirect=["client"])
def test_a_worker_killed_in_mid_sweep(
    client: Client, paper: hs.Arm, here: xr.Dataset, tmp_path: Path, kind: str
) -> None:
    output = tmp_path / "rows" if kind == "parquet" else None
    outcome: list[Any] = []

    def run() -> None:
        outcome.append(hs.sweep(paper, VARY, client=client, output=output, chunk_seconds=0.1))

    before = client.run(os.getpid)
    thread = threading.Thread(target=run)
    thread.start()
    deadline = time.monotonic() + 60.0
    while finished(client) < 3 and time.monotonic() < deadline:
        time.sleep(0.01)
    chunks = finished(client)
    if output is not None:
        # What a worker leaves that is killed while it writes, which is rarely when this one is.
        (output / ".rows-000000000000.parquet.1-0.tmp").write_bytes(b"PAR1")
    os.kill(next(iter(before.values())), signal.SIGKILL)
    assert chunks >= 3 and thread.is_alive() and not outcome
    thread.join(timeout=120.0)
    assert not thread.is_alive() and len(outcome) == 1
    after = client.run(os.getpid)
    assert set(after.values()) != set(before.values()), "a worker was killed"
    if output is None:
        same(outcome[0].compute(), here)
        return
    rows = written(output)
    # Nothing lost, nothing doubled, nothing half-written beside.
    assert rows["row"].tolist() == list(range(6000))
    assert np.array_equal(rows["tip_x_m"], here.tip_x.values.ravel(), equal_nan=True)
    assert not list(output.glob(".*"))


def test_results_survive_a_worker(client: Client, paper: hs.Arm, here: xr.Dataset) -> None:
    there = hs.sweep(paper, VARY, client=client)
    os.kill(next(iter(client.run(os.getpid).values())), signal.SIGKILL)
    same(there.compute(), here)
