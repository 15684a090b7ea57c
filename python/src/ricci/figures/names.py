"""Names that stand for the constants of the headers: RICCI_SPACE_E2 is ``"e2"``."""

from __future__ import annotations

from typing import Literal, TypeAlias

Space: TypeAlias = Literal["e2", "h2", "s2"]
Scheme: TypeAlias = Literal["yamabe", "inversive", "thurston", "tangential", "virtual"]
Model: TypeAlias = Literal["poincare", "klein", "half_plane", "ambient"]
Stop: TypeAlias = Literal[
    "converged",
    "rounding_floor",
    "broken_triangles",
    "diverged",
    "stalled",
    "iteration_limit",
    "infeasible",
    "out_of_reach",
]
StructureKind: TypeAlias = Literal["conformal", "spherical", "affine", "hyperbolic", "projective"]
On: TypeAlias = Literal["input", "metric", "refinement"]

# The prefix of the constants that a type of field stands for.
PREFIXES = {"Space": "SPACE", "Scheme": "SCHEME", "Model": "MODEL", "Stop": "STOP", "StructureKind": "STRUCTURE"}
