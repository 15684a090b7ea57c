"""Texture atlases of whole models, on their own faces."""

from __future__ import annotations

import os
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, TypeAlias, TypedDict

import numpy as np
import numpy.typing as npt

from ricci._arrays import frozen
from ricci._call import CONTROL, Doubles, Handle, Indices, call, doubles, filled, path_bytes, pointer, summary
from ricci._library import lib
from ricci._shown import Scene
from ricci._signatures import picked, takes
from ricci._structs import Write, above_zero, options, or_none
from ricci.adapters import from_arrays_of
from ricci.control import Progress
from ricci.figures import TextureAtlasSummary
from ricci.mesh import Mesh
from ricci.scenes import SceneFile
from ricci.soup import Soup

__all__ = ["SplitModel", "TextureAtlas", "TextureOptions", "texture_atlas"]

# A Soup, a Mesh, a SceneFile, a file's name, a pair of arrays (V, F), or a mesh of trimesh, meshio, PyVista or nibabel.
ModelLike: TypeAlias = Any


class TextureOptions(TypedDict, total=False):
    """Options of texture atlases.

    Attributes
    ----------
    stretch : float
        the bound, above 1, of the stretch of all but a hundredth of the area; 1.3. A smaller one makes longer seams.
    fill : float
        the share of the page that charts are divided to fill; 0.68. 0 divides none.
    page : int
        texels along a side of the page, a power of two; 1024.
    margin : int
        least distance of two charts in texels; 2. Mipmaps need more.
    density : float
        texels for a unit of length on the model, and as many pages as that takes, up to 160; by default one page, filled as far as it goes.
    threads : int
        one for each core.
    """

    stretch: float
    fill: float
    page: int
    margin: int
    density: float
    threads: int


_TEXTURE: dict[str, Write] = {
    **dict.fromkeys(("stretch", "page", "density", "threads"), above_zero),
    **dict.fromkeys(("fill", "margin"), or_none),
}


class SplitModel(NamedTuple):
    """A model with one pair of texture coordinates for each vertex. Faces without a place are left out.

    Examples
    --------
    >>> disk = ricci.make("disk", n=3)
    >>> split = ricci.texture_atlas(disk, page=64).split()
    >>> split.uv.shape == (disk.n_vertices, 2)
    True
    """

    #: m x 3 vertices of every face with a place.
    F: Indices
    #: For each of these faces its number in the model.
    faces: Indices
    #: For each vertex the model's vertex that it is a copy of: `V[vertices]` are their positions.
    vertices: Indices
    #: n x 2 texture coordinates.
    uv: Doubles


class TextureAtlas(Handle):
    """A model with texture coordinates on its own faces: `texture_atlas` makes one.

    Examples
    --------
    >>> torus = ricci.make("torus", n=10)
    >>> atlas = ricci.texture_atlas(torus, page=64)
    >>> atlas.uv.shape == (torus.n_faces, 3, 2)
    True
    >>> split = atlas.split()
    >>> len(split.uv) > torus.n_vertices
    True
    """

    _type: ClassVar[str] = "texture_atlas"
    _made_by: ClassVar[str] = "ricci.texture_atlas(model)"
    _figures: ClassVar[tuple[str, ...]] = ("n_charts", "fill", "seam_length", "stretch_99", "n_faces", "page")

    def _scene(self) -> Scene | None:
        split = self.split()
        return Scene(split.uv, split.F, self.charts[split.faces] * 0.6180339887498949 % 1)

    @cached_property
    def summary(self) -> TextureAtlasSummary:
        """Counts, stretch, seams, and the share of the page that is filled."""
        return summary(TextureAtlasSummary, "texture_atlas", self)

    @cached_property
    def uv(self) -> Doubles:
        """m x 3 x 2 texture coordinates of the corners of the model's faces; 0 for faces without a place.

        They are from 0 to 1; of several pages they are in the tiles of UDIM, page p with u from p % 10 and v from p // 10.
        """
        return frozen(doubles(lib.ricci_texture_atlas_uv, self, shape=(self.summary.n_faces, 3, 2)))

    @cached_property
    def charts(self) -> Indices:
        """The chart of every face of the model, -1 without a place; charts with more area come first."""
        return frozen(filled(lib.ricci_texture_atlas_charts, self, out=np.empty(self.summary.n_faces, np.uint32)))

    @cached_property
    def pages(self) -> Indices:
        """The page of every face of the model; 0 without a place."""
        return frozen(filled(lib.ricci_texture_atlas_pages, self, out=np.empty(self.summary.n_faces, np.uint32)))

    @cached_property
    def placeless(self) -> Indices:
        """The faces without a place: a corner is missing or not finite, two corners are in one place, or they are too thin for the page."""
        return self._list(lib.RICCI_TEXTURE_PLACELESS, self.summary.n_placeless)

    @cached_property
    def folded(self) -> Indices:
        """The faces that are turned over or without area on the page, by exact arithmetic: none."""
        return self._list(lib.RICCI_TEXTURE_FOLDED, self.summary.n_folded)

    @cached_property
    def overlapping(self) -> Indices:
        """The faces that meet the interior of an earlier face on the page, by exact arithmetic: none."""
        return self._list(lib.RICCI_TEXTURE_OVERLAPPING, self.summary.n_overlapping)

    @cached_property
    def turned(self) -> Indices:
        """The faces that run against most faces around them, as their image does: clockwise."""
        return self._list(lib.RICCI_TEXTURE_TURNED, self.summary.n_turned)

    def split(self) -> SplitModel:
        """The model with its vertices split along the seams, as renderers take it."""
        s = self.summary
        corners, faces, vertices = (np.empty(n, np.uint32) for n in ((s.n_split_faces, 3), s.n_split_faces, s.n_split_vertices))
        uv = np.empty((s.n_split_vertices, 2))
        lists = [argument for array in (corners, faces, vertices) for argument in (pointer(array), array.size)]
        filled(lib.ricci_texture_atlas_split, self, *lists, out=uv)
        return SplitModel(frozen(corners), frozen(faces), frozen(vertices), frozen(uv))

    def soup(self) -> Soup:
        """The model with these texture coordinates in place of its own; its other attributes are as they were."""
        return Soup._made(lib.ricci_texture_atlas_soup, self)

    def write(self, path: str | os.PathLike[str], progress: Progress = None, *, tangents: bool = False) -> None:
        """Write the model with these texture coordinates: .obj, .ply and .glb have seams.

        Parameters
        ----------
        path : str | os.PathLike[str]
            the file's name.
        progress : Progress
            a `Control` or a callback.
        tangents : bool
            True to write .glb with tangents; vertices without normals get averages of those of their faces.
        """
        if tangents:
            call(lib.ricci_soup_write_with_tangents, self.soup(), path_bytes(path), progress=progress)
        else:
            self.soup().write(path, progress)

    def _list(self, which: int, n: int) -> Indices:
        return frozen(filled(lib.ricci_texture_atlas_faces, self, which, out=np.empty(n, np.uint32)))


def _soup_of(model: ModelLike, F: npt.ArrayLike | None) -> Soup:
    """The triangle list that a model stands for."""
    if F is not None:
        return Soup(model, F)
    if isinstance(model, Soup):
        return model
    if isinstance(model, Mesh):
        return Soup(model.V, model.F)
    return Soup.read(model) if isinstance(model, str | os.PathLike) else Soup(*from_arrays_of(model))


@takes(TextureOptions)
def texture_atlas(
    V: ModelLike,
    F: npt.ArrayLike | None = None,
    progress: Progress = None,
    *,
    stretch: float | None = None,
    fill: float | None = None,
    page: int | None = None,
    margin: int | None = None,
    density: float | None = None,
    threads: int | None = None,
) -> TextureAtlas:
    """A texture atlas of a model, whatever its defects: every face keeps its number and gets a place on a square page.

    The model is opened where it is no surface; seams run along its edges, and no face is turned over or meets another one on the page.

    Parameters
    ----------
    V : ModelLike
        n x 3 positions with `F`; without, a `Soup`, whose other attributes `TextureAtlas.write` keeps, a `Mesh`, a file's name, a pair
        (V, F), another library's mesh, or a `SceneFile`, which `SceneFile.write` writes with its nodes and materials.
    F : npt.ArrayLike | None
        m x 3 vertex indices; nothing is asked of them.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    ArgumentError
        an option outside its range.
    LayoutError
        no face of the model has a place, the page has no room, a face is larger than a page, or more than 160 pages are needed.

    Examples
    --------
    >>> model = ricci.Soup([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1]], [[0, 1, 2], [1, 0, 3], [0, 1, 4]])
    >>> atlas = ricci.texture_atlas(model, page=64)
    >>> atlas.charts.tolist(), atlas.summary.n_opened_edges
    ([0, 0, 1], 1)
    """
    given = options("texture_options", picked(locals(), TextureOptions), _TEXTURE)
    if isinstance(V, SceneFile):
        return TextureAtlas._made(lib.ricci_scene_texture_atlas, V, given, CONTROL, progress=progress)
    return TextureAtlas._made(lib.ricci_texture_atlas_new, _soup_of(V, F), given, CONTROL, progress=progress)
