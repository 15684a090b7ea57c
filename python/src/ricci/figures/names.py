"""Names that stand for the constants of the headers: RICCI_SPACE_E2 is ``"e2"``."""

from __future__ import annotations

from typing import Literal, TypeAlias, get_args

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
Frame: TypeAlias = Literal["auto", "disk", "strip"]
FlattenStart: TypeAlias = Literal["conformal", "tutte", "untangled", "seamless", "coarse"]
FlattenStop: TypeAlias = Literal["converged", "rounding", "max_iterations", "barrier", "no_step", "unmet"]
StructureKind: TypeAlias = Literal["conformal", "spherical", "affine", "hyperbolic", "projective", "integer"]
LowerBound: TypeAlias = Literal["none", "periods", "moduli"]
Verdict: TypeAlias = Literal["good", "rough", "unlikely"]
On: TypeAlias = Literal["input", "metric", "refinement"]

# For a type of field the prefix of the constants that it stands for, and their names: other constants may have the same prefix.
CONSTANTS: dict[str, tuple[str, tuple[str, ...]]] = {
    "Space": ("SPACE", get_args(Space)),
    "Scheme": ("SCHEME", get_args(Scheme)),
    "Model": ("MODEL", get_args(Model)),
    "Stop": ("STOP", get_args(Stop)),
    "Frame": ("FRAME", get_args(Frame)),
    "FlattenStart": ("FLATTEN_FROM", get_args(FlattenStart)),
    "FlattenStop": ("FLATTEN", get_args(FlattenStop)),
    "LowerBound": ("LOWER", get_args(LowerBound)),
    "Verdict": ("VERDICT", get_args(Verdict)),
    "StructureKind": ("STRUCTURE", get_args(StructureKind)),
}
