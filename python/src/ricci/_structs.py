"""Structs of the C face, which are filled from options by their names and keep the arrays that they point to."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeAlias

import numpy as np

from ricci import _arrays
from ricci._call import Handle, Passed, constant, fitting, pointer
from ricci._library import ffi, lib
from ricci.control import check
from ricci.errors import ArgumentError, ArgumentTypeError

# Writes a value into the field of that name, and keeps what the field points to.
Write: TypeAlias = "Callable[[Struct, str, Any], None]"


class Struct(Passed):
    """A struct that begins with its size. Its other fields are zero at first, which means the defaults."""

    def __init__(self, name: str) -> None:
        self._pointer = ffi.new(f"ricci_{name} *")
        self._kept: list[Any] = []
        check(lib.ricci_init(self._pointer, ffi.sizeof(f"ricci_{name}")))

    def put(self, field: str, value: Any) -> None:
        """Set one field: a number, an array, or another struct or handle, which is kept."""
        if isinstance(value, np.ndarray | Passed):
            self._kept.append(value)
        kind = dict(ffi.typeof(self._pointer).item.fields)[field].type
        if isinstance(value, np.ndarray) and kind.kind == "pointer" and kind.item.kind == "primitive":
            value = pointer(value)
        try:
            setattr(self._pointer, field, fitting(kind, value, field))
        except (TypeError, OverflowError) as wrong:
            raise wrong if isinstance(wrong, ArgumentError) else ArgumentError(f"{field}: {wrong}") from wrong


def options(name: str, given: Mapping[str, Any], writers: Mapping[str, Write]) -> Struct:
    """The struct `ricci_<name>` with the given fields; None leaves a field's default.

    Raises
    ------
    ArgumentError
        a name that is no option; the message lists those that there are.
    """
    struct = Struct(name)
    known(given, writers)
    for field, value in given.items():
        if value is not None:
            writers[field](struct, field, value)
    return struct


def known(given: Mapping[str, Any], names: Iterable[str]) -> None:
    """Refuse options by other names than these.

    Raises
    ------
    ArgumentTypeError
        options that are no mapping.
    ArgumentError
        a name that is no option; the message lists those that there are.
    """
    if not isinstance(given, Mapping):
        raise ArgumentTypeError(f"options are a dict of names and values, not {type(given).__name__}")
    for name in given:
        if name not in names:
            near = difflib.get_close_matches(str(name), names, 1)
            meant = f"; did you mean {near[0]!r}?" if near else ""
            raise ArgumentError(f"there is no option {name!r}; there are {', '.join(sorted(names))}{meant}")


def number(struct: Struct, field: str, value: Any) -> None:
    """A number, or a flag."""
    struct.put(field, int(value) if isinstance(value, bool | np.bool_) else value)


def above_zero(struct: Struct, field: str, value: Any) -> None:
    """A number whose zero stands for the default in the library, so that a zero of the caller's is refused."""
    number(struct, field, value)
    if value == 0:
        raise ArgumentError(f"{field} is {value}: it must be above 0; None, or leaving it out, is the default")


def or_none(struct: Struct, field: str, value: Any) -> None:
    """A number for which the library takes zero as the default and what is below zero as none: a zero of the caller's is none."""
    number(struct, field, -1 if value == 0 else value)


def choice(prefix: str, among: tuple[str, ...] | None = None) -> Write:
    """One of the constants RICCI_<prefix>_..., by its name in lower case."""
    return lambda struct, field, value: struct.put(field, constant(prefix, value, among))


def one_index(struct: Struct, field: str, value: Any) -> None:
    """An index that may be left out: a pointer to it."""
    struct.put(field, _arrays.index(value, field))


def index_list(count: str | None = None, columns: int | None = None) -> Write:
    """A list of indices, in rows of `columns`, and the number of rows in the field `count`."""

    def write(struct: Struct, field: str, value: Any) -> None:
        array = _arrays.indices(value, columns, field)
        struct.put(field, array)
        if count is not None:
            struct.put(count, len(array))

    return write


def real_list(columns: int | None = None, count: str | None = None) -> Write:
    """A list of numbers, in rows of `columns`, and the number of rows in the field `count`."""

    def write(struct: Struct, field: str, value: Any) -> None:
        array = _arrays.real(value, columns, field)
        struct.put(field, array)
        if count is not None:
            struct.put(count, len(array))

    return write


def nested(struct: Struct, field: str, value: Struct | Handle) -> None:
    """Another struct, or a handle."""
    struct.put(field, value)
