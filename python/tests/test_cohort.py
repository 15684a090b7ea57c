"""Cohorts: the same table by every engine, from every interruption; failures are rows."""

import hashlib
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import cohort_jobs
import ricci
from ricci.cohorts import Job, repaired

pq = pytest.importorskip("pyarrow.parquet")


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Nine meshes of five topologies, and a file that is none."""
    folder = tmp_path_factory.mktemp("meshes")
    shapes = {
        "torus": ricci.make("torus", a=2, b=0.8, n=24, m=12),
        "thin": ricci.make("torus", a=2, b=0.3, n=30, m=8),
        "genus2": ricci.make("genus", genus=2, n=2),
        "genus3": ricci.make("genus", genus=3, n=2),
        "disk": ricci.make("disk", n=6),
        "sphere": ricci.make("sphere", n=4),
        "pants": ricci.change(ricci.make("sphere", n=8), "punch", count=3),
        "ring": ricci.make("annulus", a=1, b=2, n=4, m=16),
        "knot": ricci.make("knot", a=2, b=0.8, c=0.3, p=2, q=3, n=60, m=8),
    }
    for name, mesh in shapes.items():
        mesh.write(folder / f"{name}.obj")
    (folder / "broken.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 7\n")
    (folder / "twice.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\n")
    return sorted(folder.glob("*.obj"))


def contents(folder):
    return (folder / "results.parquet").read_bytes()


@pytest.fixture(scope="module")
def whole(files, tmp_path_factory):
    """The cohort in one go."""
    out = tmp_path_factory.mktemp("whole")
    return ricci.cohort(files, Job("flow"), out, engine="inline")


def test_every_mesh_is_a_row_and_failures_name_what_is_wrong(files, whole):
    table = whole.results
    assert table["path"].to_pylist() == [str(path) for path in files]
    assert [row["error"] for row in whole.failures] == ["MeshError", "MeshError"]
    broken = next(row for row in whole.failures if row["path"].endswith("broken.obj"))
    assert broken["status"] == "DEFECTS"
    assert "vertex 6" in broken["message"]
    torus = next(row for row in table.to_pylist() if row["path"].endswith("torus.obj"))
    assert (torus["genus"], torus["converged"], torus["stop_reason"]) == (1, True, "converged")
    assert torus["factor"] == ricci.flow(str(next(p for p in files if p.name == "torus.obj"))).factor.tolist()
    assert set(whole.reports.column_names) > {"path", "worker", "seconds", "seconds_total"}
    assert pq.read_table(whole.folder / "results.parquet").schema == table.schema


@pytest.mark.parametrize("engine", ["processes", "dask"])
def test_engines_give_the_same_file(files, whole, tmp_path, engine):
    if engine == "dask":
        pytest.importorskip("distributed")
    told = []
    found = ricci.cohort(files, Job("flow"), tmp_path, engine=engine, workers=2, progress=lambda *at: told.append(at[:2]))
    assert contents(tmp_path) == contents(whole.folder)
    assert told == [(k + 1, len(files)) for k in range(len(files))]
    assert len(set(found.reports["worker"].to_pylist())) == 2


def test_a_client_of_the_callers_is_used_and_left_open(files, whole, tmp_path):
    distributed = pytest.importorskip("distributed")
    with distributed.Client(n_workers=1, threads_per_worker=2, processes=False, dashboard_address=":0") as client:
        ricci.cohort(files, Job("flow"), tmp_path, engine=client)
        assert client.submit(sum, [1, 2]).result() == 3
    assert contents(tmp_path) == contents(whole.folder)


KILLED = """
import sys
sys.path.insert(0, {tests!r})
import cohort_jobs, ricci
if __name__ == "__main__":
    ricci.cohort({files!r}, cohort_jobs.slow, {out!r}, engine={engine!r}, workers=2)
"""


@pytest.mark.parametrize("engine", ["inline", "processes", "dask"])
def test_a_run_that_was_killed_goes_on_to_the_same_table(files, tmp_path, engine):
    if engine == "dask":
        pytest.importorskip("distributed")
    names = [str(path) for path in files]
    script = tmp_path / "run.py"
    script.write_text(KILLED.format(tests=os.path.dirname(cohort_jobs.__file__), files=names, out=str(tmp_path / "out"), engine=engine))
    process = subprocess.Popen([sys.executable, str(script)], start_new_session=True)
    rows = tmp_path / "out" / "rows"
    while process.poll() is None and (not rows.exists() or len(list(rows.glob("*.results"))) < 4):
        time.sleep(0.01)
    assert process.poll() is None, "the run was over before it could be killed"
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    before = {path: path.stat().st_mtime_ns for path in rows.glob("*.results")}
    assert 4 <= len(before) < len(files)
    again = []
    ricci.cohort(names, cohort_jobs.slow, tmp_path / "out", engine=engine, workers=2, progress=lambda *at: again.append(at[2].path))
    assert len(again) == len(files) - len(before)
    ricci.cohort(names, cohort_jobs.slow, tmp_path / "once", engine="inline")
    assert contents(tmp_path / "out") == contents(tmp_path / "once")
    assert not rows.exists()


def test_a_finished_cohort_takes_more_meshes(files, whole, tmp_path):
    ricci.cohort(files[:4], Job("flow"), tmp_path, engine="inline")
    done = []
    ricci.cohort(files, Job("flow"), tmp_path, engine="inline", progress=lambda *at: done.append(at[2].path))
    assert done == [str(path) for path in files[4:]]
    assert contents(tmp_path) == contents(whole.folder)


@pytest.mark.parametrize("engine", ["processes", "dask"])
def test_a_worker_that_dies_costs_one_mesh(files, tmp_path, engine):
    if engine == "dask":
        pytest.importorskip("distributed")
    found = ricci.cohort(files, cohort_jobs.dies_on_genus2, tmp_path, engine=engine, workers=2)
    errors = {os.path.basename(row["path"]): row["error"] for row in found.failures}
    assert errors == {"broken.obj": "MeshError", "twice.obj": "MeshError", "genus2.obj": "WorkerDied"}


def test_a_cluster_whose_workers_do_not_come_back_is_replaced(files, whole, tmp_path, monkeypatch):
    """Dask does not start a worker again that dies while it is starting: here, none of the first that die."""
    distributed = pytest.importorskip("distributed")
    exits, again = [], distributed.Nanny._on_worker_exit

    async def forgotten(nanny, code):
        exits.append(code)
        if code == 0 or len(exits) > 2:
            await again(nanny, code)

    monkeypatch.setattr(distributed.Nanny, "_on_worker_exit", forgotten)
    found = ricci.cohort(files, cohort_jobs.dies_on_genus2, tmp_path, engine="dask", workers=2)
    assert len(exits) > 2
    assert {row["error"] for row in found.failures} == {"MeshError", "WorkerDied"}
    assert len(found.results) == len(files)


@pytest.mark.parametrize("engine", ["inline", "processes", "dask"])
def test_results_that_cannot_be_kept_are_failures(files, tmp_path, engine):
    some = [path for path in files if path.stem in ("torus", "genus2", "genus3")]
    found = ricci.cohort(some, cohort_jobs.odd_results, tmp_path, engine=engine, workers=1)
    assert found.results["ok"].to_pylist() == [False, False, True]
    assert [(row["error"], row["message"][-6:]) for row in found.failures] == [("TypeError", "t lock"), ("TypeError", "object")]


@pytest.mark.parametrize("engine", ["inline", "processes"])
def test_a_run_that_is_stopped_keeps_its_rows(files, whole, tmp_path, engine):
    def stop(done, total, row):
        if done == 5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ricci.cohort(files, Job("flow"), tmp_path, engine=engine, workers=2, progress=stop)
    assert len(list((tmp_path / "rows").glob("*.results"))) == 5
    ricci.cohort(files, Job("flow"), tmp_path, engine=engine, workers=2)
    assert contents(tmp_path) == contents(whole.folder)


def test_jobs_are_told_apart_by_every_number():
    long = [Job("flow", {"target": np.r_[np.zeros(2000), x]}) for x in (1.0, 2.0)]
    assert str(long[0]) != str(long[1])


def test_failures_are_tried_again_when_that_is_asked(tmp_path):
    path = tmp_path / "later.obj"
    ricci.make("disk", n=3).write(path)
    run = {"engine": "inline", "read": cohort_jobs.fails_once}
    assert len(ricci.cohort([path], cohort_jobs.counts, tmp_path / "out", **run).failures) == 1
    (tmp_path / "now").touch()
    assert len(ricci.cohort([path], cohort_jobs.counts, tmp_path / "out", **run).failures) == 1
    assert ricci.cohort([path], cohort_jobs.counts, tmp_path / "out", retry=True, **run).failures == []


@pytest.mark.parametrize("kind", ["info", "uniformize", "circles", "forms", "structure", "spline"])
def test_every_kind_of_job_has_its_columns(files, tmp_path, kind):
    some = [path for path in files if path.stem in ("torus", "pants", "genus2")]
    options = {"spline": {"rounds": 1, "degree": 2}, "structure": {"kind": "affine"}}.get(kind, {})
    found = ricci.cohort(some, Job(kind, options), tmp_path, engine="inline")
    assert len(found.results) == 3
    assert any(found.results["ok"].to_pylist())
    wanted = {"uniformize": "modulus", "circles": "circles", "forms": "periods", "structure": "holonomy", "spline": "fit_rms"}
    assert wanted.get(kind, "genus") in found.results.column_names


def test_a_mesh_that_takes_too_long_is_given_up(files, tmp_path):
    path = tmp_path / "large.obj"
    ricci.make("torus", a=2, b=0.8, n=300, m=150).write(path)
    found = ricci.cohort([path], Job("flow", seconds=0.01), tmp_path / "out", engine="inline")
    assert [row["error"] for row in found.failures] == ["Cancelled"]


def test_files_with_defects_are_mended_on_the_way(files, tmp_path):
    twice = [path for path in files if path.stem == "twice"]
    assert ricci.cohort(twice, Job("info"), tmp_path, engine="inline", read=repaired).failures == []


def test_what_cannot_be_a_cohort_is_refused(files, tmp_path):
    ricci.cohort(files[:2], Job("info"), tmp_path, engine="inline")
    with pytest.raises(ricci.ArgumentError, match="another job"):
        ricci.cohort(files[:2], Job("flow"), tmp_path, engine="inline")
    with pytest.raises(ricci.ArgumentError, match="twice"):
        ricci.cohort([files[0], files[0]], Job("info"), tmp_path)
    with pytest.raises(ricci.ArgumentError, match="inline, processes, dask"):
        ricci.cohort(files, Job("info"), tmp_path, engine="threads")


def test_nothing_is_a_cohort_too(tmp_path):
    assert len(ricci.cohort([], Job("info"), tmp_path, engine="inline").results) == 0


def test_a_file_that_has_changed_is_done_again(tmp_path):
    kept, edited = tmp_path / "kept.obj", tmp_path / "edited.obj"
    for path in (kept, edited):
        ricci.make("disk", n=3).write(path)
    run = {"engine": "inline", "out": tmp_path / "out"}
    first = ricci.cohort([kept, edited], Job("info"), **run).results.to_pylist()
    assert first[0]["content"] == first[1]["content"] == hashlib.blake2b(kept.read_bytes(), digest_size=16).hexdigest()
    ricci.make("disk", n=5).write(edited)
    done = []
    again = ricci.cohort([kept, edited], Job("info"), **run, progress=lambda *at: done.append(at[2].path)).results.to_pylist()
    assert done == [str(edited)]
    assert again[0] == first[0]
    assert [row["n_faces"] for row in again] == [ricci.read(kept).n_faces, ricci.read(edited).n_faces]
    # What was absent is done when it is there; what is gone keeps its row.
    late = tmp_path / "late.obj"
    missing = ricci.cohort([late], Job("info"), **run).results.to_pylist()[0]
    assert (missing["error"], missing["content"]) == ("FileMissingError", None)
    ricci.make("disk", n=4).write(late)
    assert ricci.cohort([late], Job("info"), **run).results["ok"].to_pylist()[0]
    late.unlink()
    assert ricci.cohort([late], Job("info"), **run).failures == []


@pytest.mark.parametrize("engine", ["processes", "dask"])
def test_where_nothing_is_to_be_done_nothing_starts(files, whole, tmp_path, engine, monkeypatch):
    if engine == "dask":
        distributed = pytest.importorskip("distributed")

        def none(*_, **__):
            raise AssertionError("a cluster was started")

        monkeypatch.setattr(distributed, "LocalCluster", none)
    monkeypatch.setattr(subprocess, "Popen", None)
    run = {"engine": engine, "workers": 2}
    assert len(ricci.cohort([], Job("flow"), tmp_path, **run).results) == 0
    assert len(ricci.cohort(files, Job("flow"), whole.folder, **run).failures) == len(whole.failures)


@pytest.mark.corpus
def test_the_corpus_killed_half_way_and_resumed(corpus, tmp_path, capsys):
    """All good meshes by one worker and by two of Dask, and killed half way and resumed by processes: the same bytes."""
    names = [str(path) for path in corpus]
    for workers in (1, 2):
        start = time.perf_counter()
        found = ricci.cohort(names, Job("flow"), tmp_path / str(workers), engine="dask", workers=workers)
        seconds = time.perf_counter() - start
        with capsys.disabled():
            print(f"\n{len(names)} meshes, Dask with {workers} workers: {seconds:.1f} s, {len(found.failures)} failures")
        assert all(found.results["converged"].to_pylist())
    script = tmp_path / "run.py"
    script.write_text(
        "import ricci\nfrom ricci.cohorts import Job\n"
        f"if __name__ == '__main__':\n    ricci.cohort({names!r}, Job('flow'), {str(tmp_path / 'out')!r}, workers=2)\n"
    )
    process = subprocess.Popen([sys.executable, str(script)], start_new_session=True)
    rows = tmp_path / "out" / "rows"
    while process.poll() is None and (not rows.exists() or len(list(rows.glob("*.results"))) < len(names) // 2):
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    assert len(names) // 2 <= len(list(rows.glob("*.results"))) < len(names)
    ricci.cohort(names, Job("flow"), tmp_path / "out", workers=2)
    assert contents(tmp_path / "out") == contents(tmp_path / "1") == contents(tmp_path / "2")
