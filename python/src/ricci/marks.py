"""Landmarks of a surface: the vertices where its curvature is extreme, and those that are farthest from all others."""

from __future__ import annotations

import heapq
import operator
from typing import Literal

import numpy as np
import numpy.typing as npt

from ricci._call import Doubles, Indices
from ricci.adapters import MeshLike, as_mesh
from ricci.errors import ArgumentError, ArgumentTypeError
from ricci.mesh import Mesh

__all__ = ["landmarks"]

# The length over which curvature is averaged, in sides of a square with the surface's area.
_SCALE = 0.05
# An extreme counts if it differs from the mean curvature by this share of the mean of the absolute values: rounding and the mesh's own
# irregularities do not make landmarks of a round sphere.
_DISTINCT = 0.25
# Landmarks are at least so far apart, in sides of a square with the surface's area over their number.
_APART = 0.5


def landmarks(mesh: MeshLike, n: int, *, by: Literal["curvature", "distance"] = "curvature") -> Indices:
    """Vertices that stand out on a surface, as landmarks of `match`.

    First come the local extremes of the Gaussian curvature, averaged over a twentieth of the surface's size, those that differ most from
    the mean first; where there are fewer than n, the vertices follow that are farthest from all before. Of two surfaces of nearly the same
    shape they correspond in this order, whatever their meshes are, ``np.column_stack([landmarks(a, n), landmarks(b, n)])``, as long as no
    two extremes are equally distinct.

    Parameters
    ----------
    mesh : MeshLike
        a mesh of any kind (`as_mesh`) with positions.
    n : int
        how many.
    by : Literal["curvature", "distance"]
        ``"distance"``: only the most distinct extreme, then the farthest vertices.

    Returns
    -------
    Indices
        n vertices.

    Raises
    ------
    ArgumentError
        fewer than one, or more than there are vertices; a surface without positions.

    Examples
    --------
    >>> import numpy as np
    >>> mesh = ricci.make("ellipsoid", a=3, b=1, c=1, n=8)
    >>> sorted(np.round(mesh.V[ricci.landmarks(mesh, 2), 0]).tolist())
    [-3.0, 3.0]
    """
    surface = as_mesh(mesh)
    try:
        count = operator.index(n)
    except TypeError:
        raise ArgumentTypeError(f"n is {n!r}: a whole number is needed") from None
    if by not in ("curvature", "distance"):
        raise ArgumentError(f"by is {by!r}: curvature or distance")
    if not surface.summary.has_positions:
        raise ArgumentError("landmarks are of a surface with positions")
    if not 1 <= count <= surface.n_vertices:
        raise ArgumentError(f"n is {count}: from 1 to the {surface.n_vertices} vertices")
    area = _vertex_areas(surface)
    extremes, strengths = _extremes(surface, area)
    walk = _Distances(surface)
    least = _APART * np.sqrt(area.sum() / count)
    found: list[int] = []
    for vertex, strength in zip(extremes.tolist(), strengths.tolist(), strict=True):
        enough = len(found) == (count if by == "curvature" else 1)
        if enough or (found and (strength < _DISTINCT or walk.to[vertex] < least)):
            if enough or strength < _DISTINCT:
                break
            continue
        found.append(vertex)
        walk.start_at(vertex)
    while len(found) < count:
        found.append(int(np.argmax(walk.to)))
        walk.start_at(found[-1])
    return np.array(found, np.int32)


def _sides(mesh: Mesh) -> Doubles:
    """m x 3, the length of the side opposite each corner."""
    return np.stack([np.linalg.norm(mesh.V[mesh.F[:, (k + 1) % 3]] - mesh.V[mesh.F[:, (k + 2) % 3]], axis=1) for k in range(3)], axis=1)


def _face_areas(mesh: Mesh) -> Doubles:
    a, b = (mesh.V[mesh.F[:, k]] - mesh.V[mesh.F[:, 0]] for k in (1, 2))
    return np.asarray(np.linalg.norm(np.cross(a, b), axis=1) / 2)


def _vertex_areas(mesh: Mesh) -> Doubles:
    """A third of the area of the faces around every vertex."""
    return np.asarray(np.bincount(mesh.F.ravel(), np.repeat(_face_areas(mesh) / 3, 3), mesh.n_vertices), float)


def _defects(mesh: Mesh, sides: Doubles) -> Doubles:
    """The curvature of every vertex, radians: 2 pi minus the angles around it, pi minus them on the boundary."""
    whole = np.full(mesh.n_vertices, 2 * np.pi)
    for loop in mesh.boundary:
        whole[loop] = np.pi
    for k in range(3):
        a, b, c = sides[:, k], sides[:, (k + 1) % 3], sides[:, (k + 2) % 3]
        with np.errstate(all="ignore"):
            cosine = np.clip(np.nan_to_num((b * b + c * c - a * a) / (2 * b * c)), -1, 1)
        np.subtract.at(whole, mesh.F[:, k], np.arccos(cosine))
    return whole


def _extremes(mesh: Mesh, area: Doubles) -> tuple[npt.NDArray[np.intp], Doubles]:
    """The local extremes of the averaged curvature, most distinct first, and how distinct they are; the most distinct vertex at least."""
    sides, faces = _sides(mesh), _face_areas(mesh)
    tails, heads = (np.concatenate([mesh.F[:, (k + j) % 3] for k in range(3)]) for j in (1, 2))
    # Half the cotangent of the angle opposite each side.
    squares = sides**2
    tiny = np.finfo(float).tiny
    weights = np.concatenate([(squares.sum(1) - 2 * squares[:, k]) / np.maximum(8 * faces, tiny) for k in range(3)])
    # Negative weights, of obtuse angles, and those of needles would let the average swing over.
    weights = np.clip(weights, 0, 10)
    size = _SCALE**2 * area.sum()
    curvature = _averaged(_defects(mesh, sides), np.maximum(area, 1e-12 * area.mean()), size * weights, (tails, heads))
    mean = float(area @ curvature / area.sum())
    scale = float(area @ np.abs(curvature) / area.sum()) or 1.0
    highest, lowest = curvature.copy(), curvature.copy()
    for a, b in ((tails, heads), (heads, tails)):
        np.maximum.at(highest, a, curvature[b])
        np.minimum.at(lowest, a, curvature[b])
    strength = np.abs(curvature - mean) / scale
    is_extreme = ((curvature >= highest) & (curvature > mean)) | ((curvature <= lowest) & (curvature < mean))
    is_extreme[np.argmax(strength)] = True
    found = np.flatnonzero(is_extreme)
    found = found[np.argsort(-strength[found], kind="stable")]
    return found, strength[found]


def _averaged(totals: Doubles, area: Doubles, weights: Doubles, edges: tuple[Indices, Indices]) -> Doubles:
    """The density x with A x + L x = totals, L the Laplacian of the weights: totals spread by a step of heat flow; conjugate gradients."""
    tails, heads = edges
    n = len(area)

    def applied(x: Doubles) -> Doubles:
        flow = weights * (x[tails] - x[heads])
        return area * x + np.bincount(tails, flow, n) - np.bincount(heads, flow, n)

    diagonal = area + np.bincount(tails, weights, n) + np.bincount(heads, weights, n)
    x = np.zeros(n)
    rest = totals.copy()
    along = scaled = rest / diagonal
    size = float(rest @ scaled)
    end = 1e-16 * size
    for _ in range(2000):
        if size <= end:
            break
        image = applied(along)
        step = size / float(along @ image)
        x += step * along
        rest -= step * image
        scaled = rest / diagonal
        grown = float(rest @ scaled)
        along = scaled + grown / size * along
        size = grown
    return x


class _Distances:
    """The distance of every vertex along edges from the nearest of the vertices that it was started at."""

    def __init__(self, mesh: Mesh) -> None:
        self.to: Doubles = np.full(mesh.n_vertices, np.inf)
        ends = mesh.edges
        lengths = np.linalg.norm(mesh.V[ends[:, 0]] - mesh.V[ends[:, 1]], axis=1)
        tails, heads = np.concatenate([ends[:, 0], ends[:, 1]]), np.concatenate([ends[:, 1], ends[:, 0]])
        order = np.argsort(tails, kind="stable")
        self._heads = heads[order].tolist()
        self._lengths = np.concatenate([lengths, lengths])[order].tolist()
        self._starts = np.concatenate([[0], np.cumsum(np.bincount(tails, minlength=mesh.n_vertices))]).tolist()

    def start_at(self, vertex: int) -> None:
        """Take a further vertex into account: only what is nearer to it than to the earlier ones is visited."""
        to: list[float] = self.to.tolist()
        to[vertex] = 0.0
        queue = [(0.0, vertex)]
        while queue:
            distance, at = heapq.heappop(queue)
            if distance > to[at]:
                continue
            for k in range(self._starts[at], self._starts[at + 1]):
                there = distance + self._lengths[k]
                if there < to[self._heads[k]]:
                    to[self._heads[k]] = there
                    heapq.heappush(queue, (there, self._heads[k]))
        self.to = np.array(to)
