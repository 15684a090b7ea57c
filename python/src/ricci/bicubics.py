"""Bicubic patches near splines, for CAD."""

from __future__ import annotations

import os
from functools import cached_property
from typing import Any, ClassVar, Literal, TypedDict

from ricci._call import CONTROL, Handle, call, constant, path_bytes, summary, text_of
from ricci._library import ffi, lib
from ricci._signatures import picked, takes
from ricci._structs import Struct, Write, above_zero, choice, number, options
from ricci.control import Progress
from ricci.figures import BicubicSummary
from ricci.splines import Spline

__all__ = ["Bicubic", "BicubicOptions", "StepOptions", "bicubic"]


class BicubicOptions(TypedDict, total=False):
    """Options of bicubic patches: how near they are to the spline.

    Attributes
    ----------
    tolerance : float
        largest distance from the spline over the diagonal, 1e-10 to 1; 1e-4.
    angle : float
        largest angle between the normals of neighbouring patches beyond the spline's own, radians; half a degree.
    threads : int
        one per core. The result does not depend on it.
    control_points : int
        most control points of all patches together; where more are needed nothing is made. No limit.
    folds : bool
        true for patches of a spline that folds too, which is refused else.
    """

    tolerance: float
    angle: float
    threads: int
    control_points: int
    folds: bool


class StepOptions(TypedDict, total=False):
    """Entries of a STEP file beside the patches.

    Attributes
    ----------
    name : str
        the name of the part.
    unit : Literal["millimetre", "metre"]
        of the coordinates: ``"millimetre"``, ``"metre"``.
    colours : bool
        colours of faces that differ from those of their neighbours; False.
    """

    name: str
    unit: Literal["millimetre", "metre"]
    colours: bool


def _name(struct: Struct, field: str, value: str) -> None:
    text: Any = ffi.new("char[]", value.encode())
    struct._kept.append(text)
    struct.put(field, text)


_STEP: dict[str, Write] = {"name": _name, "unit": choice("UNIT"), "colours": number}
_BICUBIC: dict[str, Write] = {**dict.fromkeys(BicubicOptions.__annotations__, above_zero), "folds": number}


class Bicubic(Handle):
    """Bicubic B-spline patches near a spline, three for each of its patches; neighbours share the control points of their side.

    Examples
    --------
    >>> patches = ricci.bicubic(ricci.Spline.plane(ricci.make("disk", n=2), degree=2))
    >>> patches.text("step")[:13]
    'ISO-10303-21;'
    """

    _type: ClassVar[str] = "bicubic"
    _made_by: ClassVar[str] = "ricci.bicubic(spline)"
    _figures: ClassVar[tuple[str, ...]] = ("n_patches", "n_control_points", "spans_min", "spans_max", "distance", "normal_jump_max")

    @cached_property
    def summary(self) -> BicubicSummary:
        """Counts, distance from the spline, jumps of the normals."""
        return summary(BicubicSummary, "bicubic", self)

    @takes(StepOptions)
    def write(
        self,
        path: str | os.PathLike[str],
        *,
        name: str | None = None,
        unit: Literal["millimetre", "metre"] = "millimetre",
        colours: bool = False,
    ) -> None:
        """Write the patches as .step, .stp (STEP AP242) or .json, whole or not at all."""
        given = picked(locals(), StepOptions)
        call(lib.ricci_bicubic_write, self, options("step_options", given, _STEP), path_bytes(path))

    @takes(StepOptions)
    def text(
        self,
        kind: Literal["step", "json"] = "json",
        *,
        name: str | None = None,
        unit: Literal["millimetre", "metre"] = "millimetre",
        colours: bool = False,
    ) -> str:
        """The text of such a file."""
        given = picked(locals(), StepOptions)
        return text_of(lib.ricci_bicubic_text, self, constant("BICUBIC", kind), options("step_options", given, _STEP))


@takes(BicubicOptions)
def bicubic(
    spline: Spline,
    progress: Progress = None,
    *,
    tolerance: float | None = None,
    angle: float | None = None,
    threads: int | None = None,
    control_points: int | None = None,
    folds: bool = False,
) -> Bicubic:
    """Bicubic patches within a tolerance of a spline, with as many spans as that takes, up to 128 along a side.

    Parameters
    ----------
    spline : Spline
        the spline.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    SplineError
        a patch that 128 spans do not bring within the tolerance, or in which the spline folds; the index is its number.
    ArgumentError
        more control points than allowed are needed.

    Examples
    --------
    >>> patches = ricci.bicubic(ricci.Spline.plane(ricci.make("disk", n=2), degree=2))
    >>> patches.summary.n_patches
    72
    """
    given = picked(locals(), BicubicOptions)
    return Bicubic._made(lib.ricci_bicubic_new, spline, options("bicubic_options", given, _BICUBIC), CONTROL, progress=progress)
