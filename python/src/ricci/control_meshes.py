"""Splines over control meshes of Catmull-Clark surfaces."""

from __future__ import annotations

import numpy.typing as npt

from ricci import _arrays
from ricci._call import CONTROL
from ricci._library import lib
from ricci._signatures import picked, takes
from ricci._structs import Struct, options
from ricci.control import Progress
from ricci.quad_splines import _QUAD_SPLINE, QuadSpline, QuadSplineOptions

__all__ = ["fit_control_mesh"]


@takes(QuadSplineOptions)
def fit_control_mesh(
    positions: npt.ArrayLike,
    quads: npt.ArrayLike,
    progress: Progress = None,
    *,
    tolerance: float | None = None,
    bending: float | None = None,
    most_spans: int | None = None,
    threads: int | None = None,
) -> QuadSpline:
    """A spline near the Catmull-Clark surface of a control mesh of quadrilaterals.

    Patches lie between the lines of edges that go straight on from irregular vertices, with one span for each quadrilateral, up to 32:
    where no irregular vertex is near, the surface is such a spline.

    Parameters
    ----------
    positions : npt.ArrayLike
        n x 3 positions of the vertices.
    quads : npt.ArrayLike
        m x 4 vertex indices, counterclockwise seen from outside.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    ArgumentError
        positions or quads of another shape.
    SplineError
        a quadrilateral or a vertex that makes the mesh no surface, with its number.
    LayoutError
        quadrilaterals that lines do not divide into four-sided patches.

    Examples
    --------
    >>> corners = [[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
    >>> cube = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]]
    >>> ricci.fit_control_mesh(corners, cube, tolerance=0.01).summary.n_patches
    6
    """
    given = picked(locals(), QuadSplineOptions)
    points, corners = _arrays.real(positions, 3, "positions"), _arrays.indices(quads, 4, "quads")
    mesh = Struct("control_mesh")
    mesh.put("positions", points)
    mesh.put("n_vertices", len(points))
    mesh.put("quads", corners)
    mesh.put("n_quads", len(corners))
    struct = options("quad_spline_options", given, _QUAD_SPLINE)
    return QuadSpline._made(lib.ricci_quad_spline_fit_quads, mesh, struct, CONTROL, progress=progress)
