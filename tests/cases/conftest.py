"""Jobs on which people failed (`../shared/cases`): each row of INDEX.csv is run, and what is right there is asserted.

A test says with `@pytest.mark.row("x_bom.stl")` to which row it belongs; test_index.py asks that every row has one.
RICCI is the command (default: the release build); RICCI_MESHES/../cases holds the files. Both absent: every test is skipped, and says so.
"""

import csv
import json
import os
import pathlib
import subprocess
from dataclasses import dataclass, field

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MESHES = pathlib.Path(os.environ.get("RICCI_MESHES") or ROOT / "../shared/meshes")
CASES = MESHES.parent / "cases"
RICCI = os.environ.get("RICCI") or str(
    pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release/ricci"
)


def rows():
    """The rows of INDEX.csv, empty where the cases are absent."""
    index = CASES / "INDEX.csv"
    return list(csv.DictReader(index.open())) if index.is_file() else []


@dataclass
class Run:
    """One call of the command: its exit code, what it printed, and its report."""

    code: int
    out: str
    err: str
    report: dict = field(default_factory=dict)

    @property
    def text(self):
        return self.out + self.err


@pytest.fixture
def ricci(tmp_path):
    """A function that runs the command in a folder of the test's own: `ricci("info", case("y.off"))`."""

    def run(*words, stdin=None, report=True, timeout=120):
        where = tmp_path / "report.json"
        where.unlink(missing_ok=True)
        words = [str(word) for word in words]
        if report:
            words += ["--report", str(where)]
        done = subprocess.run(
            [RICCI, *words], input=stdin, capture_output=True, timeout=timeout, cwd=tmp_path
        )
        said = json.loads(where.read_text()) if where.is_file() else {}
        return Run(done.returncode, done.stdout.decode(), done.stderr.decode(), said)

    return run


@pytest.fixture
def case():
    """A function that gives the path of a file of the cases."""
    if not rows():
        pytest.skip(f"{CASES} is absent: set RICCI_MESHES to the corpus beside it")

    def find(name):
        path = CASES / name
        assert path.is_file(), f"{path} is absent"
        return path

    return find


@dataclass
class Obj:
    """What an OBJ file says, without anything of the project: positions, texture coordinates, faces as indices into both."""

    v: list
    vt: list
    f: list
    ft: list

    def turned(self):
        """The faces whose texture coordinates do not run counterclockwise."""
        return [k for k, corners in enumerate(self.ft) if area([self.vt[c] for c in corners]) <= 0]


def area(p):
    """Twice the signed area of a triangle in the plane."""
    (ax, ay), (bx, by), (cx, cy) = p
    return (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)


@pytest.fixture
def read_obj():
    """A function that reads an OBJ file of triangles."""

    def read(path):
        obj = Obj([], [], [], [])
        for line in open(path, encoding="utf-8"):
            word, *rest = line.split() or [""]
            if word == "v":
                obj.v.append([float(x) for x in rest[:3]])
            elif word == "vt":
                obj.vt.append([float(x) for x in rest[:2]])
            elif word == "f":
                corners = [corner.split("/") for corner in rest]
                obj.f.append([int(c[0]) - 1 for c in corners])
                if all(len(c) > 1 and c[1] for c in corners):
                    obj.ft.append([int(c[1]) - 1 for c in corners])
        return obj

    return read


def pytest_configure(config):
    config.addinivalue_line("markers", "row(file): the row of ../shared/cases/INDEX.csv that the test asserts")
