"""Pages in which a surface turns: their data, what they take, how they are drawn in a browser and shown by a notebook."""

import base64
import html
import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import ricci
from conftest import ROOT


@pytest.fixture(scope="module")
def laid(genus2):
    return ricci.layout(ricci.flow(genus2, target="auto:6"))


def data_of(page):
    """The data of a page's view, decoded."""
    return parts_of(page.html)[0]


def parts_of(text):
    """The data of the view in the text of a page, decoded, and what is before and behind it."""
    before, data, behind = re.fullmatch(r'(.*<script type="application/json" id="views">)(.*?)(</script>.*)', text, re.DOTALL).groups()
    return json.loads(data)["view"], before, behind


def command():
    """The command of the release build."""
    given = os.environ.get("RICCI") or Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release" / "ricci"
    if not Path(given).exists():
        pytest.skip("the command is absent: RICCI names it")
    return given


def numbers(text, kind="<u2"):
    return np.frombuffer(base64.b64decode(text), kind).astype(int)


def points(packed):
    return np.array(packed["from"]) + packed["step"] * numbers(packed["data"]).reshape(-1, 3)


def test_a_page_has_both_sides_of_a_layout(laid):
    height = laid.mesh.V[:, 2].copy()
    height[3] = np.nan
    view = data_of(ricci.show(laid, {"height": height}))
    corners = numbers(view["corners"]).reshape(-1, 3)
    assert np.array_equal(corners, laid.corners("refinement"))
    for packed, wanted in ((view["surface"], laid.mesh.V[laid.mesh.F]), (view["image"], laid.points()[corners])):
        found = points(packed)[corners]
        assert np.abs(found[..., : wanted.shape[-1]] - wanted).max() <= 0.5 * packed["step"] + 1e-12
    assert view["flat"]
    assert [quantity["name"] for quantity in view["quantities"]] == [
        "height",
        "logarithm of the change of area",
        "quasi-conformal dilatation",
    ]
    quantity = view["quantities"][0]
    shares = numbers(quantity["data"])
    origins = np.empty(len(shares), int)
    origins[corners] = laid.mesh.F
    assert (shares[origins == 3] == 65535).all()
    inside = (origins != 3) & (height[origins] > quantity["low"]) & (height[origins] < quantity["high"])
    step = (quantity["high"] - quantity["low"]) / 65534
    assert np.abs(quantity["low"] + step * shares[inside] - height[origins][inside]).max() <= 0.5 * step + 1e-12
    assert inside.mean() > 0.95


@pytest.mark.parametrize("kind", ["mesh", "metric", "charts", "repaired input", "sphere", "torus", "matching", "circles", "spline"])
def test_objects_with_a_surface_are_shown(kind, laid, genus2, disk, pants):
    thing, two = {
        "mesh": lambda: (genus2, None),
        "metric": lambda: (ricci.flow(genus2), None),
        "charts": lambda: (ricci.charts(laid), True),
        "repaired input": lambda: (laid.repaired_input(), True),
        "sphere": lambda: (ricci.uniformize(ricci.make("ellipsoid", n=5)), False),
        "torus": lambda: (ricci.uniformize(ricci.make("torus", n=16)), True),
        "matching": lambda: (ricci.match(disk, ricci.Mesh(2 * disk.V, disk.F), boundary="arc_length"), False),
        "circles": lambda: (ricci.circles(pants), True),
        "spline": lambda: (ricci.spline(ricci.make("torus", n=20), rounds=1), None),
    }[kind]()
    view = data_of(ricci.show(thing))
    assert (view["image"] is None) == (two is None)
    assert view["flat"] == bool(two)
    corners = numbers(view["corners"])
    assert corners.size == 3 * view["faces"]
    assert corners.max() + 1 == view["vertices"] == len(points(view["surface"]))


def test_the_command_makes_the_same_page_of_the_same_layout(laid, tmp_path):
    """But for the number of each vertex, the direction that is up, which it chooses by the shape, and rounding of the distortion."""
    height = laid.mesh.V[:, 2]
    laid.write(tmp_path / "flat.obj", on="refinement")
    (tmp_path / "height.csv").write_text("vertex,height\n" + "".join(f"{v},{z!r}\n" for v, z in enumerate(height.tolist())))
    words = ["view", "flat.obj", "--values", "height.csv", "--title", "Layout", "-o", "page.html", "--quiet"]
    subprocess.run([command(), *words], cwd=tmp_path, check=True)
    ours, *ours_around = parts_of(ricci.show(laid, {"height": height}).html)
    theirs, *theirs_around = parts_of((tmp_path / "page.html").read_text())
    assert ours_around == theirs_around
    assert ours.keys() == theirs.keys()
    for name in ("vertices", "faces", "wide", "flat", "cut"):
        assert ours[name] == theirs[name], name
    corners, their_corners = (numbers(view["corners"]) for view in (ours, theirs))
    for side in ("surface", "image"):
        for name in ("from", "step"):
            assert ours[side][name] == theirs[side][name], (side, name)
        found, wanted = (numbers(view[side]["data"]).reshape(-1, 3) for view in (theirs, ours))
        assert np.array_equal(found[their_corners], wanted[corners]), side
    for found, wanted in zip(theirs["quantities"], ours["quantities"], strict=True):
        assert found["name"] == wanted["name"]
        assert [found["low"], found["high"]] == pytest.approx([wanted["low"], wanted["high"]], rel=1e-6, abs=1e-9)
        assert np.abs(numbers(found["data"])[their_corners] - numbers(wanted["data"])[corners]).max() <= 1


def test_large_surfaces_have_wide_numbers():
    mesh = ricci.make("torus", n=420, m=200)
    view = data_of(ricci.show(mesh))
    assert view["wide"]
    assert np.array_equal(numbers(view["corners"], "<u4").reshape(-1, 3), mesh.F)


def test_what_cannot_be_shown_is_refused(laid, genus2):
    with pytest.raises(ricci.ArgumentError, match="no surface in space"):
        ricci.show(ricci.deck(ricci.uniformize(genus2)))
    with pytest.raises(ricci.ArgumentError, match="no surface in space"):
        ricci.show(ricci.make("bolza", n=1))
    with pytest.raises(ricci.ArgumentError, match="height has shape"):
        ricci.show(laid, {"height": [1.0]})
    with pytest.raises(ricci.ArgumentTypeError, match="as_mesh makes a mesh of it"):
        ricci.show(genus2.V)
    with pytest.raises(ricci.ArgumentTypeError, match="values are texts"):
        ricci.show(genus2, np.full(genus2.n_vertices, "a"))


def test_names_are_no_code(genus2):
    name = "</script><script>alert(1)</script>{program}"
    page = ricci.show(genus2, {name: genus2.V[:, 2]}).html
    assert page.count("<script") == 2
    assert "alert(1)</script>" not in page
    assert not re.search(r"https?://(?!www\.w3)[^ )]*\.(js|css)", page)


def browser():
    return os.environ.get("CHROMIUM") or shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


def look_at(path, profile):
    if browser() is None or shutil.which("node") is None:
        pytest.skip("Chromium or Node.js is absent")
    done = subprocess.run(["node", ROOT / "tests" / "gallery.mjs", browser(), path, profile], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert "1 views" in done.stdout


def test_a_page_turns_in_a_browser(laid, tmp_path):
    ricci.show(laid, {"height": laid.mesh.V[:, 2]}, path=tmp_path / "page.html")
    look_at(tmp_path / "page.html", tmp_path / "profile")


def test_a_notebook_shows_pages_and_pictures(tmp_path):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    lines = ["import ricci\nlaid = ricci.layout(ricci.flow(ricci.make('disk', n=8)))", "ricci.show(laid)", "laid"]
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(line) for line in lines])
    nbclient.NotebookClient(book, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}).execute()
    shown, picture = (book.cells[k].outputs[0]["data"] for k in (1, 2))
    assert shown["text/plain"].startswith("<ricci.Page: Layout")
    assert 'src="data:image/png;base64,' in picture["text/html"]
    frame = re.fullmatch(r'<iframe srcdoc="([^"]*)" [^>]*></iframe>', shown["text/html"]).group(1)
    (tmp_path / "frame.html").write_text(html.unescape(frame), encoding="utf-8")
    look_at(tmp_path / "frame.html", tmp_path / "profile")
