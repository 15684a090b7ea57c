"""Metrics of a surface in a conformal class, and the flows between them."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any, ClassVar, Literal, TypedDict

import numpy as np
import numpy.typing as npt

from ricci._arrays import frozen
from ricci._call import CONTROL, Doubles, Indices, Passed, constant, doubles, filled, summary
from ricci._kept import Archive, Kept
from ricci._library import lib
from ricci._shown import Scene
from ricci._signatures import picked, takes
from ricci._structs import Struct, Write, above_zero, choice, index_list, number, options
from ricci.adapters import MeshLike, as_mesh
from ricci.control import Progress
from ricci.errors import ArgumentError, warn
from ricci.figures import MetricSummary, ReportSummary
from ricci.figures.names import Scheme, Space
from ricci.mesh import Mesh
from ricci.targets import TargetLike, target_struct

__all__ = ["FlowJob", "FlowOptions", "Metric", "Report", "flow", "metric"]


class FlowOptions(TypedDict, total=False):
    """Options of a flow; those that are left out have their defaults.

    Attributes
    ----------
    method : Literal["newton", "gradient"]
        ``"newton"`` on the convex energy, or ``"gradient"``, the flow du/dt = target - K itself.
    flips : Literal["auto", "never"]
        ``"auto"``: edges are flipped as often as needed, so that every admissible target is reached; ``"never"``.
    tolerance : float
        largest |K - target| of a converged metric, radians; 1e-10.
    max_iterations : int
        steps before giving up; 500 for Newton, 200,000 for the gradient flow.
    threads : int
        of this flow; one per core. The result does not depend on it.
    max_step : float
        largest change of any u in one Newton step; 3.
    fixed_edges : npt.ArrayLike
        rows of `Mesh.edges` that are not flipped, such as feature lines.
    step : Literal["armijo", "barzilai_borwein", "stable", "fixed"]
        step size of the gradient flow: ``"armijo"`` (the energy falls at every step), ``"stable"``, ``"fixed"``, or
        ``"barzilai_borwein"`` (the energy may rise on the way); ``"armijo"``.
    step_size : float
        that of ``"fixed"``.
    area_normalised : bool
        true if a gradient flow in E2 keeps the area of the start.
    """

    method: Literal["newton", "gradient"]
    flips: Literal["auto", "never"]
    tolerance: float
    max_iterations: int
    threads: int
    max_step: float
    fixed_edges: npt.ArrayLike
    step: Literal["armijo", "barzilai_borwein", "stable", "fixed"]
    step_size: float
    area_normalised: bool


class FlowJob(FlowOptions, total=False):
    """Options of `flow`: how it is solved, and the conformal class.

    Attributes
    ----------
    space : Space
        the geometry in which the metric lives: ``"e2"``, ``"h2"``, ``"s2"``; ``"e2"``.
    scheme : Scheme
        how lengths depend on u: ``"yamabe"`` (vertex scaling), ``"inversive"``, ``"thurston"``, ``"tangential"``,
        ``"virtual"``; ``"yamabe"``.
    """

    space: Space
    scheme: Scheme


_FLOW: dict[str, Write] = {
    **dict.fromkeys(("tolerance", "max_iterations", "threads", "max_step", "step_size"), above_zero),
    "area_normalised": number,
    "method": choice("METHOD"),
    "flips": choice("FLIPS"),
    "step": choice("STEP"),
    "fixed_edges": index_list("n_fixed_edges"),
}


def flow_struct(given: Any) -> Struct:
    """The struct of options of a flow."""
    return options("flow_options", given, _FLOW)


class Report(ReportSummary, Passed):
    """The report of the flow that led to a metric: figures, target, residuals, and the vertices with the largest errors.

    The figures are attributes of the report itself, as of `summary`.

    Examples
    --------
    >>> report = ricci.flow(ricci.make("torus", n=16)).report
    >>> report.stop_reason, report.max_curvature_error < 1e-10
    ('converged', True)
    """

    def __init__(self, of: Metric) -> None:
        # The library's object, not the Python one, which has this report: both are freed at once, without a search for cycles.
        found = {"_pointer": of._pointer, "_n_vertices": of.summary.n_vertices}
        self.__dict__.update(found)
        told = summary(ReportSummary, "report", self)
        self.__dict__.update({**vars(told), "summary": told})

    summary: ReportSummary
    _n_vertices: int

    @cached_property
    def target(self) -> Doubles:
        """The target, n curvatures in radians; at pinned vertices the curvature at the end."""
        return self._values("TARGET", self._n_vertices)

    @cached_property
    def residuals(self) -> Doubles:
        """Largest |K - target| at the start and after every Newton step, radians."""
        return self._values("RESIDUALS", self.summary.n_residuals)

    @cached_property
    def trace(self) -> Doubles:
        """The course of a gradient flow, k x 5: step, energy, largest |K - target|, area, step size."""
        return self._values("TRACE", self.summary.n_trace, 5)

    @cached_property
    def cones(self) -> Indices:
        """The vertices through which a layout is cut open."""
        return self._vertices("CONES", self.summary.n_cones)

    @cached_property
    def worst(self) -> tuple[Indices, Doubles]:
        """The vertices farthest from their target, farthest first, and K - target there."""
        n = self.summary.n_worst
        return self._vertices("WORST", n), self._values("WORST_ERRORS", n)

    @cached_property
    def obstruction(self) -> Indices:
        """Vertices that prove that the target cannot be reached, ascending; none unless the flow stopped as infeasible."""
        return self._vertices("OBSTRUCTION", self.summary.n_obstruction)

    def __reduce__(self) -> Any:
        """The bytes of the metric whose report it is."""
        return _report, (Archive.of("metric", self._pointer).bytes(),)

    def _values(self, which: str, *shape: int) -> Any:
        return frozen(doubles(lib.ricci_report_values, self._pointer, getattr(lib, f"RICCI_REPORT_{which}"), shape=shape))

    def _vertices(self, which: str, n: int) -> Any:
        return frozen(filled(lib.ricci_report_vertices, self._pointer, getattr(lib, f"RICCI_REPORT_{which}"), out=np.empty(n, np.uint32)))

    def __repr__(self) -> str:
        s = self.summary
        return f"<ricci.Report: {s.stop_reason} after {s.iterations} steps, {s.flips} flips, error {s.max_curvature_error:.1e}>"


def _report(data: bytes) -> Report:
    """The report of a pickle."""
    return Report(Archive.parse(data).object())


class Metric(Kept):
    """A metric of a surface in a conformal class, with the report of the flow that led to it. It never changes; a flow makes a new one.

    A flow that flips edges leads to another triangulation, `triangulation`; vertices keep their numbers. Arrays are read-only.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`).
    F : npt.ArrayLike | None
        m x 3 vertex indices from 0.
    space : Space
        the geometry in which the metric will live.
    scheme : Scheme
        how lengths depend on u.

    Examples
    --------
    >>> flat = ricci.flow(ricci.make("torus", n=16))
    >>> float(abs(flat.curvature).max()) < 1e-9
    True
    >>> flat.factor.shape
    (128,)
    """

    # The mesh that it was made from, which is drawn; of metrics that come out of other objects None.
    _input: Mesh | None = None

    _type: ClassVar[str] = "metric"
    _made_by: ClassVar[str] = "ricci.flow(mesh)"
    _figures: ClassVar[tuple[str, ...]] = ("space", "scheme", "n_vertices", "n_flips", "area", "gauss_bonnet")

    def __init__(self, V: MeshLike, F: npt.ArrayLike | None = None, *, space: Space = "e2", scheme: Scheme = "yamabe") -> None:
        self._input = as_mesh(V, F)
        made = Metric._made(lib.ricci_metric_new, self._input, constant("SCHEME", scheme), constant("SPACE", space))
        self._pointer = made._pointer

    def _come_from(self, found: Mapping[str, Any]) -> None:
        self._input = found["mesh"]

    def _scene(self) -> Scene | None:
        seen = self._input
        return None if seen is None or not seen.summary.has_positions else Scene(seen.V, seen.F, self.factor, "conformal factor")

    @takes(FlowOptions)
    def flow(
        self,
        target: TargetLike = None,
        progress: Progress = None,
        *,
        method: Literal["newton", "gradient"] = "newton",
        flips: Literal["auto", "never"] = "auto",
        tolerance: float | None = None,
        max_iterations: int | None = None,
        threads: int | None = None,
        max_step: float | None = None,
        fixed_edges: npt.ArrayLike | None = None,
        step: Literal["armijo", "barzilai_borwein", "stable", "fixed"] = "armijo",
        step_size: float | None = None,
        area_normalised: bool = False,
    ) -> Metric:
        """The metric of the class with the curvature `target`, as `ricci.flow`; it goes on from where this one is."""
        given = picked(locals(), FlowOptions)
        made = Metric._made(lib.ricci_flow, self, target_struct(target), flow_struct(given), CONTROL, progress=progress)
        made._input = self._input
        made._warn()
        return made

    def _warn(self) -> None:
        """Warn of a flow that has not converged."""
        s = self.report.summary
        if not s.converged:
            warn(
                f"the flow stopped ({s.stop_reason}) after {s.iterations} steps with a curvature error of {s.max_curvature_error:.1e}, "
                f"which is above the tolerance {s.tolerance:.1e}: look at `report`"
            )

    def fill(self, target: TargetLike = None, progress: Progress = None) -> Doubles:
        """The curvature that a target has at every vertex, n numbers in radians.

        Raises
        ------
        TargetError
            no metric has it; the element is the vertex, the amount by how much.
        """
        out = np.empty(self.summary.n_vertices)
        return filled(lib.ricci_target_fill, self, target_struct(target), CONTROL, out=out, progress=progress)

    @cached_property
    def summary(self) -> MetricSummary:
        """Kind, counts, area and Gauss-Bonnet residual."""
        return summary(MetricSummary, "metric", self)

    @cached_property
    def report(self) -> Report:
        """The report of the flow that led to this metric.

        Raises
        ------
        ArgumentError
            no flow has led here.
        """
        return Report(self)

    def flow_report(self) -> Report | None:
        """The report of the flow that led to this metric; None if no flow has."""
        try:
            return self.report
        except ArgumentError:
            return None

    @property
    def converged(self) -> bool:
        """True if the flow that led to this metric came to its target."""
        return self.report.converged

    def boundary_vertices(self) -> Indices:
        """The vertices of the surface on its boundary, ascending: of a double those that are their own mirror images."""
        if self.summary.doubled:
            return frozen(np.flatnonzero(self.mirror == np.arange(self.summary.n_mesh_vertices)).astype(np.int32))
        return frozen(np.unique(np.concatenate([np.empty(0, np.int32), *self.triangulation.boundary])))

    @cached_property
    def factor(self) -> Doubles:
        """n conformal factors f against the input: lengths near vertex i change by about exp(f_i)."""
        return self._values("FACTOR", self.summary.n_vertices)

    @cached_property
    def curvature(self) -> Doubles:
        """n curvatures, radians: 2 pi minus the angles at a vertex inside, pi minus them on the boundary."""
        return self._values("CURVATURE", self.summary.n_vertices)

    @cached_property
    def u(self) -> Doubles:
        """n conformal variables."""
        return self._values("U", self.summary.n_vertices)

    @cached_property
    def types(self) -> Doubles:
        """n types epsilon: 1 circle, 0 vertex scaling, -1 imaginary circle."""
        return self._values("TYPE", self.summary.n_vertices)

    @cached_property
    def lengths(self) -> Doubles:
        """The length of every edge of `triangulation`."""
        return self._values("LENGTH", self.summary.n_edges)

    @cached_property
    def eta(self) -> Doubles:
        """The weight of every edge of `triangulation`."""
        return self._values("ETA", self.summary.n_edges)

    @cached_property
    def triangulation_u(self) -> Doubles:
        """The conformal variable of every vertex of `triangulation`, of a double with its mirror images."""
        return self._values("MESH_U", self.summary.n_mesh_vertices)

    @cached_property
    def triangulation(self) -> Mesh:
        """The triangulation that the metric lives on, an intrinsic mesh with the metric's lengths."""
        return Mesh._made(lib.ricci_metric_mesh, self)

    @cached_property
    def mirror(self) -> Indices:
        """The mirror image of every vertex of `triangulation`: itself, but inside a surface that was doubled."""
        return frozen(filled(lib.ricci_metric_mirror, self, out=np.empty(self.summary.n_mesh_vertices, np.uint32)))

    def _values(self, which: str, *shape: int) -> Any:
        return frozen(doubles(lib.ricci_metric_values, self, getattr(lib, f"RICCI_METRIC_{which}"), shape=shape))

    def __repr__(self) -> str:
        s = self.summary
        return f"<ricci.Metric: {s.scheme} in {s.space}, {s.n_vertices} vertices, {s.n_flips} flips>"


def metric(V: MeshLike, F: npt.ArrayLike | None = None, *, space: Space = "e2", scheme: Scheme = "yamabe") -> Metric:
    """The initial metric of a mesh in the conformal class of its lengths, as `Metric`.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`).
    F : npt.ArrayLike | None
        m x 3 vertex indices from 0.
    space : Space
        the geometry in which the metric will live.
    scheme : Scheme
        how lengths depend on u.

    Examples
    --------
    >>> start = ricci.metric(ricci.make("torus", n=16))
    >>> bool(abs(start.curvature.sum()) < 1e-9)
    True
    """
    return Metric(V, F, space=space, scheme=scheme)


@takes(FlowJob, FlowOptions)
def flow(
    V: MeshLike,
    F: npt.ArrayLike | None = None,
    target: TargetLike = None,
    progress: Progress = None,
    *,
    method: Literal["newton", "gradient"] = "newton",
    flips: Literal["auto", "never"] = "auto",
    tolerance: float | None = None,
    max_iterations: int | None = None,
    threads: int | None = None,
    max_step: float | None = None,
    fixed_edges: npt.ArrayLike | None = None,
    step: Literal["armijo", "barzilai_borwein", "stable", "fixed"] = "armijo",
    step_size: float | None = None,
    area_normalised: bool = False,
    space: Space = "e2",
    scheme: Scheme = "yamabe",
) -> Metric:
    """Deform the metric of a mesh in its conformal class to a prescribed curvature.

    Whether it came that far is in ``result.converged``: a flow that stops early is a result with a `ConvergenceWarning`, not an error.

    Parameters
    ----------
    V : MeshLike
        n x 3 positions with `F`, or a mesh of any kind (`as_mesh`).
    F : npt.ArrayLike | None
        m x 3 vertex indices from 0.
    target : TargetLike
        ``"uniform"``, ``"boundary"``, ``"single:V"``, ``"auto:N"``, a mapping of vertices to curvatures (0 elsewhere), or n
        curvatures in radians. None: uniform on closed surfaces of genus 1 and more and outside E2, on the boundary of open ones.
    progress : Progress
        a `Control`, or a callback ``progress(stage, fraction)``.

    Raises
    ------
    TargetError
        no metric has the target; the element is the vertex, the amount by how much.
    MeshError, MetricError
        there is no metric to begin with.
    Cancelled
        stopped by its control.

    Examples
    --------
    >>> flat = ricci.flow(ricci.make("genus", genus=2, n=3), target="auto:4")
    >>> flat.converged, flat.report.n_cones
    (True, 4)
    """
    given = picked(locals(), FlowJob)
    how: dict[str, Any] = dict(given)
    start = Metric(V, F, space=how.pop("space", "e2"), scheme=how.pop("scheme", "yamabe"))
    return start.flow(target, progress, **how)
