"""Deck transformations, Dirichlet domains and pieces of the universal cover."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any, ClassVar, Literal, TypeAlias, TypedDict, get_args

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._arrays import frozen
from ricci._call import (
    CONTROL,
    Complexes,
    Doubles,
    Handle,
    Indices,
    Signed,
    call,
    constant,
    doubles,
    filled,
    pointer,
    rows,
    signed_view,
    summary,
)
from ricci._library import ffi, lib
from ricci._shown import Scene
from ricci._signatures import picked, takes
from ricci._structs import Struct, Write, known, nested, number, options
from ricci.adapters import MeshLike
from ricci.control import Progress, stages
from ricci.errors import ArgumentError
from ricci.figures import DeckSummary, DirichletSummary
from ricci.figures.names import Model
from ricci.layouts import Layout
from ricci.models import from_ambient
from ricci.uniform import Uniform, uniformize

__all__ = ["Cover", "CoverOptions", "Deck", "DeckSpec", "Dirichlet", "cover", "deck", "dirichlet"]


Kind: TypeAlias = Literal["generators", "sides", "words", "depth", "within", "dirichlet_sides", "geodesics"]


class DeckSpec(TypedDict, total=False):
    """The deck transformations that are asked for.

    Attributes
    ----------
    kind : Kind
        ``"generators"``, ``"sides"`` of the layout, ``"words"``, all to a ``"depth"``, all ``"within"`` a radius,
        ``"dirichlet_sides"``, or an element of every class of closed ``"geodesics"`` up to a length.
    words : Sequence[npt.ArrayLike]
        those of ``"words"``, each a list of letters.
    dirichlet : Dirichlet
        for ``"within"`` and ``"dirichlet_sides"``, a domain of this surface.
    radius : float
        for ``"within"``: how far the centre may move; for ``"geodesics"``: the largest length.
    depth : int
        for ``"depth"``: most letters of a word.
    limit : int
        most elements that are looked at; 100,000.
    """

    kind: Kind
    words: Sequence[npt.ArrayLike]
    dirichlet: Dirichlet
    radius: float
    depth: int
    limit: int


def _words(struct: Struct, _: str, value: Any) -> None:
    letters, starts = _arrays.joined(value)
    struct.put("letters", letters)
    struct.put("n_letters", letters.size)
    struct.put("starts", starts)
    struct.put("n_words", len(starts) - 1)


_DECK: dict[str, Write] = {
    **dict.fromkeys(("kind", "radius", "depth", "limit"), number),
    "words": _words,
    "dirichlet": nested,
}
# Elements that are looked at for a piece of the universal cover where the caller names no limit.
LIMIT = 100_000


class Deck(Handle):
    """Deck transformations of a quotient, each as a word in the generators and as an isometry. They act from the left.

    Examples
    --------
    >>> curved = ricci.uniformize(ricci.make("genus", genus=2, n=3))
    >>> bool(ricci.deck(curved).lengths.min() > 0)
    True
    """

    _type: ClassVar[str] = "deck"
    _made_by: ClassVar[str] = "ricci.deck(uniform)"
    _figures: ClassVar[tuple[str, ...]] = ("space", "n_elements", "n_letters", "longest")

    @cached_property
    def summary(self) -> DeckSummary:
        """Counts."""
        return summary(DeckSummary, "deck", self)

    def __len__(self) -> int:
        return self.summary.n_elements

    @cached_property
    def words(self) -> list[Signed]:
        """The words of the elements, reduced: letters from 1, negative for inverses."""
        return rows(len(self), lib.ricci_deck_words, self)

    @cached_property
    def mobius(self) -> Complexes:
        """k x 2 x 2 complex matrices of z -> (a z + b)/(c z + d), in the Poincare disk or the plane."""
        return frozen(self._values("MOBIUS", 2, 2, 2).view(np.complex128)[..., 0])

    @cached_property
    def matrices(self) -> Doubles:
        """k x 3 x 3 matrices that act on ambient coordinates."""
        return frozen(self._values("MATRIX", 3, 3))

    @cached_property
    def traces(self) -> Doubles:
        """|trace| of the 2 x 2 matrices of determinant 1: 2 cosh(L/2) for a translation of length L in the hyperbolic plane."""
        return frozen(self._values("TRACE"))

    @cached_property
    def lengths(self) -> Doubles:
        """The translation lengths of the elements: lengths of the closed geodesics in their free homotopy classes."""
        return frozen(self._values("LENGTH"))

    @cached_property
    def powers(self) -> Doubles:
        """How often each closed geodesic runs around a shorter one on its line, else 1; known of ``"geodesics"`` alone."""
        return frozen(self._values("POWER"))

    def geodesic(self, element: int, progress: Progress = None) -> tuple[Signed, Doubles]:
        """The closed geodesic of an element on the given surface: per point a face, and k x 3 weights of the face's corners.

        The line is closed, and its first point is not repeated. Of a power it is run through once.

        Raises
        ------
        LayoutError
            a surface that is not hyperbolic, or the element of a loop that can be contracted.
        """
        n = ffi.new("size_t *")
        call(lib.ricci_deck_geodesic, self, element, CONTROL, ffi.NULL, 0, ffi.NULL, 0, n, progress=progress)
        faces, weights = np.empty(n[0], np.uint32), np.empty((n[0], 3))
        places = (pointer(faces), faces.size, pointer(weights), weights.size)
        call(lib.ricci_deck_geodesic, self, element, CONTROL, *places, n)
        return frozen(signed_view(faces)), frozen(weights)

    def apply(self, element: int, points: npt.ArrayLike) -> Doubles:
        """k x 3 points in ambient coordinates, moved by one element, computed in double-double precision."""
        array = _arrays.real(points, 3, "points")
        return doubles(lib.ricci_deck_apply, self, element, pointer(array), len(array), shape=array.shape)

    def _values(self, which: str, *shape: int) -> Any:
        return doubles(lib.ricci_deck_values, self, getattr(lib, f"RICCI_DECK_{which}"), shape=(len(self), *shape))


class Dirichlet(Handle):
    """The points of the universal cover that are nearer to a centre than to its images: a convex polygon.

    Examples
    --------
    >>> curved = ricci.uniformize(ricci.make("genus", genus=2, n=3))
    >>> polygon = ricci.dirichlet(curved)
    >>> polygon.corners.shape == (polygon.summary.n_sides, 3)
    True
    """

    _type: ClassVar[str] = "dirichlet"
    _made_by: ClassVar[str] = "ricci.dirichlet(uniform)"
    _figures: ClassVar[tuple[str, ...]] = ("space", "n_sides", "area", "radius")

    def _scene(self) -> Scene | None:
        # Sides are straight in the Klein disk, so that the polygon is a fan about a corner: it is convex.
        corners = from_ambient(self.corners, self.summary.space, "klein")
        fan = np.arange(1, len(corners) - 1)
        return Scene(corners, np.column_stack([np.zeros_like(fan), fan, fan + 1]))

    @cached_property
    def summary(self) -> DirichletSummary:
        """Area, radius, number of sides."""
        return summary(DirichletSummary, "dirichlet", self)

    @cached_property
    def corners(self) -> Doubles:
        """k x 3, ambient coordinates, counterclockwise: side k runs from corner k to the next one."""
        return frozen(doubles(lib.ricci_dirichlet_corners, self, shape=(self.summary.n_sides, 3)))

    @cached_property
    def partners(self) -> Signed:
        """The side with the inverse element, for every side."""
        return frozen(filled(lib.ricci_dirichlet_partners, self, out=np.empty(self.summary.n_sides, np.int32)))


class CoverOptions(TypedDict, total=False):
    """A piece of the universal cover: the neighbours of a copy, all copies to a depth, or all within a radius of the base.

    Attributes
    ----------
    depth : int
        most letters of a word in the generators; few of the copies with one letter share a side with the first one.
    radius : float
        how far the base may move.
    limit : int
        most elements that are looked at; 100,000.
    """

    depth: int
    radius: float
    limit: int


class Cover:
    """A piece of the universal cover: copies of a layout, moved by deck transformations.

    Attributes
    ----------
    uniform : Uniform
        the surface.
    layout : Layout
        the layout on the given surface (``"refinement"``), or on the metric's own triangulation.
    deck : Deck
        the deck transformation of every copy; the first is the identity.
    faces : Indices
        m x 3 indices of the points of a copy.

    Examples
    --------
    >>> piece = ricci.cover(ricci.make("torus", n=8), depth=1)
    >>> len(piece), piece.points(0).shape[1]
    (5, 2)
    """

    def __init__(self, uniform: Uniform, layout: Layout, deck: Deck) -> None:
        self.uniform, self.layout, self.deck = uniform, layout, deck
        self.faces: Indices = layout.corners("refinement")
        self._points = layout.points("ambient")

    def __len__(self) -> int:
        return len(self.deck)

    def points(self, copy: int, model: Model = "poincare") -> Doubles:
        """The points of one copy, k x 2, or k x 3 in ambient coordinates."""
        return from_ambient(self.deck.apply(copy, self._points), self.deck.summary.space, model)


@takes(DeckSpec)
def deck(
    uniform: Uniform,
    progress: Progress = None,
    *,
    kind: Kind = "generators",
    words: Sequence[npt.ArrayLike] | None = None,
    dirichlet: Dirichlet | None = None,
    radius: float | None = None,
    depth: int | None = None,
    limit: int | None = None,
) -> Deck:
    """Deck transformations of a quotient; by default the generators.

    Parameters
    ----------
    uniform : Uniform
        the surface, no sphere.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    LayoutError
        a sphere.
    ArgumentError
        more elements than `limit`.

    Examples
    --------
    >>> curved = ricci.uniformize(ricci.make("genus", genus=2, n=3))
    >>> len(ricci.deck(curved))
    4
    """
    spec = picked(locals(), DeckSpec)
    given = {"limit": LIMIT, **spec, "kind": constant("DECK", spec.get("kind", "generators"), get_args(Kind))}
    return Deck._made(lib.ricci_deck_new, uniform, options("deck_spec", given, _DECK), CONTROL, progress=progress)


def dirichlet(uniform: Uniform, centre: npt.ArrayLike | None = None, progress: Progress = None) -> Dirichlet:
    """The Dirichlet domain of a point in ambient coordinates; of the origin, where the base vertex is, if none is given.

    Parameters
    ----------
    uniform : Uniform
        the surface, no sphere.
    centre : npt.ArrayLike | None
        3 ambient coordinates.
    progress : Progress
        a `Control` or a callback.

    Examples
    --------
    >>> curved = ricci.uniformize(ricci.make("genus", genus=2, n=3))
    >>> round(ricci.dirichlet(curved).summary.area / 3.141592653589793, 6)
    4.0
    """
    point = None if centre is None else _arrays.real(centre)
    if point is not None and point.shape != (3,):
        raise ArgumentError(f"the centre has shape {point.shape}, (3,) is needed")
    return Dirichlet._made(lib.ricci_dirichlet_new, uniform, pointer(point), CONTROL, progress=progress)


@takes(CoverOptions)
def cover(
    V: MeshLike,
    F: npt.ArrayLike | None = None,
    progress: Progress = None,
    *,
    depth: int | None = None,
    radius: float | None = None,
    limit: int | None = None,
) -> Cover:
    """A piece of the universal cover of a surface that is no sphere; by default a copy and its neighbours, one across each of its sides.

    Parameters
    ----------
    V : MeshLike
        a `Uniform`, or positions with `F`, or a mesh of any kind (`as_mesh`), which is uniformized first.
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    progress : Progress
        a `Control` or a callback.

    Examples
    --------
    >>> piece = ricci.cover(ricci.make("genus", genus=2, n=3))
    >>> len(piece) == 1 + len({tuple(word) for word in ricci.deck(piece.uniform, kind="sides").words})
    True
    """
    given = picked(locals(), CoverOptions)
    known(given, CoverOptions.__annotations__)
    if "radius" in given and "depth" in given:
        raise ArgumentError("depth and radius: name one of them")
    # Most of the time goes into the flow, where there is one.
    parts = stages(progress, [0.3, 0.6, 1.0] if isinstance(V, Uniform) else [0.8, 0.85, 0.9, 1.0])
    uniform = V if isinstance(V, Uniform) else uniformize(V, F, next(parts))
    limit = given.get("limit", LIMIT)
    if "depth" not in given and "radius" not in given:
        across = {tuple(word.tolist()): None for word in deck(uniform, next(parts), kind="sides").words}
        across.pop((), None)
        found = deck(uniform, next(parts), kind="words", words=[(), *across])
    elif "radius" in given:
        domain = dirichlet(uniform, progress=next(parts))
        found = deck(uniform, next(parts), kind="within", dirichlet=domain, radius=given["radius"], limit=limit)
    else:
        next(parts)
        found = deck(uniform, next(parts), kind="depth", depth=given["depth"], limit=limit)
    return Cover(uniform, uniform.layout("refinement", progress=next(parts)), found)
