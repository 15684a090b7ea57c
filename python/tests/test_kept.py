"""Every object that can be kept comes back bit for bit, from bytes, files, pickles and other processes, and goes on as before."""

import copy
import pickle
import subprocess
import sys
from dataclasses import fields
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import ricci
from ricci._call import _KINDS, Handle
from ricci._kept import Kept


@cache
def flat():
    return ricci.flow(ricci.make("genus", genus=2, n=4), target="auto:4")


@cache
def seamless():
    return ricci.seamless(ricci.make("torus", n=20, m=12))


@cache
def patches():
    return ricci.quad_layout(seamless())


MAKERS = {
    "mesh": lambda: ricci.make("torus", n=12),
    "spherical mesh": lambda: ricci.make("hyperelliptic", n=3),
    "mesh with lengths": lambda: ricci.make("disk", n=4).with_lengths(1.01 * ricci.make("disk", n=4).lengths, "h2"),
    "mesh with attributes": lambda: ricci.make("disk", n=4).with_attributes(normals=np.ones((61, 3)), uv=np.ones((96, 3, 2))),
    "subdivision": lambda: ricci.layout(flat()).mesh,
    "initial metric": lambda: ricci.metric(ricci.make("torus", n=12), space="h2", scheme="inversive"),
    "metric": flat,
    "disk": lambda: ricci.flow(ricci.make("disk", n=5)),
    "double": lambda: ricci.flow(ricci.make("annulus", a=0.9, b=1, n=1, m=12), target="boundary"),
    "layout of a double": lambda: ricci.layout(made("double")),
    "caps": lambda: ricci.flow(ricci.make("annulus", a=0.4, b=1, n=4, m=24)),
    "gradient": lambda: ricci.flow(ricci.make("torus", n=10), target="uniform", method="gradient", max_iterations=20),
    "layout": lambda: ricci.layout(flat()),
    "layout in H2": lambda: ricci.layout(ricci.flow(ricci.make("genus", genus=2, n=4), space="h2"), model="klein"),
    "charts": lambda: ricci.charts(ricci.layout(flat())),
    "map": lambda: ricci.Map(flat()),
    "sphere": lambda: ricci.uniformize(ricci.make("ellipsoid", n=6)),
    "quotient": lambda: ricci.uniformize(ricci.make("genus", genus=2, n=4)),
    "annulus": lambda: ricci.uniformize(ricci.make("annulus", a=0.4, b=1, n=4, m=24)),
    "circles": lambda: ricci.circles(ricci.make("annulus", a=0.4, b=1, n=4, m=24)),
    "forms": lambda: ricci.forms(ricci.make("genus", genus=2, n=4)),
    "open forms": lambda: ricci.forms(ricci.make("annulus", a=0.4, b=1, n=4, m=24)),
    "matching": lambda: ricci.match(ricci.make("ellipsoid", n=5), ricci.make("sphere", n=6)),
    "mirror": lambda: ricci.match(ricci.make("ellipsoid", n=5), ricci.make("sphere", n=6), mirror=True),
    "overlay": lambda: ricci.match(ricci.make("ellipsoid", n=5), ricci.make("sphere", n=6)).map(),
    "structure": lambda: ricci.structure(ricci.make("genus", genus=2, n=4), kind="hyperbolic"),
    "seamless": seamless,
    "quads": lambda: ricci.quads(seamless(), n_quads=100),
    "quad layout": patches,
    "quad spline": lambda: ricci.quad_spline(seamless(), patches(), most_spans=4),
    "spline": lambda: ricci.spline(ricci.make("ellipsoid", n=6), control_points=60, rounds=1),
}


@cache
def made(name):
    return MAKERS[name]()


def numbers(value):
    """Everything that an object shows without arguments, as bytes and texts."""
    found = {}
    for name in dir(type(value)):
        if name.startswith("_") or callable(getattr(type(value), name)):
            continue
        try:
            got = getattr(value, name)
        except ricci.RicciError as wrong:
            got = str(wrong)
        found[name] = plain(got)
    return found


def plain(got):
    """A value as what can be compared bit for bit."""
    if isinstance(got, np.ndarray):
        return got.dtype.str, got.shape, got.tobytes()
    if isinstance(got, Handle):
        return numbers(got)
    if isinstance(got, ricci.Report):
        return plain(got.summary), plain(got.target), plain(got.residuals), plain(got.trace), plain(got.cones), plain(got.worst)
    if isinstance(got, list | tuple):
        return [plain(one) for one in got]
    if hasattr(got, "__dataclass_fields__"):
        return {field.name: plain(getattr(got, field.name)) for field in fields(got) if "seconds" not in field.name}
    if type(got).__module__.startswith("ricci") and vars(got):
        return {name: plain(value) for name, value in vars(got).items()}
    return repr(got)


@pytest.mark.parametrize("name", MAKERS)
def test_objects_come_back_bit_for_bit(name, tmp_path):
    value = made(name)
    data = value.to_bytes()
    value.save(tmp_path / "kept")
    assert (tmp_path / "kept").read_bytes() == data
    shown = numbers(value)
    assert len(shown) > 2
    for again in (
        type(value).from_bytes(data),
        ricci.load(tmp_path / "kept"),
        type(value).load(tmp_path / "kept"),
        pickle.loads(pickle.dumps(value)),
    ):
        assert type(again) is type(value)
        assert again.to_bytes() == data
        assert numbers(again) == shown
    assert copy.deepcopy(value) is value


def test_every_kind_is_kept_or_says_why_not():
    kept = {type(made(name)) for name in MAKERS}
    assert kept == {kind for kind in _KINDS.values() if issubclass(kind, Kept)}
    rest = {kind.__name__ for kind in _KINDS.values()} - {kind.__name__ for kind in kept}
    # A list has its own pickle, a solver changes; the others are cheap to make again from what is kept.
    assert rest == {"Soup", "Solver", "RepairedInput", "Deck", "Dirichlet", "Homotopy", "Domain", "Bicubic", "SceneFile", "TextureAtlas"}


def test_results_go_on_as_before():
    again = pickle.loads(pickle.dumps(made("metric")))
    assert ricci.layout(again).to_bytes() == made("layout").to_bytes()
    target = {0: np.pi / 2, 1: -np.pi / 2, 2: -4 * np.pi}
    assert again.flow(target).to_bytes() == made("metric").flow(target).to_bytes()
    assert ricci.Map(again).to_bytes() == made("map").to_bytes()
    found, copied = made("matching"), pickle.loads(pickle.dumps(made("matching")))
    labels = np.arange(ricci.make("sphere", n=6).n_vertices)
    assert np.array_equal(copied.carry(labels), found.carry(labels))
    assert np.array_equal(copied.carry(1.0 * labels, mode="conservative"), found.carry(1.0 * labels, mode="conservative"))
    mirror, turned = made("mirror"), pickle.loads(pickle.dumps(made("mirror")))
    assert turned.carry(labels).tobytes() == mirror.carry(labels).tobytes()
    assert turned.weights("backward").tobytes() == mirror.weights("backward").tobytes()
    quotient = pickle.loads(pickle.dumps(made("quotient")))
    assert quotient.layout().to_bytes() == made("quotient").layout().to_bytes()
    assert np.array_equal(ricci.deck(quotient, depth=1).mobius, ricci.deck(made("quotient"), depth=1).mobius)
    basis = pickle.loads(pickle.dumps(made("forms")))
    assert np.array_equal(basis.holomorphic([1.0, 2.0, 0.0, 0.5]), made("forms").holomorphic([1.0, 2.0, 0.0, 0.5]))


def test_a_layout_of_patches_still_belongs_to_its_metric():
    metric, layout = (pickle.loads(pickle.dumps(value)) for value in (seamless(), patches()))
    assert ricci.quad_spline(metric, layout, most_spans=4).to_bytes() == made("quad spline").to_bytes()
    other = ricci.seamless(ricci.make("torus", n=18, m=12))
    with pytest.raises(ricci.ArgumentError, match="another seamless metric"):
        ricci.quad_spline(other, layout)


@pytest.mark.parametrize("path", sorted((Path(__file__).parents[2] / "tests" / "archives").glob("*.ricci")), ids=lambda path: path.stem)
def test_files_of_this_format_keep_their_bytes(path):
    assert ricci.load(path).to_bytes() == path.read_bytes()


def test_the_examples_are_of_every_sort():
    assert made("double").summary.doubled
    assert made("metric").summary.n_flips > 0
    assert made("metric").summary.n_start_flips > 0


def test_threads_leave_no_trace():
    torus = ricci.make("torus", n=24, m=16)
    assert ricci.flow(torus, threads=1).to_bytes() == ricci.flow(torus, threads=2).to_bytes()


def test_reports_and_maps_of_points_are_pickled():
    report, again = made("metric").report, pickle.loads(pickle.dumps(made("metric").report))
    assert plain(again) == plain(report)
    disk = ricci.harmonic_map(ricci.make("disk", n=4))
    assert plain(pickle.loads(pickle.dumps(disk))) == plain(disk)


def test_another_process_reads_a_pickle_and_a_file(tmp_path):
    layout = made("layout")
    layout.save(tmp_path / "kept")
    (tmp_path / "pickle").write_bytes(pickle.dumps(layout))
    script = f"""
import pickle, ricci
one, two = ricci.load({str(tmp_path / "kept")!r}), pickle.loads(open({str(tmp_path / "pickle")!r}, "rb").read())
assert one.to_bytes() == two.to_bytes()
print(one.uv().tobytes().hex()[:400])
"""
    told = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout
    assert told.strip() == layout.uv().tobytes().hex()[:400]


def test_wrong_files_are_refused_by_name(tmp_path):
    data = made("metric").to_bytes()
    with pytest.raises(ricci.ParseError, match="cut off"):
        ricci.Metric.from_bytes(data[:-1])
    with pytest.raises(ricci.ParseError, match="damaged"):
        ricci.Metric.from_bytes(data[:-1] + bytes([data[-1] ^ 1]))
    with pytest.raises(ricci.FileError, match="no archive"):
        ricci.Metric.from_bytes(b"ply\nformat ascii 1.0")
    with pytest.raises(ricci.ArgumentError, match="archive of a Metric, not of a Layout"):
        ricci.Layout.from_bytes(data)
    with pytest.raises(FileNotFoundError) as missing:
        ricci.load(tmp_path / "none")
    assert missing.value.filename.endswith("none")
    with pytest.raises(ricci.ArgumentTypeError, match="bytes are needed"):
        ricci.Metric.from_bytes(3)
    (tmp_path / "mesh.obj").write_text("v 0 0 0\n")
    with pytest.raises(ricci.FileError, match="no archive"):
        ricci.load(tmp_path / "mesh.obj")


def test_a_cache_of_joblib_finds_equal_metrics(tmp_path):
    """A metric that is computed anew is the same argument, and what comes out of the cache is what was put in."""
    joblib = pytest.importorskip("joblib")
    memory, calls = joblib.Memory(tmp_path, verbose=0), []

    def laid(metric):
        calls.append(1)
        return ricci.layout(metric)

    kept = memory.cache(laid, ignore=[])
    first = kept(ricci.flow(ricci.make("torus", n=12)))
    second = kept(ricci.flow(ricci.make("torus", n=12)))
    assert calls == [1]
    assert second.to_bytes() == first.to_bytes()
