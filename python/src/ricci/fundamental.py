"""Fundamental groups: homotopy bases, words, lifts of paths, fundamental domains."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._arrays import frozen
from ricci._call import CONTROL, Handle, Indices, Longs, Signed, filled, pointer, rows, sized_list, summary, text_of
from ricci._library import ffi, lib
from ricci._structs import Struct
from ricci.adapters import MeshLike, as_mesh
from ricci.control import Progress
from ricci.figures import DomainSummary, HomotopySummary

__all__ = ["Domain", "Homotopy", "homotopy"]


class Homotopy(Handle):
    """Generators a1, b1, ..., ag, bg, c1, ..., cb of the fundamental group, with loops through one base vertex.

    The one relation is a1 b1 a1^-1 b1^-1 ... c1 ... cb = 1. A word is an array of letters: k for generator k (from 1), -k for its
    inverse; an edge path one of edge numbers from 1, negative against the edge.

    Examples
    --------
    >>> loops = ricci.homotopy(ricci.make("torus", n=8))
    >>> loops.intersections.tolist()
    [[0, 1], [-1, 0]]
    >>> loops.text(loops.parse("a1 b1 b1^-1"))
    'a1'
    """

    _type: ClassVar[str] = "homotopy"
    _made_by: ClassVar[str] = "ricci.homotopy(mesh)"
    _figures: ClassVar[tuple[str, ...]] = ("genus", "base", "n_generators", "n_boundary_loops", "n_relator", "n_loop_edges")

    @cached_property
    def summary(self) -> HomotopySummary:
        """Base, genus, counts."""
        return summary(HomotopySummary, "homotopy", self)

    @cached_property
    def loops(self) -> list[Signed]:
        """The edges of every generator's loop, from the base to the base."""
        return rows(self.summary.n_generators, lib.ricci_homotopy_loops, self)

    @cached_property
    def intersections(self) -> Longs:
        """The intersection numbers [i, j]: crossings of loop i by loop j from right to left, minus those from left to right."""
        n = self.summary.n_generators
        return frozen(filled(lib.ricci_homotopy_intersections, self, out=np.empty((n, n), np.int64)))

    def tree_path(self, vertex: int) -> Signed:
        """The tree path from the base to a vertex, along which lifts are named."""
        return sized_list(lib.ricci_homotopy_tree_path, self, vertex)

    def path_word(self, path: npt.ArrayLike) -> Signed:
        """The element of an edge path, closed up along the tree; empty if and only if the loop can be contracted."""
        edges = _arrays.signed(path)
        return sized_list(lib.ricci_homotopy_path_word, self, pointer(edges), edges.size)

    def reduce(self, word: npt.ArrayLike) -> Signed:
        """A shorter word of the same element, empty if and only if it is the identity."""
        letters = _arrays.signed(word, "word")
        return sized_list(lib.ricci_homotopy_reduce, self, pointer(letters), letters.size)

    def homology(self, word: npt.ArrayLike) -> Longs:
        """The sum of each generator's exponents; with boundary the last c counts as minus the sum of the others."""
        letters = _arrays.signed(word, "word")
        n = self.summary.n_generators - (self.summary.n_boundary_loops > 0)
        return filled(lib.ricci_homotopy_homology, self, pointer(letters), letters.size, out=np.empty(n, np.int64))

    def text(self, word: npt.ArrayLike) -> str:
        """A word as text, ``"a1 b1 a1^-1"``; the empty word is ``"1"``."""
        letters = _arrays.signed(word, "word")
        return text_of(lib.ricci_homotopy_word_text, self, pointer(letters), letters.size)

    def parse(self, text: str) -> Signed:
        """The word of a text like ``"a1 b1 a1^-1"``, freely reduced."""
        return sized_list(lib.ricci_homotopy_word_parse, self, text.encode())

    def lift(self, vertex: int, path: npt.ArrayLike, element: npt.ArrayLike = ()) -> list[Signed]:
        """The lift of an edge path to the universal cover: the deck transformation of its start, then of the end of each edge.

        Parameters
        ----------
        vertex : int
            where the path starts.
        path : npt.ArrayLike
            its edges.
        element : npt.ArrayLike
            the word of the lift that it starts at; the identity.
        """
        edges, letters = _arrays.signed(path), _arrays.signed(element, "element")
        struct = Struct("lift")
        struct.put("vertex", vertex)
        for name, array in (("path", edges), ("element", letters)):
            struct.put(name, array)
            struct.put(f"n_{name}", array.size)
        return rows(edges.size + 1, lib.ricci_homotopy_lift, self, struct)

    def domain(self, cut: npt.ArrayLike | None = None) -> Domain:
        """The fundamental domain of a cut.

        Parameters
        ----------
        cut : npt.ArrayLike | None
            edges, from 0, that open the surface into a disk; None for those of the basis's own polygon.
        """
        edges = None if cut is None else _arrays.indices(cut)
        return Domain._made(lib.ricci_domain_new, self, pointer(edges), 0 if edges is None else edges.size)


class Domain(Handle):
    """A surface opened along a cut into a disk, lifted to the universal cover: a polygon whose sides are paired.

    Examples
    --------
    >>> ricci.homotopy(ricci.make("genus", genus=2, n=3)).domain().summary.n_sides
    12
    """

    _type: ClassVar[str] = "domain"
    _made_by: ClassVar[str] = "ricci.homotopy(mesh).domain()"
    _figures: ClassVar[tuple[str, ...]] = ("n_sides", "n_side_edges", "n_side_letters", "n_corner_letters", "base_edge")

    @cached_property
    def summary(self) -> DomainSummary:
        """Counts."""
        return summary(DomainSummary, "domain", self)

    @cached_property
    def sides(self) -> list[Signed]:
        """The edges of every side, counterclockwise: the domain lies on their left."""
        return rows(self.summary.n_sides, lib.ricci_domain_sides, self)

    @cached_property
    def partners(self) -> Signed:
        """The side with the same edges, run through the other way; -1 on the boundary of the surface."""
        return frozen(filled(lib.ricci_domain_partners, self, out=np.empty(self.summary.n_sides, np.int32)))

    @cached_property
    def elements(self) -> list[Signed]:
        """The deck transformation of every side: it carries the domain onto its neighbour there."""
        return rows(self.summary.n_sides, lib.ricci_domain_elements, self)

    @cached_property
    def corners(self) -> tuple[Indices, Sequence[Signed]]:
        """The lifts at which the sides start: vertices, and deck transformations."""
        vertices = np.empty(self.summary.n_sides, np.uint32)
        words = rows(len(vertices), lib.ricci_domain_corners, self, pointer(vertices), vertices.size)
        return frozen(vertices), words


def homotopy(V: MeshLike, F: npt.ArrayLike | None = None, *, base: int | None = None, progress: Progress = None) -> Homotopy:
    """A canonical homotopy basis of a mesh, with short loops. The surface may have boundary.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`).
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    base : int | None
        the base vertex; None for one from which the loops are short.
    progress : Progress
        a `Control` or a callback.

    Examples
    --------
    >>> loops = ricci.homotopy(ricci.make("genus", genus=2, n=3))
    >>> loops.text(loops.path_word(loops.loops[0]))
    'a1'
    """
    at = ffi.NULL if base is None else pointer(_arrays.index(base, "base"))
    return Homotopy._made(lib.ricci_homotopy_new, as_mesh(V, F), at, CONTROL, progress=progress)
