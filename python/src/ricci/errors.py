"""Exceptions of failed calls: one class for each family of statuses, with the element and the amount as numbers.

Every exception of the library is a `RicciError`. Those of arguments are also a `ValueError`, and a `TypeError` where the type is wrong;
those of files are an `OSError` with its number and file name, such as `FileNotFoundError`, and a refusal of memory is a `MemoryError`, so
that code which knows nothing of this package treats them rightly.
"""

from __future__ import annotations

import os
import re
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

from ricci._library import ffi, lib
from ricci.status import Status

__all__ = [
    "ArgumentError",
    "ArgumentTypeError",
    "Cancelled",
    "ConvergenceWarning",
    "FileError",
    "InternalError",
    "LayoutError",
    "LeftOutError",
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

    Attributes
    ----------
    message : str
        one sentence that names the element and says what to do.
    status : int
        what the call returned, a `Status`.
    element
        what `index` counts: ``"vertex"``, ``"edge"``, ``"face"``, ``"entry"``, ``"line"``, ``"byte"``, or None.
    index
        the element concerned, from 0 (lines from 1), or None.
    amount : float
        by how much: what it counts depends on the status, and the message says it; 0 where there is nothing to be told.

    Examples
    --------
    >>> try:
    ...     ricci.flow(ricci.make("torus", n=8), target={7: 9.0})
    ... except ricci.RicciError as wrong:
    ...     wrong.element, wrong.index, wrong.status.name
    ('vertex', 7, 'TARGET_AT_VERTEX')
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


class ArgumentTypeError(ArgumentError, TypeError):
    """An argument is of another type than the one that is needed; the message says how to make one."""


class Cancelled(RicciError):
    """The call was stopped by its `Control`."""


class InternalError(RicciError, RuntimeError):
    """A defect of the library, or a solver that one has left unusable."""


class OutOfMemory(RicciError, MemoryError):
    """The system refused the memory that the work takes."""


class FileError(RicciError, OSError):
    """A file could not be read or written, or its name has no known format.

    As with every `OSError`, `errno` is the number of the system's error, `strerror` its text and `filename` the file; None where the
    system had nothing against it. What is not there is also a `FileNotFoundError`, what is not permitted a `PermissionError`.
    """

    def __new__(cls, *given: Any) -> FileError:
        """An exception of the class that stands for the system's error, which is the amount."""
        number = int(given[3]) if len(given) > 3 else 0
        kind = _BY_NUMBER.get(type(OSError(number, "")), cls) if cls is FileError and number else cls
        made: FileError = OSError.__new__(kind)
        return made

    def __init__(self, message: str, status: int = Status.IO, place: tuple[int, int] = (0, -1), amount: float = 0.0) -> None:
        super().__init__(message, status, place, amount)
        self.args = (message,)
        if amount:
            self.errno, self.strerror = int(amount), os.strerror(int(amount))

    def __reduce__(self) -> tuple[Any, ...]:
        return FileError, (self.message, int(self.status), self._place, self.amount), {"filename": self.filename}


class FileMissingError(FileError, FileNotFoundError):
    """There is no such file or folder."""


class FilePermissionError(FileError, PermissionError):
    """The system does not permit that to this user."""


class FileIsFolderError(FileError, IsADirectoryError):
    """A folder is where a file is needed."""


class FileUnderFileError(FileError, NotADirectoryError):
    """A file is where a folder is needed."""


_BY_NUMBER: dict[type, type[FileError]] = {
    FileNotFoundError: FileMissingError,
    PermissionError: FilePermissionError,
    IsADirectoryError: FileIsFolderError,
    NotADirectoryError: FileUnderFileError,
}


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


class LeftOutError(RicciError, NotImplementedError):
    """The call belongs to a part that was left out when the library was built."""


class SplineError(RicciError, ValueError):
    """A spline, or an argument that one is made from, is not what it must be."""


_SINGLE: dict[int, type[RicciError]] = {
    Status.CANCELLED: Cancelled,
    Status.PANIC: InternalError,
    Status.POISONED: InternalError,
    Status.NO_MEMORY: OutOfMemory,
    Status.LEFT_OUT: LeftOutError,
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


def in_methods(message: str) -> str:
    """A message of the library in the words of Python: its C functions are methods of the package, their fields keyword arguments."""
    told = re.sub(r"ricci_soup_(repair|refine) with (\w+) = ([0-9.e+-]*[0-9])", r"Soup.\1(\2=\3)", message)
    told = re.sub(r"ricci_soup_(repair|refine) with (\w+)", r"Soup.\1(\2=...)", told)
    told = told.replace("ricci_flow", "Metric.flow").replace("ricci_mesh_refine_angle", "Mesh.refine_angle")
    return told.replace("ricci_soup_", "Soup.")


def last_failure(status: int) -> RicciError:
    """The exception for the last call of this thread that failed, which returned `status`."""
    failure = ffi.new("ricci_failure *")
    lib.ricci_last_failure(failure, ffi.sizeof("ricci_failure"))
    message = in_methods(ffi.string(lib.ricci_last_error()).decode("utf-8", "replace"))
    kind = _SINGLE.get(status) or _FAMILIES[status // 100]
    return kind(message, status, (failure.element, failure.index), failure.amount)


def last_needed() -> int:
    """The number of entries that the last failed call of this thread needs room for."""
    failure = ffi.new("ricci_failure *")
    lib.ricci_last_failure(failure, ffi.sizeof("ricci_failure"))
    return int(failure.needed)


class ConvergenceWarning(UserWarning):
    """A result is handed out that did not come to its target; `converged` of it is False, and its `summary` says why."""


_SILENT: ContextVar[bool] = ContextVar("ricci_silent", default=False)


@contextmanager
def silent() -> Iterator[None]:
    """Within it, results that did not converge are no warnings: for callers who look at `converged` themselves."""
    token = _SILENT.set(True)
    try:
        yield
    finally:
        _SILENT.reset(token)


def warn(message: str) -> None:
    """Warn of a result that did not converge, at the line of the caller's that asked for it."""
    if _SILENT.get():
        return
    level, frame = 2, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] == "ricci":
        level, frame = level + 1, frame.f_back
    warnings.warn(message, ConvergenceWarning, stacklevel=level)
