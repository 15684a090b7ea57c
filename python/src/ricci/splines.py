"""Triangular B-splines over the plane, and over whole surfaces."""

from __future__ import annotations

import os
from functools import cached_property
from typing import Any, ClassVar, Literal, Self, TypedDict

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._arrays import frozen
from ricci._call import (
    CONTROL,
    Doubles,
    Indices,
    Signed,
    call,
    constant,
    doubles,
    filled,
    path_bytes,
    pointer,
    signed_view,
    summary,
    text_of,
)
from ricci._kept import Kept
from ricci._library import lib
from ricci._shown import Scene
from ricci._signatures import picked, takes
from ricci._structs import Struct, Write, above_zero, index_list, options, or_none, real_list
from ricci.adapters import MeshLike, as_mesh
from ricci.control import Progress
from ricci.errors import ArgumentError
from ricci.figures import SplineSummary
from ricci.mesh import Mesh
from ricci.metrics import Metric

__all__ = ["PlaneOptions", "Spline", "SurfaceOptions", "spline"]

# Columns that the library writes for each place.
_COLUMNS = {"point": 3, "first": 9, "second": 18, "shape": 5}


class PlaneOptions(TypedDict, total=False):
    """The basis functions of a spline over a domain in the plane.

    Attributes
    ----------
    degree : int
        1 to 5; 3.
    knots : npt.ArrayLike
        n x (degree + 1) x 2, the first of a vertex the vertex itself.
    coincident : npt.ArrayLike
        vertices whose knots coincide.
    creases : npt.ArrayLike
        k x 2 vertices: edges across which the spline may have a crease.
    spread : float
        distance of the farthest knots from their vertex over the radius of the smallest circle in a face there; 0.5.
    """

    degree: int
    knots: npt.ArrayLike
    coincident: npt.ArrayLike
    creases: npt.ArrayLike
    spread: float


class SurfaceOptions(TypedDict, total=False):
    """Options of a fit of a spline to a whole surface.

    Attributes
    ----------
    degree : int
        1 to 5; 3.
    control_points : int
        their number, at most; a quarter of the vertices, and where no such spline holds twice and four times as
        many, up to 4000.
    tolerance : float
        largest distance of a vertex over the diagonal at which no further round is made; 0.01.
    fairness : float
        weight of the variation of bending in the first round; chosen by cross-validation.
    spread : float
        least distance of knots from their vertex; 0.9.
    rounds : int
        times that the sizes of the triangles are adapted to the errors; 6.
    corrections : int
        times at most that vertices are moved to the nearest points of the spline; 20; 0: none.
    threads : int
        one per core. The result does not depend on it.
    """

    degree: int
    control_points: int
    tolerance: float
    fairness: float
    spread: float
    rounds: int
    corrections: int
    threads: int


_PLANE: dict[str, Write] = {
    "degree": above_zero,
    "spread": above_zero,
    "knots": real_list(),
    "coincident": index_list("n_coincident"),
    "creases": index_list("n_creases", 2),
}
_SURFACE: dict[str, Write] = {**dict.fromkeys(SurfaceOptions.__annotations__, above_zero), "corrections": or_none}


def _places(parameters: npt.ArrayLike, patches: npt.ArrayLike | None) -> Struct:
    """The struct of places: x and y of each, and its patch; None: the one in which it lies."""
    array = _arrays.real(parameters, 2, "parameters")
    struct = Struct("spline_places")
    struct.put("parameters", array)
    struct.put("n", len(array))
    if patches is not None:
        numbers = _arrays.indices(patches, name="patches")
        if numbers.shape != (len(array),):
            raise ArgumentError(f"{numbers.size} patches for {len(array)} places")
        struct.put("patches", numbers)
    return struct


class Spline(Kept):
    """A spline surface: basis functions over a domain, with a control point each. It never changes.

    Examples
    --------
    >>> flat = ricci.Spline.plane(ricci.make("disk", n=2), degree=2)
    >>> flat.evaluate([[0.1, 0.2]]).round(12)
    array([[0.1, 0.2, 0. ]])
    """

    _type: ClassVar[str] = "spline"
    _made_by: ClassVar[str] = "ricci.spline(mesh)"
    _figures: ClassVar[tuple[str, ...]] = ("degree", "n_patches", "n_control_points", "fit_rms", "fit_max", "n_folded_patches")

    def _scene(self) -> Scene | None:
        return self.tessellate(6)._scene()

    @classmethod
    @takes(PlaneOptions)
    def plane(
        cls,
        domain: MeshLike,
        *,
        degree: int | None = None,
        knots: npt.ArrayLike | None = None,
        coincident: npt.ArrayLike | None = None,
        creases: npt.ArrayLike | None = None,
        spread: float | None = None,
    ) -> Self:
        """A spline over a mesh that lies over the plane without folds; its surface is the plane z = 0.

        Raises
        ------
        SplineError
            a clockwise face, knots that give no basis.
        """
        given = picked(locals(), PlaneOptions)
        mesh = as_mesh(domain)
        knots = given.get("knots")
        if knots is not None and np.size(knots) != mesh.n_vertices * (given.get("degree", 3) + 1) * 2:
            raise ArgumentError(f"knots have shape {np.shape(knots)} for {mesh.n_vertices} vertices of degree {given.get('degree', 3)}")
        return cls._made(lib.ricci_spline_new, mesh, options("spline_spec", given, _PLANE))

    @classmethod
    @takes(SurfaceOptions)
    def of_surface(
        cls,
        flat: Metric,
        progress: Progress = None,
        *,
        degree: int | None = None,
        control_points: int | None = None,
        tolerance: float | None = None,
        fairness: float | None = None,
        spread: float | None = None,
        rounds: int | None = None,
        corrections: int | None = None,
        threads: int | None = None,
    ) -> Self:
        """A spline near the vertices of a whole surface, on a metric that a flow made flat, up to singular vertices.

        Raises
        ------
        ArgumentError
            the metric is not Euclidean.
        """
        given = picked(locals(), SurfaceOptions)
        return cls._made(lib.ricci_spline_fit_surface, flat, options("spline_surface_options", given, _SURFACE), CONTROL, progress=progress)

    @classmethod
    @takes(SurfaceOptions)
    def of_mesh(
        cls,
        surface: MeshLike,
        progress: Progress = None,
        *,
        degree: int | None = None,
        control_points: int | None = None,
        tolerance: float | None = None,
        fairness: float | None = None,
        spread: float | None = None,
        rounds: int | None = None,
        corrections: int | None = None,
        threads: int | None = None,
    ) -> Self:
        """A spline near the vertices of a whole surface of any topology, on flat metrics that are made for it.

        The first is the usual one, in which a sphere has a vertex at infinity; those with more singular vertices follow until a fit
        holds, and the best is kept. `summary.converged` says whether it holds.

        Raises
        ------
        ArgumentError
            a surface without positions.
        LayoutError
            no flow to a flat metric converged.
        """
        given = picked(locals(), SurfaceOptions)
        mesh = as_mesh(surface)
        return cls._made(lib.ricci_spline_fit_mesh, mesh, options("spline_surface_options", given, _SURFACE), CONTROL, progress=progress)

    @classmethod
    def read(cls, path: str | os.PathLike[str], progress: Progress = None) -> Self:
        """The spline of a file, `ricci-spline 1`."""
        return cls._made(lib.ricci_spline_read, path_bytes(path), progress=progress)

    @classmethod
    def parse(cls, text: str) -> Self:
        """The spline of a text that is such a file's."""
        return cls._made(lib.ricci_spline_parse, text.encode())

    def write(self, path: str | os.PathLike[str], progress: Progress = None) -> None:
        """Write a spline file, whole or not at all; numbers are read back as they were."""
        call(lib.ricci_spline_write, self, path_bytes(path), progress=progress)

    def text(self) -> str:
        """The text of the spline's file."""
        return text_of(lib.ricci_spline_text, self)

    def with_points(self, points: npt.ArrayLike) -> Spline:
        """The surface with other control points, k x 3."""
        array = _arrays.real(points, 3, "points")
        return Spline._made(lib.ricci_spline_with_points, self, pointer(array), len(array))

    def with_polynomial(self, coefficients: npt.ArrayLike) -> Spline:
        """The polynomial with these coefficients (k x 3) of 1, x, y, x^2, x y, y^2, ..."""
        array = _arrays.real(coefficients, 3, "coefficients")
        return Spline._made(lib.ricci_spline_with_polynomial, self, pointer(array), len(array))

    def fit(
        self,
        points: npt.ArrayLike,
        places: npt.ArrayLike | None = None,
        progress: Progress = None,
        *,
        fairness: float | None = None,
        threads: int | None = None,
    ) -> Spline:
        """The surface that is nearest to points in the sense of least squares.

        Parameters
        ----------
        points : npt.ArrayLike
            k x 3.
        places : npt.ArrayLike | None
            k x 2, where in the spline they belong; None: over their own x and y.
        progress : Progress
            a `Control` or a callback.
        fairness : float | None
            the weight of the variation of bending; 1e-12; 0: none.
        threads : int | None
            one per core. The result does not depend on it.
        """
        array = _arrays.real(points, 3, "points")
        how = {"fairness": fairness, "threads": threads}
        struct = options("spline_fit_options", how, {"fairness": or_none, "threads": above_zero})
        if places is not None:
            struct.put("places", _places(places, None))
        return Spline._made(lib.ricci_spline_fit, self, pointer(array), len(array), struct, CONTROL, progress=progress)

    @cached_property
    def summary(self) -> SplineSummary:
        """Degree, counts, errors of the fit."""
        return summary(SplineSummary, "spline", self)

    @cached_property
    def control_points(self) -> Doubles:
        """k x 3."""
        return self._values("CONTROL_POINTS", self.summary.n_control_points, 3)

    @cached_property
    def knots(self) -> Doubles:
        """n_patches x 3 x (degree + 1) x 2: for each corner of a patch its knots, the corner first."""
        return self._values("KNOTS", self.summary.n_patches, 3, self.summary.degree + 1, 2)

    @cached_property
    def abscissas(self) -> Doubles:
        """k x 2: over which points of the plane the control points of a height field lie."""
        return self._values("ABSCISSAS", self.summary.n_control_points, 2)

    @cached_property
    def holes(self) -> Doubles:
        """k x 2: of each hole around a singular vertex the total angle there in turns, and the radius."""
        return self._values("HOLES", self.summary.n_holes, 2)

    @cached_property
    def folds(self) -> Indices:
        """Of a fit to a surface, the patches in which it folds: normals turn by more than 60 degrees there between neighbouring places."""
        return frozen(filled(lib.ricci_spline_folds, self, out=np.empty(self.summary.n_folded_patches, np.uint32)))

    @cached_property
    def controls(self) -> Indices:
        """n_patches x n_basis: the control points of every patch."""
        out = np.empty((self.summary.n_patches, self.summary.n_basis), np.uint32)
        return frozen(filled(lib.ricci_spline_controls, self, out=out))

    def locate(self, points: npt.ArrayLike) -> Signed:
        """The patches in which points of the plane (k x 2) lie; -1 outside the domain."""
        array = _arrays.real(points, 2, "points")
        return filled(lib.ricci_spline_locate, self, pointer(array), len(array), out=np.empty(len(array), np.int32))

    def evaluate(
        self,
        parameters: npt.ArrayLike,
        patches: npt.ArrayLike | None = None,
        what: Literal["point", "first", "second", "shape"] = "point",
        progress: Progress = None,
    ) -> Doubles:
        """Points of the surface with derivatives, normals or curvatures, in parallel.

        Parameters
        ----------
        parameters : npt.ArrayLike
            k x 2, x and y of each place.
        patches : npt.ArrayLike | None
            the patch of each place; None: the one in which it lies, of a spline over the plane.
        what : Literal["point", "first", "second", "shape"]
            ``"point"``: k x 3; ``"first"``: k x 3 x 3, the point, its derivatives by x and y; ``"second"``: k x 6 x 3, those and
            xx, xy, yy; ``"shape"``: k x 5, the unit normal and the principal curvatures, the larger one first.
        progress : Progress
            a `Control` or a callback.

        Raises
        ------
        SplineError
            a place outside; the index is its number.
        """
        which = constant("SPLINE", what, tuple(_COLUMNS))
        struct = _places(parameters, patches)
        out = np.empty((struct._pointer.n, _COLUMNS[what]))
        filled(lib.ricci_spline_evaluate, self, struct, which, CONTROL, out=out, progress=progress)
        return out.reshape(len(out), -1, 3) if what in ("first", "second") else out

    def closest(self, points: npt.ArrayLike, progress: Progress = None) -> tuple[Indices, Doubles, Doubles, Doubles]:
        """For points in space (k x 3) the nearest ones of the surface: patches, parameters (k x 2), points (k x 3), distances."""
        array = _arrays.real(points, 3, "points")
        patches, values = np.empty(len(array), np.uint32), np.empty((len(array), 6))
        call(
            lib.ricci_spline_closest,
            self,
            pointer(array),
            len(array),
            CONTROL,
            pointer(patches),
            pointer(values),
            values.size,
            progress=progress,
        )
        return signed_view(patches), values[:, :2], values[:, 2:5], values[:, 5]

    def blossom(self, patch: int, arguments: npt.ArrayLike) -> Doubles:
        """The polar form of the polynomial in the middle of a patch at `arguments`, degree x 2: a point in space."""
        array, out = _arrays.real(arguments, 2, "arguments"), np.empty(3)
        call(lib.ricci_spline_blossom, self, patch, pointer(array), len(array), pointer(out))
        return out

    def tessellate(self, sides: int = 4, progress: Progress = None) -> Mesh:
        """A mesh with normals and, as texture coordinates, the places of its corners: sides^2 triangles for each patch."""
        return Mesh._made(lib.ricci_spline_tessellate, self, sides, CONTROL, progress=progress)

    def _values(self, which: str, *shape: int) -> Any:
        return frozen(doubles(lib.ricci_spline_values, self, getattr(lib, f"RICCI_SPLINE_{which}"), shape=shape))

    def __repr__(self) -> str:
        s = self.summary
        return f"<ricci.Spline: degree {s.degree}, {s.n_patches} patches, {s.n_control_points} control points>"


@takes(SurfaceOptions)
def spline(
    V: MeshLike,
    F: npt.ArrayLike | None = None,
    progress: Progress = None,
    *,
    degree: int | None = None,
    control_points: int | None = None,
    tolerance: float | None = None,
    fairness: float | None = None,
    spread: float | None = None,
    rounds: int | None = None,
    corrections: int | None = None,
    threads: int | None = None,
) -> Spline:
    """A spline near the vertices of a whole surface, with as few singular vertices as its shape needs.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, a mesh of any kind (`as_mesh`), or a `Metric` that a flow made flat.
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    progress : Progress
        a `Control` or a callback.

    Examples
    --------
    >>> ring = ricci.spline(ricci.make("torus", n=24), rounds=1)
    >>> ring.summary.degree
    3
    """
    given = picked(locals(), SurfaceOptions)
    if isinstance(V, Metric):
        return Spline.of_surface(V, progress, **given)
    return Spline.of_mesh(as_mesh(V, F), progress, **given)
