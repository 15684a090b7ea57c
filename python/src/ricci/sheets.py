"""Sheets that are cut by flat maps: their strain, and darts that keep it within the limits of a material."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, TypedDict

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._call import CONTROL, Doubles, Indices, call, figures_of, pointer
from ricci._library import ffi, lib
from ricci._signatures import picked, takes
from ricci._structs import Write, above_zero, number, options
from ricci.adapters import MeshLike, as_mesh
from ricci.control import Progress, stages
from ricci.figures import DartSummary
from ricci.flat_maps import FlatMap, flatten
from ricci.mesh import Mesh

__all__ = ["DartOptions", "Darted", "Strains", "flatten_darts", "strains"]


class DartOptions(TypedDict, total=False):
    """The limits of a sheet, and of the darts that keep it within them.

    Attributes
    ----------
    strain_warp : float
        largest size of the strain along the warp, from the plane to the surface; no limit.
    strain_weft : float
        the same along the weft, at a right angle to the warp in the plane; no limit.
    shear : float
        largest size of the shear, radians between warp and weft; no limit.
    warp : float
        direction of the warp in the plane, radians from the x axis; 0.
    budget : float
        most length of all darts together; no limit.
    most : int
        most darts; 8.
    """

    strain_warp: float
    strain_weft: float
    shear: float
    warp: float
    budget: float
    most: int


_DARTS: dict[str, Write] = {
    "strain_warp": above_zero,
    "strain_weft": above_zero,
    "shear": above_zero,
    "warp": number,
    "budget": above_zero,
    "most": above_zero,
}


class Strains(NamedTuple):
    """The strain of each triangle of a sheet that is cut by a flat map and takes the shape of the surface.

    Attributes
    ----------
    warp : Doubles
        length on the surface over length in the plane along the warp, less 1.
    weft : Doubles
        the same along the weft.
    shear : Doubles
        radians by which the angle between them becomes less than a right one.

    Examples
    --------
    >>> import numpy as np
    >>> disk = ricci.make("disk", n=3)
    >>> sheet = ricci.strains(disk, points=0.5 * disk.V[:, :2])
    >>> np.allclose(sheet.warp, 1), np.allclose(sheet.shear, 0)
    (True, True)
    """

    warp: Doubles
    weft: Doubles
    shear: Doubles


def strains(V: MeshLike, F: npt.ArrayLike | None = None, *, points: npt.ArrayLike, warp: float = 0.0) -> Strains:
    """The strain of a sheet that is cut by a flat map, triangle by triangle.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`).
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    points : npt.ArrayLike
        the flat map, n x 2 (`flatten`).
    warp : float
        direction of the warp in the plane, radians from the x axis.

    Raises
    ------
    ArgumentError
        another number of points than of vertices.
    LayoutError
        a triangle without area.

    Examples
    --------
    >>> import numpy as np
    >>> disk = ricci.make("disk", n=3)
    >>> np.allclose(ricci.strains(disk, points=disk.V[:, :2]).weft, 0)
    True
    """
    mesh = as_mesh(V, F)
    given = _arrays.real(points, 2, "points")
    values = np.empty((mesh.n_faces, 3))
    call(lib.ricci_flatten_strains, mesh, pointer(given), len(given), warp, pointer(values), values.size)
    return Strains(*(np.ascontiguousarray(column) for column in values.T))


@dataclass(frozen=True)
class Darted:
    """A surface that darts have opened, laid flat.

    Attributes
    ----------
    mesh : Mesh
        the surface with the vertices of darts doubled; faces in the order of the given ones.
    origins : Indices
        per vertex of it the given one.
    flat : FlatMap
        its flat map.
    summary : DartSummary
        the number of darts, their length, what triangles take of the limits.

    Examples
    --------
    >>> import numpy as np
    >>> disk = ricci.make("disk", n=6)
    >>> cone = np.column_stack([disk.V[:, :2], np.hypot(disk.V[:, 0], disk.V[:, 1])])
    >>> sheet = ricci.flatten_darts(cone, disk.F, strain_warp=0.05, strain_weft=0.05)
    >>> sheet.summary.n_darts, sheet.summary.after < 1 < sheet.summary.before
    (1, True)
    """

    mesh: Mesh
    origins: Indices
    flat: FlatMap
    summary: DartSummary


@takes(DartOptions)
def flatten_darts(
    V: MeshLike,
    F: npt.ArrayLike | None = None,
    progress: Progress = None,
    *,
    strain_warp: float | None = None,
    strain_weft: float | None = None,
    shear: float | None = None,
    warp: float | None = None,
    budget: float | None = None,
    most: int | None = None,
) -> Darted:
    """A flat map with darts, which open from the border inwards until a sheet is strained no more than its limits.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`): an open surface of genus 0.
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    ArgumentError
        limits that are not positive.
    LayoutError
        a closed surface, one of higher genus, a triangle without area.

    Examples
    --------
    >>> import numpy as np
    >>> disk = ricci.make("disk", n=6)
    >>> dome = np.column_stack([disk.V[:, :2], -0.8 * (disk.V[:, :2] ** 2).sum(axis=1)])
    >>> sheet = ricci.flatten_darts(dome, disk.F, strain_warp=0.05, strain_weft=0.05, most=2)
    >>> sheet.summary.after < sheet.summary.before
    True
    """
    given = picked(locals(), DartOptions)
    mesh = as_mesh(V, F)
    struct = options("dart_options", given, _DARTS)
    out = ffi.new("ricci_dart_summary *")
    origins = np.empty(2 * mesh.n_vertices, np.uint32)
    places = (pointer(origins), origins.size, out, ffi.sizeof("ricci_dart_summary"))
    parts = stages(progress, [0.8, 1.0])
    opened = Mesh._made(lib.ricci_flatten_darts, mesh, ffi.NULL, struct, CONTROL, *places, progress=next(parts))
    told = figures_of(DartSummary, out)
    flat = flatten(opened, progress=next(parts))
    parts.close()
    return Darted(opened, origins[: told.n_vertices].astype(np.int32), flat, told)
