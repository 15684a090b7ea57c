"""The frame of the scripts of this folder: the corpus, the runs of the command, the program that judges its files from outside, and the page.

A script is its selection of meshes, its commands and its columns: a function `content(run)` that returns the blocks of the page, which `main` calls.
The command line is [CORPUS [NAME…]]. RICCI names the command, by default that of the release build, RICCI_CHECK the outside
program (by default ../shared/tools/check.py beside the repository), RICCI_ROWS a file that keeps finished rows, one per line, so that an interrupted script goes on from there.
"""
import contextlib
import csv
import importlib.util
import io
import json
import math
import os
import subprocess
import sys
import tempfile

root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
named = sys.argv[2:]
ricci = os.environ.get("RICCI") or os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(root, "target")), "release", "ricci")
build = "a development build" if "debug" in ricci.split(os.sep) else "a release build"
judge = os.environ.get("RICCI_CHECK", os.path.join(root, "..", "shared", "tools", "check.py"))


def corpus_of(kind):
    """The folder of meshes that the command line names, or one of those beside the repository."""
    return sys.argv[1] if len(sys.argv) > 1 else os.path.join(root, "..", "shared", "meshes", kind)


corpus = corpus_of("good")
# The meshes of the corpus that are made of flat and round faces.
CAD = {"anchor_519", "bamboo_pen", "block_2132", "boot", "casting", "chair_10k", "couplingdown", "fandisk", "fixed_top", "helmet", "joint_221",
       "maze", "pinion", "pinion_10k", "plate_holes", "thingi_1146164", "tray_bottom", "trim_star", "turbine", "universal_joint"}


def index(folder):
    """The rows of a folder's table of meshes."""
    return list(csv.DictReader(open(os.path.join(folder, "INDEX.csv"))))


def meshes(keep=lambda mesh: True, key=lambda mesh: (int(mesh["genus"]), int(mesh["V"]))):
    """The connected meshes of the corpus that `keep` wants, of those that are named, in order."""
    rows = index(corpus)
    return sorted((m for m in rows if int(m["components"]) == 1 and (not named or m["name"] in named) and keep(m)), key=key)


def genus(mesh):
    return int(mesh["genus"])


def loops(mesh):
    return int(mesh["boundary_loops"])


def euler(mesh):
    return 2 - 2 * genus(mesh) - loops(mesh)


def file_of(mesh):
    return os.path.join(corpus, mesh["file"])


def outside():
    """The outside program as a module, or why there is none."""
    try:
        spec = importlib.util.spec_from_file_location("check", judge)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module, None
    except (ImportError, OSError) as why:
        return None, f"{judge}: {why}"


CHECK, WHY = outside()


def judged(call, *paths):
    """What the outside program says of a file; None where there is no such program."""
    if CHECK is None:
        return None
    with contextlib.redirect_stdout(io.StringIO()):
        return getattr(CHECK, call)(*paths)


def judged_within(seconds, call, *paths):
    """The same in a process of its own; None where that takes longer."""
    if CHECK is None:
        return None
    try:
        said = subprocess.run([sys.executable, judge, call, *paths], capture_output=True, text=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        return None
    return json.loads(said.stdout)


def launch(folder, *arguments, seconds=None):
    """Exit code, report and stderr of a command; without a report None in its place, and without an exit code one that was stopped."""
    report = os.path.join(folder, "report.json")
    if os.path.exists(report):
        os.remove(report)
    try:
        done = subprocess.run([ricci, *arguments, "--quiet", "--report", report], capture_output=True, text=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        return None, None, f"stopped after {seconds} s"
    return done.returncode, json.load(open(report)) if os.path.exists(report) else None, done.stderr.strip()


def failures(name, report):
    """The checks of a report that do not hold, as lines."""
    return [f"{name}: {check}" for check, c in report["checks"].items() if not c["holds"]]


class Run:
    """One run of a script: a folder for its files, and the lines that say what does not hold."""

    def __init__(self, folder):
        self.folder, self.bad = folder, []
        self.kept, self.known = os.environ.get("RICCI_ROWS"), {}
        if self.kept and os.path.exists(self.kept):
            self.known = {json.dumps(key): kept for key, *kept in map(json.loads, open(self.kept))}

    def path(self, name):
        return os.path.join(self.folder, name)

    def fresh(self, *names):
        """The paths of files that a command is to write; there are none of these names yet."""
        paths = [self.path(name) for name in names]
        for path in filter(os.path.exists, paths):
            os.remove(path)
        return paths

    def make(self, name, *arguments):
        """The file of a surface that `ricci make` makes."""
        path = self.path(name)
        subprocess.run([ricci, "make", *arguments, "-o", path, "--quiet"], check=True, capture_output=True)
        return path

    def try_report(self, *arguments, seconds=None):
        """The report of a command and its exit code, or None and why the command refuses."""
        code, report, said = launch(self.folder, *arguments, seconds=seconds)
        if report is not None and "error" in report["result"]:
            return None, report["result"]["error"]["message"]
        return (report, code) if report is not None else (None, said)

    def report(self, name, *arguments, seconds=None):
        """The report of a command; a refusal, for which it is None, and checks that fail are told under this name."""
        report, why = self.try_report(*arguments, seconds=seconds)
        self.bad += [f"{name}: {why}"] if report is None else failures(name, report)
        return report

    def needed(self, name, *arguments):
        """The report of a command without which the script ends."""
        report, why = self.try_report(*arguments)
        if report is None:
            raise SystemExit(f"{name}: {why}")
        return report

    def insist(self, holds, line):
        self.bad += [] if holds else [line]

    def rows(self, chosen, row):
        """The cells of each, `row(self, one)`; those that have none are left out."""
        return [cells for cells in (row(self, one) for one in chosen) if cells]

    def refined(self, name, surfaces, errors, *command):
        """A row for each of ever finer meshes of a surface, (path, what is known of it): its errors, each with the factor by which it has fallen."""
        rows, before = [], None
        for path, known in surfaces:
            report = self.needed(name, *command, path)
            now = errors(report["result"], known)
            rows.append([name, report["input"]["vertices"], *fallen(now, before)])
            before = now
        return rows

    def keep(self, key, make):
        """What `make()` returns, or what the file of RICCI_ROWS has kept of it under this key, with the lines that say what did not hold."""
        text = json.dumps(key)
        if text in self.known:
            row, *bad = self.known[text]
            self.bad += bad[0] if bad else []
            return row
        before = len(self.bad)
        self.known[text] = [make(), self.bad[before:]]
        if self.kept:
            with open(self.kept, "a") as file:
                file.write(json.dumps([key, *self.known[text]]) + "\n")
        return self.known[text][0]


def main(content):
    """Print the page whose blocks `content(run)` returns; empty ones are left out."""
    with tempfile.TemporaryDirectory() as folder:
        blocks = list(content(Run(folder)))
    print("\n\n".join(block.strip("\n") for block in blocks if block))


def read_obj(path):
    """The positions and the faces of an OBJ file."""
    places, faces = [], []
    for word in (line.split() for line in open(path)):
        if word and word[0] == "v":
            places.append([float(x) for x in word[1:4]])
        elif word and word[0] == "f":
            faces.append([int(corner.split("/")[0]) - 1 for corner in word[1:]])
    return places, faces


def write_obj(path, places, faces):
    with open(path, "w") as file:
        file.writelines("v {!r} {!r} {!r}\n".format(*p) for p in places)
        file.writelines("f {} {} {}\n".format(*(v + 1 for v in f)) for f in faces)
    return path


def write_rows(path, head, rows):
    """A CSV file."""
    with open(path, "w") as file:
        file.write(head + "\n" + "".join(",".join(x if isinstance(x, str) else repr(x) for x in row) + "\n" for row in rows))
    return path


def sides(faces):
    """The directed sides of faces."""
    return {(a, b) for f in faces for a, b in zip(f, f[1:] + f[:1])}


def rim(faces):
    """The vertices of boundary edges."""
    known = sides(faces)
    return {v for a, b in known if (b, a) not in known for v in (a, b)}


def divided(path, out, times=1):
    """Write the surface of an OBJ file with every triangle cut into four at the midpoints of its sides, so often."""
    places, faces = read_obj(path)
    for _ in range(times):
        middle, finer = {}, []

        def between(a, b):
            key = (min(a, b), max(a, b))
            if key not in middle:
                middle[key] = len(places)
                places.append([0.5 * (x + y) for x, y in zip(places[a], places[b])])
            return middle[key]

        for a, b, c in faces:
            ab, bc, ca = between(a, b), between(b, c), between(c, a)
            finer += [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        faces = finer
    return write_obj(out, places, faces)


def small(x):
    return "–" if x is None else "0" if x == 0 else f"{x:.1e}" if abs(x) < 1e-2 or abs(x) >= 1e4 else f"{x:.3g}"


def plain(x, form):
    """A number in a format; a dash for none."""
    return "–" if x is None else format(x, form)


def complex_text(z, digits):
    return f"{z[0]:.{digits}f} + {z[1]:.{digits}f} i"


def seconds(report):
    return f"{report['seconds']['total']:.2f}"


def fallen(errors, before, least=1e-12):
    """Errors, each with the factor by which it has fallen; those of rounding as 0."""
    factor = lambda e, b: "" if e < least or b is None or b < least else f" (÷{b / e:.2f})"
    return [("0" if e < least else small(e)) + factor(e, b) for e, b in zip(errors, before or [None] * len(errors))]


def rate(errors):
    """log₂ of the quotient of the last two errors; empty for the first."""
    return "" if len(errors) < 2 else f"{math.log2(errors[-2] / errors[-1]):.2f}"


def table(head, rows):
    lines = ["| " + " | ".join(map(str, head)) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def verdict(bad, good="All checks of every report hold."):
    return good if not bad else "What does not hold:\n\n" + "\n".join(f"- {line}" for line in bad)


def verdict_of_outside(about):
    """The sentence on the outside program: `about` it, or why there is none."""
    return about if WHY is None else f"No independent program has judged the files: {WHY}."
