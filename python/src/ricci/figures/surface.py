"""Counts and measured figures of meshes, triangle lists, metrics, flows."""

from __future__ import annotations

from dataclasses import dataclass

from ricci.figures.names import Scheme, Space, Stop


@dataclass(frozen=True)
class ArchiveSummary:
    """What an archive holds.

    Attributes
    ----------
    kind : str
        the kind of object.
    n_bytes : int
        number of bytes of the whole archive.
    format : int
        the version of the format.
    """

    kind: str
    n_bytes: int
    format: int


@dataclass(frozen=True)
class MeshSummary:
    """Counts of a mesh.

    Attributes
    ----------
    n_vertices : int
        V.
    n_edges : int
        E.
    n_faces : int
        F.
    n_boundary_loops : int
        number of boundary loops; 0 for a closed surface.
    n_boundary_vertices : int
        number of vertices on the boundary.
    euler : int
        V - E + F.
    genus : int
        (2 - euler - boundary loops) / 2.
    has_positions : bool
        true if its vertices have positions in space, 0 for an intrinsic surface.
    geometry : Space
        the geometry in which its lengths are meant.
    n_normals : int
        number of normals of vertices: V, or 0 if the mesh was not read from a file that has them.
    n_colors : int
        number of colours: V, or 0.
    n_uv : int
        number of faces with texture coordinates: F, or 0.
    n_corner_normals : int
        number of faces with normals at their corners, instead of those of the vertices: F, or 0.
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

    Attributes
    ----------
    n_vertices : int
        number of vertices.
    n_edges : int
        number of distinct edges.
    n_faces : int
        number of faces.
    n_defects : int
        number of defects; without any, a mesh can be built.
    n_components : int
        connected pieces.
    n_boundary_loops : int
        boundary loops, as connected pieces of the edges with one face (where the surface is no manifold, too).
    euler : int
        V - E + F over the vertices in use.
    genus : int
        genus; -1 where the surface is not a connected, orientable manifold.
    n_normals : int
        number of normals of vertices: n_vertices, or 0.
    n_colors : int
        number of colours: n_vertices, or 0.
    n_uv : int
        number of faces with texture coordinates: n_faces, or 0.
    n_corner_normals : int
        number of faces with normals at their corners: n_faces, or 0.
    welded_vertices : int
        of a repaired list, as all below: vertices that became one with an earlier vertex.
    degenerate_faces : int
        faces dropped because they used a vertex twice.
    duplicate_faces : int
        faces dropped because an earlier face had their vertices.
    cut_edges : int
        edges along which the surface was cut open.
    split_vertices : int
        vertices made for further fans of faces.
    turned_faces : int
        faces turned around.
    faces_of_other_components : int
        faces of other components than the one that was asked for.
    isolated_vertices : int
        vertices dropped because no face uses them.
    refused_edges : int
        edges in which welding would have made more than two faces meet: `Soup.refused` lists them.
    refused_faces : int
        faces of all these edges together.
    non_finite_faces : int
        faces dropped because a corner has no finite place.
    joined_t_junctions : int
        vertices put on the boundary edges on which they lie.
    collapsed_edges : int
        edges collapsed because a face without area had two corners in nearly one place.
    flipped_edges : int
        faces without area replaced by dividing the face beyond their longest edge.
    opened_faces : int
        faces without area dropped at the boundary.
    filled_holes : int
        boundary loops that were filled.
    open_holes : int
        boundary loops that were to be filled and could not be.
    n_hints : int
        of any list: findings that are no defects, `Soup.hints`.
    n_loops : int
        number of loops of `Soup.loops`: chains that end in an edge of more than two faces are none.
    n_loop_vertices : int
        number of vertices of all these loops.
    n_vertex_numbers : int
        number of further numbers of every vertex, `Soup.vertex_numbers`.
    n_face_numbers : int
        number of further numbers of every face.
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

    Attributes
    ----------
    area : float
        area of all faces.
    min_angle : float
        the smallest angle, radians; 0 of a face without area.
    obtuse_fraction : float
        share of the faces with an angle above 90 degrees.
    edge_ratio : float
        longest over shortest edge; NaN if an edge has length 0.
    non_delaunay_fraction : float
        share of the interior edges whose opposite angles add up to more than pi; NaN of what is no surface.
    """

    area: float
    min_angle: float
    obtuse_fraction: float
    edge_ratio: float
    non_delaunay_fraction: float


@dataclass(frozen=True)
class RefineSummary:
    """The course of a refinement of a metric.

    Attributes
    ----------
    n_inside : int
        vertices that were added inside the surface.
    n_on_boundary : int
        vertices that were added on the boundary.
    n_flips : int
        edges that were flipped.
    n_below : int
        triangles with a smaller angle than asked for: 0 unless the most vertices were added.
    n_forced : int
        triangles whose smaller angle the surface forces, at corners where it has an angle below 60 degrees.
    given_angle : float
        the smallest angle of the given triangles, radians.
    least_angle : float
        the smallest angle of the triangles where the surface forces none, radians.
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

    Attributes
    ----------
    space : Space
        the geometry of its triangles.
    input_geometry : Space
        the geometry in which the input lengths were read.
    scheme : Scheme
        how lengths depend on u.
    doubled : bool
        true if its triangulation is one of the double of the surface: two copies glued along the boundary.
    n_vertices : int
        V of the mesh it was made from, the entries of per-vertex arrays.
    n_mesh_vertices : int
        V of its triangulation: those of the mesh, and of a double the mirror images of interior vertices behind them.
    n_edges : int
        E of its triangulation, the entries of per-edge arrays.
    n_faces : int
        F of its triangulation.
    area : float
        area of the surface, in units of the input length squared (E2) or of 1/|curvature|.
    gauss_bonnet : float
        |sum of curvatures + lambda area - 2 pi chi| of its triangulation: rounding only.
    broken_triangles : int
        number of triangles whose lengths break the triangle inequality.
    clamped_edges : int
        edges whose initial weight the scheme had to change (Thurston).
    max_length_change : float
        largest relative change of an edge length by going over to the scheme.
    n_flips : int
        edge flips from the mesh it was made from to its triangulation.
    n_start_flips : int
        those of them that come before the flow and change no distance on the surface.
    max_log_length : float
        largest |log| of a length of the metric that the scheme starts from, over that of the surface; 0 with schemes that
        represent every metric.
    mean_log_length : float
        the mean of that over the sides of the faces.
    max_dilatation : float
        largest dilatation of the maps from the surface's triangles to those of the start.
    mean_dilatation : float
        its mean, weighed with areas. Flows are conformal to the start, so refining does not lower it.
    far : bool
        true if the start is so far (mean dilatation above 1.02, or a largest one above 2) that results belong to another conformal
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

    Attributes
    ----------
    converged : bool
        true if the curvature error is within `tolerance` and no triangle is broken.
    stop_reason : Stop
        why the flow stopped.
    iterations : int
        number of steps.
    flips : int
        number of edges flipped by this flow; those before it are in `MetricSummary`.
    broken_triangles : int
        number of triangles whose lengths break the triangle inequality.
    max_curvature_error : float
        largest |K - target| over the vertices, radians.
    tolerance : float
        the tolerance that was asked for, radians.
    rounding_floor : float
        largest curvature error that rounding can cause at the final metric, radians; determined where a flow stalls, else
        0.
    gauss_bonnet : float
        |sum of curvatures + lambda area - 2 pi chi| of the result.
    seconds_assemble : float
        seconds in the assembly of curvature and its derivative.
    seconds_analyse : float
        seconds in the symbolic analysis.
    seconds_factor : float
        seconds in numeric factorisations.
    seconds_solve : float
        seconds in solves.
    seconds_flip : float
        seconds in edge flips.
    seconds_total : float
        seconds in all.
    n_cones : int
        entries of CONES.
    n_residuals : int
        entries of RESIDUALS.
    n_trace : int
        rows of TRACE.
    n_worst : int
        entries of WORST and WORST_ERRORS.
    n_obstruction : int
        entries of OBSTRUCTION; 0 unless the stop reason is RICCI_STOP_INFEASIBLE.
    obstruction_target : float
        total target curvature at the vertices of the obstruction, radians; of a double, with their mirror images.
    obstruction_above : float
        every metric of the class on this triangulation has a total curvature above this at the vertices of the
        obstruction, radians.
    double_double : bool
        true if u, lengths and curvature were computed in double-double precision (Newton in E2).
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
