"""Modes in which values are carried: labels that stay labels, numbers that are interpolated, and densities whose integrals stay."""

from __future__ import annotations

from typing import Any, Literal, NamedTuple, get_args

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._call import Doubles, Indices
from ricci.errors import ArgumentError, ArgumentTypeError

__all__ = ["Mode", "Pieces", "conserved", "heaviest", "mode_of"]

Mode = Literal["nearest", "linear", "conservative"]


def mode_of(values: npt.ArrayLike, asked: Mode | None) -> Mode:
    """The mode in which values are carried: what the caller asks for, else "nearest" for whole numbers and flags, "linear" for others.

    Raises
    ------
    ArgumentTypeError
        complex numbers, texts, objects; whole numbers that are to be averaged.
    ArgumentError
        there is no such mode.
    """
    if asked is not None and asked not in get_args(Mode):
        raise ArgumentError(f"mode {asked!r} is none of {', '.join(get_args(Mode))}")
    whole = _arrays.numbers(values).dtype.kind in "iub"
    if whole and asked not in (None, "nearest"):
        raise ArgumentTypeError(
            f"whole numbers are labels, which have no mean: {asked} takes them as numbers with a fraction, astype(float)"
        )
    return asked or ("nearest" if whole else "linear")


def heaviest(labels: npt.NDArray[Any], weights: Doubles) -> npt.NDArray[Any]:
    """For k points with three corners each the label with the largest sum of weights; of equal ones that of the earlier corner.

    Parameters
    ----------
    labels : npt.NDArray[Any]
        k x 3, or k x 3 x j for j labels at each corner.
    weights : Doubles
        k x 3 barycentric coordinates.
    """
    weights = weights.reshape(*weights.shape, *([1] * (labels.ndim - 2)))
    sums = np.stack([np.where(labels == labels[:, [corner]], weights, 0).sum(axis=1) for corner in range(3)], axis=1)
    best = sums.argmax(axis=1)
    return np.take_along_axis(labels, np.expand_dims(best, 1), axis=1)[:, 0]


class Pieces(NamedTuple):
    """The faces of a common subdivision as parts of the faces of one surface."""

    #: n x 3, the vertices of the surface.
    points: Doubles
    #: m x 3, its faces.
    faces: Indices
    #: The face that each piece is part of.
    parents: Indices
    #: k x 3 x 3 [piece, corner, corner of its face].
    weights: Doubles

    def at_corners(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Values at the vertices (n x j), interpolated at the corners of the pieces (k x 3 x j)."""
        return np.einsum("kpc,kcj->kpj", self.weights, values[self.faces[self.parents]])

    def piece_areas(self) -> Doubles:
        """The area of every piece on this surface."""
        return _areas(self.at_corners(self.points))

    def vertex_areas(self) -> Doubles:
        """A third of the area of the faces around every vertex."""
        out = np.zeros(len(self.points))
        for corner in self.faces.T:
            np.add.at(out, corner, _areas(self.points[self.faces]) / 3)
        return out


def _areas(corners: npt.NDArray[Any]) -> Doubles:
    return np.asarray(np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2)


def conserved(values: Doubles, given: Pieces, wanted: Pieces) -> Doubles:
    """Densities at the vertices of one surface as densities at those of the other one, whose integral is the same.

    On each piece the product of the density, which is linear there, and of a hat function of the other surface is integrated exactly; a
    vertex gets the sum over the pieces around it, divided by its share of the area.
    """
    columns = values.reshape(len(values), -1)
    density, hats = given.at_corners(columns), wanted.weights
    products = np.einsum("kj,kc->kcj", density.sum(1), hats.sum(1)) + np.einsum("kpj,kpc->kcj", density, hats)
    amounts = given.piece_areas()[:, None, None] / 12 * products
    out = np.zeros((len(wanted.points), columns.shape[1]))
    np.add.at(out, wanted.faces[wanted.parents], amounts)
    return np.asarray((out / wanted.vertex_areas()[:, None]).reshape(-1, *values.shape[1:]))
