"""Golden vectors (tests/vectors), with hexadecimal doubles from 60 digits and from exact arithmetic: the same that Rust and C read."""

from collections import Counter

import numpy as np
import pytest

import ricci
from conftest import ROOT

VECTORS = ROOT / "tests" / "vectors"
# As the C test has them: of curvature, of weights, and of what a flow ends at.
CURVATURE, ETA, SOLUTION = 1e-14, 1e-13, 1e-12
# Of the lengths of a triangle, relative, times what an angle in radians makes of it.
ROUNDING = 8 * np.finfo(float).eps


def hexes(words):
    return np.array([float.fromhex(word) for word in words])


def blocks(name):
    """The blocks of a file, from their first line to `end`: the words behind each key, in lists of lines."""
    block = []
    for line in (VECTORS / name).read_text().splitlines():
        if line == "end":
            yield block
            block = []
        else:
            key, *words = line.split()
            block.append((key, words))
    assert block == []


def surfaces():
    return [dict(block) for block in blocks("surfaces.txt")]


def test_all_vectors_are_read():
    assert len(surfaces()) == 40
    assert Counter(block["surface"][3] for block in surfaces()).keys() == {"yamabe", "inversive", "thurston", "tangential", "virtual"}


def agree(block):
    """Hold one block against what the library computes of its lengths and its target."""
    _, geometry, space, scheme = block["surface"]
    faces = np.array(block["faces"], int).reshape(-1, 3)
    mesh = ricci.Mesh.from_gluing(faces, np.array(block["face_edges"], int).reshape(-1, 3), hexes(block["lengths"]), geometry)
    start = ricci.metric(mesh, space=geometry, scheme=scheme)
    assert np.abs(start.eta - hexes(block["eta"])).max() < ETA
    assert np.abs(start.curvature - hexes(block["curvature"])).max() < CURVATURE
    if "target" in block:
        flat = ricci.flow(mesh, target=hexes(block["target"]), space=space, scheme=scheme, flips="never")
        assert flat.converged
        assert np.abs(flat.u - hexes(block["u"])).max() < SOLUTION
        assert np.abs(flat.lengths - hexes(block["solution"])).max() < SOLUTION


@pytest.mark.parametrize("block", surfaces(), ids=lambda block: "-".join(block["surface"]))
def test_metrics_and_flows_agree_with_sixty_digits(block):
    agree(block)


@pytest.mark.parametrize(
    ("key", "change"), [("curvature", 2 * CURVATURE), ("eta", 2 * ETA), ("u", 2 * SOLUTION), ("solution", 2 * SOLUTION)]
)
def test_a_vector_that_is_changed_is_seen(key, change):
    block = next(block for block in surfaces() if key in block)
    for at in range(len(block[key])):
        words = list(block[key])
        words[at] = (float.fromhex(words[at]) + change).hex()
        with pytest.raises(AssertionError):
            agree({**block, key: words})


def test_single_triangles_have_their_angles_and_areas():
    """A triangle is a surface whose curvature at a corner is pi minus its angle.

    Its lengths go through the variables of the class, whose rounding moves an angle by so many times as the triangle is thin, and the area,
    a root of the half-perimeter's small differences, by the square of that.
    """
    lines = (VECTORS / "triangles.txt").read_text().splitlines()
    assert len(lines) > 60
    for line in lines:
        space, *words = line.split()
        lengths, angles, area = np.split(hexes(words), [3, 6])
        mesh = ricci.Mesh.from_gluing([[0, 1, 2]], [[1, 2, 3]], lengths, space)
        start = ricci.metric(mesh, space=space)
        thin = 1 / np.sin(angles).min()
        assert np.abs(np.pi - start.curvature - angles).max() < ROUNDING * thin, line
        assert start.summary.area == pytest.approx(area[0], rel=ROUNDING * thin**2, abs=0), line


@pytest.mark.parametrize("block", list(blocks("splines.txt")), ids=lambda block: "-".join(block[0][1]))
def test_splines_agree_with_exact_arithmetic(block):
    one = dict(block)
    degree = int(one["spline"][0])
    vertices = hexes(one["vertices"]).reshape(-1, 2)
    domain = ricci.Mesh(np.pad(vertices, ((0, 0), (0, 1))), np.array(one["triangles"], int).reshape(-1, 3))
    spline = ricci.Spline.plane(domain, degree=degree, knots=hexes(one["knots"]))
    given = hexes(one["control"]).reshape(*spline.controls.shape, 3)
    points = np.empty((spline.summary.n_control_points, 3))
    points[spline.controls] = given
    assert np.array_equal(points[spline.controls], given), "control points that are one have one place"
    rows = [words for key, words in block if key == "place"]
    numbers = np.array([hexes(words[1:]) for words in rows])
    found = spline.with_points(points).evaluate(numbers[:, :2], patches=[int(words[0]) for words in rows], what="second")
    expected = numbers[:, 2:].reshape(-1, 6, 3)
    assert len(rows) == 6
    # Derivatives grow with the powers of the knots' distances: each order is held to its own size.
    for part in (slice(0, 1), slice(1, 3), slice(3, 6)):
        size = max(1.0, np.abs(expected[:, part]).max())
        assert np.abs(found[:, part] - expected[:, part]).max() < 1e-11 * size
