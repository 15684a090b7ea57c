"""Triangular B-splines in exact rational arithmetic: random rational knots and places.

A basis function is |d| M(u | V), d the area of its last knots, M by Micchelli's recurrence over fractions; derivatives by its formula for
them. Standard library alone."""
import random
from fractions import Fraction as F

PLACES = 6


def cross(a, b, c):
    """Twice the signed area."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def split(knots):
    """Three knots that are not on a line, and twice their area; None where there are none."""
    n = len(knots)
    for i in range(n):
        for j in range(i + 1, n):
            for k in range(j + 1, n):
                d = cross(knots[i], knots[j], knots[k])
                if d:
                    return (i, j, k), d
    return None


def jet(knots, u, order, memo):
    """M and its derivatives at u up to the order, as a dictionary from the numbers of differentiations by x and y."""
    key = (tuple(knots), order)
    if key in memo:
        return memo[key]
    names = [(p, q) for p in range(order + 1) for q in range(order + 1 - p)]
    zero = {name: F(0) for name in names}
    found = split(knots)
    if found is None:
        memo[key] = zero
        return zero
    at, d = found
    a = [knots[i] for i in at]
    degree = len(knots) - 3
    if degree == 0:
        sides = [cross(u, a[k], a[(k + 1) % 3]) for k in range(3)]
        assert all(sides), "a place on the line of two knots"
        inside = all(s > 0 for s in sides) or all(s < 0 for s in sides)
        memo[key] = {**zero, (0, 0): 1 / abs(d) if inside else F(0)}
        return memo[key]
    total = dict(zero)
    for k in range(3):
        b, c = a[(k + 1) % 3], a[(k + 2) % 3]
        weight = cross(u, b, c) / d
        slope = ((b[1] - c[1]) / d, (c[0] - b[0]) / d)
        rest = knots[: at[k]] + knots[at[k] + 1 :]
        part = jet(rest, u, order, memo)
        total[0, 0] += weight * part[0, 0]
        for p, q in names[1:]:
            # D M = n (grad weight) M', once for the last differentiation; the weights are affine.
            less = (p - 1, q) if p else (p, q - 1)
            total[p, q] += degree * slope[0 if p else 1] * part[less]
    memo[key] = total
    return total


def multi_indices(n):
    return [(i, j, n - i - j) for i in range(n, -1, -1) for j in range(n - i, -1, -1)]


def block(degree, name, rng):
    """One spline with its places: a dictionary of lists of fractions and whole numbers."""
    corners = [(0, 0), (4, 0), (4, 4), (0, 4), (F(115, 64), F(141, 64))]
    vertices = [(F(x), F(y)) for x, y in corners]
    triangles = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
    near = lambda v: tuple(x + F(rng.randint(-24, 24), 64) for x in v)
    knots = []
    for i, v in enumerate(vertices):
        moves = name == "general" or i == 4
        knots.append([v] + [near(v) if moves else v for _ in range(degree)])
    control, value = {}, lambda: tuple(F(rng.randint(-64, 64), 64) for _ in range(3))
    patches = []
    for t in triangles:
        ids = []
        for beta in multi_indices(degree):
            ids.append(frozenset((t[k], beta[k]) for k in range(3) if beta[k]))
            control.setdefault(ids[-1], value())
        patches.append(ids)
    flat = lambda rows: [x for row in rows for x in row]
    made = {
        "degree": degree, "vertices": flat(vertices), "triangles": flat(triangles), "knots": flat(flat(knots)),
        "control": flat(control[i] for ids in patches for i in ids), "patches": [], "places": [], "point": [], "first": [], "second": [],
    }
    for _ in range(PLACES):
        patch = rng.randrange(len(triangles))
        r, s = sorted(rng.sample(range(1, 256), 2))
        weights = (F(r, 256), F(s - r, 256), F(256 - s, 256))
        u = tuple(sum(w * vertices[v][x] for w, v in zip(weights, triangles[patch])) for x in range(2))
        u = tuple(F(float(x)) for x in u)
        order = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]
        sums, memo = {o: [F(0)] * 3 for o in order}, {}
        for t, ids in zip(triangles, patches):
            for beta, i in zip(multi_indices(degree), ids):
                own = [knots[t[k]][: beta[k] + 1] for k in range(3)]
                d = abs(cross(*(of[-1] for of in own)))
                basis = jet(flat(own), u, 2, memo)
                for o in order:
                    for x in range(3):
                        sums[o][x] += d * basis[o] * control[i][x]
        made["patches"].append(patch)
        made["places"] += u
        made["point"] += sums[0, 0]
        made["first"] += sums[1, 0] + sums[0, 1]
        made["second"] += sums[2, 0] + sums[1, 1] + sums[0, 2]
    return made


def splines():
    """Every degree with general knots and with knots that coincide at the boundary."""
    rng = random.Random(18)
    return [(name, block(degree, name, rng)) for degree in range(1, 6) for name in ("general", "ends")]


def polynomial(degree, rng):
    """Points of a polynomial surface over the square, and what it has at other places: nothing but sums of powers."""
    powers = [(d - j, j) for d in range(degree + 1) for j in range(d + 1)]
    coefficients = [[F(rng.randint(-64, 64), 64) for _ in range(3)] for _ in powers]
    at = lambda x, y: [sum(c[k] * x**p * y**q for c, (p, q) in zip(coefficients, powers)) for k in range(3)]
    grid = [(F(i, 4), F(j, 4)) for i in range(17) for j in range(17)]
    places = [(F(rng.randint(1, 255), 64), F(rng.randint(1, 255), 64)) for _ in range(PLACES)]
    flat = lambda rows: [x for row in rows for x in row]
    return {"parameters": flat(grid), "points": flat(at(*u) for u in grid), "places": flat(places), "point": flat(at(*u) for u in places)}
