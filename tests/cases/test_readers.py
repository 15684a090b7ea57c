"""Readers: what a file says is read, or the file is named for what it is, from a name and from stdin alike."""

import gzip
import json
import struct

import pytest

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.2\nv 0.5 0.5 {z}\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n"


def counts(run):
    """The numbers of vertices and faces that a report has."""
    return run.report["input"]["vertices"], run.report["input"]["faces"]


def defects(run):
    return [(d["code"], d["vertices"]) for d in run.report["result"]["defects"]]


@pytest.mark.row("x_nanind.obj")
@pytest.mark.row("y.off")
@pytest.mark.parametrize("name", ["x_nanind.obj", "y.off"])
def test_a_number_that_is_not_finite_is_named_with_its_vertex(ricci, case, name):
    for run in [ricci("info", case(name)), ricci("info", "-", stdin=case(name).read_bytes())]:
        assert ("non_finite_coordinate", [4]) in defects(run), run.text
        assert not run.report["result"]["admissible"]
    assert ricci("flow", case(name)).code == 3


@pytest.mark.parametrize("word", ["nan", "-nan(ind)", "1.#QNAN", "-1.#IND", "#QNAN", "1.#INF", "-1.#INF00", "inf"])
def test_every_spelling_is_found_in_every_text_format(ricci, tmp_path, word):
    obj = SQUARE.format(z=word)
    points = [line[2:] for line in obj.splitlines() if line.startswith("v ")]
    faces = [[int(v) - 1 for v in line[2:].split()] for line in obj.splitlines() if line.startswith("f ")]
    rows = "".join("3 {} {} {}\n".format(*face) for face in faces)
    head = "".join(f"property double {c}\n" for c in "xyz")
    facets = ["\n".join(["facet normal 0 0 1", "outer loop", *(f"vertex {points[v]}" for v in face), "endloop", "endfacet"]) for face in faces]
    texts = {
        "m.obj": obj,
        "m.off": "OFF\n5 4 0\n" + "\n".join(points) + "\n" + rows,
        "m.ply": f"ply\nformat ascii 1.0\nelement vertex 5\n{head}element face 4\n"
        "property list uchar int vertex_indices\nend_header\n" + "\n".join(points) + "\n" + rows,
        "m.stl": "solid a\n" + "\n".join(facets) + "\nendsolid a\n",
    }
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
        codes = [code for code, _ in defects(ricci("info", name))]
        assert "non_finite_coordinate" in codes, (name, word)


def test_comments_begin_at_words(ricci, tmp_path):
    (tmp_path / "m.obj").write_text("# head\n" + SQUARE.format(z="0.3 # tip") + "#end\n")
    run = ricci("info", "m.obj")
    assert run.code == 0 and counts(run) == (5, 4) and run.report["result"]["admissible"]


@pytest.mark.row("n_nnan.ply")
def test_normals_that_are_not_finite_are_left_out_and_that_is_said(ricci, case):
    run = ricci("info", case("n_nnan.ply"))
    assert run.code == 0 and counts(run) == (3, 1) and run.report["result"]["admissible"]
    assert any(what.startswith("normals: 1 of 3") for what in run.report["result"]["left_out"])
    assert "left out normals" in run.out
    run = ricci("repair", case("n_nnan.ply"), "-o", "r.ply")
    assert run.code == 0 and any("normals" in what for what in run.report["result"]["left_out"])


@pytest.mark.row("end_solid.stl")
@pytest.mark.row("upper.stl")
@pytest.mark.row("x_bom.stl")
@pytest.mark.row("x_noheader.off")
@pytest.mark.parametrize(
    "name, expected", [("end_solid.stl", None), ("upper.stl", None), ("x_bom.stl", (5, 4)), ("x_noheader.off", (5, 4))]
)
def test_stdin_is_read_as_the_file_is(ricci, case, name, expected):
    by_name = ricci("info", case(name))
    by_stdin = ricci("info", "-", stdin=case(name).read_bytes())
    assert by_name.code == by_stdin.code == 0, by_name.text + by_stdin.text
    assert by_name.report["result"] == by_stdin.report["result"]
    assert counts(by_name) == counts(by_stdin) and counts(by_name)[1] > 0
    assert expected is None or counts(by_name) == expected
    assert by_name.report["result"]["admissible"]


def test_the_two_words_of_end_make_one(ricci, case, tmp_path):
    """`end solid`, `end facet` and `end loop`, wherever a line ends."""
    text = case("end_solid.stl").read_text().replace("endfacet", "end facet").replace("endloop", "END\nLOOP")
    (tmp_path / "two.stl").write_text(text)
    assert counts(ricci("info", "two.stl")) == counts(ricci("info", case("end_solid.stl")))


def test_trailing_bytes_and_headers_in_small_letters_come_through_stdin(ricci, tmp_path):
    facet = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
    stl = b"exported".ljust(80, b"\0") + struct.pack("<I", 1) + facet
    for more in [b"", b"\0\0", b"trailing bytes"]:
        assert counts(ricci("info", "-", stdin=stl + more)) == (3, 1), more
    off = b"off\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
    assert counts(ricci("info", "-", stdin=off)) == (3, 1)


@pytest.mark.row("x_utf16.obj")
def test_another_encoding_is_named(ricci, case):
    for run in [ricci("info", case("x_utf16.obj")), ricci("info", "-", stdin=case("x_utf16.obj").read_bytes())]:
        assert run.code == 3 and "UTF-16" in run.err and "UTF-8" in run.err


@pytest.mark.parametrize(
    "name, data, says",
    [
        ("page.obj", b"<!DOCTYPE html>\n<html><body>404</body></html>\n", "HTML page"),
        ("page.stl", b"<html>", "HTML page"),
        ("lfs.ply", b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n", "git lfs pull"),
        ("zip.obj", b"PK\x03\x04....", "ZIP archive"),
        ("old.gltf", b'{"asset": {"version": "1.0"}, "accessors": {"a": {}}, "meshes": {"m": {}}}', "glTF 1.0"),
        ("old.glb", b"glTF" + struct.pack("<II", 1, 20) + b"\0" * 8, "version 1 of GLB"),
        ("twice.obj.gz", gzip.compress(gzip.compress(b"v 0 0 0\n")), "packed this file twice"),
        ("cut.obj.gz", gzip.compress(b"v 0 0 0\n" * 99)[:-9], "gzip data are damaged"),
    ],
)
def test_files_that_are_no_mesh_are_named(ricci, tmp_path, name, data, says):
    (tmp_path / name).write_bytes(data)
    for run in [ricci("info", name), ricci("info", "-", stdin=data)]:
        assert run.code == 3 and says in run.err, run.text


def test_every_format_is_read_packed(ricci, case, tmp_path):
    (tmp_path / "m.obj").write_text(SQUARE.format(z=0.3))
    for end in ["off", "ply", "glb"]:
        assert ricci("repair", "m.obj", "-o", f"m.{end}").code == 0
    (tmp_path / "m.stl").write_bytes(case("x_bom.stl").read_bytes())
    assert ricci("flow", "m.obj", "--metric", "m.json").code == 0
    for end in ["obj", "off", "ply", "glb", "stl", "json"]:
        plain = counts(ricci("info", f"m.{end}"))
        packed = gzip.compress((tmp_path / f"m.{end}").read_bytes())
        for name in [f"p.{end}.gz", f"p.{end}"]:
            (tmp_path / name).write_bytes(packed)
            assert counts(ricci("info", name)) == plain, name
        assert counts(ricci("info", "-", stdin=packed)) == plain, end
        assert end == "json" or plain == (5, 4)


def test_gltf_is_read_with_the_file_beside_it(ricci, tmp_path):
    data = struct.pack("<9f3H", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 2)
    (tmp_path / "scene").mkdir()
    (tmp_path / "scene/a b.bin").write_bytes(data)
    document = {
        "asset": {"version": "2.0"},
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 6},
        ],
        "buffers": [{"byteLength": 42, "uri": "a%20b.bin"}],
    }
    (tmp_path / "scene/m.gltf").write_text(json.dumps(document))
    run = ricci("info", "scene/m.gltf")
    assert run.code == 0 and counts(run) == (3, 1), run.text
    run = ricci("info", "-", stdin=json.dumps(document).encode())
    assert run.code == 3 and "give that by name" in run.err
    for uri, says in [("../m.bin", "not in the folder"), ("none.bin", "none.bin")]:
        document["buffers"][0]["uri"] = uri
        (tmp_path / "scene/n.gltf").write_text(json.dumps(document))
        run = ricci("info", "scene/n.gltf")
        assert run.code == 3 and says in run.err, run.err


@pytest.mark.row("c_semi.csv")
@pytest.mark.row("c_tab.csv")
@pytest.mark.parametrize("name, curvature", [("c_semi.csv", 1.5707963), ("c_tab.csv", 1.57)])
def test_the_separator_of_a_table_is_found(ricci, case, tmp_path, name, curvature):
    assert ricci("make", "disk", "-o", "m.obj", "-n", "20").code == 0
    run = ricci("flow", "m.obj", "--target", f"cones:{case(name)}", "--pin", "boundary")
    assert run.code == 0, run.text
    [(vertex, found)] = run.report["result"]["cones"]
    assert vertex == 700 and found == pytest.approx(curvature)


@pytest.mark.row("groups full.obj")
@pytest.mark.parametrize("more", [["--on", "input"], []])
def test_materials_and_groups_go_with_the_faces(ricci, case, tmp_path, more):
    source = case("groups full.obj")
    run = ricci("flow", source, "--uv", "u.obj", *more)
    given, written = named_faces(source), named_faces(tmp_path / "u.obj")
    assert written[0] == given[0] == ["my materials ü.mtl"]
    assert set(written[1]) == set(given[1])
    if more:
        assert written[1] == given[1]
    assert not any("material" in what and "only OBJ" in what for what in run.report["result"]["left_out"])
    run = ricci("flow", source, "--uv", "u.glb", *more)
    assert any("2 groups, 1 object name" in what for what in run.report["result"]["left_out"]), run.report
    assert "left out 2 groups" in run.out
    materials = gltf_materials((tmp_path / "u.glb").read_bytes())
    assert sorted(set(materials)) == sorted({face[2] for face in given[1]})
    for end, kept in [("obj", True), ("ply", False), ("glb", True), ("off", False)]:
        run = ricci("repair", source, "-o", f"r.{end}")
        assert any("2 materials" in what and "only OBJ" in what for what in run.report["result"]["left_out"]) != kept
    assert named_faces(tmp_path / "r.obj") == given


def gltf_materials(binary):
    """The names of the materials of the primitives of a GLB file."""
    length = struct.unpack("<I", binary[12:16])[0]
    document = json.loads(binary[20 : 20 + length])
    return [document["materials"][p["material"]].get("name", "") for p in document["meshes"][0]["primitives"]]


def test_parts_of_faces_keep_their_names(ricci, case, tmp_path):
    source = case("groups full.obj")
    assert ricci("refine", source, "-o", "f.obj", "--levels", "1").code == 0
    given, written = named_faces(source), named_faces(tmp_path / "f.obj")
    assert written[0] == given[0] and sorted(map(str, written[1])) == sorted(4 * list(map(str, given[1])))


def named_faces(path):
    """The material libraries of an OBJ file, and the object, group and material of each of its faces."""
    libraries, names, faces = [], {}, []
    for line in path.read_text(encoding="utf-8").splitlines():
        word, _, rest = line.partition(" ")
        if word == "mtllib":
            libraries.append(rest)
        elif word in ("o", "g", "usemtl"):
            names[word] = rest
        elif word == "f":
            faces.append((names.get("o"), names.get("g"), names.get("usemtl")))
    return libraries, faces


def test_numbers_of_a_ply_go_through_repair(ricci, tmp_path):
    points = ["0 0 0 0.5 7", "1 0 0 nan 8", "1 1 0 1e-3 9", "0 1 0 2 10"]
    head = "ply\nformat ascii 1.0\nelement vertex 4\n" + "".join(f"property double {c}\n" for c in "xyz")
    head += "property float quality\nproperty int label\nelement face 2\nproperty list uchar int vertex_indices\n"
    head += "property uchar flags\nelement edge 1\nproperty int a\nproperty int b\nend_header\n"
    (tmp_path / "m.ply").write_text(head + "\n".join(points) + "\n3 2 3 0 200\n3 0 1 2 100\n0 1\n")
    run = ricci("repair", "m.ply", "-o", "r.ply")
    assert run.report["result"]["left_out"] == ["element `edge` of 1 rows"]
    data = (tmp_path / "r.ply").read_bytes()
    text, _, body = data.partition(b"end_header\n")
    assert b"property float quality\nproperty int label\n" in text and b"property uchar flags\n" in text
    rows = [struct.unpack_from("<3dfi", body, 32 * v) for v in range(4)]
    assert [row[4] for row in rows] == [7, 8, 9, 10]
    assert rows[0][3] == 0.5 and rows[1][3] != rows[1][3]
    faces = [struct.unpack_from("<B3IB", body, 128 + 14 * f) for f in range(2)]
    assert faces == [(3, 2, 3, 0, 200), (3, 0, 1, 2, 100)]
    run = ricci("refine", "m.ply", "-o", "f.ply", "--levels", "1")
    assert run.code == 0 and run.report["result"]["left_out"] == ["element `edge` of 1 rows"], run.text
    body = (tmp_path / "f.ply").read_bytes().partition(b"end_header\n")[2]
    rows = [struct.unpack_from("<3dfi", body, 32 * v) for v in range(9)]
    assert [row[4] for row in rows[:4]] == [7, 8, 9, 10] and {row[4] for row in rows[4:]} <= {7, 8, 9, 10}
    assert any(row[3] == pytest.approx(1.25) for row in rows[4:])
    assert [body[32 * 9 + 14 * f + 13] for f in range(8)].count(200) == 4
    run = ricci("flow", "m.ply", "--uv", "u.obj")
    said = run.report["result"]["left_out"]
    assert "numbers of vertices `quality`, `label`: only PLY and VTK have them" in said and "numbers of faces `flags`: only PLY and VTK have them" in said


@pytest.mark.parametrize("command", [["flow"], ["uniformize", "--boundary", "straight"], ["harmonic", "--to", "disk"]])
def test_every_layout_keeps_the_names_of_its_faces(ricci, tmp_path, command):
    (tmp_path / "m.obj").write_text("mtllib m.mtl\no Sheet\n" + SQUARE.format(z=0.3).replace("f 3 4 5", "usemtl Red #2\nf 3 4 5") + "l 1 2\n")
    run = ricci(command[0], "m.obj", *command[1:], "--uv", "u.obj")
    assert run.code == 0, run.text
    libraries, faces = named_faces(tmp_path / "u.obj")
    assert libraries == ["m.mtl"] and set(faces) == {("Sheet", None, None), ("Sheet", None, "Red #2")}
    assert "polylines: 1 (`l`), for they are no faces" in run.report["result"]["left_out"]
    assert "left out polylines" in run.out
