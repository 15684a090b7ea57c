"""Cohorts: the same job on thousands of meshes, with results and reports in Parquet. A mesh that fails does not stop the others."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Literal, TypedDict

from ricci._signatures import takes
from ricci.cohorts.distances import ModuliDistances, classical_scaling, moduli_distances
from ricci.cohorts.engines import engine_of, inline
from ricci.cohorts.jobs import Job, Outcome, Row, content_of, one, repaired, signature
from ricci.errors import ArgumentError, ArgumentTypeError
from ricci.mesh import Mesh
from ricci.mesh import read as read_mesh

__all__ = [
    "CohortOptions",
    "CohortResult",
    "Job",
    "ModuliDistances",
    "Outcome",
    "Row",
    "classical_scaling",
    "cohort",
    "moduli_distances",
    "repaired",
]


class CohortOptions(TypedDict, total=False):
    """Options of the run of a cohort.

    Attributes
    ----------
    engine : Literal["inline", "processes", "dask"] | Any
        ``"inline"``, ``"processes"``, ``"dask"`` (a local cluster), or a `distributed.Client`; ``"processes"``.
    workers : int
        processes; one per core. A client has its own.
    read : Callable[[str], Any]
        makes of a path what the job is given; `ricci.read`. `ricci.cohorts.repaired` mends what needs no guess.
    retry : bool
        true if meshes that failed in an earlier run are tried again.
    progress : Callable[[int, int, Row], object]
        called as ``progress(done, total, row)`` after each mesh.
    """

    engine: Literal["inline", "processes", "dask"] | Any
    workers: int
    read: Callable[[str], Any]
    retry: bool
    progress: Callable[[int, int, Row], object]


@dataclass(frozen=True)
class CohortResult:
    """The tables of a cohort, as they are in its folder.

    Attributes
    ----------
    folder : Path
        with `results.parquet` and `reports.parquet`.
    results : Any
        a `pyarrow.Table`, one row for each mesh: path, content (a digest of the file's bytes), ok, error, status, element, index,
        amount, message, and the job's columns.
    reports : Any
        likewise: path, worker, seconds, and what else differs from run to run.

    Examples
    --------
    >>> found = ricci.cohort(["missing.obj"], ricci.Job("info"), "out", engine="inline")
    >>> [row["error"] for row in found.failures]
    ['FileMissingError']
    """

    folder: Path
    results: Any
    reports: Any

    @property
    def failures(self) -> list[dict[str, Any]]:
        """The rows with an error: path, error, status, element, index, amount, message."""
        names = ["path", "error", "status", "element", "index", "amount", "message"]
        wrong = [not ok for ok in self.results["ok"].to_pylist()]
        return self.results.select(names).filter(wrong).to_pylist()


def _is_done(path: str, told: Mapping[str, tuple[bool, str | None]], retry: bool) -> bool:
    """True of a mesh with a row that is of its file as it is now; of one that failed, unless such are tried again."""
    if path not in told:
        return False
    ok, content = told[path]
    if retry and not ok:
        return False
    # A file that only the workers can read has no content here, and is taken to be what it was.
    return content_of(path) in (None, content)


@takes(CohortOptions)
def cohort(
    paths: Iterable[str | os.PathLike[str]],
    job: Job | Callable[[Any], Outcome | Mapping[str, Any]],
    out: str | os.PathLike[str] = "cohort",
    *,
    engine: Literal["inline", "processes", "dask"] | Any = "processes",
    workers: int | None = None,
    read: Callable[[str], Any] | None = None,
    retry: bool = False,
    progress: Callable[[int, int, Row], object] | None = None,
) -> CohortResult:
    """Do one job on many meshes, into tables of the folder `out`.

    Each mesh is one row as soon as it is done; a run that was killed goes on where it stopped when it is called again, and its tables are
    those of a run in one go, but for the reports' seconds. What fails on one mesh, a worker's death included, is that row's error. A folder
    goes on with its own job alone: one whose code has changed, or a number that it uses, is refused there. A file whose bytes have changed
    since is done again; of a file that names others, such as a .gltf with its .bin, that are its own bytes alone.

    Parameters
    ----------
    paths : Iterable[str | os.PathLike[str]]
        mesh files, each once.
    job : Job | Callable[[Any], Outcome | Mapping[str, Any]]
        a `Job`, or a function that takes what `read` makes and returns columns by name, or an `Outcome`. One that is defined in a
        script or a notebook is sent to workers by value, which takes the package cloudpickle.
    out : str | os.PathLike[str]
        the folder.

    Raises
    ------
    ArgumentError
        a path that is there twice, a folder with rows of another job, no such engine.

    Examples
    --------
    >>> ricci.make("torus", n=8).write("ring.obj")
    >>> found = ricci.cohort(["ring.obj"], ricci.Job("info"), "out", engine="inline")
    >>> found.results["genus"].to_pylist()
    [1]
    """
    from ricci.cohorts.store import Store

    if workers is not None and (not isinstance(workers, int) or workers < 1):
        raise ArgumentError(f"workers is {workers!r}: a number of processes from 1, or None for one per core")
    if isinstance(paths, str | bytes | os.PathLike):
        raise ArgumentTypeError(f"paths are a list of files: [{os.fspath(paths)!r}]")
    if not callable(job):
        raise ArgumentTypeError(f"a job is a function of a mesh, or a Job, not {type(job).__name__}")
    names = [os.fspath(path) for path in paths]
    if len(set(names)) != len(names):
        twice = next(name for at, name in enumerate(names) if name in names[:at])
        raise ArgumentError(f"{twice} is there twice")
    start = engine_of(engine)
    reader = read or read_mesh
    by = "" if reader in (read_mesh, Mesh.read) else f" read by {signature(reader)}"
    store = Store(Path(out), signature(job) + by)
    told = store.done()
    todo = [name for name in names if not _is_done(name, told, retry)]
    done = len(names) - len(todo)
    work = partial(one, job, reader)
    # Closed however the run ends, so that no worker is left. Where nothing is to be done, no engine starts.
    with closing(start(work, todo, workers or os.cpu_count() or 1) if todo else inline(work, [], 1)) as rows:
        for row in rows:
            store.add(row)
            done += 1
            if progress is not None:
                progress(done, len(names), row)
    tables = store.finish(names)
    return CohortResult(Path(out), tables["results"], tables["reports"])
