"""Mirror images, and maps to surfaces of the other hand: what they are asked and what they answer is in the source's own numbers."""

import numpy as np
import pytest

import ricci

FLIP = np.array([-1.0, 1, 1])


def bumpy(mesh):
    """A surface without any symmetry."""
    x, y, z = mesh.V.T
    return ricci.Mesh(mesh.V * (1 + 0.2 * np.sin(3 * x + 1) * np.cos(2 * y) + 0.1 * z)[:, None], mesh.F)


@pytest.mark.parametrize(
    "make",
    [
        lambda: bumpy(ricci.make("torus", n=16)),
        lambda: ricci.make("bolza", n=1),
        lambda: ricci.make("one_vertex", genus=2),
        lambda: bumpy(ricci.make("disk", n=5)).with_lengths(bumpy(ricci.make("disk", n=5)).lengths * 1.01),
    ],
)
def test_a_mirror_image_has_the_same_lengths_and_is_turned_over(make):
    mesh = make()
    image = mesh.mirrored()
    assert np.array_equal(image.F, mesh.F[:, [0, 2, 1]])
    ours, theirs = np.abs(mesh.face_edges[:, [0, 2, 1]]) - 1, np.abs(image.face_edges) - 1
    assert np.array_equal(image.lengths[theirs], mesh.lengths[ours])
    assert image.euler == mesh.euler
    if mesh.summary.has_positions:
        assert np.array_equal(image.V, mesh.V * FLIP)
        again = image.mirrored()
        assert np.array_equal(again.V, mesh.V)
        assert np.array_equal(again.F, mesh.F)


def test_attributes_are_mirrored_with_their_corners(disk):
    rng = np.random.default_rng(2)
    normals, uv = rng.random((disk.n_vertices, 3)), rng.random((disk.n_faces, 3, 2))
    image = disk.with_attributes(normals=normals, uv=uv).mirrored()
    assert np.array_equal(image.normals, normals * FLIP)
    assert np.array_equal(image.uv, uv[:, [0, 2, 1]])


def test_a_left_surface_is_matched_to_its_right_image():
    left = bumpy(ricci.make("disk", n=10))
    right = ricci.Mesh(left.V * FLIP, left.F[:, [0, 2, 1]])
    rim = left.boundary[0]
    marks = [[v, v] for v in rim[[0, len(rim) // 3, 2 * len(rim) // 3]]]
    found = ricci.match(left, right, landmarks=marks, mirror=True)
    assert found.summary.n_flipped == 0
    assert found.summary.qc_max == pytest.approx(1, abs=1e-6)
    np.testing.assert_allclose(found.carry(right.V), right.V, atol=1e-6)
    np.testing.assert_allclose(found.carry(left.V, "backward"), left.V, atol=1e-6)
    for direction, other in (("forward", right), ("backward", left)):
        own = np.einsum("nc,ncx->nx", found.weights(direction), other.V[other.F[found.faces(direction)]])
        np.testing.assert_allclose(found.carry(other.V, direction), own, atol=1e-12)
        labels = np.arange(other.n_vertices)
        assert np.array_equal(found.carry(labels, direction), labels)
    with pytest.raises(ricci.MatchingError, match="come in the order"):
        ricci.match(left, right, landmarks=marks)


def test_points_and_loops_are_those_of_the_source():
    left = bumpy(ricci.change(ricci.make("sphere", n=10), "punch", count=3))
    right = ricci.Mesh(left.V * FLIP, left.F[:, [0, 2, 1]])
    least = {int(loop.min()): k for k, loop in enumerate(right.boundary)}
    loops = [least[int(loop.min())] for loop in left.boundary]
    weights = np.array([[0.5, 0.3, 0.2], [0.5, 0.2, 0.3]])
    points = {"faces": [[40, 40]], "weights": weights[None]}
    found = ricci.match(left, right, loops=loops, points=points, mirror=True)
    assert found.summary.n_flipped == 0
    np.testing.assert_allclose(found.carry(right.V)[left.F[40]].T @ weights[0], right.V[right.F[40]].T @ weights[1], atol=0.1)
    faces, at = found.points
    assert faces[0].tolist() == [40, 40]
    np.testing.assert_allclose(at[0, 0], weights[1], atol=1e-6)


def test_paths_are_those_of_the_source():
    left = bumpy(ricci.make("torus", n=20))
    right = ricci.Mesh(left.V * FLIP, left.F[:, [0, 2, 1]])
    number = {tuple(ends): k + 1 for k, ends in enumerate(right.edges.tolist())}

    def there(edge):
        a, b = left.edges[abs(edge) - 1][:: 1 if edge > 0 else -1].tolist()
        return number[a, b] if (a, b) in number else -number[b, a]

    loops = ricci.homotopy(left).loops
    images = [[there(int(edge)) for edge in loop] for loop in loops]
    found = ricci.match(left, right, basis=list(zip(loops, images, strict=True)), mirror=True)
    np.testing.assert_allclose(found.carry(right.V), right.V, atol=1e-6)
    twisted = [images[0], [*images[0], *images[1]]]
    assert np.abs(ricci.match(left, right, basis=list(zip(loops, twisted, strict=True)), mirror=True).carry(right.V) - right.V).max() > 1


def test_mirror_is_a_flag(disk):
    with pytest.raises(ricci.ArgumentTypeError, match="mirror"):
        ricci.match(disk, disk, mirror="x")
