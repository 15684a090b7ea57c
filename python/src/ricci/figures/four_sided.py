"""Counts and measured figures of quad meshes, of their layouts, and of splines over these."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class QuadsSummary:
    """Figures of a quad mesh. The shape of the quads is NaN on a surface without positions.

    Attributes
    ----------
    n_quads : int
        quads.
    n_vertices : int
        vertices.
    n_irregular : int
        vertices inside that have not four quads, and on the boundary that have not two.
    n_collapsed : int
        quads that were collapsed because two of their sides were one edge: those around cones of valence 1.
    n_creases : int
        edges on features and on the boundary.
    n_off_axis : int
        features that are not parallel to an axis exactly, so that edges need not run along them.
    n_rectangles : int
        rectangles of the T-mesh of the seamless map.
    n_arcs : int
        arcs of the T-mesh.
    euler : int
        vertices less edges plus quads, counted anew from the quads.
    n_bad_edges : int
        edges with more than one quad on a side, and sides of quads that have a vertex twice.
    n_bad_vertices : int
        vertices whose quads form more than one fan.
    cost : float
        the sum over the arcs of the squares of the edges along them less the wanted number of edges.
    edge : float
        the edge length that was asked for, or found for a number of quads, units of the surface's lengths.
    angle_mean : float
        the mean deviation of the corners' angles from 90 degrees in space, radians.
    angle_max : float
        the largest deviation of a corner's angle from 90 degrees, radians.
    edge_mean : float
        the mean length of the edges in space.
    edge_deviation : float
        the standard deviation of the lengths of the edges over their mean.
    """

    n_quads: int
    n_vertices: int
    n_irregular: int
    n_collapsed: int
    n_creases: int
    n_off_axis: int
    n_rectangles: int
    n_arcs: int
    euler: int
    n_bad_edges: int
    n_bad_vertices: int
    cost: float
    edge: float
    angle_mean: float
    angle_max: float
    edge_mean: float
    edge_deviation: float


@dataclass(frozen=True)
class QuadLayoutSummary:
    """Figures of a layout of patches.

    Attributes
    ----------
    n_nodes : int
        nodes, where arcs end.
    n_arcs : int
        arcs between nodes.
    n_patches : int
        patches.
    n_units : int
        unit squares of all patches.
    n_parts : int
        edges of the quad mesh in one unit of length.
    n_quads : int
        quads of the quad mesh.
    n_vertices : int
        vertices of the quad mesh.
    """

    n_nodes: int
    n_arcs: int
    n_patches: int
    n_units: int
    n_parts: int
    n_quads: int
    n_vertices: int


@dataclass(frozen=True)
class QuadSplineSummary:
    """Figures of a spline over a layout. Distances are over the diagonal of the surface's bounding box.

    Attributes
    ----------
    n_patches : int
        patches.
    n_arcs : int
        arcs, each a side of one patch or of two.
    n_nodes : int
        nodes, where arcs end.
    degree : int
        along u and v: 5.
    most_spans : int
        largest number of spans of a patch along u or v.
    n_control_points : int
        control points of all patches, those on common sides once.
    n_free : int
        free control points, of which all others are combinations.
    n_entries : int
        entries of the extraction matrix.
    n_folded_patches : int
        patches that are turned over somewhere.
    diagonal : float
        the diagonal of the bounding box of the surface that was fitted.
    rms : float
        root of the mean squared distance of places of the patches from the surface.
    max : float
        the largest of these distances.
    vertex_rms : float
        root of the mean squared distance of the vertices from the spline.
    vertex_max : float
        the largest of these distances.
    normal_error : float
        the largest angle between the normals of spline and surface, radians.
    normal_jump : float
        the largest angle between normals on both sides of an arc that is no crease, radians.
    noise : float
        the standard deviation of the noise of the surface's vertices over the diagonal, as their heights over the spline tell.
    tolerance : float
        over the diagonal: the one that was asked for, else as in the options.
    converged : bool
        distances are within the tolerance, and no patch is turned over.
    volume : float
        inside, negative if normals point inwards; NaN with a boundary.
    """

    n_patches: int
    n_arcs: int
    n_nodes: int
    degree: int
    most_spans: int
    n_control_points: int
    n_free: int
    n_entries: int
    n_folded_patches: int
    diagonal: float
    rms: float
    max: float
    vertex_rms: float
    vertex_max: float
    normal_error: float
    normal_jump: float
    noise: float
    tolerance: float
    converged: bool
    volume: float
