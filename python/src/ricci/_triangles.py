"""The common part of meshes and triangle lists: positions, faces, and the attributes of a file."""

from __future__ import annotations

from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from ricci._arrays import frozen
from ricci._call import Doubles, Handle, Indices, doubles, filled
from ricci._library import lib
from ricci.figures import MeshSummary, SoupSummary

__all__ = ["Triangles"]


class Triangles(Handle):
    """Triangles with attributes. Arrays are computed once and handed out read-only."""

    # The library's functions for the type.
    _faces_of: ClassVar[Any]
    _values_of: ClassVar[Any]

    @cached_property
    def summary(self) -> MeshSummary | SoupSummary:
        """Counts, and which attributes there are: each type has its own."""
        raise NotImplementedError

    @cached_property
    def V(self) -> Doubles:
        """n x 3 positions."""
        return self._values("POSITIONS", self.summary.n_vertices, 3)

    @cached_property
    def F(self) -> Indices:
        """m x 3 vertices of every face."""
        return frozen(filled(self._faces_of, self, out=np.empty((self.summary.n_faces, 3), np.uint32)))

    @cached_property
    def normals(self) -> Doubles | None:
        """n x 3 normals of the vertices that the file had, or None."""
        return self._values("NORMALS", self.summary.n_normals, 3) if self.summary.n_normals else None

    @cached_property
    def colors(self) -> Doubles | None:
        """n x 4 colours of the vertices that the file had (red, green, blue, opacity), or None."""
        return self._values("COLORS", self.summary.n_colors, 4) if self.summary.n_colors else None

    @cached_property
    def uv(self) -> Doubles | None:
        """m x 3 x 2 texture coordinates of the corners that the file had, or None."""
        return self._values("UV", self.summary.n_uv, 3, 2) if self.summary.n_uv else None

    @cached_property
    def corner_normals(self) -> Doubles | None:
        """m x 3 x 3 normals of the corners that the file had in place of those of the vertices, or None."""
        n = self.summary.n_corner_normals
        return self._values("CORNER_NORMALS", n, 3, 3) if n else None

    def _values(self, which: str, *shape: int) -> Any:
        return frozen(doubles(self._values_of, self, getattr(lib, f"RICCI_{which}"), shape=shape))
