"""Sweeps on the cluster of a `distributed.Client`."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any
from uuid import uuid4

import dask.array as da
from dask.delayed import delayed
from distributed import as_completed
from distributed.scheduler import KilledWorker

from hydrostat import _inputs
from hydrostat._progress import Progress
from hydrostat.sweep import Columns, Plan, Values, Variable, assembled, columns_of, dataset, variables

if TYPE_CHECKING:
    import xarray as xr
    from distributed import Client, Future

#: Numbers of a chunk at most, 8 bytes each.
_LARGEST = 1 << 22
#: Chunks a thread at least, so that none waits long for the last one.
_EACH = 8
#: Tiles whose cost is measured, a thread.
_PROBES = 2

Tiles = tuple[int, int]


def _cost(plan: Plan, tile: int) -> float:
    """Seconds that a tile takes, on a worker."""
    native = plan.native()
    start = time.perf_counter()
    native.columns((tile, tile + 1), 1, None)
    return time.perf_counter() - start


def _columns(plan: Plan, tiles: Tiles) -> Columns:
    """The rows of some tiles, on a worker."""
    return columns_of(plan, tiles, 1, None)


def _written(plan: Plan, tiles: Tiles, output: str) -> tuple[int, int]:
    """Rows, and those with an answer, of a file that a worker has written whole."""
    return plan.native().write_tiles(tiles, output, 1, None)


class Run:
    """A sweep on a cluster. Rows come in tiles that do not depend on each other, and a chunk is some of them: where it is solved, and
    how often, changes nothing in its rows."""

    def __init__(self, client: Client, plan: Plan, seconds: float, retries: int, progress: bool | None) -> None:
        if not _inputs.number("chunk_seconds", seconds) > 0.0:
            raise ValueError(f"chunk_seconds: expected a number above zero, found {seconds}")
        if retries < 0:
            raise ValueError(f"retries: expected a number that is not negative, found {retries}")
        self._client = client
        self._plan = plan
        self._sweep = plan.native()
        self._seconds = seconds
        self._retries = retries
        self._progress = progress
        self._token = uuid4().hex[:12]
        self._probe = columns_of(plan, (0, 1), 1, None)

    def dataset(self, vary: dict[str, Values]) -> xr.Dataset:
        """All rows in the workers' memory, as Dask arrays."""
        chunks = self._chunks()
        futures = [self._submit(_columns, tiles) for tiles in chunks]
        self._wait(futures, chunks)
        sizes = [self._rows(tiles) for tiles in chunks]
        blocks = [delayed(future) for future in futures]

        def rows_of(variable: Variable) -> da.Array:
            template = assembled(self._probe, variable)
            parts = [
                da.from_delayed(delayed(assembled)(block, variable), (size, *template.shape[1:]), template.dtype)
                for block, size in zip(blocks, sizes, strict=True)
            ]
            return da.concatenate(parts)

        axes = self._sweep.axes
        values = {variable: rows_of(variable) for variable in variables(self._sweep, self._probe)}
        keys = {}
        if self._plan.sample is not None:
            own = [Variable(column, (column,), "", None, isinstance(self._probe[column], tuple)) for _, column, *_ in axes]
            keys = {variable.name: rows_of(variable).compute(scheduler=self._client) for variable in own}
        # Its graph holds the futures, and these the rows: variables are only cut out of them when they are asked for.
        return dataset(self._plan, vary, values, keys)

    def parquet(self, directory: FilePath) -> FilePath:
        """All rows as a directory of Parquet files, one a chunk, whose names are their first rows."""
        directory.mkdir(parents=True, exist_ok=True)
        if any(directory.iterdir()):
            raise FileExistsError(f"output: {directory} is not empty; remove it or choose another name")
        chunks = self._chunks()
        paths = [directory.resolve() / f"rows-{self._sweep.tile(tiles[0])[0]:012d}.parquet" for tiles in chunks]
        work = list(zip(chunks, paths, strict=True))
        futures = [self._submit(_written, tiles, str(path)) for tiles, path in work]
        self._wait(futures, chunks)
        written: Any = self._client.gather(futures)
        rows = sum(rows for rows, _ in written)
        # A worker that was killed while it wrote leaves what it had, under a hidden name of its own; others wrote those rows again.
        for leftover in directory.glob(".rows-*.tmp"):
            leftover.unlink(missing_ok=True)
        present = sorted(directory.glob("rows-*.parquet"))
        if rows != self._sweep.rows or [path.name for path in present] != [path.name for path in paths]:
            raise RuntimeError(f"output: {directory} has {len(present)} files of {rows} rows, where {self._sweep.rows} were solved")
        note = {"sweep": json.loads(self._sweep.note), "rows": rows, "files": [path.name for path in present]}
        (directory / "_hydrostat.json").write_text(json.dumps(note, indent=2), encoding="utf-8")
        return directory

    def _submit(self, work: Any, tiles: Tiles, *more: str) -> Future:
        # The names of functions that are pure follow from their arguments; two sweeps alike are two sweeps all the same.
        key = f"hydrostat-{self._token}-{work.__name__}-{tiles[0]}"
        return self._client.submit(work, self._plan, tiles, *more, key=key, retries=self._retries)

    def _rows(self, tiles: Tiles) -> int:
        return self._sweep.tile(tiles[1] - 1)[1] - self._sweep.tile(tiles[0])[0]

    def _chunks(self) -> list[Tiles]:
        """Equal shares of the tiles, each about as long as asked for."""
        tiles = self._sweep.tiles
        workers: Any = self._client.nthreads()
        threads = max(sum(workers.values()), 1)
        most = max(tiles // (_EACH * threads), 1)
        width = sum(len(variable.columns) for variable in variables(self._sweep, self._probe)) + 1
        largest = max(_LARGEST // width // max(self._rows((0, 1)), 1), 1)
        size = min(most, largest)
        if size > 1:
            count = min(_PROBES * threads, tiles)
            places = [(2 * k + 1) * tiles // (2 * count) for k in range(count)]
            keys = [f"hydrostat-{self._token}-cost-{place}" for place in places]
            probes = [
                self._client.submit(_cost, self._plan, place, key=key, retries=self._retries)
                for place, key in zip(places, keys, strict=True)
            ]
            cost = sum(future.result() for future in self._each(probes)) / count
            size = min(size, max(int(self._seconds / max(cost, 1e-9)), 1))
        return [(start, min(start + size, tiles)) for start in range(0, tiles, size)]

    def _wait(self, futures: list[Future], chunks: list[Tiles]) -> None:
        """Until all chunks are there."""
        rows = {future.key: self._rows(tiles) for future, tiles in zip(futures, chunks, strict=True)}
        with Progress(self._sweep.rows, self._progress) as bar:
            for future in self._each(futures):
                bar(bar.done + rows[future.key])

    def _each(self, futures: list[Future]) -> Iterator[Future]:
        """The futures as they end; one whose workers died too often for the scheduler is asked for again."""
        left = {future.key: self._retries for future in futures}
        try:
            completed = as_completed(futures)
            for future in completed:
                if future.status == "error" and isinstance(future.exception(), KilledWorker) and left[future.key]:
                    left[future.key] -= 1
                    future.retry()
                    completed.add(future)
                    continue
                if future.status != "finished":
                    future.result()
                yield future
        except BaseException:
            self._client.cancel(futures)
            raise
