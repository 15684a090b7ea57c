"""Jobs of the cohort tests, in a module of their own so that workers can import them."""

import os
import signal
import threading
import time
from pathlib import Path

import ricci


def counts(mesh):
    return {"vertices": mesh.n_vertices, "euler": mesh.euler}


def slow(mesh):
    time.sleep(0.15)
    return ricci.cohorts.Outcome(counts(mesh), {"at": time.time()})


def dies_on_genus2(mesh):
    """The worker is killed as the system kills one that takes too much memory."""
    if mesh.genus == 2:
        os.kill(os.getpid(), signal.SIGKILL)
    return counts(mesh)


def fails_once(path):
    """A reader that fails on `later.obj` until a file beside it exists."""
    if Path(path).name == "later.obj" and not (Path(path).parent / "now").exists():
        raise RuntimeError("not yet")
    return ricci.read(path)


def odd_results(mesh):
    """A result that cannot be a column, or that cannot be sent between processes."""
    if mesh.genus == 2:
        return {"what": threading.Lock()}
    return {"what": object()} if mesh.genus == 3 else counts(mesh)


class WorksLong:
    """A job that is in the middle of every mesh but the smallest for a long time, and says so in files of this folder."""

    def __init__(self, folder):
        self.folder = Path(folder).resolve()
        self.folder.mkdir(parents=True, exist_ok=True)

    def __call__(self, mesh):
        if mesh.n_vertices > 37:
            (self.folder / str(mesh.n_vertices)).touch()
            end = time.time() + 60
            while time.time() < end:
                time.sleep(0.01)
        return counts(mesh)
