"""Surfaces of constant curvature unfolded in 60 digits: places of corners, side pairings, moduli, and groups enumerated from them."""
from mpmath import acosh, cosh, exp, mp, mpc, mpf, sinh, sqrt, tanh

from discrete import angles


def third(space, p, q, l, angle):
    """The corner to the left of the segment p q, at the distance l from p under this angle; points of the plane or the Poincaré disk."""
    if space == "e2":
        return p + l * (q - p) / abs(q - p) * exp(mpc(0, angle))
    seen = (q - p) / (1 - p.conjugate() * q)
    at = tanh(l / 2) * seen / abs(seen) * exp(mpc(0, angle))
    return (at + p) / (1 + p.conjugate() * at)


def distance(space, p, q):
    if space == "e2":
        return abs(p - q)
    if space == "s2":  # seen from the south pole onto the plane
        return 2 * mp.asin(abs(p - q) / sqrt((1 + abs(p) ** 2) * (1 + abs(q) ** 2)))
    return 2 * mp.asinh(abs(p - q) / sqrt((1 - abs(p) ** 2) * (1 - abs(q) ** 2)))


def unfold(surface, space, lengths, root=0, corner=0, cut=()):
    """The corners of every face, face after face across edges from `root`, whose `corner` lies at 0; and the edges that were not crossed, those of `cut` among
    them."""
    where = {}
    for f, row in enumerate(surface.face_edges):
        for k, e in enumerate(row):
            where.setdefault(abs(e), []).append((f, k))
    l = surface.sides(lengths, root)
    a = angles(space, l)
    k = corner
    places = {root: [None] * 3}
    near, far = l[(k + 2) % 3], l[(k + 1) % 3]
    reach = (lambda x: x) if space == "e2" else (lambda x: tanh(x / 2))
    places[root][k] = mpc(0)
    places[root][(k + 1) % 3] = mpc(reach(near))
    places[root][(k + 2) % 3] = reach(far) * exp(mpc(0, a[k]))
    queue, crossed = [root], set()
    while queue:
        f = queue.pop(0)
        for k, e in enumerate(surface.face_edges[f]):
            for g, m in where[abs(e)]:
                if g in places or abs(e) in cut:
                    continue
                p, q = places[f][(k + 2) % 3], places[f][(k + 1) % 3]  # as the neighbour runs
                l = surface.sides(lengths, g)
                a = angles(space, l)
                places[g] = [None] * 3
                i, j = (m + 1) % 3, (m + 2) % 3
                places[g][i], places[g][j] = p, q
                places[g][m] = third(space, p, q, l[j], a[i])
                crossed.add(abs(e))
                queue.append(g)
    seams = []
    for e, sides in where.items():
        if e in crossed or len(sides) < 2:
            continue
        (f, k), (g, m) = sides
        seams.append((places[f][(k + 1) % 3], places[f][(k + 2) % 3], places[g][(m + 2) % 3], places[g][(m + 1) % 3]))
    return places, seams


def reduced(tau):
    """The modulus in |Re| <= 1/2, |tau| >= 1."""
    while True:
        tau = tau - mp.nint(tau.real)
        if abs(tau) >= 1:
            return tau
        tau = -1 / tau


def torus_modulus(surface, lengths):
    """The quotient of two shortest periods of a flat torus."""
    _, seams = unfold(surface, "e2", lengths)
    periods = [p - r for p, _, r, _ in seams]
    a, b = None, None
    lattice = [x for x in periods if abs(x) > mpf(10) ** -20]
    # Euclid's algorithm on the lattice: two vectors from which all others are whole combinations.
    while True:
        lattice.sort(key=abs)
        lattice = [x for x in lattice if abs(x) > mpf(10) ** -20]
        a = lattice[0]
        rest, changed = [a], False
        for x in lattice[1:]:
            less = x - a * mp.nint((x * a.conjugate()).real / abs(a) ** 2)
            changed = changed or abs(less - x) > mpf(10) ** -20
            if abs(less) > mpf(10) ** -20 and not any(min(abs(less - y), abs(less + y)) < mpf(10) ** -20 for y in rest):
                rest.append(less)
        if not changed and len(rest) == 2:
            b = rest[1]
            break
        if not changed and len(rest) > 2:
            c, d, x = rest[0], rest[1], rest[2]
            m = (x * mpc(0, 1) * c.conjugate()).real / (d * mpc(0, 1) * c.conjugate()).real
            rest[2] = x - d * mp.nint(m)
        lattice = rest
    tau = b / a
    return reduced(tau if tau.imag > 0 else -tau)


def mobius(p, q):
    """The motion z -> (a z + b) / (b' z + a') of the disk, as (a, b), that brings 0 to p and the positive axis to the way to q."""
    seen = (q - p) / (1 - p.conjugate() * q)
    turn = sqrt(seen / abs(seen))
    scale = 1 / sqrt(1 - abs(p) ** 2)
    return scale * turn, scale * p / turn


def product(m, n):
    return m[0] * n[0] + m[1] * n[1].conjugate(), m[0] * n[1] + m[1] * n[0].conjugate()


def inverse(m):
    return m[0].conjugate(), -m[1]


def traces_within(surface, lengths, cut, radius):
    """|trace| of all elements of the group of a hyperbolic surface that move corner 0 of face 0 by at most `radius`, ascending."""
    with mp.workdps(40):
        places, seams = unfold(surface, "h2", lengths, cut=cut)
        size = max(distance("h2", mpc(0), z) for corners in places.values() for z in corners)
        generators = []
        for p, q, r, s in seams:
            m = product(mobius(p, q), inverse(mobius(r, s)))
            if abs(m[1]) > mpf(10) ** -20:
                generators += [m, inverse(m)]
        # A way of this length to the base's image stays in copies whose bases are nearer than this, and copies are neighbours in it or meet in a
        # corner, around which one goes by neighbours within another size.
        moved = lambda m: float(mp.acosh(abs(m[0]) ** 2 + abs(m[1]) ** 2))
        key = lambda m: (sign := 1 if m[0].real > 1e-9 or abs(m[0].real) <= 1e-9 and m[0].imag > 0 else -1) and tuple(
            round(sign * float(x) * 1e4) for z in m for x in (z.real, z.imag))
        found, queue = {key((mpc(1), mpc(0))): (mpc(1), mpc(0))}, [(mpc(1), mpc(0))]
        while queue:
            m = queue.pop()
            for g in generators:
                n = product(m, g)
                if abs(n[1]) <= mp.sinh((radius + 2 * size) / 2) and key(n) not in found:
                    found[key(n)] = n
                    queue.append(n)
        near = [m for m in found.values() if moved(m) <= radius]
        assert min(abs(moved(m) - radius) for m in found.values()) > 1e-3, "an element on the border"
        return sorted(abs(2 * m[0].real) for m in near)


def regular_octagon(surface):
    """Lengths of the Bolza surface, cut from its centre: spokes and sides of a regular octagon with angles pi/4."""
    eighth = mp.pi / 8
    side = 2 * acosh(mp.cos(eighth) / mp.sin(eighth))
    spoke = acosh(1 / (mp.tan(eighth) ** 2))
    assert abs(cosh(side) - (cosh(spoke) ** 2 - sinh(spoke) ** 2 * mp.cos(mp.pi / 4))) < mpf(10) ** -40
    return [side] * 4 + [spoke] * (surface.n_edges - 4)
