"""Meshes of other libraries: trimesh, meshio, PyVista and nibabel give and take them. None of these is needed to import this package.

Normals, colours and texture coordinates go along both ways. Where a library has one pair of texture coordinates for each vertex and those
of a mesh have seams, they become an attribute `uv` of its faces (m x 6, the pairs of the three corners): cutting the mesh open along the
seams would make another surface of it. A layout is that other surface: it is given with a vertex for each of its points, so that each has
one pair, and the number of its mesh's vertex as the attribute `vertex`.
"""

from __future__ import annotations

import os
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from ricci.errors import ArgumentError, ArgumentTypeError
from ricci.mesh import Attributes, Mesh

__all__ = ["MeshLike", "as_mesh", "from_arrays_of", "to_meshio", "to_polyscope", "to_pyvista", "to_trimesh"]

# A Mesh, a file's name, a pair of arrays (V, F), or an object of trimesh, meshio, PyVista or nibabel; as V with F = None.
MeshLike: TypeAlias = Any
_Arrays: TypeAlias = "tuple[npt.ArrayLike, npt.ArrayLike]"
_Found: TypeAlias = "tuple[npt.ArrayLike, npt.ArrayLike, Attributes]"


def as_mesh(V: MeshLike, F: npt.ArrayLike | None = None) -> Mesh:
    """The mesh that the arguments `V, F` of this package stand for.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`; without, a `Mesh`, a file's name, a pair (V, F), or another library's mesh.
    F : npt.ArrayLike | None
        m x 3 vertex indices from 0.

    Raises
    ------
    ArgumentError
        not a mesh.
    MeshError
        the faces are no surface.

    Examples
    --------
    >>> mesh = ricci.as_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> mesh
    <ricci.Mesh: 3 vertices, 1 faces, genus 0, 1 boundary loops>
    """
    if F is not None:
        if isinstance(V, Mesh | str | os.PathLike | tuple) or _is_foreign(V):
            given = f"{F!r:.40}"
            raise ArgumentTypeError(
                f"{type(V).__name__} is a whole mesh, so that {given} behind it is not its faces: name the argument, as in target={given}"
            )
        return Mesh(V, F)
    if isinstance(V, Mesh):
        return V
    if isinstance(V, str | os.PathLike):
        return Mesh.read(V)
    points, faces, attributes = _parts_of(V)
    mesh = Mesh(points, faces)
    return mesh.with_attributes(**attributes) if attributes else mesh


def from_arrays_of(other: Any) -> _Arrays:
    """Positions and triangles of a pair (V, F), or of another library's mesh.

    Raises
    ------
    ArgumentError
        it is none of these, or has other faces than triangles.
    """
    points, faces, _ = _parts_of(other)
    return points, faces


def _parts_of(other: Any) -> _Found:
    """Positions, triangles and attributes."""
    if isinstance(other, tuple) and len(other) == 2:
        return *other, {}
    for read in (_of_pyvista, _of_meshio, _of_trimesh, _of_nibabel):
        found = read(other)
        if found is not None:
            return found
    if isinstance(other, np.ndarray | list):
        raise ArgumentTypeError("positions V alone are no mesh: give the faces F behind them, or name the file")
    raise ArgumentTypeError(f"a mesh, a file or arrays V and F are needed, not {type(other).__name__}")


def _is_foreign(other: Any) -> bool:
    """True of a mesh of another library."""
    return any(hasattr(other, name) for name in ("points", "vertices", "agg_data"))


def _corners(values: npt.ArrayLike, faces: npt.ArrayLike) -> npt.NDArray[Any]:
    """Values of vertices at the corners of the faces."""
    return np.asarray(values, float)[np.asarray(faces)]


def _named(points: Any, cells: Any, faces: npt.ArrayLike) -> Attributes:
    """The attributes of these names in mappings of arrays at vertices and faces."""
    found: Attributes = {}
    n, m = len(np.asarray(points.get("normals", ()))), len(np.asarray(faces))
    if n and np.shape(points["normals"]) == (n, 3):
        found["normals"] = np.asarray(points["normals"], float)
    if "colors" in points and np.ndim(points["colors"]) == 2 and np.shape(points["colors"])[1] == 4:
        found["colors"] = np.asarray(points["colors"], float)
    if "uv" in points and np.ndim(points["uv"]) == 2 and np.shape(points["uv"])[1] == 2:
        found["uv"] = _corners(points["uv"], faces)
    if "uv" in cells and np.size(cells["uv"]) == 6 * m:
        found["uv"] = np.reshape(np.asarray(cells["uv"], float), (m, 3, 2))
    if "corner_normals" in cells and np.size(cells["corner_normals"]) == 9 * m:
        found["corner_normals"] = np.reshape(np.asarray(cells["corner_normals"], float), (m, 3, 3))
    return found


def _of_meshio(other: Any) -> _Found | None:
    """meshio.Mesh: `points` and blocks of cells, of which those of two dimensions must be triangles."""
    if not (hasattr(other, "points") and hasattr(other, "cells_dict")):
        return None
    wrong = sorted({"quad", "polygon", "triangle6"} & set(other.cells_dict))
    if wrong or "triangle" not in other.cells_dict:
        raise ArgumentError(f"triangles are needed, not {', '.join(map(str, other.cells_dict))}")
    points, faces = np.asarray(other.points), other.cells_dict["triangle"]
    cells = {name: values["triangle"] for name, values in getattr(other, "cell_data_dict", {}).items() if "triangle" in values}
    attributes = _named(getattr(other, "point_data", {}), cells, faces)
    return (points if points.shape[1] == 3 else np.pad(points, ((0, 0), (0, 1)))), faces, attributes


def _of_pyvista(other: Any) -> _Found | None:
    """pyvista.PolyData: `points`, and faces as rows of a count and as many vertices."""
    if hasattr(other, "combine") and hasattr(other, "n_blocks"):
        raise ArgumentTypeError(f"one surface is needed, not {type(other).__name__}: combine().extract_surface().triangulate() makes one")
    if not hasattr(other, "is_all_triangles"):
        if hasattr(other, "extract_surface"):
            raise ArgumentTypeError(f"a surface is needed, not {type(other).__name__}: extract_surface().triangulate() makes one of it")
        return None
    if not other.is_all_triangles:
        raise ArgumentError("triangles are needed: PolyData.triangulate makes them")
    faces = np.asarray(other.faces).reshape(-1, 4)[:, 1:]
    attributes = _named(other.point_data, other.cell_data, faces)
    if "uv" not in attributes and getattr(other, "active_texture_coordinates", None) is not None:
        attributes["uv"] = _corners(np.asarray(other.active_texture_coordinates)[:, :2], faces)
    if "normals" not in attributes and "Normals" in other.point_data:
        attributes["normals"] = np.asarray(other.point_data["Normals"], float)
    return other.points, faces, attributes


def _of_trimesh(other: Any) -> _Found | None:
    """trimesh.Trimesh, and every other object with `vertices` and `faces`."""
    if hasattr(other, "geometry") and hasattr(other, "graph"):
        raise ArgumentTypeError(f"one mesh is needed, not {type(other).__name__}: to_mesh() makes one of it, its geometry has each")
    if not (hasattr(other, "vertices") and hasattr(other, "faces")):
        return None
    faces = np.asarray(other.faces)
    attributes = _named(getattr(other, "vertex_attributes", {}), getattr(other, "face_attributes", {}), faces)
    visual: Any = getattr(other, "visual", None)
    kind, uv = getattr(visual, "kind", None), getattr(visual, "uv", None)
    if uv is not None and "uv" not in attributes:
        attributes["uv"] = _corners(uv, faces)
    if kind == "vertex" and "colors" not in attributes:
        attributes["colors"] = np.asarray(visual.vertex_colors) / 255.0
    return other.vertices, faces, attributes


def _of_nibabel(other: Any) -> _Found | None:
    """nibabel.GiftiImage: a surface's pointset and triangles."""
    if not hasattr(other, "agg_data"):
        return None
    found = other.agg_data(("pointset", "triangle"))
    if any(np.size(part) == 0 for part in found):
        raise ArgumentError("this GIFTI image has no pointset and triangles: it is not the file of the surface, which is beside it")
    return *found, {}


class Dressed(NamedTuple):
    """A mesh, or a layout cut open, as other libraries take it."""

    #: n x 3.
    V: npt.NDArray[Any]
    #: m x 3.
    F: npt.NDArray[Any]
    #: n x 2 texture coordinates of the vertices, where their corners agree on them.
    uv: npt.NDArray[Any] | None
    #: Attributes of the vertices and the caller's fields, by name.
    at_vertices: dict[str, Any]
    #: Attributes of corners that do not fit vertices, one row for each face.
    at_faces: dict[str, Any]


def dressed(mesh: MeshLike, fields: dict[str, Any]) -> Dressed:
    """A mesh of any kind with its attributes and the caller's fields; a layout, or charts, with a vertex for each of their points.

    Raises
    ------
    ArgumentError
        a field that has not one row for each vertex.
    """
    cut = getattr(mesh, "_cut_open", None)
    if cut is not None:
        points, faces, uv, origins = cut()
        return Dressed(points, faces, uv, {"vertex": origins, **_rows(fields, len(origins), origins)}, {})
    mesh = as_mesh(mesh)
    fields = _rows(fields, mesh.n_vertices, None)
    own = {"normals": mesh.normals, "colors": mesh.colors}
    at_vertices = {**{name: np.array(values) for name, values in own.items() if values is not None}, **fields}
    uv, at_faces = None, {}
    if mesh.uv is not None:
        found = np.zeros((mesh.n_vertices, 2))
        found[mesh.F] = mesh.uv
        uv = found if np.array_equal(found[mesh.F], mesh.uv) else None
        if uv is None:
            at_faces["uv"] = mesh.uv.reshape(-1, 6).copy()
    if mesh.corner_normals is not None:
        at_faces["corner_normals"] = mesh.corner_normals.reshape(-1, 9).copy()
    return Dressed(mesh.V, mesh.F.astype(np.int64), uv, at_vertices, at_faces)


def _rows(fields: dict[str, Any], n: int, origins: npt.NDArray[Any] | None) -> dict[str, Any]:
    """Fields with n rows; of a layout those with a row for each vertex of its mesh have one for each point."""
    found = {}
    for name, values in fields.items():
        rows = np.shape(values)[:1]
        whole = None if origins is None else int(origins.max()) + 1
        if rows == (n,):
            found[name] = values
        elif origins is not None and rows == (whole,):
            found[name] = np.asarray(values)[origins]
        else:
            needed = f"{n} rows are needed" if whole is None else f"{whole} rows, of the mesh, or {n}, of the points, are needed"
            raise ArgumentError(f"{name} has shape {np.shape(values)}, {needed}")
    return found


def to_trimesh(mesh: MeshLike, **fields: Any) -> Any:
    """A `trimesh.Trimesh` with the same vertices and faces, in order; `fields` (n rows each) become vertex attributes.

    Texture coordinates become its visual, or the face attribute `uv` where they have seams; colours its visual, beside texture coordinates
    the vertex attribute `colors`; normals the vertex attribute `normals`.

    Parameters
    ----------
    mesh : MeshLike
        a mesh of any kind (`as_mesh`), or a `Layout`, `RepairedInput` or `Charts`.
    fields : Any
        n rows each, by the name of the vertex attribute.

    Examples
    --------
    >>> ricci.to_trimesh(ricci.make("sphere", n=2)).is_watertight
    True
    """
    import trimesh

    V, F, uv, at_vertices, at_faces = dressed(mesh, fields)
    colors = at_vertices.pop("colors", None) if uv is None and "colors" not in fields else None
    return trimesh.Trimesh(
        V,
        F,
        process=False,
        vertex_attributes=at_vertices,
        face_attributes=at_faces,
        vertex_colors=None if colors is None else np.round(255 * colors).astype(np.uint8),
        visual=None if uv is None else trimesh.visual.TextureVisuals(uv=uv),
    )


def to_meshio(mesh: MeshLike, **fields: Any) -> Any:
    """A `meshio.Mesh`; `fields` (n rows each) become point data.

    Normals, colours and texture coordinates are the point data `normals`, `colors` and `uv`, the last at seams the cell data `uv`.

    Parameters
    ----------
    mesh : MeshLike
        a mesh of any kind (`as_mesh`), or a `Layout`, `RepairedInput` or `Charts`.
    fields : Any
        n rows each, by the name of the point data.

    Examples
    --------
    >>> ricci.to_meshio(ricci.make("disk", n=2)).cells_dict["triangle"].shape
    (24, 3)
    """
    import meshio

    V, F, uv, at_vertices, at_faces = dressed(mesh, fields)
    points = at_vertices if uv is None else {"uv": uv, **at_vertices}
    return meshio.Mesh(V, [("triangle", F)], point_data=points, cell_data={name: [values] for name, values in at_faces.items()})


def to_pyvista(mesh: MeshLike, **fields: Any) -> Any:
    """A `pyvista.PolyData`; `fields` (n rows each) become point data.

    Texture coordinates are its active ones, or the cell data `uv` where they have seams; normals and colours are point data.

    Parameters
    ----------
    mesh : MeshLike
        a mesh of any kind (`as_mesh`), or a `Layout`, `RepairedInput` or `Charts`.
    fields : Any
        n rows each, by the name of the point data.

    Examples
    --------
    >>> mesh = ricci.make("disk", n=2)
    >>> ricci.to_pyvista(mesh, height=mesh.V[:, 2]).array_names
    ['height']
    """
    import pyvista

    V, F, uv, at_vertices, at_faces = dressed(mesh, fields)
    made = pyvista.PolyData.from_regular_faces(np.array(V), F)
    if uv is not None:
        made.active_texture_coordinates = uv
    for name, values in at_vertices.items():
        made.point_data[name] = values
    for name, values in at_faces.items():
        made.cell_data[name] = values
    return made


def to_polyscope(mesh: MeshLike, name: str = "ricci", **fields: Any) -> Any:
    """Show the mesh in Polyscope: its `SurfaceMesh`, registered under this name; call ``polyscope.init()`` before.

    Texture coordinates become the parameterization `uv`, of a mesh with seams at its corners; `fields` (n numbers each) scalar quantities
    and those of n x 3 vectors.

    Parameters
    ----------
    mesh : MeshLike
        a mesh of any kind (`as_mesh`), or a `Layout`, `RepairedInput` or `Charts`.
    name : str
        the name in Polyscope's list of structures.
    fields : Any
        n rows each, by the name of the quantity.

    Examples
    --------
    >>> import polyscope
    >>> polyscope.init("openGL_mock")
    >>> ricci.to_polyscope(ricci.make("sphere", n=2)).n_vertices()
    42
    """
    import polyscope

    V, F, uv, at_vertices, at_faces = dressed(mesh, fields)
    made = polyscope.register_surface_mesh(name, V, F)
    if uv is not None:
        made.add_parameterization_quantity("uv", uv, defined_on="vertices")
    elif "uv" in at_faces:
        made.add_parameterization_quantity("uv", at_faces["uv"].reshape(-1, 2), defined_on="corners")
    for label, values in at_vertices.items():
        array = np.asarray(values, float)
        if label == "colors":
            made.add_color_quantity(label, array[:, :3])
        elif array.ndim == 2 and array.shape[1] == 3:
            made.add_vector_quantity(label, array)
        else:
            made.add_scalar_quantity(label, array)
    return made
