"""Counts and measured figures of texture atlases."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class TextureAtlasSummary:
    """Figures of a texture atlas. Stretches are relative to the scale that keeps the total area.

    Attributes
    ----------
    n_faces : int
        faces of the model.
    n_sheets : int
        connected pieces of the model that are surfaces.
    n_opened_edges : int
        edges with several faces along which the model was opened because it is no surface there.
    n_charts : int
        charts.
    n_split_faces : int
        faces with a place.
    n_split_vertices : int
        vertices after they are split along the seams.
    n_placeless : int
        faces without a place: with a corner that is missing or not finite, or with two corners in one place.
    n_folded : int
        faces that are turned over or without area on the page, by exact arithmetic.
    n_overlapping : int
        faces that meet the interior of an earlier face on the page, by exact arithmetic.
    n_turned : int
        faces that run against most faces around them, as their image does.
    page : int
        texels along a side of the page.
    stretch_l2 : float
        how much larger texels are on the model than evenly spread ones, root mean square: 1 at best.
    stretch_max : float
        the largest stretch or compression along a direction.
    stretch_99 : float
        that which is exceeded on a hundredth of the area.
    angle_mean : float
        mean by area of the largest change of an angle between two directions, degrees.
    angle_99 : float
        that which is exceeded on a hundredth of the area, degrees.
    log_area_deviation : float
        standard deviation of the logarithm of the change of areas.
    seam_length : float
        length of the seams on the model, each once, over the root of its area.
    fill : float
        the share of the page that faces fill.
    texel_density : float
        texels per unit of length on the model.
    """

    n_faces: int
    n_sheets: int
    n_opened_edges: int
    n_charts: int
    n_split_faces: int
    n_split_vertices: int
    n_placeless: int
    n_folded: int
    n_overlapping: int
    n_turned: int
    page: int
    stretch_l2: float
    stretch_max: float
    stretch_99: float
    angle_mean: float
    angle_99: float
    log_area_deviation: float
    seam_length: float
    fill: float
    texel_density: float
