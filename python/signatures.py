"""The options of functions, written into their heads as keyword arguments: python signatures.py [--write].

A function with the decorator `takes(Kind)` has behind its other arguments the options of the `TypedDict` Kind, in its order, with types and
defaults. Options follow the structs of the C headers, which a test compares; None is the default of what has one of its own there. Without
--write the modules with other heads are listed.
"""

from __future__ import annotations

import ast
import importlib
import sys
from pathlib import Path
from typing import Any

PACKAGE = Path(__file__).resolve().parent / "src" / "ricci"
# Options whose default is not the first of their names: it depends on the call, or is none.
OTHERS = {
    ("Attributes", "wrap"): None,
    ("HarmonicOptions", "target"): None,
    ("CohortOptions", "engine"): "processes",
}


def default_of(kind: type, name: str) -> Any:
    """The default of an option: of a choice its first name, of a flag False, of everything else None."""
    if (kind.__name__, name) in OTHERS:
        return OTHERS[kind.__name__, name]
    text = annotation_of(kind, name)
    if text.startswith("Literal["):
        return ast.literal_eval(text.removeprefix("Literal")[:])[0]
    if text in NAMES:
        return NAMES[text]
    return False if text == "bool" else None


# Defaults of options whose names have a type of their own.
NAMES = {"Space": "e2", "Scheme": "yamabe", "Model": "poincare", "Kind": "generators"}


def annotation_of(kind: type, name: str) -> str:
    """The type of an option as the source has it."""
    return str(kind.__annotations__[name].__forward_arg__)


def parameters_of(kind: type) -> list[str]:
    """The keyword arguments of a function with these options, as source."""
    found = []
    for name in kind.__annotations__:
        default, text = default_of(kind, name), annotation_of(kind, name)
        written = text if default is not None or text.endswith(("Any", "None")) else f"{text} | None"
        found.append(f"{name}: {written} = {default!r}".replace("'", '"'))
    return found


def functions_of(tree: ast.Module) -> list[tuple[ast.FunctionDef, str]]:
    """The functions with options, and the names of their kinds."""
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            for mark in node.decorator_list:
                if isinstance(mark, ast.Call) and getattr(mark.func, "id", "") == "takes":
                    found.append((node, ast.unparse(mark.args[0])))
    return found


def rewritten(source: str, module: Any) -> str:
    """The source of a module with the heads of its functions as their kinds say."""
    lines = source.splitlines(keepends=True)
    for node, name in sorted(functions_of(ast.parse(source)), key=lambda found: -found[0].lineno):
        kind = getattr(module, name)
        own = [argument for argument in node.args.kwonlyargs if argument.arg in kind.__annotations__]
        last = own[-1]
        value = node.args.kw_defaults[node.args.kwonlyargs.index(last)]
        end = value or last.annotation or last
        start = (own[0].lineno - 1, own[0].col_offset)
        stop = ((end.end_lineno or 0) - 1, end.end_col_offset or 0)
        head = lines[start[0]][: start[1]] + ", ".join(parameters_of(kind)) + lines[stop[0]][stop[1] :]
        lines[start[0] : stop[0] + 1] = [head]
    return "".join(lines)


def main() -> int:
    """Writes the heads, or lists the modules in which they are others."""
    stale = []
    for path in sorted(PACKAGE.rglob("*.py")):
        source = path.read_text(encoding="utf-8")
        if "@takes(" not in source:
            continue
        name = ".".join(("ricci", *path.relative_to(PACKAGE).with_suffix("").parts)).removesuffix(".__init__")
        made = rewritten(source, importlib.import_module(name))
        if ast.dump(ast.parse(made)) != ast.dump(ast.parse(source)):
            stale.append(path)
            if "--write" in sys.argv:
                path.write_text(made, encoding="utf-8")
    print("\n".join(map(str, stale)))
    return 0 if "--write" in sys.argv else len(stale)


if __name__ == "__main__":
    sys.exit(main())
