"""Sample surfaces of every topology, at any resolution, and changes of surfaces."""

from __future__ import annotations

from typing import Any, Literal, TypeAlias, TypedDict, Unpack

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._call import Complexes, constant, doubles, pointer
from ricci._library import lib
from ricci._structs import Struct, Write, number, options, real_list
from ricci.mesh import Mesh

__all__ = ["ChangeOptions", "ShapeOptions", "change", "hyperelliptic_periods", "make"]

Shape: TypeAlias = Literal[
    "sphere",
    "ellipsoid",
    "disk",
    "annulus",
    "torus",
    "genus",
    "knot",
    "flat_torus",
    "bolza",
    "one_vertex",
    "two_vertex",
    "two_triangles",
    "pants",
    "hyperelliptic",
]
Change: TypeAlias = Literal["punch", "grade", "caps", "needles", "noise", "invert"]


class ShapeOptions(TypedDict, total=False):
    """Sizes of a surface; `shapes.h` describes them for each shape.

    Attributes:
        genus: number of handles, at least 1.
        n: resolution.
        m: resolution in the other direction.
        a: first size.
        b: second size.
        c: third size.
        p: times around the axis, of a knot.
        q: times around the tube, of a knot.
        points: complex branch points, of a hyperelliptic surface.
    """

    genus: int
    n: int
    m: int
    a: float
    b: float
    c: float
    p: int
    q: int
    points: npt.ArrayLike


class ChangeOptions(TypedDict, total=False):
    """Arguments of a change; `shapes.h` describes them for each change.

    Attributes:
        vertex: a vertex.
        count: how many, or how often.
        amount: how much.
        seed: chooses what is random.
        centre: a point in space.
    """

    vertex: int
    count: int
    amount: float
    seed: int
    centre: npt.ArrayLike


def _pairs(points: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Complex numbers as rows of real and imaginary parts."""
    array = np.ascontiguousarray(points, dtype=np.complex128)
    return array.view(np.float64).reshape(-1, 2)


def _points(struct: Struct, field: str, value: Any) -> None:
    real_list(2, "n_points")(struct, field, _pairs(value))


def _centre(struct: Struct, field: str, value: Any) -> None:
    struct.put(field, [float(x) for x in _arrays.real(value)])


_SHAPE: dict[str, Write] = {**dict.fromkeys(ShapeOptions.__annotations__, number), "points": _points, "shape": number}
_CHANGE: dict[str, Write] = {**dict.fromkeys(ChangeOptions.__annotations__, number), "centre": _centre, "change": number}


def make(shape: Shape, **sizes: Unpack[ShapeOptions]) -> Mesh:
    """A sample surface: ``make("torus", a=2, b=1, n=48, m=24)``.

    Args:
        shape: which one; those from ``"flat_torus"`` on are intrinsic: gluings with lengths, without positions.
        sizes: as the shape uses them.
    """
    return Mesh._made(lib.ricci_make, options("shape", {**sizes, "shape": constant("SHAPE", shape)}, _SHAPE))


def change(mesh: Mesh, what: Change, **how: Unpack[ChangeOptions]) -> Mesh:
    """A changed copy of a surface in space, without its attributes: ``change(mesh, "punch", count=3)`` cuts three holes."""
    return Mesh._made(lib.ricci_change, mesh, options("change_spec", {**how, "change": constant("CHANGE", what)}, _CHANGE))


def hyperelliptic_periods(points: npt.ArrayLike) -> Complexes:
    """The g x g period matrix of the curve y^2 = (x - e_1) (x - e_2) ..., in some symplectic basis of cycles.

    Args:
        points: the finite branch points e_j, complex, all different: 2 g + 1, or 2 g + 2.
    """
    pairs = _pairs(points)
    genus = (len(pairs) - 1) // 2
    periods = doubles(lib.ricci_hyperelliptic_periods, pointer(pairs), len(pairs), shape=(genus, genus, 2))
    return periods.view(np.complex128)[..., 0]
