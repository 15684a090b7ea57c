"""Teichmüller distances between all pairs of some surfaces, between bounds, and maps of them by classical scaling."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ricci._call import Doubles
from ricci.control import Progress
from ricci.errors import ArgumentError
from ricci.form import forms
from ricci.matching import match
from ricci.mesh import Mesh
from ricci.moduli import dilatation_bracket, modulus_bounds, period_bounds

__all__ = ["ModuliDistances", "classical_scaling", "moduli_distances"]


@dataclass(frozen=True)
class ModuliDistances:
    """Bounds of the Teichmüller distances of all pairs of surfaces, half of the logarithm of the least dilatation of maps between them.

    Attributes
    ----------
    lower : Doubles
        n x n, symmetric: no distance is smaller.
    upper : Doubles
        n x n, symmetric: no distance is larger.

    Examples
    --------
    >>> import numpy as np
    >>> tori = [ricci.make("flat_torus", b=b, n=4, m=4) for b in (1.0, 2.0)]
    >>> found = ricci.moduli_distances(tori)
    >>> bool(found.lower[0, 1] <= np.log(2) / 2 <= found.upper[0, 1])
    True
    """

    lower: Doubles
    upper: Doubles


def _pairs(n: int, of: Callable[[int, int], tuple[float, float]]) -> ModuliDistances:
    lower, upper = np.zeros((n, n)), np.zeros((n, n))
    for i, j in itertools.combinations(range(n), 2):
        lower[i, j], upper[i, j] = of(i, j)
    return ModuliDistances(lower + lower.T, upper + upper.T)


def _modular_images(tau: complex) -> list[complex]:
    """Images of a reduced modulus by elements of the modular group, those nearest to the fundamental domain among them."""
    size = range(-3, 4)
    words = (w for w in itertools.product(size, size, size, size) if w[0] * w[3] - w[1] * w[2] == 1)
    return [(a * tau + b) / (c * tau + d) for a, b, c, d in words]


def _hyperbolic(z: complex, w: complex) -> float:
    return float(2 * np.arcsinh(abs(z - w) / (2 * np.sqrt(z.imag * w.imag))))


def _of_tori(meshes: Sequence[Mesh], width: float | None) -> ModuliDistances:
    bounds = [period_bounds(forms(mesh), width=width).summary for mesh in meshes]

    def of(i: int, j: int) -> tuple[float, float]:
        middle = min(_hyperbolic(bounds[i].modulus, w) for w in _modular_images(bounds[j].modulus))
        blur = np.log1p(bounds[i].gap) + np.log1p(bounds[j].gap)
        return max(0.0, 0.5 * (middle - blur)), 0.5 * (middle + blur)

    return _pairs(len(meshes), of)


def _of_annuli(meshes: Sequence[Mesh], width: float | None) -> ModuliDistances:
    bounds = [modulus_bounds(mesh, width=width) for mesh in meshes]

    def of(i: int, j: int) -> tuple[float, float]:
        a, b = bounds[i], bounds[j]
        least = max(0.0, np.log(a.low / b.high), np.log(b.low / a.high))
        return 0.5 * float(least), 0.5 * float(max(np.log(a.high / b.low), np.log(b.high / a.low)))

    return _pairs(len(meshes), of)


def moduli_distances(
    meshes: Sequence[Mesh],
    width: float | None = None,
    progress: Progress = None,
    loops: Sequence[Sequence[npt.ArrayLike]] | None = None,
) -> ModuliDistances:
    """Bounds of the Teichmüller distances between all pairs of surfaces of one topology.

    Of tori and annuli they are those of their moduli, over all maps that keep orientation. Of closed surfaces of higher genus they are
    those of the class of maps that `match` finds, each pair matched once, or of that which brings the `loops` of surfaces to each other:
    the upper bound is the dilatation of its map, the lower one that of period matrices in its class.

    Parameters
    ----------
    meshes : Sequence[Mesh]
        the surfaces.
    width : float | None
        largest relative width of moduli and period matrices; 1e-3.
    progress : Progress
        a `Control` or a callback, of matchings.
    loops : Sequence[Sequence[npt.ArrayLike]] | None
        per surface the edge paths that mark it, as `make_loops` has them and ``match(basis=...)`` takes them.

    Raises
    ------
    ArgumentError
        surfaces of several topologies, or of one without a distance here.
    MatchingError
        two surfaces for which no map was found.

    Examples
    --------
    >>> rings = [ricci.make("annulus", a=a) for a in (0.3, 0.5)]
    >>> found = ricci.moduli_distances(rings)
    >>> bool(found.lower[0, 1] > 0.2)
    True
    """
    kinds = {(mesh.genus, mesh.summary.n_boundary_loops) for mesh in meshes}
    if len(kinds) > 1:
        raise ArgumentError(f"surfaces of {len(kinds)} topologies (genus, boundary loops): {sorted(kinds)}; one is needed")
    if kinds <= {(1, 0)}:
        return _of_tori(meshes, width)
    if kinds == {(0, 2)}:
        return _of_annuli(meshes, width)
    if any(loops > 0 or genus == 0 for genus, loops in kinds):
        raise ArgumentError("distances are known of annuli and closed surfaces of genus 1 and more")

    def of(i: int, j: int) -> tuple[float, float]:
        basis = None if loops is None else list(zip(loops[i], loops[j], strict=True))
        found = dilatation_bracket(match(meshes[i], meshes[j], progress, basis=basis), width=width)
        return 0.5 * float(np.log(found.lower)), 0.5 * float(np.log(found.upper))

    return _pairs(len(meshes), of)


def classical_scaling(distances: Doubles, dimension: int = 2) -> Doubles:
    """Points whose distances are near given ones: the leading eigenvectors of the doubly centred squares.

    Parameters
    ----------
    distances : Doubles
        n x n, symmetric.
    dimension : int
        number of coordinates.

    Examples
    --------
    >>> import numpy as np
    >>> line = np.abs(np.subtract.outer([0.0, 1.0, 3.0], [0.0, 1.0, 3.0]))
    >>> bool(np.allclose(np.abs(np.diff(ricci.classical_scaling(line, 1)[:, 0])), [1, 2]))
    True
    """
    squares = np.asarray(distances, dtype=float) ** 2
    if squares.ndim != 2 or squares.shape[0] != squares.shape[1]:
        raise ArgumentError(f"distances have shape {squares.shape}, n x n is needed")
    centred = -0.5 * (squares - squares.mean(0) - squares.mean(1)[:, None] + squares.mean())
    values, vectors = np.linalg.eigh(0.5 * (centred + centred.T))
    order = np.argsort(values)[::-1][:dimension]
    points: Doubles = vectors[:, order] * np.sqrt(np.maximum(values[order], 0))
    return points
