"""What a file of quads is, beside the mesh it was made from: manifold, topology, shape, distance, sharp edges. Needs numpy and scipy."""

import functools

import numpy as np
import page
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

# Sharp edges turn by more than this, degrees, and are kept where edges of quads are within these shares of the diagonal.
SHARP = 40
NEAR = [1e-3, 3e-3]
# Samples of a quarter of a quad, by which the nearest ones are looked for, and how many of those are measured exactly.
SAMPLES = [(1 / 3, 1 / 3), (0.1, 0.1), (0.8, 0.1), (0.1, 0.8), (0.45, 0.45), (0.1, 0.45), (0.45, 0.1)]
NEAREST = 12


def arrays(path):
    """The positions and the triangles of a mesh."""
    places, faces = page.read_obj(path)
    return np.array(places), np.array(faces)


def judged(path, mesh, sharp):
    """What a file of faces is, beside the mesh that it was made from."""
    places, faces = page.read_obj(path)
    if not faces:
        return {"error": "a file without faces"}
    V = np.array(places)
    n = np.array([len(f) for f in faces])
    tail = np.array([v for f in faces for v in f])
    first = np.cumsum(n) - n
    face = np.repeat(np.arange(len(n)), n)
    turn = np.arange(len(tail)) - first[face]
    after = first[face] + (turn + 1) % n[face]
    before = first[face] + (turn - 1) % n[face]
    head = tail[after]
    if not np.isfinite(V[np.unique(tail)]).all():
        return {"error": "coordinates that are no numbers"}
    known = connected(tail, head, face, after)
    repeated = len({(f, v) for f, v in zip(face.tolist(), tail.tolist(), strict=True)}) < len(tail)
    known["manifold"] = bool(known["manifold"] and not repeated)
    known["topology"] = (known["parts"], known["loops"], known["euler"]) == (1, page.loops(mesh), page.euler(mesh))
    known |= {"faces": len(n), "quads": float((n == 4).mean()), "pure": bool((n == 4).all() and not repeated)}
    known["angle"], known["angle_most"] = angles(V[tail], V[tail[before]], V[head], n[face] == 4)
    ends = np.unique(np.sort(np.column_stack([tail, head]), axis=1), axis=0)
    lengths = np.linalg.norm(V[ends[:, 0]] - V[ends[:, 1]], axis=1)
    known["edges"] = float(lengths.std() / lengths.mean())
    given = Given.of(page.file_of(mesh))
    middles = np.add.reduceat(V[tail], first) / n[:, None]
    far = distances(given.V, np.stack([middles[face], V[tail], V[head]], axis=1)) / given.size
    known["distance"], known["distance_most"] = float(np.sqrt((far**2).mean())), float(far.max())
    if sharp:
        known["kept"] = given.kept(V[ends])
    return known


def connected(tail, head, face, after):
    """Whether faces make a manifold, its parts, loops, Euler characteristic and irregular vertices, from their sides."""
    ends, side = np.unique(np.sort(np.column_stack([tail, head]), axis=1), axis=0, return_inverse=True)
    side = side.ravel()
    uses = np.bincount(side)
    order = np.argsort(side, kind="stable")
    starts = np.cumsum(uses) - uses
    c, d = order[starts[uses == 2]], order[starts[uses == 2] + 1]
    opposite = tail[c] == head[d]
    beside = np.concatenate([np.where(opposite, after[d], d), np.where(opposite, d, after[d])])
    at = pieces(len(tail), np.concatenate([c, after[c]]), beside)
    vertices = np.unique(tail)
    rim = ends[uses == 1]
    border = np.unique(rim)
    loops = pieces(len(border), *np.searchsorted(border, rim).T) if len(rim) else 0
    inside = np.setdiff1d(vertices, border)
    valence, corners = np.bincount(ends.ravel()), np.bincount(tail)
    return {
        "manifold": bool(uses.max() <= 2 and opposite.all() and at == len(vertices)),
        "parts": pieces(int(face.max()) + 1, face[c], face[d]),
        "loops": loops,
        "euler": len(vertices) - len(ends) + int(face.max()) + 1,
        "irregular": int((valence[inside] != 4).sum() + (corners[border] != 2).sum()),
    }


def pieces(n, a, b):
    """The number of connected pieces of a graph."""
    return int(connected_components(coo_array((np.ones(len(a)), (a, b)), shape=(n, n)), directed=False)[0])


def angles(at, before, after, counted):
    """Mean and largest deviation of corners from 90°, degrees; a side without length is as far off as can be."""
    p, q = (before - at)[counted], (after - at)[counted]
    if not len(p):
        return 0.0, 0.0
    with np.errstate(all="ignore"):
        cosines = (p * q).sum(1) / np.linalg.norm(p, axis=1) / np.linalg.norm(q, axis=1)
    off = np.abs(np.degrees(np.arccos(np.clip(np.nan_to_num(cosines, nan=1.0), -1, 1))) - 90)
    return float(off.mean()), float(off.max())


def distances(points, triangles):
    """Of points from the nearest of triangles: exactly, of those whose samples are nearest."""
    a, p, q = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    tree = cKDTree(np.concatenate([a + s * p + t * q for s, t in SAMPLES]))
    _, near = tree.query(points, k=NEAREST)
    near %= len(triangles)
    best = np.full(len(points), np.inf)
    for column in near.T:
        best = np.minimum(best, from_triangles(points, triangles[column]))
    return best


def from_triangles(x, triangles):
    """The distance of each point from its triangle."""
    a, b, c = triangles.transpose(1, 0, 2)
    best = np.minimum(np.minimum(from_segments(x, a, b), from_segments(x, b, c)), from_segments(x, c, a))
    p, q, r = b - a, c - a, x - a
    pp, pq, qq, pr, qr = ((s * t).sum(1) for s, t in ((p, p), (p, q), (q, q), (p, r), (q, r)))
    det = pp * qq - pq**2
    with np.errstate(all="ignore"):
        s, t = (qq * pr - pq * qr) / det, (pp * qr - pq * pr) / det
    over = (det > 0) & (s >= 0) & (t >= 0) & (s + t <= 1)
    s, t = np.where(over, s, 0.0), np.where(over, t, 0.0)
    return np.where(over, np.linalg.norm(r - s[:, None] * p - t[:, None] * q, axis=1), best)


def from_segments(x, a, b):
    """The distance of each point from its segment."""
    along = b - a
    square = (along**2).sum(1)
    t = np.clip(((x - a) * along).sum(1) / np.where(square > 0, square, 1.0), 0, 1)
    return np.linalg.norm(x - a - t[:, None] * along, axis=1)


class Given:
    """A mesh that quads are made of: its vertices, the diagonal of its box and its sharp edges."""

    def __init__(self, path):
        self.V, self.F = arrays(path)
        self.size = float(np.linalg.norm(np.ptp(self.V, axis=0)))

    @staticmethod
    @functools.lru_cache(maxsize=1)
    def of(path):
        """The mesh of a file; the last one is kept."""
        return Given(path)

    @functools.cached_property
    def sharp(self):
        """The ends of the edges at which the surface turns by more than SHARP."""
        a, b, c = self.V[self.F].transpose(1, 0, 2)
        normals = np.cross(b - a, c - a)
        normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
        sides = np.sort(np.concatenate([self.F[:, [0, 1]], self.F[:, [1, 2]], self.F[:, [2, 0]]]), axis=1)
        faces = np.tile(np.arange(len(self.F)), 3)
        order = np.lexsort(sides.T)
        sides, faces = sides[order], faces[order]
        pair = np.flatnonzero((sides[1:] == sides[:-1]).all(1))
        turns = (normals[faces[pair]] * normals[faces[pair + 1]]).sum(1) < np.cos(np.radians(SHARP))
        return self.V[sides[pair[turns]]]

    def kept(self, edges):
        """The shares of the length of sharp edges that lie beside edges of quads, nearer and farther; None where none is sharp."""
        if not len(self.sharp):
            return None
        points, weights, _ = along(self.sharp, self.size * NEAR[0])
        samples, _, which = along(edges, self.size * NEAR[0] / 2)
        _, nearest = cKDTree(samples).query(points, k=min(8, len(samples)))
        best = np.full(len(points), np.inf)
        for column in which[nearest].T:
            best = np.minimum(best, from_segments(points, *edges[column].transpose(1, 0, 2)))
        return [float(weights[best <= self.size * near].sum() / weights.sum()) for near in NEAR]


def along(segments, step):
    """Points on segments at most a step apart, the length that each stands for, and its segment."""
    lengths = np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1)
    n = np.maximum(np.ceil(lengths / step), 1).astype(int)
    which = np.repeat(np.arange(len(n)), n)
    t = (np.arange(len(which)) - (np.cumsum(n) - n)[which] + 0.5) / n[which]
    points = segments[which, 0] + t[:, None] * (segments[which, 1] - segments[which, 0])
    return points, (lengths / n)[which], which
