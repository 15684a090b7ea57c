"""The domains of splines: triangles inside polygons, and flat metrics of surfaces."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._call import CONTROL, filled, pointer
from ricci._library import lib
from ricci.adapters import as_mesh
from ricci.control import Progress, stages
from ricci.errors import ArgumentError
from ricci.mesh import Mesh
from ricci.metrics import Metric

__all__ = ["flat_metric", "spline_domain"]


def spline_domain(polygons: Sequence[npt.ArrayLike], edge: float) -> Mesh:
    """Triangles inside polygons, as the domain of a spline: a mesh in the plane z = 0.

    Parameters
    ----------
    polygons : Sequence[npt.ArrayLike]
        the corners of each, k x 2; the inside is what an odd number of them winds around.
    edge : float
        triangles are about as large as equilateral ones with this edge.

    Raises
    ------
    SplineError
        a polygon that crosses itself or another one.

    Examples
    --------
    >>> ricci.spline_domain([[[0, 0], [1, 0], [1, 1], [0, 1]]], edge=0.5).euler
    1
    """
    parts = [_arrays.real(part, 2, "polygons") for part in polygons]
    corners = np.concatenate(parts)
    starts = np.concatenate([[0], np.cumsum([len(part) for part in parts])]).astype(np.uintp)
    return Mesh._made(lib.ricci_spline_domain, pointer(corners), pointer(starts), len(parts), edge)


def flat_metric(mesh: Mesh, singular: int | str | npt.ArrayLike = "auto", range: float = 30.0, progress: Progress = None) -> Metric:
    """The flat metric of a surface on which a spline lives: its curvature is at singular vertices inside, and at corners of the boundary.

    Parameters
    ----------
    mesh : Mesh
        a surface.
    singular : int | str | npt.ArrayLike
        "auto" for as few as keep lengths within a factor `range` of each other; their number; or the vertices.
    range : float
        that factor, above 1.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    ArgumentError
        a sphere with fewer than three singular vertices, or too few vertices for three (500 each).

    Examples
    --------
    >>> flat = ricci.flat_metric(ricci.make("torus", n=16))
    >>> bool(abs(flat.curvature).max() < 1e-9)
    True
    """
    mesh = as_mesh(mesh)
    vertices = None if isinstance(singular, (int, str)) else np.ascontiguousarray(singular, dtype=np.uint32)
    if isinstance(singular, str) and singular != "auto":
        raise ArgumentError(f'singular is {singular!r}: "auto", a number or vertices')
    # The largest size_t stands for as few as are needed.
    number = 2**64 - 1
    if vertices is not None:
        number = len(vertices)
    elif isinstance(singular, int):
        number = singular
    curvatures = np.empty(mesh.n_vertices)
    parts = stages(progress, [0.5, 1.0])
    filled(lib.ricci_spline_curvatures, mesh, pointer(vertices), number, float(range), CONTROL, out=curvatures, progress=next(parts))
    return Metric(mesh).flow(curvatures, next(parts))
