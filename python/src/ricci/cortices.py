"""Cortical hemispheres: to the sphere, inflated, and flat without their medial wall."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._call import CONTROL, Booleans, Doubles, Indices, call, pointer
from ricci._library import lib
from ricci.adapters import MeshLike, as_mesh
from ricci.control import Progress, stages
from ricci.errors import ArgumentError
from ricci.flat_maps import FlatMap, flatten, flatten_sphere
from ricci.mesh import Mesh

__all__ = ["Brain", "brain", "flat_part", "inflate", "medial_wall"]

_MEDIAL = {"left": (1.0, 0.0, 0.0), "right": (-1.0, 0.0, 0.0)}


def inflate(V: MeshLike, F: npt.ArrayLike | None = None, progress: Progress = None, *, time: float = 0.002, steps: int = 10) -> Doubles:
    """The positions of a closed surface after its folds were smoothed away, n x 3: steps of the conformalized mean curvature flow.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`).
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    progress : Progress
        a `Control` or a callback.
    time : float
        a share of the surface's area: folds narrower than about its root times that of the area are gone.
    steps : int
        implicit steps.

    Raises
    ------
    ArgumentError
        a surface that is not closed; a time or a number of steps that is not positive.

    Examples
    --------
    >>> import numpy as np
    >>> ball = ricci.make("ellipsoid", n=4, a=1, b=1, c=2)
    >>> view = ricci.inflate(ball, time=0.1)
    >>> float(np.ptp(view[:, 2]) / np.ptp(view[:, 0])) < 2
    True
    """
    for name, value in (("time", time), ("steps", steps)):
        if not value > 0:
            raise ArgumentError(f"{name} is {value}: it must be above 0")
    mesh = as_mesh(V, F)
    positions = np.empty((mesh.n_vertices, 3))
    call(lib.ricci_inflate, mesh, time, steps, CONTROL, pointer(positions), positions.size, progress=progress)
    return positions


def medial_wall(
    V: MeshLike,
    F: npt.ArrayLike | None = None,
    *,
    view: npt.ArrayLike,
    hemisphere: Literal["left", "right"] = "left",
    share: float = 0.08,
) -> Booleans:
    """True for vertices of the medial wall of a hemisphere: those nearest to the one that the middle of its inflated view sees towards the
    other hemisphere, x growing from left to right.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`).
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    view : npt.ArrayLike
        the inflated positions, n x 3 (`inflate`).
    hemisphere : Literal["left", "right"]
        which hemisphere it is.
    share : float
        the wall's share of the surface's area.

    Raises
    ------
    ArgumentError
        a share that is not between 0 and 1; another hemisphere.

    Examples
    --------
    >>> ball = ricci.make("sphere", n=8)
    >>> wall = ricci.medial_wall(ball, view=ball.V, share=0.1)
    >>> bool((ball.V[wall, 0] > 0.5).all()), bool(0.05 < wall.mean() < 0.2)
    (True, True)
    """
    if hemisphere not in _MEDIAL:
        raise ArgumentError(f'hemisphere is "{hemisphere}": known are "left" and "right"')
    mesh = as_mesh(V, F)
    seen = _arrays.real(view, 3, "view")
    direction = np.array(_MEDIAL[hemisphere])
    is_wall = np.empty(mesh.n_vertices, np.uint32)
    call(lib.ricci_medial_wall, mesh, pointer(seen), len(seen), pointer(direction), share, pointer(is_wall), is_wall.size)
    return is_wall != 0


def flat_part(V: MeshLike, F: npt.ArrayLike | None = None, *, marked: npt.ArrayLike) -> Booleans:
    """True for those marked vertices that belong to the largest piece of the surface that is one with boundary.

    Pieces join faces with three marked vertices along edges; vertices at which a piece touches itself are left out.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`).
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    marked : npt.ArrayLike
        n flags.

    Raises
    ------
    ArgumentError
        no face has three marked vertices.

    Examples
    --------
    >>> import numpy as np
    >>> ball = ricci.make("sphere", n=4)
    >>> part = ricci.flat_part(ball, marked=ball.V[:, 2] < 0.5)
    >>> bool((ball.V[part, 2] < 0.5).all())
    True
    """
    mesh = as_mesh(V, F)
    given = np.ascontiguousarray(np.asarray(marked, dtype=bool), dtype=np.uint32)
    is_kept = np.empty(mesh.n_vertices, np.uint32)
    call(lib.ricci_flat_part, mesh, pointer(given), given.size, pointer(is_kept), is_kept.size)
    return is_kept != 0


@dataclass(frozen=True)
class Brain:
    """The maps of a cortical hemisphere.

    Attributes
    ----------
    sphere : Doubles
        the places on the sphere, n x 3.
    sphere_map : FlatMap
        the map to the unit sphere with its figures.
    inflated : Doubles
        the inflated view, n x 3.
    cortex : Booleans
        True for vertices of the cortex, n.
    vertices : Indices
        the numbers of these vertices, k.
    faces : Indices
        the faces of the cortex, m x 3, in the numbers of the whole surface.
    flat_map : FlatMap
        the flat map of the cortex: a point for each of `vertices`.

    Examples
    --------
    >>> ball = ricci.make("ellipsoid", n=6, a=1, b=1.5, c=1)
    >>> maps = ricci.brain(ball, wall=0.1)
    >>> maps.sphere.shape == maps.inflated.shape, maps.flat.shape == (maps.cortex.sum(), 2)
    (True, True)
    """

    sphere: Doubles
    sphere_map: FlatMap
    inflated: Doubles
    cortex: Booleans
    vertices: Indices
    faces: Indices
    flat_map: FlatMap

    @property
    def flat(self) -> Doubles:
        """The places of the cortex in the plane, a row for each of `vertices`."""
        return self.flat_map.points


def brain(
    V: MeshLike,
    F: npt.ArrayLike | None = None,
    progress: Progress = None,
    *,
    hemisphere: Literal["left", "right"] = "left",
    cortex: npt.ArrayLike | None = None,
    wall: float = 0.08,
    radius: float = 100.0,
    time: float = 0.002,
    energy: Literal["isometric", "area", "distance"] = "isometric",
    injective: bool = False,
) -> Brain:
    """The maps of a cortical hemisphere, white or pial: to a sphere, inflated, and flat without its medial wall.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`): a closed surface of genus 0.
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    progress : Progress
        a `Control` or a callback.
    hemisphere : Literal["left", "right"]
        which hemisphere it is, where the medial wall is to be found.
    cortex : npt.ArrayLike | None
        n flags of the vertices without the medial wall; None: found by `medial_wall`.
    wall : float
        the share of the surface's area of a wall that is found.
    radius : float
        radius of the sphere.
    time : float
        time of the flow that inflates (`inflate`).
    energy : Literal["isometric", "area", "distance"]
        what the flat map keeps (`flatten`).
    injective : bool
        True if no part of the flat map is to lie on another one.

    Raises
    ------
    ArgumentError
        a surface that is no sphere.
    LayoutError
        a cortex that is no surface of genus 0 with boundary.

    Examples
    --------
    >>> import numpy as np
    >>> ball = ricci.make("ellipsoid", n=6, a=1, b=1.5, c=1)
    >>> maps = ricci.brain(ball, wall=0.1)
    >>> maps.sphere_map.converged, maps.flat_map.converged
    (True, True)
    """
    mesh = as_mesh(V, F)
    parts = stages(progress, [0.6, 0.7, 1.0])
    round_map = flatten_sphere(mesh, progress=next(parts))
    inflated = inflate(mesh, progress=next(parts), time=time)
    part = ~medial_wall(mesh, view=inflated, hemisphere=hemisphere, share=wall) if cortex is None else flat_part(mesh, marked=cortex)
    faces = np.asarray(mesh.F)
    faces = faces[part[faces].all(axis=1)]
    vertices = np.flatnonzero(part).astype(np.int32)
    number = np.cumsum(part) - 1
    cut = Mesh(np.asarray(mesh.V)[part], number[faces].astype(np.int32))
    flat_map = flatten(cut, progress=next(parts), energy=energy, injective=injective)
    parts.close()
    return Brain(radius * round_map.points, round_map, inflated, part, vertices, faces, flat_map)
