"""Sample surfaces of every topology, at any resolution, and changes of surfaces."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, TypeAlias, TypedDict

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._call import Complexes, Signed, constant, doubles, pointer, rows
from ricci._library import lib
from ricci._signatures import picked, takes
from ricci._structs import Struct, Write, known, number, options, real_list
from ricci.errors import ArgumentError, ArgumentTypeError
from ricci.mesh import Mesh

__all__ = ["ChangeOptions", "ShapeOptions", "change", "hyperelliptic_periods", "make", "make_loops"]

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
    "fenchel_nielsen",
]
Change: TypeAlias = Literal["punch", "grade", "caps", "needles", "noise", "invert"]


class ShapeOptions(TypedDict, total=False):
    """Sizes of a surface; `make` says which ones a shape has. Left out: as the command `ricci make` has them.

    Attributes
    ----------
    genus : int
        number of handles, at least 1.
    n : int
        resolution.
    m : int
        resolution in the other direction.
    a : float
        first size.
    b : float
        second size.
    c : float
        third size.
    p : int
        times around the axis, of a knot.
    q : int
        times around the tube, of a knot.
    points : npt.ArrayLike
        complex branch points, of a hyperelliptic surface; lengths and twists as length + 1j * twist, of glued pairs of pants.
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
    """Arguments of a change; `change` says which ones it needs.

    Attributes
    ----------
    vertex : int
        a vertex.
    count : int
        how many, or how often.
    amount : float
        how much.
    seed : int
        chooses what is random.
    centre : npt.ArrayLike
        a point in space.
    """

    vertex: int
    count: int
    amount: float
    seed: int
    centre: npt.ArrayLike


# The sizes that the command `ricci make` has where none are given.
_DEFAULTS: dict[str, dict[str, Any]] = {
    "sphere": {"n": 16},
    "ellipsoid": {"a": 3.0, "b": 2.0, "c": 1.0, "n": 16},
    "disk": {"n": 24},
    "annulus": {"a": 0.3, "b": 1.0, "n": 16},
    "torus": {"a": 2.0, "b": 1.0, "n": 64},
    "genus": {"genus": 2, "n": 6},
    "knot": {"p": 2, "q": 3, "a": 2.0, "b": 0.9, "c": 0.4, "n": 240},
    "flat_torus": {"a": 0.0, "b": 1.0, "n": 16, "m": 16},
    "bolza": {"n": 3},
    "one_vertex": {"genus": 2},
    "two_vertex": {"genus": 2},
    "pants": {"a": 1.0, "b": 2.0, "c": 3.0, "n": 4},
    "hyperelliptic": {"n": 16, "points": [np.exp(1j * np.pi * k / 3) for k in range(6)]},
    "fenchel_nielsen": {"genus": 2, "n": 2, "points": [2.0, 2.0, 2.0]},
}
# What a change needs to be told.
_NEEDS: dict[str, tuple[str, ...]] = {
    "punch": ("count",),
    "grade": ("vertex", "count"),
    "caps": ("count", "amount"),
    "needles": ("count", "amount"),
    "noise": ("amount",),
    "invert": ("centre", "amount"),
}


def _around(shape: str, sizes: Mapping[str, Any]) -> int:
    """The number of vertices around for which triangles are nearly equilateral, at least 3."""
    a, b, n = sizes["a"], sizes["b"], sizes["n"]
    if shape == "torus":
        vertices = n * b / a
    elif shape == "annulus":
        vertices = 2 * np.pi * np.sqrt(0.75) * n / np.log(b / a)
    else:
        # The length of a knot: p turns around the axis and q around the tube, at right angles.
        vertices = n * sizes["c"] / np.hypot(sizes["p"] * a, sizes["q"] * b)
    return int(np.clip(np.floor(vertices + 0.5), 3, 1e6)) if np.isfinite(vertices) else 3


def _sizes(shape: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """The sizes of a shape, with defaults for those that are not given."""
    told = {name: value for name, value in given.items() if value is not None}
    sizes = {**_DEFAULTS.get(shape, {}), **told}
    if shape == "genus" and told.get("a") == 0:
        raise ArgumentError("a is 0: the first hole is a times as wide as the last, above 0")
    if shape in ("torus", "annulus", "knot") and "m" not in sizes:
        with np.errstate(all="ignore"):
            sizes["m"] = _around(shape, {name: _arrays.real(value, name=name)[0] for name, value in sizes.items()})
    return sizes


def _pairs(points: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Complex numbers as rows of real and imaginary parts."""
    array = np.asarray(points)
    if array.dtype.kind not in "biufc" or array.ndim != 1:
        what = "texts" if array.dtype.kind in "US" else f"{array.dtype} of shape {array.shape}"
        raise ArgumentTypeError(f"points are {what}: a list of complex numbers is needed")
    return np.ascontiguousarray(array, dtype=np.complex128).view(np.float64).reshape(-1, 2)


def _points(struct: Struct, field: str, value: Any) -> None:
    real_list(2, "n_points")(struct, field, _pairs(value))


def _centre(struct: Struct, field: str, value: Any) -> None:
    struct.put(field, [float(x) for x in _arrays.real(value)])


_SHAPE: dict[str, Write] = {**dict.fromkeys(ShapeOptions.__annotations__, number), "points": _points, "shape": number}
_CHANGE: dict[str, Write] = {**dict.fromkeys(ChangeOptions.__annotations__, number), "centre": _centre, "change": number}


@takes(ShapeOptions)
def make(
    shape: Shape,
    *,
    genus: int | None = None,
    n: int | None = None,
    m: int | None = None,
    a: float | None = None,
    b: float | None = None,
    c: float | None = None,
    p: int | None = None,
    q: int | None = None,
    points: npt.ArrayLike | None = None,
) -> Mesh:
    """A sample surface: ``make("torus")``, or ``make("torus", a=2, b=1, n=48, m=24)``.

    Parameters
    ----------
    shape : Shape
        which one, with the sizes that it has:

        - ``"sphere"``: n. An icosahedron with each edge cut into n, on the unit sphere.
        - ``"ellipsoid"``: a, b, c, n. The sphere scaled along x, y, z.
        - ``"disk"``: n. A centre and n rings in the plane.
        - ``"annulus"``: a, b, n, m. Inner and outer radius, steps outwards in geometric progression, vertices around.
        - ``"torus"``: a, b, n, m. Radii of the centre circle and of the tube, vertices around the axis and around the tube.
        - ``"genus"``: genus, a, n. Handles in a row, the first hole a times as wide as the last, n layers over a quarter of the tube.
        - ``"knot"``: p, q, a, b, c, n, m. A tube of radius c around the curve that goes p times around the axis and q times around the
          tube of a torus of radii a and b; n cross-sections, m vertices around.

        These are intrinsic, gluings with lengths without positions:

        - ``"flat_torus"``: a, b, n, m. Periods 1 and a + i b, of n x m parallelograms.
        - ``"bolza"``: n. The regular hyperbolic octagon with opposite sides glued, every triangle cut into four n times.
        - ``"one_vertex"``, ``"two_vertex"``: genus. A regular polygon with its sides glued, cut by diagonals or from its centre.
        - ``"two_triangles"``. Glued along their sides.
        - ``"pants"``: a, b, c, n. The hyperbolic surface with three geodesic boundaries of these lengths.
        - ``"hyperelliptic"``: points, n. The double cover of the round sphere branched over these points; 40 n^2 faces.
        - ``"fenchel_nielsen"``: genus, points, n. The hyperbolic surface of glued pairs of pants, with length + 1j * twist of each of the
          3 g - 3 + b curves of `fenchel_nielsen`, then the lengths of b boundary loops.

    Examples
    --------
    >>> ricci.make("genus", genus=3)
    <ricci.Mesh: 4604 vertices, 9216 faces, genus 3, 0 boundary loops>
    >>> ricci.make("flat_torus", a=0.5, b=1.2, n=8, m=8)
    <ricci.Mesh: 64 vertices, 128 faces, genus 1, 0 boundary loops>
    """
    sizes = picked(locals(), ShapeOptions)
    number_of = constant("SHAPE", shape)
    known(sizes, ShapeOptions.__annotations__)
    return Mesh._made(lib.ricci_make, options("shape", {**_sizes(shape, sizes), "shape": number_of}, _SHAPE))


def make_loops(genus: int = 2, points: npt.ArrayLike = (2.0, 2.0, 2.0), n: int = 2) -> list[Signed]:
    """The loops a1, b1, ..., c1, ... that the coordinates of ``make("fenchel_nielsen", genus=genus, points=points, n=n)`` belong to.

    They are edge paths that start and end at vertex 0: edges numbered from 1, negative backwards.

    Parameters
    ----------
    genus : int
        number of handles.
    points : npt.ArrayLike
        length + 1j * twist of each curve, then the lengths of boundary loops.
    n : int
        times that every triangle is cut into four.

    Examples
    --------
    >>> points = [2 + 0.5j, 3 + 1j, 2.5 - 0.2j]
    >>> surface, loops = ricci.make("fenchel_nielsen", points=points), ricci.make_loops(points=points)
    >>> ricci.fenchel_nielsen(ricci.uniformize(surface), loops).round(9).tolist()
    [[2.0, 0.5], [3.0, 1.0], [2.5, -0.2]]
    """
    sizes = {"genus": genus, "points": points, "n": n, "shape": constant("SHAPE", "fenchel_nielsen")}
    struct = options("shape", sizes, _SHAPE)
    n_curves = len(_pairs(points))
    n_generators = 2 * genus + max(n_curves + 3 - 3 * genus, 0) // 2
    return rows(n_generators, lib.ricci_make_loops, struct)


@takes(ChangeOptions)
def change(
    mesh: Mesh,
    what: Change,
    *,
    vertex: int | None = None,
    count: int | None = None,
    amount: float | None = None,
    seed: int | None = None,
    centre: npt.ArrayLike | None = None,
) -> Mesh:
    """A changed copy of a surface in space, without its attributes: ``change(mesh, "punch", count=3)`` cuts three holes.

    Parameters
    ----------
    mesh : Mesh
        the surface.
    what : Change
        what is done, with the arguments that it needs; new vertices come last:

        - ``"punch"``: count. Cuts round holes, as far from each other and from the boundary as the vertices allow.
        - ``"grade"``: vertex, count. Halves the edges around the vertex, then those of the smaller triangles around it, count times.
        - ``"caps"``, ``"needles"``: count, amount, seed. Cuts faces into three by a vertex near the middle of a side, or near a corner;
          the amount is the smallest angle or the length of the short edge.
        - ``"noise"``: amount, seed. Moves every vertex by up to this share of the mean edge length in each coordinate.
        - ``"invert"``: centre, amount. Maps by the inversion in the sphere of this centre and radius; faces keep their outside.

    Raises
    ------
    ArgumentError
        an argument that the change needs is not given.

    Examples
    --------
    >>> ricci.change(ricci.make("sphere"), "punch", count=3)
    <ricci.Mesh: 2313 vertices, 4528 faces, genus 0, 3 boundary loops>
    """
    how = picked(locals(), ChangeOptions)
    number_of = constant("CHANGE", what)
    known(how, ChangeOptions.__annotations__)
    missing = [name for name in _NEEDS[what] if how.get(name) is None]
    if missing:
        raise ArgumentError(f"{what} needs {', '.join(missing)}")
    return Mesh._made(lib.ricci_change, mesh, options("change_spec", {**how, "change": number_of}, _CHANGE))


def hyperelliptic_periods(points: npt.ArrayLike) -> Complexes:
    """The g x g period matrix of the curve y^2 = (x - e_1) (x - e_2) ..., in some symplectic basis of cycles.

    Parameters
    ----------
    points : npt.ArrayLike
        the finite branch points e_j, complex, all different: 2 g + 1, or 2 g + 2.

    Examples
    --------
    >>> ricci.hyperelliptic_periods([-1, 0, 1]).round(6)
    array([[-0.+1.j]])
    """
    pairs = _pairs(points)
    genus = (len(pairs) - 1) // 2
    periods = doubles(lib.ricci_hyperelliptic_periods, pointer(pairs), len(pairs), shape=(genus, genus, 2))
    return periods.view(np.complex128)[..., 0]
