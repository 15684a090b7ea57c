"""GIFTI, the surfaces of brains: with labels and their tables, shapes, and what part of the anatomy they are."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ricci.adapters import MeshLike, dressed
from ricci.errors import ArgumentError, ArgumentTypeError
from ricci.mesh import Mesh

__all__ = ["Gifti", "from_gifti", "to_gifti"]


class Gifti(NamedTuple):
    """The content of a GIFTI image.

    Attributes
    ----------
    mesh : Mesh | None
        the surface; None in files of labels or shapes alone.
    fields : dict[str, npt.NDArray[Any]]
        the other arrays by their names, whole numbers where they are labels.
    labels : dict[int, str]
        the names of the labels.
    anatomy : dict[str, str]
        what the surface is of, such as ``{"AnatomicalStructurePrimary": "CortexLeft", "GeometricType": "Inflated"}``.

    Examples
    --------
    >>> image = ricci.to_gifti(ricci.make("sphere", n=2), anatomy={"AnatomicalStructurePrimary": "CortexLeft"})
    >>> ricci.from_gifti(image).anatomy
    {'AnatomicalStructurePrimary': 'CortexLeft'}
    """

    mesh: Mesh | None
    fields: dict[str, npt.NDArray[Any]]
    labels: dict[int, str]
    anatomy: dict[str, str]


def to_gifti(mesh: MeshLike, *, labels: Mapping[int, str] | None = None, anatomy: Mapping[str, str] | None = None, **fields: Any) -> Any:
    """A `nibabel.GiftiImage` with pointset and triangles; `fields` (n numbers each) become arrays with these names.

    Whole numbers and flags are labels: they get the intent LABEL and a table of their values; other numbers have the intent SHAPE. GIFTI
    has no place for texture coordinates, whose loss is a warning.

    Parameters
    ----------
    mesh : MeshLike
        a mesh of any kind (`as_mesh`), or a `Layout`, `RepairedInput` or `Charts`.
    labels : Mapping[int, str] | None
        the names of labels; those without are called by their numbers.
    anatomy : Mapping[str, str] | None
        the metadata of the surface: `AnatomicalStructurePrimary` is ``"CortexLeft"`` or ``"CortexRight"``, and so on; `GeometricType` is
        ``"Anatomical"``, ``"Inflated"``, ``"Spherical"`` or ``"Flat"``. The first is also given to the arrays of the fields' file.
    fields : Any
        n numbers for each vertex, each by the name of its array.

    Examples
    --------
    >>> import numpy as np
    >>> mesh = ricci.make("sphere", n=2)
    >>> image = ricci.to_gifti(mesh, parcel=np.arange(mesh.n_vertices) % 3, labels={1: "motor"})
    >>> [label.label for label in image.labeltable.labels]
    ['0', 'motor', '2']
    """
    from nibabel.gifti import GiftiDataArray, GiftiImage, GiftiMetaData

    V, F, uv, at_vertices, at_faces = dressed(mesh, fields)
    told = {str(name): str(value) for name, value in (anatomy or {}).items()}
    points = GiftiDataArray(V.astype(np.float32), intent="NIFTI_INTENT_POINTSET", datatype="NIFTI_TYPE_FLOAT32", meta=told)
    faces = GiftiDataArray(F.astype(np.int32), intent="NIFTI_INTENT_TRIANGLE", datatype="NIFTI_TYPE_INT32")
    image = GiftiImage(darrays=[points, faces])
    structure = told.get("AnatomicalStructurePrimary")
    if structure is not None:
        image.meta = GiftiMetaData({"AnatomicalStructurePrimary": structure})
    if uv is not None or "uv" in at_faces:
        warnings.warn("GIFTI has no place for texture coordinates: they are left out", UserWarning, stacklevel=2)
    names = {int(key): str(name) for key, name in (labels or {}).items()}
    for name, values in at_vertices.items():
        image.add_gifti_data_array(_gifti_array(name, np.asarray(values), image, names))
    return image


def from_gifti(image: Any) -> Gifti:
    """The content of a GIFTI image or file: the surface, labels with their names, shapes, and the anatomy.

    Parameters
    ----------
    image : Any
        a `nibabel.GiftiImage`, or the name of a file.

    Raises
    ------
    ArgumentTypeError
        it is neither.

    Examples
    --------
    >>> mesh = ricci.make("sphere", n=2)
    >>> found = ricci.from_gifti(ricci.to_gifti(mesh, depth=mesh.V[:, 2]))
    >>> found.mesh.n_faces, sorted(found.fields)
    (80, ['depth'])
    """
    if isinstance(image, str | os.PathLike):
        import nibabel

        image = nibabel.load(image)
    if not hasattr(image, "darrays"):
        raise ArgumentTypeError(f"a GiftiImage, or the name of a file, is needed, not {type(image).__name__}")
    surface: dict[str, Any] = {}
    fields: dict[str, npt.NDArray[Any]] = {}
    anatomy = {str(name): str(value) for name, value in dict(image.meta).items()}
    for array in image.darrays:
        intent = _INTENTS.get(int(array.intent), "field")
        if intent == "field":
            name = str(array.metadata.get("Name", f"field{len(fields)}"))
            if name in fields:
                raise ArgumentError(f"two arrays of this image have the name {name!r}")
            fields[name] = np.asarray(array.data)
        else:
            surface[intent] = np.asarray(array.data)
            anatomy |= {str(name): str(value) for name, value in dict(array.metadata).items()}
    mesh = Mesh(surface["points"], surface["faces"]) if len(surface) == 2 else None
    names = {int(label.key): str(label.label) for label in image.labeltable.labels}
    kept = {name: value for name, value in anatomy.items() if name in _ANATOMY}
    return Gifti(mesh, fields, names, kept)


# The arrays of a surface by their intents, and the names of metadata that tell the anatomy.
_INTENTS = {1008: "points", 1009: "faces"}
_ANATOMY = ("AnatomicalStructurePrimary", "AnatomicalStructureSecondary", "GeometricType", "TopologicalType")


def _gifti_array(name: str, values: npt.NDArray[Any], image: Any, names: Mapping[int, str]) -> Any:
    """One array of a GIFTI image, with the intent that its numbers have; labels are entered into the image's table."""
    from nibabel.gifti import GiftiDataArray, GiftiLabel

    if values.dtype.kind in "iub":
        known = {label.key for label in image.labeltable.labels}
        for key in np.unique(values.astype(np.int32)).tolist():
            if key not in known:
                label = GiftiLabel(key, *_color_of(key))
                label.label = names.get(key, str(key))
                image.labeltable.labels.append(label)
        labels = np.asarray(values, np.int32)
        return GiftiDataArray(labels, intent="NIFTI_INTENT_LABEL", datatype="NIFTI_TYPE_INT32", meta={"Name": name})
    if values.dtype.kind != "f":
        raise ArgumentTypeError(f"{name}: GIFTI holds numbers, not {values.dtype}")
    intent = {3: "NIFTI_INTENT_VECTOR", 4: "NIFTI_INTENT_RGBA_VECTOR"}.get(values.shape[1] if values.ndim == 2 else 0, "NIFTI_INTENT_SHAPE")
    return GiftiDataArray(values.astype(np.float32), intent=intent, datatype="NIFTI_TYPE_FLOAT32", meta={"Name": name})


def _color_of(key: int) -> tuple[float, float, float, float]:
    """A colour for a label: hues a golden section apart, so that near numbers are far apart; 0 is without colour."""
    if key == 0:
        return 0.0, 0.0, 0.0, 0.0
    hue = 6 * (key * 0.6180339887498949 % 1)
    red, green, blue = (min(max(abs((hue + turn) % 6 - 3) - 1, 0), 1) for turn in (0, 4, 2))
    return red, green, blue, 1.0
