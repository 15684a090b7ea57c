"""Pages of the notebooks: their text and code, and what the cells put out when they are run."""

from __future__ import annotations

import html
import json
import os
import tempfile
from pathlib import Path
from typing import Any

import nbclient
import nbformat

# Kernels are spoken to on this machine only, and do not warn of that at each start.
QUIET = ["--IPKernelApp.log_level=ERROR"]


def run(path: Path) -> dict[str, Any]:
    """The notebook with the outputs of its cells: as it has been run in RICCI_NOTEBOOKS, or run in a folder of its own."""
    book = nbformat.read(path, as_version=4)
    done = Path(os.environ.get("RICCI_NOTEBOOKS") or "/nowhere") / path.name
    if done.exists():
        known = nbformat.read(done, as_version=4)
        if [(cell.cell_type, cell.source) for cell in known.cells] == [(cell.cell_type, cell.source) for cell in book.cells]:
            return json.loads(nbformat.writes(known))
    with tempfile.TemporaryDirectory() as folder:
        place = {"metadata": {"path": folder}}
        nbclient.NotebookClient(book, timeout=600, kernel_name="python3", resources=place, extra_arguments=QUIET).execute()
    return json.loads(nbformat.writes(book))


def fenced(text: str, language: str) -> list[str]:
    """A block of code in a fence that it does not hold."""
    fence = "```"
    while fence in text:
        fence += "`"
    return [f"{fence}{language}", text.strip("\n"), fence, ""]


def output(given: dict[str, Any]) -> list[str]:
    """What a cell put out: a page or picture as it is, text as text."""
    if given["output_type"] == "stream":
        return fenced("".join(given["text"]), "text")
    data = given.get("data", {})
    if "text/html" in data:
        body = "".join(data["text/html"])
        # Blank lines end a block of HTML in Markdown; entities in their place keep what is in an attribute.
        return ['<div class="cell-output">' + body.replace("\n", "&#10;" if "srcdoc=" in body else " ") + "</div>", ""]
    if "image/png" in data:
        return [f'<img alt="what the cell shows" src="data:image/png;base64,{"".join(data["image/png"]).strip()}">', ""]
    return fenced("".join(data["text/plain"]), "text") if "text/plain" in data else []


def page(book: dict[str, Any], name: str) -> str:
    """A notebook as Markdown."""
    lines: list[str] = []
    for cell in book["cells"]:
        text = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            lines += [text, ""]
            continue
        lines += fenced(text, "python")
        for given in cell.get("outputs", []):
            lines += output(given)
    lines += [f'The notebook: <a download href="../_downloads/notebooks/{html.escape(name)}">{html.escape(name)}</a>.', ""]
    return "\n".join(lines)


def write(books: Path, folder: Path) -> list[str]:
    """A page in `folder` for each notebook in `books`; their names."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = sorted(books.glob("*.ipynb"))
    for path in paths:
        (folder / f"{path.stem}.md").write_text(page(run(path), path.name), encoding="utf-8")
    return [path.stem for path in paths]
