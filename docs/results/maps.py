#!/usr/bin/env python3
"""Harmonic maps of every disk of the corpus to the disk, to polygons and to its rectangle, and of every sphere to the sphere, as tables.

usage: docs/results/maps.py [CORPUS [NAME…]] > docs/results/maps.md     (after: cargo build --release -p ricci-apps)
"""
import math

from page import (fallen, file_of, genus, judged, loops, main, meshes, named, read_obj, rim, seconds, sides, small, table, verdict,
                  verdict_of_outside, write_obj, write_rows)

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


def linear(run, uv):
    """The image of a disk as a plane surface of its own: the largest error of two linear functions that are given along its boundary."""
    faces, at = texture(uv)
    plane = write_obj(run.path("plane.obj"), [(*at[v], 0) for v in range(len(at))], faces)
    value = lambda p: (2 * p[0] - p[1] + 0.5, 0.3 * p[1] - p[0])
    values = write_rows(run.path("values.csv"), "vertex,x,y", ((v, *value(at[v])) for v in sorted(rim(faces))))
    (out,) = run.fresh("linear.obj")
    report, why = run.try_report("harmonic", plane, "--to", f"file:{values}", "--uv", out)
    if report is None:
        return None, why
    found = texture(out)[1]
    return max(math.dist(value(at[v]), found[v]) for v in at), None


DISKS = ["mesh", "V", "flips", "added", "energy", "off the means", "flipped", "without area", "outside: flipped, without area", "linear off",
         f"flipped (added): {', '.join(map(str, CORNERS))} corners", "flipped: rectangle", "s"]


def disk(run, mesh):
    path, (uv,), name = file_of(mesh), run.fresh("uv.obj"), mesh["name"]
    report = run.report(name, "harmonic", path, "--to", "disk", "--uv", uv)
    if report is None:
        return None
    r, seen = report["result"], judged("uv", uv, path)
    run.insist(not seen or not seen["flipped"] and seen["first_vertices_kept"], f"{name}, outside: {seen}")
    off, why = linear(run, uv)
    run.insist(off is not None and off <= LINEAR, f"{name}, linear functions: {why or off}")
    polygons = []
    for n in CORNERS:
        polygon = run.report(f"{name}, {n} corners", "harmonic", path, "--to", f"polygon:{n}")
        polygons.append("–" if polygon is None else f"{polygon['result']['flipped_triangles']} ({polygon['result']['added_vertices']})")
    rectangle, why = run.try_report("harmonic", path, "--to", "rectangle")
    run.insist(rectangle is not None, f"{name}, rectangle: {why}")
    return [
        name, mesh["V"], r["flips"], r["added_vertices"], f"{r['energy']:.4f}", small(r["mean_value_residual"]), r["flipped_triangles"],
        r["degenerate_pieces"], "–" if seen is None else f"{seen['flipped']}, {seen['degenerate']}", small(off), ", ".join(polygons),
        "–" if rectangle is None else rectangle["result"]["flipped_triangles"], seconds(report),
    ]


def sphere(run, mesh):
    report = run.report(mesh["name"], "harmonic", file_of(mesh), "--to", "sphere")
    if report is None:
        return None
    r, energies = report["result"], report["result"]["energies"]
    rising = sum(b > a for a, b in zip(energies, energies[1:]))
    return [mesh["name"], mesh["V"], r["flips"], r["iterations"], f"{energies[0]:.4f}", f"{energies[-1]:.6f}", rising, r["flipped_triangles"],
            seconds(report)]


def round_spheres(run):
    """Largest relative change of an edge by the map of a round sphere to itself: centred Möbius transformations of it are rotations."""
    rows, before = [], None
    for n in (4, 8, 16, 32, 64):
        path, out = run.make("ball.obj", "sphere", "-n", str(n)), run.path("out.obj")
        run.needed(f"sphere {n}", "harmonic", path, "--sphere", out)
        (given, faces), (found, _) = read_obj(path), read_obj(out)
        edges = {(min(a, b), max(a, b)) for a, b in sides(faces)}
        now = [max(abs(math.dist(found[a], found[b]) / math.dist(given[a], given[b]) - 1) for a, b in edges)]
        rows.append([n, len(given), *fallen(now, before)])
        before = now
    return table(["frequency", "V", "edges off by"], rows)


def content(run):
    flat = run.rows(meshes(lambda m: genus(m) == 0 and loops(m) == 1), disk)
    ball = run.rows(meshes(lambda m: genus(m) == 0 and loops(m) == 0), sphere)
    page = [
        "# Harmonic maps",
        "Made by `docs/results/maps.py`: `ricci harmonic` with default options, on the intrinsic Delaunay triangulation. Times are those of one run on a "
        "shared machine and say little.",
        verdict(run.bad),
        verdict_of_outside(""),
        "## Disks",
        "Every disk of the corpus onto the unit disk, its boundary by its length. *flipped*: triangles of the Delaunay triangulation that are not "
        "counterclockwise, by exact arithmetic, and pieces of its common subdivision with the mesh whose area is below −1e-12 times their longest edge "
        "squared; *without area*: pieces within that of 0. *outside*: check.py on the file. *added*: vertices put on edges inside, because two edges "
        "of the Delaunay triangulation had the same ends: the linear map would collapse all that lies between them. *off the means*: of a vertex from the mean of its neighbours by weight, over the size of "
        "the image. *linear off*: the image as a plane surface of its own, two linear functions given along its boundary: their largest "
        "error.",
        "*corners*: onto regular polygons, the corners at the vertices nearest to even shares of the boundary. More vertices are added there: an edge inside "
        "must not join two boundary vertices, which may lie on one side. *rectangle*: onto the rectangle of the disk's modulus, where two sides of each coordinate are free; no theorem "
        "excludes flipped triangles there. Of maze, a long winding corridor, 3011 of 9924 pieces lie within 1e-15 of a slanted "
        "side of the triangle, and 1756 of the pentagon: coordinates in f64 do not tell which way they turn.",
        table(DISKS, flat),
        "## Spheres",
        "Every closed mesh of genus 0 onto the unit sphere. *energy*: Dirichlet energy of the map, 4π = 12.566371 at least on smooth surfaces, before the first "
        "step and after the last; it may be less on coarse meshes. No theorem excludes flipped triangles "
        "here.",
        table(["mesh", "V", "flips", "steps", "energy before", "energy after", "steps that raise it", "flipped", "s"], ball),
    ]
    return page if named else page + [
        "## The round sphere",
        "Icospheres onto the sphere: the largest relative change of an edge's length. The map is a Möbius transformation up to O(h²); centred, it is "
        "a rotation, which changes none. With the factor by which it has fallen; the command stops where a step lowers the energy by less than "
        "1e-10 of it, which leaves a few 1e-5.",
        round_spheres(run),
    ]


main(content)
