"""Golden vectors (tests/vectors/README.md): what the package computes agrees with the numbers that all languages are held to."""

import json
import math
import os
from pathlib import Path

import numpy as np
import pytest

import ricci
from conftest import ROOT

VECTORS = Path(os.environ.get("RICCI_VECTORS", ROOT / "tests" / "vectors"))
# Formulas below the C face, which the Rust test alone can call.
BELOW = {"circle_pattern", "derivative"}
# Of the angles and of the area of a triangle, some units in the last place.
ROUNDING = 8 * np.finfo(float).eps


def sealed(line):
    """FNV-1a of what stands before the seal."""
    text, _, rest = line.partition(',"seal":"')
    value = 0xCBF29CE484222325
    for byte in text.encode():
        value = (value ^ byte) * 0x100000001B3 % 2**64
    return f"{value:016x}" == rest[:16]


def read():
    """Every case with its file and whether its seal holds."""
    for path in sorted(VECTORS.glob("*.json")):
        text = path.read_text()
        lines = [line for line in text.splitlines() if line.startswith('{"name"')]
        cases = json.loads(text)["cases"]
        assert len(lines) == len(cases) > 0, path
        for line, case in zip(lines, cases, strict=True):
            yield pytest.param(case, sealed(line), id=f"{path.stem}/{case['name']}")


def hexes(words):
    return np.array([float.fromhex(word) for word in words])


def number(value):
    return float.fromhex(value) if isinstance(value, str) else value


def surface(given):
    if "shape" in given:
        return ricci.make(given["shape"], **{key: number(value) for key, value in given.items() if key != "shape"})
    faces = np.array(given["faces"]).reshape(-1, 3)
    if "positions" in given:
        return ricci.Mesh(hexes(given["positions"]).reshape(-1, 3), faces)
    return ricci.Mesh.from_gluing(faces, np.array(given["face_edges"]).reshape(-1, 3), hexes(given["lengths"]), given["geometry"])


def pair(z):
    return [z.real, z.imag]


def of_faces(lengths, mesh):
    """The lengths opposite the corners of every face, from those of the edges."""
    return lengths[np.abs(mesh.face_edges) - 1]


def lengths_in(model, p, q):
    """Distances between points of the plane, the Poincaré disk, the plane under the sphere, or the Klein disk."""
    p, q = p[..., 0] + 1j * p[..., 1], q[..., 0] + 1j * q[..., 1]
    apart = np.abs(p - q)
    if model == "e2":
        return apart
    if model == "klein":
        a, b = 1 - np.abs(p) ** 2, 1 - np.abs(q) ** 2
        return np.arcsinh(np.sqrt(apart**2 - (p.conj() * q).imag ** 2) / np.sqrt(a * b))
    if model == "h2":
        return 2 * np.arcsinh(apart / np.sqrt((1 - np.abs(p) ** 2) * (1 - np.abs(q) ** 2)))
    return 2 * np.arcsin(np.minimum(1, apart / np.sqrt((1 + np.abs(p) ** 2) * (1 + np.abs(q) ** 2))))


def sides(model, uv):
    """The lengths opposite the corners of triangles, m x 3 x 2."""
    return lengths_in(model, np.roll(uv, -1, axis=1), np.roll(uv, -2, axis=1))


def solved(mesh, how):
    if how.get("without_flow"):
        return ricci.metric(mesh, space=how["space"], scheme=how["scheme"])
    target = dict(zip(how["cones"], hexes(how["curvatures"]), strict=True)) if "cones" in how else hexes(how["target"])
    flat = ricci.flow(mesh, target=target, space=how["space"], scheme=how["scheme"], flips=how["flips"])
    assert flat.converged
    return flat


def flips(how):
    return {"flow": {"flips": how["flips"]}} if "flips" in how else {}


def metric(case):
    start = ricci.metric(surface(case["mesh"]), space=case["mesh"].get("geometry", "e2"), scheme=case["options"]["scheme"])
    return {"eta": start.eta, "curvature": start.curvature}


def flow(case):
    mesh = surface(case["mesh"])
    flat = solved(mesh, case["options"])
    return {**metric(case), "u": flat.u, "sides": of_faces(flat.lengths, mesh)}


def layout(case):
    how = case["options"]
    uv = ricci.layout(solved(surface(case["mesh"]), how)).uv()
    corners = uv.reshape(-1, 2)
    return {"sides": sides(how["space"], uv), "distances": lengths_in(how["space"], corners[:1], corners)}


def uniformize(case):
    how = case["options"]
    options = {key: how[key] for key in ("scheme", "boundary", "corners") if key in how}
    mesh = surface(case["mesh"])
    found = ricci.uniformize(mesh, **options)
    assert found.converged
    summary = found.summary
    ours = {"modulus": pair(summary.modulus), "area": summary.area, "extremal_distance": summary.extremal_distance}
    if "cross_ratios" in case["expect"]:
        ours["cross_ratios"] = cross_ratios(found.sphere_points(), case["mesh"]["faces"])
    return ours


def cross_ratios(points, faces):
    """For the corners of every face: of the edge opposite, i j with k here and l across, |il| |jk| / (|lj| |ki|)."""
    faces = np.array(faces).reshape(-1, 3)
    across = {(a, b): c for f in faces for a, b, c in (f, np.roll(f, -1), np.roll(f, -2))}

    def apart(i, j):
        return np.linalg.norm(points[i] - points[j])

    return [
        apart(across[j, i], i) * apart(j, k) / (apart(across[j, i], j) * apart(k, i))
        for f in faces
        for k, i, j in (f, np.roll(f, -1), np.roll(f, -2))
    ]


def group(case):
    how = case["options"]
    found = ricci.uniformize(surface(case["mesh"]), scheme=how["scheme"], **flips(how), **({"base": how["base"]} if "base" in how else {}))
    assert found.converged
    near = ricci.deck(found, kind="within", dirichlet=ricci.dirichlet(found), radius=number(how["radius"]))
    return {"traces": np.sort(near.traces)}


def circles(case):
    found = ricci.circles(surface(case["mesh"]), **case["options"])
    assert found.converged
    by_radius = np.argsort(-found.circles[:, 2])
    return {"modulus": [found.summary.modulus.imag], "circles": found.circles[by_radius, :3]}


def harmonic(case):
    how = case["options"]
    given = {"b": how["vertices"], "bc": hexes(how["values"]).reshape(-1, 3)} if how["to"] == "values" else {"target": how["to"]}
    points = ricci.harmonic(surface(case["mesh"]), **given)
    return {"points": points, "radii": np.hypot(points[:, 0], points[:, 1])}


def forms(case):
    found = ricci.forms(surface(case["mesh"]))
    return {"modulus": pair(found.summary.modulus), "absolute": np.sort(np.abs(found.values[0]))}


def structure(case):
    kind = case["options"]["kind"]
    found = ricci.structure(surface(case["mesh"]), kind=kind, **flips(case["options"]))
    model = {"affine": "e2", "hyperbolic": "h2", "projective": "klein", "spherical": "s2", "conformal": "e2"}[kind]
    shown = np.full((len(found.F), 3), np.nan)
    for chart, (faces, corners) in enumerate(zip(found.chart_faces, found.chart_corners, strict=True)):
        points = found.coordinates(chart)
        for face, at in zip(faces, corners.reshape(-1, 3), strict=True):
            if np.isnan(shown[face, 0]):
                shown[face] = sides(model, points[at][None])[0]
    carried = 0.0
    for face in range(len(found.F)):
        first, *others = found.places(face, [0.5, 0.25, 0.25])
        for other in others:
            moved = found.carry(first, other, [[first.x, first.y]])[0]
            carried = max(carried, np.abs(moved - [other.x, other.y]).max())
    return {"sides": shown, "carried": [carried]}


def spline(case):
    how = case["options"]
    flat = ricci.Spline.plane(surface(case["mesh"]), degree=how["degree"], knots=hexes(how["knots"]))
    given = hexes(how["control"]).reshape(*flat.controls.shape, 3)
    points = np.empty((flat.summary.n_control_points, 3))
    points[flat.controls] = given
    assert np.array_equal(points[flat.controls], given), "control points that are one have one place"
    found = flat.with_points(points).evaluate(hexes(how["places"]).reshape(-1, 2), patches=how["patches"], what="second")
    return {"point": found[:, :1], "first": found[:, 1:3], "second": found[:, 3:]}


def fit(case):
    how = case["options"]
    flat = ricci.Spline.plane(surface(case["mesh"]), degree=how["degree"])
    near = flat.fit(hexes(how["points"]).reshape(-1, 3), hexes(how["parameters"]).reshape(-1, 2), fairness=-1.0)
    return {"point": near.evaluate(hexes(how["places"]).reshape(-1, 2))}


def surface_fit(case):
    how, mesh = case["options"], surface(case["mesh"])
    found = ricci.Spline.of_surface(ricci.flow(mesh), degree=how["degree"], control_points=how["control_points"])
    V = found.tessellate(3).V
    big, small = number(case["mesh"]["a"]), number(case["mesh"]["b"])
    return {"distance": [np.abs(np.hypot(np.hypot(V[:, 0], V[:, 1]) - big, V[:, 2]) - small).max()]}


def match(case):
    how, target = case["options"], surface(case["target"])
    options = {"boundary": how["boundary"]} if "boundary" in how else {}
    found = ricci.match(surface(case["mesh"]), target, landmarks=np.array(how["landmarks"]).reshape(-1, 2), **options)
    return {"images": found.carry(target.V)}


def triangle(case):
    """A triangle is a surface whose curvature at a corner is pi minus its angle; what the C face has of one.

    In the hyperbolic plane its lengths go through the variables of the class, whose rounding weighs the more the less the two shorter sides
    have over the longest: by the root of that at angles, by itself in the area. The tolerances are other ones than those of the formulas.
    """
    how = case["options"]
    mesh = ricci.Mesh.from_gluing([[0, 1, 2]], [[1, 2, 3]], hexes(how["lengths"]), how["space"])
    start = ricci.metric(mesh, space=how["space"])
    *shorter, longest = np.sort(hexes(how["lengths"]))
    spare = min(1, 2 * math.fsum([*shorter, -longest]) / longest) if how["space"] == "h2" else 1
    case["expect"]["angles"]["tolerance"] = ROUNDING / math.sqrt(spare)
    case["expect"]["area"]["tolerance"] = ROUNDING / spare * number(case["expect"]["area"]["values"][0])
    return {"angles": np.pi - start.curvature, "area": start.summary.area}


CALLS = {
    made.__name__: made
    for made in (metric, flow, layout, uniformize, group, circles, harmonic, forms, structure, spline, fit, surface_fit, match, triangle)
}


def agree(case):
    """Hold a case against what the library computes."""
    ours = CALLS[case["call"]](case)
    for quantity, expected in case["expect"].items():
        found, values = np.ravel(ours[quantity]), hexes(expected["values"])
        assert found.shape == values.shape, quantity
        error = np.abs(found - values).max()
        assert error <= expected["tolerance"], f"{case['name']}: {quantity} is off by {error:.2e}, {expected['tolerance']:.2e} is allowed"


@pytest.mark.parametrize(("case", "intact"), list(read()))
def test_cases_agree(case, intact):
    assert case["because"]
    assert intact, f"{case['name']}: what is written is not what was sealed"
    if case["call"] not in BELOW:
        agree(case)


def test_every_capability_has_cases():
    calls = {param.values[0]["call"] for param in read()}
    assert calls == BELOW | CALLS.keys()
