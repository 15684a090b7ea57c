"""Cases of metrics: flows, cones, layouts, uniformization, groups."""
from mpmath import log, mp, mpf, pi, sqrt, tan, tanh

import shapes
from cases import DIGITS, case, check_delaunay, embedded, flat, flattened, hexes, in_space, intrinsic, lifted, of_faces, rounded, scaled, total_area
from discrete import genus_two, glued, grid_torus, hexagon, octahedron, solve, weight
from unfold import distance, regular_octagon, torus_modulus, traces_within, unfold


# --- flows, cones

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
