"""Quad meshes of seamless metrics, and layouts of few four-sided patches."""

from __future__ import annotations

from functools import cached_property
from typing import Any, ClassVar, NamedTuple, TypedDict

import numpy as np

from ricci._arrays import frozen
from ricci._call import CONTROL, Doubles, Indices, call, constant, doubles, filled, pointer, rows, signed_view, summary
from ricci._kept import Kept
from ricci._library import lib
from ricci._shown import Scene
from ricci._signatures import picked, takes
from ricci._structs import Struct, Write, above_zero, number, options
from ricci.control import Progress
from ricci.errors import ArgumentError
from ricci.figures import QuadLayoutSummary, QuadsSummary
from ricci.seams import Seamless

__all__ = ["QuadLayout", "QuadPlaces", "Quads", "QuadsOptions", "quad_layout", "quads"]


class QuadsOptions(TypedDict, total=False):
    """Options of quad meshes and layouts: one size, and threads.

    Attributes
    ----------
    n_quads : int
        about this number of quads; 1,000 for a quad mesh. Of a layout they are its unit squares.
    edge : float
        edges of about this length, in the units of the surface's lengths.
    coarse : bool
        as few quads as the lines between cones allow; the default of a layout.
    at_most : int
        at most this number of quads, each side as near as that allows to its length on the surface.
    threads : int
        one for each core.
    """

    n_quads: int
    edge: float
    coarse: bool
    at_most: int
    threads: int


def _sized(sizing: str) -> Write:
    """A field that stands for one way in which the size of the quads is told."""

    def write(struct: Struct, field: str, value: Any) -> None:
        above_zero(struct, field, value)
        struct.put("sizing", constant("QUADS", sizing))

    return write


def _coarse(struct: Struct, field: str, value: Any) -> None:
    if not isinstance(value, bool | np.bool_):
        raise ArgumentError(f"{field} is {value!r}: it is True or False")
    if value:
        struct.put("sizing", constant("QUADS", "coarse"))


def _at_most(struct: Struct, field: str, value: Any) -> None:
    del field
    _sized("at_most")(struct, "n_quads", value)


_QUADS: dict[str, Write] = {"n_quads": _sized("number"), "edge": _sized("edge"), "coarse": _coarse, "at_most": _at_most, "threads": number}


def _options(given: QuadsOptions) -> Struct:
    struct = options("quads_options", given, _QUADS)
    sizes = [name for name in ("n_quads", "edge", "coarse", "at_most") if given.get(name) not in (None, False)]
    if len(sizes) > 1:
        raise ArgumentError(f"one size is needed, not {' and '.join(sizes)}")
    return struct


class QuadPlaces(NamedTuple):
    """Where the vertices of a quad mesh lie on the mesh from which it was made."""

    #: For each vertex a face that contains it.
    faces: Indices
    #: n x 3, its barycentric coordinates there.
    weights: Doubles


class Quads(Kept):
    """A mesh of quads on a surface. Every vertex that is no cone or corner has four quads, two on the boundary.

    Examples
    --------
    >>> made = ricci.quads(ricci.seamless(ricci.make("ellipsoid", n=8)), n_quads=200)
    >>> made.positions.shape == (made.summary.n_vertices, 3)
    True
    """

    _type: ClassVar[str] = "quads"
    _made_by: ClassVar[str] = "ricci.quads(ricci.seamless(mesh))"
    _figures: ClassVar[tuple[str, ...]] = ("n_quads", "n_vertices", "n_irregular", "n_creases", "angle_mean", "edge_mean")

    def _scene(self) -> Scene | None:
        halves = np.concatenate([self.F[:, [0, 1, 2]], self.F[:, [0, 2, 3]]])
        return Scene(self.positions, halves, np.tile(self.rectangles, 2) * 0.6180339887498949 % 1)

    @cached_property
    def summary(self) -> QuadsSummary:
        """Counts, topology, the shape of the quads."""
        return summary(QuadsSummary, "quads", self)

    @cached_property
    def F(self) -> Indices:
        """m x 4, the corners of each quad, counterclockwise seen from outside."""
        return frozen(filled(lib.ricci_quads_faces, self, out=np.empty((self.summary.n_quads, 4), np.uint32)))

    @cached_property
    def positions(self) -> Doubles:
        """n x 3, the vertices in space.

        Raises
        ------
        ArgumentError
            a surface without positions.
        """
        return frozen(doubles(lib.ricci_quads_positions, self, shape=(self.summary.n_vertices, 3)))

    @cached_property
    def places(self) -> QuadPlaces:
        """Where the vertices lie on the mesh from which the seamless metric was made."""
        n = self.summary.n_vertices
        faces, weights = np.empty(n, np.uint32), np.empty((n, 3))
        call(lib.ricci_quads_places, self, pointer(faces), faces.size, pointer(weights), weights.size)
        return QuadPlaces(frozen(signed_view(faces)), frozen(weights))

    @cached_property
    def creases(self) -> Indices:
        """k x 2, the edges on features and on the boundary, each by the vertices at its ends."""
        return frozen(filled(lib.ricci_quads_creases, self, out=np.empty((self.summary.n_creases, 2), np.uint32)))

    @cached_property
    def rectangles(self) -> Indices:
        """The rectangle of the T-mesh that each quad is a part of."""
        return frozen(filled(lib.ricci_quads_rectangles, self, out=np.empty(self.summary.n_quads, np.uint32)))


class QuadLayout(Kept):
    """A layout of four-sided patches, each a rectangle of quads.

    Examples
    --------
    >>> patches = ricci.quad_layout(ricci.seamless(ricci.make("ellipsoid", n=8)))
    >>> [len(sides) for sides in patches.sides] == [4] * patches.summary.n_patches
    True
    """

    _type: ClassVar[str] = "quad_layout"
    _made_by: ClassVar[str] = "ricci.quad_layout(ricci.seamless(mesh))"
    _figures: ClassVar[tuple[str, ...]] = ("n_nodes", "n_arcs", "n_patches", "n_units", "n_parts", "n_quads")

    def _scene(self) -> Scene | None:
        seen = self.quads._scene()
        return None if seen is None else seen._replace(values=np.tile(self.patches, 2) * 0.6180339887498949 % 1)

    @cached_property
    def summary(self) -> QuadLayoutSummary:
        """Counts."""
        return summary(QuadLayoutSummary, "quad_layout", self)

    @cached_property
    def quads(self) -> Quads:
        """The quad mesh under the patches, `summary.n_parts` edges to a unit of length."""
        return Quads._made(lib.ricci_quad_layout_quads, self)

    @cached_property
    def nodes(self) -> Indices:
        """One row for each node: the vertex of the quad mesh, the number of patches around it, 1 on features and the boundary."""
        return frozen(filled(lib.ricci_quad_layout_nodes, self, out=np.empty((self.summary.n_nodes, 3), np.uint32)))

    @cached_property
    def arcs(self) -> Indices:
        """One row for each arc: the nodes at both ends, the whole length, 1 on features and the boundary."""
        return frozen(filled(lib.ricci_quad_layout_arcs, self, out=np.empty((self.summary.n_arcs, 4), np.uint32)))

    @cached_property
    def arc_vertices(self) -> list[Indices]:
        """For each arc the vertices of the quad mesh along it, from its first node to its second."""
        return rows(self.summary.n_arcs, lib.ricci_quad_layout_arc_vertices, self, dtype=np.uint32)

    @cached_property
    def sides(self) -> list[list[Indices]]:
        """For each patch its four sides, counterclockwise: arc a as a + 1 in its direction, -(a + 1) against it."""
        all_sides = rows(4 * self.summary.n_patches, lib.ricci_quad_layout_sides, self)
        return [all_sides[k : k + 4] for k in range(0, len(all_sides), 4)]

    @cached_property
    def sizes(self) -> Indices:
        """One row for each patch: the lengths of its first and its second side; opposite sides have the same."""
        return frozen(filled(lib.ricci_quad_layout_sizes, self, out=np.empty((self.summary.n_patches, 2), np.uint32)))

    @cached_property
    def patches(self) -> Indices:
        """The patch of each quad of the quad mesh."""
        return frozen(filled(lib.ricci_quad_layout_patches, self, out=np.empty(self.summary.n_quads, np.uint32)))


@takes(QuadsOptions)
def quads(
    seamless: Seamless,
    progress: Progress = None,
    *,
    n_quads: int | None = None,
    edge: float | None = None,
    coarse: bool = False,
    at_most: int | None = None,
    threads: int | None = None,
) -> Quads:
    """The quad mesh of a seamless metric: about 1,000 quads, unless another size is given.

    Vertices lie on the surface, irregular ones at its cones alone; features and the boundary are chains of edges.

    Parameters
    ----------
    seamless : Seamless
        the seamless metric.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    ArgumentError
        more than one size, or one that is not positive.
    LayoutError
        the seamless metric is so far from its target that its seams do not turn by multiples of 90 degrees.

    Examples
    --------
    >>> made = ricci.quads(ricci.seamless(ricci.make("ellipsoid", n=8)), n_quads=200)
    >>> made.F.shape[1], made.summary.euler
    (4, 2)
    """
    given = picked(locals(), QuadsOptions)
    return Quads._made(lib.ricci_quads_new, seamless, _options(given), CONTROL, progress=progress)


@takes(QuadsOptions)
def quad_layout(
    seamless: Seamless,
    progress: Progress = None,
    *,
    n_quads: int | None = None,
    edge: float | None = None,
    coarse: bool = False,
    at_most: int | None = None,
    threads: int | None = None,
) -> QuadLayout:
    """The layout of a seamless metric: the patches of its coarsest quad mesh, unless another size is given.

    Patches lie between the lines of edges that go straight on from irregular vertices and from corners of features and the boundary.

    Parameters
    ----------
    seamless : Seamless
        the seamless metric.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    ArgumentError
        more than one size, or one that is not positive.
    LayoutError
        the seamless metric is so far from its target that its seams do not turn by multiples of 90 degrees.

    Examples
    --------
    >>> patches = ricci.quad_layout(ricci.seamless(ricci.make("ellipsoid", n=8)))
    >>> patches.summary.n_nodes - patches.summary.n_arcs + patches.summary.n_patches
    2
    """
    given = picked(locals(), QuadsOptions)
    return QuadLayout._made(lib.ricci_quad_layout_new, seamless, _options(given), CONTROL, progress=progress)
