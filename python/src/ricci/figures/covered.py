"""Counts and measured figures of uniformization and the universal cover."""

from __future__ import annotations

from dataclasses import dataclass

from ricci.figures.names import Space, Stop


@dataclass(frozen=True)
class UniformSummary:
    """Figures of a uniformization. What a kind of surface does not have is 0.

    Attributes
    ----------
    space : Space
        ``"s2"``, ``"e2"``, ``"h2"`` for chi > 0, = 0, < 0; ``"e2"`` with straight sides.
    base : int
        the base vertex: at the origin of a quotient, at infinity of the plane under a sphere.
    converged : bool
        true if the curvature is within the tolerance and no triangle is broken; of a sphere also every edge Delaunay and the
        plane's outline convex to 1e-9.
    stop_reason : Stop
        why the flow stopped.
    genus : int
        g.
    iterations : int
        Newton steps of all flows.
    n_flips : int
        edge flips inside the conformal class.
    n_start_flips : int
        edge flips before them, which change no distance on the surface.
    max_curvature_error : float
        largest |K| that the flow has left, of a sphere in the plane under it, radians.
    angle_defect : float
        largest |K| of the metric, of a quotient after corrections in double-double precision, radians.
    gauss_bonnet : float
        |sum of curvatures + lambda area - 2 pi chi| of the metric.
    area : float
        area: in the plane that of the given surface, else 2 pi |chi|; by a formula without angles.
    n_generators : int
        quotients: number of generators, 2 g and one per boundary loop.
    n_sides : int
        quotients: number of sides of the layout as a fundamental domain.
    n_polygon : int
        quotients: corners of `Uniform.polygon`, 4 g and one per boundary loop.
    disagreement : float
        quotients: largest distance between where a face has its corner and where the corner lies, also across the cut by the
        pairings.
    radius : float
        quotients: largest distance of a point of the layout from the origin.
    relation_residual : float
        quotients: |R - I| / max |P_k|^2 of the relation's matrix R over its partial products P_k, Frobenius norms of 2 x
        2 matrices.
    side_residual : float
        quotients: the same of each side's pairing against its word; the largest.
    base_lift : tuple[float, float, float]
        quotients: ambient coordinates of the base lift, from which deck transformations are counted: the origin, up to a loop of
        the base on the cut.
    modulus : complex
        of a torus, real and imaginary part: the quotient of two periods in |Re| <= 1/2, |tau| >= 1, Im > 0, on the border Re >= 0.
        Else NaN.
    n_tried : int
        spheres: flows that were started.
    u_range : float
        spheres: largest minus smallest u in the plane. Beyond about 30 positions run out of digits, where the metric does not.
    smallest_edge : float
        spheres: length of the shortest edge.
    delaunay_violation : float
        spheres: by how much angles opposite an edge exceed pi in the plane at most, radians: 0 where all edges are
        Delaunay.
    outline_turning : float
        spheres: least turning of the plane's outline, radians: not negative where it is convex.
    nonconvexity : float
        spheres: largest signed distance of a vertex over the plane of a neighbouring face: not positive where the polyhedron
        is convex.
    off_centre : float
        spheres: |sum of w x| / sum of w over the vertices, w one third of the area of the given faces at x.
    n_boundary_sides : int
        number of straight sides of the boundary; a loop without corners has one.
    straightness : float
        largest distance of a vertex of the boundary from the line through the ends of its side: in the hyperbolic plane a
        length, in the plane in units of the side.
    extremal_distance : float
        of an annulus in the plane, and of a disk with four right angles, height over base: the distance of the loops
        over the length of one, the length of the second side over that of the first. Else NaN.
    """

    space: Space
    base: int
    converged: bool
    stop_reason: Stop
    genus: int
    iterations: int
    n_flips: int
    n_start_flips: int
    max_curvature_error: float
    angle_defect: float
    gauss_bonnet: float
    area: float
    n_generators: int
    n_sides: int
    n_polygon: int
    disagreement: float
    radius: float
    relation_residual: float
    side_residual: float
    base_lift: tuple[float, float, float]
    modulus: complex
    n_tried: int
    u_range: float
    smallest_edge: float
    delaunay_violation: float
    outline_turning: float
    nonconvexity: float
    off_centre: float
    n_boundary_sides: int
    straightness: float
    extremal_distance: float


@dataclass(frozen=True)
class DeckSummary:
    """Figures of deck transformations.

    Attributes
    ----------
    space : Space
        the space they act on.
    longest : int
        most letters of a word.
    n_elements : int
        number of elements.
    n_letters : int
        number of letters of all words.
    """

    space: Space
    longest: int
    n_elements: int
    n_letters: int


@dataclass(frozen=True)
class DirichletSummary:
    """Figures of a Dirichlet domain.

    Attributes
    ----------
    space : Space
        where it lies.
    n_sides : int
        number of sides, and of corners.
    area : float
        area of the polygon, from its sides and the rays to its corners: that of the surface.
    radius : float
        largest distance of a corner from the centre.
    centre : tuple[float, float, float]
        ambient coordinates of the centre.
    """

    space: Space
    n_sides: int
    area: float
    radius: float
    centre: tuple[float, float, float]


@dataclass(frozen=True)
class HomotopySummary:
    """Figures of a homotopy basis.

    Attributes
    ----------
    base : int
        the base vertex.
    genus : int
        g.
    n_boundary_loops : int
        b.
    n_generators : int
        2 g + b.
    n_relator : int
        letters of the relation, 4 g + b.
    n_loop_edges : int
        number of edges of all loops.
    """

    base: int
    genus: int
    n_boundary_loops: int
    n_generators: int
    n_relator: int
    n_loop_edges: int


@dataclass(frozen=True)
class DomainSummary:
    """Figures of a fundamental domain.

    Attributes
    ----------
    n_sides : int
        number of sides, and of corners.
    n_side_edges : int
        number of edges of all sides.
    n_side_letters : int
        number of letters of all sides' words.
    n_corner_letters : int
        number of letters of all corners' words.
    base_edge : int
        a half-edge of a face of the domain that starts at the base lift, as a signed edge number.
    """

    n_sides: int
    n_side_edges: int
    n_side_letters: int
    n_corner_letters: int
    base_edge: int
