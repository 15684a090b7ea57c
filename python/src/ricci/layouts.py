"""Layouts: coordinates of a surface that is cut open, in the plane, the hyperbolic plane or on the sphere."""

from __future__ import annotations

import os
from functools import cached_property
from typing import Any, ClassVar, Literal, TypeAlias, TypedDict

import numpy as np
import numpy.typing as npt

from ricci._arrays import frozen
from ricci._call import (
    CONTROL,
    Complexes,
    Doubles,
    Handle,
    Indices,
    Signed,
    call,
    constant,
    doubles,
    filled,
    listed,
    path_bytes,
    pointer,
    rows,
    summary,
)
from ricci._kept import Kept
from ricci._library import lib
from ricci._shown import Scene
from ricci._signatures import picked, takes
from ricci._structs import Write, above_zero, choice, index_list, one_index, options
from ricci.control import Progress
from ricci.errors import LayoutError, warn
from ricci.figures import LayoutSummary, RepairedInputSummary
from ricci.figures.names import Model, On
from ricci.mesh import Mesh
from ricci.metrics import Metric
from ricci.status import Status

__all__ = ["Layout", "LayoutOptions", "RepairedInput", "Seam", "SheetLine", "layout"]

Layer: TypeAlias = Literal["boundary", "seams", "folds", "allowance"]
LAYERS: tuple[Layer, ...] = ("boundary", "seams", "folds", "allowance")


class LayoutOptions(TypedDict, total=False):
    """Options of a layout.

    Attributes
    ----------
    model : Model
        coordinates of `Layout.uv` and of files: ``"poincare"``, ``"klein"``, ``"half_plane"``.
    scale : Literal["input_area", "as_solved"]
        ``"input_area"``: the area of the surface as it came; ``"as_solved"``: lengths as the metric has them. E2 only.
    cones : npt.ArrayLike
        vertices through which the cut goes; those of the flow. An empty list: none.
    root : int
        the vertex at the origin.
    threads : int
        as many as the flow had. The result does not depend on it.
    """

    model: Model
    scale: Literal["input_area", "as_solved"]
    cones: npt.ArrayLike
    root: int
    threads: int


def _cones(struct: Any, field: str, value: Any) -> None:
    """Sets the cones. An empty list becomes a pointer with the count 0, because NULL means the default."""
    index_list("n_cones")(struct, field, value if np.size(value) else [0])
    struct.put("n_cones", int(np.size(value)))


_LAYOUT: dict[str, Write] = {
    "model": choice("MODEL"),
    "scale": choice("SCALE"),
    "cones": _cones,
    "root": one_index,
    "threads": above_zero,
}


class Seam:
    """One seam of a layout, and the isometry z -> (a z + b)/(c z + d) that carries its left side onto its right side.

    Attributes
    ----------
    mobius : Complexes
        2 x 2 complex: ((a, b), (c, d)).
    error
        how far the edges of the seam are from it: relative to the diameter in E2, elsewhere a distance.
    """

    def __init__(self, row: Doubles) -> None:
        self.mobius: Complexes = np.ascontiguousarray(row[:8]).view(np.complex128).reshape(2, 2)
        self.error = float(row[8])


FOLD_ANGLE = np.pi / 6
"""Angle in radians above which an edge is a fold where none is asked for: 30 degrees."""


class SheetLine:
    """A line along which a layout in the plane is cut or folded.

    Attributes
    ----------
    layer : Literal["boundary", "seams", "folds"]
        ``"boundary"``; ``"seams"``, one side of a seam; or ``"folds"``.
    seam
        the number of the seam, or None.
    closed
        whether the line goes on from its last point to the first.
    points : Indices
        indices into `Layout.points`; a closed line does not repeat its first point.

    Examples
    --------
    >>> laid = ricci.layout(ricci.flow(ricci.make("disk", n=4)))
    >>> laid.lines()
    [<ricci.SheetLine: boundary, 24 points, closed>]
    """

    def __init__(self, row: Any, points: Indices) -> None:
        layer, seam, closed, _ = (int(x) for x in row)
        self.layer: Layer = LAYERS[layer]
        self.seam = seam if seam >= 0 else None
        self.closed = closed == 1
        self.points = points

    def __repr__(self) -> str:
        return f"<ricci.SheetLine: {self.layer}, {self.points.size} points{', closed' if self.closed else ''}>"


def cut_open(mesh: Mesh, corners: Indices, points: Doubles) -> tuple[Doubles, Indices, Doubles, Indices]:
    """A mesh in space with a vertex for each point of a layout: positions, faces, the points, and the vertex of the mesh of each."""
    origins = np.zeros(len(points), np.int32)
    origins[corners] = mesh.F
    return mesh.V[origins], corners, points, origins


class Layout(Kept):
    """The coordinates of a surface that is opened along a cut and unfolded in the space of its metric.

    If edges were flipped, the mesh of the layout is the common subdivision of the mesh and the metric's triangulation: ``on="refinement"``;
    ``on="input"`` makes the map linear on the faces of the mesh itself. Arrays of properties are read-only.

    Examples
    --------
    >>> laid = ricci.layout(ricci.flow(ricci.make("disk", n=4)))
    >>> laid.points().shape, laid.summary.n_flipped
    ((61, 2), 0)
    """

    _type: ClassVar[str] = "layout"
    _made_by: ClassVar[str] = "ricci.layout(metric)"
    _figures: ClassVar[tuple[str, ...]] = ("space", "n_faces", "n_seams", "n_flipped", "qc_mean", "area")

    def _scene(self) -> Scene | None:
        ratio = self.distortion("refinement")[1]
        with np.errstate(divide="ignore", invalid="ignore"):
            return Scene(self.points(), self.corners("refinement"), np.log(ratio), "logarithm of the change of area")

    @cached_property
    def summary(self) -> LayoutSummary:
        """Counts, consistency and distortion."""
        return summary(LayoutSummary, "layout", self)

    def _cut_open(self) -> tuple[Doubles, Indices, Doubles, Indices]:
        """The surface with a vertex for each point of the layout: positions, faces, the points, and the vertex of the mesh of each."""
        return cut_open(self.mesh, self.corners("refinement"), self.points())

    def _sides(self) -> tuple[Any, ...]:
        """The surface, its image, and how the map changes areas and angles around the vertices, means of the faces."""
        dilatation, ratio = self.distortion("refinement")
        faces = self.mesh.F
        around = np.bincount(faces.ravel(), minlength=self.mesh.n_vertices)
        with np.errstate(divide="ignore", invalid="ignore"):
            told = {"logarithm of the change of area": np.log(ratio), "quasi-conformal dilatation": dilatation}
            found = {name: np.bincount(faces.ravel(), np.repeat(values, 3), self.mesh.n_vertices) / around for name, values in told.items()}
        return *self._cut_open(), found

    def points(self, model: Model = "poincare") -> Doubles:
        """n_points x 2 points, x 3 for ``"ambient"``."""
        columns = 3 if model == "ambient" else 2
        return doubles(lib.ricci_layout_points, self, constant("MODEL", model), shape=(self.summary.n_points, columns))

    def corners(self, on: On = "input") -> Indices:
        """The point of every corner of every face, m x 3."""
        out = np.empty((self._faces(on), 3), np.uint32)
        return filled(lib.ricci_layout_corners, self, constant("ON", on), out=out)

    def uv(self, on: On = "input") -> Doubles:
        """The coordinates of every corner of every face in the layout's model, m x 3 x 2."""
        return doubles(lib.ricci_layout_uv, self, constant("ON", on), shape=(self._faces(on), 3, 2))

    def flipped(self, on: On = "input") -> Indices:
        """The faces that are not counterclockwise, ascending."""
        return listed(lib.ricci_layout_flipped, self, constant("ON", on))

    def distortion(self, on: On = "input") -> tuple[Doubles, Doubles]:
        """Quasi-conformal dilatation of every face (1 is conformal), and its share of the area over its share in the input."""
        qc, ratio = np.empty(self._faces(on)), np.empty(self._faces(on))
        call(lib.ricci_layout_distortion, self, constant("ON", on), pointer(qc), pointer(ratio), qc.size)
        return qc, ratio

    def circle_pattern(self, which: Literal["vertices", "faces"] = "vertices") -> Doubles:
        """The circle pattern of a layout in the plane: centre and squared radius of each circle, n x 3.

        Parameters
        ----------
        which : Literal["vertices", "faces"]
            the circles of the vertices, one per point of the layout; or those of the faces of the metric's triangulation, orthogonal
            to the circles of their corners. NaN where there is none.
        """
        return np.asarray(listed(lib.ricci_layout_circles, self, constant("CIRCLES", which), dtype=float)).reshape(-1, 3)

    @cached_property
    def seams(self) -> list[Seam]:
        """The seams with their isometries."""
        return [Seam(row) for row in doubles(lib.ricci_layout_seams, self, shape=(self.summary.n_seams, 9))]

    def seam_edges(self, on: On = "input") -> list[Signed]:
        """The edges of every seam, in order: numbers from 1, negative where the seam runs against the edge."""
        return rows(self.summary.n_seams, lib.ricci_layout_seam_edges, self, constant("ON", on))

    def repaired_input(self, progress: Progress = None) -> RepairedInput:
        """The layout on the faces of the mesh, with the fewest edges split that leave no face folded."""
        return RepairedInput(self, progress)

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh of the layout: the given mesh, or the common subdivision, whose first vertices are the given ones."""
        return Mesh._made(lib.ricci_layout_mesh, self)

    def write(self, path: str | os.PathLike[str], on: On = "input", *, homogeneous: bool = False) -> None:
        """Write the mesh with the layout as texture coordinates, as .obj, .ply, .glb or, without seams, .off.

        Parameters
        ----------
        path : str | os.PathLike[str]
            the file, whose ending says the format.
        on : On
            the mesh, or what is laid out.
        homogeneous : bool
            `vt qx qy q`, in which the projective map of every piece is linear; as .obj only.

        Raises
        ------
        FileError
            another ending.
        ArgumentError
            what the format has no place for.
        """
        call(lib.ricci_layout_write, self, constant("ON", on), int(homogeneous), path_bytes(path))

    def lines(self, fold_angle: float = FOLD_ANGLE, on: On = "input") -> list[SheetLine]:
        """The lines along which a layout in E2 is cut and folded.

        Parameters
        ----------
        fold_angle : float
            edges of the mesh are folds where the normals of their faces differ by more than this, in radians.
        on : On
            along edges of the mesh, or of what is laid out.
        """
        asked = (self, constant("ON", on), fold_angle)
        table = listed(lib.ricci_layout_lines, *asked, dtype=np.int32).reshape(-1, 4)
        points = listed(lib.ricci_layout_line_points, *asked)
        starts = np.cumsum(table[:, 3])
        return [SheetLine(row, line) for row, line in zip(table, np.split(points, starts[:-1]), strict=False)]

    def write_flat(
        self,
        path: str | os.PathLike[str],
        on: On = "input",
        *,
        fold_angle: float = FOLD_ANGLE,
        unit: Literal["millimetre", "centimetre", "metre", "inch"] = "millimetre",
    ) -> None:
        """Write a layout in E2 as a mesh of points (x, y, 0), or its lines as a drawing for cutting.

        Parameters
        ----------
        path : str | os.PathLike[str]
            the file: .obj, .off, .ply, .glb; or .svg, .dxf with the layers BOUNDARY, SEAMS and FOLDS.
        on : On
            the mesh, or what is laid out.
        fold_angle : float
            as of `lines`.
        unit : Literal["millimetre", "centimetre", "metre", "inch"]
            the unit of the coordinates, for the size of an SVG.
        """
        call(lib.ricci_layout_write_flat, self, constant("ON", on), fold_angle, constant("SHEET", unit), path_bytes(path))

    def _faces(self, on: On) -> int:
        return self.summary.n_input_faces if on == "input" else self.summary.n_faces

    def __repr__(self) -> str:
        s = self.summary
        return f"<ricci.Layout: {s.space}, {s.n_faces} faces, {s.n_seams} seams, {s.n_flipped} flipped>"


class RepairedInput(Handle):
    """A layout on the faces of the mesh, with the fewest edges split that leave no face folded. Arrays of properties are read-only.

    Parameters
    ----------
    layout : Layout
        the layout.
    progress : Progress
        a `Control` or a callback.

    Examples
    --------
    >>> laid = ricci.layout(ricci.flow(ricci.make("genus", genus=2, n=3), target="auto:4"))
    >>> laid.repaired_input().summary.n_flipped
    0
    """

    _type: ClassVar[str] = "repaired_input"
    _made_by: ClassVar[str] = "ricci.layout(metric).repaired_input()"
    _figures: ClassVar[tuple[str, ...]] = ("n_vertices", "n_faces", "n_split_edges", "n_flipped", "qc_mean", "qc_max")

    def __init__(self, layout: Layout, progress: Progress = None) -> None:
        self._pointer = RepairedInput._made(lib.ricci_repaired_input_new, layout, CONTROL, progress=progress)._pointer

    def _scene(self) -> Scene | None:
        return Scene(self.points, self.corners)

    @cached_property
    def summary(self) -> RepairedInputSummary:
        """Counts and distortion."""
        return summary(RepairedInputSummary, "repaired_input", self)

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh with its edges split; its first vertices are those of the mesh."""
        return Mesh._made(lib.ricci_repaired_input_mesh, self)

    @cached_property
    def faces(self) -> Indices:
        """The face of the mesh in which every face lies, ascending."""
        return frozen(filled(lib.ricci_repaired_input_faces, self, out=np.empty(self.summary.n_faces, np.uint32)))

    @cached_property
    def barycentric(self) -> Doubles:
        """n_faces x 3 x 3: the coordinates of every corner in its face of the mesh."""
        return frozen(doubles(lib.ricci_repaired_input_barycentric, self, shape=(self.summary.n_faces, 3, 3)))

    @cached_property
    def split_edges(self) -> Indices:
        """The edges of the mesh that were split, ascending."""
        return frozen(filled(lib.ricci_repaired_input_split_edges, self, out=np.empty(self.summary.n_split_edges, np.uint32)))

    @cached_property
    def points(self) -> Doubles:
        """n_points x 2, in the layout's model."""
        return frozen(doubles(lib.ricci_repaired_input_points, self, shape=(self.summary.n_points, 2)))

    @cached_property
    def corners(self) -> Indices:
        """The point of every corner of every face, n_faces x 3."""
        return frozen(filled(lib.ricci_repaired_input_corners, self, out=np.empty((self.summary.n_faces, 3), np.uint32)))

    def uv(self) -> Doubles:
        """The coordinates of every corner of every face, n_faces x 3 x 2."""
        return self.points[self.corners]

    def _cut_open(self) -> tuple[Doubles, Indices, Doubles, Indices]:
        return cut_open(self.mesh, self.corners, self.points)

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write the mesh with its edges split and the layout as texture coordinates, as `Layout.write` does."""
        call(lib.ricci_repaired_input_write, self, path_bytes(path))


# Largest curvature of a vertex, radians, that a layout does not cut through: the library's own bound for cones.
_FLAT = 1e-10


def _check_flat(metric: Metric, has_cones: bool) -> None:
    """Refuse a curved metric that no flow has led to; warn of a flow that did not converge."""
    report = metric.flow_report()
    if report is not None:
        if not report.converged:
            s = report.summary
            warn(f"the metric that is laid out has not converged ({s.stop_reason}, {s.max_curvature_error:.1e}): its seams do not fit")
        return
    inside = np.ones(metric.summary.n_vertices, bool)
    inside[metric.boundary_vertices()] = False
    curved = np.flatnonzero(inside & (np.abs(metric.curvature) > _FLAT))
    if curved.size and not has_cones:
        at = int(curved[np.argmax(np.abs(metric.curvature[curved]))])
        raise LayoutError(
            f"the metric is curved at {curved.size} vertices inside, most at vertex {at} by {metric.curvature[at]:.3g}: no flow has led "
            'to it: ricci.flow(mesh, target="auto:8") makes one that is flat but for eight cones; a layout that is cut at each of the '
            "curved vertices is had by naming them: cones=[...]",
            Status.LAYOUT,
            (1, at),
            float(metric.curvature[at]),
        )


@takes(LayoutOptions)
def layout(
    metric: Metric,
    progress: Progress = None,
    *,
    model: Model = "poincare",
    scale: Literal["input_area", "as_solved"] = "input_area",
    cones: npt.ArrayLike | None = None,
    root: int | None = None,
    threads: int | None = None,
) -> Layout:
    """The layout of a metric in its space, cut open along edges of the mesh through all cones.

    Parameters
    ----------
    metric : Metric
        the metric, as a flow makes it.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    LayoutError
        the metric has no layout; or it is curved, no flow has led to it, and `cones` does not say where it is to be cut.

    Warns
    -----
    ConvergenceWarning
        the flow that led to the metric did not come to its target, so that seams do not fit and faces may be folded.

    Examples
    --------
    >>> flat = ricci.flow(ricci.make("genus", genus=2, n=3), target="auto:4")
    >>> ricci.layout(flat).uv().shape
    (1584, 3, 2)
    """
    given = picked(locals(), LayoutOptions)
    if isinstance(metric, Metric):
        _check_flat(metric, given.get("cones") is not None)
    return Layout._made(lib.ricci_layout_new, metric, options("layout_options", given, _LAYOUT), CONTROL, progress=progress)
