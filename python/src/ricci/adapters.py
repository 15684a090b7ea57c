"""Meshes of other libraries: trimesh, meshio, PyVista and nibabel give and take them. None of these is needed to import this package."""

from __future__ import annotations

import os
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ricci.errors import ArgumentError
from ricci.mesh import Mesh

__all__ = ["MeshLike", "as_mesh", "from_arrays_of", "to_gifti", "to_meshio", "to_pyvista", "to_trimesh"]

# A Mesh, a file's name, a pair of arrays (V, F), or an object of trimesh, meshio, PyVista or nibabel; as V with F = None.
MeshLike: TypeAlias = Any
_Arrays: TypeAlias = "tuple[npt.ArrayLike, npt.ArrayLike]"


def as_mesh(V: MeshLike, F: npt.ArrayLike | None = None) -> Mesh:
    """The mesh that the arguments `V, F` of this package stand for.

    Args:
        V: n x 3 positions with `F`; without, a `Mesh`, a file's name, a pair (V, F), or another library's mesh.
        F: m x 3 vertex indices from 0.

    Raises:
        ArgumentError: not a mesh.
        MeshError: the faces are no surface.
    """
    if F is not None:
        return Mesh(V, F)
    if isinstance(V, Mesh):
        return V
    if isinstance(V, str | os.PathLike):
        return Mesh.read(V)
    return Mesh(*from_arrays_of(V))


def from_arrays_of(other: Any) -> _Arrays:
    """Positions and triangles of a pair (V, F), or of another library's mesh.

    Raises:
        ArgumentError: it is none of these, or has other faces than triangles.
    """
    if isinstance(other, tuple) and len(other) == 2:
        return other
    for read in (_of_meshio, _of_pyvista, _of_trimesh, _of_nibabel):
        found = read(other)
        if found is not None:
            return found
    raise ArgumentError(f"a mesh, a file or arrays V and F are needed, not {type(other).__name__}")


def _of_meshio(other: Any) -> _Arrays | None:
    """meshio.Mesh: `points` and blocks of cells, of which those of two dimensions must be triangles."""
    if not (hasattr(other, "points") and hasattr(other, "cells_dict")):
        return None
    wrong = sorted({"quad", "polygon", "triangle6"} & set(other.cells_dict))
    if wrong or "triangle" not in other.cells_dict:
        raise ArgumentError(f"triangles are needed, not {', '.join(other.cells_dict)}")
    points = np.asarray(other.points)
    return (points if points.shape[1] == 3 else np.pad(points, ((0, 0), (0, 1)))), other.cells_dict["triangle"]


def _of_pyvista(other: Any) -> _Arrays | None:
    """pyvista.PolyData: `points`, and faces as rows of a count and as many vertices."""
    if not (hasattr(other, "points") and hasattr(other, "is_all_triangles")):
        return None
    if not other.is_all_triangles:
        raise ArgumentError("triangles are needed: PolyData.triangulate makes them")
    return other.points, np.asarray(other.faces).reshape(-1, 4)[:, 1:]


def _of_trimesh(other: Any) -> _Arrays | None:
    """trimesh.Trimesh, and every other object with `vertices` and `faces`."""
    return (other.vertices, other.faces) if hasattr(other, "vertices") and hasattr(other, "faces") else None


def _of_nibabel(other: Any) -> _Arrays | None:
    """nibabel.GiftiImage: a surface's pointset and triangles."""
    return other.agg_data(("pointset", "triangle")) if hasattr(other, "agg_data") else None


def to_trimesh(mesh: Mesh, **fields: Any) -> Any:
    """A `trimesh.Trimesh` with the same vertices and faces, in order; `fields` (n rows each) become vertex attributes."""
    import trimesh

    return trimesh.Trimesh(mesh.V, mesh.F.astype(np.int64), process=False, vertex_attributes=fields)


def to_meshio(mesh: Mesh, **fields: Any) -> Any:
    """A `meshio.Mesh`; `fields` (n rows each) become point data."""
    import meshio

    return meshio.Mesh(mesh.V, [("triangle", mesh.F.astype(np.int64))], point_data=fields)


def to_pyvista(mesh: Mesh, **fields: Any) -> Any:
    """A `pyvista.PolyData`; `fields` (n rows each) become point data."""
    import pyvista

    made = pyvista.PolyData.from_regular_faces(np.array(mesh.V), mesh.F.astype(np.int64))
    for name, values in fields.items():
        made.point_data[name] = values
    return made


def to_gifti(mesh: Mesh, **fields: Any) -> Any:
    """A `nibabel.GiftiImage` with pointset and triangles; `fields` (n numbers each) become arrays with these names."""
    from nibabel.gifti import GiftiDataArray, GiftiImage

    points = GiftiDataArray(mesh.V.astype(np.float32), intent="NIFTI_INTENT_POINTSET", datatype="NIFTI_TYPE_FLOAT32")
    faces = GiftiDataArray(mesh.F.astype(np.int32), intent="NIFTI_INTENT_TRIANGLE", datatype="NIFTI_TYPE_INT32")
    image = GiftiImage(darrays=[points, faces])
    for name, values in fields.items():
        data = np.asarray(values, np.float32)
        image.add_gifti_data_array(GiftiDataArray(data, intent="NIFTI_INTENT_SHAPE", datatype="NIFTI_TYPE_FLOAT32", meta={"Name": name}))
    return image
