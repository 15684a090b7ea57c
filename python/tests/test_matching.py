"""Maps between surfaces: the identity comes out, landmarks are met, what is carried fits, and conflicts are named."""

import numpy as np
import pytest

import ricci

TURN = np.array([[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, 1]])


def test_a_disk_to_a_turned_copy_is_the_identity(disk):
    bumpy = ricci.Mesh(disk.V + [0, 0, 0.3] * np.cos(3 * disk.V[:, :1]), disk.F)
    copy = ricci.Mesh(2 * bumpy.V @ TURN.T + [1, 2, 3], disk.F)
    rim = disk.boundary[0]
    found = ricci.match(bumpy, copy, landmarks=[[v, v] for v in rim[[0, len(rim) // 3, 2 * len(rim) // 3]]])
    np.testing.assert_allclose(found.carry(copy.V), copy.V, atol=1e-6)
    assert found.summary.n_flipped == 0
    assert found.summary.qc_max == pytest.approx(1, abs=1e-6)


def test_landmarks_are_met_and_weights_are_barycentric(disk):
    target = ricci.Mesh(disk.V * [1.5, 1, 1], disk.F)
    landmarks = np.array([[5, 9], [100, 103]])
    found = ricci.match((disk.V, disk.F), target, landmarks=landmarks, boundary="arc_length")
    image = found.carry(target.V)
    np.testing.assert_allclose(image[landmarks[:, 0]], target.V[landmarks[:, 1]], atol=1e-8)
    for direction, n, other in (("forward", disk.n_vertices, target), ("backward", target.n_vertices, disk)):
        weights, faces = found.weights(direction), found.faces(direction)
        assert weights.shape == (n, 3)
        assert weights.min() >= 0
        np.testing.assert_allclose(weights.sum(1), 1, atol=1e-12)
        own = np.einsum("nc,ncx->nx", weights, other.V[other.F[faces]])
        np.testing.assert_allclose(found.carry(other.V, direction), own, atol=1e-12)
    with pytest.raises(ricci.ArgumentError, match="rows are needed"):
        found.carry(np.zeros(3))


def test_labels_are_carried_as_labels(disk):
    """A vertex gets the label that has the most weight around its image."""
    target = ricci.Mesh(disk.V * [1.5, 1, 1], disk.F)
    found = ricci.match(disk, target, boundary="arc_length")
    labels = (np.arange(disk.n_vertices) * 7 % 5).astype(np.uint8)
    for direction in ("forward", "backward"):
        carried = found.carry(labels, direction)
        assert carried.dtype == np.uint8
        shares = np.stack([found.carry((labels == label).astype(float), direction) for label in range(5)])
        np.testing.assert_allclose(np.take_along_axis(shares, carried[None].astype(int), 0)[0], shares.max(0), atol=1e-12)
    both = np.stack([labels, labels[::-1]], 1)
    assert np.array_equal(found.carry(both)[:, 0], found.carry(labels))
    for mode in ("linear", "conservative"):
        with pytest.raises(ricci.ArgumentTypeError, match="whole numbers are labels, which have no mean"):
            found.carry(labels, mode=mode)
    with pytest.raises(ricci.ArgumentError, match="none of nearest, linear, conservative"):
        found.carry(labels, mode="cubic")
    assert np.array_equal(found.carry(labels.astype(float), mode="nearest"), found.carry(labels))
    assert np.array_equal(found.carry(target.V, mode="linear"), found.carry(target.V))
    assert np.array_equal(found.map().carry(np.arange(disk.n_vertices))[: disk.n_vertices], np.arange(disk.n_vertices))
    for wrong, words in (
        (disk.V[:, 0] * 1j, "real and imaginary parts"),
        (labels.astype(str), "texts"),
        (labels.astype(object), "objects"),
    ):
        with pytest.raises(TypeError, match=words):
            found.carry(wrong)
    masked = np.ma.masked_equal(labels, 3)
    with pytest.raises(ricci.ArgumentError, match="masked entries"):
        found.carry(masked)


def areas_at(mesh):
    """A third of the area of the faces around every vertex."""
    sides = mesh.V[mesh.F[:, 1:]] - mesh.V[mesh.F[:, :1]]
    faces = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / 2
    return np.bincount(mesh.F.ravel(), np.repeat(faces / 3, 3), mesh.n_vertices)


@pytest.mark.parametrize("mirror", [False, True])
def test_conservative_values_keep_their_integral(disk, mirror):
    bumpy = ricci.Mesh(disk.V + [0, 0, 0.4] * np.cos(3 * disk.V[:, :1]) + 0.05 * np.sin(5 * disk.V[:, [1, 0, 0]]), disk.F)
    plate = ricci.make("disk", n=9)
    target = ricci.Mesh(plate.V * [2, 1, 1], plate.F)
    found = ricci.match(bumpy, target.mirrored() if mirror else target, boundary="arc_length", mirror=mirror)
    for direction, here, there in (("forward", bumpy, target), ("backward", target, bumpy)):
        density = np.random.default_rng(4).random((there.n_vertices, 2))
        carried = found.carry(density, direction, mode="conservative")
        assert carried.shape == (here.n_vertices, 2)
        np.testing.assert_allclose(areas_at(here) @ carried, areas_at(there) @ density, rtol=1e-9)
        np.testing.assert_allclose(found.carry(density[:, 0], direction, mode="conservative"), carried[:, 0], rtol=1e-12)
        # Interpolated values have another integral.
        linear = areas_at(here) @ found.carry(density, direction)
        assert (abs(linear - areas_at(there) @ density) > 0.01 * linear).all()


def test_conservative_values_of_a_similar_copy_are_scaled(disk):
    """A copy twice as large under a map that is the identity: areas are four times as large."""
    copy = ricci.Mesh(2 * disk.V, disk.F)
    rim = disk.boundary[0]
    found = ricci.match(disk, copy, landmarks=[[v, v] for v in rim[[0, len(rim) // 3, 2 * len(rim) // 3]]])
    np.testing.assert_allclose(found.carry(np.ones(disk.n_vertices), mode="conservative"), 4, rtol=1e-5)


def test_spheres_and_tori(torus):
    ball = ricci.make("ellipsoid", n=5, a=1.5, b=1, c=1)
    found = ricci.match(ball, ricci.make("sphere", n=6))
    assert found.summary.n_flipped == 0
    assert np.linalg.norm(found.carry(ricci.make("sphere", n=6).V), axis=1).min() > 0.95
    same = ricci.match(torus, torus)
    np.testing.assert_allclose(same.carry(torus.V), torus.V, atol=1e-6)


def test_a_class_is_named_by_loops(torus):
    loops = ricci.homotopy(torus).loops
    found = ricci.match(torus, torus, basis=[(loop, loop) for loop in loops])
    assert found.summary.n_markings == 1
    np.testing.assert_allclose(found.carry(torus.V), torus.V, atol=1e-6)
    a, b = loops
    twisted = ricci.match(torus, torus, basis=[(a, a), (b, np.concatenate([a, b]))])
    assert np.linalg.norm(twisted.carry(torus.V) - torus.V, axis=1).max() > 1
    assert twisted.summary.n_flipped == 0


def test_points_curves_and_soft_landmarks(disk):
    target = ricci.Mesh(disk.V * [1.2, 1, 1], disk.F)
    points = {"faces": [[30, 30]], "weights": [[[0.2, 0.3, 0.5], [0.3, 0.3, 0.4]]]}
    found = ricci.match(disk, target, points=points, soft=[[150, 160]], soft_weights=[1.0])
    faces, weights = found.points
    spots = np.einsum("kpc,kpcx->kpx", weights, target.V[target.F[faces]])
    np.testing.assert_allclose(spots[:, 0], spots[:, 1], atol=1e-8)
    assert found.soft_left.shape == (1,)
    assert found.soft_left[0] > 0
    ring = ricci.homotopy(disk)
    path = ring.tree_path(int(disk.boundary[0][0]))
    ends = disk.edges[np.abs(path) - 1]
    curve = [*np.where(path > 0, ends[:, 0], ends[:, 1]), np.where(path[-1] > 0, ends[-1, 1], ends[-1, 0])]
    curve = [int(v) for v in curve[:4]]
    along = ricci.match(disk, target, curves=[(curve, curve)])
    assert along.summary.n_points >= len(curve) - 2
    with pytest.raises(ricci.ArgumentError, match="one weight for every pair"):
        ricci.match(disk, target, soft=[[1, 1]])


def test_both_surfaces_are_laid_over_each_other(disk):
    target = ricci.Mesh(disk.V * [1.2, 1, 1], disk.F)
    way = ricci.match(disk, target).map()
    spots = way.carry(disk.V)
    np.testing.assert_allclose(spots, way.mesh.V, atol=1e-9)
    assert way.faces("metric").max() < target.n_faces


def test_conflicts_are_named(disk, torus):
    with pytest.raises(ricci.MatchingError):
        ricci.match(disk, torus)
    with pytest.raises(ricci.RicciError):
        ricci.match(disk, disk, landmarks=[[5, 9], [5, 11]])
    with pytest.raises(ricci.ArgumentError):
        ricci.match(disk, disk, landmarks=[[5, 10**6]])


def test_a_surface_matched_to_itself_by_its_shape_is_judged_good():
    torus = ricci.make("torus", n=12, m=8)
    found = ricci.match(torus, torus, landmarks="auto")
    judged = found.judgement()
    assert judged.verdict == "good"
    assert judged.agreement == pytest.approx(1, abs=1e-3)
    assert judged.area_log_99 < 1e-6
    with pytest.raises(ricci.ArgumentError, match="auto"):
        ricci.match(torus, torus, landmarks="tips")
    with pytest.raises(ricci.ArgumentError, match="soft"):
        ricci.match(torus, torus, landmarks="auto", soft=[[0, 1]], soft_weights=[1.0])


def test_landmarks_that_are_found_are_told_of_both_sides():
    ball = ricci.make("sphere", n=6)
    # No plane of symmetry: three arms of different lengths at right angles.
    out = sum(length * np.exp(-8 * (1 - ball.V[:, axis])) for axis, length in enumerate((1.6, 1.2, 0.8)))
    one = ricci.Mesh(ball.V * (1 + out)[:, None], ball.F)
    found = ricci.match(one, one, landmarks="auto")
    assert found.found.n_kept == len(found.landmarks("kept")) >= 3
    assert not found.found.mirror
    np.testing.assert_array_equal(*found.landmarks("kept").T)
    other = ricci.match(one, one.mirrored(), landmarks="auto")
    assert other.found.mirror
    pairs = other.landmarks("mirrored")
    np.testing.assert_array_equal(*pairs.T)
    turned = ricci.match(one, one.mirrored(), landmarks=pairs, mirror=True)
    np.testing.assert_array_equal(turned.landmarks(), pairs)
    np.testing.assert_allclose(turned.carry(one.V), one.V, atol=1e-6)
    assert turned.found.n_paired == turned.found.n_signed == 0
