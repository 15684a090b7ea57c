"""Long calls: they show progress, stop when they are told, and leave the interpreter to other threads."""

import gc
import logging
import os
import signal
import threading
import time
import weakref

import numpy as np
import pytest

import ricci


@pytest.fixture(scope="module")
def large():
    """A metric whose flow takes long enough to be watched."""
    return ricci.metric(ricci.change(ricci.make("torus", a=2, b=0.8, n=400, m=200), "noise", amount=0.2, seed=1))


def when_it_flows(control, act):
    """Do `act` from another thread as soon as the call with this control is at its flow."""

    def wait():
        while control.progress()[0] != "flow":
            time.sleep(0.001)
        act()

    threading.Thread(target=wait).start()


def test_progress_is_told(large):
    told = []
    flat = large.flow("uniform", lambda stage, fraction: told.append((stage, fraction)))
    assert flat.converged
    assert any(stage == "flow" for stage, _ in told)
    fractions = [fraction for _, fraction in told]
    assert fractions == sorted(fractions)
    assert 0 <= fractions[0] <= fractions[-1] == 1


def test_reading_writing_and_fits_have_progress(tmp_path, torus):
    told = []
    path = tmp_path / "torus.obj"
    torus.write(path, progress=lambda stage, fraction: told.append((stage, fraction)))
    assert told[-1] == ("write", 1)
    ricci.read(path, lambda stage, fraction: told.append((stage, fraction)))
    assert told[-1] == ("build", 1)
    told.clear()
    ricci.Spline.of_mesh(ricci.make("torus", a=2, b=0.8, n=30, m=20), lambda stage, fraction: told.append(fraction), rounds=2)
    assert told == sorted(told)
    assert told[-1] == 1
    control = ricci.Control()
    control.cancel()
    with pytest.raises(ricci.Cancelled):
        ricci.read(path, control)
    assert ricci.read(path).summary.n_faces == torus.summary.n_faces


def test_several_calls_fill_one_bar(torus):
    control = ricci.Control()
    control.set_part(0, 0.5)
    flat = ricci.metric(torus).flow(progress=control)
    assert control.progress()[1] == 0.5
    control.set_part(0.5, 1)
    ricci.layout(flat, progress=control)
    assert control.progress()[1] == 1
    with pytest.raises(ricci.ArgumentError):
        control.set_part(0.5, 0.25)


LONG = {
    "flow": lambda m, p: ricci.flow(m["genus2"], progress=p),
    "layout": lambda m, p: ricci.layout(m["flat"], p),
    "uniformize": lambda m, p: ricci.uniformize(m["genus2"], progress=p),
    "sphere": lambda m, p: ricci.uniformize(m["sphere"], progress=p),
    "cover": lambda m, p: ricci.cover(m["genus2"], progress=p),
    "within": lambda m, p: ricci.cover(m["genus2"], progress=p, radius=2.0),
    "depth": lambda m, p: ricci.cover(m["genus2"], progress=p, depth=1),
    "match": lambda m, p: ricci.match(m["sphere"], m["finer"], p),
    "match of genus 2": lambda m, p: ricci.match(m["genus2"], ricci.make("genus", genus=2, n=3), p),
    "spline": lambda m, p: ricci.spline(m["sphere"], progress=p, rounds=2),
    "flat metric": lambda m, p: ricci.flat_metric(m["genus2"], progress=p),
    "bicubic": lambda m, p: ricci.bicubic(m["spline"], p),
    "structures": lambda m, p: ricci.structures(m["genus2"], progress=p),
    "seamless": lambda m, p: ricci.seamless(m["genus2"], progress=p),
    "circles": lambda m, p: ricci.circles(m["pants"], progress=p),
    "flatten": lambda m, p: ricci.flatten(m["pants"], progress=p),
    "flatten_darts": lambda m, p: ricci.flatten_darts(m["pants"], progress=p, strain_warp=0.01, most=1),
    "flatten_sphere": lambda m, p: ricci.flatten_sphere(m["sphere"], progress=p),
    "brain": lambda m, p: ricci.brain(m["sphere"], progress=p),
}


@pytest.fixture(scope="module")
def surfaces(genus2, pants):
    sphere = ricci.make("sphere", n=8)
    made = {"genus2": genus2, "pants": pants, "sphere": sphere, "finer": ricci.make("sphere", n=9)}
    return made | {"flat": ricci.flow(genus2), "spline": ricci.spline(sphere, rounds=2)}


@pytest.mark.parametrize("name", LONG)
def test_progress_never_goes_back_and_ends_at_1(surfaces, name):
    control, told = ricci.Control(), []
    over = threading.Event()

    def look():
        while not over.is_set():
            told.append(control.progress()[1])
            time.sleep(0.0005)

    looking = threading.Thread(target=look)
    looking.start()
    try:
        LONG[name](surfaces, control)
    finally:
        over.set()
        looking.join()
    told.append(control.progress()[1])
    assert told == sorted(told)
    assert told[-1] == 1
    heard = []
    LONG[name](surfaces, lambda stage, fraction: heard.append(fraction))
    assert heard == sorted(heard)
    assert heard[-1] == 1


def test_parts_lie_in_the_part_of_the_caller(genus2):
    control = ricci.Control()
    control.set_part(0.25, 0.75)
    ricci.structures(genus2, progress=control)
    assert control.progress()[1] == 0.75
    control.set_part(0, 1)


def test_a_control_cancels_from_another_thread(large):
    control = ricci.Control()
    when_it_flows(control, control.cancel)
    with pytest.raises(ricci.Cancelled) as stopped:
        large.flow("uniform", control)
    assert stopped.value.status is ricci.Status.CANCELLED
    assert control.since_cancel() is not None
    with pytest.raises(ricci.Cancelled):
        ricci.uniformize(large.triangulation, progress=control)
    assert ricci.Control().since_cancel() is None


def test_what_a_callback_raises_stops_the_call(large):
    class Enough(Exception):
        pass

    def callback(stage, fraction):
        raise Enough

    control = ricci.Control(callback)
    with pytest.raises(Enough):
        large.flow("uniform", control)
    assert control.since_cancel() is not None


@pytest.fixture
def handled():
    """Python's own way with Ctrl-C, which it leaves out where it is started in the background."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("handled")
def test_ctrl_c_stops_a_call(large):
    """The signal of Ctrl-C comes while the library computes; the call ends and its inputs are as they were."""
    before, control = large.u.copy(), ricci.Control()
    when_it_flows(control, lambda: os.kill(os.getpid(), signal.SIGINT))
    with pytest.raises(KeyboardInterrupt):
        large.flow("uniform", control)
    assert control.since_cancel() is not None
    assert np.array_equal(large.u, before)
    assert large.summary.n_vertices == 80_000


def test_arrays_of_a_call_that_is_given_up_live_on():
    """After a second Ctrl-C nobody waits for the call, which may still write: what it was handed keeps its arrays."""
    from ricci._call import pointer

    array = np.zeros(1000)
    known, handed = weakref.ref(array), pointer(array)
    del array
    gc.collect()
    assert known() is not None
    assert len(handed) == 1000
    del handed
    gc.collect()
    assert known() is None


def test_handles_are_freed_at_once(genus2):
    """Without a search for cycles, which knows nothing of the library's memory."""
    gc.collect()
    gc.disable()
    try:
        flat = ricci.flow(genus2, target="single:0")
        soup = ricci.Soup([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 1, 2]])
        _ = flat.report.residuals, flat.triangulation.lengths, soup.defects[0].faces
        start = ricci.metric(genus2)
        known = [weakref.ref(of) for of in (flat, soup, start)]
        with pytest.raises(ricci.TargetError):
            start.flow({0: 7.0})
        del flat, soup, start, _
        assert [of() for of in known] == [None, None, None]
    finally:
        gc.enable()


def test_threads_run_beside_a_call(large):
    """While one thread is inside the library another one counts: had the call kept the GIL, there would be one long gap."""
    spent = []

    def work():
        start = time.perf_counter()
        large.flow("uniform", threads=1)
        spent.append(time.perf_counter() - start)

    thread = threading.Thread(target=work)
    gaps, last = [], time.perf_counter()
    thread.start()
    while thread.is_alive():
        time.sleep(0.001)
        now = time.perf_counter()
        gaps.append(now - last)
        last = now
    assert len(gaps) > 20
    assert max(gaps) < 0.5 * spent[0]


def test_two_calls_at_once_give_what_one_gives(genus2):
    alone = ricci.flow(genus2, target="single:3").u
    found = []
    threads = [threading.Thread(target=lambda: found.append(ricci.flow(genus2, target="single:3").u)) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 4
    assert all(np.array_equal(u, alone) for u in found)


def test_threads_take_turns_at_a_solver(genus2):
    solver = ricci.Solver(ricci.metric(genus2))
    found = {}

    def solve(vertex):
        found[vertex] = solver.solve(f"single:{vertex}")

    threads = [threading.Thread(target=solve, args=(v,)) for v in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert {v: flat.report.cones.tolist() for v, flat in found.items()} == {v: [v] for v in range(6)}
    assert all(flat.converged for flat in found.values())


def test_messages_belong_to_the_thread_of_the_call(genus2):
    """Two threads fail at once, each with its own message."""
    wrong = {}

    def fail(vertex):
        try:
            ricci.flow(genus2, target={vertex: 7.0})
        except ricci.TargetError as failure:
            wrong[vertex] = failure.index

    threads = [threading.Thread(target=fail, args=(v,)) for v in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == {v: v for v in range(8)}


def test_messages_of_the_library_reach_logging(caplog, torus):
    with caplog.at_level(logging.DEBUG, logger="ricci"):
        ricci.log_to_logging("debug")
        try:
            ricci.flow(torus)
        finally:
            ricci.log_to_logging("off")
    assert any(record.name == "ricci" for record in caplog.records)
    caplog.clear()
    ricci.flow(torus)
    assert not caplog.records


@pytest.mark.parametrize("progress", [3, "flow", [print]])
def test_progress_is_a_function_or_a_control(torus, progress):
    with pytest.raises(TypeError, match="progress is a function of a stage and a fraction, or a Control"):
        ricci.flow(torus, progress=progress)
    with pytest.raises(TypeError, match="progress is a function"):
        ricci.Control(progress)
