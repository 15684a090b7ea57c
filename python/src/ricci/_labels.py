"""Labels that are carried from one triangulation to another: a point gets the label that has the most of its face's weight there."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._call import Doubles

__all__ = ["are_labels", "heaviest"]


def are_labels(values: npt.ArrayLike, asked: bool | None) -> bool:
    """True if values are carried as labels: what the caller asks for, else whole numbers and flags are.

    Raises
    ------
    ArgumentTypeError
        complex numbers, texts, objects.
    """
    kind = _arrays.numbers(values).dtype.kind
    return kind in "iub" if asked is None else asked


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
