#!/usr/bin/env python3
"""Harmonic maps of every disk of the corpus to the disk, to polygons and to its rectangle, and of every sphere to the sphere, as tables.

usage: docs/results/maps.py [CORPUS [NAME…]] > docs/results/maps.md     (after: cargo build --release -p ricci-apps)

RICCI_CHECK names the program that judges the files from outside (by default ../shared/tools/check.py beside the repository).
"""
import math
import os
import tempfile

from page import WHY, failures, fallen, file_of, judged, make, meshes, named, run, small, table, verdict

# Corners of the polygons.
CORNERS = [3, 5, 12]
# How far a linear function may be off, over the size of the image.
LINEAR = 1e-12


def texture(path):
    """The faces of an OBJ file, and its texture coordinates by vertex."""
    places, faces, at = [], [], {}
    for word in (line.split() for line in open(path)):
        if word and word[0] == "vt":
            places.append([float(x) for x in word[1:3]])
        elif word and word[0] == "f":
            corners = [[int(x) - 1 for x in corner.split("/")[:2]] for corner in word[1:4]]
            faces.append([v for v, _ in corners])
            at.update((v, places[t]) for v, t in corners)
    return faces, at


def linear(folder, uv):
    """The image of a disk as a plane surface of its own: the largest error of two linear functions that are given along its boundary."""
    faces, at = texture(uv)
    plane, values, out = (os.path.join(folder, name) for name in ("plane.obj", "values.csv", "linear.obj"))
    with open(plane, "w") as file:
        file.writelines("v {!r} {!r} 0\n".format(*at[v]) for v in range(len(at)))
        file.writelines("f {} {} {}\n".format(*(v + 1 for v in f)) for f in faces)
    value = lambda p: (2 * p[0] - p[1] + 0.5, 0.3 * p[1] - p[0])
    sides = {(a, b) for f in faces for a, b in zip(f, f[1:] + f[:1])}
    rim = sorted({v for a, b in sides if (b, a) not in sides for v in (a, b)})
    with open(values, "w") as file:
        file.write("vertex,x,y\n")
        file.writelines("{},{!r},{!r}\n".format(v, *value(at[v])) for v in rim)
    report, why = run(folder, "harmonic", plane, "--to", f"file:{values}", "--uv", out)
    if report is None:
        return None, why
    found = texture(out)[1]
    return max(math.dist(value(at[v]), found[v]) for v in at), None


def disks(folder):
    rows, bad = [], []
    for mesh in meshes(lambda m: int(m["genus"]) == 0 and int(m["boundary_loops"]) == 1):
        path, uv = file_of(mesh), os.path.join(folder, "uv.obj")
        report, why = run(folder, "harmonic", path, "--to", "disk", "--uv", uv)
        if report is None:
            bad.append(f"{mesh['name']}: {why}")
            continue
        bad += failures(mesh["name"], report)
        r, seen = report["result"], judged("uv", uv, path)
        if seen and (seen["flipped"] or not seen["first_vertices_kept"]):
            bad.append(f"{mesh['name']}, outside: {seen}")
        off, why = linear(folder, uv)
        if off is None or off > LINEAR:
            bad.append(f"{mesh['name']}, linear functions: {why or off}")
        polygons = []
        for n in CORNERS:
            polygon, why = run(folder, "harmonic", path, "--to", f"polygon:{n}")
            if polygon is None:
                bad.append(f"{mesh['name']}, {n} corners: {why}")
            else:
                bad += failures(f"{mesh['name']}, {n} corners", polygon)
            polygons.append("–" if polygon is None else f"{polygon['result']['flipped_triangles']} ({polygon['result']['added_vertices']})")
        rectangle, why = run(folder, "harmonic", path, "--to", "rectangle")
        if rectangle is None:
            bad.append(f"{mesh['name']}, rectangle: {why}")
        rows.append([
            mesh["name"], mesh["V"], str(r["flips"]), str(r["added_vertices"]), f"{r['energy']:.4f}", small(r["mean_value_residual"]),
            str(r["flipped_triangles"]), str(r["degenerate_pieces"]), "–" if seen is None else f"{seen['flipped']}, {seen['degenerate']}",
            small(off), ", ".join(polygons), "–" if rectangle is None else str(rectangle["result"]["flipped_triangles"]),
            f"{report['seconds']['total']:.2f}",
        ])
    head = ["mesh", "V", "flips", "added", "energy", "off the means", "flipped", "without area", "outside: flipped, without area", "linear off",
            f"flipped (added): {', '.join(map(str, CORNERS))} corners", "flipped: rectangle", "s"]
    return table(head, rows), bad


def spheres(folder):
    rows, bad = [], []
    for mesh in meshes(lambda m: int(m["genus"]) == 0 and int(m["boundary_loops"]) == 0):
        report, why = run(folder, "harmonic", file_of(mesh), "--to", "sphere")
        if report is None:
            bad.append(f"{mesh['name']}: {why}")
            continue
        r, name = report["result"], mesh["name"]
        bad += failures(name, report)
        energies = r["energies"]
        rising = sum(b > a for a, b in zip(energies, energies[1:]))
        rows.append([name, mesh["V"], str(r["flips"]), str(r["iterations"]), f"{energies[0]:.4f}", f"{energies[-1]:.6f}", str(rising),
                     str(r["flipped_triangles"]), f"{report['seconds']['total']:.2f}"])
    return table(["mesh", "V", "flips", "steps", "energy before", "energy after", "steps that raise it", "flipped", "s"], rows), bad


def round_spheres(folder):
    """Largest relative change of an edge by the map of a round sphere to itself: centred Möbius transformations of it are rotations."""
    rows, before = [], None
    for n in (4, 8, 16, 32, 64):
        path, out = make(folder, "ball.obj", "sphere", "-n", str(n)), os.path.join(folder, "out.obj")
        report, why = run(folder, "harmonic", path, "--sphere", out)
        if report is None:
            raise SystemExit(f"sphere {n}: {why}")
        read = lambda name, kind: [line.split()[1:4] for line in open(name) if line.startswith(kind)]
        given, found = ([[float(x) for x in p] for p in read(name, "v ")] for name in (path, out))
        faces = [[int(x.split("/")[0]) - 1 for x in f] for f in read(path, "f ")]
        sides = {(min(a, b), max(a, b)) for f in faces for a, b in zip(f, f[1:] + f[:1])}
        now = [max(abs(math.dist(found[a], found[b]) / math.dist(given[a], given[b]) - 1) for a, b in sides)]
        rows.append([str(n), str(len(given)), *fallen(now, before)])
        before = now
    return table(["frequency", "V", "edges off by"], rows)


def main():
    with tempfile.TemporaryDirectory() as folder:
        flat, bad = disks(folder)
        ball, more = spheres(folder)
        known = None if named else round_spheres(folder)
    print("# Harmonic maps\n")
    print("Made by `docs/results/maps.py`: `ricci harmonic` with default options, on the intrinsic Delaunay triangulation. Times are those of one run on a "
          "shared machine and say little.\n")
    print(verdict(bad + more) + "\n")
    if WHY:
        print(f"No independent program has judged the files: {WHY}.\n")
    print("## Disks\n")
    print("Every disk of the corpus onto the unit disk, its boundary by its length. *flipped*: triangles of the Delaunay triangulation that are not "
          "counterclockwise, by exact arithmetic, and pieces of its common refinement with the mesh whose area is below −1e-12 times their longest edge "
          "squared; *without area*: pieces within that of 0. *outside*: check.py on the file. *added*: vertices put on edges inside, because two edges "
          "of the Delaunay triangulation had the same ends: the linear map would collapse all that lies between them. *off the means*: of a vertex from the mean of its neighbours by weight, over the size of "
          "the image. *linear off*: the image as a plane surface of its own, two linear functions given along its boundary: their largest "
          "error.\n")
    print("*corners*: onto regular polygons, the corners at the vertices nearest to even shares of the boundary. More vertices are added there: an edge inside "
          "must not join two boundary vertices, which may lie on one side. *rectangle*: onto the rectangle of the disk's modulus, where two sides of each coordinate are free; no theorem "
          "excludes flipped triangles there. Of maze, a long winding corridor, 3011 of 9924 pieces lie within 1e-15 of a slanted "
          "side of the triangle, and 1756 of the pentagon: coordinates in f64 do not tell which way they turn.\n")
    print(flat)
    print("\n## Spheres\n")
    print("Every closed mesh of genus 0 onto the unit sphere. *energy*: Dirichlet energy of the map, 4π = 12.566371 at least on smooth surfaces, before the first "
          "step and after the last; it may be less on coarse meshes. No theorem excludes flipped triangles "
          "here.\n")
    print(ball)
    if known:
        print("\n## The round sphere\n")
        print("Icospheres onto the sphere: the largest relative change of an edge's length. The map is a Möbius transformation up to O(h²); centred, it is "
              "a rotation, which changes none. With the factor by which it has fallen; the command stops where a step lowers the energy by less than "
              "1e-10 of it, which leaves a few 1e-5.\n")
        print(known)


main()
