"""Seamless metrics and maps, whose cones and handles turn by multiples of 90 degrees."""

from __future__ import annotations

from functools import cached_property
from typing import Any, ClassVar, TypedDict

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._arrays import frozen
from ricci._call import CONTROL, constant, filled, summary
from ricci._kept import Kept
from ricci._library import lib
from ricci._shown import Scene
from ricci._signatures import picked, takes
from ricci._structs import Write, above_zero, index_list, number, options, real_list
from ricci.adapters import MeshLike, as_mesh
from ricci.control import Progress
from ricci.errors import ArgumentError, warn
from ricci.figures import SeamlessSummary
from ricci.layouts import Layout
from ricci.metrics import Metric

__all__ = ["Seamless", "SeamlessOptions", "cross_field", "seamless"]


class SeamlessOptions(TypedDict, total=False):
    """Options of a seamless metric.

    Attributes
    ----------
    cones : str | int | dict[int, int]
        ``"field"``: those of the smoothest field of four directions; a number: so many, placed so that areas change little, their
        angles rounded to multiples of 90 degrees; a mapping from vertices to valences, the number of right angles around each: the sum
        of 4 - valence, and of 2 - valence on the boundary, is 4 chi.
    quarter_turns : npt.ArrayLike
        the turning of each of the `n_loops` paths; the nearest to that of the conformal metric with these cones.
    tolerance : float
        largest deviation of an angle from its target, radians; 1e-10.
    max_iterations : int
        most Newton steps after the conformal flow; 100.
    threads : int
        one for each core.
    features : npt.ArrayLike
        m x 2 vertices: edges that become straight and parallel to an axis. Edges of the boundary do so anyway.
    feature_angle : float
        edges at which the surface turns by so many radians are features too.
    curvature : float
        the strength by which the field is drawn along principal curvature.
    strokes : dict[int, npt.ArrayLike]
        a mapping from vertices to directions in space, which the field is drawn along.
    isometric_steps : int
        steps towards the lengths of the surface with the same angles and turning; none.
    sizes : npt.ArrayLike
        for each vertex the factor by which lengths near it are to be larger, for the isometric steps.
    """

    cones: str | int | dict[int, int]
    quarter_turns: npt.ArrayLike
    tolerance: float
    max_iterations: int
    threads: int
    features: npt.ArrayLike
    feature_angle: float
    curvature: float
    strokes: dict[int, npt.ArrayLike]
    isometric_steps: int
    sizes: npt.ArrayLike


def _cones(struct: Any, field: str, value: Any) -> None:
    if isinstance(value, str):
        if value != "field":
            raise ArgumentError(f'{field} is "{value}": known are "field", a number of cones, a mapping from vertices to valences')
        struct.put(field, constant("SEAMLESS", "field"))
    elif isinstance(value, dict):
        struct.put(field, constant("SEAMLESS", "valences"))
        struct.put("vertices", _arrays.indices(list(value.keys()), None, "vertices"))
        struct.put("valences", _arrays.indices(list(value.values()), None, "valences"))
        struct.put("n_cones", len(value))
    else:
        struct.put(field, constant("SEAMLESS", "auto"))
        struct.put("n_cones", value)


def _quarter_turns(struct: Any, field: str, value: Any) -> None:
    given = np.asarray(value)
    turns = np.ascontiguousarray(given, np.int32)
    if turns.ndim != 1 or not np.array_equal(turns, given):
        raise ArgumentError(f"{field} is no list of whole numbers")
    struct.put(field, turns)
    struct.put("n_quarter_turns", len(turns))


def _strokes(struct: Any, field: str, value: Any) -> None:
    struct.put("stroke_vertices", _arrays.indices(list(value.keys()), None, field))
    struct.put(field, _arrays.real(np.array(list(value.values()), float), 3, field))
    struct.put("n_strokes", len(value))


_SEAMLESS: dict[str, Write] = {
    "cones": _cones,
    "quarter_turns": _quarter_turns,
    "tolerance": above_zero,
    "max_iterations": above_zero,
    "threads": number,
    "features": index_list("n_features", 2),
    "feature_angle": above_zero,
    "curvature": above_zero,
    "strokes": _strokes,
    "isometric_steps": number,
    "sizes": real_list(count="n_sizes"),
}


class Seamless(Kept):
    """A flat metric whose angles around cones and along loops are multiples of 90 degrees.

    Examples
    --------
    >>> turning = ricci.seamless(ricci.make("torus", n=24), cones={})
    >>> turning.summary.n_cones, turning.map().summary.n_flipped
    (0, 0)
    """

    _type: ClassVar[str] = "seamless"
    _made_by: ClassVar[str] = "ricci.seamless(mesh)"
    _figures: ClassVar[tuple[str, ...]] = ("converged", "n_cones", "n_loops", "error", "n_flips", "n_features")

    def _sides(self) -> tuple[Any, ...]:
        return self.map()._sides()

    def _scene(self) -> Scene | None:
        return self.map()._scene()

    @cached_property
    def summary(self) -> SeamlessSummary:
        """Convergence, counts, the largest deviation of an angle."""
        return summary(SeamlessSummary, "seamless", self)

    @property
    def converged(self) -> bool:
        """True if every angle is within the tolerance of its target."""
        return self.summary.converged

    @cached_property
    def cones(self) -> npt.NDArray[np.uint32]:
        """One row for each cone, by vertex: the vertex and its valence, the number of right angles around it."""
        return frozen(filled(lib.ricci_seamless_cones, self, out=np.empty((self.summary.n_cones, 2), np.uint32)))

    @cached_property
    def turning(self) -> npt.NDArray[np.int32]:
        """The turning of each loop that was asked for, quarter turns."""
        return frozen(filled(lib.ricci_seamless_turning, self, out=np.empty(self.summary.n_loops, np.int32)))

    @cached_property
    def features(self) -> npt.NDArray[np.uint32]:
        """The features and the edges of the boundary, each by the vertices at its ends."""
        return frozen(filled(lib.ricci_seamless_features, self, out=np.empty((self.summary.n_features, 2), np.uint32)))

    @cached_property
    def metric(self) -> Metric:
        """The metric on its Delaunay triangulation. Its report is that of the conformal flow."""
        return Metric._made(lib.ricci_seamless_metric, self)

    def map(self, progress: Progress = None) -> Layout:
        """The map into the plane, cut through all cones.

        Each edge of a seam is exactly, in doubles, a rotation by a multiple of 90 degrees and a translation of its other side.
        """
        return Layout._made(lib.ricci_seamless_map, self, CONTROL, progress=progress)


@takes(SeamlessOptions)
def seamless(
    V: MeshLike,
    F: npt.ArrayLike | None = None,
    progress: Progress = None,
    *,
    cones: str | int | dict[int, int] | None = None,
    quarter_turns: npt.ArrayLike | None = None,
    tolerance: float | None = None,
    max_iterations: int | None = None,
    threads: int | None = None,
    features: npt.ArrayLike | None = None,
    feature_angle: float | None = None,
    curvature: float | None = None,
    strokes: dict[int, npt.ArrayLike] | None = None,
    isometric_steps: int | None = None,
    sizes: npt.ArrayLike | None = None,
) -> Seamless:
    """A seamless metric of a surface near its conformal class.

    First the conformal metric with the cones, then least changes of the logarithms of lengths until 2g loops turn by multiples of
    90 degrees. Edges of the boundary and features become straight lines parallel to an axis.

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
        the target was not reached; whether a metric with this signature exists is not known.

    Raises
    ------
    ArgumentError
        features or strokes that do not exist; a choice of cones that does not fit a boundary or features.
    TargetError
        cones or a signature that no metric has.

    Examples
    --------
    >>> ricci.seamless(ricci.make("ellipsoid", n=8)).converged
    True
    """
    given = picked(locals(), SeamlessOptions)
    struct = options("seamless_options", given, _SEAMLESS)
    made = Seamless._made(lib.ricci_seamless_new, as_mesh(V, F), struct, CONTROL, progress=progress)
    if not made.converged:
        warn(f"the seamless metric did not converge: angles are off by {made.summary.error:.1e}; try other cones or quarter turns")
    return made


@takes(SeamlessOptions)
def cross_field(
    V: MeshLike,
    F: npt.ArrayLike | None = None,
    progress: Progress = None,
    *,
    cones: str | int | dict[int, int] | None = None,
    quarter_turns: npt.ArrayLike | None = None,
    tolerance: float | None = None,
    max_iterations: int | None = None,
    threads: int | None = None,
    features: npt.ArrayLike | None = None,
    feature_angle: float | None = None,
    curvature: float | None = None,
    strokes: dict[int, npt.ArrayLike] | None = None,
    isometric_steps: int | None = None,
    sizes: npt.ArrayLike | None = None,
) -> npt.NDArray[np.float64]:
    """The smoothest field of four directions along features and the boundary, near strokes and principal curvature.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`).
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    progress : Progress
        a `Control` or a callback.

    Returns
    -------
    npt.NDArray[np.float64]
        m x 3: one of the four directions in each face, a unit vector.

    Raises
    ------
    ArgumentError
        a mesh without positions; features or strokes that do not exist.

    Examples
    --------
    >>> ricci.cross_field(ricci.make("sphere", n=4)).shape
    (320, 3)
    """
    given = picked(locals(), SeamlessOptions)
    mesh = as_mesh(V, F)
    struct = options("seamless_options", given, _SEAMLESS)
    return filled(lib.ricci_seamless_field, mesh, struct, CONTROL, out=np.empty((mesh.summary.n_faces, 3)), progress=progress)
