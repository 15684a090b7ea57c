"""Data of FreeSurfer at the vertices of surfaces: values, labels, patches, annotations."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._call import Booleans, Doubles, Indices, call, pointer
from ricci._library import ffi, lib
from ricci.errors import ArgumentError

__all__ = [
    "Annotation",
    "Patch",
    "VertexLabel",
    "read_annotation",
    "read_label",
    "read_patch",
    "read_values",
    "write_annotation",
    "write_label",
    "write_patch",
    "write_values",
]

FileName = str | os.PathLike[str]


class VertexLabel(NamedTuple):
    """A set of vertices.

    Attributes
    ----------
    vertices : Indices
        the vertices; -1 for a point of the volume that belongs to none.
    positions : Doubles
        their places, n x 3.
    values : Doubles
        a value each, such as a probability.

    Examples
    --------
    >>> import numpy as np
    >>> ricci.VertexLabel(np.array([4]), np.zeros((1, 3)), np.ones(1)).vertices.tolist()
    [4]
    """

    vertices: Indices
    positions: Doubles
    values: Doubles


class Patch(NamedTuple):
    """A part of the vertices of a surface with places of their own, such as a flat cortex.

    Attributes
    ----------
    vertices : Indices
        the vertices of the whole surface.
    positions : Doubles
        their places, n x 3; z = 0 where the part lies flat.
    is_border : Booleans
        True for vertices on the part's border.

    Examples
    --------
    >>> import numpy as np
    >>> ricci.Patch(np.array([4]), np.zeros((1, 3)), np.array([True])).is_border.tolist()
    [True]
    """

    vertices: Indices
    positions: Doubles
    is_border: Booleans


class Annotation(NamedTuple):
    """One named region per vertex.

    Attributes
    ----------
    regions : Indices
        per vertex its region, from 0; -1 for a vertex in none.
    names : list[str]
        the names of the regions.
    colors : Indices
        red, green, blue from 0 to 255 and transparency of each region, m x 4.

    Examples
    --------
    >>> import numpy as np
    >>> ricci.Annotation(np.array([0, -1]), ["cuneus"], np.array([[220, 20, 100, 0]])).names
    ['cuneus']
    """

    regions: Indices
    names: list[str]
    colors: Indices


def _name(path: FileName) -> bytes:
    return os.fspath(path).encode()


def _count(function: Any, *arguments: object) -> int:
    n = ffi.new("size_t *")
    call(function, *arguments, n)
    return int(n[0])


def read_values(path: FileName) -> Doubles:
    """The values of a file: curv, sulc, area, thickness.

    Parameters
    ----------
    path : FileName
        the file, packed by gzip or not; by its content also one of GIFTI with one array of values (.shape.gii, .func.gii).

    Examples
    --------
    >>> import numpy as np
    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "lh.sulc")
    >>> ricci.write_values(path, [0.5, 1.5], n_faces=1)
    >>> ricci.read_values(path).tolist()
    [0.5, 1.5]
    """
    name, n = _name(path), ffi.new("size_t *")
    values = np.empty(_count(lib.ricci_values_read, name, ffi.NULL, 0))
    call(lib.ricci_values_read, name, pointer(values), values.size, n)
    return values


def write_values(path: FileName, values: npt.ArrayLike, *, n_faces: int = 0) -> None:
    """Write values at the vertices of a surface, in single precision; packed where the name ends in .gz.

    Parameters
    ----------
    path : FileName
        the file.
    values : npt.ArrayLike
        n values.
    n_faces : int
        the number of faces of the surface, which the file names too.

    Examples
    --------
    >>> import numpy as np
    >>> import os, tempfile
    >>> ricci.write_values(os.path.join(tempfile.mkdtemp(), "lh.curv.gz"), np.zeros(5))
    """
    given = _arrays.real(values, None, "values")
    call(lib.ricci_values_write, _name(path), pointer(given), given.size, n_faces)


def read_label(path: FileName) -> VertexLabel:
    """The label of a file.

    Parameters
    ----------
    path : FileName
        the file, packed by gzip or not.

    Examples
    --------
    >>> import numpy as np
    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "lh.cortex.label")
    >>> ricci.write_label(path, [3, 4])
    >>> ricci.read_label(path).vertices.tolist()
    [3, 4]
    """
    name, n = _name(path), ffi.new("size_t *")
    count = _count(lib.ricci_label_read, name, *(ffi.NULL, 0) * 3)
    found = VertexLabel(np.empty(count, np.int32), np.empty((count, 3)), np.empty(count))
    call(lib.ricci_label_read, name, *(part for array in found for part in (pointer(array), array.size)), n)
    return found


def write_label(
    path: FileName,
    vertices: npt.ArrayLike,
    *,
    positions: npt.ArrayLike | None = None,
    values: npt.ArrayLike | None = None,
    comment: str = "",
) -> None:
    """Write a label.

    Parameters
    ----------
    path : FileName
        the file.
    vertices : npt.ArrayLike
        n vertices; -1 for a point of the volume that belongs to none.
    positions : npt.ArrayLike | None
        n x 3; zeros.
    values : npt.ArrayLike | None
        n values; zeros.
    comment : str
        the first line.

    Examples
    --------
    >>> import numpy as np
    >>> import os, tempfile
    >>> ricci.write_label(os.path.join(tempfile.mkdtemp(), "lh.label"), [1, 2], values=[0.5, 1])
    """
    numbers = np.ascontiguousarray(vertices, dtype=np.int32)
    places = np.zeros((numbers.size, 3)) if positions is None else _arrays.real(positions, 3, "positions")
    weights = np.zeros(numbers.size) if values is None else _arrays.real(values, None, "values")
    if len(places) != numbers.size or weights.size != numbers.size:
        raise ArgumentError(f"{numbers.size} vertices have {len(places)} positions and {weights.size} values")
    call(lib.ricci_label_write, _name(path), comment.encode(), pointer(numbers), pointer(places), pointer(weights), numbers.size)


def read_patch(path: FileName) -> Patch:
    """The patch of a file.

    Parameters
    ----------
    path : FileName
        the file, packed by gzip or not.

    Examples
    --------
    >>> import numpy as np
    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "lh.flat")
    >>> ricci.write_patch(path, [3], [[1, 2, 0]], is_border=[True])
    >>> ricci.read_patch(path).positions.tolist()
    [[1.0, 2.0, 0.0]]
    """
    name, n = _name(path), ffi.new("size_t *")
    count = _count(lib.ricci_patch_read, name, *(ffi.NULL, 0) * 3)
    found = np.empty(count, np.uint32), np.empty((count, 3)), np.empty(count, np.uint32)
    call(lib.ricci_patch_read, name, *(part for array in found for part in (pointer(array), array.size)), n)
    return Patch(found[0].astype(np.int32), found[1], found[2] != 0)


def write_patch(path: FileName, vertices: npt.ArrayLike, positions: npt.ArrayLike, *, is_border: npt.ArrayLike) -> None:
    """Write a patch, in single precision.

    Parameters
    ----------
    path : FileName
        the file.
    vertices : npt.ArrayLike
        n vertices of the whole surface.
    positions : npt.ArrayLike
        n x 3.
    is_border : npt.ArrayLike
        n flags of the vertices on the part's border.

    Examples
    --------
    >>> import numpy as np
    >>> import os, tempfile
    >>> ricci.write_patch(os.path.join(tempfile.mkdtemp(), "lh.flat"), [3], [[1, 2, 0]], is_border=[True])
    """
    numbers = _arrays.indices(vertices, None, "vertices")
    places = _arrays.real(positions, 3, "positions")
    border = np.ascontiguousarray(np.asarray(is_border, dtype=bool), dtype=np.uint32)
    if len(places) != numbers.size or border.size != numbers.size:
        raise ArgumentError(f"{numbers.size} vertices have {len(places)} positions and {border.size} flags")
    call(lib.ricci_patch_write, _name(path), pointer(numbers), pointer(places), pointer(border), numbers.size)


def read_annotation(path: FileName) -> Annotation:
    """The annotation of a file.

    Parameters
    ----------
    path : FileName
        the file, packed by gzip or not; by its content also labels of GIFTI (.label.gii).

    Examples
    --------
    >>> import numpy as np
    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "lh.annot")
    >>> ricci.write_annotation(path, [0, -1, 0], {"cuneus": (220, 20, 100, 0)})
    >>> ricci.read_annotation(path).names
    ['cuneus']
    """
    name, n, n_bytes = _name(path), ffi.new("size_t *"), ffi.new("size_t *")
    call(lib.ricci_annotation_read, name, ffi.NULL, 0, n, ffi.NULL, 0, ffi.NULL, 0, n_bytes)
    regions, text = np.empty(n[0], np.int32), ffi.new("char[]", int(n_bytes[0]))
    call(lib.ricci_annotation_read, name, pointer(regions), regions.size, n, ffi.NULL, 0, text, len(text), n_bytes)
    names = ffi.string(text).decode().splitlines()
    colors = np.empty((len(names), 4), np.uint32)
    call(lib.ricci_annotation_read, name, ffi.NULL, 0, n, pointer(colors), colors.size, ffi.NULL, 0, n_bytes)
    return Annotation(regions, names, colors.astype(np.int32))


def write_annotation(path: FileName, regions: npt.ArrayLike, table: Mapping[str, npt.ArrayLike]) -> None:
    """Write an annotation.

    Parameters
    ----------
    path : FileName
        the file.
    regions : npt.ArrayLike
        per vertex its region, by its place in `table`; -1 for a vertex in none.
    table : Mapping[str, npt.ArrayLike]
        the names of the regions, and their red, green, blue from 0 to 255 and transparency.

    Examples
    --------
    >>> import numpy as np
    >>> import os, tempfile
    >>> ricci.write_annotation(os.path.join(tempfile.mkdtemp(), "lh.annot"), [0, 0], {"cuneus": (220, 20, 100, 0)})
    """
    numbers = np.ascontiguousarray(regions, dtype=np.int32)
    colors = _arrays.indices([list(np.asarray(color)) for color in table.values()], 4, "table")
    names = "".join(f"{name}\n" for name in table)
    call(lib.ricci_annotation_write, _name(path), pointer(numbers), numbers.size, names.encode(), pointer(colors), len(colors))
