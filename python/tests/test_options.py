"""Options arrive: every field of every struct that a caller fills is written from the option that stands for it."""

import numpy as np
import pytest

import ricci
from ricci import (
    atlases,
    bicubics,
    circle,
    covering,
    flat_maps,
    form,
    layouts,
    matching,
    mesh,
    metrics,
    moduli,
    quad_splines,
    scenes,
    shapes,
    sheets,
    soup,
    splines,
    texture_atlases,
    uniform,
)
from ricci._library import ffi
from ricci._structs import options
from ricci.targets import target_struct

FLOW = {"tolerance": 0.5, "threads": 3}
# Struct, options, and every field that they must have set: numbers, or the entries of arrays.
CASES = [
    (
        options(
            "flow_options",
            {
                **FLOW,
                "method": "gradient",
                "flips": "never",
                "max_iterations": 7,
                "max_step": 2.0,
                "fixed_edges": [4, 5],
                "step": "fixed",
                "step_size": 0.25,
                "area_normalised": True,
            },
            metrics._FLOW,
        ),
        {
            **FLOW,
            "method": 1,
            "flips": 1,
            "max_iterations": 7,
            "max_step": 2.0,
            "fixed_edges": [4, 5],
            "n_fixed_edges": 2,
            "step": 2,
            "step_size": 0.25,
            "area_normalised": 1,
        },
    ),
    (target_struct("outer"), {"kind": 7}),
    (target_struct("outer:5"), {"kind": 7, "n": 1, "vertices": [5]}),
    (target_struct({3: 0.5, 8: -1.0}), {"kind": 4, "n": 2, "vertices": [3, 8], "curvatures": [0.5, -1.0]}),
    (
        options(
            "layout_options",
            {"model": "klein", "scale": "as_solved", "cones": [1, 2], "root": 9, "threads": 2},
            layouts._LAYOUT,
        ),
        {"model": 1, "scale": 1, "cones": [1, 2], "n_cones": 2, "root": [9], "threads": 2},
    ),
    (
        options(
            "attributes",
            {"normals": [[1.0, 2, 3]], "colors": [[1.0, 0, 0, 1]], "uv": [[[0.5, 0.25]]], "corner_normals": [[[3.0, 2, 1]]]}
            | {"png": b"\x89PNG", "wrap": "clamp"},
            mesh._ATTRIBUTES,
        ),
        {"normals": [1, 2, 3], "colors": [1, 0, 0, 1], "uv": [0.5, 0.25], "corner_normals": [3, 2, 1]}
        | {"png": [0x89, 0x50], "png_size": 4, "wrap": 2},
    ),
    (
        options(
            "repair_options",
            {"weld": 0.1, "component": 2, "cut_non_manifold_edges": True, "drop_non_finite": True, "split_t_junctions": True}
            | {"mend_zero_area": True, "fill_holes": 12, "holes": [3, 4]},
            soup._REPAIR,
        ),
        {"weld": 0.1, "component": 2, "cut_non_manifold_edges": 1, "drop_non_finite": 1, "split_t_junctions": 1}
        | {"mend_zero_area": 1, "fill_holes": 12, "holes": [3, 4], "n_holes": 2},
    ),
    (
        options(
            "shape",
            {"shape": 6, "genus": 2, "n": 3, "m": 4, "a": 0.5, "b": 0.6, "c": 0.7, "p": 8, "q": 9, "points": [1 + 2j]},
            shapes._SHAPE,
        ),
        {"shape": 6, "genus": 2, "n": 3, "m": 4, "a": 0.5, "b": 0.6, "c": 0.7, "p": 8, "q": 9, "points": [1, 2], "n_points": 1},
    ),
    (
        options(
            "change_spec",
            {"change": 5, "vertex": 2, "count": 3, "amount": 0.5, "seed": 11, "centre": [1, 2, 3]},
            shapes._CHANGE,
        ),
        {"change": 5, "vertex": 2, "count": 3, "amount": 0.5, "seed": 11, "centre": [1, 2, 3]},
    ),
    (
        options(
            "circle_domain_options",
            {"flow": FLOW, "outer": 1, "centre": 5, "three": [1, 2, 3], "angles": [0.1, 0.2, 0.3], "least_loop": 20, "frame": "strip"},
            circle._CIRCLES,
        ),
        {"flow": FLOW, "outer": [1], "centre": [5], "three": [1, 2, 3], "angles": [0.1, 0.2, 0.3], "least_loop": 20, "frame": 2},
    ),
    (
        options("dart_options", {"strain_warp": 0.1, "strain_weft": 0.2, "shear": 0.3, "warp": 0.4, "budget": 5, "most": 6}, sheets._DARTS),
        {"strain_warp": 0.1, "strain_weft": 0.2, "shear": 0.3, "warp": 0.4, "budget": 5, "most": 6},
    ),
    (
        options(
            "flatten_options",
            {
                "energy": "distance",
                "conformal": 0.25,
                "tolerance": 1e-6,
                "rings": 3,
                "injective": True,
                "max_iterations": 9,
                "weights": [1, 2, 3],
                "pins": {4: [0.5, 6], 2: [7, 8]},
                "straight": [[1, 2, 3], [4, 5, 6, 7]],
            },
            flat_maps._FLATTEN,
        ),
        {
            "energy": 3,
            "conformal": 0.25,
            "tolerance": 1e-6,
            "rings": 3,
            "injective": 1,
            "max_iterations": 9,
            "weights": [1, 2, 3],
            "n_weights": 3,
            "pins": [4, 2],
            "places": [0.5, 6, 7, 8],
            "n_pins": 2,
            "straight": [1, 2, 3, 4, 5, 6, 7],
            "straight_sizes": [3, 4],
            "n_straight": 2,
        },
    ),
    (
        options("bounds_options", {"width": 0.5, "most_unknowns": 9, "degree": "linear"}, moduli._BOUNDS),
        {"width": 0.5, "most_unknowns": 9, "degree": 1},
    ),
    (options("forms_options", {"base": 4, "classes": "relative"}, form._FORMS), {"base": [4], "classes": 1}),
    (
        form._harmonic_struct(
            {"target": "rectangle", "b": [1, 2], "bc": [[0.5], [0.6]], "method": "heat", "step": 0.5, "max_iterations": 7}
        ),
        {"target": 1, "vertices": [1, 2], "n": 2, "values": [0.5, 0, 0, 0.6, 0, 0], "method": 1, "step": 0.5, "max_iterations": 7},
    ),
    (
        options(
            "uniform_options",
            {"flow": FLOW, "base": 4, "scheme": "inversive", "boundary": "straight", "corners": [1, 2], "corner_angles": [0.5, 0.6]},
            uniform._UNIFORM,
        ),
        {"flow": FLOW, "base": [4], "scheme": 1, "boundary": 1, "corners": [1, 2], "n_corners": 2, "corner_angles": [0.5, 0.6]},
    ),
    (
        options("deck_spec", {"kind": 2, "words": [[1, -2], [3]], "radius": 0.5, "depth": 2, "limit": 10}, covering._DECK),
        {"kind": 2, "letters": [1, -2, 3], "n_letters": 3, "starts": [0, 2, 3], "n_words": 2, "radius": 0.5, "depth": 2, "limit": 10},
    ),
    (
        options(
            "match_options",
            {
                "landmarks": [[1, 2]],
                "loops": [1, 0],
                "threads": 2,
                "points": {"faces": [[3, 4]], "weights": np.arange(6.0).reshape(1, 2, 3)},
                "curves": [([1, 2, 3], [4, 5])],
                "soft": [[6, 7]],
                "soft_weights": [0.5],
                "boundary": "arc_length",
                "loop_shape": "circles",
                "basis": [([1, -2], [3])],
            },
            matching._MATCH,
        ),
        {"landmarks": [1, 2], "n_landmarks": 1, "loops": [1, 0], "n_loops": 2, "threads": 2}
        | {"point_faces": [3, 4], "point_weights": [0, 1, 2, 3, 4, 5], "n_points": 1}
        | {"curves": [1, 2, 3, 4, 5], "curve_sizes": [3, 2], "n_curves": 1}
        | {"soft": [6, 7], "soft_weights": [0.5], "n_soft": 1, "boundary": 1, "loop_shape": 1}
        | {"basis": [1, -2, 3], "basis_sizes": [2, 1], "n_basis": 1},
    ),
    (
        options(
            "structure_options",
            {"flow": FLOW, "singular": 3, "radius": 0.5, "charts": "patches", "source": "form", "n_quads": 300},
            atlases._STRUCTURE,
        ),
        {"flow": FLOW, "singular": [3], "radius": 0.5, "charts": 1, "source": 1, "n_quads": 300},
    ),
    (
        options(
            "spline_spec",
            {"degree": 2, "spread": 0.25, "knots": [[[0.5, 0.6]]], "coincident": [1, 2], "creases": [[3, 4]]},
            splines._PLANE,
        ),
        {"degree": 2, "spread": 0.25, "knots": [0.5, 0.6], "coincident": [1, 2], "n_coincident": 2, "creases": [3, 4], "n_creases": 1},
    ),
    (splines._places([[0.5, 0.6]], [7]), {"parameters": [0.5, 0.6], "patches": [7], "n": 1}),
    (
        options(
            "spline_surface_options",
            {
                "control_points": 9,
                "tolerance": 0.5,
                "fairness": 0.1,
                "spread": 0.2,
                "threads": 2,
                "degree": 4,
                "rounds": 3,
                "corrections": -1,
            },
            splines._SURFACE,
        ),
        {"control_points": 9, "tolerance": 0.5, "fairness": 0.1, "spread": 0.2, "threads": 2, "degree": 4, "rounds": 3, "corrections": -1},
    ),
    (
        options("bicubic_options", {"tolerance": 0.5, "angle": 0.1, "threads": 2, "control_points": 9, "folds": True}, bicubics._BICUBIC),
        {"tolerance": 0.5, "angle": 0.1, "threads": 2, "control_points": 9, "folds": 1},
    ),
    (
        options("step_options", {"name": "part", "unit": "metre", "colours": True}, bicubics._STEP),
        {"name": b"part", "unit": 1, "colours": 1},
    ),
    (
        options(
            "texture_options", {"stretch": 1.5, "fill": 0, "page": 64, "margin": 0, "density": 8, "threads": 2}, texture_atlases._TEXTURE
        ),
        {"stretch": 1.5, "fill": -1, "page": 64, "margin": -1, "density": 8, "threads": 2},
    ),
    (options("scene_options", {"texcoord": 0, "tangents": True}, scenes._SCENE), {"texcoord": -1, "tangents": 1}),
    (
        options("quad_spline_options", {"tolerance": 0.5, "bending": 0, "threads": 2, "most_spans": 4}, quad_splines._QUAD_SPLINE),
        {"tolerance": 0.5, "bending": -1, "threads": 2, "most_spans": 4},
    ),
]
# What these structs leave to handles, or what a test of another file covers.
ELSEWHERE = {
    "target": {"curvatures", "n", "vertices"},
    "uniform_options": {"start"},
    "deck_spec": {"dirichlet"},
    "spline_places": {"threads"},
}


def name_of(struct):
    return ffi.typeof(struct._pointer).item.cname.removeprefix("struct ").removeprefix("ricci_")


@pytest.mark.parametrize(("struct", "expected"), CASES, ids=lambda case: None if isinstance(case, dict) else name_of(case))
def test_every_field_is_written(struct, expected):
    kind = ffi.typeof(struct._pointer).item
    all_fields = {field for field, _ in kind.fields if field != "size" and "reserved" not in field}
    assert set(expected) | ELSEWHERE.get(name_of(struct), set()) == all_fields
    assert struct._pointer.size == ffi.sizeof(kind)
    for field, wanted in expected.items():
        found = getattr(struct._pointer, field)
        if isinstance(wanted, dict):
            assert {key: getattr(found, key) for key in wanted} == wanted, field
        elif isinstance(wanted, list):
            assert [found[k] for k in range(len(wanted))] == wanted, field
        else:
            assert (ffi.string(found) if isinstance(wanted, bytes) else found) == wanted, field


def test_handles_are_options_too(torus):
    start = ricci.metric(torus)
    struct = options("uniform_options", {"start": start, "corners": np.int64(5)}, uniform._UNIFORM)
    assert struct._pointer.start == start._pointer
    assert struct._pointer.n_corners == 5
    domain = ricci.dirichlet(ricci.uniformize(torus))
    assert options("deck_spec", {"dirichlet": domain}, covering._DECK)._pointer.dirichlet == domain._pointer


def test_values_of_another_type_are_refused():
    with pytest.raises(ricci.ArgumentError, match="tolerance"):
        ricci.flow(ricci.make("disk", n=3), tolerance="small")
    with pytest.raises(ricci.ArgumentError, match="1 is none of gradient, newton"):
        ricci.flow(ricci.make("disk", n=3), method=1)
    with pytest.raises(ricci.ArgumentError, match="threads"):
        ricci.flow(ricci.make("disk", n=3), threads=-1)
