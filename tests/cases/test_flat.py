"""Layouts as geometry: flat meshes and drawings for cutting, read back without anything of the project."""

import math
import xml.etree.ElementTree

import pytest

# Digits that the layout of a developable surface keeps.
EXACT = 1e-9


def read_dxf(path):
    """The polylines of a DXF file: rows of layer, whether it is closed, points."""
    text = path.read_text().splitlines()
    pairs = [(int(code), value) for code, value in zip(text[::2], text[1::2], strict=True)]
    lines, entity = [], ""
    for code, value in pairs:
        if code == 0:
            entity = value
            if value == "POLYLINE":
                lines.append([None, False, []])
            elif value == "VERTEX":
                lines[-1][2].append([None, None])
        elif entity == "POLYLINE" and code == 8:
            lines[-1][0] = value
        elif entity == "POLYLINE" and code == 70:
            lines[-1][1] = value == "1"
        elif entity == "VERTEX" and code in (10, 20):
            lines[-1][2][-1][code // 20] = float(value)
    return lines


def length(points, closed):
    """The length of a polyline."""
    return sum(math.dist(p, q) for p, q in zip(points, points[1:] + points[: 1 if closed else 0], strict=False))


@pytest.mark.row("gc43.json")
def test_a_metric_of_lengths_alone_is_written_as_a_flat_mesh(ricci, case, read_obj, tmp_path):
    done = ricci("flow", case("gc43.json"), "--pin", "boundary", "--flat", "f.obj")
    assert done.code == 0, done.text
    flat = read_obj(tmp_path / "f.obj")
    assert len(flat.v) == 4
    assert len(flat.f) == 2
    assert all(v[2] == 0 for v in flat.v)
    for face in flat.f:
        sides = sorted(math.dist(flat.v[face[k]], flat.v[face[k - 1]]) for k in range(3))
        assert sides == pytest.approx([1, 1, math.sqrt(2)], abs=EXACT)


@pytest.mark.row("gc43.json")
def test_without_positions_the_message_of_uv_names_flat(ricci, case):
    done = ricci("flow", case("gc43.json"), "--uv", "f.obj", report=False)
    assert done.code == 2
    assert "--flat" in done.err


@pytest.mark.row("gc43.json")
def test_drawings_of_the_square_are_one_closed_line(ricci, case, tmp_path):
    done = ricci("flow", case("gc43.json"), "--pin", "boundary", "--flat", "f.dxf")
    assert done.code == 0, done.text
    [[layer, closed, points]] = read_dxf(tmp_path / "f.dxf")
    assert (layer, closed, len(points)) == ("BOUNDARY", True, 4)
    assert length(points, closed) == pytest.approx(4, abs=EXACT)
    assert ricci("flow", case("gc43.json"), "--pin", "boundary", "--flat", "f.svg").code == 0
    svg = xml.etree.ElementTree.parse(tmp_path / "f.svg").getroot()
    space = "{http://www.w3.org/2000/svg}"
    paths = [(g.get("id"), p.get("d")) for g in svg.iter(f"{space}g") for p in g.iter(f"{space}path")]
    assert [layer for layer, _ in paths] == ["BOUNDARY"]
    assert paths[0][1].endswith("Z")
    width = svg.get("width")
    assert width.endswith("mm")
    assert float(width[:-2]) == float(svg.get("viewBox").split()[2])


def test_flat_meshes_keep_the_names_of_faces(ricci, tmp_path):
    points = [(x, y, 0) for y in range(3) for x in range(3)]
    lines = [f"v {x} {y} {z}" for x, y, z in points] + ["mtllib cloth.mtl"]
    for name, row in (("silk", 0), ("wool", 1)):
        lines += [f"usemtl {name}"]
        for a in (3 * row + 1, 3 * row + 2):
            lines += [f"f {a} {a + 1} {a + 4}", f"f {a} {a + 4} {a + 3}"]
    (tmp_path / "cloth.obj").write_text("\n".join(lines) + "\n")
    done = ricci("flow", "cloth.obj", "--flat", "flat.obj")
    assert done.code == 0, done.text
    names = [line.split()[1] for line in (tmp_path / "flat.obj").read_text().splitlines() if line.startswith("usemtl")]
    assert names == ["silk", "wool"]
    assert ricci("flow", "cloth.obj", "--flat", "flat.ply").code == 0
