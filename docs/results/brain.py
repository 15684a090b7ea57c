#!/usr/bin/env python3
"""Spheres, inflated views and flat maps of cortices, read again by nibabel; and a cohort of twenty subjects that is stopped and resumed.

usage: docs/results/brain.py [CORPUS] > docs/results/brain.md
(after: cargo build --release -p ricci-apps, in a Python with: pip install numpy nibabel nilearn autoflatten)

Turned triangles, lengths and areas are those that this file finds in the numbers that nibabel reads.
"""
import os
import signal
import subprocess
import time
from fractions import Fraction

import nibabel
import nilearn
import numpy as np
from autoflatten.flatten.algorithm import count_flipped_triangles
from autoflatten.viz import compute_kring_distortion
from nibabel import freesurfer
from nilearn.surface import load_surf_data, load_surf_mesh
from page import corpus, main, ricci, table, verdict

CORTICES = [("fsaverage5 pial", "cortex_fsaverage5_pial_left", "lh"), ("fsaverage5 pial", "cortex_fsaverage5_pial_right", "rh"),
            ("fsaverage5 white", "cortex_fsaverage5_white_left", "lh")]
SUBJECTS = 20
# The part of the subjects after which the cohort is stopped for the first time.
STOPPED = 0.4


def turned(corners):
    """The number of triangles (m x 3 x 2 or m x 3 x 3 from the middle) that are not counterclockwise; fractions where floating point is not sure."""
    rows = corners.astype(float)
    if rows.shape[2] == 2:
        rows = np.concatenate([rows, np.ones_like(rows[:, :, :1])], 2)
    sizes = np.abs(rows).max(axis=(1, 2)) ** 3
    dets = np.linalg.det(rows)
    sure = np.abs(dets) > 1e-12 * sizes
    count = int((sure & (dets < 0)).sum())
    for a, b, c in rows[~sure]:
        a, b, c = ([Fraction(float(x)) for x in point] for point in (a, b, c))
        cross = (b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0])
        count += sum(x * y for x, y in zip(a, cross, strict=True)) <= 0
    return count


def patch(path):
    """Vertices, places and the border of a patch of FreeSurfer, which nibabel does not read."""
    words = np.fromfile(path, ">i4")
    assert words[0] == -1 and len(words) == 2 + 4 * words[1]
    rows = words[2:].reshape(-1, 4)
    return np.abs(rows[:, 0]) - 1, rows[:, 1:].copy().view(">f4").astype(float), rows[:, 0] < 0


def written(run, name, side, path, *options):
    """The report of `ricci brain` on a surface under the name of its hemisphere, the beginning of its files, and the surface as nibabel reads it."""
    folder = run.path(f"{name}-{side}".replace(" ", "-"))
    os.makedirs(folder, exist_ok=True)
    given = os.path.join(folder, f"{side}.pial")
    subprocess.run([ricci, "repair", path, "--no-weld", "-o", given, "--quiet"], check=True, capture_output=True)
    report = run.report(name, "brain", given, "-o", os.path.join(folder, "maps"), "--gifti", *options)
    return report, os.path.join(folder, "maps", side), freesurfer.read_geometry(given)


def same_in_both(run, name, at, F):
    """Insists that the files of FreeSurfer and GIFTI hold the same numbers, to the last bit."""
    for freesurfers, giftis in (("sphere", "sphere.surf.gii"), ("inflated", "inflated.surf.gii")):
        V, G = freesurfer.read_geometry(f"{at}.{freesurfers}")
        image = nibabel.load(f"{at}.{giftis}")
        points, faces = (image.agg_data(kind) for kind in ("pointset", "triangle"))
        same = (G == F).all() and (faces == F).all() and (points.astype(np.float32) == V.astype(np.float32)).all()
        run.insist(same, f"{name}: {freesurfers} and {giftis} differ")
    arrays = nibabel.load(f"{at}.distortion.shape.gii").darrays
    for k, ending in enumerate(("sphere.areal", "sphere.shape", "flat.areal", "flat.shape")):
        values = freesurfer.read_morph_data(f"{at}.{ending}")
        run.insist((arrays[k].data == values).all(), f"{name}: {ending} differs in GIFTI")
    label = freesurfer.read_label(f"{at}.cortex.label")
    labels = nibabel.load(f"{at}.cortex.label.gii")
    run.insist((np.flatnonzero(labels.agg_data()) == np.sort(label)).all(), f"{name}: the label differs in GIFTI")
    run.insist(labels.labeltable.get_labels_as_dict() == {0: "medial wall", 1: "cortex"}, f"{name}: the table of labels")
    return label


def lengths_off(V, F, W):
    """The mean of |length in the image / length - 1| over the sides of triangles, in percent."""
    sides = np.sort(np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), axis=1)
    a, b = np.unique(sides, axis=0).T
    return 100 * np.abs(np.linalg.norm(W[a] - W[b], axis=1) / np.linalg.norm(V[a] - V[b], axis=1) - 1).mean()


def surface_area(V, F):
    return np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1).sum() / 2


def cortex_row(run, name, file, side):
    report, at, (V, F) = written(run, name, side, os.path.join(corpus, f"{file}.obj"))
    if report is None:
        return None
    label = same_in_both(run, name, at, F)
    S, _ = freesurfer.read_geometry(f"{at}.sphere")
    radii = np.linalg.norm(S, axis=1)
    run.insist(np.abs(radii - 100).max() < 1e-4, f"{name}: the sphere has radii {radii.min()} to {radii.max()}")
    vertices, P, _ = patch(f"{at}.cortex.patch.flat")
    run.insist((np.sort(vertices) == np.sort(label)).all(), f"{name}: the patch has other vertices than the label")
    number = np.full(len(V), -1)
    number[vertices] = np.arange(len(vertices))
    inside = F[(number[F] >= 0).all(axis=1)]
    on_sphere, in_plane = turned(S[F]), turned(P[number[inside]][:, :, :2])
    run.insist(on_sphere == 0 and in_plane == 0, f"{name}: {on_sphere} and {in_plane} triangles are turned over in the files")
    radius = np.sqrt(surface_area(V, F) / (4 * np.pi))
    row = report["result"]["hemispheres"][0]
    sphere, flat = row["sphere"], row["flat"]
    return [f"{name}, {side}", len(V), sphere["start"], sphere["iterations"], f"{sphere['after']['energy']:.4f}", f"{lengths_off(V, F, radius * S / 100):.2f}",
            f"{100 * sphere['after']['mean_area_error']:.1f}", f"{sphere['after']['mean_dilatation']:.3f}", on_sphere, len(vertices), flat["iterations"],
            f"{flat['after']['energy']:.4f}", f"{lengths_off(V, inside, P[number]):.2f}", in_plane, f"{100 * flat['overlap']:.2g}"]


def same_in_nilearn(run, name, at, n):
    """Insists that nilearn's own loaders read the files of both formats, and the same from both."""
    for kind in ("sphere", "inflated"):
        one, other = (load_surf_mesh(f"{at}.{kind}{ending}") for ending in ("", ".surf.gii"))
        same = (one.coordinates == other.coordinates).all() and (one.faces == other.faces).all()
        run.insist(same and len(one.coordinates) == n, f"{name}: nilearn reads another {kind} from GIFTI")
    sulc = [load_surf_data(f"{at}.sulc{ending}") for ending in ("", ".shape.gii")]
    run.insist(len(sulc[0]) == n and (sulc[0] == sulc[1]).all(), f"{name}: nilearn reads another sulc from GIFTI")


def others_row(run, name, file, side, energy):
    """What nilearn and autoflatten say of the files."""
    report, at, (V, F) = written(run, f"{name}-{energy}", side, os.path.join(corpus, f"{file}.obj"), "--energy", energy)
    if report is None:
        return None
    same_in_nilearn(run, name, at, len(V))
    vertices, P, _ = patch(f"{at}.cortex.patch.flat")
    order = np.argsort(vertices)
    vertices, P = vertices[order], P[order, :2]
    number = np.full(len(V), -1)
    number[vertices] = np.arange(len(vertices))
    inside = F[(number[F] >= 0).all(axis=1)]
    turned_over = int(count_flipped_triangles(P, number[inside]))
    run.insist(turned_over == 0, f"{name}: autoflatten finds {turned_over} flipped triangles")
    errors = [compute_kring_distortion(P, V, F, vertices, k=k, verbose=False)[1] for k in (2, 7)]
    return [f"{name}, {side}", energy, *(f"{error:.2f}" for error in errors), turned_over]


def subject(run, k):
    """Both hemispheres of a synthetic subject: the average ones, stretched and bent by a few waves."""
    random = np.random.default_rng(k)
    folder = run.path(f"subject-{k:02d}")
    os.makedirs(folder, exist_ok=True)
    stretch, waves = random.uniform(0.9, 1.1, 3), random.uniform(-0.004, 0.004, (3, 3))
    for side, file in (("lh", "cortex_fsaverage5_pial_left"), ("rh", "cortex_fsaverage5_pial_right")):
        V, F = freesurfer.read_geometry(run.path(f"{side}.average"))
        moved = stretch * V + 10 * np.sin(V @ (waves * 10).T)
        freesurfer.write_geometry(os.path.join(folder, f"{side}.pial"), moved, F)
    return folder


def command(folder):
    surfaces = [os.path.join(folder, f"{side}.pial") for side in ("lh", "rh")]
    return [ricci, "brain", *surfaces, "-o", os.path.join(folder, "maps"), "--resume", "--quiet"]


def cohort(run):
    """The files of a cohort that is stopped while it works and goes on, and how many of them were made twice."""
    for side, file in (("lh", "cortex_fsaverage5_pial_left"), ("rh", "cortex_fsaverage5_pial_right")):
        path = os.path.join(corpus, f"{file}.obj")
        subprocess.run([ricci, "repair", path, "--no-weld", "-o", run.path(f"{side}.white"), "--quiet"], check=True, capture_output=True)
        os.rename(run.path(f"{side}.white"), run.path(f"{side}.average"))
    folders = [subject(run, k) for k in range(SUBJECTS)]
    seconds, stopped_in = [], None
    for k, folder in enumerate(folders):
        if k == int(STOPPED * SUBJECTS):
            working = subprocess.Popen(command(folder), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            # Well before the end of the quickest subject so far.
            time.sleep(0.3 * min(seconds))
            run.insist(working.poll() is None, "the cohort was to be stopped at work, and had ended")
            working.send_signal(signal.SIGINT)
            stopped_in = working.wait()
            break
        begun = time.monotonic()
        run.insist(subprocess.run(command(folder)).returncode == 0, f"subject {k} failed")
        seconds.append(time.monotonic() - begun)
    run.insist(stopped_in == 4, f"the cohort was stopped with exit code {stopped_in}, not 4")
    before = {path: os.stat(path).st_mtime_ns for path in files_of(folders)}
    for k, folder in enumerate(folders):
        run.insist(subprocess.run(command(folder)).returncode == 0, f"subject {k} failed")
    again = sum(os.stat(path).st_mtime_ns != kept for path, kept in before.items())
    run.insist(again == 0, f"{again} files were made twice")
    whole = len(files_of(folders))
    run.insist(whole == SUBJECTS * 2 * 9, f"{whole} files, not {SUBJECTS * 2 * 9}")
    made = {path: os.stat(path).st_mtime_ns for path in files_of(folders)}
    for folder in folders:
        subprocess.run(command(folder), check=True)
    third = sum(os.stat(path).st_mtime_ns != kept for path, kept in made.items())
    run.insist(third == 0, f"{third} files were made again when nothing was left to do")
    return [[SUBJECTS, len(before), whole, again, third]]


def files_of(folders):
    maps = [os.path.join(folder, "maps") for folder in folders]
    return [os.path.join(at, name) for at in maps if os.path.isdir(at) for name in sorted(os.listdir(at))]


def content(run):
    rows = run.rows(CORTICES, lambda run, one: cortex_row(run, *one))
    head = ["surface", "V", "start", "steps", "energy", "lengths: mean %", "areas: mean %", "dilatation", "turned", "V of the cortex", "steps", "energy",
            "lengths: mean %", "turned", "overlap %"]
    yield "# Cortices on the sphere and in the plane"
    yield ("Made by `docs/results/brain.py`: `ricci brain` with default options on the cortices of the corpus, the medial wall found; its files are read again by "
           f"nibabel {nibabel.__version__}. The files of FreeSurfer and of GIFTI hold the same numbers, to the last bit.")
    yield ("*lengths*: |length on the sphere or in the plane / length - 1| of the edges, found in the files. *areas*: |area / area - 1| of the triangles, the sphere scaled to the "
           "surface's area. *dilatation*: larger stretch over the smaller one. *turned*: triangles that are not counterclockwise in the single-precision numbers of the files, by "
           "fractions where floating point is not sure. Left: the sphere; right: the flat map.")
    yield table(head, rows)
    yield "## What other programs say"
    yield (f"The loaders of nilearn {nilearn.__version__} open the spheres, the inflated views and the values, in FreeSurfer's format and in GIFTI, and read the same numbers from both. "
           "The distance error of a flat map by autoflatten's own function (1.0.7; percent, over the pairs of vertices that up to so many edges separate, with its estimate of "
           "lengths on the surface), and the flipped triangles that it counts. The hemispheres are cut at the medial wall alone, without the further cuts into the cortex that flat maps often have.")
    yield table(["surface", "what is kept", "distance error, 2 edges", "7 edges", "flipped"],
                run.rows([(*one, energy) for one in CORTICES for energy in ("isometric", "distance")], lambda run, one: others_row(run, *one)))
    yield "## A cohort that is stopped"
    yield (f"{SUBJECTS} synthetic subjects: both hemispheres of fsaverage5, stretched and bent. The cohort is stopped by Ctrl-C in its {int(STOPPED * SUBJECTS) + 1}th subject, "
           "and the same command with `--resume` goes on; files appear whole or not at all. The last column is the cohort run once more, with nothing left to do.")
    yield table(["subjects", "files when stopped", "files in the end", "of the first made twice", "made again once more"], cohort(run))
    yield verdict(run.bad, "All checks hold.")


if __name__ == "__main__":
    main(content)
