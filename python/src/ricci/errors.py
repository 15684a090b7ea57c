"""Exceptions of failed calls: one class for each family of statuses, with the element and the amount as numbers.

Every exception of the library is a `RicciError`. Those of arguments are also a `ValueError`, those of files an `OSError`, and a refusal
of memory is a `MemoryError`, so that code which knows nothing of this package treats them rightly.
"""

from __future__ import annotations

from typing import Any

from ricci._library import ffi, lib
from ricci.status import Status

__all__ = [
    "ArgumentError",
    "Cancelled",
    "FileError",
    "InternalError",
    "LayoutError",
    "MatchingError",
    "MeshError",
    "MetricError",
    "OutOfMemory",
    "ParseError",
    "RicciError",
    "SolverError",
    "SplineError",
    "TargetError",
]

# The names of RICCI_ELEMENT_*.
_ELEMENTS = {1: "vertex", 2: "edge", 3: "face", 4: "entry", 5: "line", 6: "byte"}


class RicciError(Exception):
    """A call of the library failed.

    Attributes:
        message: one sentence that names the element and says what to do.
        status: what the call returned, a `Status`.
        element: what `index` counts: ``"vertex"``, ``"edge"``, ``"face"``, ``"entry"``, ``"line"``, ``"byte"``, or None.
        index: the element concerned, from 0 (lines from 1), or None.
        amount: by how much, as the status says in `ricci.h`; 0 where it says nothing.
    """

    def __init__(self, message: str, status: int = Status.ARGUMENT, place: tuple[int, int] = (0, -1), amount: float = 0.0) -> None:
        super().__init__(message)
        self.message = message
        self.status = Status(status)
        self.element = _ELEMENTS.get(place[0])
        self.index = place[1] if place[1] >= 0 else None
        self.amount = amount
        self._place = place

    def __str__(self) -> str:
        return self.message

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.message, int(self.status), self._place, self.amount)


class ArgumentError(RicciError, ValueError):
    """An argument, an array's size or an option is not what it must be."""


class Cancelled(RicciError):
    """The call was stopped by its `Control`."""


class InternalError(RicciError, RuntimeError):
    """A defect of the library, or a solver that one has left unusable."""


class OutOfMemory(RicciError, MemoryError):
    """The system refused the memory that the work takes."""


class FileError(RicciError, OSError):
    """A file could not be read or written, or its name has no known format."""


class ParseError(RicciError, ValueError):
    """A file's content is not what its format says."""


class MeshError(RicciError, ValueError):
    """Faces that form no connected oriented surface; `ricci.Soup` lists every defect."""


class MetricError(RicciError, ValueError):
    """Lengths, weights or conformal variables that give no metric."""


class TargetError(RicciError, ValueError):
    """A target curvature that no metric has."""


class SolverError(RicciError, ArithmeticError):
    """A linear system could not be factorised."""


class LayoutError(RicciError, ValueError):
    """The metric or the surface has no layout of the kind that was asked for."""


class MatchingError(RicciError, ValueError):
    """There is no map of the kind that was asked for between two surfaces."""


class SplineError(RicciError, ValueError):
    """A spline, or an argument that one is made from, is not what it must be."""


_SINGLE: dict[int, type[RicciError]] = {
    Status.CANCELLED: Cancelled,
    Status.PANIC: InternalError,
    Status.POISONED: InternalError,
    Status.NO_MEMORY: OutOfMemory,
    Status.PARSE: ParseError,
    Status.MATCHING: MatchingError,
}
# By the hundreds of the status.
_FAMILIES: tuple[type[RicciError], ...] = (
    ArgumentError,
    FileError,
    MeshError,
    MetricError,
    TargetError,
    SolverError,
    LayoutError,
    SplineError,
)


def last_failure(status: int) -> RicciError:
    """The exception for the last call of this thread that failed, which returned `status`."""
    failure = ffi.new("ricci_failure *")
    lib.ricci_last_failure(failure, ffi.sizeof("ricci_failure"))
    message = ffi.string(lib.ricci_last_error()).decode("utf-8", "replace")
    kind = _SINGLE.get(status) or _FAMILIES[status // 100]
    return kind(message, status, (failure.element, failure.index), failure.amount)


def last_needed() -> int:
    """The number of entries that the last failed call of this thread needs room for."""
    failure = ffi.new("ricci_failure *")
    lib.ricci_last_failure(failure, ffi.sizeof("ricci_failure"))
    return int(failure.needed)
