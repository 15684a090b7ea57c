"""What consoles and notebooks show of an object: its kind, six figures of it, and a picture; and its plot."""

from __future__ import annotations

import importlib.util
from typing import Any, ClassVar, Literal

import numpy as np
import numpy.typing as npt

from ricci import _pictures
from ricci._pictures import Scene
from ricci.errors import ArgumentError, RicciError

__all__ = ["Backend", "Scene", "Shown"]

Backend = Literal["matplotlib", "pyvista"]


class Shown:
    """An object with a summary that can be shown."""

    summary: Any
    # The fields of its summary that are shown.
    _figures: ClassVar[tuple[str, ...]] = ()

    def _scene(self) -> Scene | None:
        """What there is to be seen of it, or None."""
        return None

    def _figure_texts(self) -> dict[str, str]:
        return {name: _text(getattr(self.summary, name)) for name in self._figures}

    def __repr__(self) -> str:
        told = ", ".join(f"{name.removeprefix('n_')} {value}" for name, value in list(self._figure_texts().items())[:4])
        return f"<ricci.{type(self).__name__}{': ' if told else ''}{told}>"

    def _repr_html_(self) -> str:
        """The figures and the picture, as notebooks show them."""
        try:
            scene = self._scene()
        except RicciError:
            # An intrinsic surface, or one that cannot be unfolded.
            scene = None
        return _pictures.html(f"ricci.{type(self).__name__}", self._figure_texts(), scene)

    def plot(self, values: npt.ArrayLike | None = None, *, ax: Any = None, backend: Backend | None = None) -> Any:
        """Plot the object with matplotlib or PyVista, whichever is there.

        Parameters
        ----------
        values : npt.ArrayLike | None
            A number for each vertex or each face of what is plotted, shown in colours; None: those of the object's picture.
        ax : Any
            The axes of matplotlib to plot into; None: new ones.
        backend : Backend | None
            ``"matplotlib"`` or ``"pyvista"``; None: what is in space by PyVista if it is installed and no axes are given.

        Returns
        -------
        Any
            The axes of matplotlib, or a `pyvista.Plotter`, whose method `show` opens it.

        Raises
        ------
        ArgumentError
            there is nothing to be seen, as of an intrinsic surface; values of another number.
        ImportError
            neither package is installed.
        """
        scene = self._scene()
        if scene is None:
            raise ArgumentError(f"there is nothing to be seen of this ricci.{type(self).__name__}")
        if values is not None:
            given = np.asarray(values, float)
            if given.shape not in ((len(scene.points),), (len(scene.faces),)):
                raise ArgumentError(f"values have shape {given.shape}: ({len(scene.points)},) or ({len(scene.faces)},) is needed")
            scene = scene._replace(values=given, label="")
        if backend is None:
            by_pyvista = scene.points.shape[1] == 3 and ax is None and importlib.util.find_spec("pyvista") is not None
            backend = "pyvista" if by_pyvista else "matplotlib"
        if backend not in ("matplotlib", "pyvista"):
            raise ArgumentError(f"backend {backend!r} is none of matplotlib, pyvista")
        return _by_pyvista(scene) if backend == "pyvista" else _by_matplotlib(scene, ax)


def _text(value: Any) -> str:
    """A figure in few characters."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, complex):
        return f"{value.real:.4g} {'-' if value.imag < 0 else '+'} {abs(value.imag):.4g}i"
    return ", ".join(map(_text, value)) if isinstance(value, tuple) else str(value)


def _by_matplotlib(scene: Scene, ax: Any) -> Any:
    """A plot of a scene by matplotlib; its axes."""
    from matplotlib import pyplot

    flat = scene.points.shape[1] == 2
    if ax is None:
        ax = pyplot.figure().add_subplot(projection=None if flat else "3d")
    points = np.asarray(scene.points, float)
    faces = scene.faces[np.isfinite(points).all(1)[scene.faces].all(1)]
    values = None
    if scene.values is not None:
        values = np.asarray(scene.values, float)
        values = values[faces].mean(1) if len(values) == len(points) else values[np.isfinite(points).all(1)[scene.faces].all(1)]
    points = np.nan_to_num(points)
    if flat and values is None:
        ax.triplot(points[:, 0], points[:, 1], faces, linewidth=0.4)
    elif flat:
        ax.tripcolor(points[:, 0], points[:, 1], faces, facecolors=values)
    else:
        drawn = ax.plot_trisurf(*points.T, triangles=faces, linewidth=0)
        if values is not None:
            drawn.set_array(values)
            drawn.autoscale()
    ax.set_aspect("equal")
    return ax


def _by_pyvista(scene: Scene) -> Any:
    """A plot of a scene by PyVista: a plotter."""
    import pyvista

    points = np.asarray(scene.points, float)
    if points.shape[1] == 2:
        points = np.pad(points, ((0, 0), (0, 1)))
    finite = np.isfinite(points).all(1)[scene.faces].all(1)
    surface = pyvista.PolyData.from_regular_faces(np.nan_to_num(points), np.asarray(scene.faces, np.int64)[finite])
    plotter = pyvista.Plotter()
    if scene.values is None:
        plotter.add_mesh(surface)
    else:
        values = np.asarray(scene.values, float)
        name = scene.label or "values"
        if len(values) == len(scene.faces):
            surface.cell_data[name] = values[finite]
        else:
            surface.point_data[name] = values
        plotter.add_mesh(surface, scalars=name)
    return plotter
