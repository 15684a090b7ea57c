"""Solvers for many targets on one metric."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, ClassVar, Literal, Self

import numpy.typing as npt

from ricci import _arrays
from ricci._call import CONTROL, Handle, call, pointer
from ricci._library import ffi, lib
from ricci._signatures import picked, takes
from ricci.control import Progress
from ricci.metrics import FlowOptions, Metric, flow_struct
from ricci.targets import TargetLike, target_struct

__all__ = ["Solver"]


class Solver(Handle):
    """A solver for many targets on one metric: it keeps its analysis, its threads and the last solution. Threads take turns.

    Parameters
    ----------
    start : Metric
        where the first solve starts.

    Examples
    --------
    >>> solver = ricci.Solver(ricci.metric(ricci.make("disk", n=4)))
    >>> [solver.solve(target).converged for target in ("boundary", "outer")]
    [True, True]
    """

    _type: ClassVar[str] = "solver"
    _made_by: ClassVar[str] = "ricci.Solver(metric)"
    _figures: ClassVar[tuple[str, ...]] = ()

    @takes(FlowOptions)
    def __init__(
        self,
        start: Metric,
        *,
        method: Literal["newton", "gradient"] = "newton",
        flips: Literal["auto", "never"] = "auto",
        tolerance: float | None = None,
        max_iterations: int | None = None,
        threads: int | None = None,
        max_step: float | None = None,
        fixed_edges: npt.ArrayLike | None = None,
        step: Literal["armijo", "barzilai_borwein", "stable", "fixed"] = "armijo",
        step_size: float | None = None,
        area_normalised: bool = False,
    ) -> None:
        given = picked(locals(), FlowOptions)
        self._pointer = Solver._made(lib.ricci_solver_new, start, flow_struct(given))._pointer
        self._input = start._input
        self._turn = threading.Lock()

    def __copy__(self) -> Self:
        raise TypeError("a ricci.Solver changes with every solve, so that it has no copies: make another one of its metric")

    def __deepcopy__(self, _: Any) -> Self:
        return self.__copy__()

    def pin(self, vertices: npt.ArrayLike = ()) -> None:
        """Hold u fixed at these vertices in the following solves, whose curvature is then free; none releases all."""
        pinned = _arrays.indices(vertices)
        call(self._in_turn(lib.ricci_solver_pin), self, pointer(pinned) if pinned.size else ffi.NULL, pinned.size)

    def solve(self, target: TargetLike = None, progress: Progress = None) -> Metric:
        """The metric with this target, from where the last solve ended. After a failure the solver is where it was before."""
        made = Metric._made(self._in_turn(lib.ricci_solver_solve), self, target_struct(target), CONTROL, progress=progress)
        made._input = self._input
        made._warn()
        return made

    def _in_turn(self, function: Callable[..., int]) -> Callable[..., int]:
        """The function, which the library asks for by one thread at a time; held by the thread that runs it, until it has ended."""
        turn = self._turn

        def waiting(*arguments: Any) -> int:
            with turn:
                return function(*arguments)

        return waiting
