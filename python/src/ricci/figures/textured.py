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
    n_pages : int
        pages; 1 unless a density is asked for.
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
    n_pages: int


@dataclass(frozen=True)
class SceneSummary:
    """Counts of a scene.

    Attributes
    ----------
    n_nodes : int
        nodes.
    n_meshes : int
        meshes with triangles.
    n_primitives : int
        primitives with triangles: parts of meshes that have one material each.
    n_materials : int
        materials.
    n_vertices : int
        vertices of all these primitives; those that several primitives of a mesh share count once.
    n_faces : int
        triangles.
    """

    n_nodes: int
    n_meshes: int
    n_primitives: int
    n_materials: int
    n_vertices: int
    n_faces: int


@dataclass(frozen=True)
class SceneReport:
    """What was written of a scene, and what is not as it was.

    Attributes
    ----------
    texcoord : int
        the set of texture coordinates that holds the atlas.
    n_primitives : int
        primitives that have it.
    n_vertices : int
        their vertices in the file that was read.
    n_split_vertices : int
        their vertices in the file that was written.
    n_replaced : int
        primitives that had coordinates in this set, which are gone.
    n_kept_textures : int
        textures of materials that use other sets, which are as they were.
    n_misplaced_textures : int
        textures that use this set, whose pictures no longer fit: 0 unless the set was asked for.
    n_tangents : int
        primitives with tangents of the atlas.
    n_without_tangents : int
        primitives without, though they were asked for: without normals, or with a normal map on another set.
    n_dropped_tangents : int
        primitives whose tangents are gone with the coordinates that they belonged to.
    n_unrolled : int
        strips and fans that became lists of triangles.
    n_shared_meshes : int
        meshes that several nodes show.
    n_notes : int
        pictures in files beside the scene that could not move into the file; the log names them.
    """

    texcoord: int
    n_primitives: int
    n_vertices: int
    n_split_vertices: int
    n_replaced: int
    n_kept_textures: int
    n_misplaced_textures: int
    n_tangents: int
    n_without_tangents: int
    n_dropped_tangents: int
    n_unrolled: int
    n_shared_meshes: int
    n_notes: int
