#!/usr/bin/env python3
"""Open the STEP files of `ricci spline export` and `ricci surface` in OpenCASCADE and in arris: topology, validity, distance from the mesh.

usage: cad.py RICCI_BINARY [SPLINE MESH TOLERANCE]...
"""
import json
import math
import os
import subprocess
import sys
import tempfile
import time

import arris
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeVertex
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.BRepGProp import BRepGProp
from OCP.gp import gp_Pnt
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.STEPControl import STEPControl_Reader
from OCP.TopAbs import TopAbs_ShapeEnum as Kind
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

RICCI = sys.argv[1]
# Vertices of the mesh whose distance from the shape is measured: each takes up to a tenth of a second.
VERTICES = 40
# Faces up to which arris reads a file: it checks what it reads, 12 faces in a second and 336 in more than a minute.
FEW = 50
# Tolerance of an edge over the diagonal: sides have control points and parameters in common with the patches beside them.
EDGE_TOLERANCE = 1e-6
passed = failed = 0


def check(name, holds, detail=""):
    global passed, failed
    passed, failed = passed + bool(holds), failed + (not holds)
    if not holds:
        print(f"FAILED {name}: {detail}")


def parts(shape, kind):
    found, explorer = [], TopExp_Explorer(shape, kind)
    while explorer.More():
        found.append(explorer.Current())
        explorer.Next()
    return found


def vertices(path):
    return [[float(x) for x in line.split()[1:4]] for line in open(path) if line.startswith("v ")]


def edge_tolerance(shape):
    """The largest tolerance of an edge: how far the reader found it from the faces beside it."""
    as_edge = getattr(TopoDS, "Edge_s", None) or TopoDS.Edge
    return max(BRep_Tool.Tolerance_s(as_edge(edge)) for edge in parts(shape, Kind.TopAbs_EDGE))


def sampled(shape, point):
    """Distance from a point to 101 x 101 places of each of the eight faces whose middles are nearest: OpenCASCADE's own search may end
    at a place that is not the nearest one."""
    as_face = getattr(TopoDS, "Face_s", None) or TopoDS.Face  # Versions differ in the name.
    surfaces = [BRep_Tool.Surface_s(as_face(face)) for face in parts(shape, Kind.TopAbs_FACE)]

    def apart(surface, s, t):
        u0, u1, v0, v1 = surface.Bounds()
        return surface.Value(u0 + (u1 - u0) * s, v0 + (v1 - v0) * t).Distance(point)

    near = sorted(surfaces, key=lambda surface: apart(surface, 0.5, 0.5))[:8]
    return min(apart(surface, i / 100, j / 100) for surface in near for i in range(101) for j in range(101))


def opened(name, path, report, points, fit):
    """OpenCASCADE: one shell of as many faces, valid, closed where the patches close up, near the points."""
    reader = STEPControl_Reader()
    check(name + " read", reader.ReadFile(path) == IFSelect_ReturnStatus.IFSelect_RetDone)
    reader.TransferRoots()
    shape, result = reader.OneShape(), report["result"]
    count = {kind: len(parts(shape, kind)) for kind in (Kind.TopAbs_SOLID, Kind.TopAbs_SHELL, Kind.TopAbs_FACE)}
    expected = [int(result["closed"]), 1, result["bicubic_patches"]]
    check(name + " topology", list(count.values()) == expected, f"{count}, {expected}")
    check(name + " BRepCheck", BRepCheck_Analyzer(shape).IsValid())
    apart, limit = edge_tolerance(shape), EDGE_TOLERANCE * result["diagonal"]
    check(name + " edges", apart <= limit, f"{apart}, {limit}")
    shell = parts(shape, Kind.TopAbs_SHELL)[0]
    check(name + " closed", BRep_Tool.IsClosed_s(shell) == result["closed"])
    if result["closed"]:
        volume = GProp_GProps()
        BRepGProp.VolumeProperties_s(shape, volume)
        check(name + " volume", volume.Mass() > 0, volume.Mass())
    limit = (report["options"]["tolerance"] + fit) * result["diagonal"]
    worst = 0.0
    for point in points[:: 1 + len(points) // VERTICES]:
        apart = BRepExtrema_DistShapeShape(BRepBuilderAPI_MakeVertex(gp_Pnt(*point)).Vertex(), shape)
        far = apart.Value() if apart.IsDone() else float("inf")
        worst = max(worst, far if far <= limit else sampled(shape, gp_Pnt(*point)))
    check(name + " distance", worst <= limit, f"{worst}, {limit}")
    return worst / result["diagonal"]


def read_again(name, path, report):
    """arris: one body without refusal or repair, closed where the patches close up."""
    if report["result"]["bicubic_patches"] > FEW:
        return
    model = arris.Model()
    [body] = model.read_step(open(path).read(), heal=False).solids
    check(name + " second reader", body.ok, body.refusal)
    if body.ok:
        check(name + " second faces", len(model.faces(body.body)) == report["result"]["bicubic_patches"])
        kind = "solid" if report["result"]["closed"] else "sheet"
        check(name + " second kind", str(model.body_kind(body.body)).lower().endswith(kind), model.body_kind(body.body))


def export(name, spline, mesh, tolerance, fit):
    with tempfile.TemporaryDirectory() as out:
        path = lambda file: os.path.join(out, file)
        command = [RICCI, "spline", "export", spline, "--tolerance", str(tolerance), "--quiet"]
        again = subprocess.run([*command, "-o", path("part.step"), "--report", path("r.json")]).returncode
        subprocess.run([*command, "-o", path("again.step")])
        report = json.load(open(path("r.json")))
        told = report["checks"]
        check(name + " exit", again == (not all(c["holds"] for c in told.values())), f"{again} {told}")
        check(name + " watertight", told["open_sides"]["holds"] and told["distance"]["holds"], told)
        first, second = (open(path(f)).read().replace("again", "part") for f in ("part.step", "again.step"))
        check(name + " same bytes", first == second)
        start = time.time()
        far = opened(name, path("part.step"), report, vertices(mesh), fit)
        read_again(name, path("part.step"), report)
        turn = report["result"]["normal_jump_max"]
        print(f"{name}: {report['result']['bicubic_patches']} faces, vertices within {far:.2e}, normals turn {turn:.2f} degrees, {time.time() - start:.1f} s")


def fitted(name, shape, *options):
    """A spline near a generated mesh, exported."""
    with tempfile.TemporaryDirectory() as out:
        mesh, spline, report = (os.path.join(out, f) for f in ("mesh.obj", "spline.json", "fit.json"))
        subprocess.run([RICCI, "make", *shape, "-o", mesh, "--quiet"], check=True)
        command = [RICCI, "spline", "fit", mesh, *options, "-o", spline, "--report", report, "--quiet"]
        if subprocess.run(command, stderr=subprocess.PIPE).returncode not in (0, 1):
            print(f"{name}: this command fits no such surface; nothing was exported")
            return
        export(name, spline, mesh, 1e-3, json.load(open(report))["result"]["max"])


def enclosed(path):
    """The signed volume inside the triangles of an OBJ file."""
    corners = vertices(path)
    faces = [[int(c.split("/")[0]) - 1 for c in line.split()[1:]] for line in open(path) if line.startswith("f ")]
    volume = 0.0
    for a, b, c in ((corners[i] for i in face) for face in faces):
        volume += sum(a[k] * (b[k - 2] * c[k - 1] - b[k - 1] * c[k - 2]) for k in range(3)) / 6
    return volume


def large_patches(name, *shape):
    """A solid of large patches near a generated mesh: one shell of the faces said, valid, of nearly the volume of the mesh."""
    with tempfile.TemporaryDirectory() as out:
        mesh, step, report = (os.path.join(out, f) for f in ("mesh.obj", "part.step", "r.json"))
        subprocess.run([RICCI, "make", *shape, "-o", mesh, "--quiet"], check=True)
        command = [RICCI, "surface", mesh, "-o", step, "--report", report, "--quiet"]
        if subprocess.run(command, stderr=subprocess.PIPE).returncode not in (0, 1):
            print(f"{name}: this command makes no surface of large patches; nothing was read")
            return
        reader = STEPControl_Reader()
        check(name + " read", reader.ReadFile(step) == IFSelect_ReturnStatus.IFSelect_RetDone)
        reader.TransferRoots()
        solid, result = reader.OneShape(), json.load(open(report))["result"]
        count = [len(parts(solid, kind)) for kind in (Kind.TopAbs_SOLID, Kind.TopAbs_SHELL, Kind.TopAbs_FACE)]
        check(name + " topology", count == [1, 1, result["faces"]], f"{count}, {result['faces']}")
        check(name + " BRepCheck", BRepCheck_Analyzer(solid).IsValid())
        apart, limit = edge_tolerance(solid), EDGE_TOLERANCE * math.dist(*zip(*map(lambda x: (min(x), max(x)), zip(*vertices(mesh)))))
        check(name + " edges", apart <= limit, f"{apart}, {limit}")
        volume = GProp_GProps()
        BRepGProp.VolumeProperties_s(solid, volume)
        # A smooth surface through the vertices of a mesh bulges over its triangles.
        ratio = volume.Mass() / enclosed(mesh)
        check(name + " volume", 0.99 < ratio < 1.06, ratio)
        print(f"{name}: {result['faces']} faces, edges within {apart:.1e}, volume {ratio:.4f} of that of the mesh")


def square():
    """A square of a few faces, small enough for arris."""
    with tempfile.TemporaryDirectory() as out:
        mesh, spline = os.path.join(out, "square.obj"), os.path.join(out, "square.json")
        with open(mesh, "w") as file:
            for i in range(16):
                x, y = (i % 4) / 3, (i // 4) / 3
                file.write(f"v {x!r} {y!r} {0.1 * x * y!r}\n")
            for i in (1, 2, 3, 5, 6, 7, 9, 10, 11):
                file.write(f"f {i} {i + 1} {i + 5}\nf {i} {i + 5} {i + 4}\n")
        subprocess.run([RICCI, "spline", "fit", mesh, "--planar", "--edge", "1", "-o", spline, "--quiet"], check=True)
        export("square", spline, mesh, 1e-4, 1e-3)


square()
fitted("hill", ["disk", "--height", "0.3"], "--planar")
fitted("torus", ["torus"])
large_patches("torus of large patches", "torus")
large_patches("genus 2 of large patches", "genus")
large_patches("knot of large patches", "knot")
for spline, mesh, tolerance in zip(sys.argv[2::3], sys.argv[3::3], sys.argv[4::3]):
    export(os.path.basename(spline), spline, mesh, float(tolerance), 0.02)
print(f"{passed} passed, {failed} failed")
sys.exit(failed > 0)
