"""Files of GIFTI without other libraries: surfaces, values and labels with notes: metadata, and the spaces of coordinates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._call import Doubles, call, path_bytes, pointer
from ricci._library import ffi, lib
from ricci.adapters import MeshLike, as_mesh
from ricci.errors import ArgumentError, ArgumentTypeError
from ricci.freesurfers import FileName

__all__ = [
    "GiftiColumn",
    "GiftiColumns",
    "GiftiLabel",
    "GiftiNotes",
    "GiftiTransform",
    "read_gifti_columns",
    "read_gifti_notes",
    "write_gifti_labels",
    "write_gifti_surface",
    "write_gifti_values",
]


class GiftiTransform(NamedTuple):
    """The way from the coordinates of a surface to those of another space.

    Attributes
    ----------
    source : str
        the name of the space of the coordinates.
    target : str
        the name of the other space.
    matrix : npt.ArrayLike
        4 x 4, which acts on (x, y, z, 1).

    Examples
    --------
    >>> import numpy as np
    >>> way = ricci.GiftiTransform("NIFTI_XFORM_SCANNER_ANAT", "NIFTI_XFORM_MNI_152", np.diag([2, 2, 2, 1]))
    >>> way.target
    'NIFTI_XFORM_MNI_152'
    """

    source: str
    target: str
    matrix: npt.ArrayLike


class GiftiNotes(NamedTuple):
    """What a file says beside its numbers.

    Attributes
    ----------
    metadata : Mapping[str, str] | Sequence[tuple[str, str]]
        names and values; pairs where they were read, since a name may come again.
    transforms : Sequence[GiftiTransform]
        the ways to other spaces.

    Examples
    --------
    >>> notes = ricci.GiftiNotes({"AnatomicalStructurePrimary": "CortexLeft"})
    >>> notes.transforms
    ()
    """

    metadata: Mapping[str, str] | Sequence[tuple[str, str]] = ()
    transforms: Sequence[GiftiTransform] = ()


class GiftiColumn(NamedTuple):
    """One number per vertex.

    Attributes
    ----------
    intent : str
        what the numbers are: ``"SHAPE"``, ``"LABEL"``, ``"TIME_SERIES"``, ``"NONE"`` and others.
    name : str
        the name of the column; empty where the file gives none.
    values : Doubles
        the numbers; a NaN in the file stays one.

    Examples
    --------
    >>> import numpy as np
    >>> ricci.GiftiColumn("SHAPE", "sulc", np.zeros(3)).name
    'sulc'
    """

    intent: str
    name: str
    values: Doubles


class GiftiLabel(NamedTuple):
    """A row of the table of labels.

    Attributes
    ----------
    key : int
        the number that stands at vertices.
    name : str
        the name.
    color : tuple[float, float, float, float]
        red, green, blue and opacity from 0 to 1.

    Examples
    --------
    >>> ricci.GiftiLabel(7, "cuneus", (1, 0.25, 0.5, 1)).key
    7
    """

    key: int
    name: str
    color: tuple[float, float, float, float]


class GiftiColumns(NamedTuple):
    """What a file of values or labels holds.

    Attributes
    ----------
    columns : list[GiftiColumn]
        the arrays with one number per vertex, in the order of the file.
    table : list[GiftiLabel]
        the table of labels.

    Examples
    --------
    >>> ricci.GiftiColumns([], [ricci.GiftiLabel(7, "cuneus", (1, 0, 0, 1))]).table[0].name
    'cuneus'
    """

    columns: list[GiftiColumn]
    table: list[GiftiLabel]


def read_gifti_notes(path: FileName) -> GiftiNotes:
    """The notes of a file: metadata of the file and of its first array, and the transforms of its points.

    Parameters
    ----------
    path : FileName
        the file, packed by gzip or not.

    Examples
    --------
    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "lh.surf.gii")
    >>> ricci.write_gifti_surface(path, ricci.make("sphere", n=2), notes=ricci.GiftiNotes({"GeometricType": "Spherical"}))
    >>> ricci.read_gifti_notes(path).metadata
    (('GeometricType', 'Spherical'),)
    """
    notes = _made("gifti_notes", lib.ricci_gifti_notes_read, path_bytes(path))
    n_metadata, n_transforms = _counts(lib.ricci_gifti_notes_count, notes)
    pairs = [_item("gifti_note", lib.ricci_gifti_notes_get, notes, k) for k in range(n_metadata)]
    ways = [_item("gifti_transform", lib.ricci_gifti_notes_transform, notes, k) for k in range(n_transforms)]
    return GiftiNotes(
        tuple((_words(pair.name), _words(pair.value)) for pair in pairs),
        tuple(GiftiTransform(_words(getattr(way, "from")), _words(way.to), np.array([*way.matrix]).reshape(4, 4)) for way in ways),
    )


def read_gifti_columns(path: FileName) -> GiftiColumns:
    """The arrays of a file that have one number per vertex, and its table of labels; surfaces and vectors are passed over.

    Parameters
    ----------
    path : FileName
        the file (.shape.gii, .func.gii, .label.gii), packed by gzip or not.

    Examples
    --------
    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "lh.shape.gii")
    >>> ricci.write_gifti_values(path, {"sulc": [0.5, 1.5], "curv": [2, 3]})
    >>> [(column.name, column.values.tolist()) for column in ricci.read_gifti_columns(path).columns]
    [('sulc', [0.5, 1.5]), ('curv', [2.0, 3.0])]
    """
    file = _made("gifti_columns", lib.ricci_gifti_columns_read, path_bytes(path))
    n_columns, n_labels = _counts(lib.ricci_gifti_columns_count, file)
    columns = [_item("gifti_column", lib.ricci_gifti_columns_get, file, k) for k in range(n_columns)]
    rows = [_item("gifti_label", lib.ricci_gifti_columns_label, file, k) for k in range(n_labels)]
    return GiftiColumns(
        [GiftiColumn(_words(column.intent), _words(column.name), _numbers(column)) for column in columns],
        [GiftiLabel(int(row.key), _words(row.name), tuple(row.color)) for row in rows],
    )


def write_gifti_surface(path: FileName, V: MeshLike, F: npt.ArrayLike | None = None, *, notes: GiftiNotes | None = None) -> None:
    """Write a surface (.surf.gii) with notes, in single precision; packed where the name ends in .gz.

    Parameters
    ----------
    path : FileName
        the file.
    V : MeshLike
        n x 3 positions with `F`; without, a mesh of any kind (`as_mesh`).
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    notes : GiftiNotes | None
        metadata and transforms; without a transform the identity is written.

    Examples
    --------
    >>> import numpy as np
    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "lh.surf.gii")
    >>> shift = ricci.GiftiTransform("NIFTI_XFORM_SCANNER_ANAT", "NIFTI_XFORM_MNI_152", np.diag([2, 2, 2, 1]))
    >>> ricci.write_gifti_surface(path, ricci.make("sphere", n=2), notes=ricci.GiftiNotes(transforms=[shift]))
    >>> ricci.read(path).n_faces
    80
    """
    if F is None:
        mesh = as_mesh(V)
        V, F = mesh.V, mesh.F
    places, faces = _arrays.real(V, 3, "V"), _arrays.indices(F, 3, "F")
    told = _told(notes)
    call(lib.ricci_gifti_surface_write, path_bytes(path), pointer(places), len(places), pointer(faces), len(faces), told)


def write_gifti_values(path: FileName, columns: Mapping[str, npt.ArrayLike], *, notes: GiftiNotes | None = None) -> None:
    """Write values at the vertices of a surface (.shape.gii), in single precision; packed where the name ends in .gz.

    Parameters
    ----------
    path : FileName
        the file.
    columns : Mapping[str, npt.ArrayLike]
        n values for each name; a NaN stays one.
    notes : GiftiNotes | None
        metadata; transforms, which are those of points, are left out.

    Examples
    --------
    >>> import os, tempfile
    >>> notes = ricci.GiftiNotes({"AnatomicalStructurePrimary": "CortexLeft"})
    >>> ricci.write_gifti_values(os.path.join(tempfile.mkdtemp(), "lh.shape.gii"), {"sulc": [0.5, 1.5]}, notes=notes)
    """
    if not isinstance(columns, Mapping):
        raise ArgumentTypeError(f"columns are a dict of names and values, not {type(columns).__name__}")
    given = [_arrays.real(values, None, name) for name, values in columns.items()]
    n = given[0].size if given else 0
    for name, values in zip(columns, given, strict=True):
        if values.shape != (n,):
            raise ArgumentError(f"{name} has shape {values.shape}, ({n},) is needed")
    values = np.concatenate([np.empty(0), *given])
    names, told = _lines(columns), _told(notes)
    call(lib.ricci_gifti_values_write, path_bytes(path), names, pointer(values), n, len(given), told)


def write_gifti_labels(path: FileName, labels: npt.ArrayLike, table: Sequence[GiftiLabel], *, notes: GiftiNotes | None = None) -> None:
    """Write labels at the vertices of a surface (.label.gii) with their table; packed where the name ends in .gz.

    Parameters
    ----------
    path : FileName
        the file.
    labels : npt.ArrayLike
        per vertex a key of the table.
    table : Sequence[GiftiLabel]
        key, name and colour of each label.
    notes : GiftiNotes | None
        metadata; transforms, which are those of points, are left out.

    Examples
    --------
    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "lh.label.gii")
    >>> ricci.write_gifti_labels(path, [7, 7, 0], [(0, "???", (0, 0, 0, 0)), (7, "cuneus", (1, 0, 0, 1))])
    >>> ricci.read_gifti_columns(path).table[1].name
    'cuneus'
    """
    numbers = _arrays.signed(labels, "labels")
    rows = _rows(table)
    keys = _arrays.signed([row.key for row in rows], "keys")
    if not all(np.shape(row.color) == (4,) for row in rows):
        raise ArgumentError("a colour is four numbers: red, green, blue and opacity")
    colors = _arrays.real([row.color for row in rows] or np.empty((0, 4)), 4, "colors")
    names, told = _lines(row.name for row in rows), _told(notes)
    call(
        lib.ricci_gifti_labels_write,
        *(path_bytes(path), pointer(numbers), numbers.size),
        *(pointer(keys), names, pointer(colors), len(rows), told),
    )


def _made(kind: str, function: Any, *arguments: object) -> Any:
    """The object that a function returns through its last argument, freed with the Python object."""
    out = ffi.new(f"ricci_{kind} **")
    call(function, *arguments, out)
    return ffi.gc(out[0], lib.ricci_gifti_notes_free if kind == "gifti_notes" else lib.ricci_gifti_columns_free)


def _counts(function: Any, of: Any) -> tuple[int, int]:
    first, second = ffi.new("size_t *"), ffi.new("size_t *")
    call(function, of, first, second)
    return int(first[0]), int(second[0])


def _item(kind: str, function: Any, of: Any, k: int) -> Any:
    """The struct that a function fills for one of several items, whose texts live as long as `of`."""
    item = ffi.new(f"ricci_{kind} *")
    call(function, of, k, item, ffi.sizeof(item[0]))
    return item


def _words(text: Any) -> str:
    return ffi.string(text).decode()


def _numbers(column: Any) -> Doubles:
    """A copy of the numbers of a column."""
    return np.frombuffer(ffi.buffer(column.values, 8 * column.n)).copy() if column.n else np.empty(0)


def _text(text: Any) -> bytes:
    """A text as the library takes it."""
    if not isinstance(text, str):
        raise ArgumentTypeError(f"a text is needed, not {type(text).__name__}")
    if "\0" in text:
        raise ArgumentError(f"{text!r} has a zero, which would end it")
    return text.encode()


def _lines(names: Any) -> bytes:
    """Names, one to a line."""
    return b"".join(_text(name) + b"\n" for name in names)


def _rows(table: Any) -> list[GiftiLabel]:
    """The rows of a table of labels."""
    if not isinstance(table, Sequence) or not all(isinstance(row, tuple | list) and len(row) == 3 for row in table):
        raise ArgumentTypeError("a table is a list of labels: key, name and colour of each")
    return [GiftiLabel(*row) for row in table]


def _told(notes: GiftiNotes | None) -> Any:
    """The notes as the library takes them."""
    if notes is None:
        return ffi.NULL
    if not isinstance(notes, GiftiNotes):
        raise ArgumentTypeError(f"notes are a GiftiNotes, not {type(notes).__name__}")
    made = _made("gifti_notes", lib.ricci_gifti_notes_new)
    pairs = notes.metadata.items() if isinstance(notes.metadata, Mapping) else notes.metadata
    for name, value in pairs:
        call(lib.ricci_gifti_notes_add, made, _text(name), _text(value))
    for source, target, given in notes.transforms:
        matrix = _arrays.real(given, 4, "matrix")
        if matrix.shape != (4, 4):
            raise ArgumentError(f"matrix has shape {matrix.shape}, (4, 4) is needed")
        call(lib.ricci_gifti_notes_add_transform, made, _text(source), _text(target), pointer(matrix))
    return made
