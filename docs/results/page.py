"""What the scripts of this folder share: the corpus, the command, the program that judges its files from outside, and tables.

Their command line is [CORPUS [NAME…]]. RICCI_CHECK names the outside program (by default ../shared/tools/check.py beside the repository).
"""
import contextlib
import csv
import importlib.util
import io
import json
import os
import subprocess
import sys

root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
corpus = sys.argv[1] if len(sys.argv) > 1 else os.path.join(root, "..", "shared", "meshes", "good")
named = sys.argv[2:]
ricci = os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(root, "target")), "release", "ricci")
judge = os.environ.get("RICCI_CHECK", os.path.join(root, "..", "shared", "tools", "check.py"))


def meshes(keep, key=lambda m: (int(m["genus"]), int(m["V"]))):
    """The connected meshes of the corpus that `keep` wants, of those that are named, in order."""
    rows = csv.DictReader(open(os.path.join(corpus, "INDEX.csv")))
    return sorted((m for m in rows if int(m["components"]) == 1 and (not named or m["name"] in named) and keep(m)), key=key)


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


def run(folder, *arguments, seconds=None):
    """The report of a command and its exit code, or None and what it says; it is stopped after so many seconds."""
    report = os.path.join(folder, "report.json")
    if os.path.exists(report):
        os.remove(report)
    try:
        done = subprocess.run([ricci, *arguments, "--quiet", "--report", report], capture_output=True, text=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        return None, f"stopped after {seconds} s"
    return (json.load(open(report)), done.returncode) if os.path.exists(report) else (None, done.stderr.strip())


def make(folder, name, *arguments):
    """The file of a surface that `ricci make` makes."""
    path = os.path.join(folder, name)
    subprocess.run([ricci, "make", *arguments, "-o", path, "--quiet"], check=True, capture_output=True)
    return path


def failures(name, report):
    """The checks of a report that do not hold, as lines."""
    return [f"{name}: {check}" for check, c in report["checks"].items() if not c["holds"]]


def small(x):
    return "–" if x is None else "0" if x == 0 else f"{x:.1e}" if abs(x) < 1e-2 or abs(x) >= 1e4 else f"{x:.3g}"


def fallen(errors, before, least=1e-12):
    """Errors, each with the factor by which it has fallen; those of rounding as 0."""
    factor = lambda e, b: "" if e < least or b is None or b < least else f" (÷{b / e:.2f})"
    return [("0" if e < least else small(e)) + factor(e, b) for e, b in zip(errors, before or [None] * len(errors))]


def table(head, rows):
    lines = ["| " + " | ".join(map(str, head)) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def verdict(bad, good="All checks of every report hold."):
    return good if not bad else "What does not hold:\n\n" + "\n".join(f"- {line}" for line in bad)
