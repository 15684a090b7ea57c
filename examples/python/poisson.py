"""Poisson's equation on a sphere, by the spline that is fitted to a mesh: the basis of its patches, combined by its extraction matrix.

The functions that the extraction matrix leaves have continuous gradients across all arcs, so that they are a space for equations of the
second and of the fourth order. The answer is known: of spherical harmonics u of degree 3, -div grad u = 12 u.

    python examples/python/poisson.py [SIZE]          SIZE: parts of the edges of the icosahedron; 32
"""

import sys

import numpy as np
from scipy.interpolate import BSpline
from scipy.sparse import block_array, coo_array, csr_array
from scipy.sparse.linalg import spsolve

import ricci

# Gauss points in a span, in each direction.
POINTS = 8


def harmonic(x):
    """A harmonic polynomial of degree 3, at the points of the unit sphere nearest to `x`."""
    x = x / np.linalg.norm(x, axis=-1, keepdims=True)
    return x[..., 0] * (x[..., 0] ** 2 - 3 * x[..., 1] ** 2) + x[..., 0] * x[..., 1] * x[..., 2]


def line(spline, patch, along):
    """The Gauss points and weights of all spans along u or v, with the values and the slopes of the basis functions there."""
    knots, counts = spline.knots(patch, along)
    at, weights = np.polynomial.legendre.leggauss(POINTS)
    width = np.diff(knots)[:, None]
    x = (knots[:-1, None] + width * (at + 1) / 2).ravel()
    all_knots = np.repeat(knots, counts)
    basis = BSpline(all_knots, np.eye(len(all_knots) - 6), 5)
    return x, (width * weights / 2).ravel(), basis(x), basis.derivative()(x)


def of_patch(spline, patch):
    """Stiffness, the integrals of the basis functions, and those with the right-hand side, over the basis of one patch."""
    (u, wu, fu, du), (v, wv, fv, dv) = line(spline, patch, "u"), line(spline, patch, "v")
    places = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
    point, by_u, by_v = spline.evaluate(patch, places, "first").transpose(1, 0, 2)
    values = np.einsum("pi,qj->pqij", fu, fv).reshape(len(places), -1)
    slopes = np.stack([np.einsum("pi,qj->pqij", du, fv), np.einsum("pi,qj->pqij", fu, dv)]).reshape(2, *values.shape)
    e, f, g = (np.einsum("px,px->p", a, b) for a, b in ((by_u, by_u), (by_u, by_v), (by_v, by_v)))
    area = np.sqrt(e * g - f * f)
    weight = np.outer(wu, wv).ravel() * area
    inverse = np.array([[g, -f], [-f, e]]) / area**2
    stiffness = np.einsum("p,abp,api,bpj->ij", weight, inverse, slopes, slopes, optimize=True)
    return stiffness, weight @ values, (weight * 12 * harmonic(point)) @ values


def solved(spline):
    """The coefficients of all control points."""
    s = spline.summary
    rows, columns, entries = [], [], []
    mean, right = np.zeros((2, s.n_control_points))
    for patch in range(s.n_patches):
        controls = spline.controls(patch).ravel()
        stiffness, integrals, loads = of_patch(spline, patch)
        rows.append(np.repeat(controls, len(controls)))
        columns.append(np.tile(controls, len(controls)))
        entries.append(stiffness.ravel())
        np.add.at(mean, controls, integrals)
        np.add.at(right, controls, loads)
    square = (s.n_control_points, s.n_control_points)
    stiffness = coo_array((np.concatenate(entries), (np.concatenate(rows), np.concatenate(columns))), shape=square)
    starts, numbers, values = spline.extraction
    free = csr_array((values, numbers, starts), shape=(s.n_control_points, s.n_free))
    # The constants are taken out by one more equation: the mean is 0.
    edge = csr_array((free.T @ mean)[None])
    system = block_array([[free.T @ stiffness.tocsr() @ free, edge.T], [edge, None]], format="csc")
    return free @ spsolve(system, np.append(free.T @ right, 0))[:-1]


def error(spline, coefficients):
    """The root of the mean squared difference from the known answer, over that of the answer."""
    off, size = 0.0, 0.0
    for patch in range(spline.summary.n_patches):
        (u, _, fu, _), (v, _, fv, _) = line(spline, patch, "u"), line(spline, patch, "v")
        found = fu @ coefficients[spline.controls(patch)] @ fv.T
        places = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
        exact = harmonic(spline.evaluate(patch, places)).reshape(found.shape)
        off += ((found - exact) ** 2).sum()
        size += (exact**2).sum()
    return np.sqrt(off / size)


def main(size=32, most=4):
    """Splines with more and more spans on the same patches; returns the errors."""
    flat = ricci.seamless(ricci.make("sphere", n=size))
    layout = ricci.quad_layout(flat)
    errors = []
    print("spans  free control points  distance / diagonal  error of the answer")
    for spans in range(1, most + 1):
        # No fit meets this tolerance, so that all patches get the most spans.
        spline = ricci.quad_spline(flat, layout, tolerance=1e-12, most_spans=spans)
        errors.append(float(error(spline, solved(spline))))
        s = spline.summary
        print(f"{s.most_spans:5} {s.n_free:20} {s.max:20.1e} {errors[-1]:20.1e}")
    return errors


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]))
