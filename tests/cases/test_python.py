"""The scripts of ../shared/cases/python: what is right in the Python package, on the same meshes and with the same calls.

Each test has the number of its script. The package is the one that the running Python finds; its own tests (python/tests) hold the rest of
each kind of fault.
"""

import copy
import os
import pickle
import signal
import subprocess
import sys
import textwrap
import time
import warnings

import numpy as np
import pytest
from conftest import MESHES, rows

package = pytest.importorskip("ricci")

pytestmark = [
    pytest.mark.row("python/*.py"),
    pytest.mark.skipif(not rows(), reason="../shared/cases is absent: set RICCI_MESHES to the corpus beside it"),
]


@pytest.fixture
def good():
    """A function that gives the path of a good mesh of the corpus."""

    def find(name):
        path = MESHES / "good" / name
        assert path.is_file(), f"{path} is absent"
        return str(path.resolve())

    return find


@pytest.fixture(scope="module")
def genus2():
    return package.make("genus", genus=2, n=6)


def run(text, folder, *words):
    """What a program prints that Python reads from its standard input: it has no file, as a notebook has none."""
    done = subprocess.run(
        [sys.executable, "-", *words], input=textwrap.dedent(text), cwd=folder, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def refused(call, kinds, *words):
    """A call fails with one of the kinds of exceptions, and its message has the words."""
    with pytest.raises(kinds) as told:
        call()
    missing = [word for word in words if word not in str(told.value)]
    assert not missing, f"{told.value} does not say {missing}"
    return told.value


def test_01_dask_takes_jobs_of_scripts(good, tmp_path):
    cloudpickle = pytest.importorskip("cloudpickle")
    pytest.importorskip("distributed")
    assert pickle.loads(cloudpickle.dumps(package.read)) is package.read
    script = tmp_path / "script.py"
    script.write_text(
        textwrap.dedent(
            """
            import sys, ricci
            def job(mesh):
                return {"genus": mesh.genus, "K": float(ricci.Metric(mesh).curvature.max())}
            if __name__ == "__main__":
                found = ricci.cohort(sys.argv[1:], job, "out", engine="dask", workers=1)
                print(found.failures, found.results["genus"].to_pylist())
            """
        )
    )
    meshes = [good("fuze.obj"), good("bob.obj")]
    done = subprocess.run([sys.executable, script, *meshes], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.stdout.split("\n")[0] == f"[] {[package.read(path).genus for path in meshes]}", done.stderr


def test_02_an_edited_job_gets_no_old_table(good, tmp_path):
    pytest.importorskip("pyarrow")
    mesh, out = good("fuze.obj"), tmp_path / "q6"

    def job(m):
        return {"a": 1}

    assert package.cohort([mesh], job, out, engine="inline").results.column_names[-1] == "a"
    first = job

    def job(m):
        return {"b": 2}

    refused(lambda: package.cohort([mesh], job, out, engine="inline"), ValueError, "has changed since", "another folder")
    refused(lambda: package.cohort([mesh], first, out, engine="inline", read=lambda p: 1 / 0), ValueError, "rows of another job")
    assert package.cohort([mesh], first, out, engine="inline").results["ok"].to_pylist() == [True]


def test_03_jobs_of_notebooks_reach_the_workers(good, tmp_path):
    pytest.importorskip("cloudpickle")
    printed = run(
        """
        import sys, ricci
        def job(mesh):
            return {"K": float(ricci.Metric(mesh).curvature.max())}
        for engine in ("processes", "inline"):
            found = ricci.cohort(sys.argv[1:], job, engine, engine=engine)
            print([(row["error"], row["message"]) for row in found.failures], found.results["K"].to_pylist())
        """,
        tmp_path,
        good("fuze.obj"),
        good("eight_315.obj"),
        good("bob.obj"),
    )
    assert printed[0].startswith("[] [")
    assert printed[0] == printed[1]


def test_04_no_worker_is_left_after_an_interrupt(good, tmp_path):
    psutil = pytest.importorskip("psutil")
    meshes = [good(name) for name in ("igea_134k.obj", "max_planck_25k.obj", "pair_face_rage.obj")]
    script = tmp_path / "run.py"
    script.write_text(
        f"""
import ricci
try:
    ricci.cohort({meshes!r}, ricci.Job("flow", {{"target": "auto:40"}}), "cz", engine="processes", workers=2)
except KeyboardInterrupt:
    print("interrupted", flush=True)
    input()
"""
    )
    # What a shell runs in the background ignores SIGINT, and so would its children.
    heard = lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)
    process = subprocess.Popen(
        [sys.executable, script], cwd=tmp_path, stdin=subprocess.PIPE, stdout=subprocess.PIPE, preexec_fn=heard
    )
    try:
        end = time.time() + 30
        while len(psutil.Process(process.pid).children()) < 2:
            assert process.poll() is None
            assert time.time() < end
            time.sleep(0.05)
        time.sleep(1.5)
        os.kill(process.pid, signal.SIGINT)
        assert process.stdout.readline() == b"interrupted\n"
        assert psutil.Process(process.pid).children(recursive=True) == []
    finally:
        process.kill()
        process.wait()


def test_05_meshes_are_pickled_and_copied():
    mesh = package.make("sphere", n=4)
    again = pickle.loads(pickle.dumps(mesh))
    assert again.V.tobytes() == mesh.V.tobytes()
    assert again.F.tobytes() == mesh.F.tobytes()
    assert again.face_edges.tobytes() == mesh.face_edges.tobytes()
    assert again.lengths.tobytes() == mesh.lengths.tobytes()
    assert copy.deepcopy({"mesh": mesh})["mesh"].F.tobytes() == mesh.F.tobytes()
    metric = package.flow(mesh)
    assert pickle.loads(pickle.dumps(metric)).u.tobytes() == metric.u.tobytes()
    assert copy.deepcopy(metric).lengths.tobytes() == metric.lengths.tobytes()


def test_06_the_ending_says_the_format(tmp_path):
    laid = package.layout(package.flow(package.make("disk", n=4)))
    for name, start in (("a.ply", b"ply\n"), ("a.glb", b"glTF"), ("a.obj", b"v "), ("a.off", b"STOFF"), ("a.vtk", b"# vtk")):
        laid.write(tmp_path / name)
        assert (tmp_path / name).read_bytes().startswith(start), name
        back = package.Soup.read(tmp_path / name).uv
        np.testing.assert_allclose(back, laid.uv(), atol=1e-6 if name == "a.glb" else 0)
    refused(lambda: laid.write(tmp_path / "a.stl"), OSError, "a.stl", ".obj, .off, .ply, .glb")
    assert not (tmp_path / "a.stl").exists()


def test_07_errors_say_what_to_call(genus2):
    pyvista = pytest.importorskip("pyvista")
    kinds = (TypeError, ValueError)
    refused(lambda: package.layout(genus2), TypeError, "a Metric is needed, not Mesh", "ricci.flow(mesh)")
    refused(lambda: package.deck(genus2), TypeError, "a Uniform is needed, not Mesh", "ricci.uniformize(mesh)")
    refused(lambda: package.charts(package.metric(genus2)), TypeError, "a Layout is needed, not Metric", "ricci.layout(metric)")
    refused(lambda: package.flow(genus2, "uniform"), TypeError, "target='uniform'")
    refused(lambda: package.as_mesh(pyvista.Sphere().cast_to_unstructured_grid()), TypeError, "extract_surface().triangulate()")
    assert package.to_pyvista((genus2.V, genus2.F)).n_points == genus2.n_vertices
    refused(lambda: package.cohort("fuze.obj", package.Job("info"), "q7", engine="inline"), TypeError, "['fuze.obj']")
    refused(lambda: package.Job("flowx"), kinds, "'flowx'", "uniformize")
    refused(lambda: package.Job("flow", {"targt": 1}), kinds, "'targt'", "did you mean 'target'")


def test_08_zero_is_not_the_default(genus2):
    refused(lambda: package.flow(genus2, max_iterations=0), ValueError, "max_iterations is 0", "None")
    refused(lambda: package.flow(genus2, tolerance=0.0), ValueError, "tolerance is 0.0", "None")
    refused(lambda: package.flow(genus2, progress=3), TypeError, "progress is a function", "Control", "not int")


def test_09_a_missing_file_is_a_file_not_found_error():
    missing = refused(lambda: package.read("nothere.obj"), FileNotFoundError, "nothere.obj")
    assert (missing.errno, missing.filename) == (2, "nothere.obj")
    assert isinstance(missing, package.FileError)


def test_10_a_cover_has_the_neighbours(genus2):
    curved = package.uniformize(genus2)
    across = {tuple(word) for word in package.deck(curved, kind="sides").words}
    assert len(across) == 18
    assert {tuple(word) for word in package.cover(curved).deck.words} == across | {()}


def test_11_labels_stay_labels():
    nibabel = pytest.importorskip("nibabel")
    a, b = package.make("sphere", n=6), package.make("sphere", n=7)
    matching = package.match(a, b)
    labels = np.arange(b.n_vertices)
    carried = matching.carry(labels)
    assert carried.dtype == labels.dtype
    # The nearest corner: that with the most weight.
    heaviest = matching.weights().argmax(1)
    assert np.array_equal(carried, b.F[matching.faces(), heaviest])
    parcels = np.where(b.V[:, 2] > 0, 13, 14)
    assert set(matching.carry(parcels)) == {13, 14}
    refused(lambda: matching.carry(b.V[:, 0] + 1j * b.V[:, 1]), TypeError, "real and imaginary parts")
    refused(lambda: matching.carry(labels.astype(str)), TypeError, "texts")
    image = package.to_gifti(b, aparc=labels, depth=b.V[:, 2])
    assert [array.intent for array in image.darrays[2:]] == [1002, 2005]
    assert nibabel.gifti.GiftiImage.from_bytes(image.to_bytes()).darrays[2].data.tolist() == labels.tolist()


def test_12_what_did_not_converge_warns_and_a_curved_metric_is_not_laid_out(genus2):
    with pytest.warns(package.ConvergenceWarning, match="iteration_limit"):
        early = package.flow(genus2, target="auto:6", max_iterations=1)
    assert not early.converged
    with pytest.warns(package.ConvergenceWarning, match="seams do not fit"):
        package.layout(early)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        package.charts(package.layout(package.flow(genus2, target="auto:6")))
    refused(lambda: package.layout(package.Metric(genus2)), package.LayoutError, "curved at", "ricci.flow(mesh", "cones=")


def test_13_attributes_are_kept(tmp_path):
    pytest.importorskip("pyvista")
    pytest.importorskip("trimesh")
    mesh = package.make("disk", n=5)
    uv = package.layout(package.flow(mesh)).uv()
    mesh.write(tmp_path / "u.obj", uv=uv)
    read = package.read(tmp_path / "u.obj")
    of_vertices = np.zeros((mesh.n_vertices, 2))
    of_vertices[mesh.F] = uv
    np.testing.assert_allclose(package.to_pyvista(read).active_texture_coordinates, of_vertices, atol=1e-7)
    np.testing.assert_allclose(package.to_trimesh(read).visual.uv, of_vertices, atol=0)
    for there in (package.to_pyvista, package.to_trimesh):
        np.testing.assert_allclose(package.as_mesh(there(read)).uv, uv, atol=1e-7)


def test_14_shapes_have_defaults():
    genera = {"torus": (1, 0), "sphere": (0, 0), "disk": (0, 1), "genus": (2, 0), "annulus": (0, 2)}
    for shape, (genus, loops) in genera.items():
        made = package.make(shape)
        assert (made.genus, made.summary.n_boundary_loops) == (genus, loops)


def test_14_the_defaults_are_those_of_the_command(ricci, tmp_path):
    for shape in ("torus", "annulus", "genus", "knot"):
        assert ricci("make", shape, "-o", f"{shape}.off", report=False).code == 0
        written = package.read(tmp_path / f"{shape}.off")
        mesh = package.make(shape)
        assert np.array_equal(written.F, mesh.F), shape
        assert np.array_equal(written.V, mesh.V), shape


def test_15_indices_have_a_sign():
    mesh = package.make("sphere", n=4)
    assert mesh.F.dtype == np.int32
    assert (mesh.F - 1).min() == -1
    assert (mesh.F[0] - mesh.F[1]).min() < 0
    assert package.Mesh(mesh.V, mesh.F).F.tobytes() == mesh.F.tobytes()
