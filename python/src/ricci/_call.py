"""Calls of the library with numpy arrays. Arguments are checked and passed without a copy; results are written into new arrays."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import fields
from itertools import pairwise
from typing import Any, ClassVar, Self, TypeVar

import numpy as np
import numpy.typing as npt

from ricci._library import ffi, lib
from ricci.control import Progress, check, run
from ricci.errors import ArgumentError, last_failure, last_needed
from ricci.figures.names import CONSTANTS
from ricci.status import Status

Doubles = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]
Indices = npt.NDArray[np.uint32]
Signed = npt.NDArray[np.int32]
Longs = npt.NDArray[np.int64]

_POINTERS = {"d": "double", "I": "uint32_t", "i": "int32_t", "l": "int64_t", "L": "size_t"}
Figures = TypeVar("Figures")


class _Watched:
    """The type of `CONTROL`, which stands in a list of arguments at the place of the call's control."""


CONTROL = _Watched()


class Passed:
    """An object that is passed to the library as a pointer, and that keeps the memory behind the pointer alive."""

    _pointer: Any


class Handle(Passed):
    """An object of the library, freed with the Python object. The library keeps alive the objects that it was made from."""

    _type: ClassVar[str]

    def __init__(self, pointer: Any) -> None:
        self._pointer = ffi.gc(pointer, getattr(lib, f"ricci_{self._type}_free"))

    @classmethod
    def _made(cls, function: Callable[..., int], *arguments: Any, progress: Progress = None) -> Self:
        """The handle that `function` returns through its last argument."""
        out = ffi.new(f"ricci_{cls._type} **")
        call(function, *arguments, out, progress=progress)
        made = cls.__new__(cls)
        Handle.__init__(made, out[0])
        return made


def call(function: Callable[..., int], *arguments: Any, progress: Progress = None) -> None:
    """Call `function`; handles among the arguments are passed as their pointers, CONTROL as the control of `progress`.

    Raises:
        RicciError: the call failed.
    """
    given = [a._pointer if isinstance(a, Passed) else a for a in arguments]
    if CONTROL not in given:
        check(function(*given))
        return
    at = given.index(CONTROL)

    def work(control: Any) -> int:
        # This closure keeps the arguments alive as long as the call runs, even if the caller is gone.
        _ = arguments
        return function(*given[:at], control, *given[at + 1 :])

    run(progress, work)


def pointer(array: npt.NDArray[Any] | None) -> Any:
    """The address of an array's numbers, for cffi; NULL for None.

    It keeps the array alive, because a call that was abandoned may still be writing there. An array whose rows lie apart is not kept
    alive: the caller must do that.
    """
    if array is None:
        return ffi.NULL
    kind = _POINTERS[array.dtype.char]
    return ffi.from_buffer(f"{kind}[]", array) if array.flags.c_contiguous else ffi.cast(f"{kind} *", array.ctypes.data)


def filled(function: Callable[..., int], *arguments: Any, out: npt.NDArray[Any], progress: Progress = None) -> Any:
    """The array `out`, into which `function` wrote through its last two arguments, address and capacity."""
    call(function, *arguments, pointer(out), out.size, progress=progress)
    return out


def doubles(function: Callable[..., int], *arguments: Any, shape: tuple[int, ...]) -> Doubles:
    """The numbers of this shape that `function` copies out through its last two arguments."""
    return filled(function, *arguments, out=np.empty(shape))


def listed(function: Callable[..., int], *arguments: Any, dtype: Any = np.uint32) -> Any:
    """A list whose length the call reports: a first call asks for the length."""
    given = [a._pointer if isinstance(a, Passed) else a for a in arguments]
    status = function(*given, ffi.NULL, 0)
    if status == Status.OK:
        return np.empty(0, dtype)
    if status != Status.BUFFER_TOO_SMALL:
        raise last_failure(status)
    return filled(function, *arguments, out=np.empty(last_needed(), dtype))


def sized_list(function: Callable[..., int], *arguments: Any, dtype: Any = np.int32) -> Any:
    """A list whose length the call writes to its last argument."""
    n = ffi.new("size_t *")
    call(function, *arguments, ffi.NULL, 0, n)
    out = np.empty(n[0], dtype)
    call(function, *arguments, pointer(out), out.size, n)
    return out


def text_of(function: Callable[..., int], *arguments: Any) -> str:
    """A text whose length the call writes to its last argument."""
    n = ffi.new("size_t *")
    call(function, *arguments, ffi.NULL, 0, n)
    out = ffi.new("char[]", n[0])
    call(function, *arguments, out, n[0], n)
    return str(ffi.string(out).decode("utf-8"))


def rows(n: int, function: Callable[..., int], *arguments: Any, dtype: Any = np.int32) -> list[Any]:
    """The n lists of different lengths that `function` copies out: views of one array.

    A first call without room for the entries either reports their number or writes the offsets at which each list starts and ends.
    """
    starts = np.zeros(n + 1, np.uintp)
    given = [a._pointer if isinstance(a, Passed) else a for a in arguments]
    status = function(*given, ffi.NULL, 0, pointer(starts), starts.size)
    if status not in (Status.OK, Status.BUFFER_TOO_SMALL):
        raise last_failure(status)
    entries = np.empty(last_needed() if status else int(starts[-1]), dtype)
    if entries.size:
        call(function, *arguments, pointer(entries), entries.size, pointer(starts), starts.size)
    return [entries[a:b] for a, b in pairwise(starts)]


def summary(kind: type[Figures], name: str, handle: Passed, function: Callable[..., int] | None = None) -> Figures:
    """The figures that `function`, or `ricci_<name>_summarise`, fills, as the dataclass `kind` with fields of the same names."""
    struct = f"ricci_{name}_summary"
    out = ffi.new(f"{struct} *")
    check((function or getattr(lib, f"ricci_{name}_summarise"))(handle._pointer, out, ffi.sizeof(struct)))
    return kind(**{field.name: _number(getattr(out, field.name), str(field.type)) for field in fields(kind)})  # type: ignore[arg-type]


def _number(value: Any, kind: str) -> Any:
    """A field of a struct as its Python type: flags are bool, constants their names, a modulus is complex, an array a tuple."""
    if kind in CONSTANTS:
        prefix, names = CONSTANTS[kind]
        return next(name for name in names if getattr(lib, f"RICCI_{prefix}_{name.upper()}") == value)
    if kind == "bool":
        return bool(value)
    if kind == "str":
        return ffi.string(value).decode()
    if kind == "complex":
        return complex(value[0], value[1])
    if kind.startswith("tuple"):
        return tuple(value)
    return value


def path_bytes(path: str | os.PathLike[str]) -> bytes:
    """A file's name as the library takes it."""
    return os.fspath(path).encode("utf-8")


def constant(prefix: str, name: str, among: tuple[str, ...] | None = None) -> int:
    """The constant RICCI_<prefix>_<NAME>.

    Args:
        prefix: the common prefix of the constants of its list.
        name: the rest of its name, in lower case.
        among: the names of the list, where several lists have the same prefix.

    Raises:
        ArgumentError: there is no such constant; the message lists the known names.
    """
    head = f"RICCI_{prefix}_"
    known = among or tuple(sorted(n.removeprefix(head).lower() for n in dir(lib) if n.startswith(head)))
    if name not in known:
        raise ArgumentError(f"{name!r} is none of {', '.join(known)}")
    return int(getattr(lib, head + name.upper()))
