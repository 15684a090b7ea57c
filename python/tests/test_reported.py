"""What users have reported as wrong: one test for each report, with the calls that they made."""

import copy
import pickle
import signal
import subprocess
import sys
import time
import warnings

import numpy as np
import pytest

import ricci


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("meshes")
    for n in (2, 3):
        ricci.make("genus", genus=2, n=n).write(folder / f"genus{n}.obj")
    return [str(folder / f"genus{n}.obj") for n in (2, 3)]


def test_01_the_reader_can_be_sent():
    cloudpickle = pytest.importorskip("cloudpickle")
    for function in (ricci.read, ricci.Mesh.read, ricci.flow, ricci.cohort):
        assert pickle.loads(cloudpickle.dumps(function)).__name__ == function.__name__


def test_02_an_edited_job_gets_no_old_table(files, tmp_path):
    pytest.importorskip("pyarrow")
    place = {"out": tmp_path / "out", "engine": "inline"}

    def job(mesh):
        return {"a": 1}

    assert ricci.cohort(files, job, **place).results.column_names[-1] == "a"

    def job(mesh):
        return {"b": 2}

    with pytest.raises(ricci.ArgumentError, match="has changed since"):
        ricci.cohort(files, job, **place)
    with pytest.raises(ricci.ArgumentError, match="rows of another job"):
        ricci.cohort(files, job, **place, read=lambda path: 1 / 0)


CELLS = [
    "import ricci\ndef job(mesh): return {'K': float(ricci.Metric(mesh).curvature.max())}",
    "[ricci.cohort(PATHS, job, 'out1').failures, ricci.cohort(PATHS, job, 'out2', engine='dask', workers=1).failures]",
    "from distributed import Client\nclient = Client(n_workers=1, threads_per_worker=1, dashboard_address=':0')",
    "found = ricci.cohort(PATHS, job, 'out3', engine=client)\n[found.failures, found.results.column_names[-1]]",
    "def job(mesh): return {'Kmin': float(ricci.Metric(mesh).curvature.min())}",
    "try:\n    print(ricci.cohort(PATHS, job, 'out3', engine=client))\nexcept ricci.ArgumentError as wrong:\n    print(wrong)",
    "client.close()",
]


def test_03_a_job_of_a_notebooks_cell_runs_on_every_engine(files, tmp_path):
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    for package in ("ipykernel", "pyarrow", "distributed", "cloudpickle"):
        pytest.importorskip(package)
    cells = [nbformat.v4.new_code_cell(cell) for cell in (f"PATHS = {files!r}", *CELLS)]
    book = nbformat.v4.new_notebook(cells=cells)
    nbclient.NotebookClient(book, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}).execute()
    told = [[out.get("text") or out["data"]["text/plain"] for out in cell.outputs if "text" in out or "data" in out] for cell in cells]
    assert told[2][-1] == "[[], []]"
    assert told[4] == ["[[], 'K']"]
    assert "has changed since" in told[6][0]


INTERRUPTED = """
import ricci
from ricci.cohorts import Job
if __name__ == "__main__":
    try:
        ricci.cohort({paths!r}, Job("flow", {{"target": "auto:40"}}), "out", engine="processes", workers=2)
    except KeyboardInterrupt:
        print("stopped", flush=True)
    import time
    time.sleep(60)
"""


def test_04_no_worker_is_left_after_an_interrupt_in_the_library(tmp_path):
    psutil = pytest.importorskip("psutil")
    pytest.importorskip("pyarrow")
    ricci.make("torus", n=500).write(tmp_path / "large.obj")
    script = tmp_path / "script.py"
    script.write_text(INTERRUPTED.format(paths=[str(tmp_path / "large.obj")]))

    def hear_interrupts():
        signal.signal(signal.SIGINT, signal.default_int_handler)

    process = subprocess.Popen([sys.executable, str(script)], cwd=tmp_path, stdout=subprocess.PIPE, preexec_fn=hear_interrupts)
    try:
        at_work = []
        while not any(sum(child.cpu_times()[:2]) > 2 for child in at_work):
            assert process.poll() is None, "the run was over before it could be stopped"
            time.sleep(0.05)
            at_work = psutil.Process(process.pid).children()
        process.send_signal(signal.SIGINT)
        assert psutil.wait_procs(at_work, timeout=1)[1] == []
        assert process.stdout.readline() == b"stopped\n"
    finally:
        process.kill()
        process.wait()


def test_05_meshes_are_pickled_and_copied():
    mesh = ricci.make("sphere", n=4)
    assert pickle.loads(pickle.dumps(mesh)).V.tobytes() == mesh.V.tobytes()
    assert copy.deepcopy(mesh) is mesh


def test_06_layouts_are_written_as_their_ending_says(tmp_path, disk):
    laid = ricci.layout(ricci.flow(disk))
    laid.write(tmp_path / "a.ply")
    laid.write(tmp_path / "a.glb")
    assert (tmp_path / "a.ply").read_bytes()[:4] == b"ply\n"
    assert (tmp_path / "a.glb").read_bytes()[:4] == b"glTF"
    with pytest.raises(ricci.FileError, match="unknown format"):
        laid.write(tmp_path / "a.vtk")


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda m: ricci.layout(m), "a Metric is needed, not Mesh"),
        (lambda m: ricci.deck(m), "a Uniform is needed, not Mesh"),
        (lambda m: ricci.charts(ricci.flow(m)), "a Layout is needed, not Metric"),
        (lambda m: ricci.flow(m, "uniform"), "target='uniform'"),
        (lambda m: ricci.cohort("fuze.obj", ricci.Job("info"), engine="inline"), "paths are a list of files"),
        (lambda m: ricci.Job("flowx"), "'flowx' is none of info, flow"),
        (lambda m: ricci.Job("flow", {"targt": 1}), "did you mean 'target'"),
        (lambda m: ricci.hyperelliptic_periods("points"), "points are texts"),
        (lambda m: ricci.to_gifti(m, area=3.0), r"area has shape \(\)"),
        (lambda m: ricci.make("torus", rings=3), "there is no option 'rings'"),
    ],
)
def test_07_what_does_not_fit_is_our_error(genus2, tmp_path, monkeypatch, call, words):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ricci.ArgumentError, match=words):
        call(genus2)


def test_07_grids_of_pyvista_say_what_makes_a_surface_of_them(genus2):
    pyvista = pytest.importorskip("pyvista")
    with pytest.raises(ricci.ArgumentTypeError, match=r"extract_surface\(\)\.triangulate\(\)"):
        ricci.as_mesh(pyvista.Sphere().cast_to_unstructured_grid())
    assert ricci.to_pyvista((genus2.V, genus2.F)).n_points == genus2.n_vertices


@pytest.mark.parametrize("given", [{"max_iterations": 0}, {"tolerance": 0.0}])
def test_08_zero_is_not_the_default(genus2, given):
    with pytest.raises(ricci.ArgumentError, match=next(iter(given))):
        ricci.flow(genus2, **given)


def test_08_progress_is_a_function(genus2):
    with pytest.raises(ricci.ArgumentTypeError, match="progress"):
        ricci.flow(genus2, progress=3)


def test_09_a_missing_file_is_missing():
    with pytest.raises(FileNotFoundError) as wrong:
        ricci.read("nothere.obj")
    assert (wrong.value.errno, wrong.value.filename) == (2, "nothere.obj")


def test_10_a_cover_has_a_neighbour_across_every_side(genus2):
    curved = ricci.uniformize(genus2)
    across = {tuple(word) for word in ricci.deck(curved, kind="sides").words}
    assert across <= {tuple(word) for word in ricci.cover(curved).deck.words}


def test_11_labels_stay_labels():
    a, b = ricci.make("sphere", n=6), ricci.make("sphere", n=7)
    carried = ricci.match(a, b).carry(np.arange(b.n_vertices))
    assert carried.dtype.kind == "i"
    nibabel = pytest.importorskip("nibabel")
    codes = nibabel.nifti1.intent_codes
    arrays = ricci.to_gifti(b, aparc=np.arange(b.n_vertices), thickness=np.ones(b.n_vertices)).darrays
    assert [array.intent for array in arrays[-2:]] == [codes["NIFTI_INTENT_LABEL"], codes["NIFTI_INTENT_SHAPE"]]


def test_12_what_has_not_converged_is_told(genus2):
    with pytest.warns(ricci.NotConverged, match="iteration_limit"):
        flat = ricci.flow(genus2, target="auto:6", max_iterations=1)
    with pytest.warns(ricci.NotConverged):
        ricci.layout(flat)
    with pytest.raises(ricci.RicciError), warnings.catch_warnings():
        ricci.layout(ricci.Metric(genus2))


def test_13_texture_coordinates_go_along(tmp_path, disk):
    laid = ricci.layout(ricci.flow(disk))
    disk.write(tmp_path / "u.obj", uv=laid.uv())
    mesh = ricci.read(tmp_path / "u.obj")
    assert mesh.uv is not None
    pytest.importorskip("pyvista")
    assert ricci.to_pyvista(mesh).active_texture_coordinates is not None
    pytest.importorskip("trimesh")
    assert ricci.to_trimesh(mesh).visual.uv.shape == (mesh.n_vertices, 2)


@pytest.mark.parametrize("shape", ["torus", "sphere", "disk", "genus", "annulus"])
def test_14_shapes_have_sizes_of_their_own(shape):
    assert ricci.make(shape).n_faces > 100


def test_15_faces_can_be_subtracted_from():
    mesh = ricci.make("sphere", n=4)
    assert mesh.F.dtype == np.int32
    assert (mesh.F - 1).max() == mesh.n_vertices - 2
    assert (mesh.F[0] - mesh.F[1]).min() < 0
