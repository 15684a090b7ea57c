"""Poisson's equation on a sphere and on a surface of genus 2, by the spline that is fitted to a mesh: the basis of its patches, combined by
its extraction matrix.

The functions that the extraction matrix leaves have continuous gradients across all arcs, so that they are a space for equations of the
second and of the fourth order. The answers are known. On the sphere, of spherical harmonics u of degree 3, -div grad u = 12 u. On any
surface, of a function g of space, div grad g is the trace of its second derivatives within the tangent plane and the sum of the principal
curvatures times its derivative along the normal.

    python examples/python/poisson.py [SURFACE [SIZE]]     SURFACE: sphere or genus2; SIZE: of `ricci.make`; 32 for the sphere, 4 for genus 2
"""

import sys

import numpy as np
from scipy.interpolate import BSpline
from scipy.sparse import block_array, coo_array, csr_array
from scipy.sparse.linalg import spsolve

import ricci

# Gauss points in a span, in each direction.
POINTS = 8
# The direction of a wave in space, 2 pi over its length.
WAVE = np.array([1.2, 0.7, -0.5])


def harmonic(x):
    """A harmonic polynomial of degree 3, at the points of the unit sphere nearest to `x`."""
    x = x / np.linalg.norm(x, axis=-1, keepdims=True)
    return x[..., 0] * (x[..., 0] ** 2 - 3 * x[..., 1] ** 2) + x[..., 0] * x[..., 1] * x[..., 2]


def wave(x):
    """A function of space that is no polynomial, at points."""
    return np.sin(x @ WAVE)


class Sphere:
    """A spherical harmonic on the unit sphere, of degree 3."""

    size = 32
    exact = staticmethod(harmonic)

    @staticmethod
    def mesh(size):
        return ricci.make("sphere", n=size)

    @staticmethod
    def load(spline, patch, places, points):
        """-div grad of the answer at places of a patch."""
        return 12 * harmonic(points)


class GenusTwo:
    """A plane wave of space on a surface of genus 2."""

    size = 4
    exact = staticmethod(wave)

    @staticmethod
    def mesh(size):
        return ricci.make("genus", genus=2, n=size)

    @staticmethod
    def load(spline, patch, places, points):
        """-div grad of the answer at places of a patch."""
        shape = spline.evaluate(patch, places, "shape")
        along = shape[:, :3] @ WAVE
        phase = points @ WAVE
        return (WAVE @ WAVE - along**2) * np.sin(phase) - shape[:, 3:].sum(axis=1) * along * np.cos(phase)


PROBLEMS = {"sphere": Sphere, "genus2": GenusTwo}


def line(spline, patch, along):
    """The Gauss points and weights of all spans along u or v, with the values and the slopes of the basis functions there."""
    knots, counts = spline.knots(patch, along)
    at, weights = np.polynomial.legendre.leggauss(POINTS)
    width = np.diff(knots)[:, None]
    x = (knots[:-1, None] + width * (at + 1) / 2).ravel()
    all_knots = np.repeat(knots, counts)
    basis = BSpline(all_knots, np.eye(len(all_knots) - 6), 5)
    return x, (width * weights / 2).ravel(), basis(x), basis.derivative()(x)


def of_patch(problem, spline, patch):
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
    return stiffness, weight @ values, (weight * problem.load(spline, patch, places, point)) @ values


def solved(problem, spline):
    """The coefficients of all control points: of answers with the mean 0."""
    s = spline.summary
    rows, columns, entries = [], [], []
    mean, right = np.zeros((2, s.n_control_points))
    for patch in range(s.n_patches):
        controls = spline.controls(patch).ravel()
        stiffness, integrals, loads = of_patch(problem, spline, patch)
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


def error(problem, spline, coefficients):
    """The root of the mean squared difference from the known answer, both less their means, over that of the answer."""
    off, size = [], []
    for patch in range(spline.summary.n_patches):
        (u, _, fu, _), (v, _, fv, _) = line(spline, patch, "u"), line(spline, patch, "v")
        found = fu @ coefficients[spline.controls(patch)] @ fv.T
        places = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
        exact = problem.exact(spline.evaluate(patch, places)).reshape(found.shape)
        off.append((found - exact).ravel())
        size.append(exact.ravel())
    return np.std(np.concatenate(off)) / np.std(np.concatenate(size))


def main(surface="sphere", size=None, most=4):
    """Splines with more and more spans on the same patches; returns the errors."""
    problem = PROBLEMS[surface]
    flat = ricci.seamless(problem.mesh(int(size or problem.size)))
    layout = ricci.quad_layout(flat)
    errors = []
    print("spans  free control points  distance / diagonal  error of the answer")
    for spans in range(1, most + 1):
        # No fit meets this tolerance, so that all patches get the most spans.
        spline = ricci.quad_spline(flat, layout, tolerance=1e-12, most_spans=spans)
        errors.append(float(error(problem, spline, solved(problem, spline))))
        s = spline.summary
        print(f"{s.most_spans:5} {s.n_free:20} {s.max:20.1e} {errors[-1]:20.1e}")
    return errors


if __name__ == "__main__":
    main(*sys.argv[1:3])
