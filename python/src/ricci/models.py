"""Points of the three spaces in other coordinates: ambient (x, y, w) from and to the models, as the layouts of `uniformize` have them.

The plane is (x, y, 1), the hyperbolic plane x^2 + y^2 - w^2 = -1 with w > 0, the sphere x^2 + y^2 + w^2 = 1.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ricci._call import Doubles
from ricci.errors import ArgumentError
from ricci.figures.names import Model, Space

__all__ = ["from_ambient", "from_hyperboloid", "to_hyperboloid", "to_plane", "to_sphere"]


def _columns(points: npt.ArrayLike, n: int) -> list[Doubles]:
    array = np.asarray(points, np.float64)
    if array.ndim == 0 or array.shape[-1] != n:
        raise ArgumentError(f"points have shape {array.shape}, ... x {n} is needed")
    return list(np.moveaxis(array, -1, 0))


def from_ambient(points: npt.ArrayLike, space: Space, model: Model = "poincare") -> Doubles:
    """Ambient coordinates (... x 3) in a model of their space (... x 2, or ... x 3 for ``"ambient"``)."""
    if model == "ambient":
        return np.asarray(points, np.float64)
    if space == "h2":
        return from_hyperboloid(points, model)
    return to_plane(points) if space == "s2" else np.stack(_columns(points, 3)[:2], -1)


def from_hyperboloid(points: npt.ArrayLike, model: Model = "poincare") -> Doubles:
    """Points (... x 3) of the hyperboloid in the Poincare disk, the Klein disk or the half-plane (... x 2)."""
    x, y, w = _columns(points, 3)
    if model == "ambient":
        return np.stack([x, y, w], -1)
    if model == "half_plane":
        # w - x without cancellation where x is positive.
        rest = np.where(x > 0, (1 + y * y) / (w + np.abs(x)), w - x)
        return np.stack([-y / rest, 1 / rest], -1)
    rest = 1 + w if model == "poincare" else w
    return np.stack([x / rest, y / rest], -1)


def to_hyperboloid(points: npt.ArrayLike, model: Model = "poincare") -> Doubles:
    """The points of the hyperboloid (... x 3) from their coordinates in a model (... x 2, or ambient ... x 3)."""
    x, y = _columns(points, 3 if model == "ambient" else 2)[:2]
    r = np.hypot(x, y)
    rest = (1 - r) * (1 + r)
    if model == "poincare":
        return np.stack([2 * x / rest, 2 * y / rest, (1 + r * r) / rest], -1)
    if model == "klein":
        w = 1 / np.sqrt(rest)
        return np.stack([x * w, y * w, w], -1)
    if model == "half_plane":
        total = (x * x + y * y) / y
        return np.stack([0.5 * (total - 1 / y), -x / y, 0.5 * (total + 1 / y)], -1)
    return np.stack([x, y, np.hypot(r, 1)], -1)


def to_plane(points: npt.ArrayLike) -> Doubles:
    """Unit vectors (... x 3) in the plane, seen from the south pole (... x 2): infinite for (0, 0, -1)."""
    x, y, w = _columns(points, 3)
    with np.errstate(divide="ignore", invalid="ignore"):
        rest = np.where(w >= 0, 1 + w, (x * x + y * y) / (1 - w))
        plane = np.stack([x / rest, y / rest], -1)
    return np.where((rest > 0)[..., None], plane, np.inf)


def to_sphere(points: npt.ArrayLike) -> Doubles:
    """The unit vectors (... x 3) over points of the plane (... x 2), the inverse of `to_plane`."""
    x, y = _columns(points, 2)
    r = np.hypot(x, y)
    with np.errstate(divide="ignore", invalid="ignore"):
        near = np.stack([2 * x, 2 * y, (1 - r) * (1 + r)], -1) / (1 + r * r)[..., None]
        q = 1 / r
        far = np.stack([2 * (x / r) * q, 2 * (y / r) * q, -(1 - q) * (1 + q)], -1) / (1 + q * q)[..., None]
    far = np.where(np.isinf(r)[..., None], [0.0, 0.0, -1.0], far)
    return np.where((r <= 1)[..., None], near, far)
