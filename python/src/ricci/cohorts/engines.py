"""Engines that do the work of a cohort: this process, several processes, or Dask. If a worker dies, only its current mesh fails.

No engine leaves a process behind: workers end with the run, however it ends, and with this process, however that ends.
"""

from __future__ import annotations

import asyncio
import multiprocessing
import multiprocessing.spawn
import pickle
import signal
import subprocess
import sys
import time
from collections import deque
from collections.abc import Callable, Generator, Sequence
from contextlib import suppress
from multiprocessing.connection import wait
from typing import Any

from ricci.cohorts.jobs import Row, content_of, failed
from ricci.cohorts.worker import REFUSED, ROW
from ricci.errors import ArgumentError, ArgumentTypeError

Work = Callable[[str], Row]
Rows = Generator[Row, None, None]


class WorkerDied(Exception):
    """The process that was at a mesh ended before it had a row."""


def packed(work: Work) -> bytes:
    """The work as bytes for another process: by name where it can be imported there, else by value.

    Raises
    ------
    ArgumentError
        it cannot be sent; the message says what to do.
    """
    advice = 'put it into a module that can be imported, or take engine="inline"'
    try:
        by_name = pickle.dumps(work)
    except Exception:
        by_name = b"__main__"
    # A script is not imported by workers, and a notebook has no file that could be.
    if b"__main__" not in by_name:
        return by_name
    try:
        import cloudpickle
    except ImportError:
        raise ArgumentError(
            f"the job or its reader is defined in the script or notebook itself, or within a function: pip install cloudpickle, {advice}"
        ) from None
    try:
        return bytes(cloudpickle.dumps(work))
    except Exception as wrong:
        raise ArgumentError(f"the job or its reader cannot be sent to workers ({wrong}): {advice}") from wrong


def inline(work: Work, paths: Sequence[str], _: int) -> Rows:
    """Does the work in this process, one mesh after the other."""
    for path in paths:
        yield work(path)


class _Worker:
    """A process that does the work on one mesh at a time, and the mesh that it is at."""

    def __init__(self, payload: bytes) -> None:
        self.connection, theirs = multiprocessing.Pipe()
        self.path: str | None = None
        self.loaded = False
        serve = f"from ricci.cohorts.worker import serve; serve({theirs.fileno()})"
        # A new interpreter: a forked child would inherit locks that are held by threads which it does not have. The script that calls
        # this is not run again in it, so that it needs no guard.
        self.process = subprocess.Popen(
            [multiprocessing.spawn.get_executable() or sys.executable, "-c", f"import sys; sys.path[:] = {sys.path!r}; {serve}"],
            stdin=subprocess.DEVNULL,
            pass_fds=[theirs.fileno()],
        )
        theirs.close()
        self._send(payload)

    def begin(self, path: str) -> None:
        """Name the mesh that it is to work on."""
        self.path = path
        self._send(path.encode("utf-8", "surrogateescape"))

    def _send(self, message: bytes) -> None:
        # If it is dead, `answer` finds that.
        with suppress(OSError):
            self.connection.send_bytes(message)

    def answer(self) -> Row | None:
        """The row of its mesh, that it has died there included; None: it is ready for work.

        Raises
        ------
        ArgumentError
            it cannot load the work.
        RuntimeError
            it ended before it came to that, as where this package cannot be imported.
        """
        try:
            kind, content = pickle.loads(self.connection.recv_bytes())
        except (EOFError, OSError):
            ended = _how_ended(self.process.wait())
            if not self.loaded:
                raise RuntimeError(f"a worker ended before it had loaded the job ({ended}): what it wrote to stderr says why") from None
            path, self.path = self.path or "", None
            return failed(path, WorkerDied(f"the process that worked on it has died ({ended})"), content_of(path))
        self.loaded = True
        if kind == REFUSED:
            raise ArgumentError(f"the workers cannot load the job or its reader ({content}): it must be importable where they run")
        if kind == ROW:
            self.path = None
            row: Row = content
            return row
        return None

    def end(self) -> None:
        """End the process at once."""
        self.connection.close()
        self.process.kill()
        self.process.wait()


def _how_ended(code: int) -> str:
    """The end of a process in words."""
    if code >= 0:
        return f"exit status {code}"
    reason = ", as the system does to one that takes too much memory" if -code == signal.SIGKILL else ""
    return f"signal {signal.Signals(-code).name}{reason}"


def processes(work: Work, paths: Sequence[str], workers: int) -> Rows:
    """Does the work in several processes, each at one mesh. If one dies, another takes its place."""
    payload, waiting = packed(work), deque(paths)
    crew: list[_Worker] = []
    try:
        while waiting or crew:
            while waiting and len(crew) < workers:
                crew.append(_Worker(payload))
                crew[-1].begin(waiting.popleft())
            for worker in [worker for worker in crew if worker.connection in wait([w.connection for w in crew])]:
                row = worker.answer()
                if row is None:
                    continue
                if worker.process.poll() is None and waiting:
                    worker.begin(waiting.popleft())
                else:
                    crew.remove(worker)
                    worker.end()
                yield row
    finally:
        for worker in crew:
            worker.end()


async def _kill(nannies: Sequence[Any]) -> None:
    """Ends the worker of each nanny. A cluster that is closed waits for seconds until workers have come to the end of their meshes."""
    await asyncio.gather(*(nanny.kill(timeout=0.1, reason="the run has ended") for nanny in nannies))


def _in_own_cluster(work: Work, paths: Sequence[str], workers: int) -> Rows:
    """Does the work with a local cluster of processes that is made for it, and with another where none of its workers comes back."""
    from distributed import Client, LocalCluster

    left, lost = dict.fromkeys(paths), 0
    while left and lost < _MOST_LOST:
        with (
            LocalCluster(n_workers=min(workers, len(left)), threads_per_worker=1, dashboard_address=":0") as cluster,
            Client(cluster) as own,
        ):
            try:
                for row in _by_client(work, list(left), own, lambda: not any(nanny.is_alive() for nanny in cluster.workers.values())):
                    lost = 0
                    del left[row.path]
                    yield row
            except _ClusterLost:
                lost += 1
            except BaseException:
                cluster.sync(_kill, list(cluster.workers.values()))
                raise
    for path in left:
        yield failed(path, WorkerDied(f"the workers of {lost} clusters in turn have died and not come back"), content_of(path))


# Seconds without a process of a cluster after which it is given up: a worker that dies is started again within a second, but Dask forgets
# one that dies while it is still starting, and then waits for ever.
_PATIENCE = 5.0
# Clusters in turn that are lost without a row before the rest fails.
_MOST_LOST = 3


class _ClusterLost(Exception):
    """No worker of a cluster is left, and none is started again."""


def _each(futures: Sequence[Any], is_lost: Callable[[], bool]) -> Generator[tuple[Any, Row | BaseException], None, None]:
    """Futures in the order in which they are done, with their rows or what went wrong.

    A row comes with its future: asked for afterwards it would be waited for where the worker that has it dies in between.

    Raises
    ------
    _ClusterLost
        `is_lost` has said for some seconds that no worker is left, and none is done.
    """
    from distributed import as_completed

    completed, since = as_completed(futures, with_results=True, raise_errors=False), time.monotonic()
    while not completed.is_empty():
        if completed.has_ready():
            future, found = next(completed)
            yield future, found[1] if future.status == "error" else found
            since = time.monotonic()
        elif not is_lost():
            since = time.monotonic()
            time.sleep(0.01)
        elif time.monotonic() - since > _PATIENCE:
            raise _ClusterLost
        else:
            time.sleep(0.1)


def _by_client(work: Work, paths: Sequence[str], client: Any, is_lost: Callable[[], bool]) -> Rows:
    """Does the work with the workers of a client; `is_lost`: whether there are none and none will come."""
    from distributed import KilledWorker

    futures = {client.submit(work, path, pure=False): path for path in paths}
    suspects = []
    try:
        for future, found in _each(list(futures), is_lost):
            path = futures.pop(future)
            if isinstance(found, KilledWorker):
                suspects.append(path)
            else:
                yield found if isinstance(found, Row) else failed(path, found, content_of(path))
            future.release()
        # Dask blames every mesh that waited at a worker which died, so each is tried again by itself.
        for path in suspects:
            future = client.submit(work, path, pure=False)
            futures[future] = path
            ((_, found),) = _each([future], is_lost)
            del futures[future]
            yield found if isinstance(found, Row) else failed(path, WorkerDied(str(found)), content_of(path))
    finally:
        # Those that have not begun; what a worker of the caller's client is at, it brings to its end.
        if futures:
            client.cancel(list(futures))


def dask(work: Work, paths: Sequence[str], workers: int, client: Any = None) -> Rows:
    """Does the work with the workers of a `distributed.Client`, or of a local cluster of processes that is made for it."""
    packed(work)
    # A cluster of the caller's may have no workers for a while.
    yield from _in_own_cluster(work, paths, workers) if client is None else _by_client(work, paths, client, lambda: False)


def engine_of(engine: Any) -> Callable[[Work, Sequence[str], int], Rows]:
    """The engine of this name, or that of a `distributed.Client`.

    Raises
    ------
    ArgumentError
        there is none.
    """
    named = {"inline": inline, "processes": processes, "dask": dask}
    if isinstance(engine, str) and engine in named:
        return named[engine]
    if hasattr(engine, "submit") and hasattr(engine, "scheduler"):
        return lambda work, paths, workers: dask(work, paths, workers, engine)
    kind = ArgumentError if isinstance(engine, str) else ArgumentTypeError
    raise kind(f"engine {engine!r}: {', '.join(named)}, or a distributed.Client")
