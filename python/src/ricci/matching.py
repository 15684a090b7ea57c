"""Maps between two surfaces of the same topology."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, ClassVar, Literal, TypedDict

import numpy as np
import numpy.typing as npt

from ricci import _arrays
from ricci._arrays import frozen
from ricci._call import CONTROL, Doubles, Indices, call, constant, doubles, figures_of, filled, pointer, summary
from ricci._kept import Kept
from ricci._labels import Mode, Pieces, conserved, heaviest, mode_of
from ricci._library import ffi, lib
from ricci._shown import Scene
from ricci._signatures import picked, takes
from ricci._structs import Struct, Write, above_zero, choice, index_list, known, options, real_list
from ricci.adapters import MeshLike, as_mesh
from ricci.control import Progress
from ricci.errors import ArgumentError, ArgumentTypeError
from ricci.figures import FoundLandmarks, MatchingJudgement, MatchingSummary
from ricci.maps import Map
from ricci.mesh import Mesh

__all__ = ["MatchOptions", "Matching", "Points", "match"]

Direction = Literal["forward", "backward"]
# Pairs of lists: the first on the source, the second on the target.
Pairs = Sequence[tuple[npt.ArrayLike, npt.ArrayLike]]


class Points(TypedDict):
    """Pairs of points that correspond.

    Attributes
    ----------
    faces : npt.ArrayLike
        k x 2, of the source and of the target.
    weights : npt.ArrayLike
        k x 2 x 3 barycentric coordinates in these faces, each three with the sum 1.
    """

    faces: npt.ArrayLike
    weights: npt.ArrayLike


class MatchOptions(TypedDict, total=False):
    """Options of a map between surfaces: the points and curves that correspond, and the boundary.

    Attributes
    ----------
    landmarks : npt.ArrayLike | Literal["auto"]
        k x 2 vertices, of the source and of the target, that correspond; ``"auto"``: they are found by the shapes of the surfaces where
        they make the map better, and nothing else can say what corresponds but `loops`, `boundary` and `basis`.
    loops : npt.ArrayLike
        for each boundary loop of the source that of the target; by landmarks on them, the others by descending length.
    points : Points
        pairs of points that correspond as landmarks do.
    curves : Pairs
        pairs of curves that correspond by shares of their lengths, as lists of vertices joined by edges.
    soft : npt.ArrayLike
        k x 2 vertices inside that need not be met.
    soft_weights : npt.ArrayLike
        k weights w >= 0: a landmark goes to the share w / (1 + w) of its way.
    boundary : Literal["slides", "arc_length"]
        it ``"slides"`` until the map is harmonic, or goes by ``"arc_length"``.
    loop_shape : Literal["geodesics", "circles"]
        boundary loops of surfaces with handles become ``"geodesics"``, or ``"circles"`` of a closed flat or hyperbolic surface.
    basis : Pairs
        pairs of closed edge paths that name the homotopy class, on surfaces with handles.
    threads : int
        one per core. The result does not depend on it.
    mirror : bool
        true if the map turns the surface over, as from a left half of a brain to a right one: the mirror image of the source is
        mapped. All options and results have the numbers of the source itself.
    """

    landmarks: npt.ArrayLike | Literal["auto"]
    loops: npt.ArrayLike
    points: Points
    curves: Pairs
    soft: npt.ArrayLike
    soft_weights: npt.ArrayLike
    boundary: Literal["slides", "arc_length"]
    loop_shape: Literal["geodesics", "circles"]
    basis: Pairs
    threads: int
    mirror: bool


def _direction(name: Direction) -> int:
    return constant("MATCH", name, ("forward", "backward"))


def _points(struct: Struct, _: str, value: Points) -> None:
    faces, weights = _arrays.indices(value["faces"], 2, "faces"), _arrays.real(value["weights"])
    if weights.shape != (len(faces), 2, 3):
        raise ArgumentError(f"weights have shape {weights.shape}, ({len(faces)}, 2, 3) is needed")
    struct.put("point_faces", faces)
    struct.put("point_weights", weights)
    struct.put("n_points", len(faces))


def _curves(struct: Struct, _: str, value: Pairs) -> None:
    lists = [_arrays.indices(part, name="curves") for pair in value for part in pair]
    struct.put("curves", np.concatenate([np.empty(0, np.uint32), *lists]))
    struct.put("curve_sizes", np.array([part.size for part in lists], np.uint32))
    struct.put("n_curves", len(value))


def _basis(struct: Struct, _: str, value: Pairs) -> None:
    edges, starts = _arrays.joined(part for pair in value for part in pair)
    struct.put("basis", edges)
    struct.put("basis_sizes", np.diff(starts).astype(np.uint32))
    struct.put("n_basis", len(value))


_MATCH: dict[str, Write] = {
    "landmarks": index_list("n_landmarks", 2),
    "loops": index_list("n_loops"),
    "points": _points,
    "curves": _curves,
    "soft": index_list("n_soft", 2),
    "soft_weights": real_list(),
    "boundary": choice("MATCH", ("slides", "arc_length")),
    "loop_shape": choice("MATCH", ("geodesics", "circles")),
    "basis": _basis,
    "threads": above_zero,
}


# The corners of a face of the mirror image.
_TURNED = [0, 2, 1]


def _of_mirrored(given: dict[str, Any], source: Mesh, image: Mesh) -> dict[str, Any]:
    """Options that speak of a surface, as they are for its mirror image: other orders of corners, of boundary loops and of edges."""
    found = dict(given)
    if given.get("points") is not None:
        weights = _arrays.real(given["points"]["weights"]).copy()
        weights[:, 0] = weights[:, 0][:, _TURNED]
        found["points"] = {**given["points"], "weights": weights}
    if np.shape(given.get("loops", ())) == (len(source.boundary),):
        first = {int(loop.min()): k for k, loop in enumerate(source.boundary)}
        found["loops"] = [given["loops"][first[int(loop.min())]] for loop in image.boundary]
    if given.get("basis") is not None:
        edges = np.empty(source.summary.n_edges, np.int32)
        ours, theirs = source.face_edges[:, _TURNED], image.face_edges
        # In the image a face runs along its edges the other way round.
        edges[np.abs(ours) - 1] = -np.sign(ours) * theirs
        found["basis"] = [([int(np.sign(e)) * int(edges[abs(e) - 1]) for e in path], other) for path, other in given["basis"]]
    return found


class Matching(Kept):
    """A map between two surfaces and its inverse; no face folds. It never changes.

    Examples
    --------
    >>> found = ricci.match(ricci.make("sphere", n=4), ricci.make("sphere", n=5))
    >>> found.summary.n_flipped
    0
    >>> bool(found.weights().min() >= 0)
    True
    """

    # The surfaces, whose faces labels are looked up in.
    _source: Mesh
    _target: Mesh
    # Whether the map turns the source over: then the library has its mirror image, whose faces have two corners exchanged.
    _mirror: bool = False

    _type: ClassVar[str] = "matching"
    _made_by: ClassVar[str] = "ricci.match(source, target)"
    _figures: ClassVar[tuple[str, ...]] = ("n_source_vertices", "n_target_vertices", "n_flipped", "qc_mean", "qc_max", "distance_mean")

    def _come_from(self, found: Mapping[str, Any]) -> None:
        self._mirror = found["mirrored"]
        self._source = found["mesh"].mirrored() if self._mirror else found["mesh"]
        self._target = found["target"]

    def _sides(self) -> tuple[Any, ...]:
        """The source and its image on the target."""
        if not (self._source.summary.has_positions and self._target.summary.has_positions):
            raise ArgumentError("a map between intrinsic surfaces has no places in space that could be shown")
        return self._source.V, self._source.F, self.carry(self._target.V), np.arange(self._source.n_vertices), {}

    def _scene(self) -> Scene | None:
        if not (self._source.summary.has_positions and self._target.summary.has_positions):
            return None
        image = self.carry(self._target.V)
        return Scene(self._source.V, self._source.F, image[:, np.ptp(image, axis=0).argmax()], "coordinate of the image")

    @cached_property
    def summary(self) -> MatchingSummary:
        """Distortion, distances, energy."""
        return summary(MatchingSummary, "matching", self)

    def judgement(self, progress: Progress = None) -> MatchingJudgement:
        """How much the map distorts, whether it brings alike points to each other, and what it is good for.

        Parameters
        ----------
        progress : Progress
            a `Control` or a callback.

        Raises
        ------
        ArgumentError
            a surface without positions.
        """
        out = ffi.new("ricci_matching_judgement *")
        call(lib.ricci_matching_judge, self, CONTROL, out, ffi.sizeof("ricci_matching_judgement"), progress=progress)
        return figures_of(MatchingJudgement, out)

    @cached_property
    def found(self) -> FoundLandmarks:
        """What was found of landmarks with ``landmarks="auto"``; without that, and from an archive, no candidates."""
        out = ffi.new("ricci_found_landmarks *")
        call(lib.ricci_matching_found, self, out, ffi.sizeof("ricci_found_landmarks"))
        return figures_of(FoundLandmarks, out)

    def landmarks(self, kind: Literal["used", "kept", "mirrored"] = "used") -> Indices:
        """k x 2 vertices of the source and of the target that correspond; an archive keeps none.

        A surface with a plane of symmetry has two maps that fit equally well. That which turns the surface over is
        ``match(source, target, landmarks=found.landmarks("mirrored"), mirror=True)``.

        Parameters
        ----------
        kind : Literal["used", "kept", "mirrored"]
            ``"used"``: those that the map meets, without points and curves. Those that ``landmarks="auto"`` found, by the best candidate
            that keeps the sides of the surface (``"kept"``), or turns it over (``"mirrored"``).

        Examples
        --------
        >>> egg = ricci.make("ellipsoid", n=5, a=2, b=1, c=0.8)
        >>> found = ricci.match(egg, egg, landmarks="auto")
        >>> found.landmarks("mirrored").shape[1]
        2
        """
        which = constant("LANDMARKS", kind, ("used", "kept", "mirrored"))
        sizes = (self.found.n_used, self.found.n_kept, self.found.n_mirrored)
        return filled(lib.ricci_matching_landmarks, self, which, out=np.empty((sizes[which], 2), np.uint32))

    def faces(self, direction: Direction = "forward") -> Indices:
        """The face of the other surface that every vertex goes to."""
        out = np.empty(self._size(direction), np.uint32)
        return filled(lib.ricci_matching_faces, self, _direction(direction), out=out)

    def weights(self, direction: Direction = "forward") -> Doubles:
        """n x 3 barycentric coordinates of the images in their faces, not negative, with the sum 1."""
        found = doubles(lib.ricci_matching_weights, self, _direction(direction), shape=(self._size(direction), 3))
        return found[:, _TURNED] if self._mirror and direction == "backward" else found

    def carry(self, values: npt.ArrayLike, direction: Direction = "forward", mode: Mode | None = None) -> npt.NDArray[Any]:
        """Values at the vertices of the surface that the map leads to (n, or n x k), brought to those where it comes from.

        ``carry(V_target)`` has the image of every vertex of the source. Whole numbers and flags are labels, such as those of parcels: a
        vertex gets the label that has the most weight in the face of its image, and the result has the type of `values`.

        Parameters
        ----------
        values : npt.ArrayLike
            one row for each vertex.
        direction : Direction
            ``"forward"``: from the target to the source.
        mode : Literal["nearest", "linear", "conservative"] | None
            ``"nearest"``: as labels. ``"linear"``: the value at the image of each vertex. ``"conservative"``: a density for each unit of
            area, whose integral over the surface stays the same; an amount for each vertex is one divided by the vertex's area. None:
            nearest for whole numbers and flags, which are never averaged, else linear.

        Raises
        ------
        ArgumentTypeError
            complex numbers (carry the two parts), texts (carry their numbers), whole numbers that are to be averaged.
        ArgumentError
            rows of another number; densities on surfaces without positions.
        """
        given = _arrays.numbers(values)
        other = self._size("backward" if direction == "forward" else "forward")
        if given.ndim == 0 or len(given) != other:
            raise ArgumentError(f"values have shape {given.shape}, {other} rows are needed")
        how = mode_of(given, mode)
        if how == "conservative":
            start, end = self._pieces[::-1] if direction == "forward" else self._pieces
            return conserved(_arrays.real(given), start, end)
        if how == "nearest":
            corners = (self._target if direction == "forward" else self._source).F
            return heaviest(given[corners[self.faces(direction)]], self.weights(direction))
        array = _arrays.real(given)
        shape = (self._size(direction), *array.shape[1:])
        return doubles(lib.ricci_matching_carry, self, _direction(direction), pointer(array), array.size, shape=shape)

    @cached_property
    def _pieces(self) -> tuple[Pieces, Pieces]:
        """The common subdivision as parts of the faces of the source and of the target."""
        if not (self._source.summary.has_positions and self._target.summary.has_positions):
            raise ArgumentError("densities are carried between surfaces with positions, whose areas are those in space")
        both = self.map()
        weights = both.barycentric("input")
        source = Pieces(self._source.V, self._source.F, both.faces("input"), weights[:, :, _TURNED] if self._mirror else weights)
        return source, Pieces(self._target.V, self._target.F, both.faces("metric"), both.barycentric("metric"))

    @cached_property
    def points(self) -> tuple[Indices, Doubles]:
        """The images of points that correspond, and their given partners: faces (k x 2) and weights (k x 2 x 3) on the target."""
        n = self.summary.n_points
        faces, weights = np.empty((n, 2), np.uint32), np.empty((n, 2, 3))
        call(lib.ricci_matching_points, self, pointer(faces), faces.size, pointer(weights), weights.size)
        return frozen(faces), frozen(weights)

    @cached_property
    def soft_left(self) -> Doubles:
        """The distance of each soft landmark's image from its partner, a length on the target."""
        return frozen(doubles(lib.ricci_matching_soft_left, self, shape=(self.summary.n_soft,)))

    def map(self, progress: Progress = None) -> Map:
        """The common subdivision of the two surfaces: in its methods ``"input"`` is the source and ``"metric"`` the target.

        With ``mirror`` it is that of the source's mirror image, `Mesh.mirrored`.
        """
        made = Map._made(lib.ricci_matching_map, self, CONTROL, progress=progress)
        made._target = self._target
        return made

    def _size(self, direction: Direction) -> int:
        s = self.summary
        return s.n_source_vertices if direction == "forward" else s.n_target_vertices

    def __repr__(self) -> str:
        s = self.summary
        return f"<ricci.Matching: {s.n_source_vertices} to {s.n_target_vertices} vertices, mean dilatation {s.qc_mean:.3f}>"


@takes(MatchOptions)
def match(
    source: MeshLike,
    target: MeshLike,
    progress: Progress = None,
    *,
    landmarks: npt.ArrayLike | Literal["auto"] | None = None,
    loops: npt.ArrayLike | None = None,
    points: Points | None = None,
    curves: Pairs | None = None,
    soft: npt.ArrayLike | None = None,
    soft_weights: npt.ArrayLike | None = None,
    boundary: Literal["slides", "arc_length"] = "slides",
    loop_shape: Literal["geodesics", "circles"] = "geodesics",
    basis: Pairs | None = None,
    threads: int | None = None,
    mirror: bool = False,
) -> Matching:
    """The map from one surface to another one of the same topology: harmonic into the target's metric of constant curvature.

    Parameters
    ----------
    source : MeshLike
        the surface whose vertices are mapped: a mesh of any kind (`as_mesh`), or a pair (V, F).
    target : MeshLike
        the surface that they are mapped to.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    MatchingError
        surfaces of different topology, landmarks in conflict, no map found.

    Examples
    --------
    >>> a, b = ricci.make("sphere", n=4), ricci.make("ellipsoid", n=5)
    >>> found = ricci.match(a, b)
    >>> found.carry(b.V).shape == a.V.shape
    True
    """
    given = picked(locals(), MatchOptions)
    hard: dict[str, Any] = dict(given.items())
    mirror = hard.pop("mirror", False)
    if not isinstance(mirror, bool | np.bool_):
        raise ArgumentTypeError(f"mirror is {mirror!r}: it is True or False")
    if np.size(hard.get("soft", ())) != 2 * np.size(hard.get("soft_weights", ())):
        raise ArgumentError("soft and soft_weights: one weight for every pair")
    is_found = isinstance(landmarks, str)
    if is_found:
        if landmarks != "auto":
            raise ArgumentError(f"landmarks is {landmarks!r}: it is 'auto' or pairs of vertices")
        if any(hard.get(name) is not None for name in ("points", "curves", "soft")):
            raise ArgumentError("landmarks='auto' finds what corresponds: points, curves and soft landmarks are not for it")
        del hard["landmarks"]
    known(hard, _MATCH)
    start, end = as_mesh(source), as_mesh(target)
    image = start.mirrored() if mirror else start
    struct = options("match_options", _of_mirrored(hard, start, image) if mirror else hard, _MATCH)
    made = Matching._made(lib.ricci_match_by_shape if is_found else lib.ricci_match, image, end, struct, CONTROL, progress=progress)
    made._source, made._target, made._mirror = start, end, bool(mirror)
    return made
