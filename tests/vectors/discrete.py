"""Discrete surfaces in 60 digits: triangles by plain cosine laws, conformal classes, Newton's method with derivatives by differences.

Nothing here comes from the project but the definition of a class (docs/notation.md, section 2)."""
from mpmath import acos, acosh, cos, cosh, exp, lu_solve, matrix, mp, mpf, pi, sin, sinh, sqrt

mp.dps = 60


def angle(space, opposite, a, b):
    if space == "e2":
        return acos((a * a + b * b - opposite * opposite) / (2 * a * b))
    if space == "h2":
        return acos((cosh(a) * cosh(b) - cosh(opposite)) / (sinh(a) * sinh(b)))
    return acos((cos(opposite) - cos(a) * cos(b)) / (sin(a) * sin(b)))


def angles(space, l):
    return [angle(space, l[k], l[(k + 1) % 3], l[(k + 2) % 3]) for k in range(3)]


def area(space, l):
    if space == "e2":
        s = sum(l) / 2
        return sqrt(s * (s - l[0]) * (s - l[1]) * (s - l[2]))
    return abs(sum(angles(space, l)) - pi)


def length(space, ei, ej, eta, ui, uj):
    xi, xj, cross = ei * exp(2 * ui), ej * exp(2 * uj), eta * exp(ui + uj)
    if space == "e2":
        return sqrt(xi + xj + 2 * cross)
    if space == "h2":
        return acosh((4 * cross + (1 + xi) * (1 + xj)) / ((1 - xi) * (1 - xj)))
    return acos((-4 * cross + (1 - xi) * (1 - xj)) / ((1 + xi) * (1 + xj)))


def weight(space, ei, ej, l, ui, uj):
    """The eta that gives an edge its length."""
    xi, xj, scale = ei * exp(2 * ui), ej * exp(2 * uj), exp(ui + uj)
    if space == "e2":
        return (l * l - xi - xj) / (2 * scale)
    if space == "h2":
        return (cosh(l) * (1 - xi) * (1 - xj) - (1 + xi) * (1 + xj)) / (4 * scale)
    return ((1 - xi) * (1 - xj) - cos(l) * (1 + xi) * (1 + xj)) / (4 * scale)


class Surface:
    def __init__(self, name, n, faces, face_edges):
        self.name, self.n, self.faces = name, n, faces
        self.face_edges, self.n_edges = face_edges, max(abs(e) for f in face_edges for e in f)
        self.ends, seen = [None] * self.n_edges, [0] * self.n_edges
        for f, e in zip(faces, face_edges):
            for k in range(3):
                ends = (f[(k + 1) % 3], f[(k + 2) % 3])
                self.ends[abs(e[k]) - 1] = ends if e[k] > 0 else ends[::-1]
                seen[abs(e[k]) - 1] += 1
        self.boundary = [any(s == 1 and v in ends for s, ends in zip(seen, self.ends)) for v in range(n)]
        self.euler = n - self.n_edges + len(faces)

    def sides(self, lengths, f):
        return [lengths[abs(e) - 1] for e in self.face_edges[f]]

    def curvature(self, space, lengths):
        k = [pi if b else 2 * pi for b in self.boundary]
        for f, corners in enumerate(self.faces):
            for v, a in zip(corners, angles(space, self.sides(lengths, f))):
                k[v] -= a
        return k

    def lengths(self, space, epsilon, eta, u):
        return [length(space, epsilon, epsilon, e, u[i], u[j]) for e, (i, j) in zip(eta, self.ends)]

    def radii(self, lengths, scheme):
        tangents = [[] for _ in range(self.n)]
        for f, corners in enumerate(self.faces):
            l = self.sides(lengths, f)
            for k, v in enumerate(corners):
                tangents[v].append((sum(l) - 2 * l[k]) / 2)
        if scheme in ("inversive", "virtual"):
            return [min(t) for t in tangents]
        return [sum(t) / len(t) for t in tangents]

    def derivative(self, space, epsilon, eta, u):
        h = mpf(10) ** -20
        columns = []
        for j in range(self.n):
            at = lambda s: self.curvature(space, self.lengths(space, epsilon, eta, [x + (s if i == j else 0) for i, x in enumerate(u)]))
            columns.append([(a - b) / (2 * h) for a, b in zip(at(h), at(-h))])
        return [[columns[j][i] for j in range(self.n)] for i in range(self.n)]


def real(x):
    return not isinstance(x, mp.mpc) and mp.isfinite(x)


def solve(surface, space, epsilon, eta, u, target):
    """Damped Newton until 40 digits stand."""
    def at(u):
        if space == "h2" and epsilon == 1 and max(u) >= 0:
            return None
        lengths = surface.lengths(space, epsilon, eta, u)
        if not all(real(l) and l > 0 for l in lengths):
            return None
        k = surface.curvature(space, lengths)
        return [t - x for t, x in zip(target, k)] if all(real(x) for x in k) else None
    residual = at(u)
    for _ in range(60):
        if max(abs(r) for r in residual) < mpf(10) ** -38:
            return u
        m = matrix(surface.derivative(space, epsilon, eta, u))
        if space == "e2":  # constants are its kernel
            for i in range(surface.n):
                for j in range(surface.n):
                    m[i, j] += 1
        step, t = lu_solve(m, matrix(residual)), mpf(1)
        while True:
            trial = [x + t * s for x, s in zip(u, step)]
            now = at(trial)
            if now and max(abs(r) for r in now) < max(abs(r) for r in residual):
                break
            t /= 2
            assert t > 1e-9, "no step"
        u, residual = trial, now
    raise AssertionError("no solution")


class Random:
    """Knuth's 64-bit congruential generator: the same on every machine."""
    def __init__(self, seed):
        self.state = seed

    def unit(self):
        self.state = (6364136223846793005 * self.state + 1442695040888963407) % 2**64
        return (self.state >> 11) / 2.0**53


def grid_torus(n):
    faces, face_edges = [], []
    at = lambda i, j: (i % n) * n + j % n
    for i in range(n):
        for j in range(n):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            along = lambda v: 3 * v + 1   # (i, j) to (i+1, j)
            up = lambda v: 3 * v + 2      # (i, j) to (i, j+1)
            across = lambda v: 3 * v + 3  # (i, j) to (i+1, j+1)
            faces += [[a, b, c], [a, c, d]]
            face_edges += [[up(b), -across(a), along(a)], [-along(d), -up(a), across(a)]]
    return Surface("torus", n * n, faces, face_edges)


def octahedron():
    faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1], [5, 2, 1], [5, 3, 2], [5, 4, 3], [5, 1, 4]]
    return glued("octahedron", 6, faces)


def glued(name, n, faces):
    """A simplicial surface: edges in order of appearance."""
    number, face_edges = {}, []
    for f in faces:
        row = []
        for k in range(3):
            a, b = f[(k + 1) % 3], f[(k + 2) % 3]
            if (b, a) in number:
                row.append(-number[(b, a)])
            else:
                number[(a, b)] = len(number) + 1
                row.append(number[(a, b)])
        face_edges.append(row)
    return Surface(name, n, faces, face_edges)


def genus_two():
    """An octagon a b a' b' c d c' d' cut from its centre (vertex 1): two vertices, twelve edges, eight faces."""
    sides = [1, 2, -1, -2, 3, 4, -3, -4]
    spoke = lambda k: 5 + k % 8
    faces = [[1, 0, 0]] * 8
    face_edges = [[sides[k], -spoke(k + 1), spoke(k)] for k in range(8)]
    return Surface("genus2", 2, faces, face_edges)


def hexagon():
    return glued("disk", 7, [[6, i, (i + 1) % 6] for i in range(6)])
