"""Cases as they are written, and the surfaces that they are made of."""
import json
import os
import sys

from mpmath import log, mpf, pi, sqrt

from discrete import angles, area, solve, weight


HERE = "tests/vectors/make.py"
DIGITS = "60 digits, plain cosine laws, Newton's method with derivatives by differences; the tolerance is rounding: "


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
