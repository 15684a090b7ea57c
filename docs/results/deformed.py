"""Pairs of surfaces whose partners are known: a mesh and what known deformations make of it, with other numbers of vertices."""
import numpy as np

# Angle by which the ends of a bent or twisted surface are turned against each other, radians.
TURNED = np.radians(75)
# Standard deviation of the noise along normals, over the mean length of an edge.
NOISE = 0.15
# Size of the one end of a surface over that of the other.
SWOLLEN = 1.8
# Share of the sides that are cut, and where at least.
CUT, NEAREST = 0.5, 0.3


def frame(V):
    """Places along the axes of the surface, the longest first, which reaches from about -1/2 to 1/2."""
    centred = V - V.mean(0)
    _, _, axes = np.linalg.svd(centred, full_matrices=False)
    axes[2] = np.cross(axes[0], axes[1])
    placed = centred @ axes.T
    return placed / np.ptp(placed[:, 0])


def bent(V, F, _):
    x, y, z = frame(V).T
    radius, angle = 1 / TURNED, TURNED * x
    return np.stack([(radius - y) * np.sin(angle), radius - (radius - y) * np.cos(angle), z], 1), F


def twisted(V, F, _):
    x, y, z = frame(V).T
    cos, sin = np.cos(TURNED * x), np.sin(TURNED * x)
    return np.stack([x, cos * y - sin * z, sin * y + cos * z], 1), F


def noisy(V, F, random):
    sides = V[F[:, [1, 2, 0]]] - V[F]
    normals = np.zeros_like(V)
    np.add.at(normals, F, np.cross(sides[:, 0], -sides[:, 2])[:, None])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    step = NOISE * np.linalg.norm(sides, axis=2).mean()
    return V + step * random.standard_normal(len(V))[:, None] * normals, F


def swollen(V, F, _):
    """One end is larger than the other: the size s(x) changes about the middle, and the way along the axis is the integral of s."""
    x, y, z = frame(V).T
    fine = np.linspace(x.min(), x.max(), 2000)
    size = lambda at: 1 + (SWOLLEN - 1) / (1 + np.exp(-16 * at))
    along = np.concatenate([[0], np.cumsum(np.diff(fine) * size(0.5 * (fine[1:] + fine[:-1])))])
    return np.stack([np.interp(x, fine, along), size(x) * y, size(x) * z], 1), F


def remeshed(V, F, random):
    """Half of the sides are cut, each somewhere, and the faces with them: the surface stays the same."""
    middle, places = {}, list(V)
    for a, b in sorted({(min(a, b), max(a, b)) for f in F for a, b in zip(f, np.roll(f, -1))}):
        if random.random() < CUT:
            middle[a, b] = len(places)
            share = NEAREST + (1 - 2 * NEAREST) * random.random()
            places.append((1 - share) * V[a] + share * V[b])
    faces = []
    for f in F.tolist():
        cut = [middle.get((min(a, b), max(a, b))) for a, b in zip(f, f[1:] + f[:1])]
        corners = [v for pair in zip(f, cut) for v in pair if v is not None]
        # The faces beside the corners between two cuts are taken off; what is left has at most four corners.
        for k in range(3):
            before, after = cut[k - 1], cut[k]
            if before is not None and after is not None:
                faces.append([before, f[k], after])
                corners.remove(f[k])
        # From a cut, since a side that is cut has three corners in line.
        start = next((corners.index(v) for v in cut if v is not None), 0)
        corners = corners[start:] + corners[:start]
        faces += [[corners[0], corners[k], corners[k + 1]] for k in range(1, len(corners) - 1)]
    return np.array(places), np.array(faces)


KINDS = {"bent": bent, "twisted": twisted, "noisy": noisy, "swollen": swollen, "remeshed": remeshed}


def renumbered(V, F, random):
    """The surface with other numbers, and the new number of each vertex: nothing is to be learned from the old ones."""
    new = random.permutation(len(V))
    places = np.empty_like(V)
    places[new] = V
    return places, random.permutation(new[F]), new


def deformed(V, F, kind, seed):
    """Positions and faces of the deformed surface, and the partner of each vertex of the given one."""
    random = np.random.default_rng(seed)
    places, faces, new = renumbered(*KINDS[kind](V, F, random), random)
    return places, faces, new[: len(V)]
