"""Uniformization: surfaces in their metric of constant curvature, on the sphere, in the plane or the hyperbolic plane."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any, ClassVar, Literal, TypedDict

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._arrays import frozen
from ricci._call import CONTROL, Doubles, Indices, Signed, call, constant, doubles, pointer, summary
from ricci._kept import Kept
from ricci._library import ffi, lib
from ricci._shown import Scene
from ricci._signatures import picked, takes
from ricci._structs import Write, choice, index_list, nested, one_index, options, real_list
from ricci.adapters import MeshLike, as_mesh
from ricci.control import Progress
from ricci.errors import ArgumentError, LayoutError, warn
from ricci.figures import UniformSummary
from ricci.figures.names import Model, On, Scheme
from ricci.fundamental import Domain, Homotopy
from ricci.layouts import Layout
from ricci.mesh import Mesh
from ricci.metrics import FlowOptions, Metric, flow_struct

__all__ = ["Uniform", "UniformOptions", "uniformize"]


class UniformOptions(TypedDict, total=False):
    """Options of a uniformization.

    Attributes
    ----------
    flow : FlowOptions
        how the flow is done; a sphere takes tolerance, max_iterations and threads, or with the method ``"gradient"``, by which it
        flows in S2, all of them.
    start : Metric
        where the flow starts, such as another flow's result.
    base : int
        the vertex at a quotient's origin; of a sphere that which is sent to infinity.
    scheme : Scheme
        spheres have ``"yamabe"``, but for those that flow in S2.
    boundary : Literal["geodesic", "straight"]
        the shape that the boundary is given: ``"geodesic"`` loops, or ``"straight"`` sides between corners.
    corners : npt.ArrayLike | int
        vertices of the boundary, for straight sides; a number of them: as many are chosen.
    corner_angles : npt.ArrayLike
        angles inside the corners, radians; 0: those without one share what is left.
    """

    flow: FlowOptions
    start: Metric
    base: int
    scheme: Scheme
    boundary: Literal["geodesic", "straight"]
    corners: npt.ArrayLike | int
    corner_angles: npt.ArrayLike


def _corners(struct: Any, field: str, value: Any) -> None:
    """Vertices, or their number."""
    if isinstance(value, int | np.integer):
        if value < 1:
            raise ArgumentError(f"corners is {value}: at least 1, or None for none")
        struct.put("n_corners", int(value))
    else:
        index_list("n_corners")(struct, field, value)


_UNIFORM: dict[str, Write] = {
    "flow": lambda struct, field, value: struct.put(field, flow_struct(value)),
    "start": nested,
    "base": one_index,
    "scheme": choice("SCHEME"),
    "boundary": choice("BOUNDARY"),
    "corners": _corners,
    "corner_angles": real_list(),
}


class Uniform(Kept):
    """A surface with its metric of constant curvature.

    Closed of genus 0: a convex polyhedron inscribed in the unit sphere. Others: the quotient of the plane or the hyperbolic plane by a
    deck group, with a layout about a base vertex. Points there are ambient coordinates (x, y, w); `ricci.models` converts them.

    Examples
    --------
    >>> ring = ricci.uniformize(ricci.make("flat_torus", a=0.2, b=1.5, n=8, m=8))
    >>> round(ring.summary.modulus.real, 6), round(ring.summary.modulus.imag, 6)
    (0.2, 1.5)
    """

    # The mesh that was uniformized, which is shown.
    _input: Mesh

    _type: ClassVar[str] = "uniform"
    _made_by: ClassVar[str] = "ricci.uniformize(mesh)"
    _figures: ClassVar[tuple[str, ...]] = ("genus", "space", "stop_reason", "iterations", "max_curvature_error", "modulus")

    def _come_from(self, found: Mapping[str, Any]) -> None:
        self._input = found["mesh"]

    def _sides(self) -> tuple[Any, ...]:
        """The surface and its image in the plane or the hyperbolic plane; of a sphere the given mesh and the unit sphere."""
        if self.summary.space != "s2":
            return self.layout()._sides()
        if not self._input.summary.has_positions:
            raise LayoutError("an intrinsic surface has no places in space that could be shown")
        return self._input.V, self._input.F, self.sphere_points(), np.arange(self._input.n_vertices), {}

    def _scene(self) -> Scene | None:
        if self.summary.space == "s2":
            sphere = self.sphere_mesh()
            return Scene(sphere.V, sphere.F)
        return self.layout()._scene()

    @cached_property
    def summary(self) -> UniformSummary:
        """Space, convergence, modulus, residuals."""
        return summary(UniformSummary, "uniform", self)

    @property
    def converged(self) -> bool:
        """True if the curvature is within the tolerance and, on a sphere, every edge is Delaunay."""
        return self.summary.converged

    @cached_property
    def metric(self) -> Metric:
        """The metric of constant curvature; of a quotient, and of a sphere that has flowed in S2, with the report of the flow."""
        return Metric._made(lib.ricci_uniform_metric, self)

    @cached_property
    def homotopy(self) -> Homotopy:
        """The homotopy basis whose loops generate the deck group."""
        return Homotopy._made(lib.ricci_uniform_homotopy, self)

    @cached_property
    def domain(self) -> Domain:
        """The layout as a fundamental domain."""
        return Domain._made(lib.ricci_uniform_domain, self)

    def layout(self, on: On = "refinement", model: Model = "poincare", progress: Progress = None) -> Layout:
        """The layout of a quotient about its base, on the common subdivision or on ``"metric"``, its own triangulation.

        Raises
        ------
        LayoutError
            a sphere, whose points are `sphere_points`; ``"input"``.
        """
        return Layout._made(lib.ricci_uniform_layout, self, constant("ON", on), constant("MODEL", model), CONTROL, progress=progress)

    @cached_property
    def sides(self) -> tuple[Indices, Doubles]:
        """The straight sides of the boundary: generator of the loop and first vertex; length and straightness (k x 2 each)."""
        n = self.summary.n_boundary_sides
        start, lengths = np.empty((n, 2), np.uint32), np.empty((n, 2))
        call(lib.ricci_uniform_sides, self, pointer(start), pointer(lengths), n)
        return frozen(start), frozen(lengths)

    @cached_property
    def polygon(self) -> tuple[Doubles, Doubles]:
        """The canonical polygon: k x 3 corners in ambient coordinates, and the angles inside."""
        n = self.summary.n_polygon
        corners, angles = np.empty((n, 3)), np.empty(n)
        call(lib.ricci_uniform_polygon, self, pointer(corners), pointer(angles), n)
        return frozen(corners), frozen(angles)

    def lift(self, path: npt.ArrayLike) -> Doubles:
        """The lift of an edge path of the basis's triangulation that starts at the base: (k + 1) x 3 ambient coordinates."""
        edges = _arrays.signed(path)
        return doubles(lib.ricci_uniform_lift, self, pointer(edges), edges.size, shape=(edges.size + 1, 3))

    def lift_loop(self, vertices: npt.ArrayLike, layout: Layout | None = None) -> tuple[Doubles, Signed]:
        """The lift of a closed loop through vertices of the given mesh, each joined to the next by an edge and the last to the first.

        Parameters
        ----------
        vertices : npt.ArrayLike
            the loop; the first may also be named again at the end.
        layout : Layout | None
            the layout on ``"refinement"``, if it is at hand; None: it is made.

        Returns
        -------
        tuple[Doubles, Signed]
            The points along the lift (k x 3 ambient coordinates), also where edges of the metric's triangulation cross the loop, and the
            word of the deck transformation that carries the first point to the last.
        """
        around = _arrays.indices(vertices)
        on = self.layout("refinement") if layout is None else layout
        n_points, n_letters = ffi.new("size_t *"), ffi.new("size_t *")

        def copy(points: Doubles, word: Any) -> None:
            given = (self, on, pointer(around), around.size, pointer(points), points.size, n_points, pointer(word), word.size, n_letters)
            call(lib.ricci_uniform_lift_loop, *given)

        call(lib.ricci_uniform_lift_loop, self, on, pointer(around), around.size, ffi.NULL, 0, n_points, ffi.NULL, 0, n_letters)
        points, word = np.empty((n_points[0] // 3, 3)), np.empty(n_letters[0], np.int32)
        copy(points, word)
        return points, word

    def sphere_points(self, model: Model = "ambient") -> Doubles:
        """The vertices of a sphere as unit vectors (n x 3), or in the plane under it (n x 2), infinite at the base.

        Raises
        ------
        LayoutError
            not a sphere; the plane under one that has flowed in S2.
        """
        shape = (self.metric.summary.n_vertices, 3 if model == "ambient" else 2)
        return doubles(lib.ricci_sphere_points, self, constant("MODEL", model), shape=shape)

    def sphere_mesh(self, on: On = "metric", progress: Progress = None) -> Mesh:
        """The polyhedron of a sphere as a mesh with unit vectors as positions."""
        return Mesh._made(lib.ricci_sphere_mesh, self, constant("ON", on), CONTROL, progress=progress)

    def __repr__(self) -> str:
        s = self.summary
        return f"<ricci.Uniform: genus {s.genus} in {s.space}, {s.stop_reason}>"


@takes(UniformOptions)
def uniformize(
    V: MeshLike,
    F: npt.ArrayLike | None = None,
    progress: Progress = None,
    *,
    flow: FlowOptions | None = None,
    start: Metric | None = None,
    base: int | None = None,
    scheme: Scheme = "yamabe",
    boundary: Literal["geodesic", "straight"] = "geodesic",
    corners: npt.ArrayLike | int | None = None,
    corner_angles: npt.ArrayLike | None = None,
) -> Uniform:
    """The metric of constant curvature in the conformal class of a surface, by its Euler characteristic.

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
        the result did not come to its metric; `summary` says why.

    Raises
    ------
    LayoutError
        geodesics around a disk.
    TargetError
        angles of corners that do not add up.

    Examples
    --------
    >>> ricci.uniformize(ricci.make("genus", genus=2, n=3))
    <ricci.Uniform: genus 2 in h2, converged>
    >>> ricci.uniformize(ricci.make("sphere", n=4)).sphere_points().shape
    (162, 3)
    """
    given = picked(locals(), UniformOptions)
    mesh = as_mesh(V, F)
    made = Uniform._made(lib.ricci_uniformize, mesh, options("uniform_options", given, _UNIFORM), CONTROL, progress=progress)
    made._input = mesh
    s = made.summary
    if not s.converged:
        warn(f"the uniformization did not converge ({s.stop_reason}), curvature error {s.angle_defect:.1e}: look at its `summary`")
    return made
