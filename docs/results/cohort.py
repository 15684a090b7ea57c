#!/usr/bin/env python3
"""One job on every good mesh of the corpus: by one worker of Dask, by two, and killed half way and resumed by two; writes the page.

usage: target/python/fresh/bin/python docs/results/cohort.py [CORPUS] > docs/results/cohort.md     (after: python/run, which makes that Python)
"""
import hashlib
import os
import platform
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import ricci
from ricci.cohorts import Job

import page

HEAD = ["workers", "s", "s in meshes", "s of the processor", "failures", "converged", "SHA-256 of `results.parquet`"]
SUFFIXES = {".obj", ".off", ".ply", ".stl", ".glb", ".gii"}


def cohort(names, out, workers):
    return ricci.cohort(names, Job("flow"), out, engine="dask", workers=workers)


def processor():
    """Seconds of the processor that processes have taken which were started here and are over."""
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    return spent.ru_utime + spent.ru_stime


def bits(out):
    return hashlib.sha256((out / "results.parquet").read_bytes()).hexdigest()[:16]


def measured(names, out, workers):
    """The cells of a whole run."""
    start, before = time.perf_counter(), processor()
    found = cohort(names, out, workers)
    seconds, spent = time.perf_counter() - start, processor() - before
    inside = sum(found.reports["seconds"].to_pylist())
    converged = sum(map(bool, found.results["converged"].to_pylist()))
    return seconds, [f"{seconds:.1f}", f"{inside:.1f}", f"{spent:.1f}", len(found.failures), converged, bits(out)]


def killed(names, out, workers):
    """Starts the run in a process of its own and kills it, with its workers, when half of the rows are there; how many there are then."""
    arguments = [sys.executable, __file__, "--run", str(out), str(workers), *names]
    process = subprocess.Popen(arguments, start_new_session=True, stderr=subprocess.DEVNULL)
    count = lambda: len(list((out / "rows").glob("*.results")))
    while process.poll() is None and count() < len(names) // 2:
        time.sleep(0.02)
    if process.poll() is not None:
        sys.exit("the run was over before it could be killed")
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    return count()


def main():
    folder = Path(page.corpus)
    names = sorted(str(path) for path in folder.glob("*.*") if path.suffix in SUFFIXES)
    busy = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as place:
        rows = []
        for workers in (1, 2):
            seconds, cells = measured(names, Path(place, str(workers)), workers)
            rows.append((seconds, [workers, *cells]))
        out = Path(place, "killed")
        kept = killed(names, out, 2)
        start = time.perf_counter()
        cohort(names, out, 2)
        resumed = time.perf_counter() - start
        same = len({bits(Path(place, which)) for which in ("1", "2", "killed")}) == 1
        size = (out / "results.parquet").stat().st_size
    print(f"""# A cohort over the corpus

Made by `docs/results/cohort.py`: `ricci.cohort(paths, Job("flow"), out, engine="dask", workers=N)` on all {len(names)} good meshes, one thread in each
worker, on {platform.machine()} with {os.cpu_count()} cores. The load average of the minute before it began was {busy:.1f}: what else ran there is in the first two
columns of seconds, and hardly in those of the processor.

{page.table(HEAD, [cells for _, cells in rows])}

`s` is what the call takes, with the start of the cluster and of its workers; `s in meshes` the sum of what the reports of the meshes say. Two workers
are {rows[0][0] / rows[1][0]:.2f} times as fast as one.

Killed with its workers when {kept} of {len(names)} meshes were done, and called again: the rest took {resumed:.1f} s, and the table of {size / 1e6:.1f} MB
is {"the same, byte for byte" if same else "ANOTHER ONE"}. `python/run -m corpus` tests that as well, with plain processes in place of Dask.""")
    sys.exit(not same)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--run"]:
        cohort(sys.argv[4:], Path(sys.argv[2]), int(sys.argv[3]))
    else:
        main()
