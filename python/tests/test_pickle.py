"""What travels between processes, bit for bit, and what is refused by name."""

import copy
import pickle

import numpy as np
import pytest

import ricci
from ricci._call import _KINDS, Handle

ATTRIBUTES = ("normals", "colors", "uv", "corner_normals")


def again(value):
    return pickle.loads(pickle.dumps(value))


def same(a, b):
    """The same mesh to the last bit, the order of its edges included."""
    assert a.summary == b.summary
    for name in ("F", "edges", "face_edges", "lengths", *(("V",) if a.summary.has_positions else ()), *ATTRIBUTES):
        mine, other = getattr(a, name), getattr(b, name)
        assert (mine is None) == (other is None), name
        assert mine is None or mine.tobytes() == other.tobytes(), name


def with_attributes(mesh):
    """The mesh with attributes that no other one has."""
    rng = np.random.default_rng(3)
    return mesh.with_attributes(
        normals=rng.normal(size=(mesh.n_vertices, 3)), colors=rng.random((mesh.n_vertices, 4)), uv=rng.random((mesh.n_faces, 3, 2))
    )


def stretched(mesh):
    return mesh.with_lengths(1.01 * mesh.lengths, "h2")


@pytest.mark.parametrize(
    "made",
    [
        lambda: ricci.make("torus", n=12),
        lambda: with_attributes(ricci.make("disk", n=5)),
        lambda: stretched(ricci.make("disk", n=5)),
        lambda: stretched(with_attributes(ricci.make("disk", n=5))),
        lambda: ricci.make("bolza", n=1),
        lambda: ricci.make("one_vertex", genus=2),
        lambda: ricci.make("hyperelliptic", n=3),
    ],
    ids=["space", "attributes", "lengths", "both", "hyperbolic", "one vertex", "spherical"],
)
def test_meshes_are_pickled_bit_for_bit(made):
    mesh = made()
    same(mesh, again(mesh))


def test_attributes_are_those_that_were_given(disk):
    uv = np.random.default_rng(1).random((disk.n_faces, 3, 2))
    made = disk.with_attributes(uv=uv)
    assert np.array_equal(made.uv, uv)
    assert made.normals is None
    assert np.array_equal(made.V, disk.V)
    assert np.array_equal(made.with_attributes(colors=np.ones((disk.n_vertices, 4))).colors, np.ones((disk.n_vertices, 4)))
    with pytest.raises(ricci.ArgumentError, match="uv has shape"):
        disk.with_attributes(uv=uv[:3])


def test_copies_are_the_handles_themselves(torus):
    flat = ricci.flow(torus)
    kept = {"mesh": torus, "metric": [flat, ricci.layout(flat)]}
    for copied in (copy.deepcopy(kept), copy.copy(kept)):
        assert copied["mesh"] is torus
        assert copied["metric"][0] is flat
    with pytest.raises(TypeError, match="Solver changes with every solve"):
        copy.deepcopy(ricci.Solver(flat))


def test_splines_and_lists_are_pickled(disk):
    spline = ricci.Spline.plane(disk, degree=2)
    assert again(spline).text() == spline.text()
    broken = ricci.Soup([[0, 0, 0], [1, 0, 0], [0, 1, 0], [np.nan, 0, 0]], [[0, 1, 2], [0, 1, 2], [1, 2, 9]])
    copied = again(broken)
    assert copied.F.tolist() == broken.F.tolist()
    assert copied.V.tobytes() == broken.V.tobytes()
    assert [d.code for d in copied.defects] == [d.code for d in broken.defects]
    with pytest.raises(TypeError, match="repaired"):
        pickle.dumps(ricci.Soup(broken.V[:3], broken.F[:2]).repair())


def test_a_cache_of_joblib_keeps_meshes_and_splines(tmp_path):
    """What comes out of the cache is what was put in, bit for bit, and the same arguments find it."""
    joblib = pytest.importorskip("joblib")
    memory, calls = joblib.Memory(tmp_path, verbose=0), []

    def finer(mesh, levels):
        calls.append(levels)
        return ricci.Soup(mesh.V, mesh.F).refine(levels).mesh(), ricci.Spline.plane(ricci.make("disk", n=2), degree=2)

    kept = memory.cache(finer, ignore=[])
    disk = with_attributes(ricci.make("disk", n=4))
    first, again_, other = kept(disk, 1), kept(with_attributes(ricci.make("disk", n=4)), 1), kept(ricci.make("disk", n=5), 1)
    assert calls == [1, 1]
    same(first[0], again_[0])
    assert first[1].text() == again_[1].text()
    assert other[0].n_faces != first[0].n_faces
    assert joblib.hash(disk) == joblib.hash(again(disk))
    assert joblib.hash(disk) != joblib.hash(ricci.make("disk", n=4))


def test_the_others_say_what_to_send_instead(torus):
    laid = ricci.layout(ricci.flow(torus))
    for value, makes in ((ricci.homotopy(torus), "ricci.homotopy"), (laid.repaired_input(), "repaired_input")):
        with pytest.raises(TypeError, match=f"send what it was made from \\(.*{makes}"):
            pickle.dumps(value)
    with pytest.raises(TypeError, match="its own process"):
        pickle.dumps(ricci.Control())


def test_every_handle_says_how_it_is_made():
    assert len(_KINDS) > 15
    assert [kind.__name__ for kind in _KINDS.values() if not kind._made_by] == []
    assert all(issubclass(kind, Handle) for kind in _KINDS.values())


def test_everything_public_can_be_sent_by_cloudpickle():
    cloudpickle = pytest.importorskip("cloudpickle")
    for name in ricci.__all__:
        value = getattr(ricci, name)
        assert pickle.loads(cloudpickle.dumps(value)) is not None
        for member, of in vars(value).items() if isinstance(value, type) else ():
            if isinstance(of, classmethod):
                assert callable(pickle.loads(cloudpickle.dumps(getattr(value, member))))
    read = ricci.read
    assert pickle.loads(pickle.dumps(read)) is read


def test_figures_and_seams_are_pickled(torus):
    flat = ricci.flow(torus)
    laid = ricci.layout(flat)
    assert again(laid.summary) == laid.summary
    assert np.array_equal(again(laid.seams)[0].mobius, laid.seams[0].mobius)
