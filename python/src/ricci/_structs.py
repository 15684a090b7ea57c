"""Structs of the C face, which are filled from options by their names and keep the arrays that they point to."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

import numpy as np

from ricci import _arrays
from ricci._call import Handle, Passed, constant, pointer
from ricci._library import ffi, lib
from ricci.control import check
from ricci.errors import ArgumentError

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
            value = pointer(value) if isinstance(value, np.ndarray) else value._pointer
        try:
            setattr(self._pointer, field, value)
        except (TypeError, OverflowError) as wrong:
            raise ArgumentError(f"{field}: {wrong}") from wrong


def options(name: str, given: Mapping[str, Any], writers: Mapping[str, Write]) -> Struct:
    """The struct `ricci_<name>` with the given fields; None leaves a field's default.

    Raises:
        ArgumentError: a name that is no option; the message lists those that there are.
    """
    struct = Struct(name)
    for field, value in given.items():
        if field not in writers:
            raise ArgumentError(f"there is no option {field!r}; there are {', '.join(sorted(writers))}")
        if value is not None:
            writers[field](struct, field, value)
    return struct


def number(struct: Struct, field: str, value: Any) -> None:
    """A number, or a flag."""
    struct.put(field, int(value) if isinstance(value, bool | np.bool_ | np.integer) else value)


def choice(prefix: str, among: tuple[str, ...] | None = None) -> Write:
    """One of the constants RICCI_<prefix>_..., by its name in lower case."""
    return lambda struct, field, value: struct.put(field, constant(prefix, value, among))


def one_index(struct: Struct, field: str, value: Any) -> None:
    """An index that may be left out: a pointer to it."""
    struct.put(field, _arrays.indices([value], name=field))


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
