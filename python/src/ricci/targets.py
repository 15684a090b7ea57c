"""Target curvatures, by rule or by value."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._library import lib
from ricci._structs import Struct
from ricci.errors import ArgumentError

__all__ = ["TargetLike"]

# What a flow takes as its target:
#   None, "default"    closed, genus 1 and more: uniform; sphere: four cones of pi; open: outer, with handles "auto:N" with
#                      N = |chi|, 4 to 64; in H2 and S2: uniform
#   "uniform"          the same curvature everywhere
#   "outer"            0 inside, the longest loop keeps its lengths, holes are filled: one piece without seams; genus 0
#   "outer:V"          the same with the loop through vertex V
#   "boundary"         0 inside, 2 pi chi shared over the boundary by length
#   "single:V"         all curvature at vertex V
#   "auto:N"           N cones placed by the library
#   {vertex: angle}    curvatures at these vertices, 0 at every other one
#   array of n         the curvature of every vertex, radians
TargetLike: TypeAlias = "str | Mapping[int, float] | npt.ArrayLike | None"


def _rule(struct: Struct, text: str) -> None:
    """A rule by its name, with a number behind a colon where it takes one."""
    kind, _, number = text.partition(":")
    plain = kind in ("default", "uniform", "outer", "boundary") and text == kind
    if not plain and not (kind in ("outer", "single", "auto") and number.isdecimal()):
        raise ArgumentError(f"target {text!r}: default, uniform, outer, outer:VERTEX, boundary, single:VERTEX or auto:COUNT")
    struct.put("kind", getattr(lib, f"RICCI_TARGET_{kind.upper()}"))
    if kind in ("single", "outer") and number:
        struct.put("n", 1)
        struct.put("vertices", _arrays.indices([int(number)]))
    elif kind == "auto":
        struct.put("n", int(number))


def target_struct(target: TargetLike) -> Struct:
    """The struct of a target.

    Raises
    ------
    ArgumentError
        a rule that there is not.
    """
    struct = Struct("target")
    if target is None:
        return struct
    if isinstance(target, str):
        _rule(struct, target)
        return struct
    cones = isinstance(target, Mapping)
    curvatures = _arrays.real(np.fromiter(target.values(), float, len(target)) if isinstance(target, Mapping) else target)
    struct.put("kind", lib.RICCI_TARGET_CONES if cones else lib.RICCI_TARGET_GIVEN)
    struct.put("n", curvatures.size)
    struct.put("curvatures", curvatures)
    if isinstance(target, Mapping):
        struct.put("vertices", _arrays.indices(list(target), name="vertices of the target"))
    return struct
