"""Geometric structures of surfaces, by charts and transitions."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Literal, TypedDict, get_args

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._arrays import frozen
from ricci._call import CONTROL, Doubles, Indices, call, constant, doubles, listed, pointer, rows, summary
from ricci._kept import Kept
from ricci._library import ffi, lib
from ricci._shown import Scene
from ricci._signatures import picked, takes
from ricci._structs import Write, above_zero, choice, one_index, options
from ricci.adapters import MeshLike, as_mesh
from ricci.control import Progress, stages
from ricci.errors import ArgumentError
from ricci.figures import StructureSummary
from ricci.figures.names import StructureKind
from ricci.metrics import FlowOptions, flow_struct

__all__ = ["Place", "Structure", "StructureOptions", "structure", "structures"]


class StructureOptions(TypedDict, total=False):
    """Options of a structure: its charts, and the source of an affine structure.

    Attributes
    ----------
    flow : FlowOptions
        how the flow is done.
    singular : int
        the singular vertex of an affine structure by the flow; where areas are distorted least.
    radius : float
        how far a patch reaches in the sphere or the hyperbolic plane.
    charts : Literal["stars", "patches"]
        ``"stars"`` of the vertices, or larger ``"patches"``.
    source : Literal["flow", "form"]
        an affine structure comes from a ``"flow"``, or from a holomorphic 1-``"form"``: transitions are translations.
    n_quads : int
        about so many quads of an integer structure; those of the layout with the fewest patches.
    """

    flow: FlowOptions
    singular: int
    radius: float
    charts: Literal["stars", "patches"]
    source: Literal["flow", "form"]
    n_quads: int


_STRUCTURE: dict[str, Write] = {
    "flow": lambda struct, field, value: struct.put(field, flow_struct(value)),
    "singular": one_index,
    "radius": above_zero,
    "charts": choice("CHARTS"),
    "source": choice("AFFINE"),
    "n_quads": above_zero,
}


@dataclass(frozen=True)
class Place:
    """A point in a chart.

    Attributes
    ----------
    chart : int
        the chart.
    face : int
        the place of the point's face in the chart's list of faces.
    x : float
        first coordinate there.
    y : float
        second coordinate there.

    Examples
    --------
    >>> found = ricci.structure(ricci.make("torus", n=16), kind="affine")
    >>> place = found.places(0, [1 / 3, 1 / 3, 1 / 3])[0]
    >>> 0 in found.chart_faces[place.chart]
    True
    """

    chart: int
    face: int
    x: float
    y: float


class Structure(Kept):
    """A geometric structure of a surface: charts in the plane, and transitions in the structure's group. It never changes.

    Examples
    --------
    >>> found = ricci.structure(ricci.make("torus", n=16), kind="affine")
    >>> found.summary.n_charts == len(found.chart_faces)
    True
    """

    _type: ClassVar[str] = "structure"
    _made_by: ClassVar[str] = "ricci.structure(mesh, kind=...)"
    _figures: ClassVar[tuple[str, ...]] = ("kind", "n_charts", "n_transitions", "n_generators", "n_singular", "cocycle_residual")

    def _scene(self) -> Scene | None:
        first = int(np.argmax([len(faces) for faces in self.chart_faces]))
        return Scene(self.coordinates(first), self.chart_corners[first])

    @cached_property
    def summary(self) -> StructureSummary:
        """Counts and residuals."""
        return summary(StructureSummary, "structure", self)

    @cached_property
    def chart_faces(self) -> list[Indices]:
        """For each chart its faces."""
        return self._rows("CHART_FACES", self.summary.n_charts)

    @cached_property
    def chart_corners(self) -> list[Indices]:
        """For each chart the corners of its faces (k x 3), as places in its list of vertices."""
        return [row.reshape(-1, 3) for row in self._rows("CHART_CORNERS", self.summary.n_charts)]

    @cached_property
    def chart_vertices(self) -> list[Indices]:
        """For each chart its vertices."""
        return self._rows("CHART_VERTICES", self.summary.n_charts)

    @cached_property
    def shared(self) -> list[Indices]:
        """For each transition the vertices of the overlap (k x 2), as places in both charts."""
        return [row.reshape(-1, 2) for row in self._rows("TRANSITION_PAIRS", self.summary.n_transitions)]

    def coordinates(self, chart: int) -> Doubles:
        """k x 2 coordinates of the vertices of a chart, in the order of `chart_vertices`."""
        if not 0 <= chart < self.summary.n_charts:
            raise ArgumentError(f"chart {chart} of {self.summary.n_charts}")
        return doubles(lib.ricci_structure_coordinates, self, chart, shape=(len(self.chart_vertices[chart]), 2))

    @cached_property
    def transitions(self) -> tuple[Indices, npt.NDArray[Any]]:
        """The charts that each transition leads from and to (k x 2), and the matrices: k x 2 x 2 complex, or k x 3 x 3."""
        n = self.summary.n_transitions
        charts, matrices = np.empty((n, 2), np.uint32), np.empty((n, self.summary.n_matrix))
        call(lib.ricci_structure_transitions, self, pointer(charts), charts.size, pointer(matrices), matrices.size)
        return frozen(charts), frozen(self._matrices(matrices))

    @cached_property
    def holonomy(self) -> npt.NDArray[Any]:
        """The matrix of every generator of the fundamental group: 2 x 2 complex, or 3 x 3."""
        return frozen(self._matrices(self._holonomy()))

    def _holonomy(self) -> Doubles:
        return doubles(lib.ricci_structure_holonomy, self, shape=(self.summary.n_generators, self.summary.n_matrix))

    @cached_property
    def singular(self) -> Indices:
        """Vertices that no chart has inside."""
        return self._list("SINGULAR")

    @cached_property
    def excluded(self) -> Indices:
        """Faces of no chart."""
        return self._list("EXCLUDED")

    @cached_property
    def folded(self) -> Indices:
        """Charts whose faces do not lie counterclockwise beside each other."""
        return self._list("FOLDED")

    @cached_property
    def zeros(self) -> Indices:
        """k x 2: the nearest vertex and the multiplicity of each zero of the 1-form."""
        return self._list("ZEROS").reshape(-1, 2)

    @cached_property
    def F(self) -> Indices:
        """m x 3 vertices of the triangulation, of which the first are those of the mesh."""
        return self._list("TRIANGLES").reshape(-1, 3)

    def places(self, face: int, weights: npt.ArrayLike) -> list[Place]:
        """All charts that contain a point.

        Parameters
        ----------
        face : int
            a face of the triangulation.
        weights : npt.ArrayLike
            3 weights of its corners.
        """
        given = _arrays.real(weights)
        if given.shape != (3,):
            raise ArgumentError(f"weights have shape {given.shape}, (3,) is needed")
        n = ffi.new("size_t *")
        call(lib.ricci_structure_places, self, face, pointer(given), ffi.NULL, ffi.NULL, 0, n)
        lifts, points = np.empty((n[0], 2), np.uint32), np.empty((n[0], 2))
        call(lib.ricci_structure_places, self, face, pointer(given), pointer(lifts), pointer(points), n[0], n)
        return [Place(int(a), int(b), float(x), float(y)) for (a, b), (x, y) in zip(lifts, points, strict=True)]

    def carry(self, start: Place, end: Place, points: npt.ArrayLike) -> Doubles:
        """k x 2 points of one chart in the coordinates of another one that overlaps it in the face of both places."""
        array = _arrays.real(points, 2, "points")
        lifts = [np.array([place.chart, place.face], np.uint32) for place in (start, end)]
        return doubles(lib.ricci_structure_carry, self, *map(pointer, lifts), pointer(array), len(array), shape=array.shape)

    def _matrices(self, numbers: Doubles) -> npt.NDArray[Any]:
        if self.summary.n_matrix == 8:
            return numbers.view(np.complex128).reshape(-1, 2, 2)
        return numbers.reshape(-1, 3, 3)

    def _rows(self, which: str, n: int) -> list[Indices]:
        return rows(n, lib.ricci_structure_rows, self, getattr(lib, f"RICCI_{which}"), dtype=np.uint32)

    def _list(self, which: str) -> Indices:
        return frozen(listed(lib.ricci_structure_list, self, getattr(lib, f"RICCI_STRUCTURE_{which}")))

    def __repr__(self) -> str:
        s = self.summary
        return f"<ricci.Structure: {s.kind}, {s.n_charts} charts, {s.n_transitions} transitions>"


@takes(StructureOptions)
def structure(
    V: MeshLike,
    F: npt.ArrayLike | None = None,
    kind: StructureKind = "conformal",
    progress: Progress = None,
    *,
    flow: FlowOptions | None = None,
    singular: int | None = None,
    radius: float | None = None,
    charts: Literal["stars", "patches"] = "stars",
    source: Literal["flow", "form"] = "flow",
    n_quads: int | None = None,
) -> Structure:
    """A geometric structure of a surface.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`).
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    kind : StructureKind
        ``"conformal"`` (any surface), ``"spherical"`` (genus 0), ``"affine"``, ``"hyperbolic"`` or ``"projective"`` (negative
        Euler characteristic), or ``"integer"`` (any surface): the quads of a layout are unit squares. Its triangles are halves of these
        quads.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    ArgumentError
        a structure that the surface has not, or options that do not belong to it.

    Examples
    --------
    >>> found = ricci.structure(ricci.make("genus", genus=2, n=3), kind="hyperbolic")
    >>> found.holonomy.shape
    (4, 2, 2)
    """
    given = picked(locals(), StructureOptions)
    struct = options("structure_options", given, _STRUCTURE)
    return Structure._made(
        lib.ricci_structure_new, as_mesh(V, F), constant("STRUCTURE", kind, get_args(StructureKind)), struct, CONTROL, progress=progress
    )


def structures(V: MeshLike, F: npt.ArrayLike | None = None, progress: Progress = None) -> dict[str, Structure]:
    """Every structure that a surface has, by its kind, but the integer ones, which come from a mesh of quads.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`).
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    progress : Progress
        a `Control` or a callback.

    Examples
    --------
    >>> sorted(ricci.structures(ricci.make("torus", n=16)))
    ['affine', 'conformal']
    """
    mesh = as_mesh(V, F)
    kinds: list[StructureKind] = ["conformal", "affine"]
    if mesh.euler < 0:
        kinds += ["hyperbolic", "projective"]
    elif mesh.summary.n_boundary_loops == 0 and mesh.genus == 0:
        kinds += ["spherical"]
    parts = stages(progress, [(k + 1) / len(kinds) for k in range(len(kinds))])
    return {kind: structure(mesh, kind=kind, progress=part) for kind, part in zip(kinds, parts, strict=True)}
