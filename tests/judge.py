#!/usr/bin/env python3
"""Hold files of `ricci` against a program from outside that recomputes what they claim: RICCI_CHECK (default ../shared/tools/check.py
beside the repository). Called by tests/outside; without that program it says so and passes.

usage: tests/judge.py RICCI MESHES
"""
import contextlib
import importlib.util
import io
import json
import os
import random
import subprocess
import sys
import tempfile

RICCI, MESHES = sys.argv[1], sys.argv[2]
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
JUDGE = os.environ.get("RICCI_CHECK", os.path.join(ROOT, "..", "shared", "tools", "check.py"))
passed = failed = 0


def check(name, good, what):
    global passed, failed
    passed, failed = passed + bool(good), failed + (not good)
    if not good:
        print(f"FAILED {name}: {what}")


def ricci(*arguments):
    done = subprocess.run([RICCI, *map(str, arguments)], capture_output=True, text=True)
    check(" ".join(map(str, arguments)), done.returncode == 0, f"exit {done.returncode}: {done.stderr.strip()}")


def judged(call, *paths):
    with contextlib.redirect_stdout(io.StringIO()):
        return getattr(judge, call)(*paths)


def forms(name, mesh, genus, path):
    ricci("forms", mesh, "--forms", path("f.json"), "--quiet")
    said = judged("forms", path("f.json"))
    good = said["rank"] == 2 * genus and said["closedness"] <= 1e-12 and said["coclosedness"] <= 1e-10
    check(name + " forms", good and said["least_weight"] >= -1e-12 and said["faces_of_positive_index"] == 0, said)


def atlas(name, mesh, kind, path, *options):
    ricci("structure", mesh, "--kind", kind, *options, "--atlas", path("a.json"), "--quiet")
    said = judged("atlas", path("a.json"))
    check(f"{name} {kind}", said["charts"] > 0 and said["worst_transition"] <= 1e-9 and said["worst_cocycle"] <= 1e-9, said)


def spline(name, mesh, degree, path):
    ricci("spline", "fit", mesh, "--planar", "--degree", degree, "-o", path("s.json"), "--quiet")
    generator = random.Random(1)
    patches = json.load(open(path("s.json")))["patches"]
    with open(path("q.csv"), "w") as out:
        out.write("patch,x,y\n")
        for _ in range(30):
            patch = generator.randrange(len(patches))
            weights = [generator.expovariate(1.0) for _ in range(3)]
            corners = [knots[0] for knots in patches[patch]["knots"]]
            x, y = (sum(w * c[k] for w, c in zip(weights, corners)) / sum(weights) for k in (0, 1))
            out.write(f"{patch},{x!r},{y!r}\n")
    ricci("spline", "eval", path("s.json"), "--at", path("q.csv"), "-o", path("v.csv"), "--quiet")
    said = judged("spline", path("s.json"), path("v.csv"))
    good = said["rows"] == 30 and said["worst_difference"] <= 1e-9 and said["partition_of_unity"] <= 1e-12
    check(f"{name} spline of degree {degree}", good, said)


if not os.path.exists(JUDGE):
    print(f"passed over: {JUDGE} is absent")
    sys.exit(0)
spec = importlib.util.spec_from_file_location("check", JUDGE)
judge = importlib.util.module_from_spec(spec)
spec.loader.exec_module(judge)
with tempfile.TemporaryDirectory() as folder:
    path = lambda file: os.path.join(folder, file)
    made = {"torus": 1, "genus": 2, "sphere": 0, "disk": 0}
    for shape in made:
        ricci("make", shape, "-o", path(shape + ".obj"))
    surfaces = [(shape, path(shape + ".obj"), genus) for shape, genus in made.items()]
    for name, genus in (("bob", 1), ("eight_766", 2), ("pretzel", 3)):
        mesh = os.path.join(MESHES, "good", name + ".obj")
        if os.path.exists(mesh):
            surfaces.append((name, mesh, genus))
        else:
            print(f"passed over: {mesh} is absent")
    for name, mesh, genus in surfaces:
        if genus > 0:
            forms(name, mesh, genus, path)
        if genus > 1:
            for kind in ("hyperbolic", "projective"):
                atlas(name, mesh, kind, path)
        atlas(name, mesh, "spherical" if name == "sphere" else "affine", path)
        atlas(name, mesh, "conformal", path)
    for degree in (1, 2, 3):
        spline("disk", path("disk.obj"), degree, path)
print(f"{passed} passed, {failed} failed by the program from outside")
sys.exit(failed > 0)
