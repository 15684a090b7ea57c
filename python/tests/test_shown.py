"""What consoles and notebooks show: figures of every kind of object, pictures that are of the object, and plots."""

import base64
import re
import struct
import zlib
from html.parser import HTMLParser

import numpy as np
import pytest

import ricci
from ricci._call import _KINDS
from ricci._pictures import Scene, drawn, png


@pytest.fixture(scope="module")
def objects(genus2, disk, pants, tmp_path_factory):
    """One object of every kind, by the name of its class."""
    flat = ricci.flow(genus2)
    laid = ricci.layout(flat)
    curved = ricci.uniformize(genus2)
    ball = ricci.make("ellipsoid", n=8)
    turning = ricci.seamless(ball)
    spline = ricci.spline(ricci.make("torus", n=24), rounds=1)
    quads = ricci.quad_layout(turning)
    found = [
        genus2,
        flat,
        laid,
        curved,
        turning,
        spline,
        quads,
        quads.quads,
        ricci.Solver(flat),
        laid.repaired_input(),
        ricci.charts(laid),
        ricci.deck(curved),
        ricci.dirichlet(curved),
        curved.homotopy,
        curved.domain,
        ricci.circles(pants),
        ricci.forms(genus2),
        ricci.Map(flat),
        ricci.match(disk, ricci.Mesh(disk.V * [1.2, 1, 1], disk.F), boundary="arc_length"),
        ricci.structure(genus2, kind="affine"),
        ricci.Soup(disk.V, disk.F),
        ricci.bicubic(spline, tolerance=0.01),
        ricci.quad_spline(turning),
        ricci.texture_atlas(disk, page=64),
        scene_of(disk, tmp_path_factory.mktemp("scene") / "disk.glb"),
    ]
    return {type(value).__name__: value for value in found}


def scene_of(mesh, path):
    mesh.write(path)
    return ricci.SceneFile.read(path)


# These have no geometry of their own to be drawn, or it is not handed out.
WITHOUT = {"Bicubic", "Deck", "Domain", "Homotopy", "SceneFile", "Solver"}
KINDS = sorted({kind.__name__ for kind in _KINDS.values() if not kind.__name__.startswith("_")})


class Reader(HTMLParser):
    """The cells and the picture of a page."""

    def __init__(self):
        super().__init__()
        self.cells, self.image, self.open = [], None, []

    def handle_starttag(self, tag, attributes):
        if tag == "img":
            self.image = dict(attributes)["src"]
        else:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, text):
        if self.open[-1] == "td":
            self.cells.append(text)


def pixels_of(data):
    """The pixels of a PNG file that has no filters, read without the package."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, parts = 8, {}
    while at < len(data):
        n = struct.unpack(">I", data[at : at + 4])[0]
        kind, content = data[at + 4 : at + 8], data[at + 8 : at + 8 + n]
        assert struct.unpack(">I", data[at + 8 + n : at + 12 + n])[0] == zlib.crc32(kind + content)
        parts[kind] = content
        at += 12 + n
    width, height, depth, colour = struct.unpack(">IIBB", parts[b"IHDR"][:10])
    assert (depth, colour) == (8, 6)
    lines = np.frombuffer(zlib.decompress(parts[b"IDAT"]), np.uint8).reshape(height, 1 + 4 * width)
    assert not lines[:, 0].any()
    return lines[:, 1:].reshape(height, width, 4)


def test_there_is_an_object_of_every_kind(objects):
    assert sorted(objects) == KINDS


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_is_shown_with_its_figures(objects, kind):
    value = objects[kind]
    assert repr(value).startswith(f"<ricci.{kind}")
    reader = Reader()
    reader.feed(value._repr_html_())
    assert reader.open == []
    told = dict(zip(reader.cells[::2], reader.cells[1::2], strict=True))
    if kind != "Solver":
        assert 4 <= len(told) <= 6
    for name, text in told.items():
        number = getattr(value.summary, name)
        if isinstance(number, float) and not isinstance(number, bool):
            assert float(text) == pytest.approx(number, rel=1e-3, nan_ok=True)
        elif isinstance(number, int) and not isinstance(number, bool):
            assert text == str(number)
        else:
            assert text
    assert (reader.image is None) == (kind in WITHOUT)
    if reader.image is not None:
        pixels = pixels_of(base64.b64decode(reader.image.partition("base64,")[2]))
        assert 0.05 < (pixels[:, :, 3] > 0).mean() < 0.95


def test_intrinsic_surfaces_have_figures_alone():
    surface = ricci.make("bolza", n=1)
    assert "<img" not in surface._repr_html_()
    with pytest.raises(ricci.ArgumentError, match="nothing to be seen"):
        surface.plot()


def test_a_sphere_is_drawn_round():
    sphere = ricci.make("sphere", n=24)
    cover = drawn(Scene(sphere.V, sphere.F), 200, 200)[:, :, 3] / 255
    assert cover.sum() == pytest.approx(np.pi * (0.94 * 100) ** 2, rel=0.01)
    rows, columns = np.nonzero(cover > 0.5)
    assert (np.hypot(rows - 99.5, columns - 99.5) < 95).all()
    assert pixels_of(png(drawn(Scene(sphere.V, sphere.F)))).shape == (180, 240, 4)


def test_the_nearer_face_is_seen():
    """Two squares in parallel planes: from where they are seen the smaller one hides the middle of the larger one."""
    square = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
    points = np.concatenate([np.column_stack([3 * square, np.zeros(4)]), np.column_stack([square, np.full(4, 0.5)])])
    faces = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])
    front = drawn(Scene(points, faces, np.array([0.0, 0, 1, 1])), 100, 100)
    behind = drawn(Scene(points * [1, 1, -1], faces, np.array([0.0, 0, 1, 1])), 100, 100)
    # Yellow is where the larger value is.
    yellow = [(picture[:, :, 0] > picture[:, :, 2]) & (picture[:, :, 3] > 0) for picture in (front, behind)]
    assert sorted(int(seen.sum()) > 100 for seen in yellow) == [False, True]


def test_colours_follow_values(disk):
    picture = drawn(Scene(disk.V[:, :2], disk.F, disk.V[:, 0]), 100, 100).astype(float)
    seen = picture[:, :, 3] == 255
    brightness = picture[:, :, :3].sum(2)
    left, right = (brightness[:, half][seen[:, half]].mean() for half in (slice(0, 40), slice(60, 100)))
    assert right > left + 100


def test_points_that_are_not_finite_are_left_out(disk):
    points = disk.V[:, :2].copy()
    points[0] = np.nan
    assert 0 < drawn(Scene(points, disk.F))[:, :, 3].sum() < drawn(Scene(disk.V[:, :2], disk.F))[:, :, 3].sum()
    assert drawn(Scene(np.full((3, 2), np.nan), np.array([[0, 1, 2]]))).sum() == 0


def test_plots_by_matplotlib(objects):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot

    for kind in KINDS:
        if kind not in WITHOUT:
            ax = objects[kind].plot(backend="matplotlib")
            ax.figure.canvas.draw()
            pyplot.close(ax.figure)
    laid = objects["Layout"]
    own = pyplot.figure().add_subplot()
    assert laid.plot(np.arange(laid.summary.n_faces), ax=own) is own
    low, high = own.dataLim.min, own.dataLim.max
    np.testing.assert_allclose([low, high], [laid.points().min(0), laid.points().max(0)])
    assert own.collections[0].get_array().size == laid.summary.n_faces
    with pytest.raises(ricci.ArgumentError, match="values have shape"):
        laid.plot([1.0, 2.0])
    with pytest.raises(ricci.ArgumentError, match="none of matplotlib, pyvista"):
        laid.plot(backend="gnuplot")
    pyplot.close("all")


def test_plots_by_pyvista(genus2):
    pytest.importorskip("pyvista")
    plotter = genus2.plot(genus2.V[:, 2])
    assert plotter.mesh.n_points == genus2.n_vertices
    assert np.array_equal(plotter.mesh.active_scalars, genus2.V[:, 2])
    assert ricci.layout(ricci.flow(genus2)).plot(backend="pyvista").mesh.bounds[4:] == (0, 0)


def test_a_report_has_its_figures_at_first_hand(genus2):
    report = ricci.flow(genus2).report
    for name, value in vars(report.summary).items():
        assert getattr(report, name) == value
    assert {"iterations", "flips", "max_curvature_error", "seconds_total"} <= set(dir(report))
    assert report.converged is True
    assert len(report.residuals) == report.n_residuals
    assert re.match("<ricci.Report: converged after", repr(report))
