"""Small surfaces for the vectors: Delaunay triangulations of points by the definition, convex polyhedra inscribed in the sphere, rings, disks."""
from fractions import Fraction as F
from math import cos, exp, hypot, log, pi, sin, sqrt

from discrete import glued


def circle(p, q, r):
    """Centre and squared radius of the circle through three points of the plane."""
    ax, ay, bx, by = q[0] - p[0], q[1] - p[1], r[0] - p[0], r[1] - p[1]
    d = 2 * (ax * by - ay * bx)
    if abs(d) < 1e-12:
        return None
    x = (by * (ax * ax + ay * ay) - ay * (bx * bx + by * by)) / d
    y = (ax * (bx * bx + by * by) - bx * (ax * ax + ay * ay)) / d
    return p[0] + x, p[1] + y, x * x + y * y


def delaunay(points, holes=()):
    """Triangles whose circles are empty, counterclockwise; none within a set of `holes`, whose points lie on a circle each."""
    n, triangles = len(points), []
    for i in range(n):
        for j in range(i + 1, n):
            for k in range(j + 1, n):
                if any({i, j, k} <= hole for hole in holes):
                    continue
                found = circle(points[i], points[j], points[k])
                if found is None:
                    continue
                x, y, square = found
                if all(m in (i, j, k) or hypot(points[m][0] - x, points[m][1] - y) ** 2 > square for m in range(n)):
                    (a, b), (c, d), (e, f) = points[i], points[j], points[k]
                    left = (c - a) * (f - b) - (d - b) * (e - a) > 0
                    triangles.append([i, j, k] if left else [i, k, j])
    return triangles


def scattered(random, n, free):
    """Points of the unit disk that are far from each other and from those given: each the best of many tries."""
    points = list(free)
    for _ in range(n):
        tries = []
        for _ in range(400):
            r, t = sqrt(random.unit()), 2 * pi * random.unit()
            p = (r * cos(t), r * sin(t))
            tries.append((min(hypot(p[0] - q[0], p[1] - q[1]) for q in points), p))
        points.append(max(tries)[1])
    return points


def disk(random, rim, inside):
    """A round disk."""
    points = scattered(random, inside, [(cos(2 * pi * k / rim), sin(2 * pi * k / rim)) for k in range(rim)])
    return points, glued("disk", len(points), delaunay(points))


def ring(around, steps):
    """A plane ring of nearly equilateral triangles about the origin, from the inner circle of radius 1 outwards: all triangles are similar."""
    factor = exp(sqrt(3) * pi / around)
    points = [(factor**k * cos(2 * pi * (j + k / 2) / around), factor**k * sin(2 * pi * (j + k / 2) / around))
              for k in range(steps + 1) for j in range(around)]
    faces = []
    for k in range(steps):
        for j in range(around):
            a, b = k * around + j, k * around + (j + 1) % around
            c, d = a + around, (k + 1) * around + (j + 1) % around
            faces += [[a, c, b], [b, c, d]]
    return points, glued("ring", len(points), faces), steps * log(factor) / (2 * pi)


def wheel(around, steps):
    """A ring whose inner loop is filled from the origin, the last vertex."""
    points, surface, _ = ring(around, steps)
    faces = surface.faces + [[len(points), j, (j + 1) % around] for j in range(around)]
    return points + [(0.0, 0.0)], glued("wheel", len(points) + 1, faces)


def holed(random, rim, holes, around, inside):
    """The unit disk without round holes (x, y, radius): points on the rim, on the holes, then inside."""
    ring = lambda x, y, r, n, turn: [(x + r * cos(2 * pi * (k + turn) / n), y + r * sin(2 * pi * (k + turn) / n)) for k in range(n)]
    points, sets = ring(0.0, 0.0, 1.0, rim, 0), []
    for x, y, r in holes:
        sets.append(set(range(len(points), len(points) + around)))
        points += ring(x, y, r, around, 0.3)
    # A second ring beside each circle, so that no edge of a circle lies opposite an obtuse angle.
    points += ring(0.0, 0.0, exp(-sqrt(3) * pi / rim), rim, 0.5)
    for x, y, r in holes:
        points += ring(x, y, r * exp(sqrt(3) * pi / around), around, 0.8)
    out = lambda p: hypot(*p) < 0.75 and all(hypot(p[0] - x, p[1] - y) > 1.5 * r for x, y, r in holes)
    for _ in range(inside):
        tries = []
        while len(tries) < 300:
            p = (2 * random.unit() - 1, 2 * random.unit() - 1)
            if out(p):
                tries.append((min(hypot(p[0] - q[0], p[1] - q[1]) for q in points), p))
        points.append(max(tries)[1])
    return points, glued("holed", len(points), delaunay(points, sets)), sets


def torus(random, n, m):
    """A torus of revolution, its vertices moved a little."""
    points, faces = [], []
    at = lambda i, j: (i % n) * m + j % m
    for i in range(n):
        for j in range(m):
            s, t = 2 * pi * i / n, 2 * pi * j / m
            r = 2 + cos(t)
            points.append(tuple(float(x + 0.1 * random.unit()) for x in (r * cos(s), r * sin(s), sin(t))))
            faces += [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
    return points, glued("torus", n * m, faces)


def inscribed(random, n):
    """A convex polyhedron with `n` vertices on the unit sphere, far from each other; faces counterclockwise from outside."""
    points = []
    for _ in range(n):
        tries = []
        for _ in range(300):
            z, t = 2 * random.unit() - 1, 2 * pi * random.unit()
            p = (sqrt(1 - z * z) * cos(t), sqrt(1 - z * z) * sin(t), z)
            tries.append((min([4.0] + [sum((a - b) ** 2 for a, b in zip(p, q)) for q in points]), p))
        points.append(max(tries)[1])
    return points, hull(points)


def hull(points):
    """The faces of a convex polyhedron with these vertices."""
    n = len(points)
    faces = []
    for i in range(n):
        for j in range(n):
            for k in range(n):
                if i < min(j, k) and j != k:
                    u, v = [[points[m][x] - points[i][x] for x in range(3)] for m in (j, k)]
                    w = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
                    if all(m in (i, j, k) or sum(w[x] * (points[m][x] - points[i][x]) for x in range(3)) < 0 for m in range(n)):
                        faces.append([i, j, k])
    assert len(faces) == 2 * n - 4
    return glued("polyhedron", n, faces)


def turned(points):
    """Turned in space by rational angles, so that it is exact where the points are."""
    a, b, c, d = F(3, 5), F(4, 5), F(5, 13), F(12, 13)
    rows = ((a, -b, F(0)), (c * b, c * a, -d), (d * b, d * a, c))
    return [tuple(float(sum(r * F(x) for r, x in zip(row, p))) for row in rows) for p in points]
