"""Texture atlases: coordinates on the model's own faces, polygons, split vertices, files, refusals."""

from pathlib import Path

import numpy as np
import pytest

import ricci

CUBE = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
CORNERS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)


@pytest.fixture(scope="module")
def cube() -> ricci.Soup:
    """A cube of six polygons, a wing on one of its edges, and a face with two corners in one place."""
    return ricci.Soup.of_polygons([*CORNERS, [0.5, 0.5, 0.5]], [*CUBE, [0, 1, 8], [0, 0, 2]])


@pytest.fixture(scope="module")
def atlas(cube: ricci.Soup) -> ricci.TextureAtlas:
    return ricci.texture_atlas(cube, page=64, fill=0)


def doubled_areas(corners: np.ndarray) -> np.ndarray:
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    return (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]


def test_every_face_has_its_place(cube: ricci.Soup, atlas: ricci.TextureAtlas) -> None:
    s = atlas.summary
    assert (s.n_faces, s.n_sheets, s.n_opened_edges, s.n_charts, s.page) == (14, 2, 1, 2, 64)
    assert atlas.charts.tolist() == [0] * 12 + [1, -1]
    assert atlas.placeless.tolist() == [13]
    assert atlas.folded.size == atlas.overlapping.size == atlas.turned.size == 0
    areas = doubled_areas(atlas.uv)
    assert (areas[:13] > 0).all()
    # The triangles of the cube are as large as each other, and the wing has its area beside them.
    assert np.allclose(areas[:12], areas[0], rtol=1e-3)
    assert areas[12] / areas[0] == pytest.approx(np.sqrt(0.5), rel=1e-2)
    assert s.fill == pytest.approx(areas.sum() / 2, rel=1e-3)
    assert ((atlas.uv >= 0) & (atlas.uv < 1)).all()
    assert (np.ldexp(atlas.uv, 24) % 1 == 0).all()


def test_split_vertices_have_one_place(cube: ricci.Soup, atlas: ricci.TextureAtlas) -> None:
    split = atlas.split()
    assert split.faces.tolist() == list(range(13))
    assert np.array_equal(split.vertices[split.F], cube.F[split.faces])
    assert np.array_equal(split.uv[split.F], atlas.uv[split.faces])
    assert len(np.unique(np.column_stack([split.vertices, split.uv]), axis=0)) == len(split.uv) == 14 + 3


def test_polygons_lead_back(cube: ricci.Soup) -> None:
    assert cube.polygons.tolist() == [0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 7]
    assert ricci.Soup.of_polygons(CORNERS, np.array(CUBE)).F.tolist() == cube.F[:12].tolist()
    with pytest.raises(ricci.ArgumentError, match="polygons"):
        _ = ricci.Soup(CORNERS, cube.F[:12]).polygons
    with pytest.raises(ricci.ArgumentError, match="polygon 1"):
        ricci.Soup.of_polygons(CORNERS, [[0, 1, 2], [0.5, 1, 2]])


def test_files_have_the_coordinates(cube: ricci.Soup, atlas: ricci.TextureAtlas, tmp_path: Path) -> None:
    atlas.write(tmp_path / "a.obj")
    read = ricci.Soup.read(tmp_path / "a.obj")
    assert np.array_equal(read.V, cube.V)
    assert np.array_equal(read.F, cube.F)
    assert np.array_equal(read.uv, atlas.uv)
    again = ricci.texture_atlas(tmp_path / "a.obj", page=64, fill=0, threads=1)
    assert np.array_equal(again.uv, atlas.uv)
    trimesh = pytest.importorskip("trimesh")
    atlas.write(tmp_path / "a.glb")
    (shown,) = trimesh.load(tmp_path / "a.glb", process=False).geometry.values()
    assert shown.faces.shape == (14, 3)
    uv = shown.visual.uv[shown.faces[:13]]
    assert np.allclose(uv, atlas.uv[:13], atol=1e-7)


def test_models_of_every_kind(cube: ricci.Soup) -> None:
    torus = ricci.make("torus", n=12)
    one = ricci.texture_atlas(torus, page=64, fill=0)
    assert np.array_equal(ricci.texture_atlas(torus.V, torus.F, page=64, fill=0).uv, one.uv)
    assert np.array_equal(ricci.texture_atlas((torus.V, torus.F), page=64, fill=0).uv, one.uv)
    assert one.summary.stretch_99 <= 1.02 * 1.3
    tight = ricci.texture_atlas(torus, page=64, fill=0, stretch=1.1).summary
    assert tight.stretch_99 <= 1.02 * 1.1
    assert tight.seam_length > one.summary.seam_length


def test_a_density_takes_the_pages_that_it_needs(cube: ricci.Soup) -> None:
    model = ricci.Soup(CORNERS, cube.F[:12])
    atlas = ricci.texture_atlas(model, page=32, density=20)
    assert atlas.summary.n_pages > 1
    assert set(atlas.pages) == set(range(atlas.summary.n_pages))
    assert np.array_equal(np.floor(atlas.uv[:, :, 0]), np.repeat(atlas.pages[:, None], 3, axis=1))
    # Each square has 20 texels along a side.
    assert np.allclose(doubled_areas(atlas.uv), (20 / 32) ** 2, rtol=1e-3)
    assert atlas.summary.texel_density == pytest.approx(20, rel=1e-3)
    assert atlas.overlapping.size == 0
    with pytest.raises(ricci.LayoutError, match="larger than a page"):
        ricci.texture_atlas(model, page=16, density=20)


def test_what_cannot_be_is_refused(cube: ricci.Soup) -> None:
    for options, words in (({"page": 100}, "page"), ({"stretch": 1}, "stretch"), ({"fill": 2}, "fill"), ({"margin": 200}, "margin")):
        with pytest.raises(ricci.ArgumentError, match=words):
            ricci.texture_atlas(cube, **options)
    with pytest.raises(ricci.LayoutError, match="no face"):
        ricci.texture_atlas(CORNERS, [[0, 0, 1]])
    with pytest.raises(ricci.Cancelled):
        ricci.texture_atlas(cube, progress=stopped())


def stopped() -> ricci.Control:
    control = ricci.Control()
    control.cancel()
    return control
