"""Meshes: connected oriented triangulated surfaces with the lengths of their edges."""

from __future__ import annotations

import os
from functools import cached_property
from typing import Any, ClassVar, Literal, Self, TypedDict

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._arrays import frozen
from ricci._call import CONTROL, Doubles, Handle, Indices, Signed, call, constant, figures_of, filled, path_bytes, pointer, summary
from ricci._kept import Kept
from ricci._library import ffi, lib
from ricci._shown import Scene
from ricci._signatures import picked, takes
from ricci._structs import Struct, above_zero, choice, number, options, real_list
from ricci._triangles import Triangles
from ricci.control import Progress
from ricci.errors import ArgumentError, RicciError
from ricci.figures import MeshSummary, QualitySummary, RefineSummary
from ricci.figures.names import Space

__all__ = ["Attributes", "Mesh", "read"]


class Attributes(TypedDict, total=False):
    """Attributes that are written beside positions and faces.

    Attributes
    ----------
    normals : npt.ArrayLike
        n x 3, of the vertices.
    colors : npt.ArrayLike
        n x 4, of the vertices: red, green, blue, opacity, from 0 to 1.
    uv : npt.ArrayLike
        m x 3 x 2, texture coordinates of every corner.
    corner_normals : npt.ArrayLike
        m x 3 x 3, in place of `normals`.
    png : bytes
        the bytes of a PNG file, a texture for `uv`; .glb only.
    wrap : Literal["repeat", "mirror", "clamp"]
        how the texture goes on outside the unit square: ``"repeat"``, ``"mirror"``, ``"clamp"``.
    """

    normals: npt.ArrayLike
    colors: npt.ArrayLike
    uv: npt.ArrayLike
    corner_normals: npt.ArrayLike
    png: bytes
    wrap: Literal["repeat", "mirror", "clamp"]


def _png(struct: Struct, field: str, value: bytes) -> None:
    data = ffi.from_buffer("uint8_t[]", value)
    struct._kept.append(data)
    struct.put(field, data)
    struct.put("png_size", len(value))


_ATTRIBUTES = {
    "normals": real_list(),
    "colors": real_list(),
    "uv": real_list(),
    "corner_normals": real_list(),
    "png": _png,
    "wrap": choice("WRAP"),
}


class _List(Handle):
    """A triangle list of the library, on the way to a mesh with attributes."""

    _type: ClassVar[str] = "soup"


class Mesh(Kept, Triangles):
    """A connected oriented triangulated surface with the lengths of its edges. It never changes.

    Arrays are computed once and handed out read-only. Vertices, faces and corners have the order and numbers of the caller's arrays.

    Parameters
    ----------
    V : npt.ArrayLike
        n x 3 positions. Rows may lie apart in memory: a view of a wider array is not copied before the library reads it.
    F : npt.ArrayLike
        m x 3 vertex indices from 0, consistently oriented; int32 and uint32 arrays are read where they are.

    Raises
    ------
    MeshError
        the faces are no surface (`Soup` lists the defects).
    ArgumentError
        an index that is negative or too large.

    Examples
    --------
    >>> mesh = ricci.Mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> mesh.n_faces, mesh.euler, mesh.boundary[0].tolist()
    (2, 1, [2, 3, 0, 1])
    """

    _type: ClassVar[str] = "mesh"
    _made_by: ClassVar[str] = "ricci.as_mesh(V, F), or ricci.read(path),"
    _figures: ClassVar[tuple[str, ...]] = ("n_vertices", "n_edges", "n_faces", "euler", "genus", "n_boundary_loops")
    _faces_of: ClassVar[Any] = lib.ricci_mesh_faces
    _values_of: ClassVar[Any] = lib.ricci_mesh_values

    def __init__(self, V: npt.ArrayLike, F: npt.ArrayLike) -> None:
        positions, faces = _arrays.points(V), _arrays.indices(F, 3, "F")
        made = Mesh._made(lib.ricci_mesh_from_arrays, pointer(positions), positions.strides[0], len(positions), pointer(faces), len(faces))
        self._pointer = made._pointer

    def _scene(self) -> Scene | None:
        return Scene(self.V, self.F) if self.summary.has_positions else None

    @classmethod
    def read(cls, path: str | os.PathLike[str], progress: Progress = None) -> Self:
        """The mesh of a file with its attributes, in the file's numbers (.obj, .off, .ply, .stl, .glb, .gltf, .gii, .vtk, .vtp, .mz3,
        FreeSurfer's, or .gz behind).

        Raises
        ------
        FileError
            it cannot be read, or its ending is not known.
        ParseError
            its content is not what the format says; the index is that of the line or byte.
        MeshError
            the faces are no surface.
        """
        return cls._made(lib.ricci_mesh_read, path_bytes(path), progress=progress)

    @classmethod
    def from_gluing(cls, faces: npt.ArrayLike, face_edges: npt.ArrayLike, lengths: npt.ArrayLike, geometry: Space = "e2") -> Self:
        """An intrinsic surface: triangles glued along numbered edges. Two vertices may share several edges, an edge may be a loop.

        Parameters
        ----------
        faces : npt.ArrayLike
            m x 3 vertices (a, b, c).
        face_edges : npt.ArrayLike
            m x 3 edge numbers (bc, ca, ab) from 1, negative where the face runs against the edge.
        lengths : npt.ArrayLike
            that of edge number e at e - 1.
        geometry : Space
            in which the lengths are meant.
        """
        corners, edges = _arrays.indices(faces, 3, "faces"), _arrays.signed(face_edges, "face_edges")
        given = {"n_vertices": int(corners.max()) + 1, "n_faces": len(corners), "geometry": constant("SPACE", geometry)}
        struct = options("gluing", {**given, "lengths": lengths}, {**dict.fromkeys(given, number), "lengths": real_list(count="n_edges")})
        if edges.shape != corners.shape:
            raise ArgumentError(f"face_edges has shape {edges.shape}, faces {corners.shape}")
        struct.put("faces", corners)
        struct.put("face_edges", edges)
        return cls._made(lib.ricci_mesh_from_gluing, struct)

    def with_lengths(self, lengths: npt.ArrayLike, geometry: Space = "e2") -> Mesh:
        """The same mesh with these lengths of its `edges`; positions then serve to draw and write alone."""
        array = _arrays.real(lengths)
        return Mesh._made(lib.ricci_mesh_with_lengths, self, pointer(array), array.size, constant("SPACE", geometry))

    @takes(Attributes)
    def with_attributes(
        self,
        *,
        normals: npt.ArrayLike | None = None,
        colors: npt.ArrayLike | None = None,
        uv: npt.ArrayLike | None = None,
        corner_normals: npt.ArrayLike | None = None,
        png: bytes | None = None,
        wrap: Literal["repeat", "mirror", "clamp"] | None = None,
    ) -> Mesh:
        """The same mesh with these attributes in place of its own: normals, colors, uv, corner_normals."""
        attributes = picked(locals(), Attributes)
        given = options("attributes", attributes, _ATTRIBUTES)
        self._check_attributes(attributes)
        positions, faces = _arrays.points(self.V), _arrays.indices(self.F, 3, "F")
        of = (pointer(positions), positions.strides[0], len(positions), pointer(faces), len(faces))
        plain = _List._made(lib.ricci_soup_from_arrays, *of)
        made = Mesh._made(lib.ricci_soup_mesh, _List._made(lib.ricci_soup_with_attributes, plain, given))
        if not np.array_equal(made.face_edges, self.face_edges):
            raise ArgumentError("this mesh has several edges between two vertices, or edges of an order of its own: it takes no attributes")
        kept = self._own_lengths()
        return made if kept is None else made.with_lengths(kept, self.summary.geometry)

    def mirrored(self) -> Mesh:
        """The mirror image: x has the other sign, and every face (a, b, c) is (a, c, b). Vertices and faces keep their numbers."""
        turned = [0, 2, 1]
        if not self.summary.has_positions:
            return Mesh.from_gluing(self.F[:, turned], -self.face_edges[:, turned], self.lengths, self.summary.geometry)
        aside = np.array([-1.0, 1.0, 1.0])
        found: Attributes = {}
        if self.colors is not None:
            found["colors"] = self.colors
        if self.normals is not None:
            found["normals"] = self.normals * aside
        if self.uv is not None:
            found["uv"] = self.uv[:, turned]
        if self.corner_normals is not None:
            found["corner_normals"] = self.corner_normals[:, turned] * aside
        made = Mesh(self.V * aside, self.F[:, turned])
        if found:
            made = made.with_attributes(**found)
        own = self._own_lengths()
        if own is None:
            return made
        # The mirror image may have its edges in another order.
        ours, theirs = np.abs(self.face_edges[:, turned]) - 1, np.abs(made.face_edges) - 1
        lengths = np.empty(made.summary.n_edges)
        lengths[theirs] = own[ours]
        return made.with_lengths(lengths, self.summary.geometry)

    def _own_lengths(self) -> Doubles | None:
        """The lengths of a mesh in space that were given in place of those between its positions, or None."""
        try:
            measured = Mesh(self.V, self.F)
            same = self.summary.geometry == "e2" and np.array_equal(measured.lengths, self.lengths)
        except RicciError:
            # Positions coincide: lengths are the caller's, or there are none.
            same = self.summary.geometry == "e2" and not self._has_lengths()
        return None if same else self.lengths

    def _has_lengths(self) -> bool:
        try:
            return len(self.lengths) > 0
        except RicciError:
            return False

    def refine_angle(
        self, least_angle: float | None = None, most_added: int | None = None, progress: Progress = None
    ) -> tuple[Mesh, RefineSummary]:
        """The same Euclidean metric on a Delaunay triangulation without small angles, as an intrinsic mesh, and the course.

        The mesh's `places` say where its vertices lie on this one.

        Parameters
        ----------
        least_angle : float | None
            the least angle of its triangles, radians, at most 30 degrees; None: 25 degrees.
        most_added : int | None
            the most vertices that are added; None: ten per face and 100000.
        progress : Progress
            a `Control` or a callback.
        """
        given = {"least_angle": least_angle, "most_added": most_added}
        struct = options("refine_options", given, dict.fromkeys(given, above_zero))
        out = ffi.new("ricci_refine_summary *")
        finer = Mesh._made(lib.ricci_mesh_refine_angle, self, struct, CONTROL, out, ffi.sizeof("ricci_refine_summary"), progress=progress)
        return finer, figures_of(RefineSummary, out)

    @cached_property
    def places(self) -> tuple[Indices, Doubles]:
        """Of a mesh that `refine_angle` made: for each vertex a face of the given mesh and its barycentric coordinates there.

        Raises
        ------
        ArgumentError
            the mesh was not refined.
        """
        faces = np.empty(self.summary.n_vertices, np.uint32)
        weights = np.empty((faces.size, 3))
        filled(lib.ricci_mesh_places, self, pointer(faces), faces.size, out=weights)
        return frozen(faces), frozen(weights)

    @takes(Attributes)
    def write(
        self,
        path: str | os.PathLike[str],
        progress: Progress = None,
        *,
        normals: npt.ArrayLike | None = None,
        colors: npt.ArrayLike | None = None,
        uv: npt.ArrayLike | None = None,
        corner_normals: npt.ArrayLike | None = None,
        png: bytes | None = None,
        wrap: Literal["repeat", "mirror", "clamp"] | None = None,
    ) -> None:
        """Write the mesh as .obj, .off, .ply or .glb, whole or not at all, with the attributes that the format has.

        Parameters
        ----------
        path : str | os.PathLike[str]
            the file.
        progress : Progress
            shows or stops the call.
        """
        attributes = picked(locals(), Attributes)
        given = options("attributes", attributes, _ATTRIBUTES) if attributes else None
        if given is not None:
            self._check_attributes(attributes)
        call(lib.ricci_mesh_write, self, given if given is not None else ffi.NULL, path_bytes(path), progress=progress)

    def _check_attributes(self, given: Attributes) -> None:
        """The library takes the sizes of attributes for granted, so they are checked here."""
        n, m = self.summary.n_vertices, self.summary.n_faces
        shapes = {"normals": (n, 3), "colors": (n, 4), "uv": (m, 3, 2), "corner_normals": (m, 3, 3)}
        for name, shape in shapes.items():
            found = np.shape(given[name]) if given.get(name) is not None else shape  # type: ignore[literal-required]
            if found != shape:
                raise ArgumentError(f"{name} has shape {found}, {shape} is needed")

    @cached_property
    def summary(self) -> MeshSummary:
        """Counts, Euler characteristic, genus, boundary loops, and which attributes there are."""
        return summary(MeshSummary, "mesh", self)

    @cached_property
    def quality(self) -> QualitySummary:
        """How well shaped the triangles are."""
        return summary(QualitySummary, "quality", self, lib.ricci_mesh_quality)

    @cached_property
    def edges(self) -> Indices:
        """n_edges x 2 ends of every edge, in its direction."""
        return frozen(filled(lib.ricci_mesh_edges, self, out=np.empty((self.summary.n_edges, 2), np.uint32)))

    @cached_property
    def face_edges(self) -> Signed:
        """m x 3 edges opposite the corners: numbers from 1, negative where the face runs against the edge."""
        return frozen(filled(lib.ricci_mesh_face_edges, self, out=np.empty((self.summary.n_faces, 3), np.int32)))

    @cached_property
    def lengths(self) -> Doubles:
        """The length of every edge."""
        return self._values("LENGTHS", self.summary.n_edges)

    @cached_property
    def boundary(self) -> list[Indices]:
        """The vertices of every boundary loop, with the surface on the left."""
        vertices = np.empty(self.summary.n_boundary_vertices, np.uint32)
        starts = np.empty(self.summary.n_boundary_loops + 1, np.uintp)
        filled(lib.ricci_mesh_boundary, self, pointer(vertices), vertices.size, out=starts)
        return np.split(frozen(vertices), starts[1:-1].astype(np.intp)) if len(starts) > 1 else []

    @property
    def n_vertices(self) -> int:
        """Number of vertices."""
        return self.summary.n_vertices

    @property
    def n_faces(self) -> int:
        """Number of faces."""
        return self.summary.n_faces

    @property
    def euler(self) -> int:
        """V - E + F."""
        return self.summary.euler

    @property
    def genus(self) -> int:
        """Number of handles."""
        return self.summary.genus

    def __repr__(self) -> str:
        s = self.summary
        return f"<ricci.Mesh: {s.n_vertices} vertices, {s.n_faces} faces, genus {s.genus}, {s.n_boundary_loops} boundary loops>"


def read(path: str | os.PathLike[str], progress: Progress = None) -> Mesh:
    """The mesh of a file, as `Mesh.read`.

    Parameters
    ----------
    path : str | os.PathLike[str]
        the file: .obj, .off, .ply, .stl, .glb, .gltf, .gii, .vtk, .vtp, .mz3, a surface of FreeSurfer such as ``lh.pial``, or .gz behind.
    progress : Progress
        a `Control` or a callback.

    Examples
    --------
    >>> ricci.make("torus", n=8).write("ring.obj")
    >>> ricci.read("ring.obj")
    <ricci.Mesh: 32 vertices, 64 faces, genus 1, 0 boundary loops>
    """
    return Mesh.read(path, progress)
