"""Counts and measured figures of meshes, triangle lists, metrics, flows."""

from __future__ import annotations

from dataclasses import dataclass

from ricci.figures.names import Scheme, Space, Stop


@dataclass(frozen=True)
class MeshSummary:
    """Counts of a mesh.

    Attributes:
        n_vertices: V.
        n_edges: E.
        n_faces: F.
        n_boundary_loops: number of boundary loops; 0 for a closed surface.
        n_boundary_vertices: number of vertices on the boundary.
        euler: V - E + F.
        genus: (2 - euler - boundary loops) / 2.
        has_positions: true if its vertices have positions in space, 0 for an intrinsic surface.
        geometry: the geometry in which its lengths are meant.
        n_normals: number of normals of vertices: V, or 0 if the mesh was not read from a file that has them.
        n_colors: number of colours: V, or 0.
        n_uv: number of faces with texture coordinates: F, or 0.
        n_corner_normals: number of faces with normals at their corners, instead of those of the vertices: F, or 0.
    """

    n_vertices: int
    n_edges: int
    n_faces: int
    n_boundary_loops: int
    n_boundary_vertices: int
    euler: int
    genus: int
    has_positions: bool
    geometry: Space
    n_normals: int
    n_colors: int
    n_uv: int
    n_corner_normals: int


@dataclass(frozen=True)
class SoupSummary:
    """Counts of a triangle list, and what its repair did.

    Attributes:
        n_vertices: number of vertices.
        n_edges: number of distinct edges.
        n_faces: number of faces.
        n_defects: number of defects; without any, a mesh can be built.
        n_components: connected pieces.
        n_boundary_loops: boundary loops, as connected pieces of the edges with one face (where the surface is no manifold, too).
        euler: V - E + F over the vertices in use.
        genus: genus; -1 where the surface is not a connected, orientable manifold.
        n_normals: number of normals of vertices: n_vertices, or 0.
        n_colors: number of colours: n_vertices, or 0.
        n_uv: number of faces with texture coordinates: n_faces, or 0.
        n_corner_normals: number of faces with normals at their corners: n_faces, or 0.
        welded_vertices: of a repaired list, as all below: vertices that became one with an earlier vertex.
        degenerate_faces: faces dropped because they used a vertex twice.
        duplicate_faces: faces dropped because an earlier face had their vertices.
        cut_edges: edges along which the surface was cut open.
        split_vertices: vertices made for further fans of faces.
        turned_faces: faces turned around.
        faces_of_other_components: faces of other components than the one that was asked for.
        isolated_vertices: vertices dropped because no face uses them.
        refused_edges: edges in which welding would have made more than two faces meet: `Soup.refused` lists them.
        refused_faces: faces of all these edges together.
        non_finite_faces: faces dropped because a corner has no finite place.
        joined_t_junctions: vertices put on the boundary edges on which they lie.
        collapsed_edges: edges collapsed because a face without area had two corners in nearly one place.
        flipped_edges: faces without area replaced by dividing the face beyond their longest edge.
        opened_faces: faces without area dropped at the boundary.
        filled_holes: boundary loops that were filled.
        open_holes: boundary loops that were to be filled and could not be.
        n_hints: of any list: findings that are no defects, `Soup.hints`.
        n_loops: number of loops of `Soup.loops`: chains that end in an edge of more than two faces are none.
        n_loop_vertices: number of vertices of all these loops.
        n_vertex_numbers: number of further numbers of every vertex, `Soup.vertex_numbers`.
        n_face_numbers: number of further numbers of every face.
    """

    n_vertices: int
    n_edges: int
    n_faces: int
    n_defects: int
    n_components: int
    n_boundary_loops: int
    euler: int
    genus: int
    n_normals: int
    n_colors: int
    n_uv: int
    n_corner_normals: int
    welded_vertices: int
    degenerate_faces: int
    duplicate_faces: int
    cut_edges: int
    split_vertices: int
    turned_faces: int
    faces_of_other_components: int
    isolated_vertices: int
    refused_edges: int
    refused_faces: int
    non_finite_faces: int
    joined_t_junctions: int
    collapsed_edges: int
    flipped_edges: int
    opened_faces: int
    filled_holes: int
    open_holes: int
    n_hints: int
    n_loops: int
    n_loop_vertices: int
    n_vertex_numbers: int
    n_face_numbers: int


@dataclass(frozen=True)
class QualitySummary:
    """How well shaped triangles are.

    Attributes:
        area: area of all faces.
        min_angle: the smallest angle, radians; 0 of a face without area.
        obtuse_fraction: share of the faces with an angle above 90 degrees.
        edge_ratio: longest over shortest edge; NaN if an edge has length 0.
        non_delaunay_fraction: share of the interior edges whose opposite angles add up to more than pi; NaN of what is no surface.
    """

    area: float
    min_angle: float
    obtuse_fraction: float
    edge_ratio: float
    non_delaunay_fraction: float


@dataclass(frozen=True)
class RefineSummary:
    """The course of a refinement of a metric.

    Attributes:
        n_inside: vertices that were added inside the surface.
        n_on_boundary: vertices that were added on the boundary.
        n_flips: edges that were flipped.
        n_below: triangles with a smaller angle than asked for: 0 unless the most vertices were added.
        n_forced: triangles whose smaller angle the surface forces, at corners where it has an angle below 60 degrees.
        given_angle: the smallest angle of the given triangles, radians.
        least_angle: the smallest angle of the triangles where the surface forces none, radians.
    """

    n_inside: int
    n_on_boundary: int
    n_flips: int
    n_below: int
    n_forced: int
    given_angle: float
    least_angle: float


@dataclass(frozen=True)
class MetricSummary:
    """Figures of a metric.

    Attributes:
        space: the geometry of its triangles.
        input_geometry: the geometry in which the input lengths were read.
        scheme: how lengths depend on u.
        doubled: true if its triangulation is one of the double of the surface: two copies glued along the boundary.
        n_vertices: V of the mesh it was made from, the entries of per-vertex arrays.
        n_mesh_vertices: V of its triangulation: those of the mesh, and of a double the mirror images of interior vertices behind them.
        n_edges: E of its triangulation, the entries of per-edge arrays.
        n_faces: F of its triangulation.
        area: area of the surface, in units of the input length squared (E2) or of 1/|curvature|.
        gauss_bonnet: |sum of curvatures + lambda area - 2 pi chi| of its triangulation: rounding only.
        broken_triangles: number of triangles whose lengths break the triangle inequality.
        clamped_edges: edges whose initial weight the scheme had to change (Thurston).
        max_length_change: largest relative change of an edge length by going over to the scheme.
        n_flips: edge flips from the mesh it was made from to its triangulation.
        n_start_flips: those of them that come before the flow and change no distance on the surface.
        max_log_length: largest |log| of a length of the metric that the scheme starts from, over that of the surface; 0 with schemes that
            represent every metric.
        mean_log_length: the mean of that over the sides of the faces.
        max_dilatation: largest dilatation of the maps from the surface's triangles to those of the start.
        mean_dilatation: its mean, weighed with areas. Flows are conformal to the start, so refining does not lower it.
        far: true if the start is so far (mean dilatation above 1.02, or a largest one above 2) that results belong to another conformal
            structure than the surface's.
    """

    space: Space
    input_geometry: Space
    scheme: Scheme
    doubled: bool
    n_vertices: int
    n_mesh_vertices: int
    n_edges: int
    n_faces: int
    area: float
    gauss_bonnet: float
    broken_triangles: int
    clamped_edges: int
    max_length_change: float
    n_flips: int
    n_start_flips: int
    max_log_length: float
    mean_log_length: float
    max_dilatation: float
    mean_dilatation: float
    far: bool


@dataclass(frozen=True)
class ReportSummary:
    """Figures of a report.

    Attributes:
        converged: true if the curvature error is within `tolerance` and no triangle is broken.
        stop_reason: why the flow stopped.
        iterations: number of steps.
        flips: number of edges flipped by this flow; those before it are in `MetricSummary`.
        broken_triangles: number of triangles whose lengths break the triangle inequality.
        max_curvature_error: largest |K - target| over the vertices, radians.
        tolerance: the tolerance that was asked for, radians.
        rounding_floor: largest curvature error that rounding can cause at the final metric, radians; determined where a flow stalls, else
            0.
        gauss_bonnet: |sum of curvatures + lambda area - 2 pi chi| of the result.
        seconds_assemble: seconds in the assembly of curvature and its derivative.
        seconds_analyse: seconds in the symbolic analysis.
        seconds_factor: seconds in numeric factorisations.
        seconds_solve: seconds in solves.
        seconds_flip: seconds in edge flips.
        seconds_total: seconds in all.
        n_cones: entries of CONES.
        n_residuals: entries of RESIDUALS.
        n_trace: rows of TRACE.
        n_worst: entries of WORST and WORST_ERRORS.
        n_obstruction: entries of OBSTRUCTION; 0 unless the stop reason is RICCI_STOP_INFEASIBLE.
        obstruction_target: total target curvature at the vertices of the obstruction, radians; of a double, with their mirror images.
        obstruction_above: every metric of the class on this triangulation has a total curvature above this at the vertices of the
            obstruction, radians.
        double_double: true if u, lengths and curvature were computed in double-double precision (Newton in E2).
    """

    converged: bool
    stop_reason: Stop
    iterations: int
    flips: int
    broken_triangles: int
    max_curvature_error: float
    tolerance: float
    rounding_floor: float
    gauss_bonnet: float
    seconds_assemble: float
    seconds_analyse: float
    seconds_factor: float
    seconds_solve: float
    seconds_flip: float
    seconds_total: float
    n_cones: int
    n_residuals: int
    n_trace: int
    n_worst: int
    n_obstruction: int
    obstruction_target: float
    obstruction_above: float
    double_double: bool
