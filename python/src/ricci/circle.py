"""Circle domains: surfaces with boundary whose loops are circles."""

from __future__ import annotations

from functools import cached_property
from typing import Any, ClassVar, Literal, TypedDict

import numpy as np
import numpy.typing as npt

from ricci._arrays import frozen
from ricci._call import CONTROL, Doubles, constant, doubles, summary
from ricci._kept import Kept
from ricci._library import lib
from ricci._shown import Scene
from ricci._signatures import picked, takes
from ricci._structs import Write, above_zero, choice, index_list, one_index, options, real_list
from ricci.adapters import MeshLike, as_mesh
from ricci.control import Progress
from ricci.errors import ArgumentError, warn
from ricci.figures import CircleDomainSummary
from ricci.figures.names import Model
from ricci.layouts import Layout
from ricci.mesh import Mesh
from ricci.metrics import FlowOptions, flow_struct

__all__ = ["CircleDomain", "CircleOptions", "circles"]


class CircleOptions(TypedDict, total=False):
    """Options of a circle domain.

    Attributes
    ----------
    flow : FlowOptions
        tolerance, max_iterations and threads of the flows.
    outer : int
        genus 0: the boundary loop that becomes the unit circle; the longest.
    centre : int
        genus 0: the vertex at the centre of the unit disk.
    three : npt.ArrayLike
        genus 0: three vertices of the outer loop, counterclockwise, to lie at `angles`.
    angles : npt.ArrayLike
        three angles, radians; 0, 2 pi / 3, 4 pi / 3.
    least_loop : int
        edges of loops with fewer than this are halved; 12.
    frame : Literal["auto", "disk", "strip"]
        genus 0: ``"disk"``; of an annulus also ``"strip"``, its log coordinates [0, 2 pi] x [0, 2 pi m], the outer loop at y = 0,
        (x, y) the point of the disk with angle x and radius e^-y; ``"auto"``: the disk, and the strip where doubles do not hold the
        inner circle in the disk.
    """

    flow: FlowOptions
    outer: int
    centre: int
    three: npt.ArrayLike
    angles: npt.ArrayLike
    least_loop: int
    frame: Literal["auto", "disk", "strip"]


def _of_three(write: Write) -> Write:
    """Three entries: the library reads as many."""

    def checked(struct: Any, field: str, value: Any) -> None:
        if np.size(value) != 3:
            raise ArgumentError(f"{field} has {np.size(value)} entries, 3 are needed")
        write(struct, field, value)

    return checked


_CIRCLES: dict[str, Write] = {
    "flow": lambda struct, field, value: struct.put(field, flow_struct(value)),
    "outer": one_index,
    "centre": one_index,
    "three": _of_three(index_list()),
    "angles": _of_three(real_list()),
    "least_loop": above_zero,
    "frame": choice("FRAME"),
}


class CircleDomain(Kept):
    """A surface with boundary whose loops are circles: in the unit disk, a flat torus or a hyperbolic surface.

    Examples
    --------
    >>> ring = ricci.circles(ricci.make("annulus", a=0.5, b=1, n=4))
    >>> round(ring.summary.modulus.imag, 3)
    0.11
    """

    _type: ClassVar[str] = "circle_domain"
    _made_by: ClassVar[str] = "ricci.circles(mesh)"
    _figures: ClassVar[tuple[str, ...]] = ("space", "n_circles", "converged", "deviation", "modulus", "n_overlapping")

    def _sides(self) -> tuple[Any, ...]:
        return self.layout()._sides()

    def _scene(self) -> Scene | None:
        return self.layout()._scene()

    @cached_property
    def summary(self) -> CircleDomainSummary:
        """Convergence, counts, deviation, modulus."""
        return summary(CircleDomainSummary, "circle_domain", self)

    @property
    def converged(self) -> bool:
        """True if the domain has its curvature within the tolerance, round and disjoint loops, and no flipped triangle."""
        return self.summary.converged

    @cached_property
    def circles(self) -> Doubles:
        """One row for each boundary loop: centre x, y, radius, and the largest distance of a vertex from it as a share of that."""
        return frozen(doubles(lib.ricci_circle_domain_circles, self, shape=(self.summary.n_circles, 4)))

    @cached_property
    def log_radii(self) -> Doubles:
        """The logarithm of each radius; in a strip also of those that are below the range of doubles."""
        return frozen(doubles(lib.ricci_circle_domain_log_radii, self, shape=(self.summary.n_circles,)))

    @cached_property
    def mesh(self) -> Mesh:
        """The given mesh with the vertices that were added to its loops; the first are the given ones."""
        return Mesh._made(lib.ricci_circle_domain_mesh, self)

    def layout(self, model: Model = "poincare") -> Layout:
        """The layout of the surface without its holes, on a subdivision of `mesh`."""
        return Layout._made(lib.ricci_circle_domain_layout, self, constant("MODEL", model))


@takes(CircleOptions)
def circles(
    V: MeshLike,
    F: npt.ArrayLike | None = None,
    progress: Progress = None,
    *,
    flow: FlowOptions | None = None,
    outer: int | None = None,
    centre: int | None = None,
    three: npt.ArrayLike | None = None,
    angles: npt.ArrayLike | None = None,
    least_loop: int | None = None,
    frame: Literal["auto", "disk", "strip"] = "auto",
) -> CircleDomain:
    """The conformal map of a surface with boundary to one whose boundary loops are circles.

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
        the loops did not become circles; `summary` says why.

    Raises
    ------
    ArgumentError
        a closed surface; no such loop or vertex.
    LayoutError
        circles overlap however fine the loops are.

    Examples
    --------
    >>> pants = ricci.change(ricci.make("sphere", n=8), "punch", count=3)
    >>> ricci.circles(pants).circles.shape
    (3, 4)
    """
    given = picked(locals(), CircleOptions)
    struct = options("circle_domain_options", given, _CIRCLES)
    made = CircleDomain._made(lib.ricci_circle_domain_new, as_mesh(V, F), struct, CONTROL, progress=progress)
    s = made.summary
    if not s.converged:
        warn(f"the circle domain did not converge ({s.stop_reason}), curvature error {s.max_curvature_error:.1e}: look at `summary`")
    return made
