"""Counts and measured figures of flat maps."""

from __future__ import annotations

from dataclasses import dataclass

from ricci.figures.names import FlattenStart, FlattenStop


@dataclass(frozen=True)
class DartSummary:
    """Figures of a surface that darts have opened.

    Attributes
    ----------
    n_darts : int
        number of darts.
    n_vertices : int
        number of vertices of the opened surface.
    length : float
        length of the darts together.
    before : float
        the largest part of its limit that a triangle takes in the flat map without darts: more than 1 is too much.
    after : float
        that in the flat map of the opened surface.
    """

    n_darts: int
    n_vertices: int
    length: float
    before: float
    after: float


@dataclass(frozen=True)
class FlattenSummary:
    """Figures of a flat map.

    Attributes
    ----------
    n_energies : int
        number of energies: that at the start, then one per step.
    n_unclamped : int
        steps by the Hessian itself; the others replace negative eigenvalues by 0.
    energy : float
        the least energy, after the last step.
    decrement : float
        Newton decrement of the last step; infinite without one.
    gradient : float
        largest slope of the energy in a coordinate, times the diameter of the map.
    overlap : float
        share of the map's area that lies on other parts of it.
    before : tuple[float, ...]
        the change of lengths and areas at the start, in the order of `Distortion`.
    after : tuple[float, ...]
        that at the end.
    start : FlattenStart
        the ``"conformal"`` layout, or ``"tutte"``'s embedding where that turns a triangle over; on the sphere the conformal map
        with its triangles turned back, ``"untangled"``, or a map of the triangulation alone, ``"coarse"``; ``"seamless"`` where
        seams stay rotations.
    stop : FlattenStop
        why the descent ended: ``"converged"``, ``"rounding"``, ``"max_iterations"``, ``"barrier"``, ``"no_step"`` or ``"unmet"``
        (pinned vertices or
        straight runs are not where they are to be).
    misfit : float
        largest distance of a pinned vertex from its place, and of a vertex from the line of its run, over the diameter of the map.
    one_to_one : bool
        True if no part of the map lies on another one, by exact arithmetic on the points.
    """

    n_energies: int
    n_unclamped: int
    energy: float
    decrement: float
    gradient: float
    overlap: float
    before: tuple[float, ...]
    after: tuple[float, ...]
    start: FlattenStart
    stop: FlattenStop
    misfit: float
    one_to_one: bool
