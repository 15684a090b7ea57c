"""Harmonic maps, harmonic and holomorphic 1-forms."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Literal, TypedDict

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._arrays import frozen
from ricci._call import (
    CONTROL,
    Complexes,
    Doubles,
    Longs,
    call,
    constant,
    doubles,
    figures_of,
    filled,
    pointer,
    sized_list,
    summary,
)
from ricci._kept import Kept
from ricci._library import ffi, lib
from ricci._shown import Scene
from ricci._signatures import picked, takes
from ricci._structs import Struct, Write, above_zero, choice, known, one_index, options
from ricci.adapters import MeshLike, as_mesh
from ricci.control import Progress
from ricci.errors import ArgumentError, warn
from ricci.figures import FormsSummary, HarmonicSummary
from ricci.mesh import Mesh

__all__ = ["Forms", "FormsOptions", "HarmonicMap", "HarmonicOptions", "forms", "harmonic", "harmonic_map"]


class HarmonicOptions(TypedDict, total=False):
    """The target of a harmonic map, and the vertices whose images are given.

    Attributes
    ----------
    target : Literal["disk", "rectangle", "sphere", "values", "polygon"]
        a disk to the unit ``"disk"``, the ``"rectangle"`` of its modulus, or a regular ``"polygon"``; a closed surface of
        genus 0 to the unit ``"sphere"``; ``"values"``: given places for some vertices.
    b : npt.ArrayLike
        the vertices that are given, for ``"values"``; the corners of a rectangle or a polygon.
    bc : npt.ArrayLike
        the places of the vertices `b`, k x 2 or k x 3, or k numbers.
    n : int
        number of corners of a polygon; of `b` where that is given.
    method : Literal["solve", "heat"]
        ``"solve"``, or ``"heat"``: the heat flow df/dt = Laplacian of f, whose energy falls at every step (not to the rectangle).
    step : float
        length of a step of the heat flow to the plane, a time in units of area; a hundredth of the area.
    max_iterations : int
        most steps of the heat flow; 10000, to the sphere 2000.
    """

    target: Literal["disk", "rectangle", "sphere", "values", "polygon"]
    b: npt.ArrayLike
    bc: npt.ArrayLike
    n: int
    method: Literal["solve", "heat"]
    step: float
    max_iterations: int


_TARGETS = ("disk", "rectangle", "sphere", "values", "polygon")


@dataclass(frozen=True)
class HarmonicMap:
    """A harmonic map with its figures.

    Attributes
    ----------
    points : Doubles
        the images of the vertices, n x 3, in the plane with z = 0.
    energies : Doubles
        the energy at the start of the heat flow and after each step; empty for a map that was solved for.
    summary : HarmonicSummary
        energy, residual, the modulus of a rectangle with bounds.

    Examples
    --------
    >>> found = ricci.harmonic_map(ricci.make("disk", n=4))
    >>> found.points.shape, found.summary.converged
    ((61, 3), True)
    """

    points: Doubles
    energies: Doubles
    summary: HarmonicSummary


def _harmonic_struct(given: HarmonicOptions) -> Struct:
    struct = Struct("harmonic_spec")
    known(given, HarmonicOptions.__annotations__)
    if given.get("n") == 0:
        raise ArgumentError("n is 0: a polygon has at least 3 corners")
    target = given.get("target", "values" if "bc" in given else "disk")
    struct.put("target", constant("HARMONIC", target, _TARGETS))
    struct.put("method", constant("HARMONIC", given.get("method", "solve"), ("solve", "heat")))
    for name, value in (("step", given.get("step")), ("max_iterations", given.get("max_iterations"))):
        if value is not None:
            above_zero(struct, name, value)
    vertices = _arrays.indices(given.get("b", ()), name="b")
    struct.put("n", vertices.size or given.get("n", 0))
    if vertices.size:
        struct.put("vertices", vertices)
    if "bc" in given:
        values = _arrays.real(given["bc"])
        values = values[:, None] if values.ndim == 1 else values
        if values.ndim != 2 or len(values) != vertices.size or values.shape[1] > 3:
            raise ArgumentError(f"bc has shape {values.shape} for {vertices.size} vertices")
        struct.put("values", np.ascontiguousarray(np.pad(values, ((0, 0), (0, 3 - values.shape[1])))))
    return struct


@takes(HarmonicOptions)
def harmonic(
    V: MeshLike,
    F: npt.ArrayLike | None = None,
    progress: Progress = None,
    *,
    target: Literal["disk", "rectangle", "sphere", "values", "polygon"] | None = None,
    b: npt.ArrayLike | None = None,
    bc: npt.ArrayLike | None = None,
    n: int | None = None,
    method: Literal["solve", "heat"] = "solve",
    step: float | None = None,
    max_iterations: int | None = None,
) -> Doubles:
    """The harmonic map of a surface: by default of a disk to the unit disk, its boundary by length.

    ``harmonic(V, F, b=b, bc=bc)`` has the given places at the vertices `b`.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`).
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    progress : Progress
        a `Control` or a callback.

    Returns
    -------
    Doubles
        n x 3 points, in the plane with z = 0.

    Raises
    ------
    LayoutError
        a surface of another topology.

    Examples
    --------
    >>> disk = ricci.make("disk", n=4)
    >>> ricci.harmonic(disk).shape
    (61, 3)
    >>> rim = disk.boundary[0]
    >>> bool(ricci.harmonic(disk, b=rim, bc=disk.V[rim, 0])[:, 0].max() <= 1)
    True
    """
    given = picked(locals(), HarmonicOptions)
    mesh = as_mesh(V, F)
    if given.get("target") == "values" and "bc" not in given:
        raise ArgumentError("harmonic values need b and bc")
    out = np.empty((mesh.n_vertices, 3))
    return filled(lib.ricci_harmonic, mesh, _harmonic_struct(given), CONTROL, out=out, progress=progress)


@takes(HarmonicOptions)
def harmonic_map(
    V: MeshLike,
    F: npt.ArrayLike | None = None,
    progress: Progress = None,
    *,
    target: Literal["disk", "rectangle", "sphere", "values", "polygon"] | None = None,
    b: npt.ArrayLike | None = None,
    bc: npt.ArrayLike | None = None,
    n: int | None = None,
    method: Literal["solve", "heat"] = "solve",
    step: float | None = None,
    max_iterations: int | None = None,
) -> HarmonicMap:
    """`harmonic` with its figures: the modulus of a rectangle with its bounds, the energies of a heat flow.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`).
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    progress : Progress
        a `Control` or a callback.

    Warns
    -----
    ConvergenceWarning
        the steps of the heat flow ran out.

    Raises
    ------
    LayoutError
        a surface of another topology.

    Examples
    --------
    >>> found = ricci.harmonic_map(ricci.make("disk", n=4), target="rectangle", b=[37, 43, 49, 55])
    >>> found.summary.modulus_low <= found.summary.modulus <= found.summary.modulus_high
    True
    """
    given = picked(locals(), HarmonicOptions)
    mesh = as_mesh(V, F)
    if given.get("target") == "values" and "bc" not in given:
        raise ArgumentError("harmonic values need b and bc")
    points = np.empty((mesh.n_vertices, 3))
    most = (given.get("max_iterations") or 10000) + 1 if given.get("method") == "heat" or given.get("target") == "sphere" else 0
    energies = np.empty(most)
    out = ffi.new("ricci_harmonic_summary *")
    size = ffi.sizeof("ricci_harmonic_summary")
    places = (pointer(points), points.size, pointer(energies), energies.size)
    call(lib.ricci_harmonic_map, mesh, _harmonic_struct(given), CONTROL, *places, out, size, progress=progress)
    told = figures_of(HarmonicSummary, out)
    if not told.converged:
        warn(f"the heat flow did not come to a harmonic map in {told.n_energies - 1} steps: max_iterations allows more")
    return HarmonicMap(points, energies[: told.n_energies].copy(), told)


class FormsOptions(TypedDict, total=False):
    """Options of harmonic forms.

    Attributes
    ----------
    base : int
        the vertex where the loops meet; one from which they are short.
    classes : Literal["absolute", "relative"]
        on a surface with boundary, forms that flow along it (``"absolute"``), or are 0 along it (``"relative"``).
    """

    base: int
    classes: Literal["absolute", "relative"]


_FORMS: dict[str, Write] = {"base": one_index, "classes": choice("CLASSES")}


class Forms(Kept):
    """A basis of the harmonic 1-forms of a surface, on its intrinsic Delaunay triangulation `mesh`. It never changes.

    Examples
    --------
    >>> basis = ricci.forms(ricci.make("torus", n=16))
    >>> basis.values.shape == (2, basis.summary.n_edges)
    True
    """

    # The mesh that they were asked for, which is drawn; its vertices are those of `mesh`.
    _input: Mesh

    _type: ClassVar[str] = "forms"
    _made_by: ClassVar[str] = "ricci.forms(mesh)"
    _figures: ClassVar[tuple[str, ...]] = ("n_forms", "genus", "n_edges", "closedness", "coclosedness", "modulus")

    def _come_from(self, found: Mapping[str, Any]) -> None:
        self._input = found["mesh"]

    def _scene(self) -> Scene | None:
        seen = self._input
        if not seen.summary.has_positions:
            return None
        if not len(self):
            return Scene(seen.V, seen.F)
        strength = np.zeros(seen.n_vertices)
        for end in self.mesh.edges.T:
            np.maximum.at(strength, end, np.abs(self.values[0]))
        return Scene(seen.V, seen.F, strength, "largest integral of the first form over an edge")

    @cached_property
    def summary(self) -> FormsSummary:
        """Counts, residuals, modulus."""
        return summary(FormsSummary, "forms", self)

    def __len__(self) -> int:
        return self.summary.n_forms

    @cached_property
    def mesh(self) -> Mesh:
        """The triangulation that the forms live on: `Mesh.edges` has the direction of each edge."""
        return Mesh._made(lib.ricci_forms_mesh, self)

    @cached_property
    def values(self) -> Doubles:
        """n_forms x n_edges integrals over the edges, each in its direction."""
        out = np.empty((len(self), self.summary.n_edges))
        for k, row in enumerate(out):
            filled(lib.ricci_forms_values, self, k, out=row)
        return frozen(out)

    def holomorphic(self, coefficients: npt.ArrayLike) -> Complexes:
        """The holomorphic form whose real part is this combination of the harmonic ones: n_edges complex integrals."""
        given = _arrays.real(coefficients)
        values = doubles(lib.ricci_forms_holomorphic, self, pointer(given), given.size, shape=(self.summary.n_edges, 2))
        return values.view(np.complex128)[:, 0]

    def zeros(self, coefficients: npt.ArrayLike) -> Longs:
        """The zeros of the form of `holomorphic`, k x 2: nearest vertex and multiplicity."""
        given = _arrays.real(coefficients)
        return sized_list(lib.ricci_forms_zeros, self, pointer(given), given.size, dtype=np.int64).reshape(-1, 2)

    @cached_property
    def periods(self) -> Complexes:
        """The g x g period matrix of a closed surface: symmetric, with positive imaginary part.

        Raises
        ------
        LayoutError
            genus 0, or a boundary.
        """
        g = self.summary.genus
        return frozen(doubles(lib.ricci_forms_periods, self, shape=(g, g, 2)).view(np.complex128)[..., 0])


@takes(FormsOptions)
def forms(
    V: MeshLike,
    F: npt.ArrayLike | None = None,
    progress: Progress = None,
    *,
    base: int | None = None,
    classes: Literal["absolute", "relative"] = "absolute",
) -> Forms:
    """The harmonic 1-forms of a surface: form k has the integral 1 over loop k of a homotopy basis and 0 over the others.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`).
    F : npt.ArrayLike | None
        m x 3 vertex indices.
    progress : Progress
        a `Control` or a callback.

    Examples
    --------
    >>> basis = ricci.forms(ricci.make("genus", genus=2, n=3))
    >>> len(basis), basis.periods.shape
    (4, (2, 2))
    """
    given = picked(locals(), FormsOptions)
    mesh = as_mesh(V, F)
    made = Forms._made(lib.ricci_forms_new, mesh, options("forms_options", given, _FORMS), CONTROL, progress=progress)
    made._input = mesh
    return made
