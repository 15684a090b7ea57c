"""Cases of the formulas below the C face: single triangles, circle patterns."""
from mpmath import mp, mpf, pi

from cases import case, hexes, rounded
from discrete import angles, area, length


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
