"""Scenes of glTF that stay scenes: read, and written again with a texture atlas."""

from __future__ import annotations

import os
from functools import cached_property
from typing import ClassVar, Self, TypedDict

from ricci._call import Handle, call, figures_of, path_bytes, summary
from ricci._library import ffi, lib
from ricci._signatures import picked, takes
from ricci._structs import Write, number, options, or_none
from ricci.control import Progress
from ricci.figures import SceneReport, SceneSummary

__all__ = ["SceneFile", "SceneOptions"]


class SceneOptions(TypedDict, total=False):
    """Options of scenes that are written with an atlas.

    Attributes
    ----------
    texcoord : int
        the set of texture coordinates that the atlas becomes, from 0 to 7; by default 0 if no texture uses it, else the next free one.
    tangents : bool
        write tangents of the atlas where there are normals.
    """

    texcoord: int
    tangents: bool


_SCENE: dict[str, Write] = {"texcoord": or_none, "tangents": number}


class SceneFile(Handle):
    """A glTF file with everything that is in it: nodes, cameras, materials, animations, skins, names.

    A mesh counts once, however many nodes show it, in the size of the node that enlarges it most.

    Examples
    --------
    >>> ricci.make("disk", n=3).write("scene.glb")
    >>> scene = ricci.SceneFile.read("scene.glb")
    >>> atlas = ricci.texture_atlas(scene, page=64)
    >>> report = scene.write("out.glb", atlas)
    >>> report.texcoord, report.n_primitives
    (0, 1)
    """

    _type: ClassVar[str] = "scene"
    _made_by: ClassVar[str] = "ricci.SceneFile.read(path)"
    _figures: ClassVar[tuple[str, ...]] = ("n_nodes", "n_meshes", "n_primitives", "n_materials", "n_vertices", "n_faces")

    @classmethod
    def read(cls, path: str | os.PathLike[str], progress: Progress = None) -> Self:
        """The scene of a .glb or .gltf file, which may be packed by gzip."""
        return cls._made(lib.ricci_scene_read, path_bytes(path), progress=progress)

    @cached_property
    def summary(self) -> SceneSummary:
        """Counts of nodes, meshes, primitives, materials, vertices and faces."""
        return summary(SceneSummary, "scene", self)

    @takes(SceneOptions)
    def write(
        self,
        path: str | os.PathLike[str],
        atlas: Handle,
        progress: Progress = None,
        *,
        texcoord: int | None = None,
        tangents: bool = False,
    ) -> SceneReport:
        """Write the scene with its atlas as .glb; nodes, materials and names are as they were.

        Vertices keep their numbers; those along seams are repeated behind all others, with all their attributes and morph targets. All
        buffers become one, and pictures beside the file move into it.

        Parameters
        ----------
        path : str | os.PathLike[str]
            the file's name.
        atlas : TextureAtlas
            the atlas of `texture_atlas(scene)`.
        progress : Progress
            a `Control` or a callback.

        Raises
        ------
        ArgumentError
            an atlas of another number of faces, or a set above 7.
        """
        given = options("scene_options", picked(locals(), SceneOptions), _SCENE)
        report = ffi.new("ricci_scene_report *")
        call(lib.ricci_scene_write, self, atlas, given, path_bytes(path), report, ffi.sizeof("ricci_scene_report"), progress=progress)
        return figures_of(SceneReport, report)
