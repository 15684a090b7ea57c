"""Triangle lists, which may have defects: reading, diagnosis, repair, writing."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Literal, Self, TypedDict

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._arrays import frozen
from ricci._call import (
    Doubles,
    Handle,
    Indices,
    call,
    constant,
    doubles,
    filled,
    path_bytes,
    pointer,
    rows,
    signed_view,
    sized_list,
    summary,
    text_of,
)
from ricci._library import ffi, lib
from ricci._shown import Scene
from ricci._signatures import picked, takes
from ricci._structs import Struct, Write, above_zero, index_list, number, options
from ricci._triangles import Triangles
from ricci.control import Progress
from ricci.errors import ArgumentError, in_methods
from ricci.figures import QualitySummary, SoupSummary
from ricci.mesh import Mesh

__all__ = ["Defect", "Hole", "Loop", "RepairOptions", "Soup"]


class RepairOptions(TypedDict, total=False):
    """Steps of a repair that are done on request only.

    Attributes
    ----------
    weld : float
        vertices within this distance become one; 0: those in exactly the same place; negative: none.
    component : int
        keep one connected piece: 1 is that with the most faces, 2 the next; 0: all.
    cut_non_manifold_edges : bool
        cut the surface open along edges in which more than two faces meet.
    drop_non_finite : bool
        drop the faces of vertices whose coordinates are not finite, which are an error otherwise.
    split_t_junctions : bool
        divide faces at vertices that lie on their boundary edges, before welding.
    mend_zero_area : bool
        mend faces without area by collapses and flips; vertices keep their places.
    fill_holes : int | Literal["all"]
        fill the boundary loops of at most so many edges, or ``"all"``.
    holes : npt.ArrayLike
        in place of it, vertices: the loops through them are filled.
    """

    weld: float
    component: int
    cut_non_manifold_edges: bool
    drop_non_finite: bool
    split_t_junctions: bool
    mend_zero_area: bool
    fill_holes: int | Literal["all"]
    holes: npt.ArrayLike


def _most_edges(struct: Struct, field: str, value: int | str) -> None:
    number(struct, field, int(ffi.cast("size_t", -1)) if value == "all" else value)


_REPAIR: dict[str, Write] = {
    **dict.fromkeys(RepairOptions.__annotations__, number),
    "fill_holes": _most_edges,
    "holes": index_list("n_holes"),
}


@dataclass(frozen=True)
class Defect:
    """One defect of a triangle list.

    Attributes
    ----------
    code : str
        stable name of the kind of defect, such as ``"non_manifold_edge"``.
    message : str
        one sentence with the elements concerned.
    remedy : str
        what to do about it.
    vertices : Indices
        the vertices concerned, a view of the library's own memory.
    faces : Indices
        the faces concerned, likewise.

    Examples
    --------
    >>> soup = ricci.Soup([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 1, 5]])
    >>> soup.defects[0].message
    'face 1 uses vertex 5, which does not exist'
    """

    code: str
    message: str
    remedy: str
    vertices: Indices
    faces: Indices


@dataclass(frozen=True)
class Loop:
    """A boundary loop.

    Attributes
    ----------
    length : float
        its length; NaN if a vertex is not finite.
    vertices : Indices
        its vertices, in the direction of the faces beside it.

    Examples
    --------
    >>> soup = ricci.Soup([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> soup.loops[0].vertices.tolist()
    [0, 1, 2]
    """

    length: float
    vertices: Indices


@dataclass(frozen=True)
class Hole:
    """A hole that a repair was asked to fill.

    Attributes
    ----------
    filled : bool
        False where it was left open.
    reason : str
        the reason for that; empty where it was filled.
    vertex : int
        the vertex of its loop with the lowest number, in the repaired list.
    n_edges : int
        number of edges of its loop.
    length : float
        length of the loop; NaN where it was left open, as the area.
    area : float
        area of the patch.
    faces : range
        the faces of the patch.
    vertices : range
        the vertices inside the patch.

    Examples
    --------
    >>> soup = ricci.Soup([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> soup.repair(fill_holes="all").holes[0].n_edges
    3
    """

    filled: bool
    reason: str
    vertex: int
    n_edges: int
    length: float
    area: float
    faces: range
    vertices: range


class _View:
    """Memory of a handle as an array interface: arrays made of it keep the library's object alive, not the Python one that keeps them."""

    def __init__(self, owner: Handle, address: Any, n: int) -> None:
        self._owner = owner._pointer
        data = (int(ffi.cast("uintptr_t", address)), True)
        self.__array_interface__ = {"data": data, "shape": (n,), "typestr": "<i4", "version": 3}


def _view(owner: Handle, address: Any, n: int) -> Indices:
    return np.asarray(_View(owner, address, n)) if n else frozen(np.empty(0, np.uint32))


class Soup(Triangles):
    """A triangle list with attributes, which may have defects; a repaired one knows the origins of its elements. It never changes.

    Parameters
    ----------
    V : npt.ArrayLike
        n x 3 positions.
    F : npt.ArrayLike
        m x 3 vertex indices; nothing is asked of them.

    Examples
    --------
    >>> soup = ricci.Soup([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 1, 2]])
    >>> [defect.code for defect in soup.defects]
    ['duplicate_face', 'inconsistent_orientation', 'inconsistent_orientation', 'inconsistent_orientation']
    >>> soup.repair().mesh()
    <ricci.Mesh: 3 vertices, 1 faces, genus 0, 1 boundary loops>
    """

    _type: ClassVar[str] = "soup"
    _made_by: ClassVar[str] = "ricci.Soup(V, F)"
    _figures: ClassVar[tuple[str, ...]] = ("n_vertices", "n_faces", "n_components", "n_defects", "n_boundary_loops", "euler")
    _faces_of: ClassVar[Any] = lib.ricci_soup_faces
    _values_of: ClassVar[Any] = lib.ricci_soup_values

    def __init__(self, V: npt.ArrayLike, F: npt.ArrayLike) -> None:
        positions, faces = _arrays.points(V), _arrays.indices(F, 3, "F")
        made = Soup._made(lib.ricci_soup_from_arrays, pointer(positions), positions.strides[0], len(positions), pointer(faces), len(faces))
        self._pointer = made._pointer

    def _scene(self) -> Scene | None:
        # Indices and numbers of a list need not be any.
        sound = (len(self.V) > self.F).all(1) & (self.F >= 0).all(1)
        return Scene(self.V, self.F[sound]) if len(self.V) else None

    def __reduce__(self) -> Any:
        """The arrays of the list.

        Raises
        ------
        TypeError
            a list with attributes, or a repaired one, whose origins arrays cannot say.
        """
        s = self.summary
        if s.n_normals + s.n_colors + s.n_uv + s.n_corner_normals or self._is_repaired():
            raise TypeError("a triangle list with attributes, or a repaired one, cannot be pickled: send its file, or its mesh()")
        return Soup, (self.V, self.F.view(np.uint32))

    @classmethod
    def read(cls, path: str | os.PathLike[str], progress: Progress = None) -> Self:
        """The triangle list of a mesh file with its attributes, in the file's numbers."""
        return cls._made(lib.ricci_soup_read, path_bytes(path), progress=progress)

    def write(self, path: str | os.PathLike[str], progress: Progress = None) -> None:
        """Write the list as .obj, .off, .ply or .glb, whole or not at all. It may have defects."""
        call(lib.ricci_soup_write, self, path_bytes(path), progress=progress)

    @takes(RepairOptions)
    def repair(
        self,
        *,
        weld: float | None = None,
        component: int | None = None,
        cut_non_manifold_edges: bool = False,
        drop_non_finite: bool = False,
        split_t_junctions: bool = False,
        mend_zero_area: bool = False,
        fill_holes: int | Literal["all"] | None = None,
        holes: npt.ArrayLike | None = None,
    ) -> Soup:
        """The list after every repair that takes no guess. Defects that are left are a result, not an error."""
        given = picked(locals(), RepairOptions)
        return Soup._made(lib.ricci_soup_repair, self, options("repair_options", given, _REPAIR))

    def refine(self, levels: int = 0, longest_edge: float | None = None) -> Soup:
        """The same surface in smaller triangles, attributes interpolated; `places` says where its elements lie in this list.

        Parameters
        ----------
        levels : int
            the number of times that every face is cut into four.
        longest_edge : float | None
            the length above which no edge is left; None: any.
        """
        struct = Struct("refine_options")
        struct.put("levels", levels)
        if longest_edge is not None:
            above_zero(struct, "longest_edge", longest_edge)
        return Soup._made(lib.ricci_soup_refine, self, struct)

    @cached_property
    def places(self) -> tuple[Indices, Indices, Doubles]:
        """Of a refined list: for each face its given face, for each vertex a given face and its barycentric coordinates there.

        A vertex that no face uses has the face -1.
        """
        faces, at = (np.empty(n, np.uint32) for n in (self.summary.n_faces, self.summary.n_vertices))
        weights = np.empty((at.size, 3))
        filled(lib.ricci_soup_places, self, pointer(faces), faces.size, pointer(at), at.size, out=weights)
        return frozen(faces), frozen(at), frozen(weights)

    @classmethod
    def of_polygons(cls, V: npt.ArrayLike, polygons: Iterable[npt.ArrayLike]) -> Self:
        """The triangles of polygons, each a list of vertices: fans of convex ones; `polygons` of the list leads back."""
        points, parts = _arrays.points(V), [_arrays.indices(corners, name=f"polygon {k}") for k, corners in enumerate(polygons)]
        starts = np.cumsum([0, *(part.size for part in parts)]).astype(np.uintp)
        corners = np.concatenate([np.empty(0, np.uint32), *(part.ravel() for part in parts)])
        given = (pointer(points), points.strides[0], len(points), pointer(corners), pointer(starts), len(parts))
        return cls._made(lib.ricci_soup_from_polygons, *given)

    @cached_property
    def polygons(self) -> Indices:
        """Of a list `of_polygons`, the polygon of each face."""
        return frozen(filled(lib.ricci_soup_polygons, self, out=np.empty(self.summary.n_faces, np.uint32)))

    def mesh(self) -> Mesh:
        """The mesh of a list without defects, with its attributes.

        Raises
        ------
        MeshError
            there are defects.
        """
        return Mesh._made(lib.ricci_soup_mesh, self)

    @cached_property
    def summary(self) -> SoupSummary:
        """Counts, the number of defects, and the steps of a repair."""
        return summary(SoupSummary, "soup", self)

    @cached_property
    def quality(self) -> QualitySummary:
        """How well shaped the triangles are, as those of a surface if the list is one."""
        return summary(QualitySummary, "quality", self, lib.ricci_soup_quality)

    @cached_property
    def defects(self) -> list[Defect]:
        """All defects; their arrays are views of the library's memory."""
        return [self._defect(lib.ricci_soup_defect, k) for k in range(self.summary.n_defects)]

    @cached_property
    def hints(self) -> list[Defect]:
        """Findings that are no defects: an open seam with the weld that closes it, T-junctions, coarse coordinates."""
        return [self._defect(lib.ricci_soup_hint, k) for k in range(self.summary.n_hints)]

    @cached_property
    def loops(self) -> list[Loop]:
        """The boundary loops, in the order in which other functions and the command number them."""
        lengths = np.empty(self.summary.n_loops)
        vertices = rows(lengths.size, lib.ricci_soup_loops, self, pointer(lengths), lengths.size, dtype=np.uint32)
        return [Loop(float(length), frozen(around)) for length, around in zip(lengths, vertices, strict=True)]

    def sharp_edges(self, angle: float) -> tuple[Indices, Doubles]:
        """The edges of two faces at which the surface turns by `angle` radians or more (k x 2), and the angle at each."""
        n = ffi.new("size_t *")
        call(lib.ricci_soup_sharp_edges, self, angle, ffi.NULL, 0, ffi.NULL, 0, n)
        edges, angles = np.empty((n[0], 2), np.uint32), np.empty(n[0])
        call(lib.ricci_soup_sharp_edges, self, angle, pointer(edges), edges.size, pointer(angles), angles.size, n)
        return frozen(signed_view(edges)), frozen(angles)

    def corners(self, angle: float) -> Indices:
        """The vertices at which lines of sharp edges and of the boundary end, branch, or turn by `angle` radians or more; ascending."""
        return frozen(signed_view(sized_list(lib.ricci_soup_corners, self, angle, dtype=np.uint32)))

    def names(self, of: Literal["object", "group", "material", "smoothing"]) -> tuple[Indices, list[str]]:
        """For each face the number of its name of this kind, and the names; number 0 is the empty name of faces without one."""
        kind = constant("LABEL", of, ("object", "group", "material", "smoothing"))
        numbers, n = np.empty(self.summary.n_faces, np.uint32), ffi.new("size_t *")
        call(lib.ricci_soup_labels, self, kind, pointer(numbers), numbers.size, n)
        return frozen(signed_view(numbers)), [text_of(lib.ricci_soup_label, self, kind, k) for k in range(n[0])]

    @cached_property
    def vertex_numbers(self) -> dict[str, Doubles]:
        """Further numbers of every vertex by the name that the file gives them, such as ``quality`` in PLY; they may be NaN."""
        return self._further(lib.RICCI_OF_VERTICES, lib.RICCI_LABEL_VERTEX_NUMBERS, self.summary.n_vertex_numbers, self.summary.n_vertices)

    @cached_property
    def face_numbers(self) -> dict[str, Doubles]:
        """Further numbers of every face by the name that the file gives them; they may be NaN."""
        return self._further(lib.RICCI_OF_FACES, lib.RICCI_LABEL_FACE_NUMBERS, self.summary.n_face_numbers, self.summary.n_faces)

    def components(self) -> list[Soup]:
        """The connected pieces, those with the most faces first. `origins` of a piece are the vertices and faces of this list.

        Each piece is repaired, too, but its vertices are not welded.
        """
        return [self.repair(component=k + 1, weld=-1) for k in range(self.summary.n_components)]

    @cached_property
    def holes(self) -> list[Hole]:
        """Of a repaired list, the holes that were to be filled: first those that were, then those that were left open."""
        return [self._hole(k) for k in range(self.summary.filled_holes + self.summary.open_holes)]

    @cached_property
    def origins(self) -> tuple[Indices, Indices]:
        """The vertex and the face of the original that each vertex and face of a repaired list came from; 2**32 - 1 in filled holes."""
        vertices, faces = (np.empty(n, np.uint32) for n in (self.summary.n_vertices, self.summary.n_faces))
        filled(lib.ricci_soup_origins, self, pointer(vertices), vertices.size, out=faces)
        return frozen(vertices), frozen(faces)

    @cached_property
    def refused(self) -> tuple[Indices, list[Indices]]:
        """The edges that kept vertices of a repaired list from being welded (k x 2), and for each the faces that would meet there."""
        edges = np.empty((self.summary.refused_edges, 2), np.uint32)
        faces = rows(len(edges), lib.ricci_soup_refused, self, pointer(edges), edges.size, dtype=np.uint32)
        return frozen(edges), faces

    def _is_repaired(self) -> bool:
        try:
            return len(self.origins) > 0
        except ArgumentError:
            return False

    def _hole(self, index: int) -> Hole:
        found = ffi.new("ricci_hole *")
        call(lib.ricci_soup_hole, self, index, found, ffi.sizeof("ricci_hole"))
        reason = "" if found.filled else ffi.string(found.reason).decode()
        faces, vertices = (
            range(first, first + n) for first, n in ((found.first_face, found.n_faces), (found.first_vertex, found.n_vertices))
        )
        return Hole(bool(found.filled), reason, found.vertex, found.n_edges, found.length, found.area, faces, vertices)

    def _further(self, of: int, names: int, count: int, size: int) -> dict[str, Doubles]:
        def column(k: int) -> Doubles:
            return frozen(doubles(lib.ricci_soup_numbers, self, of, k, shape=(size,)))

        return {text_of(lib.ricci_soup_label, self, names, k): column(k) for k in range(count)}

    def _defect(self, one: Any, index: int) -> Defect:
        found = ffi.new("ricci_defect *")
        call(one, self, index, found, ffi.sizeof("ricci_defect"))
        code, message, remedy = (in_methods(ffi.string(text).decode()) for text in (found.code, found.message, found.remedy))
        return Defect(code, message, remedy, _view(self, found.vertices, found.n_vertices), _view(self, found.faces, found.n_faces))
