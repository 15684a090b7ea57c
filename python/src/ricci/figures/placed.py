"""Counts and measured figures of layouts, maps, charts, circle domains."""

from __future__ import annotations

from dataclasses import dataclass

from ricci.figures.names import Frame, Model, Space, Stop


@dataclass(frozen=True)
class LayoutSummary:
    """Figures of a layout.

    Attributes
    ----------
    space : Space
        the geometry of its space.
    model : Model
        the coordinates of `Layout.uv`.
    n_vertices : int
        V of what is laid out: those of the mesh, then the crossings.
    n_edges : int
        E of what is laid out.
    n_faces : int
        F of what is laid out.
    n_input_vertices : int
        V of the mesh that the metric was made from: these vertices come first.
    n_input_faces : int
        F of that mesh.
    n_points : int
        number of points: vertices count once per piece of their star between cuts.
    n_seams : int
        number of seams.
    n_seam_edges : int
        number of edges on all seams, on what is laid out.
    n_flipped : int
        faces that are not counterclockwise: by exact arithmetic; of a common subdivision, those that are clockwise by more than
        rounding.
    n_flipped_input : int
        faces of the mesh that are not counterclockwise where the map is made linear on them (``"input"``): there it folds.
    n_degenerate : int
        faces of what is laid out without area in the input or the layout, but for rounding; its distortions below leave them
        out.
    consistency : float
        largest disagreement of an edge vector with the placed points: relative to `diameter` in E2, elsewhere a distance.
    scale : float
        lengths in the layout over lengths in the metric.
    area : float
        area of the surface in the layout.
    diameter : float
        diagonal of the bounding box of the points in `model`.
    radius : float
        largest distance of a point from the origin, in the space.
    qc_mean : float
        quasi-conformal dilatation of the faces of what is laid out, at least 1: mean over the input's area. NaN, as all below, on
        the metric's own triangulation.
    qc_max : float
        largest quasi-conformal dilatation.
    area_ratio_min : float
        smallest area distortion: share of the layout's area over share of the input's.
    area_ratio_max : float
        largest area distortion.
    n_degenerate_input : int
        the faces without area of the mesh itself, where the map is made linear on them (``"input"``); the distortions
        of its faces leave them out.
    qc_mean_input : float
        the mean dilatation of the mesh's own faces. NaN, as the three below, where the layout is cut along edges of
        the metric's triangulation.
    qc_max_input : float
        largest quasi-conformal dilatation of the mesh's own faces.
    area_ratio_min_input : float
        smallest area distortion of the mesh's own faces.
    area_ratio_max_input : float
        largest area distortion of the mesh's own faces.
    overlap : float
        share of the layout's area that lies on other parts of it, up to rounding: an atlas has no overlaps. NaN outside the plane.
    symmetric_dirichlet : float
        the mean over the input's area of the sum of the squares of the singular values and of their inverses, with
        both total areas scaled to be the same; 4 for an isometry.
    """

    space: Space
    model: Model
    n_vertices: int
    n_edges: int
    n_faces: int
    n_input_vertices: int
    n_input_faces: int
    n_points: int
    n_seams: int
    n_seam_edges: int
    n_flipped: int
    n_flipped_input: int
    n_degenerate: int
    consistency: float
    scale: float
    area: float
    diameter: float
    radius: float
    qc_mean: float
    qc_max: float
    area_ratio_min: float
    area_ratio_max: float
    n_degenerate_input: int
    qc_mean_input: float
    qc_max_input: float
    area_ratio_min_input: float
    area_ratio_max_input: float
    overlap: float
    symmetric_dirichlet: float


@dataclass(frozen=True)
class MapSummary:
    """Figures of a map.

    Attributes
    ----------
    n_vertices : int
        V of the common subdivision: those of the mesh, then n_crossings.
    n_edges : int
        E of the common subdivision.
    n_faces : int
        F of the common subdivision.
    n_crossings : int
        vertices where an edge of the mesh and one of the metric's triangulation cross; 0 if no edge was flipped.
    n_pieces : int
        number of pieces: a piece is what a face of the mesh and one of the metric's triangulation have in common, cut into
        triangles.
    """

    n_vertices: int
    n_edges: int
    n_faces: int
    n_crossings: int
    n_pieces: int


@dataclass(frozen=True)
class RepairedInputSummary:
    """Figures of a repaired input.

    Attributes
    ----------
    n_vertices : int
        V: those of the mesh, then the added ones.
    n_edges : int
        E.
    n_faces : int
        F.
    n_input_vertices : int
        V of the mesh.
    n_split_edges : int
        number of edges of the mesh that were split.
    n_points : int
        number of points: vertices count once per piece of their star between cuts.
    n_flipped : int
        faces that are not counterclockwise, by exact arithmetic.
    n_degenerate : int
        faces without area on either side; the distortions below leave them out.
    qc_mean : float
        quasi-conformal dilatation of the linear maps of the faces: mean over the area of the mesh.
    qc_max : float
        largest quasi-conformal dilatation.
    area_ratio_min : float
        smallest area distortion: share of the layout's area over share of the mesh's.
    area_ratio_max : float
        largest area distortion.
    """

    n_vertices: int
    n_edges: int
    n_faces: int
    n_input_vertices: int
    n_split_edges: int
    n_points: int
    n_flipped: int
    n_degenerate: int
    qc_mean: float
    qc_max: float
    area_ratio_min: float
    area_ratio_max: float


@dataclass(frozen=True)
class ChartsSummary:
    """Figures of the charts of a layout.

    Attributes
    ----------
    n_charts : int
        number of charts.
    n_faces : int
        F of what is laid out.
    n_points : int
        number of points in the unit square.
    n_flipped : int
        faces that are clockwise by more than rounding, each a chart of its own.
    n_degenerate : int
        faces without area beyond rounding, in the layout or in the unit square; they lie in the charts of their neighbours,
        and are left out where it says that none overlap.
    scale : float
        lengths in the unit square over lengths in the layout, the same for all charts.
    efficiency : float
        share of the unit square that is covered.
    layout_seams : float
        total length of the layout's seams, in its units.
    chart_seams : float
        total length of the charts' seams, in units of the layout.
    """

    n_charts: int
    n_faces: int
    n_points: int
    n_flipped: int
    n_degenerate: int
    scale: float
    efficiency: float
    layout_seams: float
    chart_seams: float


@dataclass(frozen=True)
class SeamlessSummary:
    """Figures of a seamless metric.

    Attributes
    ----------
    converged : bool
        true if every angle is within the tolerance of its target.
    n_cones : int
        cones, and corners of the boundary.
    n_loops : int
        paths whose turning decides that of all others: 2g loops on a closed surface without features.
    flow_iterations : int
        steps of the conformal flow.
    iterations : int
        Newton steps after it.
    n_flips : int
        edge flips.
    error : float
        largest deviation, radians, of the angle around a vertex from its target, and of the turning of loops that were found
        anew, from another vertex, from multiples of 90 degrees.
    tolerance : float
        the tolerance that was asked for.
    n_features : int
        features and edges of the boundary, which are straight.
    conformal_change : float
        root mean square over the edges of the change of twice the logarithm of lengths, less its mean, before the
        isometric steps.
    length_change : float
        the same in the result.
    n_left_out : int
        features inside the surface that were asked for and are not straight.
    """

    converged: bool
    n_cones: int
    n_loops: int
    flow_iterations: int
    iterations: int
    n_flips: int
    error: float
    tolerance: float
    n_features: int
    conformal_change: float
    length_change: float
    n_left_out: int


@dataclass(frozen=True)
class CircleDomainSummary:
    """Figures of a circle domain.

    Attributes
    ----------
    space : Space
        ``"e2"``: the unit disk (genus 0) or a flat torus (1); ``"h2"`` for more.
    converged : bool
        true if the domain as it is has its curvature within the tolerance, loops that are round to 1e-9 of the radius, no
        circles that overlap and no flipped triangle.
    stop_reason : Stop
        why the flow stopped; ``"rounding_floor"`` if the domain is less exact than it.
    outer : int
        genus 0: the loop on the unit circle; else -1.
    n_circles : int
        circles: one per boundary loop of the mesh.
    n_overlapping : int
        circles that overlap another one.
    iterations : int
        Newton steps of all flows.
    n_flips : int
        edge flips.
    n_halved : int
        vertices that were added to the mesh before the flow: the last ones of `CircleDomain.mesh`.
    n_crossed : int
        vertices that flips have added to loops: some of those that the layout has beyond that mesh.
    max_curvature_error : float
        largest |K| of the metric off the outer loop, radians.
    deviation : float
        largest distance of a loop's vertex from its circle, a share of the radius.
    modulus : complex
        an annulus: 0 and its height over its circumference. A torus with holes: the modulus of the torus. Else NaN.
    frame : Frame
        ``"disk"`` or ``"strip"``: the shape of the layout; ``"auto"`` of genus 1 and more.
    worst_loop : int
        the loop with the largest deviation; -1: none.
    worst_vertex : int
        the vertex of the metric with the largest |K|, a hub beyond those of the mesh; -1: none.
    centred_on : int
        the loop that was put about 0 because doubles do not hold it elsewhere; -1: none.
    """

    space: Space
    converged: bool
    stop_reason: Stop
    outer: int
    n_circles: int
    n_overlapping: int
    iterations: int
    n_flips: int
    n_halved: int
    n_crossed: int
    max_curvature_error: float
    deviation: float
    modulus: complex
    frame: Frame
    worst_loop: int
    worst_vertex: int
    centred_on: int
