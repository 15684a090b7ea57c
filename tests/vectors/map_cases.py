"""Cases of maps and charts: circle domains, harmonic maps, forms, atlases, splines, matchings."""
from mpmath import cos, lu_solve, matrix, mp, mpc, mpf, pi, sin, sqrt

import exact
import shapes
from cases import case, check_delaunay, embedded, flat, flattened, hexes, in_space, intrinsic, lifted, of_faces, rounded, total_area
from discrete import angles, genus_two, glued, grid_torus
from unfold import torus_modulus


# --- circle domains

def circle_domains(random):
    made = []
    because = ("Möbius transformations of points in the plane keep the discrete conformal class, and polygons inscribed in circles stay so: "
               "the domain before the transformation is the answer, in closed form; the tolerance is that of a curvature within 1e-10")
    plane, surface, modulus = shapes.ring(16, 3)
    outer = max(abs(mpc(*p)) for p in plane)
    for name, pole in (("ring", mpc(0)), ("ring-moved", mpc("0.3", "0.2"))):
        z = [mpc(*p) / outer for p in plane]
        moved = [(w + pole) / (1 + pole.conjugate() * w) for w in z]
        points = [(float(w.real), float(w.imag), 0.0) for w in moved]
        made.append(case(name, "circles", embedded(points, surface), {}, {"modulus": ([modulus], 1e-10)}, because))
    for n in (1, 2):
        holes = [(0.35, 0.2, 0.2), (-0.35, -0.2, 0.15)][:n]
        plane, surface, rims = shapes.holed(random, 24, holes, 16, 22)
        pole = mpc("0.1", "-0.15")
        moved = [(w + pole) / (1 + pole.conjugate() * w) for w in (mpc(*p) for p in plane)]
        points = [(float(w.real), float(w.imag), 0.0) for w in moved]
        where = [(x, y, r) for x, y, r in [(0.0, 0.0, 1.0), *holes]]
        three = [0, 8, 16]
        made.append(case(f"holes-{n}", "circles", embedded(points, surface), {"three": three},
                         {"circles": (flat(sorted(where, key=lambda c: -c[2])), 1e-9)}, because))
    return made


# --- harmonic maps, forms

def cotangents(surface, lengths):
    """The weight of every edge: half of the cotangents opposite."""
    weights = [mpf(0)] * surface.n_edges
    for f, row in enumerate(surface.face_edges):
        for e, a in zip(row, angles("e2", surface.sides(lengths, f))):
            weights[abs(e) - 1] += cos(a) / sin(a) / 2
    return weights


def harmonics(random):
    made = []
    because = "60 digits: the linear system of the cotangent Laplacian; the tolerance is rounding"
    for n, height in ((9, 0.0), (12, 0.3)):
        points, surface = shapes.disk(random, n, 10)
        points = lifted(points, lambda x, y: height * (x * x - y))
        lengths = in_space(surface, points)
        check_delaunay(surface, lengths)
        weights = cotangents(surface, lengths)
        held = {v: [mpf(float(2 * random.unit() - 1)) for _ in range(3)] for v in range(surface.n) if surface.boundary[v]}
        made.append(case(f"values-{n}", "harmonic", embedded(points, surface), {"to": "values", "vertices": list(held),
                         "values": hexes(flat(held.values()))}, {"points": (extended(surface, weights, held), 1e-13)}, because))
        on_circle = {}
        rim = sum(lengths[e] for e, (i, j) in enumerate(surface.ends) if surface.boundary[i] and surface.boundary[j] and (i - j) % n in (1, n - 1))
        share = mpf(0)
        for v in range(n):
            on_circle[v] = [cos(2 * pi * share), sin(2 * pi * share), mpf(0)]
            share += sqrt(sum((mpf(a) - mpf(b)) ** 2 for a, b in zip(points[v], points[(v + 1) % n]))) / rim
        assert abs(share - 1) < mpf(10) ** -30
        image = extended(surface, weights, on_circle)
        radii = [sqrt(image[3 * v] ** 2 + image[3 * v + 1] ** 2) for v in range(surface.n)]
        made.append(case(f"disk-{n}", "harmonic", embedded(points, surface), {"to": "disk"}, {"radii": (radii, 1e-13)},
                         because + "; radii, because the map may be turned"))
    return made


def extended(surface, weights, held):
    """The harmonic map with the places of some vertices given."""
    free = [v for v in range(surface.n) if v not in held]
    number = {v: k for k, v in enumerate(free)}
    a, b = matrix(len(free), len(free)), matrix(len(free), 3)
    for w, (i, j) in zip(weights, surface.ends):
        for p, q in ((i, j), (j, i)):
            if p in number:
                a[number[p], number[p]] += w
                if q in number:
                    a[number[p], number[q]] -= w
                else:
                    for x in range(3):
                        b[number[p], x] += w * held[q][x]
    columns = [lu_solve(a, b[:, x]) for x in range(3)]
    return flat(held[v] if v in held else [columns[x][number[v]] for x in range(3)] for v in range(surface.n))


def form_cases(random):
    made = []
    for name, tau in (("square", mpc(0, 1)), ("slanted", mpc("0.3", "1.25"))):
        surface, n = grid_torus(3), 3
        # Edges along, up and across every parallelogram: the lattice itself, on which dx and dy are the harmonic forms.
        step = [mpc(1) / n, tau / n, (1 + tau) / n]
        if name == "slanted":  # the shorter diagonal
            step = [tau / n, (1 - tau) / n, mpc(1) / n]
        lengths = [abs(step[e % 3]) for e in range(surface.n_edges)]
        modulus = torus_modulus(surface, lengths)
        assert min(abs(modulus - tau), abs(modulus + tau.conjugate())) < mpf(10) ** -30, modulus
        made.append(case(f"torus-{name}", "forms", intrinsic(surface, lengths), {}, {"modulus": ([modulus.real, modulus.imag], 1e-13)},
                         "a lattice: dx and dy are harmonic on it, and the modulus is that of its periods; the tolerance is rounding, also of "
                         "the lengths"))
    plane, surface, _ = shapes.ring(12, 3)
    points = lifted([(x * (1 + 0.05 * random.unit()), y * (1 + 0.05 * random.unit())) for x, y in plane], lambda x, y: 0.1 * x)
    lengths = in_space(surface, points)
    check_delaunay(surface, lengths)
    weights = cotangents(surface, lengths)
    # The form that winds once: a jump of 1 along a ray, made coclosed by a potential.
    jump = []
    for i, j in surface.ends:
        a, b = [mp.atan2(points[v][1], points[v][0]) / (2 * pi) for v in (i, j)]
        jump.append(-mp.nint(b - a))
    a, b = matrix(surface.n, surface.n), matrix(surface.n, 1)
    for w, c, (i, j) in zip(weights, jump, surface.ends):
        for p, q, s in ((i, j, 1), (j, i, -1)):
            a[p, p] += w
            a[p, q] -= w
            b[p] += s * w * c
    for p in range(surface.n):
        for q in range(surface.n):
            a[p, q] += 1
    u = lu_solve(a, b)
    values = [abs(u[j] - u[i] + c) for c, (i, j) in zip(jump, surface.ends)]
    made.append(case("annulus", "forms", embedded(points, surface), {}, {"absolute": (sorted(values), 1e-13)},
                     "60 digits: closed, with the integral 1 around the annulus, and coclosed, by a linear system; absolute values, ascending, "
                     "because neither the direction nor the order of the edges is part of it; the tolerance is rounding"))
    return made


# --- atlases

def atlases(random):
    made = []
    zero = {"carried": ([0], 1e-9)}
    because = ("60 digits: sides of the faces in the solved metric, which every chart has to show; and what transitions carry has to arrive, "
               "which is 0 by definition; the tolerance is that of a curvature within 1e-10")
    surface = grid_torus(4)
    lengths = rounded(l * (1 + 0.05 * (2 * random.unit() - 1)) for l in [1] * surface.n_edges)
    check_delaunay(surface, lengths)
    solved = flattened(surface, lengths, [mpf(0)] * surface.n)
    check_delaunay(surface, solved)
    factor = sqrt(total_area(surface, "e2", lengths) / total_area(surface, "e2", solved))
    sides = of_faces(surface, [factor * l for l in solved])
    made.append(case("torus-affine", "structure", intrinsic(surface, lengths), {"kind": "affine"}, {"sides": (sides, 1e-10), **zero}, because))
    surface = genus_two()
    lengths = rounded((1 if e < 4 else 1.3) * (1 + 0.03 * (2 * random.unit() - 1)) for e in range(surface.n_edges))
    check_delaunay(surface, lengths)
    solved = flattened(surface, lengths, [mpf(0)] * 2, "h2")
    sides = of_faces(surface, solved)
    for kind in ("hyperbolic", "projective"):
        made.append(case(f"octagon-{kind}", "structure", intrinsic(surface, lengths), {"kind": kind, "flips": "never"}, {"sides": (sides, 1e-9), **zero}, because))
    return made


def round_atlases():
    """A polyhedron inscribed in the sphere that is its own mirror image in the centre, so that it is its own centred form."""
    half = [(0.9, 0.3, 0.2), (-0.2, 0.8, 0.5), (0.1, -0.5, 0.9), (0.7, -0.6, -0.3)]
    unit = [tuple(x / sqrt(sum(mpf(y) ** 2 for y in p)) for x in map(mpf, p)) for p in half]
    points = [tuple(float(s * x) for x in p) for p in unit for s in (1, -1)]
    surface = shapes.hull(points)
    lengths = in_space(surface, points)
    check_delaunay(surface, lengths)
    arcs = [2 * mp.asin(l / 2) for l in lengths]
    zero = {"carried": ([0], 1e-9)}
    because = ("the polyhedron is inscribed and symmetric about the centre, so that it is its own spherical shape: arcs between its vertices; and "
               "what transitions carry has to arrive, which is 0 by definition; the tolerance is that of a curvature within 1e-10")
    return [
        case("polyhedron-spherical", "structure", embedded(points, surface), {"kind": "spherical"},
             {"sides": (of_faces(surface, arcs), 1e-9), **zero}, because),
        case("polyhedron-conformal", "structure", embedded(points, surface), {"kind": "conformal"}, zero, "what transitions carry has to "
             "arrive, which is 0 by definition; charts are determined up to Möbius transformations alone; the tolerance is rounding"),
    ]


# --- splines, matching

def splines():
    made = []
    because = "exact rational arithmetic; the tolerance is rounding, which grows with the powers of the distances of knots in derivatives"
    for name, s in exact.splines():
        corners = [(x, y, 0) for x, y in zip(s["vertices"][::2], s["vertices"][1::2])]
        mesh = {"mesh": {"n_vertices": 5, "faces": s["triangles"], "positions": hexes(flat(corners))}}
        options = {"degree": s["degree"], "knots": hexes(s["knots"]), "control": hexes(s["control"]), "patches": s["patches"],
                   "places": hexes(s["places"])}
        made.append(case(f"{name}-{s['degree']}", "spline", mesh, options,
                         {"point": (s["point"], 1e-14), "first": (s["first"], 3e-14), "second": (s["second"], 1e-12)}, because))
    rng = exact.random.Random(7)
    for degree in (2, 3):
        p = exact.polynomial(degree, rng)
        mesh = {"mesh": {"n_vertices": 5, "faces": [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4],
                         "positions": hexes([0, 0, 0, 4, 0, 0, 4, 4, 0, 0, 4, 0, 1.75, 2.25, 0])}}
        options = {"degree": degree, "parameters": hexes(p["parameters"]), "points": hexes(p["points"]), "places": hexes(p["places"])}
        made.append(case(f"fit-{degree}", "fit", mesh, options, {"point": (p["point"], 1e-9)},
                         "points of a polynomial surface, which a spline of its degree reproduces: exact sums of powers; the tolerance is that of "
                         "the normal equations, whose condition costs half of the digits"))
    return made


def matchings(random):
    made = []
    because = ("the target is the source turned in space, its vertices in another order: the one harmonic map of least energy is the turn, which "
               "is known exactly; the tolerance is that of the search for it")

    def add(name, points, surface, options, tolerance):
        order = list(range(surface.n))
        for k in range(surface.n - 1, 0, -1):
            m = int(random.unit() * (k + 1))
            order[k], order[m] = order[m], order[k]
        # Vertex v of the source is vertex order[v] of the target.
        there, images = [None] * surface.n, shapes.turned(points)
        for v, p in zip(order, images):
            there[v] = p
        copy = glued(name, surface.n, [[order[v] for v in f] for f in surface.faces])
        marks = [[v, order[v]] for v in options.pop("landmarks")]
        mesh = {**embedded(points, surface), **embedded(there, copy, "target")}
        made.append(case(name, "match", mesh, {"landmarks": flat(marks), **options}, {"images": (flat(images), tolerance)}, because))

    points, surface = shapes.inscribed(random, 16)
    points = [(float(1.3 * x), float(y), float(0.8 * z)) for x, y, z in points]
    add("sphere", points, surface, {"landmarks": [0, 3, 7]}, 1e-9)
    points, surface = shapes.disk(random, 9, 8)
    add("disk", lifted(points, lambda x, y: 0.3 * x * x - 0.2 * y), surface, {"landmarks": [0, 3, 6], "boundary": "arc_length"}, 1e-9)
    points, surface = shapes.torus(random, 9, 6)
    add("torus", points, surface, {"landmarks": [0]}, 1e-9)
    return made


def surfaces_fitted():
    """A spline over a whole surface: there is no other computation of it, so the case has what an independent one allows, a bound of zero."""
    mesh = {"mesh": {"shape": "torus", "a": hexes([2])[0], "b": hexes([1])[0], "n": 24, "m": 12}}
    return [case("torus-surface", "surface_fit", mesh, {"degree": 3, "control_points": 150}, {"distance": ([0], 2e-2)},
                 "no independent computation exists: the surface is known, a torus of radii 2 and 1, and points of the spline are held against "
                 "it; the tolerance is what so few control points leave of it")]
