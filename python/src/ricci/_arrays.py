"""Arrays of the caller's: as they are where their type fits, converted where not, refused where numbers would be lost."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ricci._call import Doubles, Indices, Signed, signed_view
from ricci.errors import ArgumentError, ArgumentTypeError

_LARGEST = np.iinfo(np.uint32).max


# Why numbers of these kinds are not taken as real ones, by numpy's letter for the kind.
_NOT_REAL = {
    "c": "complex numbers: give their real and imaginary parts as two columns",
    "U": "texts: make numbers of them first, as float(text) does",
    "S": "texts: make numbers of them first, as float(text) does",
    "M": "dates",
    "m": "time spans",
    "V": "records: name one of their fields",
    "O": "objects, or rows of different lengths",
}


def numbers(values: npt.ArrayLike, name: str = "values") -> npt.NDArray[Any]:
    """`values` as an array of real numbers, of whatever type they are.

    Raises
    ------
    ArgumentTypeError
        complex numbers, texts, objects, entries that are masked.
    """
    if isinstance(values, np.ma.MaskedArray) and np.ma.is_masked(values):
        n = int(np.ma.getmaskarray(values).sum())
        raise ArgumentTypeError(f"{name} have {n} masked entries: fill them, or leave them out")
    try:
        array = np.asarray(values)
    except ValueError as wrong:
        raise ArgumentTypeError(f"{name}: {wrong}") from wrong
    if array.dtype.kind in _NOT_REAL:
        raise ArgumentTypeError(f"{name} are {_NOT_REAL[array.dtype.kind]}")
    return array


def real(values: npt.ArrayLike, columns: int | None = None, name: str = "values") -> Doubles:
    """`values` as contiguous doubles, with so many columns: the array itself where it is that already."""
    array = np.ascontiguousarray(numbers(values, name), dtype=np.float64)
    if columns is not None and (array.ndim != 2 or array.shape[1] != columns):
        raise ArgumentError(f"{name} has shape {array.shape}, n x {columns} is needed")
    return array


def points(values: npt.ArrayLike, name: str = "V") -> Doubles:
    """Positions, n x 3, whose rows may lie apart, so that columns of a wider array and every other row are no copies."""
    array = np.asarray(numbers(values, name), dtype=np.float64)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ArgumentError(f"{name} has shape {array.shape}, n x 3 is needed")
    in_place = array.strides[1] == 8 and array.strides[0] >= 24
    return array if in_place else np.ascontiguousarray(array)


def indices(values: npt.ArrayLike, columns: int | None = None, name: str = "indices") -> Indices:
    """Non-negative integers as contiguous 32-bit ones: int32 and uint32 arrays are taken as they are.

    Raises
    ------
    ArgumentError
        not integers, negative, or beyond 32 bits; the index is that of the entry.
    """
    array = numbers(values, name)
    if array.size == 0:
        array = array.astype(np.uint32)
    if array.dtype.kind not in "iu":
        raise ArgumentTypeError(f"{name} are integers, not {array.dtype}")
    if columns is not None and (array.ndim != 2 or array.shape[1] != columns):
        raise ArgumentError(f"{name} has shape {array.shape}, n x {columns} is needed")
    if array.dtype in (np.dtype(np.int32), np.dtype(np.uint32)) and array.flags.c_contiguous:
        _in_range(array, name, check=array.dtype == np.dtype(np.int32))
        return array.view(np.uint32)
    _in_range(array, name, check=True)
    return np.ascontiguousarray(array, dtype=np.uint32)


def index(value: Any, name: str) -> Indices:
    """One index as an array of one entry.

    Raises
    ------
    ArgumentTypeError
        no whole number.
    """
    if np.ndim(value) != 0:
        raise ArgumentTypeError(f"{name} is one index, not {value!r:.40}")
    return indices([value], name=name)


def _in_range(array: npt.NDArray[Any], name: str, check: bool) -> None:
    if not check or array.size == 0:
        return
    wrong = (array < 0) | (array > _LARGEST)
    if wrong.any():
        at = int(np.argmax(wrong))
        raise ArgumentError(f"entry {at} of {name} is {array.flat[at]}, which is no index", 2, (4, at))


def signed(values: npt.ArrayLike, name: str = "path") -> Signed:
    """Edge paths and words: contiguous int32, 1-based, negative for what is run backwards."""
    array = numbers(values, name)
    if array.size == 0:
        return np.empty(0, np.int32)
    if array.dtype.kind not in "iu" or np.abs(array.astype(np.int64)).max() > np.iinfo(np.int32).max:
        raise ArgumentError(f"{name} are integers of 32 bits")
    return np.ascontiguousarray(array, dtype=np.int32)


def joined(lists: Iterable[npt.ArrayLike]) -> tuple[Signed, npt.NDArray[np.uintp]]:
    """Lists of signed integers one after the other, and where each starts, with the end."""
    parts: Sequence[Signed] = [signed(part) for part in lists]
    starts = np.concatenate([[0], np.cumsum([part.size for part in parts])]).astype(np.uintp)
    return np.concatenate([np.empty(0, np.int32), *parts]).astype(np.int32), starts


def frozen(array: Any) -> Any:
    """The array, read-only, indices with a sign: what an object hands out again and again."""
    array = signed_view(array)
    array.setflags(write=False)
    return array
