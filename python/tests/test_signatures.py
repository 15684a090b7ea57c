"""Signatures: every option stands in the head of its function, with the type and the default that the struct of the C face has."""

import ast
import importlib
import inspect
import pickle
import pkgutil

import pytest

import ricci
import signatures
from ricci import (
    atlases,
    bicubics,
    circle,
    covering,
    form,
    layouts,
    matching,
    mesh,
    metrics,
    moduli,
    quad_meshes,
    quad_splines,
    scenes,
    seams,
    shapes,
    soup,
    splines,
    texture_atlases,
    uniform,
)
from ricci._library import ffi
from ricci._structs import options

MODULES = [
    importlib.import_module(found.name)
    for found in pkgutil.walk_packages(ricci.__path__, "ricci.")
    # Neither the declarations for cffi nor the library itself, which has the ending of a module.
    if not found.name.rpartition(".")[2].startswith(("_native", "libricci"))
]
KINDS = {
    name: value
    for module in MODULES
    for name, value in vars(module).items()
    if isinstance(value, type) and hasattr(value, "__total__") and value.__module__ == module.__name__
}
# The struct of each kind of options, the fields that options of other names fill, and these options.
STRUCTS = {
    "Attributes": ("attributes", {"png_size"}, set()),
    "BicubicOptions": ("bicubic_options", set(), set()),
    "BoundsOptions": ("bounds_options", set(), set()),
    "ChangeOptions": ("change_spec", {"change"}, set()),
    "CircleOptions": ("circle_domain_options", set(), set()),
    "DartOptions": ("dart_options", set(), set()),
    "DeckSpec": ("deck_spec", {"letters", "n_letters", "starts"}, {"words"}),
    "FlattenOptions": ("flatten_options", {"places", "straight_sizes"}, set()),
    "FlowJob": ("flow_options", set(), {"space", "scheme"}),
    "FlowOptions": ("flow_options", set(), set()),
    "FormsOptions": ("forms_options", set(), set()),
    "HarmonicOptions": ("harmonic_spec", {"vertices", "values"}, {"b", "bc"}),
    "LayoutOptions": ("layout_options", set(), set()),
    "MatchOptions": ("match_options", {"point_faces", "point_weights", "curve_sizes", "basis_sizes"}, {"points", "mirror"}),
    "PlaneOptions": ("spline_spec", set(), set()),
    "QuadSplineOptions": ("quad_spline_options", set(), set()),
    "QuadsOptions": ("quads_options", {"sizing"}, {"coarse", "at_most"}),
    "RepairOptions": ("repair_options", set(), set()),
    "SceneOptions": ("scene_options", set(), set()),
    "SeamlessOptions": ("seamless_options", {"vertices", "valences", "stroke_vertices"}, set()),
    "SeamlessFlatOptions": (
        "flatten_options",
        {"injective", "n_pins", "n_straight", "pins", "places", "rings", "straight", "straight_sizes"},
        set(),
    ),
    "ShapeOptions": ("shape", {"shape"}, set()),
    "SphereFlatOptions": (
        "flatten_options",
        {"injective", "n_pins", "n_straight", "pins", "places", "rings", "straight", "straight_sizes"},
        set(),
    ),
    "StepOptions": ("step_options", set(), set()),
    "StructureOptions": ("structure_options", set(), set()),
    "SurfaceOptions": ("spline_surface_options", set(), set()),
    "TextureOptions": ("texture_options", set(), set()),
    "UniformOptions": ("uniform_options", set(), set()),
}
WITHOUT = {"CohortOptions", "CoverOptions", "Points"}
WRITERS = {
    "BicubicOptions": bicubics._BICUBIC,
    "BoundsOptions": moduli._BOUNDS,
    "CircleOptions": circle._CIRCLES,
    "DeckSpec": covering._DECK,
    "FlowOptions": metrics._FLOW,
    "FormsOptions": form._FORMS,
    "LayoutOptions": layouts._LAYOUT,
    "MatchOptions": matching._MATCH,
    "PlaneOptions": splines._PLANE,
    "QuadSplineOptions": quad_splines._QUAD_SPLINE,
    "QuadsOptions": quad_meshes._QUADS,
    "RepairOptions": soup._REPAIR,
    "SceneOptions": scenes._SCENE,
    "SeamlessOptions": seams._SEAMLESS,
    "StepOptions": bicubics._STEP,
    "StructureOptions": atlases._STRUCTURE,
    "SurfaceOptions": splines._SURFACE,
    "TextureOptions": texture_atlases._TEXTURE,
    "UniformOptions": uniform._UNIFORM,
    "Attributes": mesh._ATTRIBUTES,
    "ShapeOptions": shapes._SHAPE,
    "ChangeOptions": shapes._CHANGE,
}


def fields_of(struct):
    return {name: field.type for name, field in ffi.typeof(f"ricci_{struct}").fields if name != "size" and "reserved" not in name}


def public_functions():
    """All functions of the package, and methods of its classes, that a user calls, by their names."""
    for name in ricci.__all__:
        value = getattr(ricci, name)
        if inspect.isfunction(value):
            yield name, value
        elif inspect.isclass(value) and not issubclass(value, Exception | dict):
            for member in [m for m in dir(value) if not m.startswith("_") or m == "__init__"]:
                found = inspect.getattr_static(value, member)
                found = found.__func__ if isinstance(found, classmethod | staticmethod) else found
                if inspect.isfunction(found) and found.__module__.startswith("ricci"):
                    yield f"{name}.{member}", found


def test_heads_have_the_options_of_their_kinds():
    """`python signatures.py --write` makes them so."""
    count = 0
    for module in MODULES:
        source = inspect.getsource(module)
        if "@takes(" in source:
            count += source.count("@takes(")
            assert ast.dump(ast.parse(signatures.rewritten(source, module))) == ast.dump(ast.parse(source)), module.__name__
    assert count > 25


def test_no_function_hides_its_options():
    hidden = {name for name, of in public_functions() if any(p.kind is p.VAR_KEYWORD for p in inspect.signature(of).parameters.values())}
    # The names of these are the caller's own, of fields.
    assert hidden == {"to_gifti", "to_meshio", "to_polyscope", "to_pyvista", "to_trimesh"}


def test_every_argument_has_a_type():
    for name, function in public_functions():
        for argument in inspect.signature(function).parameters.values():
            assert argument.name in ("self", "cls") or argument.annotation is not argument.empty, (name, argument.name)


def test_every_kind_is_compared_with_its_struct():
    assert set(KINDS) == set(STRUCTS) | WITHOUT


@pytest.mark.parametrize("name", STRUCTS)
def test_options_are_the_fields_of_their_struct(name):
    struct, filled, others = STRUCTS[name]
    kind, fields = KINDS[name], fields_of(struct)
    own = set(kind.__annotations__) - others
    counts = {f"n_{option}" for option in kind.__annotations__}
    assert own <= set(fields)
    assert set(fields) - own - counts == filled
    for option in own:
        field, told = fields[option], signatures.annotation_of(kind, option)
        if field.kind == "primitive" and field.cname in ("double", "float"):
            assert told == "float", option
        elif field.kind == "primitive":
            assert "int" in told or told == "bool" or told.startswith("Literal") or told in signatures.NAMES, option


@pytest.mark.parametrize("name", WRITERS)
def test_defaults_are_those_of_the_struct(name):
    """Named choices and flags: the constant 0, which leaves the default, so that writing them out changes nothing."""
    struct, kind = STRUCTS[name][0], KINDS[name]
    given = {option: signatures.default_of(kind, option) for option in kind.__annotations__ if option not in STRUCTS[name][2]}
    given = {option: value for option, value in given.items() if value is not None and option != "kind"}
    filled = bytes(ffi.buffer(options(struct, given, WRITERS[name])._pointer))
    assert filled == bytes(ffi.buffer(options(struct, {}, {})._pointer))


def test_help_describes_every_option():
    shown = 0
    for name, function in public_functions():
        text = inspect.getdoc(function) or ""
        for argument in inspect.signature(function).parameters.values():
            if argument.kind is argument.KEYWORD_ONLY and hasattr(function, "__wrapped__"):
                assert f"\n{argument.name} : " in text, (name, argument.name)
                shown += 1
    assert shown > 150


def test_functions_of_the_front_name_every_argument():
    names = "flow uniformize cover circles harmonic forms match spline structure quads quad_layout quad_spline fit_few_patches cohort"
    for name in [*names.split(), "fit_control_mesh", "texture_atlas"]:
        function = getattr(ricci, name)
        for argument in inspect.signature(function).parameters:
            assert f"\n{argument} : " in inspect.getdoc(function), (name, argument)


def test_wrong_names_are_our_errors(disk):
    for call in (
        lambda: ricci.flow(disk, targt="uniform"),
        lambda: ricci.Metric(disk).flow(tolerence=1),
        lambda: ricci.Solver(ricci.Metric(disk), tolerence=1),
        lambda: ricci.Spline.of_mesh(disk, degre=2),
        lambda: ricci.cohort([], ricci.Job("info"), worker=1),
    ):
        with pytest.raises(ricci.ArgumentTypeError, match=r"there is no option '\w+' of \w+; .*did you mean '\w+'\?"):
            call()


def test_options_have_types_to_be_named():
    assert set(KINDS) <= set(ricci.__all__)
    for name in KINDS:
        assert getattr(ricci, name) is KINDS[name]


def test_functions_keep_their_names():
    assert pickle.loads(pickle.dumps(ricci.flow)) is ricci.flow
    assert ricci.flow.__qualname__ == "flow"
    assert ricci.Metric.flow.__qualname__ == "Metric.flow"


def test_editors_complete_the_options():
    """What Tab asks for in a notebook."""
    completer = pytest.importorskip("IPython.core.completer")
    made = completer.IPCompleter(namespace={"ricci": ricci, "mesh": None}, global_namespace={})
    with completer.provisionalcompleter():
        assert "tolerance=" in {found.text for found in made.completions("ricci.flow(mesh, toler", 22)}
