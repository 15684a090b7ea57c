"""Invariants of conformal structures with bounds of their errors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, TypedDict

import numpy as np
import numpy.typing as npt

from ricci._arrays import frozen, indices, joined
from ricci._call import CONTROL, Complexes, Doubles, call, doubles, figures_of, pointer
from ricci._library import ffi, lib
from ricci._signatures import picked, takes
from ricci._structs import Write, above_zero, choice, options
from ricci.control import Progress
from ricci.covering import Deck
from ricci.errors import ArgumentError, ArgumentTypeError
from ricci.figures import BoundsSummary, DilatationBracket
from ricci.form import Forms
from ricci.matching import Matching
from ricci.mesh import Mesh
from ricci.uniform import Uniform

__all__ = [
    "BoundsOptions",
    "ModulusBounds",
    "PeriodBounds",
    "dilatation_bracket",
    "fenchel_nielsen",
    "modulus_bounds",
    "pants",
    "period_bounds",
]


class BoundsOptions(TypedDict, total=False):
    """Options of bounds of period matrices.

    Attributes
    ----------
    width : float
        the gap that is aimed at; 1e-3. ``math.inf`` takes the forms as they are.
    most_unknowns : int
        largest number of unknowns of a system; 4 for each vertex and 200,000 more.
    degree : Literal["quadratic", "linear"]
        the functions whose derivatives are added to forms: ``"quadratic"`` where that narrows most, or ``"linear"``.
    """

    width: float
    most_unknowns: int
    degree: Literal["quadratic", "linear"]


_BOUNDS: dict[str, Write] = {"width": above_zero, "most_unknowns": above_zero, "degree": choice("DEGREE")}


@dataclass(frozen=True)
class PeriodBounds:
    """The period matrix of a closed surface with a bound of its error.

    Attributes
    ----------
    matrix : Complexes
        the period matrix in the basis of the forms, genus x genus, symmetric.
    radius : Doubles
        genus x genus: the entries of the surface's period matrix are within these distances.
    summary : BoundsSummary
        the gap, the modulus of a torus, what it took.

    Examples
    --------
    >>> found = ricci.period_bounds(ricci.forms(ricci.make("torus", n=16)))
    >>> found.summary.gap <= 1e-3, found.matrix.shape
    (True, (1, 1))
    """

    matrix: Complexes
    radius: Doubles
    summary: BoundsSummary


@takes(BoundsOptions)
def period_bounds(
    forms: Forms,
    progress: Progress = None,
    *,
    width: float | None = None,
    most_unknowns: int | None = None,
    degree: Literal["quadratic", "linear"] = "quadratic",
) -> PeriodBounds:
    """The period matrix of a closed surface with a bound of its error, which is proven with the rounding of all numbers.

    It is true of the polyhedron with exactly the edge lengths of ``forms.mesh``. Where the gap is above `width`, forms are sought on finer
    triangulations.

    Parameters
    ----------
    forms : Forms
        the harmonic forms of a closed surface.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    LayoutError
        genus 0, or a boundary.
    SolverError
        nothing is proven.
    MeshError
        lengths more than 1e35 apart.

    Examples
    --------
    >>> basis = ricci.forms(ricci.make("genus", genus=2, n=4))
    >>> ricci.period_bounds(basis, width=1e-4).summary.reached
    True
    """
    given = picked(locals(), BoundsOptions)
    if not isinstance(forms, Forms):
        raise ArgumentTypeError(f"forms are those of ricci.forms(mesh), not {type(forms).__name__}")
    g = forms.summary.genus
    rows = np.empty((g, g, 3))
    out = ffi.new("ricci_bounds_summary *")
    size = ffi.sizeof("ricci_bounds_summary")
    struct = options("bounds_options", given, _BOUNDS)
    call(lib.ricci_forms_bounds, forms, struct, CONTROL, pointer(rows), rows.size, out, size, progress=progress)
    matrix = np.ascontiguousarray(rows[..., :2]).view(np.complex128)[..., 0]
    return PeriodBounds(frozen(matrix), frozen(np.ascontiguousarray(rows[..., 2])), figures_of(BoundsSummary, out))


@dataclass(frozen=True)
class ModulusBounds:
    """The modulus of an annulus or a quadrilateral between two bounds.

    Attributes
    ----------
    low : float
        the modulus is not below this number.
    high : float
        the modulus is not above this number.
    summary : BoundsSummary
        the figures of the torus of mirror images on which the bounds are proven.

    Examples
    --------
    >>> found = ricci.modulus_bounds(ricci.make("annulus", a=0.5, b=1.0))
    >>> bool(found.low <= found.high <= found.low * 1.003)
    True
    """

    low: float
    high: float
    summary: BoundsSummary


@takes(BoundsOptions)
def modulus_bounds(
    mesh: Mesh,
    corners: npt.ArrayLike | None = None,
    progress: Progress = None,
    *,
    width: float | None = None,
    most_unknowns: int | None = None,
    degree: Literal["quadratic", "linear"] = "quadratic",
) -> ModulusBounds:
    """Two proven bounds of the modulus of an annulus, or of a disk with four corners, for the polyhedron with exactly the given lengths.

    The modulus is height over base of the conformal image: of an annulus the distance of its loops over the length of one, of a disk the
    second side over the first, which starts at the first corner.

    Parameters
    ----------
    mesh : Mesh
        the surface.
    corners : npt.ArrayLike | None
        four vertices of the boundary of a disk; None for an annulus.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    ArgumentError
        another surface, or corners that are not four vertices of the boundary.
    SolverError
        nothing is proven.

    Examples
    --------
    >>> square = ricci.Mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> found = ricci.modulus_bounds(square, [0, 1, 2, 3])
    >>> bool(found.low <= 1 <= found.high)
    True
    """
    given = picked(locals(), BoundsOptions)
    if not isinstance(mesh, Mesh):
        raise ArgumentTypeError(f"a mesh is needed, not {type(mesh).__name__}")
    named = None if corners is None else indices(corners, name="corners")
    if named is not None and named.shape != (4,):
        raise ArgumentError(f"corners of shape {named.shape} are named: four are needed, or none")
    interval = np.empty(2)
    out = ffi.new("ricci_bounds_summary *")
    size = ffi.sizeof("ricci_bounds_summary")
    struct = options("bounds_options", given, _BOUNDS)
    at = ffi.NULL if named is None else pointer(named)
    call(lib.ricci_modulus_bounds, mesh, at, struct, CONTROL, pointer(interval), out, size, progress=progress)
    return ModulusBounds(float(interval[0]), float(interval[1]), figures_of(BoundsSummary, out))


@takes(BoundsOptions)
def dilatation_bracket(
    matching: Matching,
    corners: npt.ArrayLike | None = None,
    progress: Progress = None,
    *,
    width: float | None = None,
    most_unknowns: int | None = None,
    degree: Literal["quadratic", "linear"] = "quadratic",
) -> DilatationBracket:
    """A bracket of the least dilatation of maps in the class of a matching: by period matrices or moduli, and by the map.

    Parameters
    ----------
    matching : Matching
        the matching of two surfaces.
    corners : npt.ArrayLike | None
        4 x 2 vertices of the boundaries of disks, of source and target, that the maps of the class bring to each other.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    MatchingError
        triangles so thin that the order of their lines cannot be decided.

    Examples
    --------
    >>> square, long = ricci.make("flat_torus", n=4, m=4), ricci.make("flat_torus", b=3.0, n=4, m=4)
    >>> found = ricci.dilatation_bracket(ricci.match(square, long))
    >>> round(found.lower, 6), round(found.upper, 6), found.lower_by
    (3.0, 3.0, 'periods')
    """
    given = picked(locals(), BoundsOptions)
    if not isinstance(matching, Matching):
        raise ArgumentTypeError(f"a matching is what ricci.match(source, target) makes, not {type(matching).__name__}")
    named = None if corners is None else indices(corners, 2, "corners")
    if named is not None and len(named) != 4:
        raise ArgumentError(f"{len(named)} pairs of corners are named: four are needed, or none")
    out = ffi.new("ricci_dilatation_bracket *")
    size = ffi.sizeof("ricci_dilatation_bracket")
    struct = options("bounds_options", given, _BOUNDS)
    at = ffi.NULL if named is None else pointer(named)
    call(lib.ricci_matching_bracket, matching, at, struct, CONTROL, out, size, progress=progress)
    return figures_of(DilatationBracket, out)


def _n_curves(uniform: Uniform) -> int:
    if not isinstance(uniform, Uniform):
        raise ArgumentTypeError(f"a uniform is what ricci.uniformize(mesh) makes, not {type(uniform).__name__}")
    return max(uniform.summary.genus + uniform.summary.n_generators - 3, 0)


def fenchel_nielsen(uniform: Uniform, loops: Sequence[npt.ArrayLike] | None = None, progress: Progress = None) -> Doubles:
    """Fenchel-Nielsen coordinates of a hyperbolic surface of genus g with b boundary loops: 3 g - 3 + b rows of a length and a twist.

    The curves are a1, ..., ag, the commutators of ai and bi (in genus 2 without boundary the first alone; in genus 1 with one boundary loop
    none), and the products of the first i of commutators and boundary loops for i from 2 to g + b - 2: they cut the surface into pairs of
    pants.

    Parameters
    ----------
    uniform : Uniform
        the surface in its hyperbolic metric.
    loops : Sequence[npt.ArrayLike] | None
        loops to take for the generators a1, b1, ..., c1, ...: edge paths on the given mesh, edges numbered from 1, negative backwards.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    LayoutError
        another surface, or loops that are no canonical basis.
    ArgumentError
        loops that are no paths at one vertex.

    Examples
    --------
    >>> ricci.fenchel_nielsen(ricci.uniformize(ricci.make("genus", genus=3, n=3))).shape
    (6, 2)
    """
    shape = (_n_curves(uniform), 2)
    if loops is None:
        return doubles(lib.ricci_fenchel_nielsen, uniform, shape=shape)
    edges, starts = joined(loops)
    rows = np.empty(shape)
    arrays = (pointer(edges), pointer(starts), len(starts) - 1, CONTROL, pointer(rows), rows.size)
    call(lib.ricci_fenchel_nielsen_of_loops, uniform, *arrays, progress=progress)
    return frozen(rows)


def pants(deck: Deck, progress: Progress = None) -> Doubles:
    """Lengths and twists of curves of one's own that cut a hyperbolic surface into pairs of pants: geodesics of deck transformations.

    Without loops that cross the curves a twist is known modulo half of the length; it is that between -1/4 and 1/4 of it.

    Parameters
    ----------
    deck : Deck
        3 g - 3 + b elements, as of words.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    LayoutError
        curves that cross, are one, run along the boundary or several times around a loop, or can be contracted.

    Examples
    --------
    >>> two = ricci.uniformize(ricci.make("genus", genus=2, n=3))
    >>> ricci.pants(ricci.deck(two, kind="words", words=[[1], [3], [1, 2, -1, -2]])).shape
    (3, 2)
    """
    if not isinstance(deck, Deck):
        raise ArgumentTypeError(f"a deck is what ricci.deck(uniform) makes, not {type(deck).__name__}")
    rows = np.empty((len(deck), 2))
    call(lib.ricci_deck_pants, deck, CONTROL, pointer(rows), rows.size, progress=progress)
    return frozen(rows)
