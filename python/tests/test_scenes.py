"""Scenes of glTF with an atlas: five meshes and two materials, built here byte by byte, and read by another library."""

import json
import struct
from pathlib import Path

import numpy as np
import pytest

import ricci

KINDS = {np.dtype(np.float32): 5126, np.dtype(np.uint16): 5123, np.dtype(np.uint8): 5121}
SHAPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


class Built:
    """A document and its binary chunk."""

    def __init__(self) -> None:
        self.binary = b""
        self.document: dict = {
            "asset": {"version": "2.0", "generator": "a test"},
            "scene": 0,
            "scenes": [{"nodes": [0], "name": "all"}],
            "accessors": [],
            "bufferViews": [],
        }

    def add(self, values: np.ndarray, **more: object) -> int:
        values = np.ascontiguousarray(values)
        self.document["bufferViews"].append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": values.nbytes})
        self.binary += values.tobytes() + bytes(-values.nbytes % 4)
        entry = {"bufferView": len(self.document["bufferViews"]) - 1, "componentType": KINDS[values.dtype], "count": len(values)}
        entry["type"] = SHAPES[1 if values.ndim == 1 else values.shape[1]]
        self.document["accessors"].append({**entry, **more})
        return len(self.document["accessors"]) - 1

    def mesh(self, name: str, mesh: ricci.Mesh, material: int, **attributes: np.ndarray) -> dict:
        points = mesh.V.astype(np.float32)
        bounds = {"min": points.min(0).tolist(), "max": points.max(0).tolist()}
        named = {"POSITION": self.add(points, **bounds), **{key: self.add(values) for key, values in attributes.items()}}
        return {
            "name": name,
            "primitives": [{"attributes": named, "indices": self.add(mesh.F.astype(np.uint16).ravel()), "material": material}],
        }

    def write(self, path: Path) -> None:
        text = json.dumps({**self.document, "buffers": [{"byteLength": len(self.binary)}]}).encode()
        text += b" " * (-len(text) % 4)
        parts = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(self.binary), b"BIN\0") + self.binary
        path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(parts)) + parts)


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Five meshes with names and two materials below nodes that scale and turn them; one mesh is shown twice."""
    built = Built()
    ball, torus = ricci.make("sphere", n=4), ricci.make("torus", n=8, m=6)
    tube, disk = ricci.make("annulus", n=8), ricci.make("disk", n=4)
    normals = {"NORMAL": ball.V.astype(np.float32)}
    colors = {"COLOR_0": np.arange(4 * disk.n_vertices, dtype=np.uint8).reshape(-1, 4)}
    built.document["meshes"] = [
        built.mesh("ball", ball, 0, **normals),
        built.mesh("ring", torus, 1),
        built.mesh("tube", tube, 1),
        built.mesh("disk", disk, 0, **colors),
        built.mesh("second ball", ball, 1, **normals),
    ]
    built.document["materials"] = [
        {"name": "red", "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}},
        {"name": "blue", "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 1, 1]}},
    ]
    built.document["nodes"] = [
        {"name": "root", "children": [1, 2, 3], "scale": [2, 2, 2], "extras": {"tag": 0.1}},
        {"name": "a", "mesh": 0, "translation": [5, 0, 0]},
        {"name": "b", "mesh": 1, "rotation": [0, 0.6, 0, 0.8], "children": [4, 5, 6]},
        {"name": "c", "mesh": 2, "translation": [0, 7, 0]},
        {"name": "d", "mesh": 3, "scale": [0.5, 0.5, 0.5], "translation": [-6, 0, 1]},
        {"name": "e", "mesh": 4, "translation": [0, 0, 9]},
        {"name": "a again", "mesh": 0, "scale": [0.25, 0.25, 0.25], "translation": [0, -9, 0]},
    ]
    made = tmp_path_factory.mktemp("scene") / "scene.glb"
    built.write(made)
    return made


@pytest.fixture(scope="module")
def written(path: Path) -> tuple[Path, ricci.TextureAtlas, ricci.figures.SceneReport]:
    scene = ricci.SceneFile.read(path)
    s = scene.summary
    assert (s.n_nodes, s.n_meshes, s.n_primitives, s.n_materials) == (7, 5, 5, 2)
    atlas = ricci.texture_atlas(scene, page=128, fill=0)
    assert atlas.summary.n_faces == s.n_faces
    out = path.with_name("out.glb")
    return out, atlas, scene.write(out, atlas)


def document(path: Path) -> dict:
    data = path.read_bytes()
    return json.loads(data[20 : 20 + struct.unpack("<I", data[12:16])[0]])


def test_the_document_is_kept(path: Path, written: tuple) -> None:
    before, after = document(path), document(written[0])
    for member in ("asset", "scene", "scenes", "nodes", "materials"):
        assert before[member] == after[member]
    assert [mesh["name"] for mesh in after["meshes"]] == ["ball", "ring", "tube", "disk", "second ball"]
    report = written[2]
    assert (report.texcoord, report.n_primitives, report.n_shared_meshes, report.n_notes) == (0, 5, 1, 0)
    assert report.n_split_vertices > report.n_vertices == ricci.SceneFile.read(path).summary.n_vertices


def test_another_library_reads_the_same_scene(path: Path, written: tuple) -> None:
    trimesh = pytest.importorskip("trimesh")
    before, after = (trimesh.load(file, process=False) for file in (path, written[0]))
    assert set(before.geometry) == set(after.geometry)
    assert len(after.geometry) == 5
    assert {after.geometry[name].visual.material.name for name in after.geometry} == {"red", "blue"}
    assert set(before.graph.nodes_geometry) == set(after.graph.nodes_geometry)
    for node in before.graph.nodes_geometry:
        (was, name), (now, same) = before.graph[node], after.graph[node]
        assert name == same
        assert np.array_equal(was, now)
    every = []
    for name, shown in after.geometry.items():
        given = before.geometry[name]
        assert np.array_equal(given.triangles, shown.triangles)
        every.append(shown.visual.uv[shown.faces])
    uv = np.concatenate(every)
    atlas = written[1]
    assert np.allclose(np.sort(uv.ravel()), np.sort(atlas.uv.ravel()), atol=1e-7)
    assert ((uv >= 0) & (uv <= 1)).all()
    assert atlas.overlapping.size == atlas.folded.size == atlas.placeless.size == 0


def test_tangents_and_sets_are_asked_for(path: Path, written: tuple, tmp_path: Path) -> None:
    scene, atlas = ricci.SceneFile.read(path), written[1]
    report = scene.write(tmp_path / "t.glb", atlas, texcoord=1, tangents=True)
    assert (report.texcoord, report.n_tangents, report.n_without_tangents) == (1, 2, 3)
    meshes = document(tmp_path / "t.glb")["meshes"]
    names = [sorted(mesh["primitives"][0]["attributes"]) for mesh in meshes]
    assert names[0] == ["NORMAL", "POSITION", "TANGENT", "TEXCOORD_0", "TEXCOORD_1"]
    assert names[3] == ["COLOR_0", "POSITION", "TEXCOORD_0", "TEXCOORD_1"]


def test_a_model_without_normals_gets_tangents(tmp_path: Path) -> None:
    atlas = ricci.texture_atlas(ricci.make("disk", n=4), page=64)
    atlas.write(tmp_path / "t.glb", tangents=True)
    found = document(tmp_path / "t.glb")
    attributes = found["meshes"][0]["primitives"][0]["attributes"]
    assert sorted(attributes) == ["NORMAL", "POSITION", "TANGENT", "TEXCOORD_0"]
    assert found["accessors"][attributes["TANGENT"]]["type"] == "VEC4"


def test_what_does_not_fit_is_refused(path: Path, written: tuple, tmp_path: Path) -> None:
    scene = ricci.SceneFile.read(path)
    with pytest.raises(ricci.ArgumentError, match="texcoord"):
        scene.write(tmp_path / "x.glb", written[1], texcoord=8)
    other = ricci.texture_atlas(ricci.make("disk", n=3), page=64)
    with pytest.raises(ricci.ArgumentError, match="other faces"):
        scene.write(tmp_path / "x.glb", other)
    with pytest.raises(ricci.ArgumentTypeError, match="TextureAtlas"):
        scene.write(tmp_path / "x.glb", scene)
    assert not (tmp_path / "x.glb").exists()
    ricci.make("disk", n=3).write(tmp_path / "d.obj")
    with pytest.raises(ricci.RicciError, match="glb"):
        ricci.SceneFile.read(tmp_path / "d.obj")
