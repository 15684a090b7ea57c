"""Progress of long calls, and the means to stop them: by Ctrl-C, by a callback that raises, or from another thread."""

from __future__ import annotations

import threading
from collections.abc import Callable, Generator, Sequence
from typing import Any, TypeAlias

from ricci._library import ffi, lib
from ricci.errors import ArgumentTypeError, last_failure

__all__ = ["Control", "Progress"]

# The names of RICCI_STAGE_*.
STAGES = ("idle", "read", "build", "flow", "layout", "write")
# Seconds between two looks at a running call: the longest time before a Ctrl-C is passed on.
LOOK = 0.05


class Control:
    """Progress of one long call, and the means to cancel it. All methods may be called from any thread.

    A control that was cancelled stays so: every later call with it is stopped as well.

    Parameters
    ----------
    callback : Callable[[str, float], object] | None
        called as ``callback(stage, fraction)`` from the thread that waits for the call, about every 0.05 s and at its end: with
        the name of a stage (``"flow"``, ``"layout"``, ...) and the fraction of the whole call that is done, from 0 to 1, which
        never goes back. What it raises stops the call.

    Examples
    --------
    >>> control = ricci.Control(lambda stage, fraction: None)
    >>> flat = ricci.flow(ricci.make("torus", n=16), progress=control)
    >>> control.progress()[1]
    1.0
    """

    def __init__(self, callback: Callable[[str, float], object] | None = None) -> None:
        if callback is not None and not callable(callback):
            raise ArgumentTypeError(f"progress is a function of a stage and a fraction, or a Control, not {type(callback).__name__}")
        made = ffi.new("ricci_control **")
        status = lib.ricci_control_new(made)
        if status:
            raise last_failure(status)
        self._pointer: Any = ffi.gc(made[0], lib.ricci_control_free)
        self._callback = callback
        self._part = (0.0, 1.0)

    def __reduce__(self) -> Any:
        raise TypeError("a ricci.Control belongs to the calls of its own process, so that pickle cannot take it")

    def cancel(self) -> None:
        """Ask the running call, and every later one with this control, to stop; the call raises `Cancelled`."""
        lib.ricci_control_cancel(self._pointer)

    def set_threads(self, threads: int) -> None:
        """The number of threads of calls that have no option for it (`Spline.closest`, `Spline.tessellate`): 0, the default, is one for
        each core.

        Raises
        ------
        ArgumentTypeError
            for what is no number from 0 on.
        """
        if not isinstance(threads, int) or threads < 0:
            raise ArgumentTypeError(f"threads is a number from 0 on, not {threads!r}")
        lib.ricci_control_set_threads(self._pointer, threads)

    def set_part(self, start: float, end: float) -> None:
        """The part of the whole progress that the next calls fill, for several calls in one bar; 0 to 1 is all, as at the beginning.

        Raises
        ------
        ArgumentError
            unless 0 <= start <= end <= 1.
        """
        check(lib.ricci_control_part(self._pointer, start, end))
        self._part = (start, end)

    def progress(self) -> tuple[str, float]:
        """The stage that the call is in, and the fraction of the whole call that is done, in [0, 1]."""
        stage, fraction = ffi.new("uint32_t *"), ffi.new("double *")
        lib.ricci_control_progress(self._pointer, stage, fraction, ffi.NULL)
        return STAGES[stage[0]], float(fraction[0])

    def since_cancel(self) -> float | None:
        """Seconds since the first `cancel`, or None if there was none: right after `Cancelled` the latency."""
        stage, seconds = ffi.new("uint32_t *"), ffi.new("double[2]")
        lib.ricci_control_progress(self._pointer, stage, seconds, seconds + 1)
        return float(seconds[1]) if seconds[1] >= 0 else None

    def _report(self) -> None:
        if self._callback is not None:
            self._callback(*self.progress())


Progress: TypeAlias = "Control | Callable[[str, float], object] | None"


def stages(progress: Progress, ends: Sequence[float]) -> Generator[Progress, None, None]:
    """The progress of several calls in a row, each of which fills its part of the bar.

    Parameters
    ----------
    progress : Progress
        of the whole.
    ends : Sequence[float]
        the fraction of the whole that is done after each call, ascending; the last is 1.
    """
    if progress is None:
        yield from (None for _ in ends)
        return
    control = progress if isinstance(progress, Control) else Control(progress)
    (first, last), start = control._part, 0.0
    try:
        for end in ends:
            control.set_part(first + start * (last - first), first + end * (last - first))
            start = end
            yield control
    finally:
        control.set_part(first, last)


class _Running:
    """A call in a thread of its own. Its failure is read on that thread, because the library keeps the message for that thread."""

    def __init__(self, work: Callable[[], int]) -> None:
        self.failure: BaseException | None = None
        self.done = threading.Event()
        self._work = work
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        try:
            check(self._work())
        except BaseException as failure:
            self.failure = failure
        finally:
            self.done.set()


def check(status: int) -> None:
    """Raise the exception for the call that has just ended on this thread with `status`, unless that is OK."""
    if status:
        raise last_failure(status)


def run(progress: Progress, work: Callable[[Any], int]) -> None:
    """Do `work`, a long call that is handed a control's pointer, so that it can be watched and stopped.

    On the main thread, and where there is a callback, the call runs beside this thread, which looks at it and takes signals. A
    KeyboardInterrupt, or what the callback raises, cancels the call; it is raised here once the call has ended.

    Raises
    ------
    RicciError
        the call failed.
    """
    control = progress if isinstance(progress, Control) else Control(progress)
    if control._callback is None and threading.current_thread() is not threading.main_thread():
        check(work(control._pointer))
        return
    running = _Running(lambda: work(control._pointer))
    try:
        while not running.done.wait(LOOK):
            control._report()
    except BaseException:
        control.cancel()
        running.done.wait()
        raise
    failure = running.failure
    if failure is None:
        control._report()
    else:
        try:
            # The traceback has no frames of the thread that ran the call. `finally` breaks the cycle of this frame and the exception.
            raise failure.with_traceback(None)
        finally:
            del failure, running
