"""Pages with a surface that turns: beside it its image, checks of one pattern on both, quantities in colours, seams."""

from __future__ import annotations

import base64
import json
import os
from collections.abc import Mapping
from functools import cached_property
from html import escape
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._shown import Shown
from ricci.errors import ArgumentError, ArgumentTypeError

__all__ = ["Page", "Sides", "show"]

# The scripts of the page, each of which uses those before it; the first is a library (MIT, its licence at its head).
_SCRIPTS = ("picogl.min.js", "shape.js", "paint.js", "turn.js")
# The largest number of 16 bits; a quantity has one less for its largest value, this one where it is no number.
_MOST = 65535


def _viewer() -> Path:
    """The folder of the viewer: in the package, or in the tree of the repository, whose gallery has the same."""
    packed = Path(__file__).resolve().parent / "viewer"
    return packed if packed.exists() else Path(__file__).resolve().parents[3] / "apps" / "src" / "gallery"


class Sides(NamedTuple):
    """What a page shows of an object."""

    #: n x 3 places of the vertices in space.
    points: npt.NDArray[Any]
    #: m x 3.
    faces: npt.NDArray[Any]
    #: n x 2 in the plane, or n x 3; None for a surface alone.
    image: npt.NDArray[Any] | None
    #: The vertex of the mesh of each of the vertices, which a seam has twice.
    origins: npt.NDArray[Any]
    #: Numbers for each vertex of the mesh, by name.
    quantities: dict[str, npt.NDArray[Any]]


class Page:
    """A page of one file without any other, in which a surface turns.

    Notebooks show it where it is the last value of a cell; `write` makes a file of it.

    Attributes
    ----------
    html : str
        the whole page.

    Examples
    --------
    >>> page = ricci.show(ricci.make("sphere", n=4))
    >>> page.write("sphere.html")
    """

    def __init__(self, title: str, sides: Sides) -> None:
        self._title, self._sides = title, sides

    @cached_property
    def html(self) -> str:
        """The whole page."""
        folder = _viewer()
        frame, style = ((folder / name).read_text(encoding="utf-8") for name in ("view.html", "page.css"))
        # No end tag can begin inside the data: base64 has no `<`, and what could is written as its number.
        views = json.dumps({"view": _packed(self._sides)}).replace("<", "\\u003c")
        body = f'<h1>{escape(self._title)}</h1>\n<canvas data-view="view"></canvas>\n<p class="said"></p>'
        parts = {
            "title": escape(self._title),
            "style": style,
            "body": body,
            "views": views,
            "program": "\n".join((folder / name).read_text(encoding="utf-8") for name in _SCRIPTS),
        }
        page = ""
        # Marks come in this order; what stands in their place is not searched for marks.
        for name in ("title", "style", "body", "views", "program"):
            before, mark, frame = frame.partition(f"{{{name}}}")
            assert mark, name
            page += before + parts[name]
        return page + frame

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write the page as a file.

        Parameters
        ----------
        path : str | os.PathLike[str]
            the file, .html.
        """
        Path(path).write_text(self.html, encoding="utf-8")

    def _repr_html_(self) -> str:
        """The page in a frame of its own, as notebooks show it."""
        return f'<iframe srcdoc="{escape(self.html)}" style="width:100%;height:620px;border:0" title="{escape(self._title)}"></iframe>'

    def __repr__(self) -> str:
        return f"<ricci.Page: {self._title}, {len(self._sides.points)} vertices>"


def _numbers(values: npt.NDArray[Any], kind: str) -> str:
    return base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode()


def _packed_points(points: npt.NDArray[Any]) -> dict[str, Any]:
    """Points as numbers of 16 bits, in steps of the longest side of their box."""
    low = points.min(0)
    step = float(max(np.ptp(points, axis=0).max(), np.finfo(float).tiny)) / _MOST
    return {"from": low.tolist(), "step": step, "data": _numbers(np.round((points - low) / step), "<u2")}


def _packed_quantity(name: str, values: npt.NDArray[Any]) -> dict[str, Any]:
    """A number for each vertex in 16 bits; those below and above a hundredth of all are at the ends of the range."""
    finite = values[np.isfinite(values)]
    low, high = np.quantile(finite, [0.01, 0.99]).tolist() if finite.size else (0.0, 0.0)
    if high <= low:
        low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
    share = np.clip((values - low) / (high - low if high > low else 1.0), 0, 1) * (_MOST - 1)
    return {"name": name, "low": low, "high": high, "data": _numbers(np.where(np.isfinite(values), np.round(share), _MOST), "<u2")}


def _packed(sides: Sides) -> dict[str, Any]:
    """The data of a view."""
    n = len(sides.points)
    wide = n > _MOST
    image = sides.image
    flat = image is not None and image.shape[1] == 2
    if image is not None and flat:
        image = np.pad(image, ((0, 0), (0, 1)))
    # The direction in which a surface spreads least is looked along, and the one of its second side is up.
    spread = np.ptp(sides.points, axis=0)
    up = np.zeros(3)
    up[np.argsort(spread, kind="stable")[1]] = 1.0
    return {
        "vertices": n,
        "faces": len(sides.faces),
        "wide": wide,
        "corners": _numbers(sides.faces, "<u4" if wide else "<u2"),
        "surface": _packed_points(sides.points),
        "image": None if image is None else _packed_points(image),
        "flat": flat,
        "cut": flat,
        "up": up.tolist(),
        "lies": False,
        "quantities": [_packed_quantity(name, np.asarray(values, float)[sides.origins]) for name, values in sides.quantities.items()],
    }


def _sides_of(thing: Shown) -> Sides:
    """What a page shows of an object.

    Raises
    ------
    ArgumentError
        an object without a surface in space.
    """
    own = getattr(thing, "_sides", None)
    if own is not None:
        found: Sides = Sides(*own())
        return found
    cut = getattr(thing, "_cut_open", None)
    if cut is not None:
        points, faces, image, origins = cut()
        return Sides(points, faces, image, origins, {})
    scene = thing._scene()
    if scene is None or scene.points.shape[1] == 2:
        raise ArgumentError(f"a ricci.{type(thing).__name__} has no surface in space that could be shown")
    quantities = {scene.label: scene.values} if scene.label and scene.values is not None and len(scene.values) == len(scene.points) else {}
    return Sides(scene.points, scene.faces, None, np.arange(len(scene.points)), quantities)


def show(
    thing: Any, values: Mapping[str, npt.ArrayLike] | npt.ArrayLike | None = None, *, path: str | os.PathLike[str] | None = None
) -> Page:
    """A page in which a surface turns: with its layout or its image beside it, where it has one.

    The same place is marked on both sides where one is pointed at; checks of one pattern, whose density a slider sets, lie on both, and
    seams and quantities are switched on and off. The page needs no network and no other file.

    Parameters
    ----------
    thing : Any
        a `Layout`, `Charts`, `RepairedInput`, `Uniform`, `Matching`, or any other object with a surface in space.
    values : Mapping[str, npt.ArrayLike] | npt.ArrayLike | None
        numbers for each vertex of the mesh, or of them several by names, which are shown in colours.
    path : str | os.PathLike[str] | None
        a file that the page is written to as well.

    Returns
    -------
    Page
        the page, which notebooks show.

    Raises
    ------
    ArgumentError
        nothing in space to be shown; values of another number.

    Examples
    --------
    >>> laid = ricci.layout(ricci.flow(ricci.make("disk", n=4)))
    >>> ricci.show(laid, {"height": laid.mesh.V[:, 2]}, path="disk.html")
    <ricci.Page: Layout, 61 vertices>
    """
    if not isinstance(thing, Shown):
        raise ArgumentTypeError(f"an object of this package is shown, not {type(thing).__name__}: ricci.as_mesh makes a mesh of it")
    sides = _sides_of(thing)
    n = int(sides.origins.max()) + 1
    named = values if isinstance(values, Mapping) else {} if values is None else {"values": values}
    given = {}
    for name, numbers in named.items():
        array = _arrays.numbers(numbers, str(name)).astype(float)
        if array.shape != (n,):
            raise ArgumentError(f"{name} has shape {array.shape}, ({n},) is needed")
        given[str(name)] = array
    page = Page(type(thing).__name__, sides._replace(quantities={**given, **sides.quantities}))
    if path is not None:
        page.write(path)
    return page
