"""Counts and measured figures of forms, harmonic maps, structures, splines."""

from __future__ import annotations

from dataclasses import dataclass

from ricci.figures.names import LowerBound, Space, StructureKind


@dataclass(frozen=True)
class FormsSummary:
    """Figures of a basis of forms.

    Attributes
    ----------
    n_forms : int
        number of forms: 2 genus, and with b > 0 boundary loops b - 1 more.
    n_edges : int
        number of edges, so of values of a form.
    genus : int
        genus of the surface.
    n_flips : int
        edge flips from the given triangulation to the Delaunay one.
    closedness : float
        largest sum of a form around a face, over the form's largest value.
    coclosedness : float
        largest weighted sum of a form around a vertex, over the form's largest value.
    asymmetry : float
        |P - P^T| / |P| of the period matrix P; NaN without one, as all below.
    star_residual : float
        |J^2 + 1| of the discrete Hodge star J.
    least_eigenvalue : float
        least eigenvalue of the imaginary part of P: positive.
    modulus : complex
        of a torus, the modulus: real and imaginary part.
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
class BoundsSummary:
    """Figures of a bound of a period matrix.

    Attributes
    ----------
    gap : float
        a proven d - 1: with the energies G of the surface's harmonic forms and those H of the matrix, H / d <= G <= d H.
    first_gap : float
        the gap on the triangulation of the forms alone, rounded.
    modulus : complex
        of a torus, the modulus; NaN of others.
    modulus_radius : float
        of a torus, the distance within which the modulus is; NaN of others.
    n_added : int
        number of vertices that were added.
    n_unknowns : int
        number of unknowns of the last system.
    n_systems : int
        number of systems that were solved.
    reached : bool
        true if the gap is at most the width.
    """

    gap: float
    first_gap: float
    modulus: complex
    modulus_radius: float
    n_added: int
    n_unknowns: int
    n_systems: int
    reached: bool


@dataclass(frozen=True)
class DilatationBracket:
    """Two numbers between which the least dilatation K of the maps of a class lies; the Teichmüller distance is log(K) / 2.

    Attributes
    ----------
    lower : float
        no map of the class has a smaller dilatation.
    upper : float
        the dilatation of a map of the class, the largest over the pieces of the common subdivision.
    most : float
        the dilatation that 99 % of the source's area stay below.
    left_out_area : float
        the share of the source's area in pieces that rounding leaves without a shape.
    gaps : tuple[float, float]
        the relative widths of the period matrices or moduli of source and target.
    n_left_out : int
        number of those pieces; they do not count in `upper`.
    lower_by : LowerBound
        what proves the lower bound.
    by_numbers : bool
        true if `upper` is of the map by the numbers of vertices, linear on the faces of one triangulation on both surfaces.
    """

    lower: float
    upper: float
    most: float
    left_out_area: float
    gaps: tuple[float, float]
    n_left_out: int
    lower_by: LowerBound
    by_numbers: bool


@dataclass(frozen=True)
class HarmonicSummary:
    """Figures of a harmonic map; NaN where they have no meaning.

    Attributes
    ----------
    energy : float
        half of the weighted sum of squared differences along the edges.
    mean_value_residual : float
        largest distance of a vertex from the mean of its neighbours, over the size of the image.
    modulus : float
        of a rectangle, its modulus: width over height.
    modulus_low : float
        of a rectangle, a lower bound of the modulus of the surface of flat triangles.
    modulus_high : float
        of a rectangle, an upper bound of it.
    n_energies : int
        number of energies: that at the start, then one per step; 0 for a map that was solved for.
    converged : bool
        true if the map is harmonic within the tolerance, false if the steps ran out.
    """

    energy: float
    mean_value_residual: float
    modulus: float
    modulus_low: float
    modulus_high: float
    n_energies: int
    converged: bool


@dataclass(frozen=True)
class StructureSummary:
    """Figures of a structure.

    Attributes
    ----------
    kind : StructureKind
        which structure it is.
    space : Space
        of which the charts are pieces.
    converged : bool
        true if the flow came to its target.
    n_matrix : int
        numbers of a matrix: 8, real and imaginary parts of [[a, b], [c, d]] of z -> (a z + b) / (c z + d); or 9, by rows.
    n_vertices : int
        number of vertices of the triangulation.
    n_faces : int
        number of its faces.
    n_charts : int
        number of charts.
    n_transitions : int
        number of transitions: one for each connected overlap of two charts.
    n_generators : int
        number of generators of the fundamental group: 2 g + b.
    n_singular : int
        number of singular vertices.
    n_excluded : int
        number of faces of no chart.
    n_zeros : int
        number of zeros of the 1-form.
    n_folded : int
        number of charts that are folded.
    n_triples : int
        how many overlaps of three charts were composed.
    transition_residual : float
        largest distance between the image of a shared vertex and its place, over the size of the chart.
    cocycle_residual : float
        how far transitions around overlaps of three charts are from the identity, at most.
    relation_residual : float
        how far the relation of the group is from the identity, over its partial products.
    max_curvature_error : float
        largest |K| at a vertex that is not singular, radians.
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

    Attributes
    ----------
    degree : int
        1 to 5.
    n_patches : int
        number of patches.
    n_basis : int
        number of basis functions of a patch, (degree + 1) (degree + 2) / 2.
    n_control_points : int
        number of control points.
    fit_rms : float
        of a fit, the root of the mean squared distance between points and surface; NaN of other splines.
    fit_max : float
        the largest such distance.
    n_holes : int
        number of holes around singular vertices.
    n_folded_patches : int
        of a fit to a surface, the number of patches in which it folds, `Spline.folds`.
    folded_share : float
        the share of the fitted surface that lies in these patches; NaN of splines that were not fitted.
    converged : bool
        a fit to a surface is within the tolerance asked for, and folds nowhere.
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

    Attributes
    ----------
    n_patches : int
        number of patches, three for each of the spline.
    n_curves : int
        number of curves, each a side of one patch or of two.
    n_control_points : int
        number of control points of all patches.
    spans_min : int
        least number of spans along a side.
    spans_max : int
        largest number of spans along a side.
    rounds : int
        times that patches were made: once, and again where they missed the spline.
    n_open_sides : int
        number of sides whose control points or knots differ from those of their curve: 0 is watertight.
    closed : bool
        true if every curve is a side of two patches.
    diagonal : float
        the diagonal of the bounding box of the corners, middles of sides and centroids of the spline's patches.
    distance : float
        largest distance of a patch from the spline's point with the same parameters, over the diagonal, between the points that
        are interpolated.
    normal_jump_max : float
        largest angle between the normals of neighbouring patches along their common curves.
    normal_jump_mean : float
        the mean of these angles.
    normal_jump_of_spline : float
        the largest between the spline's own normals at the same places.
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
