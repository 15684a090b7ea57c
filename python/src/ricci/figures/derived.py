"""Counts and measured figures of forms, matchings, structures, splines."""

from __future__ import annotations

from dataclasses import dataclass

from ricci.figures.names import Space, StructureKind


@dataclass(frozen=True)
class FormsSummary:
    """Figures of a basis of forms.

    Attributes:
        n_forms: number of forms: 2 genus, and with b > 0 boundary loops b - 1 more.
        n_edges: number of edges, so of values of a form.
        genus: genus of the surface.
        n_flips: edge flips from the given triangulation to the Delaunay one.
        closedness: largest sum of a form around a face, over the form's largest value.
        coclosedness: largest weighted sum of a form around a vertex, over the form's largest value.
        asymmetry: |P - P^T| / |P| of the period matrix P; NaN without one, as all below.
        star_residual: |J^2 + 1| of the discrete Hodge star J.
        least_eigenvalue: least eigenvalue of the imaginary part of P: positive.
        modulus: of a torus, the modulus: real and imaginary part.
    """

    n_forms: int
    n_edges: int
    genus: int
    n_flips: int
    closedness: float
    coclosedness: float
    asymmetry: float
    star_residual: float
    least_eigenvalue: float
    modulus: complex


@dataclass(frozen=True)
class HarmonicSummary:
    """Figures of a harmonic map; NaN where they have no meaning.

    Attributes:
        energy: half of the weighted sum of squared differences along the edges.
        mean_value_residual: largest distance of a vertex from the mean of its neighbours, over the size of the image.
        modulus: of a rectangle, its modulus: width over height.
        modulus_low: of a rectangle, a lower bound of the modulus of the surface of flat triangles.
        modulus_high: of a rectangle, an upper bound of it.
        n_energies: number of energies: that at the start, then one per step; 0 for a map that was solved for.
        converged: true if the map is harmonic within the tolerance, false if the steps ran out.
    """

    energy: float
    mean_value_residual: float
    modulus: float
    modulus_low: float
    modulus_high: float
    n_energies: int
    converged: bool


@dataclass(frozen=True)
class MatchingSummary:
    """Figures of a matching.

    Attributes:
        n_source_vertices: vertices of the source.
        n_target_vertices: vertices of the target.
        n_flipped: faces that fold in the domain: 0, which makes the map a homeomorphism. Where faces fold there is no matching but
            RICCI_MATCHING.
        n_markings: isotopy classes of maps whose energies were compared.
        outside: largest distance of a vertex from the other surface's domain, as a share of the nearest triangle.
        energy: energy of the source in the domain of the target; 0 where spheres are turned.
        target_energy: energy of the target in its own domain.
        residual: largest distance of a vertex from the mean of its neighbours, over their mean distance.
        qc_mean: what follows is measured in space, 0 where a surface has no positions. Quasi-conformal dilatation from face to image: the
            mean by area, and the largest.
        qc_max: the largest.
        area_ratio_min: area of a face's image over its own, both as shares of the totals: the smallest.
        area_ratio_mean: the mean over the faces.
        area_ratio_max: the largest.
        area_log: mean by area of |ln ratio|.
        distance_mean: distance between a vertex and its image, over the diagonal of the target's bounding box: the mean by area.
        distance_max: the largest.
        landmark_error: the largest distance of a landmark's image from its partner, over that diagonal.
        cycle_mean: distance of a vertex from where the map and its inverse bring it, over the diagonal of the source's bounding box: the
            mean.
        cycle_max: the largest.
        n_points: pairs of points that correspond: those of the options, then one for every vertex of the curves on the source that is no
            landmark.
        n_soft: landmarks that need not be met.
        point_error: largest distance of such a point's image from its partner, over the diagonal of the target.
        n_circles: boundary loops that are circles of the domain.
        roundness: largest distance of a vertex of such a loop from its circle, as a share of the radius.
    """

    n_source_vertices: int
    n_target_vertices: int
    n_flipped: int
    n_markings: int
    outside: float
    energy: float
    target_energy: float
    residual: float
    qc_mean: float
    qc_max: float
    area_ratio_min: float
    area_ratio_mean: float
    area_ratio_max: float
    area_log: float
    distance_mean: float
    distance_max: float
    landmark_error: float
    cycle_mean: float
    cycle_max: float
    n_points: int
    n_soft: int
    point_error: float
    n_circles: int
    roundness: float


@dataclass(frozen=True)
class StructureSummary:
    """Figures of a structure.

    Attributes:
        kind: which structure it is.
        space: of which the charts are pieces.
        converged: true if the flow came to its target.
        n_matrix: numbers of a matrix: 8, real and imaginary parts of [[a, b], [c, d]] of z -> (a z + b) / (c z + d); or 9, by rows.
        n_vertices: number of vertices of the triangulation.
        n_faces: number of its faces.
        n_charts: number of charts.
        n_transitions: number of transitions: one for each connected overlap of two charts.
        n_generators: number of generators of the fundamental group: 2 g + b.
        n_singular: number of singular vertices.
        n_excluded: number of faces of no chart.
        n_zeros: number of zeros of the 1-form.
        n_folded: number of charts that are folded.
        n_triples: how many overlaps of three charts were composed.
        transition_residual: largest distance between the image of a shared vertex and its place, over the size of the chart.
        cocycle_residual: how far transitions around overlaps of three charts are from the identity, at most.
        relation_residual: how far the relation of the group is from the identity, over its partial products.
        max_curvature_error: largest |K| at a vertex that is not singular, radians.
    """

    kind: StructureKind
    space: Space
    converged: bool
    n_matrix: int
    n_vertices: int
    n_faces: int
    n_charts: int
    n_transitions: int
    n_generators: int
    n_singular: int
    n_excluded: int
    n_zeros: int
    n_folded: int
    n_triples: int
    transition_residual: float
    cocycle_residual: float
    relation_residual: float
    max_curvature_error: float


@dataclass(frozen=True)
class SplineSummary:
    """Figures of a spline.

    Attributes:
        degree: 1 to 5.
        n_patches: number of patches.
        n_basis: number of basis functions of a patch, (degree + 1) (degree + 2) / 2.
        n_control_points: number of control points.
        fit_rms: of a fit, the root of the mean squared distance between points and surface; NaN of other splines.
        fit_max: the largest such distance.
        n_holes: number of holes around singular vertices.
        n_folded_patches: of a fit to a surface, the number of patches in which it folds, `Spline.folds`.
        folded_share: the share of the fitted surface that lies in these patches; NaN of splines that were not fitted.
        converged: a fit to a surface is within the tolerance asked for, and folds nowhere.
    """

    degree: int
    n_patches: int
    n_basis: int
    n_control_points: int
    fit_rms: float
    fit_max: float
    n_holes: int
    n_folded_patches: int
    folded_share: float
    converged: bool


@dataclass(frozen=True)
class BicubicSummary:
    """Figures of bicubic patches.

    Attributes:
        n_patches: number of patches, three for each of the spline.
        n_curves: number of curves, each a side of one patch or of two.
        n_control_points: number of control points of all patches.
        spans_min: least number of spans along a side.
        spans_max: largest number of spans along a side.
        rounds: times that patches were made: once, and again where they missed the spline.
        n_open_sides: number of sides whose control points or knots differ from those of their curve: 0 is watertight.
        closed: true if every curve is a side of two patches.
        diagonal: the diagonal of the bounding box of the corners, middles of sides and centroids of the spline's patches.
        distance: largest distance of a patch from the spline's point with the same parameters, over the diagonal, between the points that
            are interpolated.
        normal_jump_max: largest angle between the normals of neighbouring patches along their common curves.
        normal_jump_mean: the mean of these angles.
        normal_jump_of_spline: the largest between the spline's own normals at the same places.
    """

    n_patches: int
    n_curves: int
    n_control_points: int
    spans_min: int
    spans_max: int
    rounds: int
    n_open_sides: int
    closed: bool
    diagonal: float
    distance: float
    normal_jump_max: float
    normal_jump_mean: float
    normal_jump_of_spline: float
