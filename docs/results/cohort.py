#!/usr/bin/env python3
"""One job on every good mesh of the corpus, and on 1,000 made ones of which 30 are bad, in one go and killed on the way; writes the page.

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

MADE = 1000
SHAPES = [("torus", {"n": 40}), ("genus", {"genus": 2, "n": 3}), ("disk", {"n": 16}), ("sphere", {"n": 10}), ("annulus", {"n": 12})]
HEAD_MADE = ["engine", "workers", "killed at", "s", "failures", "SHA-256 of `results.parquet`"]
HEAD = ["workers", "s", "s in meshes", "s of the processor", "failures", "converged", "SHA-256 of `results.parquet`"]
SUFFIXES = {".obj", ".off", ".ply", ".stl", ".glb", ".gii"}


def cohort(names, out, workers, engine="dask"):
    return ricci.cohort(names, Job("flow"), out, engine=engine, workers=workers)


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


def killed(names, out, workers, engine="dask", share=0.5):
    """Starts the run in a process of its own and kills it, with its workers, when this share of the rows is there; how many there are then."""
    listed = out.with_suffix(".txt")
    listed.write_text("\n".join(names))
    process = subprocess.Popen(
        [sys.executable, __file__, "--run", str(out), str(workers), engine, str(listed)], start_new_session=True, stderr=subprocess.DEVNULL
    )
    count = lambda: len(list((out / "rows").glob("*.results")))
    while process.poll() is None and count() < share * len(names):
        time.sleep(0.02)
    if process.poll() is not None:
        sys.exit("the run was over before it could be killed")
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    return count()


def made(folder):
    """The files of the made meshes: five shapes with noise of their own, and of every 33 one that is bad in one of three ways."""
    folder.mkdir()
    names = []
    for k in range(MADE):
        shape, sizes = SHAPES[k % len(SHAPES)]
        path = folder / f"{k:04}.obj"
        ricci.change(ricci.make(shape, **sizes), "noise", amount=0.05, seed=k).write(path)
        if k % 33 == 7 and k // 33 < 30:
            text = path.read_text()
            lines = text.splitlines(keepends=True)
            # A face too many, an index that does not exist, and a file that ends in the middle of a number.
            path.write_text([text + lines[-1], text + "f 1 2 999999\n", text[: text.index("\nv ", len(text) // 4) + 4]][k // 33 % 3])
        names.append(str(path))
    return names


def of_made(place):
    """The rows of the table of made meshes."""
    names, rows = made(place / "made"), []
    for engine, workers, shares in (
        ("processes", 1, ()), ("processes", 2, ()), ("processes", 2, (0.3, 0.7)), ("dask", 2, ()), ("dask", 2, (0.3, 0.7)),
    ):
        out = place / f"{engine}{workers}{len(shares)}"
        at = [killed(names, out, workers, engine, share) for share in shares]
        start = time.perf_counter()
        found = cohort(names, out, workers, engine)
        seconds = time.perf_counter() - start
        rows.append([engine, workers, " and ".join(map(str, at)), f"{seconds:.1f}", len(found.failures), bits(out)])
    return rows


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
        generated = of_made(Path(place))
    same_made = len({row[-1] for row in generated}) == 1
    print(f"""# A cohort over the corpus

Made by `docs/results/cohort.py`: `ricci.cohort(paths, Job("flow"), out, engine="dask", workers=N)` on all {len(names)} good meshes, one thread in each
worker, on {platform.machine()} with {os.cpu_count()} cores. The load average of the minute before it began was {busy:.1f}: what else ran there is in the first two
columns of seconds, and hardly in those of the processor.

{page.table(HEAD, [cells for _, cells in rows])}

`s` is what the call takes, with the start of the cluster and of its workers; `s in meshes` the sum of what the reports of the meshes say. Two workers
are {rows[0][0] / rows[1][0]:.2f} times as fast as one.

Killed with its workers when {kept} of {len(names)} meshes were done, and called again: the rest took {resumed:.1f} s, and the table of {size / 1e6:.1f} MB
is {"the same, byte for byte" if same else "ANOTHER ONE"}. `python/run -m corpus` tests that as well, with plain processes in place of Dask.

## 1,000 made meshes, 30 of them bad

Five shapes of some hundred vertices with noise of their own; of the bad ones ten have a face twice, ten name a vertex that does not exist and ten
end in the middle. A run that was killed twice was started twice more, each time after the kill; `s` is what its last part takes.

{page.table(HEAD_MADE, generated)}

The tables are {"the same, byte for byte" if same_made else "NOT THE SAME"}. Two processes are {float(generated[0][3]) / float(generated[1][3]):.2f} times as fast as one.""")
    sys.exit(not (same and same_made))


if __name__ == "__main__":
    if sys.argv[1:2] == ["--run"]:
        cohort(Path(sys.argv[5]).read_text().split("\n"), Path(sys.argv[2]), int(sys.argv[3]), sys.argv[4])
    else:
        main()
