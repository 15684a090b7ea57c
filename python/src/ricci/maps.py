"""Maps: common subdivisions of two triangulations, and values that are carried from one triangulation to the other."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any, ClassVar, Literal

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._arrays import frozen
from ricci._call import CONTROL, Doubles, Indices, call, constant, doubles, filled, pointer, signed_view, summary
from ricci._kept import Kept
from ricci._labels import heaviest, mode_of
from ricci._library import lib
from ricci._shown import Scene
from ricci._structs import Struct
from ricci.control import Progress
from ricci.errors import ArgumentError
from ricci.figures import MapSummary
from ricci.figures.names import On
from ricci.mesh import Mesh
from ricci.metrics import Metric

__all__ = ["Map"]

Side = Literal["input", "metric"]


class Map(Kept):
    """The common subdivision of the mesh that a metric was made from and the metric's triangulation.

    Its faces are parts of faces of both; its vertices are those of the mesh, with their numbers, then the crossings of edges. Of a
    `Matching`, ``"input"`` means the source and ``"metric"`` the target.

    Parameters
    ----------
    metric : Metric
        the result of a flow.
    progress : Progress
        a `Control` or a callback.

    Examples
    --------
    >>> flat = ricci.flow(ricci.make("torus", n=16))
    >>> over = ricci.Map(flat)
    >>> over.carry(flat.factor).shape == (over.summary.n_vertices,)
    True
    """

    # The mesh of the side "metric".
    _target: Mesh

    _type: ClassVar[str] = "map"
    _made_by: ClassVar[str] = "ricci.Map(metric)"
    _figures: ClassVar[tuple[str, ...]] = ("n_vertices", "n_edges", "n_faces", "n_crossings", "n_pieces")

    def __init__(self, metric: Metric, progress: Progress = None) -> None:
        self._pointer = Map._made(lib.ricci_map_new, metric, CONTROL, progress=progress)._pointer
        self._target: Mesh = metric.triangulation

    def _scene(self) -> Scene | None:
        return Scene(self.mesh.V, self.mesh.F, self.faces() * 0.6180339887498949 % 1)

    def _come_from(self, found: Mapping[str, Any]) -> None:
        self._target = found["target"]

    @cached_property
    def summary(self) -> MapSummary:
        """Counts."""
        return summary(MapSummary, "map", self)

    @cached_property
    def mesh(self) -> Mesh:
        """The common subdivision in space: the given vertices where they were, then the crossings."""
        return Mesh._made(lib.ricci_map_mesh, self)

    def faces(self, on: On = "input") -> Indices:
        """The face that each of the n_faces faces is part of; on ``"refinement"`` the piece with one projective map."""
        out = np.empty(self.summary.n_faces, np.uint32)
        return filled(lib.ricci_map_faces, self, constant("ON", on), out=out)

    def barycentric(self, on: Side = "input") -> Doubles:
        """n_faces x 3 x 3 weights [face, corner, corner of the face that it is part of]."""
        return doubles(lib.ricci_map_barycentric, self, constant("ON", on), shape=(self.summary.n_faces, 3, 3))

    def crossings(self, on: Side = "input") -> tuple[Indices, Doubles]:
        """For each crossing the edge that it lies on (a row of that mesh's `edges`), and how far from its first end, 0 to 1."""
        edges, fractions = np.empty(self.summary.n_crossings, np.uint32), np.empty(self.summary.n_crossings)
        call(lib.ricci_map_crossings, self, constant("ON", on), pointer(edges), pointer(fractions), edges.size)
        return signed_view(edges), fractions

    @cached_property
    def weights(self) -> Doubles:
        """The homogeneous weight q of every vertex: with (x, y) in a layout, (q x, q y, q) is linear on every piece."""
        return frozen(doubles(lib.ricci_map_weights, self, shape=(self.summary.n_vertices,)))

    def carry(
        self,
        values: npt.ArrayLike,
        on: Side = "input",
        at: Literal["vertices", "corners"] = "vertices",
        mode: Literal["nearest", "linear"] | None = None,
    ) -> npt.NDArray[Any]:
        """Values at vertices (n, or n x k) or corners (m x 3, or m x 3 x k), carried to those of the subdivision.

        Whole numbers and flags are labels: a point gets the one that has the most weight in its face, and the result has their type.

        Parameters
        ----------
        values : npt.ArrayLike
            one row for each vertex or face.
        on : Side
            the side that they are on.
        at : Literal["vertices", "corners"]
            where they are.
        mode : Literal["nearest", "linear"] | None
            ``"nearest"``: as labels; ``"linear"``: interpolated, which whole numbers never are; None: by their type.

        Raises
        ------
        ArgumentTypeError
            complex numbers (carry the two parts), texts (carry their numbers), whole numbers that are to be interpolated.
        """
        array = _arrays.numbers(values)
        lead = 1 if at == "vertices" else 2
        if array.ndim < lead or (lead == 2 and array.shape[1] != 3):
            raise ArgumentError(f"values at {at} have shape {array.shape}")
        how = mode_of(array, mode)
        if how == "conservative":
            raise ArgumentError("a subdivision has its values where they were: conservative is a mode of Matching.carry")
        if how == "nearest":
            return self._carry_labels(array, on, at)
        array = _arrays.real(array)
        rest = array.shape[lead:]
        struct = Struct("carried")
        struct.put("on", constant("ON", on))
        struct.put("at", constant("AT", at))
        struct.put("values", array)
        struct.put("n_values", len(array))
        struct.put("n_components", int(np.prod(rest, dtype=int)))
        own = (self.summary.n_vertices,) if lead == 1 else (self.summary.n_faces, 3)
        return doubles(lib.ricci_map_carry, self, struct, shape=own + rest)

    def _carry_labels(self, labels: npt.NDArray[Any], on: Side, at: str) -> npt.NDArray[Any]:
        """Labels at vertices or corners of a side, at those of the subdivision."""
        parents, weights, faces = self.faces(on), self.barycentric(on), self.mesh.F
        corners = None if at == "corners" else self._target.F if on == "metric" else self._input_faces(faces, parents, weights)
        needed = int((parents if corners is None else corners).max()) + 1
        if len(labels) != needed:
            raise ArgumentError(f"there are {len(labels)} rows of labels, {needed} are needed")
        of_face = labels[parents] if corners is None else labels[corners[parents]]
        found = np.stack([heaviest(of_face, weights[:, corner]) for corner in range(3)], axis=1)
        if at == "corners":
            return found
        out = np.empty((self.summary.n_vertices, *labels.shape[1:]), labels.dtype)
        out[faces] = found
        return out

    def _input_faces(self, faces: Indices, parents: Indices, weights: Doubles) -> Indices:
        """The vertices of the faces of the given mesh: where the pieces of a face have its corners, with all the weight."""
        found = np.zeros((int(parents.max()) + 1, 3), np.int32)
        piece, corner, place = np.nonzero(weights == 1)
        found[parents[piece], place] = faces[piece, corner]
        return found
