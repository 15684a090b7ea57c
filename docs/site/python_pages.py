"""Pages of the Python package: one for each module with public names, from their docstrings."""

from __future__ import annotations

import inspect
import re
import sys
from pathlib import Path
from typing import Any

import ricci
import ricci.figures


def directive(name: str, value: Any) -> list[str]:
    """The directive that shows a public name."""
    if inspect.isclass(value):
        options = ["   :members:", "   :show-inheritance:"]
        if not issubclass(value, dict | BaseException):
            options += ["   :inherited-members: int, object"]
        return [f".. autoclass:: {name}", *options, ""]
    return [f".. autofunction:: {name}", ""]


def title_of(lead: str) -> str:
    """What a module's documentation begins with: up to a colon or a full stop, or to the first comma of a long sentence."""
    title = re.split(r"[:.]", lead, maxsplit=1)[0].replace("\n", " ")
    return title if len(title) <= 50 else title.split(",")[0]


def page(title: str, lead: str, names: list[tuple[str, Any]]) -> str:
    """A page of names under a title."""
    lines = [title, "=" * len(title), "", lead, ""]
    for name, value in names:
        lines += directive(name, value)
    return "\n".join(lines)


def modules(package: Any) -> dict[str, list[tuple[str, Any]]]:
    """The public names of the package, by the module that has them."""
    found: dict[str, list[tuple[str, Any]]] = {}
    for name in package.__all__:
        value = getattr(package, name)
        home = getattr(value, "__module__", None)
        if home and home.startswith("ricci"):
            found.setdefault(home, []).append((f"ricci.{name}", value))
    return found


def write(folder: Path) -> list[str]:
    """A page in `folder` for each module, and one for the figures; their names."""
    folder.mkdir(parents=True, exist_ok=True)
    made = {}
    for home, names in modules(ricci).items():
        short = home.removeprefix("ricci.").split(".")[0]
        lead = (inspect.getdoc(sys.modules[home]) or "").split("\n\n")[0]
        if short in made:
            made[short][1].extend(names)
        else:
            made[short] = (lead, names)
    made["figures"] = (
        inspect.getdoc(ricci.figures) or "",
        [(f"ricci.figures.{name}", getattr(ricci.figures, name)) for name in ricci.figures.__all__],
    )
    for short, (lead, names) in made.items():
        names.sort(key=lambda pair: (inspect.isclass(pair[1]), pair[0]))
        (folder / f"{short}.rst").write_text(page(title_of(lead), lead, names), encoding="utf-8")
    return sorted(made)
