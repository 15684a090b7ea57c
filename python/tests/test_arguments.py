"""What is no argument is refused in words: a type that does not fit, a zero that the library would take for its default, a wrong name."""

import errno

import numpy as np
import pytest

import ricci
from ricci.cohorts import Job

WRONG = [None, 3, 2.5, "nothing.obj", b"x", object(), {}, [], (1, 2, 3), np.zeros(3), np.zeros((2, 2), complex), print]


@pytest.fixture(scope="module")
def things(torus, disk):
    """One of each kind of object."""
    flat = ricci.flow(torus)
    return {
        "mesh": disk,
        "metric": flat,
        "layout": ricci.layout(flat),
        "uniform": ricci.uniformize(torus),
        "spline": ricci.Spline.plane(disk, degree=2),
        "soup": ricci.Soup(disk.V, disk.F),
        "report": flat.report,
    }


# The functions, and the kinds that they take.
TAKES = {
    "as_mesh": (ricci.as_mesh, "mesh"),
    "charts": (ricci.charts, "layout"),
    "brain": (ricci.brain, "mesh"),
    "bicubic": (ricci.bicubic, "spline"),
    "change": (lambda x: ricci.change(x, "noise", amount=0.1), "mesh"),
    "circles": (ricci.circles, "mesh"),
    "cover": (ricci.cover, "mesh uniform"),
    "deck": (ricci.deck, "uniform"),
    "dirichlet": (ricci.dirichlet, "uniform"),
    "fenchel_nielsen": (ricci.fenchel_nielsen, "uniform"),
    "flat_metric": (ricci.flat_metric, "mesh"),
    "flat_part": (lambda x: ricci.flat_part(x, marked=[True]), "mesh"),
    "flatten": (ricci.flatten, "mesh"),
    "flatten_darts": (ricci.flatten_darts, "mesh"),
    "flatten_seamless": (ricci.flatten_seamless, ""),
    "flatten_sphere": (ricci.flatten_sphere, "mesh"),
    "flow": (ricci.flow, "mesh"),
    "forms": (ricci.forms, "mesh"),
    "harmonic": (ricci.harmonic, "mesh"),
    "inflate": (ricci.inflate, "mesh"),
    "medial_wall": (lambda x: ricci.medial_wall(x, view=[[0.0, 0.0, 0.0]]), "mesh"),
    "homotopy": (ricci.homotopy, "mesh"),
    "layout": (ricci.layout, "metric"),
    "match": (lambda x: ricci.match(x, x), "mesh"),
    "metric": (ricci.metric, "mesh"),
    "map": (ricci.Map, "metric"),
    "solver": (ricci.Solver, "metric"),
    "spline": (ricci.spline, "mesh metric"),
    "period_bounds": (ricci.period_bounds, ""),
    "plane": (ricci.Spline.plane, "mesh"),
    "of_surface": (ricci.Spline.of_surface, "metric"),
    "quads": (ricci.quads, ""),
    "quad_layout": (ricci.quad_layout, ""),
    "fit_control_mesh": (lambda x: ricci.fit_control_mesh(x, [[0, 1, 2, 3]]), ""),
    "fit_few_patches": (ricci.fit_few_patches, "mesh"),
    "quad_spline": (ricci.quad_spline, ""),
    "structure": (ricci.structure, "mesh"),
    "structures": (ricci.structures, "mesh"),
    "texture_atlas": (ricci.texture_atlas, "mesh soup"),
    "read_scene": (ricci.SceneFile.read, ""),
    "to_trimesh": (ricci.to_trimesh, "mesh layout"),
    "to_meshio": (ricci.to_meshio, "mesh layout"),
    "to_pyvista": (ricci.to_pyvista, "mesh layout"),
    "to_gifti": (ricci.to_gifti, "mesh layout"),
    "uniformize": (ricci.uniformize, "mesh"),
    "read_gifti_notes": (ricci.read_gifti_notes, ""),
    "read_gifti_columns": (ricci.read_gifti_columns, ""),
    "write_gifti_surface": (lambda x: ricci.write_gifti_surface("x.gii", x), "mesh"),
    "write_gifti_values": (lambda x: ricci.write_gifti_values("x.gii", x), ""),
    "write_gifti_labels": (lambda x: ricci.write_gifti_labels("x.gii", [1], x), ""),
    "read": (ricci.read, ""),
    "job": (lambda x: Job("flow", x), ""),
    "cohort": (lambda x: ricci.cohort(["a.obj"], x, "never"), ""),
    "target": (lambda x: ricci.flow(ricci.make("disk", n=3), target=x), ""),
    "progress": (lambda x: ricci.flow(ricci.make("disk", n=3), progress=x), ""),
    "start": (lambda x: ricci.uniformize(ricci.make("sphere", n=3), start=x), "metric"),
    "options": (lambda x: ricci.uniformize(ricci.make("sphere", n=3), flow=x), ""),
    "indices": (lambda x: ricci.flow(ricci.make("disk", n=3), fixed_edges=x), ""),
    "root": (lambda x: ricci.layout(ricci.flow(ricci.make("disk", n=3)), root=x), ""),
    "base": (lambda x: ricci.homotopy(ricci.make("torus", n=8), base=x), ""),
}
# Values that are right, or left out, for some of these.
FINE = {
    "target": (type(None), dict),
    "progress": (type(None), type(print)),
    "start": (type(None),),
    "options": (type(None), dict),
    "indices": (type(None), int, list, tuple),
    "root": (type(None), int),
    "base": (type(None), int),
    "job": (dict,),
    "cohort": (type(print),),
    "write_gifti_values": (dict,),
}


@pytest.mark.parametrize("name", TAKES)
def test_what_does_not_fit_is_refused_in_words(name, things, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    function, kinds = TAKES[name]
    refused = 0
    for value in [*WRONG, *(thing for kind, thing in things.items() if kind not in kinds.split())]:
        if type(value) in FINE.get(name, ()):
            continue
        with pytest.raises((TypeError, ValueError, OSError)) as told:
            function(value)
        text = str(told.value)
        assert not any(word in text for word in ("cdata", "ctype", "initializer", "attribute", "NoneType' object", "expected str")), text
        refused += 1
    assert refused > 5


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda t: ricci.layout(t["mesh"]), "a Metric is needed, not Mesh: ricci.flow\\(mesh\\) makes one"),
        (lambda t: ricci.deck(t["mesh"]), "a Uniform is needed, not Mesh: ricci.uniformize\\(mesh\\) makes one"),
        (lambda t: ricci.charts(t["metric"]), "a Layout is needed, not Metric: ricci.layout\\(metric\\) makes one"),
        (lambda t: ricci.flow(t["mesh"], "uniform"), "target='uniform'"),
        (lambda t: ricci.as_mesh(t["mesh"].V), "give the faces F"),
        (lambda t: ricci.cohort("fuze.obj", Job("info")), "paths are a list of files: \\['fuze.obj'\\]"),
        (lambda t: ricci.cohort([], 3), "a job is a function of a mesh, or a Job, not int"),
        (lambda t: ricci.hyperelliptic_periods("points"), "points are texts: a list of complex numbers is needed"),
        (lambda t: ricci.to_gifti(t["mesh"], area=3.0), r"area has shape \(\)"),
        (lambda t: ricci.make("torus", rings=3), "there is no option 'rings' of make"),
        (lambda t: t["mesh"].with_attributes(uv="x"), "uv has shape|texts"),
        (lambda t: ricci.uniformize(t["mesh"], start=t["mesh"]), "start: a Metric is needed, not Mesh"),
        (lambda t: t["layout"].write(3), "a file's name is needed, not int"),
        (lambda t: ricci.uniformize(t["mesh"], flow=3), "options are a dict"),
    ],
)
def test_messages_name_what_to_call(things, call, words):
    with pytest.raises(ValueError, match=words) as told:
        call(things)
    assert isinstance(told.value, ricci.RicciError)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: Job("flowx"), "'flowx' is none of info, flow"),
        (lambda: Job("flow", {"targt": 1}), "no option 'targt'.*did you mean 'target'"),
        (lambda: Job("circles", {"flow": {"tol": 1}}), "no option 'tol'"),
        (lambda: Job("info", seconds=0), "seconds is 0"),
        (lambda: ricci.harmonic(ricci.make("disk", n=3), targt="disk"), "no option 'targt'.*did you mean 'target'"),
        (lambda: ricci.cover(ricci.make("torus", n=8), dept=2), "no option 'dept'.*did you mean 'depth'"),
        (lambda: ricci.cohort([], Job("info"), engin="inline"), "no option 'engin'.*did you mean 'engine'"),
        (lambda: ricci.make("torus", nn=3), "no option 'nn'"),
        (lambda: ricci.change(ricci.make("disk", n=3), "punch"), "punch needs count"),
        (lambda: ricci.change(ricci.make("disk", n=3), "invert", amount=1.0), "invert needs centre"),
    ],
)
def test_names_are_looked_at(call, words):
    with pytest.raises(ricci.ArgumentError, match=words):
        call()


def plane(**given):
    return ricci.Spline.plane(ricci.make("disk", n=3), **given)


@pytest.mark.parametrize(
    ("call", "name"),
    [
        *(
            (lambda mesh, name=name: ricci.flow(mesh, **{name: 0}), name)
            for name in ("max_iterations", "tolerance", "threads", "max_step", "step_size")
        ),
        (lambda mesh: ricci.uniformize(mesh, flow={"tolerance": 0.0}), "tolerance"),
        (lambda mesh: ricci.uniformize(mesh, boundary="straight", corners=0), "corners"),
        (lambda mesh: ricci.layout(ricci.flow(mesh), threads=0), "threads"),
        (lambda mesh: ricci.match(mesh, mesh, threads=0), "threads"),
        (lambda mesh: ricci.circles(mesh, least_loop=0), "least_loop"),
        (lambda mesh: ricci.structure(mesh, kind="conformal", radius=0), "radius"),
        (lambda mesh: ricci.harmonic(mesh, target="polygon", n=0), "n is 0"),
        (lambda mesh: ricci.harmonic(mesh, method="heat", step=0.0), "step"),
        (lambda mesh: ricci.harmonic_map(mesh, method="heat", max_iterations=0), "max_iterations"),
        (lambda mesh: mesh.refine_angle(least_angle=0), "least_angle"),
        (lambda mesh: mesh.refine_angle(most_added=0), "most_added"),
        (lambda mesh: ricci.Soup(mesh.V, mesh.F).refine(longest_edge=0.0), "longest_edge"),
        *((lambda mesh, name=name: ricci.texture_atlas(mesh, **{name: 0}), name) for name in ("stretch", "page", "density", "threads")),
        (lambda mesh: plane(degree=0), "degree"),
        (lambda mesh: plane(spread=0.0), "spread"),
        *(
            (lambda mesh, name=name: ricci.spline(mesh, **{name: 0}), name)
            for name in ("degree", "control_points", "tolerance", "fairness", "spread", "rounds", "threads")
        ),
        *((lambda mesh, name=name: ricci.bicubic(plane(), **{name: 0}), name) for name in ("tolerance", "angle", "threads")),
        (lambda mesh: ricci.cohort([], Job("info"), workers=0), "workers"),
        (lambda mesh: ricci.make("genus", a=0), "a is 0"),
        (lambda mesh: ricci.make("torus", n=0), "0"),
        (lambda mesh: ricci.make("torus", b=0.0), "0"),
    ],
)
def test_zero_is_not_the_default(call, name):
    with pytest.raises(ricci.ArgumentError, match=name):
        call(ricci.make("disk", n=4))


def test_none_is_the_default():
    disk = ricci.make("disk", n=4)
    assert np.array_equal(ricci.flow(disk, tolerance=None, max_iterations=None).u, ricci.flow(disk).u)


def test_a_zero_that_means_none_is_none():
    """The fairness of a fit, and its corrections."""
    flat = plane(degree=2)
    points = np.random.default_rng(0).uniform(-1, 1, (8000, 3))
    points = points[np.hypot(points[:, 0], points[:, 1]) < 0.95]
    assert np.array_equal(flat.fit(points, fairness=0.0).control_points, flat.fit(points, fairness=-1.0).control_points)
    assert not np.array_equal(flat.fit(points, fairness=0.0).control_points, flat.fit(points, fairness=1e-3).control_points)


def test_shapes_have_the_sizes_of_the_command():
    counts = {
        "sphere": (10 * 16**2 + 2, 0),
        "ellipsoid": (10 * 16**2 + 2, 0),
        "disk": (3 * 24 * 25 + 1, 0),
        "annulus": (17 * 72, 0),
        "torus": (64 * 32, 1),
        "genus": (8 * 11 * 36 + 2 - 4, 2),
        "knot": (240 * 20, 1),
        "flat_torus": (256, 1),
        "bolza": (None, 2),
        "one_vertex": (1, 2),
        "two_vertex": (2, 2),
        "two_triangles": (3, 0),
        "pants": (None, 0),
        "hyperelliptic": (None, 2),
        "fenchel_nielsen": (None, 2),
    }
    for shape, (n, genus) in counts.items():
        mesh = ricci.make(shape)
        assert mesh.genus == genus, shape
        assert n is None or mesh.n_vertices == n, (shape, mesh.n_vertices)
    assert ricci.make("torus", n=32).n_vertices == 32 * 16
    assert ricci.make("torus", n=10, m=None).n_vertices == 50


def test_files_fail_as_every_file_does(tmp_path):
    with pytest.raises(FileNotFoundError) as missing:
        ricci.read(tmp_path / "nothing.obj")
    assert isinstance(missing.value, ricci.FileError)
    assert (missing.value.errno, missing.value.filename) == (errno.ENOENT, str(tmp_path / "nothing.obj"))
    assert missing.value.strerror == "No such file or directory"
    assert missing.value.status == ricci.Status.IO
    (tmp_path / "folder.obj").mkdir()
    with pytest.raises(IsADirectoryError):
        ricci.read(tmp_path / "folder.obj")
    with pytest.raises(NotADirectoryError) as under:
        ricci.Soup.read(tmp_path / "folder.obj" / ".." / ".." / __file__ / "x.obj")
    assert under.value.errno == errno.ENOTDIR
    with pytest.raises(FileNotFoundError) as unwritten:
        ricci.make("disk", n=3).write(tmp_path / "nowhere" / "disk.obj")
    assert unwritten.value.filename == str(tmp_path / "nowhere" / "disk.obj")
    with pytest.raises(FileNotFoundError):
        ricci.Spline.read(tmp_path / "nothing.json")
    with pytest.raises(ricci.FileError) as unknown:
        ricci.read(tmp_path / "mesh.xyz")
    assert unknown.value.errno is None
    assert unknown.value.filename == str(tmp_path / "mesh.xyz")


def test_indices_have_a_sign(torus, disk):
    flat = ricci.flow(torus, target="auto:2")
    laid, matched = ricci.layout(flat), ricci.match(disk, disk)
    arrays = [torus.F, torus.edges, torus.face_edges, *disk.boundary, laid.corners(), laid.flipped(), ricci.charts(laid).charts]
    arrays += [flat.report.cones, flat.mirror, matched.faces(), ricci.Map(flat).faces(), ricci.Map(flat).crossings()[0]]
    arrays += [ricci.structure(torus).F, ricci.structure(torus).chart_faces[0], ricci.homotopy(torus).domain().corners[0]]
    arrays += [ricci.Soup(disk.V, disk.F).F, ricci.Soup(disk.V, disk.F[:1]).defects[0].vertices]
    assert {array.dtype for array in arrays} == {np.dtype(np.int32)}
    assert (torus.F - 1).min() == -1
    assert (torus.F[0] - torus.F[1]).min() < 0
