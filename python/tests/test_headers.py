"""The package against the headers: no function of the C face is left out, no figure is forgotten, every status has its name and class."""

import ast
import dataclasses
import re
from pathlib import Path

import pytest

import ricci
from ricci import figures
from ricci._library import ffi, lib
from ricci.errors import _FAMILIES, _SINGLE
from ricci.figures.names import CONSTANTS

SOURCES = "\n".join(path.read_text() for path in Path(ricci.__file__).parent.rglob("*.py") if path.name != "_native.py")


def names_of(kind):
    """`circle_domain` of CircleDomainSummary."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", kind.__name__.removesuffix("Summary")).lower()


def test_every_function_is_called_somewhere():
    functions = [name for name in dir(lib) if name.startswith("ricci_")]
    made = {f"ricci_{names_of(getattr(figures, name))}_{verb}" for name in figures.__all__ for verb in ("summarise", "free")}
    # The names of these are put together where they are called.
    made |= {"ricci_solver_free"}
    left = [name for name in functions if name not in made and not re.search(rf"\b{name}\b", SOURCES)]
    assert len(functions) > 130
    assert left == []


def test_modules_import_in_one_direction():
    """No module of the package leads back to itself by its imports, those inside functions included."""
    imports = {}
    package = Path(ricci.__file__).parent
    for path in package.rglob("*.py"):
        name = ".".join(("ricci", *path.relative_to(package).with_suffix("").parts)).removesuffix(".__init__")
        nodes = [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.ImportFrom)]
        found = {node.module for node in nodes} | {f"{node.module}.{alias.name}" for node in nodes for alias in node.names}
        imports[name] = {target for target in found if target and target.startswith("ricci.") and target != name}
    imports = {name: {target for target in found if target in imports} for name, found in imports.items()}
    assert len(imports) > 35
    while True:
        ends = [name for name, found in imports.items() if not found]
        if not ends:
            break
        imports = {name: found - set(ends) for name, found in imports.items() if found}
    assert imports == {}


@pytest.mark.parametrize("kind", [getattr(figures, name) for name in figures.__all__], ids=lambda kind: kind.__name__)
def test_figures_have_the_fields_of_their_structs(kind):
    ends = "" if kind.__name__ in ("DilatationBracket", "FoundLandmarks", "MatchingJudgement", "SceneReport") else "_summary"
    struct = ffi.typeof(f"ricci_{names_of(kind)}{ends}")
    theirs = {name: field.type for name, field in struct.fields if name not in ("size", "stop_reason_text") and "reserved" not in name}
    ours = {field.name: field.type for field in dataclasses.fields(kind)}
    assert list(ours) == list(theirs)
    types = {
        "str": "char *",
        "bool": "uint32_t",
        "complex": "double[2]",
        "float": "double",
        "tuple[float, float]": "double[2]",
        "tuple[float, float, float]": "double[3]",
        "tuple[float, ...]": "double[10]",
    }
    for name, told in ours.items():
        allowed = {"uint32_t"} if told in CONSTANTS else {types[told]} if told in types else {"size_t", "uint32_t", "int64_t"}
        assert theirs[name].cname in allowed, (name, told)


def test_statuses_have_their_numbers_and_names():
    for status in ricci.Status:
        assert getattr(lib, f"RICCI_{status.name}") == status
        assert len(status.text) > 3
    for number in range(1000):
        known = ffi.string(lib.ricci_status_text(number)) != b"unknown status"
        assert known == (number in list(ricci.Status)), number


def test_every_status_has_an_exception_of_its_family():
    for status in list(ricci.Status)[1:]:
        kind = _SINGLE.get(status) or _FAMILIES[status // 100]
        assert issubclass(kind, ricci.RicciError)


def test_names_stand_for_constants():
    assert {lib.RICCI_SPACE_E2, lib.RICCI_SPACE_H2, lib.RICCI_SPACE_S2} == {0, 1, 2}
    flat = ricci.metric(ricci.make("torus", a=2, b=1, n=8, m=6), space="h2", scheme="inversive").summary
    assert (flat.space, flat.input_geometry, flat.scheme) == ("h2", "e2", "inversive")


def test_names_are_all_constants_of_their_prefix():
    """But for those of another list that begin alike."""
    others = {
        "STRUCTURE": {"SINGULAR", "EXCLUDED", "FOLDED", "ZEROS", "TRIANGLES"},
        "FLATTEN": {"ISOMETRIC", "ARAP", "AREA", "DISTANCE"}
        | {f"FROM_{start}" for start in ("CONFORMAL", "TUTTE", "UNTANGLED", "SEAMLESS", "COARSE")},
    }
    for prefix, names in CONSTANTS.values():
        head = f"RICCI_{prefix}_"
        theirs = {name.removeprefix(head) for name in dir(lib) if name.startswith(head)} - others.get(prefix, set())
        assert {name.upper() for name in names} == theirs
        assert sorted(getattr(lib, head + name.upper()) for name in names) == list(range(len(names)))
