"""The job that is done on each mesh of a cohort, and the row of results that comes out of it."""

from __future__ import annotations

import hashlib
import json
import os
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from typing import Any, Literal, NamedTuple

import numpy as np

from ricci._structs import known
from ricci.atlases import StructureOptions, structure
from ricci.circle import CircleOptions, circles
from ricci.cohorts.fingerprint import digest, name_of, spelled
from ricci.control import Control
from ricci.errors import ArgumentError, RicciError, silent
from ricci.form import FormsOptions, forms
from ricci.mesh import Mesh
from ricci.metrics import FlowJob, FlowOptions, flow
from ricci.moduli import BoundsOptions, fenchel_nielsen, modulus_bounds, period_bounds
from ricci.soup import Soup
from ricci.splines import SurfaceOptions, spline
from ricci.uniform import UniformOptions, uniformize

__all__ = ["Job", "Outcome", "Row", "repaired"]


class Outcome(NamedTuple):
    """The results of a job on one mesh.

    Attributes
    ----------
    result : Mapping[str, Any]
        numbers, texts and arrays that depend on the mesh alone.
    report : Mapping[str, Any]
        what differs from run to run, such as seconds.
    """

    result: Mapping[str, Any]
    report: Mapping[str, Any]


@dataclass(frozen=True)
class Row:
    """One mesh of a cohort.

    Attributes
    ----------
    path : str
        its file.
    result : dict[str, Any]
        columns of the table of results, with `ok` and the error's columns.
    report : dict[str, Any]
        columns of the table of reports, with the worker's process and seconds.
    """

    path: str
    result: dict[str, Any]
    report: dict[str, Any]


@dataclass(frozen=True)
class Job:
    """A function of this package as the job of a cohort: ``Job("flow", {"target": "auto:4"})``.

    The result has the figures of the mesh and of what the function made, and its arrays: of a flow the conformal factor, of circles the
    circles, of forms the period matrix, of moduli what is known with bounds: of closed surfaces the period matrix with the radii of its
    entries and, from genus 2 on, lengths and twists of pants; of annuli, and of disks with four `corners`, the bounds of the modulus.

    Attributes
    ----------
    kind : Literal["info", "flow", "uniformize", "circles", "forms", "moduli", "structure", "spline"]
        which function; ``"info"`` only counts.
    options : Mapping[str, Any]
        its arguments by name. One thread is used unless they say otherwise: a cohort has its meshes side by side.
    seconds : float | None
        a mesh that takes longer is given up, with the error `Cancelled`.

    Examples
    --------
    >>> job = ricci.Job("flow", {"target": "auto:4"}, seconds=60)
    >>> job(ricci.make("genus", genus=2, n=3)).result["converged"]
    True
    """

    kind: Literal["info", "flow", "uniformize", "circles", "forms", "moduli", "structure", "spline"]
    options: Mapping[str, Any] = field(default_factory=dict)
    seconds: float | None = None

    def __post_init__(self) -> None:
        if self.kind not in _OPTIONS:
            raise ArgumentError(f"{self.kind!r} is none of {', '.join(_OPTIONS)}")
        known(self.options, _OPTIONS[self.kind])
        if "flow" in self.options:
            known(self.options["flow"], FlowOptions.__annotations__)
        if self.seconds is not None and not self.seconds > 0:
            raise ArgumentError(f"seconds is {self.seconds}: above 0, or None for no limit")

    def __call__(self, mesh: Mesh) -> Outcome:
        """The outcome on one mesh."""
        # The column `converged` says what a warning would.
        with silent(), _limit(self.seconds) as control:
            found, arrays = _KINDS[self.kind](mesh, self.options, control)
        figures = {name: value for name, value in found.items() if not name.startswith("seconds")}
        report = {name: value for name, value in found.items() if name.startswith("seconds")}
        return Outcome({**_figures(mesh), **figures, **arrays}, report)

    def __str__(self) -> str:
        return f"{self.kind} {json.dumps(dict(self.options), sort_keys=True, default=spelled)} within {self.seconds} s"


@contextmanager
def _limit(seconds: float | None) -> Any:
    """A control that cancels itself after this time."""
    control = Control()
    timer = None if seconds is None else threading.Timer(seconds, control.cancel)
    if timer is not None:
        timer.start()
    try:
        yield control
    finally:
        if timer is not None:
            timer.cancel()


def _figures(of: Any) -> dict[str, Any]:
    """The figures of a mesh or a result as columns."""
    return asdict(of.summary)


_Found = tuple[dict[str, Any], dict[str, Any]]
_ONE_THREAD = {"threads": 1}


def _info(mesh: Mesh, _: Mapping[str, Any], __: Control) -> _Found:
    return {}, {}


def _flow(mesh: Mesh, given: Mapping[str, Any], control: Control) -> _Found:
    found = flow(mesh, progress=control, **{**_ONE_THREAD, **given})
    return {**_figures(found.report), "area": found.summary.area}, {"factor": found.factor}


def _uniformize(mesh: Mesh, given: Mapping[str, Any], control: Control) -> _Found:
    found = uniformize(mesh, progress=control, **{**given, "flow": {**_ONE_THREAD, **given.get("flow", {})}})
    return _figures(found), {}


def _circles(mesh: Mesh, given: Mapping[str, Any], control: Control) -> _Found:
    found = circles(mesh, progress=control, **{**given, "flow": {**_ONE_THREAD, **given.get("flow", {})}})
    return _figures(found), {"circles": found.circles}


def _forms(mesh: Mesh, given: Mapping[str, Any], control: Control) -> _Found:
    found = forms(mesh, progress=control, **given)
    closed = mesh.summary.n_boundary_loops == 0 and mesh.genus > 0
    return _figures(found), {"periods": found.periods} if closed else {}


def _moduli(mesh: Mesh, given: Mapping[str, Any], control: Control) -> _Found:
    how = {name: value for name, value in given.items() if name != "corners"}
    if mesh.summary.n_boundary_loops > 0:
        between = modulus_bounds(mesh, given.get("corners"), control, **how)
        return _figures(between), {"low": between.low, "high": between.high}
    bounds = period_bounds(forms(mesh, progress=control), control, **how)
    arrays = {"periods": bounds.matrix, "radius": bounds.radius}
    if mesh.genus > 1:
        arrays["pants"] = fenchel_nielsen(uniformize(mesh, progress=control, flow={"threads": 1}))
    return _figures(bounds), arrays


def _structure(mesh: Mesh, given: Mapping[str, Any], control: Control) -> _Found:
    found = structure(mesh, progress=control, **{**given, "flow": {**_ONE_THREAD, **given.get("flow", {})}})
    return _figures(found), {"holonomy": found.holonomy}


def _spline(mesh: Mesh, given: Mapping[str, Any], control: Control) -> _Found:
    return _figures(spline(mesh, progress=control, **{**_ONE_THREAD, **given})), {}


_KINDS: dict[str, Callable[[Mesh, Mapping[str, Any], Control], _Found]] = {
    "info": _info,
    "flow": _flow,
    "uniformize": _uniformize,
    "circles": _circles,
    "forms": _forms,
    "moduli": _moduli,
    "structure": _structure,
    "spline": _spline,
}


# The names of the options of each kind.
_OPTIONS: dict[str, frozenset[str]] = {
    "info": frozenset(),
    "flow": frozenset({"target", *FlowJob.__annotations__}),
    "uniformize": frozenset(UniformOptions.__annotations__),
    "circles": frozenset(CircleOptions.__annotations__),
    "forms": frozenset(FormsOptions.__annotations__),
    "moduli": frozenset({"corners", *BoundsOptions.__annotations__}),
    "structure": frozenset({"kind", *StructureOptions.__annotations__}),
    "spline": frozenset(SurfaceOptions.__annotations__),
}


def repaired(path: str) -> Mesh:
    """A reader for cohorts of files with defects, which are repaired where that takes no guess."""
    return Soup.read(path).repair().mesh()


def plain(value: Any) -> Any:
    """A value as Parquet has it: arrays as lists, a complex number as its two parts.

    Raises
    ------
    TypeError
        it is nothing that a column can hold.
    """
    if isinstance(value, np.ndarray):
        array = np.stack([value.real, value.imag], -1) if np.iscomplexobj(value) else value
        return array.tolist()
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, complex):
        return [value.real, value.imag]
    if isinstance(value, list | tuple):
        return [plain(entry) for entry in value]
    if value is None or isinstance(value, bool | int | float | str | bytes):
        return value
    raise TypeError(f"a job's column holds numbers, texts, arrays or lists of them, not {type(value).__name__}")


_NO_ERROR: dict[str, Any] = dict.fromkeys(("error", "status", "element", "index", "amount", "message"))


def content_of(path: str) -> str | None:
    """A digest of the bytes of a file, 32 hexadecimal digits; None where there is no such file, or it cannot be read."""
    try:
        with open(path, "rb") as file:
            return hashlib.file_digest(file, lambda: hashlib.blake2b(digest_size=16)).hexdigest()
    except (OSError, ValueError):
        return None


def failed(path: str, wrong: BaseException, content: str | None) -> Row:
    """The row of a mesh with this content on which the job failed, or whose worker died."""
    found = {**_NO_ERROR, "error": type(wrong).__name__, "message": str(wrong)}
    if isinstance(wrong, RicciError):
        found |= {"status": wrong.status.name, "element": wrong.element, "index": wrong.index, "amount": wrong.amount}
    return Row(path, {"path": path, "content": content, "ok": False, **found}, {"path": path, "worker": os.getpid()})


def one(job: Callable[[Any], Outcome | Mapping[str, Any]], read: Callable[[str], Any], path: str) -> Row:
    """Read one mesh and do the job; whatever goes wrong becomes a row."""
    start = time.perf_counter()
    # Before the file is read: one that changes meanwhile has another content afterwards, and is done again by the next run.
    content = content_of(path)
    try:
        found = job(read(path))
        outcome = found if isinstance(found, Outcome) else Outcome(found, {})
        result = {name: plain(value) for name, value in outcome.result.items()}
        report = {name: plain(value) for name, value in outcome.report.items()}
    except Exception as wrong:
        row = failed(path, wrong, content)
    else:
        head = {"path": path, "content": content, "ok": True, **_NO_ERROR}
        row = Row(path, {**result, **head}, {**report, "path": path, "worker": os.getpid()})
    row.report["seconds"] = time.perf_counter() - start
    return row


def signature(job: Any) -> str:
    """The text that identifies a job, or a reader: two runs with the same text may share a folder."""
    return str(job) if isinstance(job, Job) else f"{name_of(job)} #{digest(job)}"
