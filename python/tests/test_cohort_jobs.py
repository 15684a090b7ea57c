"""Jobs of cohorts: those of scripts and notebooks are sent to workers, an edited one is another one, and no process is left behind."""

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest

import cohort_jobs
import ricci
from ricci.cohorts.fingerprint import digest
from ricci.cohorts.jobs import signature

pytest.importorskip("pyarrow")


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("meshes")
    for n in (3, 4, 5):
        ricci.make("disk", n=n).write(folder / f"disk{n}.obj")
    return sorted(map(str, folder.glob("*.obj")))


def run(text, folder, by_stdin=False):
    """What a script prints; by the standard input it has no file, as a notebook has none."""
    text = textwrap.dedent(text)
    if by_stdin:
        done = subprocess.run([sys.executable, "-"], input=text, cwd=folder, capture_output=True, text=True, timeout=120)
    else:
        (folder / "script.py").write_text(text)
        done = subprocess.run([sys.executable, "script.py"], cwd=folder, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout.split("\n")


SCRIPT = """
import ricci
SCALE = 10
def helper(x):
    return SCALE * x
def job(mesh):
    return {{"scaled": helper(mesh.n_faces)}}
if __name__ == "__main__":
    found = ricci.cohort({files!r}, job, {out!r}, engine={engine!r}, workers=2, read=lambda path: ricci.read(path))
    print(found.failures, found.results["scaled"].to_pylist())
"""
# No guard: the workers do not run the script.
NOTEBOOK = SCRIPT.replace('if __name__ == "__main__":\n', "if True:\n")


@pytest.mark.parametrize(("engine", "by_stdin"), [("processes", True), ("processes", False), ("dask", False)])
def test_jobs_of_scripts_and_notebooks_are_sent_by_value(files, tmp_path, engine, by_stdin):
    pytest.importorskip("cloudpickle")
    if engine == "dask":
        pytest.importorskip("distributed")
    text = SCRIPT if engine == "dask" else NOTEBOOK
    printed = run(text.format(files=files, out="out", engine=engine), tmp_path, by_stdin)
    assert printed[0] == f"[] {[10 * ricci.read(path).n_faces for path in files]}"


CELLS = [
    "import ricci\ndef job(mesh): return {'K': float(ricci.Metric(mesh).curvature.max())}",
    "[ricci.cohort(PATHS, job, 'out1').failures, ricci.cohort(PATHS, job, 'out2', engine='dask', workers=1).failures]",
    "from distributed import Client\nclient = Client(n_workers=1, threads_per_worker=1, dashboard_address=':0')",
    "found = ricci.cohort(PATHS, job, 'out3', engine=client)\n[found.failures, found.results.column_names[-1]]",
    "def job(mesh): return {'Kmin': float(ricci.Metric(mesh).curvature.min())}",
    "try:\n    print(ricci.cohort(PATHS, job, 'out3', engine=client))\nexcept ricci.ArgumentError as wrong:\n    print(wrong)",
    "client.close()",
]


def test_a_job_of_a_notebooks_cell_runs_on_every_engine(files, tmp_path):
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    for package in ("ipykernel", "pyarrow", "distributed", "cloudpickle"):
        pytest.importorskip(package)
    cells = [nbformat.v4.new_code_cell(cell) for cell in (f"PATHS = {files!r}", *CELLS)]
    book = nbformat.v4.new_notebook(cells=cells)
    nbclient.NotebookClient(book, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}).execute()
    told = [[out.get("text") or out["data"]["text/plain"] for out in cell.outputs if "text" in out or "data" in out] for cell in cells]
    assert told[2][-1] == "[[], []]"
    assert told[4] == ["[[], 'K']"]
    assert "has changed since" in told[6][0]


def test_a_job_that_cannot_be_sent_is_refused_at_once(files, tmp_path):
    held = threading.Lock()

    def job(mesh):
        return {"n": held}

    with pytest.raises(ricci.ArgumentError, match=r"cannot be sent to workers.*inline"):
        ricci.cohort(files, job, tmp_path / "out")
    assert not list((tmp_path / "out" / "rows").glob("*"))


def test_without_cloudpickle_a_notebooks_job_is_refused_in_words(files, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "cloudpickle", None)
    with pytest.raises(ricci.ArgumentError, match=r"pip install cloudpickle, put it into a module.*engine=.inline."):
        ricci.cohort(files, lambda mesh: {}, tmp_path / "out")


def test_workers_that_cannot_load_the_job_say_so(files, tmp_path, monkeypatch):
    (tmp_path / "gone.py").write_text("def job(mesh):\n    return {}\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    import gone

    (tmp_path / "gone.py").unlink()
    for cached in (tmp_path / "__pycache__").glob("gone*"):
        cached.unlink()
    with pytest.raises(ricci.ArgumentError, match=r"workers cannot load the job.*No module named 'gone'"):
        ricci.cohort(files, gone.job, tmp_path / "out", workers=1)


def made(source, **around):
    """The function `job` of a source text, as a notebook defines it again and again."""
    namespace = {"__name__": "__main__", "np": np, "ricci": ricci, **around}
    exec(compile(textwrap.dedent(source), "cell", "exec"), namespace)
    return namespace["job"]


PLAIN = "def job(mesh):\n    return {'a': 1}\n"
EDITED = {
    "a constant": ("def job(mesh):\n    return {'a': 2}\n", {}),
    "a name": ("def job(mesh):\n    return {'b': 1}\n", {}),
    "a default": ("def job(mesh, k=1):\n    return {'a': 1}\n", {}),
    "a global": ("def job(mesh):\n    return {'a': K}\n", {"K": 1}),
    "another global": ("def job(mesh):\n    return {'a': K}\n", {"K": 2}),
    "an array": ("def job(mesh):\n    return {'a': K}\n", {"K": np.r_[np.zeros(5000), 1.0]}),
    "another array": ("def job(mesh):\n    return {'a': K}\n", {"K": np.r_[np.zeros(5000), 2.0]}),
    "a helper": ("def f():\n    return 1\ndef job(mesh):\n    return {'a': f()}\n", {}),
    "another helper": ("def f():\n    return 2\ndef job(mesh):\n    return {'a': f()}\n", {}),
    "a closure": ("def outer(k):\n    def job(mesh):\n        return {'a': k}\n    return job\njob = outer(1)\n", {}),
    "another closure": ("def outer(k):\n    def job(mesh):\n        return {'a': k}\n    return job\njob = outer(2)\n", {}),
    "an inner function": ("def job(mesh):\n    return {'a': (lambda: 1)()}\n", {}),
    "another inner function": ("def job(mesh):\n    return {'a': (lambda: 2)()}\n", {}),
    "a lambda": ("job = lambda mesh: {'a': 1}\n", {}),
    "another lambda": ("job = lambda mesh: {'a': 3}\n", {}),
    "an object": ("class J:\n    k = 1\n    def __call__(self, mesh):\n        return {'a': self.k}\njob = J()\n", {}),
    "another object": ("class J:\n    k = 2\n    def __call__(self, mesh):\n        return {'a': self.k}\njob = J()\n", {}),
    "its state": ("class J:\n    k = 1\n    def __call__(self, mesh):\n        return {'a': self.k}\njob = J()\njob.k = 5\n", {}),
    "a partial": ("from functools import partial\ndef f(mesh, k):\n    return {'a': k}\njob = partial(f, k=1)\n", {}),
    "another partial": ("from functools import partial\ndef f(mesh, k):\n    return {'a': k}\njob = partial(f, k=2)\n", {}),
    "a mesh": ("def job(mesh):\n    return {'a': K}\n", {"K": ricci.make("disk", n=3)}),
    "another mesh": ("def job(mesh):\n    return {'a': K}\n", {"K": ricci.make("disk", n=4)}),
}


def test_every_edit_is_another_job():
    texts = {"plain": signature(made(PLAIN)), **{name: signature(made(source, **around)) for name, (source, around) in EDITED.items()}}
    assert len(set(texts.values())) == len(texts)


def test_the_same_code_is_the_same_job():
    for source, around in [(PLAIN, {}), *EDITED.values()]:
        assert signature(made(source, **around)) == signature(made("\n# A remark.\n\n" + source, **around))
    documented = PLAIN.replace("):\n", "):\n    '''Words.'''\n")
    assert signature(made(documented)) == signature(made(documented.replace("Words", "Others")))
    # Names of attributes are no globals.
    attribute = "def job(mesh):\n    return {'a': mesh.V}\n"
    assert signature(made(attribute, V=1)) == signature(made(attribute, V=2))


def test_a_digest_is_the_same_in_every_process(tmp_path):
    text = """
        import numpy as np, ricci
        from ricci.cohorts.jobs import signature
        NAMES = {"b", "a", "c", "d"}
        def helper(k):
            return helper(k - 1) if k else NAMES
        def job(mesh, kinds=frozenset("xyz")):
            return {"a": len(helper(3)), "b": mesh.n_faces in {1, 2, 3}, "c": np.linalg.norm(mesh.V)}
        print(signature(job))
        """
    assert len({run(text, tmp_path)[0] for _ in range(3)}) == 1


def test_a_folder_refuses_an_edited_job_or_reader(files, tmp_path):
    run_it = {"out": tmp_path / "out", "engine": "inline"}
    ricci.cohort(files[:1], made(PLAIN), **run_it)
    assert ricci.cohort(files, made(PLAIN), **run_it).results.column_names[-1] == "a"
    with pytest.raises(ricci.ArgumentError, match=r"its code, or what it uses, has changed since.*Name another folder"):
        ricci.cohort(files, made(EDITED["a name"][0]), **run_it)
    with pytest.raises(ricci.ArgumentError, match="rows of another job"):
        ricci.cohort(files, made(PLAIN), **run_it, read=lambda path: ricci.read(path))
    assert ricci.cohort(files, made(PLAIN), **run_it, read=ricci.Mesh.read).failures == []


def test_a_folder_without_rows_takes_any_job(files, tmp_path):
    held = threading.Lock()
    with pytest.raises(ricci.ArgumentError, match="cannot be sent"):
        ricci.cohort(files, lambda mesh: {"a": held}, tmp_path / "out")
    assert ricci.cohort(files, made(PLAIN), tmp_path / "out", engine="inline").failures == []


def test_workers_that_cannot_start_end_the_run(files, tmp_path, monkeypatch):
    monkeypatch.setenv("RICCI_LIBRARY", str(tmp_path / "nothing.so"))
    with pytest.raises(RuntimeError, match=r"a worker ended before it had loaded the job \(exit status 1\)"):
        ricci.cohort(files, cohort_jobs.counts, tmp_path / "out", workers=2)


def test_a_users_module_counts_with_its_text(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(tmp_path))
    (tmp_path / "a_users_own.py").write_text("K = 1\n")
    import a_users_own

    job = made("def job(mesh):\n    return {'a': own.K}\n", own=a_users_own)
    before = digest(job)
    (tmp_path / "a_users_own.py").write_text("K = 2\n")
    assert digest(job) != before


STOPPED = """
import os, signal, sys, threading, time
sys.path.insert(0, {tests!r})
import cohort_jobs, ricci
if __name__ == "__main__":
    try:
        ricci.cohort({files!r}, cohort_jobs.WorksLong("out/at"), "out", engine={engine!r}, workers=2)
    except KeyboardInterrupt:
        print("stopped", flush=True)
    time.sleep(60)
"""


def children(pid):
    """The processes that a process has started, and those that they have."""
    psutil = pytest.importorskip("psutil")
    return psutil.Process(pid).children(recursive=True)


def works(child):
    """True of a process that has not ended and is no helper of the standard library."""
    psutil = pytest.importorskip("psutil")
    try:
        return child.status() != psutil.STATUS_ZOMBIE and "resource_tracker" not in " ".join(child.cmdline())
    except psutil.Error:
        return False


def serving(process):
    """Its children that are at work."""
    return [child for child in children(process.pid) if works(child)]


def wait_for(condition, seconds=30):
    end = time.time() + seconds
    while not condition():
        assert time.time() < end, "this takes too long"
        time.sleep(0.02)


def hear_interrupts():
    """What a shell runs in the background ignores SIGINT, and so would its children."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
@pytest.mark.parametrize("engine", ["processes", "dask"])
def test_no_worker_outlives_a_run_that_is_stopped(files, tmp_path, engine, how):
    """For longer than a second, though they are in the middle of their meshes; what was done before is kept."""
    if engine == "dask":
        pytest.importorskip("distributed")
    script = tmp_path / "run.py"

    def kept():
        return list((tmp_path / "out" / "rows").glob("*.results"))

    script.write_text(STOPPED.format(tests=os.path.dirname(cohort_jobs.__file__), files=files, engine=engine))
    process = subprocess.Popen([sys.executable, str(script)], cwd=tmp_path, stdout=subprocess.PIPE, preexec_fn=hear_interrupts)
    try:
        wait_for(lambda: (len(list((tmp_path / "out" / "at").glob("*"))), len(kept())) == (2, 1))
        workers = serving(process)
        process.send_signal(how)
        wait_for(lambda: not any(map(works, workers)), 1)
        assert len(kept()) == 1
        if how == signal.SIGINT:
            assert process.stdout.readline() == b"stopped\n"
    finally:
        process.kill()
        process.wait()


INTERRUPTED = """
import ricci
from ricci.cohorts import Job
if __name__ == "__main__":
    try:
        ricci.cohort({paths!r}, Job("flow", {{"target": "auto:40"}}), "out", engine="processes", workers=2)
    except KeyboardInterrupt:
        print("stopped", flush=True)
    import time
    time.sleep(60)
"""


def test_no_worker_outlives_an_interrupt_in_the_library(tmp_path):
    psutil = pytest.importorskip("psutil")
    pytest.importorskip("pyarrow")
    ricci.make("torus", n=500).write(tmp_path / "large.obj")
    script = tmp_path / "script.py"
    script.write_text(INTERRUPTED.format(paths=[str(tmp_path / "large.obj")]))
    process = subprocess.Popen([sys.executable, str(script)], cwd=tmp_path, stdout=subprocess.PIPE, preexec_fn=hear_interrupts)
    try:
        at_work = []
        while not any(sum(child.cpu_times()[:2]) > 2 for child in at_work):
            assert process.poll() is None, "the run was over before it could be stopped"
            time.sleep(0.05)
            at_work = psutil.Process(process.pid).children()
        process.send_signal(signal.SIGINT)
        assert psutil.wait_procs(at_work, timeout=1)[1] == []
        assert process.stdout.readline() == b"stopped\n"
    finally:
        process.kill()
        process.wait()


def test_a_callback_that_raises_ends_the_workers(files, tmp_path):
    before = set(children(os.getpid()))

    def stop(*_):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        ricci.cohort(files, cohort_jobs.slow, tmp_path, engine="processes", workers=2, progress=stop)
    assert set(children(os.getpid())) <= before


def test_a_dead_worker_says_how_it_died(tmp_path):
    ricci.make("genus", genus=2, n=2).write(tmp_path / "genus2.obj")
    found = ricci.cohort([tmp_path / "genus2.obj"], cohort_jobs.dies_on_genus2, tmp_path / "out", workers=1)
    assert found.failures[0]["message"].startswith("the process that worked on it has died (signal SIGKILL")
