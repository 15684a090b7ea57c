#!/usr/bin/env python3
"""Golden vectors: small surfaces and splines, computed with 60 digits or exactly, and by nothing of the project.

usage: tests/vectors/make.py DIRECTORY      (needs mpmath; the tests do not: they read the files that are committed)

README.md beside this file says what the files hold, what each case checks and where its numbers come from.
"""
import json
import os
import sys

from mpmath import cos, cosh, exp, log, lu_solve, matrix, mp, mpc, mpf, pi, sin, sqrt, tan, tanh

import exact
import shapes
from discrete import Random, angles, area, genus_two, glued, grid_torus, hexagon, length, octahedron, solve, weight
from unfold import distance, regular_octagon, torus_modulus, traces_within, unfold

HERE = "tests/vectors/make.py"


def hexes(values):
    return [float(x).hex() for x in values]


def seal(text):
    """FNV-1a, 64 bits."""
    value = 0xCBF29CE484222325
    for byte in text.encode():
        value = (value ^ byte) * 0x100000001B3 % 2**64
    return f"{value:016x}"


def line(case):
    """One case: JSON in one line, whose last member seals what stands before it."""
    text = json.dumps(case, separators=(",", ":"))[:-1]
    return f'{text},"seal":"{seal(text)}"}}'


def write(folder, capability, cases):
    with open(os.path.join(folder, f"{capability}.json"), "w") as out:
        out.write(f'{{"capability":"{capability}","made_by":"{HERE}","cases":[\n')
        out.write(",\n".join(line(case) for case in cases))
        out.write("\n]}\n")
    print(capability, len(cases), "cases", file=sys.stderr)


def case(name, call, mesh, options, expect, because):
    """`expect`: for each quantity its values and how far a result may be off each of them."""
    made = {"name": name, "call": call}
    made.update(mesh)
    made["options"] = options
    made["expect"] = {key: {"tolerance": float(tolerance), "values": hexes(values)} for key, (values, tolerance) in expect.items()}
    made["because"] = because
    return made


def flat(rows):
    return [x for row in rows for x in row]


def intrinsic(surface, lengths, geometry="e2"):
    return {"mesh": {"n_vertices": surface.n, "faces": flat(surface.faces), "face_edges": flat(surface.face_edges),
                     "lengths": hexes(lengths), "geometry": geometry}}


def embedded(points, surface, key="mesh"):
    return {key: {"n_vertices": surface.n, "faces": flat(surface.faces), "positions": hexes(flat(points))}}


def rounded(values):
    return [mpf(float(x)) for x in values]


def in_space(surface, points):
    """Lengths of the edges between points."""
    return [sqrt(sum((mpf(a) - mpf(b)) ** 2 for a, b in zip(points[i], points[j]))) for i, j in surface.ends]


def lifted(points, height):
    return [(float(x), float(y), float(height(x, y))) for x, y in points]


def of_faces(surface, lengths):
    """The lengths opposite the corners of every face."""
    return flat(surface.sides(lengths, f) for f in range(len(surface.faces)))


def check_delaunay(surface, lengths, doubled=False):
    """Angles opposite an edge add up to less than pi: no edge is flipped. Of a double, those opposite the boundary are acute."""
    opposite = [mpf(0)] * surface.n_edges
    seen = [0] * surface.n_edges
    for f, row in enumerate(surface.face_edges):
        for e, a in zip(row, angles("e2", surface.sides(lengths, f))):
            opposite[abs(e) - 1] += a
            seen[abs(e) - 1] += 1
    for a, n in zip(opposite, seen):
        assert a < (pi if n == 2 else pi / 2 if doubled else 4) - mpf("0.01"), f"an edge that would be flipped: {float(a)}"


def scaled(surface, lengths):
    """The class of lengths under vertex scaling: eta and u = 0."""
    u = [mpf(0)] * surface.n
    return [weight("e2", 0, 0, l, u[i], u[j]) for l, (i, j) in zip(lengths, surface.ends)], u


def flattened(surface, lengths, target, space="e2"):
    """Lengths with this curvature, by vertex scaling."""
    eta, u = scaled(surface, lengths)
    if space == "h2":
        u = [x - log(4) for x in u]
    u = solve(surface, space, 0, eta, u, target)
    return surface.lengths(space, 0, eta, u)


def total_area(surface, space, lengths):
    return sum(area(space, surface.sides(lengths, f)) for f in range(len(surface.faces)))


# --- flows, cones

DIGITS = "60 digits, plain cosine laws, Newton's method with derivatives by differences; the tolerance is rounding: "


def start(surface, geometry, scheme, size, spread, random):
    """A perturbed surface and its class: lengths, epsilon, eta, u."""
    near = [size * (0.8 if surface.name == "genus2" and e >= 4 else 1) for e in range(surface.n_edges)]
    lengths = rounded(l * (1 + spread * (2 * random.unit() - 1)) for l in near)
    epsilon = {"yamabe": 0, "virtual": -1}.get(scheme, 1)
    if epsilon == 0:
        u = [mpf(0)] * surface.n
    else:
        u = [log({"e2": r, "h2": tanh(r / 2), "s2": tan(r / 2)}[geometry]) for r in surface.radii(lengths, scheme)]
    eta = [weight(geometry, epsilon, epsilon, l, u[i], u[j]) for l, (i, j) in zip(lengths, surface.ends)]
    if scheme == "thurston":
        eta = [min(max(e, mpf(0)), mpf(1)) for e in eta]
    if scheme == "tangential":
        eta = [mpf(1)] * surface.n_edges
    return lengths, epsilon, eta, u


def flows(random):
    flow, derivatives = [], []
    for scheme in ("yamabe", "inversive", "thurston", "tangential", "virtual"):
        for surface, geometry, space, size, spread in [
            (grid_torus(3), "e2", "e2", 1.0, 0.05), (octahedron(), "e2", "e2", 1.0, 0.05), (hexagon(), "e2", "e2", 1.0, 0.05),
            (genus_two(), "e2", "h2", 1.0, 0.02), (genus_two(), "h2", "h2", 2.0, 0.02), (grid_torus(3), "h2", "h2", 1.0, 0.05),
            (octahedron(), "s2", "s2", 1.2, 0.05), (octahedron(), "s2", "e2", 1.2, 0.05),
        ]:
            lengths, epsilon, eta, u = start(surface, geometry, scheme, size, spread, random)
            name = f"{surface.name}-{geometry}-{space}-{scheme}"
            mesh = intrinsic(surface, lengths, geometry)
            curvature = surface.curvature(geometry, surface.lengths(geometry, epsilon, eta, u))
            derivative = flat(surface.derivative(geometry, epsilon, eta, u))
            derivatives.append(case(name, "derivative", mesh, {"scheme": scheme}, {"derivative": (derivative, 2e-14)},
                                    DIGITS + "entries are a few units large"))
            expect = {"eta": (eta, 1e-13), "curvature": (curvature, 1e-13)}
            options = {"scheme": scheme, "space": space, "flips": "never"}
            if space == "s2" and scheme in ("yamabe", "virtual"):
                # No metric on the sphere is a minimum of these energies, and no flow finds back to one.
                flow.append(case(name, "metric", mesh, {"scheme": scheme}, expect, DIGITS + "of the weights and angles"))
                continue
            if space == "s2":
                # On the sphere the energy is not convex: the target is the curvature of a metric nearby, and the flow finds back to it.
                at = [x + mpf(float(0.01 * (random.unit() - 0.5))) for x in u]
                target = rounded(surface.curvature("s2", surface.lengths("s2", epsilon, eta, at)))
                exact_target = target
            else:
                total = 2 * pi * surface.euler + (mpf("0.7") if space == "h2" else 0)
                target = rounded(total / surface.n + 0.4 * (random.unit() - 0.5) for _ in range(surface.n))
                target[-1] = mpf(float(total - sum(target[:-1])))
                exact_target = target[:-1] + [total - sum(target[:-1])] if space == "e2" else target
                at = [x - log(4) for x in u] if space == "h2" and geometry != "h2" else u
            at = solve(surface, space, epsilon, eta, at, exact_target)
            if space == "e2":
                mean = sum(at) / surface.n
                at = [x - mean for x in at]
            options["target"] = hexes(target)
            tolerance = 1e-9 if space == "s2" else 1e-12
            expect["u"] = (at, tolerance)
            expect["sides"] = (of_faces(surface, surface.lengths(space, epsilon, eta, at)), tolerance)
            flow.append(case(name, "flow", mesh, options, expect,
                             DIGITS + "of the weights and angles, and for u of a curvature within 1e-10, of which Newton's method leaves far "
                             "less, but the gradient flow on the sphere nothing"))
    return flow, derivatives


def cones(random):
    made = []
    points, surface = shapes.inscribed(random, 12)
    lengths = in_space(surface, points)
    check_delaunay(surface, lengths)
    for scheme in ("yamabe", "inversive"):
        for name, at in (("four", [0, 1, 2, 3]), ("three", [4, 5, 6])):
            angle = 4 * pi / len(at)
            target = [angle if v in at else mpf(0) for v in range(surface.n)]
            if scheme == "yamabe":
                (eta, u), epsilon = scaled(surface, lengths), 0
            else:
                u, epsilon = [log(r) for r in surface.radii(lengths, scheme)], 1
                eta = [weight("e2", 1, 1, l, u[i], u[j]) for l, (i, j) in zip(lengths, surface.ends)]
            u = solve(surface, "e2", epsilon, eta, u, target)
            mean = sum(u) / surface.n
            u = [x - mean for x in u]
            options = {"scheme": scheme, "space": "e2", "flips": "never", "cones": at, "curvatures": hexes([angle] * len(at))}
            expect = {"u": (u, 1e-12), "sides": (of_faces(surface, surface.lengths("e2", epsilon, eta, u)), 1e-11)}
            made.append(case(f"{name}-{scheme}", "flow", embedded(points, surface), options, expect,
                             DIGITS + "of a curvature within 1e-10, of which Newton leaves far less"))
    return made


# --- layouts

def layouts(random):
    made = []
    because = ("60 digits: the solved lengths unfolded corner by corner, so that only the distances in the layout count, whatever its place; "
               "the tolerance is rounding along the way from face to face")

    def add(name, surface, mesh, options, space, lengths, whole=True):
        sides = of_faces(surface, lengths)
        expect = {"sides": (sides, 1e-11)}
        if whole:
            places, _ = unfold(surface, space, lengths)
            corners = flat(places[f] for f in range(len(surface.faces)))
            expect["distances"] = ([distance(space, corners[0], z) for z in corners], 1e-11)
        made.append(case(name, "layout", mesh, {"scheme": "yamabe", "space": space, "flips": "never", **options}, expect, because))

    points, surface = shapes.disk(random, 9, 7)
    points = lifted(points, lambda x, y: 0.3 * x * x - 0.2 * x * y)
    lengths = in_space(surface, points)
    target = rounded((2 * pi / 9 + 0.2 * (random.unit() - 0.5)) if b else 0 for b in surface.boundary)
    last = max(v for v in range(surface.n) if surface.boundary[v])
    exact_target = list(target)
    exact_target[last] = 2 * pi - (sum(target) - target[last])
    target[last] = mpf(float(exact_target[last]))
    solved = flattened(surface, lengths, exact_target)
    factor = sqrt(total_area(surface, "e2", lengths) / total_area(surface, "e2", solved))
    add("disk-e2", surface, embedded(points, surface), {"target": hexes(target)}, "e2", [factor * l for l in solved])
    bent = rounded((2 * pi / 9 + 0.3) if b else 0 for b in surface.boundary)
    add("disk-h2", surface, embedded(points, surface), {"target": hexes(bent)}, "h2", flattened(surface, lengths, bent, "h2"))
    ball, polyhedron = shapes.inscribed(random, 10)
    cone = [0, 3, 5, 8]
    solved = flattened(polyhedron, in_space(polyhedron, ball), [pi if v in cone else mpf(0) for v in range(10)])
    factor = sqrt(total_area(polyhedron, "e2", in_space(polyhedron, ball)) / total_area(polyhedron, "e2", solved))
    add("cones-e2", polyhedron, embedded(ball, polyhedron), {"cones": cone, "curvatures": hexes([pi] * 4)}, "e2",
        [factor * l for l in solved], whole=False)
    # Chords of the sphere as arcs: the layout in S2 is the polyhedron itself.
    unit = [[mpf(x) / sqrt(sum(mpf(y) ** 2 for y in p)) for x in p] for p in ball]
    arcs = [2 * mp.asin(sqrt(sum((a - b) ** 2 for a, b in zip(unit[i], unit[j]))) / 2) for i, j in polyhedron.ends]
    sides = of_faces(polyhedron, arcs)
    corners = [unit[v] for v in flat(polyhedron.faces)]
    apart = [2 * mp.asin(min(mpf(1), sqrt(sum((a - b) ** 2 for a, b in zip(corners[0], z))) / 2)) for z in corners]
    made.append(case("sphere-s2", "layout", intrinsic(polyhedron, arcs, "s2"), {"scheme": "yamabe", "space": "s2", "without_flow": 1},
                     {"sides": (sides, 1e-11), "distances": (apart, 1e-11)},
                     "arcs between points of the unit sphere, which the layout has to find back; the tolerance is rounding, larger where "
                     "a point is near the place from which the sphere is projected"))
    return made


# --- uniformization, groups

def uniformizations(random):
    made = []
    for spread in (0.03, 0.06):
        surface = grid_torus(3)
        lengths = rounded(l * (1 + spread * (2 * random.unit() - 1)) for l in [1] * surface.n_edges)
        check_delaunay(surface, lengths)
        solved = flattened(surface, lengths, [mpf(0)] * surface.n)
        check_delaunay(surface, solved)
        tau = torus_modulus(surface, solved)
        made.append(case(f"torus-{spread}", "uniformize", intrinsic(surface, lengths), {"scheme": "yamabe"},
                         {"modulus": ([tau.real, tau.imag], 1e-11), "area": ([total_area(surface, "e2", lengths)], 1e-12)},
                         "60 digits: the flat lengths unfolded, the periods of the lattice reduced; the tolerance is that of a curvature "
                         "within 1e-10"))
    plane, surface = shapes.wheel(12, 3)
    points = lifted([(x * (1 + 0.03 * random.unit()), y * (1 + 0.03 * random.unit())) for x, y in plane], lambda x, y: 0.05 * x * y)
    lengths = in_space(surface, points)
    check_delaunay(surface, lengths, doubled=True)
    corners = [36, 39, 41, 45]
    solved = flattened(surface, lengths, [pi / 2 if v in corners else mpf(0) for v in range(surface.n)])
    check_delaunay(surface, solved, doubled=True)
    places, _ = unfold(surface, "e2", solved)
    where = {v: places[f][k] for f, face in enumerate(surface.faces) for k, v in enumerate(face)}
    ratio = abs(where[41] - where[39]) / abs(where[39] - where[36])
    made.append(case("rectangle", "uniformize", embedded(points, surface), {"scheme": "yamabe", "boundary": "straight", "corners": corners},
                     {"extremal_distance": ([ratio], 1e-10)},
                     "60 digits: four right angles, the flat lengths unfolded, height over base; the tolerance is that of a curvature within 1e-10"))
    plane, surface, _ = shapes.ring(12, 3)
    points = lifted([(x * (1 + 0.05 * random.unit()), y * (1 + 0.05 * random.unit())) for x, y in plane], lambda x, y: 0.1 * x)
    lengths = in_space(surface, points)
    check_delaunay(surface, lengths, doubled=True)
    solved = flattened(surface, lengths, [mpf(0)] * surface.n)
    check_delaunay(surface, solved, doubled=True)
    around = sum(l for l, (i, j) in zip(solved, surface.ends) if i < 12 and j < 12)
    made.append(case("annulus", "uniformize", embedded(points, surface), {"scheme": "yamabe"},
                     {"extremal_distance": ([total_area(surface, "e2", solved) / around**2], 1e-10)},
                     "60 digits: of a flat annulus the area over the square of the length of a loop; the tolerance is that of a curvature within 1e-10"))
    for n in (8, 14):
        points, surface = shapes.inscribed(random, n)
        centre = (0.9, -0.6, 3.7)
        moved = []
        for p in points:
            square = sum((a - b) ** 2 for a, b in zip(p, centre))
            moved.append(tuple(float(b + (a - b) / square) for a, b in zip(p, centre)))
        back = glued("polyhedron", n, [[f[0], f[2], f[1]] for f in surface.faces])
        lengths = in_space(back, moved)
        check_delaunay(back, lengths)
        made.append(case(f"sphere-{n}", "uniformize", embedded(moved, back), {"scheme": "yamabe"},
                         {"cross_ratios": (cross_ratios(back, lengths), 1e-9)},
                         "an inscribed polyhedron after an inversion: Möbius transformations keep the length cross ratio of every edge, which "
                         "is computed with 60 digits from the input; the tolerance is rounding in the plane under the sphere"))
    return made


def cross_ratios(surface, lengths):
    """For the corners of every face: of the edge opposite, i j with k here and l across, l_il l_jk / (l_lj l_ki)."""
    across = {}
    for f, row in enumerate(surface.face_edges):
        for k, e in enumerate(row):
            across[e] = (f, k)
    made = []
    for f, row in enumerate(surface.face_edges):
        for k, e in enumerate(row):
            g, m = across[-e]
            mine, other = surface.sides(lengths, f), surface.sides(lengths, g)
            # Here i, j follow k; across j, i follow l.
            made.append(other[(m + 1) % 3] * mine[(k + 1) % 3] / (other[(m + 2) % 3] * mine[(k + 2) % 3]))
    return made


def groups(random):
    made = []
    because = ("60 digits: the hyperbolic octagon unfolded, its pairings multiplied until no further element moves the base by at most the "
               "radius; the traces do not depend on the generators; the tolerance is relative to the largest, and that of a "
               "curvature within 1e-10")
    surface, radius = genus_two(), mpf("4.6")
    regular = regular_octagon(surface)
    traces = traces_within(surface, regular, (1, 2, 3, 4), radius)
    made.append(case("bolza", "group", {"mesh": {"shape": "two_vertex", "genus": 2}}, {"scheme": "yamabe", "radius": hexes([radius])[0]},
                     {"traces": (traces, 1e-9 * float(max(traces)))}, "the regular octagon in closed form; " + because))
    lengths = rounded((1 if e < 4 else 1.3) * (1 + 0.03 * (2 * random.unit() - 1)) for e in range(surface.n_edges))
    check_delaunay(surface, lengths)
    solved = flattened(surface, lengths, [mpf(0)] * 2, "h2")
    radius = mpf("4.6")
    traces = traces_within(surface, solved, (1, 2, 3, 4), radius)
    made.append(case("octagon", "group", intrinsic(surface, lengths), {"scheme": "yamabe", "base": 1, "flips": "never", "radius": hexes([radius])[0]},
                     {"traces": (traces, 1e-9 * float(max(traces)))}, because))
    return made


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


def round_atlases(random):
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


# --- formulas below the C face

def triangles():
    made = []
    rows = [(1, 1, 1), (3, 4, 5), (1, 1, 1e-9), (1, 1, 1.9999999), (1, 0.5, 0.5000000001), (0.3, 0.7, 0.41), (1, 1, 1e-200)]
    for space in ("e2", "h2", "s2"):
        for row in rows:
            for size in (1e-9, 1e-3, 0.3, 1.0, 20.0):
                l = rounded(size * x for x in row)
                if space == "s2" and (max(l) >= pi or sum(l) >= 2 * pi) or sum(l) <= 2 * max(l) or min(l) < 1e-250:
                    continue
                with mp.workdps(900 if min(row) < 1e-100 else 80):
                    made.append(case(f"{space}-{len(made)}", "triangle", {}, {"space": space, "lengths": hexes(l)},
                                     {"angles": (angles(space, l), 16 * 2.0**-52), "area": ([area(space, l)], 8 * 2.0**-52)},
                                     "up to 900 digits, plain cosine laws; the tolerance is relative: a few units in the last place"))
    return made


def circle_patterns(random):
    made = []
    domain = {"e2": (-20, 20), "h2": (-25, -0.02), "s2": (-20, -1.5)}
    for space, (low, high) in domain.items():
        for kind in [lambda: 1.0] * 6 + [lambda: random.unit()] * 6 + [lambda: 1 + 0.5 * random.unit()] * 3:
            eta = rounded(kind() for _ in range(3))
            while True:
                u = rounded(low + (high - low) * random.unit() for _ in range(3))
                if kind() <= 1 or max(u) - min(u) < 0.5:  # circles apart: keep the triangle inequality
                    break
                low, high = -2.0, -1.5
            with mp.workdps(150):
                def at(u):
                    return angles(space, [length(space, 1, 1, eta[k], u[(k + 1) % 3], u[(k + 2) % 3]) for k in range(3)])
                h, weights = mpf(10) ** -50, []
                for k in range(3):
                    i, j = (k + 1) % 3, (k + 2) % 3
                    plus, minus = list(u), list(u)
                    plus[j] += h
                    minus[j] -= h
                    weights.append((at(plus)[i] - at(minus)[i]) / (2 * h))
                made.append(case(f"{space}-{len(made)}", "circle_pattern", {}, {"space": space, "eta": hexes(eta), "u": hexes(u)},
                                 {"angles": (at(u), 1e-13), "weights": (weights, 1e-13)},
                                 "150 digits, plain cosine laws, derivatives by differences; the tolerance is relative, and u has twenty units "
                                 "before the point, so that e^u is off by as many units in the last place at the start"))
    return made


def main():
    folder = sys.argv[1]
    wanted = sys.argv[2:]
    flow = []
    def both():
        flow.extend(flows(Random(2007)))
        return flow[0]
    all_cases = {
        "flow": both, "cones": lambda: cones(Random(3)), "layouts": lambda: layouts(Random(5)),
        "uniformization": lambda: uniformizations(Random(11)), "groups": lambda: groups(Random(13)),
        "circle_domains": lambda: circle_domains(Random(17)), "harmonic": lambda: harmonics(Random(19)),
        "forms": lambda: form_cases(Random(23)), "atlases": lambda: atlases(Random(29)) + round_atlases(Random(37)), "splines": lambda: splines() + surfaces_fitted(),
        "matching": lambda: matchings(Random(31)), "triangles": triangles, "circle_patterns": lambda: circle_patterns(Random(1985)),
        "derivative": lambda: (flow or flows(Random(2007)))[1],
    }
    for capability, make in all_cases.items():
        if not wanted or capability in wanted:
            write(folder, capability, make())


main()
