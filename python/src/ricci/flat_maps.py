"""Flat maps of least stretch, and maps to the sphere."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, TypedDict

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._call import CONTROL, Doubles, call, figures_of, pointer
from ricci._library import ffi, lib
from ricci._signatures import picked, takes
from ricci._structs import Write, above_zero, choice, number, options, real_list
from ricci.adapters import MeshLike, as_mesh
from ricci.control import Progress
from ricci.errors import warn
from ricci.figures import FlattenSummary
from ricci.layouts import Layout
from ricci.seams import Seamless

__all__ = [
    "Distortion",
    "FlatMap",
    "FlattenOptions",
    "SeamlessFlatMap",
    "SeamlessFlatOptions",
    "SphereFlatOptions",
    "flatten",
    "flatten_seamless",
    "flatten_sphere",
]


class FlattenOptions(TypedDict, total=False):
    """What a flat map keeps, and where the descent to it ends. s and t are the stretches of a triangle along two perpendicular directions.

    Attributes
    ----------
    energy : Literal["isometric", "arap", "area", "distance"]
        lengths (s² + t² + 1/s² + 1/t²), lengths as rigidly as possible ((s - 1)² + (t - 1)²), areas (2 (s t + 1/(s t))), or lengths d of
        shortest paths between near vertices ((length in the plane / d - 1)², and 0.01 times the first).
    conformal : float
        share of the conformal energy 2 (s/t + t/s), from 0 to 1; none, but 0.1 for ``"area"``, where 0 is that too.
    tolerance : float
        Newton decrement of a converged map, about the root of twice the energy that is still to be lost; 1e-8.
    max_iterations : int
        most Newton steps; 2000.
    injective : bool
        True if no part of the map is to lie on another one; False.
    weights : npt.ArrayLike
        per face a factor above 0 of its part in the energy; 1.
    pins : Mapping[int, npt.ArrayLike]
        places of vertices in the plane, where they are to the last bit.
    straight : Sequence[npt.ArrayLike]
        runs of three or more vertices, such as parts of the border, each of which becomes straight.
    rings : int
        for ``"distance"``: most edges between two vertices whose distance is kept; 2.
    """

    energy: Literal["isometric", "arap", "area", "distance"]
    conformal: float
    tolerance: float
    max_iterations: int
    injective: bool
    weights: npt.ArrayLike
    pins: Mapping[int, npt.ArrayLike]
    straight: Sequence[npt.ArrayLike]
    rings: int


def _pins(struct: Any, field: str, value: Any) -> None:
    struct.put(field, _arrays.indices(list(value.keys()), None, field))
    struct.put("places", _arrays.real([*value.values()], 2, field))
    struct.put("n_pins", len(value))


def _straight(struct: Any, field: str, value: Any) -> None:
    runs = [_arrays.indices(run, None, field) for run in value]
    struct.put(field, np.concatenate(runs))
    struct.put("straight_sizes", np.array([run.size for run in runs], np.uint32))
    struct.put("n_straight", len(runs))


_FLATTEN: dict[str, Write] = {
    "energy": choice("FLATTEN", ("isometric", "arap", "area", "distance")),
    "conformal": number,
    "tolerance": above_zero,
    "max_iterations": above_zero,
    "injective": number,
    "weights": real_list(count="n_weights"),
    "pins": _pins,
    "straight": _straight,
    "rings": above_zero,
}


class Distortion(NamedTuple):
    """How much a flat map changes lengths, areas and angles. Means of triangles are weighted by their area on the surface.

    Attributes
    ----------
    energy : float
        mean of s² + t² + 1/s² + 1/t² of the stretches s, t of a triangle along two perpendicular directions: at least 4.
    least_stretch : float
        least stretch of a triangle along a direction.
    most_stretch : float
        largest stretch of a triangle along a direction.
    mean_length_error : float
        mean over the edges of |length in the plane / length - 1|.
    max_length_error : float
        largest of these.
    mean_area_error : float
        mean of |area in the plane / area - 1|.
    max_area_error : float
        largest of these.
    mean_dilatation : float
        mean dilatation s/t.
    max_dilatation : float
        largest dilatation.
    area : float
        area in the plane over that of the surface.

    Examples
    --------
    >>> flat = ricci.flatten(ricci.make("disk", n=4))
    >>> abs(flat.after.energy - 4) < 1e-12, abs(flat.after.max_dilatation - 1) < 1e-9
    (True, True)
    """

    energy: float
    least_stretch: float
    most_stretch: float
    mean_length_error: float
    max_length_error: float
    mean_area_error: float
    max_area_error: float
    mean_dilatation: float
    max_dilatation: float
    area: float


@dataclass(frozen=True)
class FlatMap:
    """A map to the plane that turns no triangle over, with its figures.

    Attributes
    ----------
    points : Doubles
        the places of the vertices, n x 2, in the unit of the surface's lengths; on the unit sphere n x 3.
    energies : Doubles
        the energy that is least: at the start and after each step.
    summary : FlattenSummary
        how the descent began and ended.

    Examples
    --------
    >>> flat = ricci.flatten(ricci.make("disk", n=4))
    >>> flat.points.shape, flat.converged
    ((61, 2), True)
    >>> flat.after.max_length_error < 1e-12
    True
    """

    points: Doubles
    energies: Doubles
    summary: FlattenSummary

    @property
    def converged(self) -> bool:
        """True if the map is as good as the tolerance asks, or as doubles hold."""
        return self.summary.stop in ("converged", "rounding")

    @property
    def before(self) -> Distortion:
        """The change of lengths and areas at the start of the descent."""
        return Distortion(*self.summary.before)

    @property
    def after(self) -> Distortion:
        """The change of lengths and areas by this map."""
        return Distortion(*self.summary.after)


@takes(FlattenOptions)
def flatten(
    V: MeshLike,
    F: npt.ArrayLike | None = None,
    progress: Progress = None,
    *,
    energy: Literal["isometric", "arap", "area", "distance"] = "isometric",
    conformal: float | None = None,
    tolerance: float | None = None,
    max_iterations: int | None = None,
    injective: bool = False,
    weights: npt.ArrayLike | None = None,
    pins: Mapping[int, npt.ArrayLike] | None = None,
    straight: Sequence[npt.ArrayLike] | None = None,
    rings: int | None = None,
) -> FlatMap:
    """The map to the plane of least distortion of an open surface of genus 0, no triangle turned over, its boundary free but for `pins` and
    `straight` runs.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`).
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    progress : Progress
        a `Control` or a callback.

    Warns
    -----
    ConvergenceWarning
        the descent ended before the tolerance was reached; the best map found is returned.

    Raises
    ------
    LayoutError
        a closed surface, one of higher genus, a triangle without area.

    Examples
    --------
    >>> import numpy as np
    >>> disk = ricci.make("disk", n=8)
    >>> bowl = np.column_stack([disk.V[:, :2], 0.3 * (disk.V[:, :2] ** 2).sum(axis=1)])
    >>> flat = ricci.flatten(bowl, disk.F)
    >>> flat.after.energy < flat.before.energy
    True
    """
    return _found(lib.ricci_flatten, 2, as_mesh(V, F), {**picked(locals(), FlattenOptions)}, progress)


class SphereFlatOptions(TypedDict, total=False):
    """What a map to the sphere keeps, and where the descent to it ends.

    Attributes
    ----------
    energy : Literal["isometric", "area"]
        lengths, so that areas and shapes are distorted alike, or areas (2 (s t + 1/(s t))).
    conformal : float
        share of the conformal energy 2 (s/t + t/s), from 0 to 1; none, but 0.1 for ``"area"``, where 0 is that too.
    tolerance : float
        Newton decrement of a converged map; 1e-8.
    max_iterations : int
        most Newton steps; 2000.
    weights : npt.ArrayLike
        per face a factor above 0 of its part in the energy; 1.
    """

    energy: Literal["isometric", "area"]
    conformal: float
    tolerance: float
    max_iterations: int
    weights: npt.ArrayLike


@takes(SphereFlatOptions)
def flatten_sphere(
    V: MeshLike,
    F: npt.ArrayLike | None = None,
    progress: Progress = None,
    *,
    energy: Literal["isometric", "area"] = "isometric",
    conformal: float | None = None,
    tolerance: float | None = None,
    max_iterations: int | None = None,
    weights: npt.ArrayLike | None = None,
) -> FlatMap:
    """The map to the unit sphere of least distortion of a closed surface of genus 0, no triangle turned over.

    Stretches are those to a sphere with the area of the surface. `points` are n x 3; the sphere is turned as the surface is in space.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`).
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    progress : Progress
        a `Control` or a callback.

    Warns
    -----
    ConvergenceWarning
        the descent ended before the tolerance was reached; the best map found is returned.

    Raises
    ------
    ArgumentError
        a surface that is no sphere.
    LayoutError
        a triangle without area; triangles of the conformal map that stay turned over.

    Examples
    --------
    >>> ball = ricci.make("ellipsoid", n=4, a=1, b=1, c=2)
    >>> round = ricci.flatten_sphere(ball)
    >>> round.converged, round.after.energy < round.before.energy
    (True, True)
    """
    return _found(lib.ricci_flatten_sphere, 3, as_mesh(V, F), {**picked(locals(), SphereFlatOptions)}, progress)


class SeamlessFlatOptions(TypedDict, total=False):
    """What a map with seams keeps, and where the descent to it ends.

    Attributes
    ----------
    energy : Literal["isometric", "arap", "area"]
        lengths (s² + t² + 1/s² + 1/t²), lengths as rigidly as possible, or areas (2 (s t + 1/(s t))).
    conformal : float
        share of the conformal energy 2 (s/t + t/s), from 0 to 1; none, but 0.1 for ``"area"``, where 0 is that too.
    tolerance : float
        Newton decrement of a converged map; 1e-8.
    max_iterations : int
        most Newton steps; 2000.
    weights : npt.ArrayLike
        per face of the surface a factor above 0 of its part in the energy; 1.
    """

    energy: Literal["isometric", "arap", "area"]
    conformal: float
    tolerance: float
    max_iterations: int
    weights: npt.ArrayLike


@dataclass(frozen=True)
class SeamlessFlatMap:
    """A map to the plane whose seams are rotations by multiples of 90 degrees, with its figures.

    Attributes
    ----------
    layout : Layout
        the map. Its mesh is the surface, some of whose edges can be split; the first vertices are the surface's.
    energies : Doubles
        the energy that is least: at the start and after each step.
    summary : FlattenSummary
        how the descent began and ended.

    Examples
    --------
    >>> flat = ricci.flatten_seamless(ricci.seamless(ricci.make("torus", n=12), cones={}))
    >>> flat.converged, flat.layout.summary.n_flipped
    (True, 0)
    """

    layout: Layout
    energies: Doubles
    summary: FlattenSummary

    @property
    def converged(self) -> bool:
        """True if the map is as good as the tolerance asks, or as doubles hold."""
        return self.summary.stop in ("converged", "rounding")

    @property
    def before(self) -> Distortion:
        """The change of lengths and areas by the map of the seamless metric."""
        return Distortion(*self.summary.before)

    @property
    def after(self) -> Distortion:
        """The change of lengths and areas by this map."""
        return Distortion(*self.summary.after)


@takes(SeamlessFlatOptions)
def flatten_seamless(
    turning: Seamless,
    progress: Progress = None,
    *,
    energy: Literal["isometric", "arap", "area"] = "isometric",
    conformal: float | None = None,
    tolerance: float | None = None,
    max_iterations: int | None = None,
    weights: npt.ArrayLike | None = None,
) -> SeamlessFlatMap:
    """The map to the plane of least distortion among those with the cones and the turning of a seamless metric, no triangle turned over.

    Seams stay rotations by multiples of 90 degrees and translations, exactly in doubles; a boundary is free.

    Parameters
    ----------
    turning : Seamless
        a seamless metric that has converged.
    progress : Progress
        a `Control` or a callback.

    Warns
    -----
    ConvergenceWarning
        the descent ended before the tolerance was reached; the best map found is returned.

    Raises
    ------
    LayoutError
        a seamless metric that has not converged, triangles that stay turned over, a triangle without area.

    Examples
    --------
    >>> flat = ricci.flatten_seamless(ricci.seamless(ricci.make("torus", n=12), cones={}))
    >>> flat.after.energy < flat.before.energy
    True
    """
    given: dict[str, Any] = {**picked(locals(), SeamlessFlatOptions)}
    energies = _room(given)
    out = ffi.new("ricci_flatten_summary *")
    places = (pointer(energies), energies.size, out, ffi.sizeof("ricci_flatten_summary"))
    struct = options("flatten_options", given, _FLATTEN)
    layout = Layout._made(lib.ricci_seamless_flatten, turning, struct, CONTROL, *places, progress=progress)
    told = _told(out)
    return SeamlessFlatMap(layout, energies[: told.n_energies].copy(), told)


def _room(given: dict[str, Any]) -> Doubles:
    """Room for the energies of all steps."""
    return np.empty((given.get("max_iterations") or 2000) + 1)


def _told(out: Any) -> FlattenSummary:
    """The figures of a descent, with a warning where it ended early."""
    told = figures_of(FlattenSummary, out)
    if told.stop not in ("converged", "rounding"):
        warn(f"the descent to a flat map ended early ({told.stop}): decrement {told.decrement:.1e} after {told.n_energies - 1} steps")
    return told


def _found(function: Any, columns: int, mesh: Any, given: dict[str, Any], progress: Progress) -> FlatMap:
    points = np.empty((mesh.n_vertices, columns))
    energies = _room(given)
    out = ffi.new("ricci_flatten_summary *")
    struct = options("flatten_options", given, _FLATTEN)
    places = (pointer(points), points.size, pointer(energies), energies.size)
    call(function, mesh, struct, CONTROL, *places, out, ffi.sizeof("ricci_flatten_summary"), progress=progress)
    told = _told(out)
    return FlatMap(points, energies[: told.n_energies].copy(), told)
