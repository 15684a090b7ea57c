"""Calls of the library with numpy arrays. Arguments are checked and passed without a copy; results are written into new arrays."""

from __future__ import annotations

import operator
import os
from collections.abc import Callable
from dataclasses import fields
from itertools import pairwise
from typing import Any, ClassVar, Self, TypeVar

import numpy as np
import numpy.typing as npt

from ricci._library import ffi, lib
from ricci._shown import Shown
from ricci.control import Progress, check, run
from ricci.errors import ArgumentError, ArgumentTypeError, FileError, last_failure, last_needed
from ricci.figures.names import CONSTANTS
from ricci.status import Status

Doubles = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]
Indices = npt.NDArray[np.int32]
Booleans = npt.NDArray[np.bool_]
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
    # How a caller makes one.
    _made_by: ClassVar[str] = ""

    def __reduce__(self) -> Any:
        kind = type(self).__name__
        raise TypeError(f"a ricci.{kind} is memory of the library, which pickle cannot take: send what it was made from ({self._made_by})")


class Handle(Shown, Passed):
    """An object of the library, freed with the Python object. The library keeps alive the objects that it was made from.

    Handles never change, so that a copy of one is the handle itself.
    """

    _type: ClassVar[str]

    def __init_subclass__(cls) -> None:
        if "_type" in cls.__dict__:
            _KINDS[f"struct ricci_{cls._type}"] = cls

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, _: Any) -> Self:
        return self

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


# The classes of handles by the names of their types in the headers.
_KINDS: dict[str, type[Handle]] = {}
# The sizes of the integers that functions take, in bits, and whether they have a sign.
_INTEGERS = {"uint32_t": (32, False), "int32_t": (32, True), "uint64_t": (64, False), "int64_t": (64, True), "size_t": (64, False)}


def fitting(kind: Any, value: Any, name: str = "") -> Any:
    """A value as cffi takes it for an argument or a field of the type `kind`: handles as their pointers, numbers checked.

    Raises
    ------
    ArgumentTypeError
        it is of another type; the message says what is needed, and how one is made.
    ArgumentError
        a number out of range.
    """
    lead = f"{name}: " if name else ""
    if kind.kind == "pointer" and kind.item.kind == "struct":
        return _struct_for(kind, value, lead)
    if kind.kind == "primitive" and not isinstance(value, bytes):
        return _number_for(kind, value, lead)
    return value


def _struct_for(kind: Any, value: Any, lead: str) -> Any:
    """The pointer to a struct or to an object of the library that a value stands for."""
    needed = _KINDS.get(kind.item.cname)
    # What is passed in place of an object, such as its report, is none.
    passes = isinstance(value, Passed if needed is None else Handle)
    given = value._pointer if passes else value
    if isinstance(given, ffi.CData) and (given == ffi.NULL or ffi.typeof(given) == kind):
        return given
    if needed is None:
        raise ArgumentTypeError(f"{lead}{type(value).__name__} is no {kind.item.cname.removeprefix('struct ricci_').replace('_', ' ')}")
    made = f": {needed._made_by} makes one" if needed._made_by else ""
    raise ArgumentTypeError(f"{lead}a {needed.__name__} is needed, not {type(value).__name__}{made}")


def _number_for(kind: Any, value: Any, lead: str) -> Any:
    """A number as an argument of a primitive type."""
    if kind.cname in ("double", "float"):
        if isinstance(value, str | bytes | complex) or not hasattr(value, "__float__"):
            raise ArgumentTypeError(f"{lead}a number is needed, not {type(value).__name__}")
        try:
            return float(value)
        except (TypeError, OverflowError) as wrong:
            raise ArgumentTypeError(f"{lead}{wrong}") from wrong
    try:
        number = operator.index(value)
    except TypeError:
        raise ArgumentTypeError(f"{lead}a whole number is needed, not {value!r}") from None
    bits, signed = _INTEGERS.get(kind.cname, (64, True))
    least, most = (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) if signed else (0, 2**bits - 1)
    if not least <= number <= most:
        raise ArgumentError(f"{lead}{number} is not between {least} and {most}")
    return number


def _fitting_all(function: Callable[..., int], arguments: tuple[Any, ...]) -> list[Any]:
    """All arguments of a function of the library as cffi takes them; those of a wrapper of one are its handles' pointers."""
    if not isinstance(function, ffi.CData):
        return [a._pointer if isinstance(a, Passed) else a for a in arguments]
    kinds = ffi.typeof(function).args
    return [a if a is CONTROL else fitting(kind, a) for kind, a in zip(kinds, arguments, strict=True)]


def call(function: Callable[..., int], *arguments: Any, progress: Progress = None) -> None:
    """Call `function`; handles among the arguments are passed as their pointers, CONTROL as the control of `progress`.

    Raises
    ------
    RicciError
        the call failed, or an argument is of another type.
    """
    given = _fitting_all(function, arguments)
    try:
        _run(function, arguments, given, progress)
    except FileError as wrong:
        # The library names the file in its message alone.
        wrong.filename = next((a.name for a in arguments if isinstance(a, _PathBytes)), None)
        raise


def _run(function: Callable[..., int], arguments: tuple[Any, ...], given: list[Any], progress: Progress) -> None:
    if not any(a is CONTROL for a in given):
        if progress is None:
            check(function(*given))
        else:
            run(progress, lambda control: _with_control(control, function, given))
        return
    at = next(k for k, a in enumerate(given) if a is CONTROL)

    def work(control: Any) -> int:
        # This closure keeps the arguments alive as long as the call runs, even if the caller is gone.
        _ = arguments
        return function(*given[:at], control, *given[at + 1 :])

    run(progress, work)


def _with_control(control: Any, function: Callable[..., int], given: list[Any]) -> int:
    """The status of a call that has no argument for a control, which the thread uses meanwhile."""
    lib.ricci_control_use(control)
    try:
        return function(*given)
    finally:
        lib.ricci_control_use(ffi.NULL)


def pointer(array: npt.NDArray[Any] | None) -> Any:
    """The address of an array's numbers, for cffi; NULL for None.

    It keeps the array alive, because a call that was abandoned may still be writing there. An array whose rows lie apart is not kept
    alive: the caller must do that.
    """
    if array is None:
        return ffi.NULL
    kind = _POINTERS[array.dtype.char]
    return ffi.from_buffer(f"{kind}[]", array) if array.flags.c_contiguous else ffi.cast(f"{kind} *", array.ctypes.data)


def signed_view(array: Any) -> Any:
    """Indices that the library wrote as unsigned numbers, as a view with a sign: no mesh has 2^31 vertices, and F - 1 of 0 is -1."""
    return array.view(np.int32) if array.dtype == np.uint32 else array


def filled(function: Callable[..., int], *arguments: Any, out: npt.NDArray[Any], progress: Progress = None) -> Any:
    """The array `out`, into which `function` wrote through its last two arguments, address and capacity; indices have a sign."""
    call(function, *arguments, pointer(out), out.size, progress=progress)
    return signed_view(out)


def doubles(function: Callable[..., int], *arguments: Any, shape: tuple[int, ...]) -> Doubles:
    """The numbers of this shape that `function` copies out through its last two arguments."""
    return filled(function, *arguments, out=np.empty(shape))


def listed(function: Callable[..., int], *arguments: Any, dtype: Any = np.uint32) -> Any:
    """A list whose length the call reports: a first call asks for the length."""
    given = _fitting_all(function, (*arguments, ffi.NULL, 0))
    status = function(*given)
    if status == Status.OK:
        return signed_view(np.empty(0, dtype))
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
    given = _fitting_all(function, (*arguments, ffi.NULL, 0, pointer(starts), starts.size))
    status = function(*given)
    if status not in (Status.OK, Status.BUFFER_TOO_SMALL):
        raise last_failure(status)
    entries = np.empty(last_needed() if status else int(starts[-1]), dtype)
    if entries.size:
        call(function, *arguments, pointer(entries), entries.size, pointer(starts), starts.size)
    entries = signed_view(entries)
    return [entries[a:b] for a, b in pairwise(starts)]


def summary(kind: type[Figures], name: str, handle: Passed, function: Callable[..., int] | None = None) -> Figures:
    """The figures that `function`, or `ricci_<name>_summarise`, fills, as the dataclass `kind` with fields of the same names."""
    struct = f"ricci_{name}_summary"
    out = ffi.new(f"{struct} *")
    check((function or getattr(lib, f"ricci_{name}_summarise"))(handle._pointer, out, ffi.sizeof(struct)))
    return figures_of(kind, out)


def figures_of(kind: type[Figures], out: Any) -> Figures:
    """A struct of figures that was filled, as the dataclass `kind` with fields of the same names."""
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
    # The library's sign that there is no such element.
    return -1 if kind == "int" and value == np.iinfo(np.uint32).max else value


class _PathBytes(bytes):
    """A file's name as the library takes it, and as the caller gave it."""

    name: str


def path_bytes(path: str | os.PathLike[str]) -> bytes:
    """A file's name as the library takes it.

    Raises
    ------
    ArgumentTypeError
        not the name of a file.
    """
    try:
        name = os.fspath(path)
    except TypeError:
        raise ArgumentTypeError(f"a file's name is needed, not {type(path).__name__}") from None
    made = _PathBytes(os.fsencode(name))
    if 0 in made:
        raise ArgumentError(f"{name!r} is no file's name")
    made.name = os.fsdecode(name)
    return made


def constant(prefix: str, name: str, among: tuple[str, ...] | None = None) -> int:
    """The constant RICCI_<prefix>_<NAME>.

    Parameters
    ----------
    prefix : str
        the common prefix of the constants of its list.
    name : str
        the rest of its name, in lower case.
    among : tuple[str, ...] | None
        the names of the list, where several lists have the same prefix.

    Raises
    ------
    ArgumentError
        there is no such constant; the message lists the known names.
    """
    head = f"RICCI_{prefix}_"
    known = among or tuple(sorted(n.removeprefix(head).lower() for n in dir(lib) if n.startswith(head)))
    if name not in known:
        raise ArgumentError(f"{name!r} is none of {', '.join(known)}")
    return int(getattr(lib, head + name.upper()))
