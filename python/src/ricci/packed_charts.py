"""Charts of a layout, packed into the unit square."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from ricci._arrays import frozen
from ricci._call import CONTROL, Doubles, Indices, call, doubles, filled, path_bytes, summary
from ricci._kept import Kept
from ricci._library import lib
from ricci._shown import Scene
from ricci.control import Progress
from ricci.figures import ChartsSummary
from ricci.layouts import Layout, cut_open

__all__ = ["Charts", "charts"]


class Charts(Kept):
    """A layout in charts that do not overlap, packed into the unit square.

    Parameters
    ----------
    layout : Layout
        the layout.
    margin : float
        least distance of two charts, in sides of the unit square.
    progress : Progress
        a `Control` or a callback.

    Examples
    --------
    >>> laid = ricci.layout(ricci.flow(ricci.make("disk", n=4)))
    >>> ricci.charts(laid).summary.n_charts
    1
    """

    _type: ClassVar[str] = "charts"
    _made_by: ClassVar[str] = "ricci.charts(layout)"
    _figures: ClassVar[tuple[str, ...]] = ("n_charts", "n_faces", "n_flipped", "efficiency", "layout_seams", "chart_seams")

    def __init__(self, layout: Layout, margin: float = 1 / 256, progress: Progress = None) -> None:
        self._pointer = Charts._made(lib.ricci_charts_new, layout, margin, CONTROL, progress=progress)._pointer
        self._layout = layout

    def _come_from(self, found: Mapping[str, Any]) -> None:
        self._layout = found["layout"]

    def _cut_open(self) -> tuple[Doubles, Indices, Doubles, Indices]:
        return cut_open(self._layout.mesh, self.corners, self.points)

    def _scene(self) -> Scene | None:
        return Scene(self.points, self.corners, self.charts * 0.6180339887498949 % 1)

    @cached_property
    def summary(self) -> ChartsSummary:
        """Counts, scale, and the share of the square that is covered."""
        return summary(ChartsSummary, "charts", self)

    @cached_property
    def charts(self) -> Indices:
        """The chart of every face of the layout's mesh; charts with more area come first."""
        return frozen(filled(lib.ricci_charts_faces, self, out=np.empty(self.summary.n_faces, np.uint32)))

    @cached_property
    def points(self) -> Doubles:
        """n_points x 2, from 0 to 1."""
        return frozen(doubles(lib.ricci_charts_points, self, shape=(self.summary.n_points, 2)))

    @cached_property
    def corners(self) -> Indices:
        """The point of every corner of every face, n_faces x 3."""
        return frozen(filled(lib.ricci_charts_corners, self, out=np.empty((self.summary.n_faces, 3), np.uint32)))

    @cached_property
    def motions(self) -> Doubles:
        """n_charts x 3: rotation (radians) and translation that carry the layout's points, times `summary.scale`, to the chart's."""
        return frozen(doubles(lib.ricci_charts_motions, self, shape=(self.summary.n_charts, 3)))

    def write(self, path: str | os.PathLike[str], *, homogeneous: bool = False) -> None:
        """Write the layout's mesh with its charts as texture coordinates, as `Layout.write` does."""
        call(lib.ricci_charts_write, self, int(homogeneous), path_bytes(path))


def charts(layout: Layout, margin: float = 1 / 256, progress: Progress = None) -> Charts:
    """Cut a layout into charts that do not overlap, and pack them into the unit square.

    Parameters
    ----------
    layout : Layout
        the layout.
    margin : float
        least distance of two charts, in sides of the unit square.
    progress : Progress
        a `Control` or a callback.

    Examples
    --------
    >>> laid = ricci.layout(ricci.flow(ricci.make("genus", genus=2, n=3), target="auto:4"))
    >>> packed = ricci.charts(laid)
    >>> bool(packed.points.min() >= 0), bool(packed.points.max() <= 1)
    (True, True)
    """
    return Charts(layout, margin, progress)
