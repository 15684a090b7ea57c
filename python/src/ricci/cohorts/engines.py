"""Engines that do the work of a cohort: this process, several processes, or Dask. If a worker dies, only its current mesh fails."""

from __future__ import annotations

import multiprocessing
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from typing import Any

from ricci.cohorts.jobs import Row, failed
from ricci.errors import ArgumentError

Work = Callable[[str], Row]


class WorkerDied(Exception):
    """The process that was at a mesh ended before it had a row."""


def inline(work: Work, paths: Sequence[str], _: int) -> Iterator[Row]:
    """Does the work in this process, one mesh after the other."""
    return map(work, paths)


def _pool(workers: int) -> ProcessPoolExecutor:
    # A forked child would inherit locks that are held by threads which it does not have.
    return ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn"))


def _row(future: Future[Row], path: str) -> Row:
    """The row that a worker has sent. If the row could not be sent, that is the error of the mesh."""
    try:
        return future.result()
    except BrokenProcessPool:
        raise
    except Exception as wrong:
        return failed(path, wrong)


def _alone(work: Work, path: str) -> Row:
    """One mesh in a process of its own."""
    with _pool(1) as pool:
        try:
            return _row(pool.submit(work, path), path)
        except BrokenProcessPool:
            return failed(path, WorkerDied("the process that worked on it has died"))


def processes(work: Work, paths: Sequence[str], workers: int) -> Iterator[Row]:
    """Does the work in several processes. If one dies, the meshes under way are done again, each in a process of its own."""
    waiting = deque(paths)
    while waiting:
        running: dict[Future[Row], str] = {}
        with _pool(workers) as pool:
            try:
                while waiting or running:
                    while waiting and len(running) < 2 * workers:
                        running[pool.submit(work, waiting[0])] = waiting[0]
                        waiting.popleft()
                    for future in wait(running, return_when=FIRST_COMPLETED).done:
                        row = _row(future, running[future])
                        del running[future]
                        yield row
            except BrokenProcessPool:
                pass
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                raise
        for path in running.values():
            yield _alone(work, path)


def dask(work: Work, paths: Sequence[str], workers: int, client: Any = None) -> Iterator[Row]:
    """Does the work with the workers of a `distributed.Client`, or of a local cluster of processes that is made for it."""
    from distributed import Client, KilledWorker, LocalCluster, as_completed

    if client is None:
        with (
            LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=":0") as cluster,
            Client(cluster) as own,
        ):
            yield from dask(work, paths, workers, own)
        return
    futures = {client.submit(work, path, pure=False): path for path in paths}
    suspects = []
    for future in as_completed(list(futures)):
        path = futures.pop(future)
        wrong = future.exception()
        if isinstance(wrong, KilledWorker):
            suspects.append(path)
        else:
            yield future.result() if wrong is None else failed(path, wrong)
        future.release()
    # Dask blames every mesh that waited at a worker which died, so each is tried again by itself.
    for path in suspects:
        future = client.submit(work, path, pure=False)
        wrong = future.exception()
        yield future.result() if wrong is None else failed(path, WorkerDied(str(wrong)))


def engine_of(engine: Any) -> Callable[[Work, Sequence[str], int], Iterator[Row]]:
    """The engine of this name, or that of a `distributed.Client`.

    Raises:
        ArgumentError: there is none.
    """
    named = {"inline": inline, "processes": processes, "dask": dask}
    if isinstance(engine, str) and engine in named:
        return named[engine]
    if hasattr(engine, "submit") and hasattr(engine, "scheduler"):
        return lambda work, paths, workers: dask(work, paths, workers, engine)
    raise ArgumentError(f"engine {engine!r}: {', '.join(named)}, or a distributed.Client")
