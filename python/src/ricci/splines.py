"""Triangular B-splines over the plane, and over whole surfaces."""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import cached_property
from typing import Any, ClassVar, Literal, Self, TypedDict, Unpack

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._arrays import frozen
from ricci._call import (
    CONTROL,
    Doubles,
    Handle,
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
from ricci._library import lib
from ricci._structs import Struct, Write, above_zero, index_list, options, or_none, real_list
from ricci.adapters import MeshLike, as_mesh
from ricci.control import Progress, stages
from ricci.errors import ArgumentError
from ricci.figures import SplineSummary
from ricci.mesh import Mesh
from ricci.metrics import Metric

__all__ = ["PlaneOptions", "Spline", "SurfaceOptions", "flat_metric", "spline", "spline_domain"]

# Columns that the library writes for each place.
_COLUMNS = {"point": 3, "first": 9, "second": 18, "shape": 5}


class PlaneOptions(TypedDict, total=False):
    """The basis functions of a spline over a domain in the plane.

    Attributes:
        degree: 1 to 5; 3.
        knots: n x (degree + 1) x 2, the first of a vertex the vertex itself.
        coincident: vertices whose knots coincide.
        creases: k x 2 vertices: edges across which the spline may have a crease.
        spread: distance of the farthest knots from their vertex over the radius of the smallest circle in a face there; 0.5.
    """

    degree: int
    knots: npt.ArrayLike
    coincident: npt.ArrayLike
    creases: npt.ArrayLike
    spread: float


class SurfaceOptions(TypedDict, total=False):
    """Options of a fit of a spline to a whole surface.

    Attributes:
        degree: 1 to 5; 3.
        control_points: their number, at most; a quarter of the vertices, and where no such spline holds twice and four times as
            many, up to 4000.
        tolerance: largest distance of a vertex over the diagonal at which no further round is made; 0.01.
        fairness: weight of the variation of bending in the first round; chosen by cross-validation.
        spread: least distance of knots from their vertex; 0.9.
        rounds: times that the sizes of the triangles are adapted to the errors; 6.
        corrections: times at most that vertices are moved to the nearest points of the spline; 20; 0: none.
        threads: one per core. The result does not depend on it.
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


class Spline(Handle):
    """A spline surface: basis functions over a domain, with a control point each. It never changes."""

    _type: ClassVar[str] = "spline"
    _made_by: ClassVar[str] = "ricci.spline(mesh)"

    @classmethod
    def plane(cls, domain: MeshLike, **given: Unpack[PlaneOptions]) -> Self:
        """A spline over a mesh that lies over the plane without folds; its surface is the plane z = 0.

        Raises:
            SplineError: a clockwise face, knots that give no basis.
        """
        mesh = as_mesh(domain)
        knots = given.get("knots")
        if knots is not None and np.size(knots) != mesh.n_vertices * (given.get("degree", 3) + 1) * 2:
            raise ArgumentError(f"knots have shape {np.shape(knots)} for {mesh.n_vertices} vertices of degree {given.get('degree', 3)}")
        return cls._made(lib.ricci_spline_new, mesh, options("spline_spec", given, _PLANE))

    @classmethod
    def of_surface(cls, flat: Metric, progress: Progress = None, **given: Unpack[SurfaceOptions]) -> Self:
        """A spline near the vertices of a whole surface, on a metric that a flow made flat, up to singular vertices.

        Raises:
            ArgumentError: the metric is not Euclidean.
        """
        return cls._made(lib.ricci_spline_fit_surface, flat, options("spline_surface_options", given, _SURFACE), CONTROL, progress=progress)

    @classmethod
    def of_mesh(cls, surface: MeshLike, progress: Progress = None, **given: Unpack[SurfaceOptions]) -> Self:
        """A spline near the vertices of a whole surface of any topology, on flat metrics that are made for it.

        The first is the usual one, in which a sphere has a vertex at infinity; those with more singular vertices follow until a fit
        holds, and the best is kept. `summary.converged` says whether it holds.

        Raises:
            ArgumentError: a surface without positions.
            LayoutError: no flow to a flat metric converged.
        """
        mesh = as_mesh(surface)
        return cls._made(lib.ricci_spline_fit_mesh, mesh, options("spline_surface_options", given, _SURFACE), CONTROL, progress=progress)

    @classmethod
    def read(cls, path: str | os.PathLike[str], progress: Progress = None) -> Self:
        """The spline of a file, `ricci-spline 1`."""
        return cls._made(lib.ricci_spline_read, path_bytes(path), progress=progress)

    def __reduce__(self) -> Any:
        """The text of the spline's file, which reads back as it was."""
        return Spline.parse, (self.text(),)

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

    def fit(self, points: npt.ArrayLike, places: npt.ArrayLike | None = None, progress: Progress = None, **how: float) -> Spline:
        """The surface that is nearest to points in the sense of least squares.

        Args:
            points: k x 3.
            places: k x 2, where in the spline they belong; None: over their own x and y.
            progress: a `Control` or a callback.
            how: `fairness`, the weight of the variation of bending (1e-12; 0: none), and `threads`.
        """
        array = _arrays.real(points, 3, "points")
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

        Args:
            parameters: k x 2, x and y of each place.
            patches: the patch of each place; None: the one in which it lies, of a spline over the plane.
            what: ``"point"``: k x 3; ``"first"``: k x 3 x 3, the point, its derivatives by x and y; ``"second"``: k x 6 x 3, those and
                xx, xy, yy; ``"shape"``: k x 5, the unit normal and the principal curvatures, the larger one first.
            progress: a `Control` or a callback.

        Raises:
            SplineError: a place outside; the index is its number.
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


def spline_domain(polygons: Sequence[npt.ArrayLike], edge: float) -> Mesh:
    """Triangles inside polygons, as the domain of a spline: a mesh in the plane z = 0.

    Args:
        polygons: the corners of each, k x 2; the inside is what an odd number of them winds around.
        edge: triangles are about as large as equilateral ones with this edge.

    Raises:
        SplineError: a polygon that crosses itself or another one.
    """
    parts = [_arrays.real(part, 2, "polygons") for part in polygons]
    corners = np.concatenate(parts)
    starts = np.concatenate([[0], np.cumsum([len(part) for part in parts])]).astype(np.uintp)
    return Mesh._made(lib.ricci_spline_domain, pointer(corners), pointer(starts), len(parts), edge)


def flat_metric(mesh: Mesh, singular: int | str | npt.ArrayLike = "auto", range: float = 30.0, progress: Progress = None) -> Metric:
    """The flat metric of a surface on which a spline lives: its curvature is at singular vertices inside, and at corners of the boundary.

    Args:
        mesh: a surface.
        singular: "auto" for as few as keep lengths within a factor `range` of each other; their number; or the vertices.
        range: that factor, above 1.
        progress: a `Control` or a callback.

    Raises:
        ArgumentError: a sphere with fewer than three singular vertices, or too few vertices for three (500 each).
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


def spline(V: MeshLike, F: npt.ArrayLike | None = None, progress: Progress = None, **given: Unpack[SurfaceOptions]) -> Spline:
    """A spline near the vertices of a whole surface, with as few singular vertices as its shape needs.

    Args:
        V: n x 3 positions with `F`, a mesh of any kind (`as_mesh`), or a `Metric` that a flow made flat.
        F: m x 3 vertex indices.
        progress: a `Control` or a callback.
        given: degree, number of control points, tolerance (`SurfaceOptions`).
    """
    if isinstance(V, Metric):
        return Spline.of_surface(V, progress, **given)
    return Spline.of_mesh(as_mesh(V, F), progress, **given)
