"""Splines over layouts of four-sided patches, for CAD and for analysis."""

from __future__ import annotations

import os
from functools import cached_property
from typing import Any, ClassVar, Literal, NamedTuple, TypedDict

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._arrays import frozen
from ricci._call import CONTROL, Doubles, Indices, call, constant, filled, listed, path_bytes, pointer, signed_view, summary
from ricci._kept import Kept
from ricci._library import ffi, lib
from ricci._shown import Scene
from ricci._signatures import picked, takes
from ricci._structs import Write, above_zero, number, options, or_none
from ricci.adapters import MeshLike, as_mesh
from ricci.bicubics import _STEP, StepOptions
from ricci.control import Progress
from ricci.errors import ArgumentError
from ricci.figures import QuadSplineSummary
from ricci.mesh import Mesh
from ricci.quad_meshes import QuadLayout
from ricci.seams import Seamless
from ricci.splines import _places

__all__ = ["ExtractionMatrix", "NearestPlaces", "QuadArc", "QuadPatch", "QuadSpline", "QuadSplineOptions", "fit_few_patches", "quad_spline"]

# Columns that the library writes for each place.
_COLUMNS = {"point": 3, "first": 9, "second": 18, "third": 30, "shape": 5}


class QuadSplineOptions(TypedDict, total=False):
    """Options of fits over layouts.

    Attributes
    ----------
    tolerance : float
        largest distance between spline and surface over the diagonal; patches that are farther off get more spans. 0.001 or,
        where that is more, four times the noise of the surface.
    bending : float
        the weight of bending, up to 1e-5; 0: none. 1e-8 and, where that misses the tolerance, as little as suits the measured noise, down
        to 1e-11.
    most_spans : int
        most spans of a patch in each direction, up to 32; 6.
    threads : int
        one per core. The result does not depend on it.
    """

    tolerance: float
    bending: float
    most_spans: int
    threads: int


_QUAD_SPLINE: dict[str, Write] = {"tolerance": above_zero, "bending": or_none, "most_spans": above_zero, "threads": number}


class QuadPatch(NamedTuple):
    """A patch: what a host needs beside poles and knots to build its own B-spline surface. Sides are counterclockwise, from v = 0 on."""

    #: Along u and v.
    degrees: tuple[int, int]
    #: Number of poles along u and v.
    n_poles: tuple[int, int]
    #: Number of distinct knots along u and v.
    n_knots: tuple[int, int]
    #: False and False: periodic in neither direction.
    periodic: tuple[bool, bool]
    #: The arc on each side.
    arcs: tuple[int, ...]
    #: True for a side whose arc runs against the way around the patch.
    reversed: tuple[bool, ...]
    #: The patch on the other side of each arc; -1 on the border.
    neighbours: tuple[int, ...]
    #: The side of that patch; -1 on the border.
    neighbour_sides: tuple[int, ...]
    #: True for a side across which the normal may jump.
    creases: tuple[bool, ...]


class QuadArc(NamedTuple):
    """An arc: a curve that is a side of one patch or of two."""

    degree: int
    n_poles: int
    #: Number of distinct knots, which are those of the patches beside it along their side.
    n_knots: int
    #: The nodes at its start and its end.
    ends: tuple[int, int]
    #: The patch to its left and that to its right; -1 for none.
    patches: tuple[int, int]
    #: The sides of these patches; -1 for none.
    sides: tuple[int, int]
    #: Its length in parameters; tangents are continuous in these.
    length: float
    #: True if the normal may jump across it.
    crease: bool


class NearestPlaces(NamedTuple):
    """The places of a spline that are nearest to points."""

    #: The patch of each place.
    patches: Indices
    #: k x 2, u and v.
    parameters: Doubles
    #: k x 3.
    points: Doubles
    #: The distance of each from its point.
    distances: Doubles


class ExtractionMatrix(NamedTuple):
    """A sparse matrix by rows, as ``scipy.sparse.csr_array((values, columns, starts))`` takes it."""

    #: Where each row starts, and the last one ends.
    starts: npt.NDArray[np.int64]
    #: The column of each entry.
    columns: Indices
    #: The entries.
    values: Doubles


class QuadSpline(Kept):
    """A spline over a layout of four-sided patches, of degree 5 along u and v; its tangent planes are continuous but at creases.

    Examples
    --------
    >>> smooth = ricci.quad_spline(ricci.seamless(ricci.make("ellipsoid", n=8)))
    >>> smooth.evaluate(0, [[0.5, 0.5]]).shape
    (1, 3)
    """

    _type: ClassVar[str] = "quad_spline"
    _made_by: ClassVar[str] = "ricci.fit_few_patches(mesh)"
    _figures: ClassVar[tuple[str, ...]] = ("n_patches", "n_control_points", "rms", "max", "normal_jump", "converged")

    def _scene(self) -> Scene | None:
        return self.tessellate(4)._scene()

    @cached_property
    def summary(self) -> QuadSplineSummary:
        """Counts, distances from the surface, jumps of the normals."""
        return summary(QuadSplineSummary, "quad_spline", self)

    @cached_property
    def folds(self) -> Indices:
        """The patches that are turned over somewhere."""
        return frozen(filled(lib.ricci_quad_spline_folds, self, out=np.empty(self.summary.n_folded_patches, np.uint32)))

    def patch(self, number: int) -> QuadPatch:
        """Degrees and sizes of a patch, its arcs, and the patches that it meets.

        Raises
        ------
        SplineError
            no such patch.
        """
        out = ffi.new("ricci_quad_patch *")
        call(lib.ricci_quad_spline_patch, self, number, out, ffi.sizeof("ricci_quad_patch"))
        flags = {"periodic", "reversed", "creases"}
        told: dict[str, Any] = {name: tuple(bool(x) if name in flags else int(x) for x in getattr(out, name)) for name in QuadPatch._fields}
        return QuadPatch(**told)

    def poles(self, patch: int) -> Doubles:
        """m x n x 3, the control points of a patch: that of i along u and j along v at [i, j]."""
        m, n = self.patch(patch).n_poles
        return filled(lib.ricci_quad_spline_poles, self, patch, out=np.empty((m, n, 3)))

    def knots(self, patch: int, along: Literal["u", "v"]) -> tuple[Doubles, Indices]:
        """The distinct knots of a patch along u or v, and how often each occurs."""
        which = constant("ALONG", along)
        n = self.patch(patch).n_knots[which]
        knots, counts = np.empty(n), np.empty(n, np.uint32)
        call(lib.ricci_quad_spline_knots, self, patch, which, pointer(knots), n, pointer(counts), n)
        return knots, signed_view(counts)

    def controls(self, patch: int) -> Indices:
        """m x n, the numbers of the control points of a patch: equal on common sides, and rows of `extraction`."""
        return filled(lib.ricci_quad_spline_controls, self, patch, out=np.empty(self.patch(patch).n_poles, np.uint32))

    def arc(self, number: int) -> QuadArc:
        """The ends of an arc, and the patches beside it.

        Raises
        ------
        SplineError
            no such arc.
        """
        out = ffi.new("ricci_quad_arc *")
        call(lib.ricci_quad_spline_arc, self, number, out, ffi.sizeof("ricci_quad_arc"))
        pairs: dict[str, Any] = {name: tuple(getattr(out, name)) for name in ("ends", "patches", "sides")}
        return QuadArc(out.degree, out.n_poles, out.n_knots, **pairs, length=out.length, crease=bool(out.crease))

    def arc_poles(self, arc: int) -> Doubles:
        """k x 3, the poles of an arc from its start to its end: the same numbers as those of the patches beside it."""
        return filled(lib.ricci_quad_spline_arc_poles, self, arc, out=np.empty((self.arc(arc).n_poles, 3)))

    def evaluate(
        self,
        patches: npt.ArrayLike,
        parameters: npt.ArrayLike,
        what: Literal["point", "first", "second", "third", "shape"] = "point",
        progress: Progress = None,
    ) -> Doubles:
        """Points of the surface with derivatives, normals or curvatures, in parallel.

        Parameters
        ----------
        patches : npt.ArrayLike
            the patch of each place, or one for all.
        parameters : npt.ArrayLike
            k x 2, u and v of each place, from 0 to 1.
        what : Literal["point", "first", "second", "third", "shape"]
            ``"point"``: k x 3; ``"first"``: k x 3 x 3, the point, its derivatives by u and v; ``"second"``: k x 6 x 3, those and
            uu, uv, vv; ``"third"``: k x 10 x 3, those and uuu, uuv, uvv, vvv; ``"shape"``: k x 5, the outward unit normal and the
            principal curvatures, the larger one first.
        progress : Progress
            a `Control` or a callback.

        Raises
        ------
        SplineError
            a place that does not exist.
        """
        which = constant("QUAD_SPLINE", what, tuple(_COLUMNS))
        array = _arrays.real(parameters, 2, "parameters")
        struct = _places(array, np.full(len(array), patches) if np.ndim(patches) == 0 else patches)
        out = np.empty((len(array), _COLUMNS[what]))
        filled(lib.ricci_quad_spline_evaluate, self, struct, which, CONTROL, out=out, progress=progress)
        return out.reshape(len(out), -1, 3) if what in ("first", "second", "third") else out

    def closest(self, points: npt.ArrayLike, progress: Progress = None) -> NearestPlaces:
        """The nearest places to points in space, k x 3. The first call makes a search structure, which the spline keeps."""
        array = _arrays.real(points, 3, "points")
        n = len(array)
        patches, values = np.empty(n, np.uint32), np.empty((n, 6))
        places = (pointer(array), n, CONTROL, pointer(patches), pointer(values), values.size)
        call(lib.ricci_quad_spline_closest, self, *places, progress=progress)
        return NearestPlaces(signed_view(patches), values[:, :2], values[:, 2:5], values[:, 5])

    def tessellate(self, parts: int | None = None, tolerance: float | None = None, progress: Progress = None) -> Mesh:
        """A mesh of the surface, patch after patch, with common vertices on common sides.

        Parameters
        ----------
        parts : int | None
            each patch is divided into parts x parts cells of two triangles.
        tolerance : float | None
            largest distance between a triangle and the surface, in the units of the surface; a thousandth of the diagonal.
        progress : Progress
            a `Control` or a callback.

        Raises
        ------
        ArgumentError
            both sizes, or one that is not positive.
        """
        if parts == 0 or tolerance == 0:
            raise ArgumentError("parts and tolerance must be above 0; None, or leaving them out, is the default")
        return Mesh._made(lib.ricci_quad_spline_tessellate, self, parts or 0, tolerance or 0.0, CONTROL, progress=progress)

    def patch_of_faces(self, mesh: MeshLike, progress: Progress = None) -> Indices:
        """The patch on which each face of a mesh of the surface lies: the nearest one to its centroid of those that face the same way."""
        given = as_mesh(mesh)
        out = np.empty(given.n_faces, np.uint32)
        return filled(lib.ricci_quad_spline_patch_of_faces, self, given, CONTROL, out=out, progress=progress)

    @cached_property
    def extraction(self) -> ExtractionMatrix:
        """Every control point (a row) as a combination of the free ones (columns), of which there are `summary.n_free`.

        Functions of the surface with continuous gradients are combinations of `n_free` basis functions: those of the patches, by
        `controls`, combined with the columns of this matrix.
        """
        n, rows = self.summary.n_entries, self.summary.n_control_points
        columns, values, starts = np.empty(n, np.uint32), np.empty(n), np.empty(rows + 1, np.uintp)
        call(lib.ricci_quad_spline_extraction, self, pointer(columns), n, pointer(values), n, pointer(starts), rows + 1)
        return ExtractionMatrix(frozen(starts.astype(np.int64)), frozen(signed_view(columns)), frozen(values))

    def bezier(self, patch: int, along: Literal["u", "v"]) -> Doubles:
        """spans x 6 x 6: per span along u or v the weight of control point 3 x span + j in Bezier point k at [span, k, j]."""
        out: Doubles = listed(lib.ricci_quad_spline_bezier, self, patch, constant("ALONG", along), dtype=np.float64)
        return out.reshape(-1, 6, 6)

    @takes(StepOptions)
    def write_step(
        self,
        path: str | os.PathLike[str],
        *,
        name: str | None = None,
        unit: Literal["millimetre", "metre"] = "millimetre",
        colours: bool = False,
    ) -> None:
        """Write the patches as .step or .stp (STEP AP242), whole or not at all: faces on planes and cylinders, else one for each patch."""
        given = picked(locals(), StepOptions)
        call(lib.ricci_quad_spline_write_step, self, options("step_options", given, _STEP), path_bytes(path))

    def write_json(self, path: str | os.PathLike[str]) -> None:
        """Write the knots and control points of the patches as .json (`ricci-quad-spline 1`), whole or not at all."""
        call(lib.ricci_quad_spline_write_json, self, path_bytes(path))

    def __repr__(self) -> str:
        s = self.summary
        return f"<ricci.QuadSpline: {s.n_patches} patches, {s.n_control_points} control points>"


@takes(QuadSplineOptions)
def quad_spline(
    seamless: Seamless,
    layout: QuadLayout | None = None,
    progress: Progress = None,
    *,
    tolerance: float | None = None,
    bending: float | None = None,
    most_spans: int | None = None,
    threads: int | None = None,
) -> QuadSpline:
    """A spline over the patches of a layout, near the surface of its seamless metric.

    Patches that miss the tolerance get more spans; `summary.converged` says whether all are within it and none is turned over.

    Parameters
    ----------
    seamless : Seamless
        the seamless metric.
    layout : QuadLayout | None
        a layout of it; None: the coarsest one.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    ArgumentError
        a layout of another seamless metric.
    LayoutError
        a surface without positions; a metric so far from its target that it has no quads.
    SplineError
        a layout with one or two patches around a node.

    Examples
    --------
    >>> smooth = ricci.quad_spline(ricci.seamless(ricci.make("ellipsoid", n=8)))
    >>> smooth.summary.degree
    5
    """
    given = picked(locals(), QuadSplineOptions)
    on: Any = ffi.NULL if layout is None else layout
    struct = options("quad_spline_options", given, _QUAD_SPLINE)
    return QuadSpline._made(lib.ricci_quad_spline_fit, seamless, on, struct, CONTROL, progress=progress)


@takes(QuadSplineOptions)
def fit_few_patches(
    V: MeshLike,
    F: npt.ArrayLike | None = None,
    feature_angle: float = 0.0,
    progress: Progress = None,
    *,
    tolerance: float | None = None,
    bending: float | None = None,
    most_spans: int | None = None,
    threads: int | None = None,
) -> QuadSpline:
    """A spline with few patches, near a mesh: over the coarsest layouts of seamless metrics with other cones in turn.

    Patches that miss the tolerance get more spans; `summary.converged` says whether all are within it and none is turned over.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`).
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    feature_angle : float
        edges at which the surface turns by this much, radians, become sides of patches across which normals may jump; 0: none.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    ArgumentError
        a mesh without positions; an angle below 0.
    LayoutError
        no layout was found.

    Examples
    --------
    >>> smooth = ricci.fit_few_patches(ricci.make("ellipsoid", n=8))
    >>> smooth.summary.converged
    True
    """
    given = picked(locals(), QuadSplineOptions)
    mesh = as_mesh(V, F)
    struct = options("quad_spline_options", given, _QUAD_SPLINE)
    return QuadSpline._made(lib.ricci_quad_spline_fit_mesh, mesh, float(feature_angle), struct, CONTROL, progress=progress)
