"""Counts and measured figures of quad meshes and of their layouts."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class QuadsSummary:
    """Figures of a quad mesh. The shape of the quads is NaN on a surface without positions.

    Attributes:
        n_quads: quads.
        n_vertices: vertices.
        n_irregular: vertices inside that have not four quads, and on the boundary that have not two.
        n_collapsed: quads that were collapsed because two of their sides were one edge: those around cones of valence 1.
        n_creases: edges on features and on the boundary.
        n_off_axis: features that are not parallel to an axis exactly, so that edges need not run along them.
        n_rectangles: rectangles of the T-mesh of the seamless map.
        n_arcs: arcs of the T-mesh.
        euler: vertices less edges plus quads, counted anew from the quads.
        n_bad_edges: edges with more than one quad on a side, and sides of quads that have a vertex twice.
        n_bad_vertices: vertices whose quads form more than one fan.
        cost: the sum over the arcs of the squares of the edges along them less the wanted number of edges.
        edge: the edge length that was asked for, or found for a number of quads, units of the surface's lengths.
        angle_mean: the mean deviation of the corners' angles from 90 degrees in space, radians.
        angle_max: the largest deviation of a corner's angle from 90 degrees, radians.
        edge_mean: the mean length of the edges in space.
        edge_deviation: the standard deviation of the lengths of the edges over their mean.
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

    Attributes:
        n_nodes: nodes, where arcs end.
        n_arcs: arcs between nodes.
        n_patches: patches.
        n_units: unit squares of all patches.
        n_parts: edges of the quad mesh in one unit of length.
        n_quads: quads of the quad mesh.
        n_vertices: vertices of the quad mesh.
    """

    n_nodes: int
    n_arcs: int
    n_patches: int
    n_units: int
    n_parts: int
    n_quads: int
    n_vertices: int
