"""Counts and measured figures of matchings."""

from __future__ import annotations

from dataclasses import dataclass

from ricci.figures.names import Verdict


@dataclass(frozen=True)
class FoundLandmarks:
    """What `match` found with ``landmarks="auto"``, of landmarks that keep the sides of the surface and of those that turn it over.

    Attributes
    ----------
    n_used : int
        number of landmarks that the map meets.
    n_kept : int
        number of landmarks that were found by the best candidate that keeps the sides of the surface.
    n_mirrored : int
        number of landmarks that were found by the best candidate that turns it over.
    n_paired : int
        number of candidates that begin with pairs of extremities: they come first, that of least cost before others.
    n_signed : int
        number of candidates that begin with signs of the first eigenfunctions.
    candidate : int
        number, from 0, of the candidate that keeps the sides; it has a meaning if `has_kept`.
    mirrored_candidate : int
        number of the candidate that turns the surface over; it has a meaning if `has_mirrored`.
    misfit : float
        mean difference of distances under the map of the first, and mean distance of the target's points from images, on surfaces of
        area 1: 0.03 to 0.04 for animals in other poses.
    mirrored_misfit : float
        the same of the candidate that turns the surface over.
    has_kept : bool
        true if a candidate keeps the sides of the surface.
    has_mirrored : bool
        true if a candidate turns the surface over.
    mirror : bool
        true if one surface is like a mirror image of the other: maps that turn it over fit clearly better.
    """

    n_used: int
    n_kept: int
    n_mirrored: int
    n_paired: int
    n_signed: int
    candidate: int
    mirrored_candidate: int
    misfit: float
    mirrored_misfit: float
    has_kept: bool
    has_mirrored: bool
    mirror: bool


@dataclass(frozen=True)
class MatchingJudgement:
    """How much a map distorts, whether it brings alike points to each other, and what it is good for.

    Attributes
    ----------
    area_log_mean : float
        mean by area of ``|ln|`` of a face's share of the image's area over its share of its own surface.
    area_log_99 : float
        that which is exceeded on 1 % of the area.
    qc_mean : float
        mean by area of the quasi-conformal dilatation of the faces.
    qc_99 : float
        that which is exceeded on 1 % of the area.
    cycle_mean : float
        mean distance of a vertex from where the map and its inverse bring it, over the diagonal of the source.
    agreement : float
        of the mean distance from the surface at corresponding points: 1 where it is equal, 0 where the map does no better than chance.
    verdict : Verdict
        ``"good"``: at most 0.5, 1.5 and 0.005 in the means, and an agreement of at least 0.8. ``"unlikely"``, landmarks are needed: above
        2, 6 or 0.1, or an agreement below 0.4 without handles. Else ``"rough"``.
    """

    area_log_mean: float
    area_log_99: float
    qc_mean: float
    qc_99: float
    cycle_mean: float
    agreement: float
    verdict: Verdict


@dataclass(frozen=True)
class MatchingSummary:
    """Figures of a matching.

    Attributes
    ----------
    n_source_vertices : int
        vertices of the source.
    n_target_vertices : int
        vertices of the target.
    n_flipped : int
        faces that fold in the domain: 0, which makes the map a homeomorphism. Where faces fold there is no matching but
        RICCI_MATCHING.
    n_markings : int
        isotopy classes of maps whose energies were compared.
    outside : float
        largest distance of a vertex from the other surface's domain, as a share of the nearest triangle.
    energy : float
        energy of the source in the domain of the target; 0 where spheres are turned.
    target_energy : float
        energy of the target in its own domain.
    residual : float
        largest distance of a vertex from the mean of its neighbours, over their mean distance.
    qc_mean : float
        what follows is measured in space, 0 where a surface has no positions. Quasi-conformal dilatation from face to image: the
        mean by area, and the largest.
    qc_max : float
        the largest.
    area_ratio_min : float
        area of a face's image over its own, both as shares of the totals: the smallest.
    area_ratio_mean : float
        the mean over the faces.
    area_ratio_max : float
        the largest.
    area_log : float
        mean by area of |ln ratio|.
    distance_mean : float
        distance between a vertex and its image, over the diagonal of the target's bounding box: the mean by area.
    distance_max : float
        the largest.
    landmark_error : float
        the largest distance of a landmark's image from its partner, over that diagonal.
    cycle_mean : float
        distance of a vertex from where the map and its inverse bring it, over the diagonal of the source's bounding box: the
        mean.
    cycle_max : float
        the largest.
    n_points : int
        pairs of points that correspond: those of the options, then one for every vertex of the curves on the source that is no
        landmark.
    n_soft : int
        landmarks that need not be met.
    point_error : float
        largest distance of such a point's image from its partner, over the diagonal of the target.
    n_circles : int
        boundary loops that are circles of the domain.
    roundness : float
        largest distance of a vertex of such a loop from its circle, as a share of the radius.
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
