"""Gathers the pages of the site: assemble.py ROOT SOURCE RICCI [MESHES].

The repository's own pages keep their text; links between them are led to where they are in the site. Pages of the command, the C headers,
the Python package and the notebooks are made from what they describe, pictures of the tutorial and of generated surfaces by the commands
beside them. Those of other surfaces are made where MESHES is given, else they are the ones in docs/pictures.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path, PurePosixPath

import commands
import headers
import notebooks
import python_pages
import tutorial

# Where pages and folders of the repository are in the site; what is not listed keeps its name, without docs/.
PLACES = {
    "README.md": "index.md",
    "ARCHITECTURE.md": "architecture.md",
    "python/README.md": "python/index.md",
    "docs/pictures/README.md": "pictures/index.md",
    "docs/notebooks": "notebooks/index.md",
    "examples": "examples.md",
}
LINK = re.compile(r"(!?\[[^\]]*\]\()([^)\s]+)(\))")
LANGUAGES = {".rs": "rust", ".c": "c", ".cpp": "cpp", ".py": "python"}


def place(path: str) -> str:
    """Where a file of the repository is in the site."""
    if path in PLACES:
        return PLACES[path]
    if path.startswith("docs/notebooks/"):
        return path.removeprefix("docs/").replace(".ipynb", ".md")
    return path.removeprefix("docs/")


def relative(target: str, page: str) -> str:
    """A path of the site, as seen from one of its pages."""
    up = len(PurePosixPath(page).parts) - 1
    return "../" * up + target


def led(text: str, origin: str) -> str:
    """The text of a page of the repository with its links led to where they are in the site."""

    def replaced(link: re.Match[str]) -> str:
        address, _, anchor = link[2].partition("#")
        if "://" in link[2] or not address:
            return link[0]
        parts: list[str] = []
        for part in (PurePosixPath(origin).parent / address).parts:
            parts = parts[:-1] if part == ".." else [*parts, part]
        target = relative(place("/".join(parts)), place(origin))
        return link[1] + target + ("#" + anchor if anchor else "") + link[3]

    # Blocks of code are left as they are.
    pieces = re.split(r"(^```.*?^```\n)", text, flags=re.MULTILINE | re.DOTALL)
    return "".join(piece if k % 2 else LINK.sub(replaced, piece) for k, piece in enumerate(pieces))


def tree(caption: str, pages: list[str], *, hidden: bool = True) -> str:
    """A table of contents."""
    options = [":hidden:"] if hidden else [":maxdepth: 1"]
    if caption:
        options.append(f":caption: {caption}")
    return "\n".join(["", "```{toctree}", *options, "", *pages, "```", ""])


def copied(root: Path, source: Path) -> None:
    """The repository's own pages, and the files beside them to which they lead."""
    pages = [root / "README.md", root / "ARCHITECTURE.md", root / "python" / "README.md"]
    pages += [*(root / "docs").glob("*.md"), *(root / "docs" / "results").glob("*.md")]
    for path in pages:
        name = path.relative_to(root).as_posix()
        target = source / place(name)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(led(path.read_text(encoding="utf-8"), name), encoding="utf-8")
    (source / "tutorial").mkdir()
    shutil.copy(root / "docs" / "tutorial" / "scan.awk", source / "tutorial")


def pictured(root: Path, source: Path, program: str, meshes: str | None) -> None:
    """The gallery: committed pictures, over them those that are made here, and the page whose views turn."""
    folder = source / "pictures"
    shutil.copytree(root / "docs" / "pictures", folder, ignore=shutil.ignore_patterns("*.html"))
    (folder / "README.md").unlink()
    made = source / "extra" / "gallery"
    subprocess.run([program, "gallery", str(made), *([meshes] if meshes else []), "--quiet"], check=True)
    for picture in made.glob("*.png"):
        shutil.move(picture, folder / picture.name)
    name = "docs/pictures/README.md"
    text = led((root / name).read_text(encoding="utf-8"), name)
    text += '\nThe generated surfaces <a href="../gallery/index.html">in views that turn</a>.\n'
    (folder / "index.md").write_text(text, encoding="utf-8")
    (made / "README.md").unlink()


def exampled(root: Path, source: Path) -> None:
    """A page of the programs in examples/, whole."""
    lines = ["# Examples", "", "Programs that are built and run by the tests.", ""]
    for path in sorted((root / "examples").rglob("*.*")):
        if path.suffix in LANGUAGES:
            text = path.read_text(encoding="utf-8").strip("\n")
            lines += [f"## {path.relative_to(root).as_posix()}", "", f"````{LANGUAGES[path.suffix]}", text, "````", ""]
    (source / "examples.md").write_text("\n".join(lines), encoding="utf-8")


def listed(path: Path, title: str, text: str, pages: list[str]) -> None:
    """A page that lists others."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"# {title}\n\n{text}\n{tree('', pages, hidden=False)}", encoding="utf-8")


def appended(path: Path, text: str) -> None:
    """Add to a page."""
    path.write_text(path.read_text(encoding="utf-8") + text, encoding="utf-8")


def generated(root: Path, source: Path, program: str) -> None:
    """Pages of the command, the headers, the Python package and the notebooks."""
    pages = [f"command/{name}" for name in commands.write(program, source / "command")]
    appended(source / "commands.md", "\n## Every command\n" + tree("", pages, hidden=False))
    text = "One page for each header, from its comments. [Conventions of the C face](../c-conventions.md) hold for all of them."
    listed(source / "c" / "index.md", "C headers", text, headers.write(root / "include" / "ricci", source / "c"))
    pages = [f"api/{name}" for name in python_pages.write(source / "python" / "api")]
    appended(source / "python" / "index.md", "\n## Every name\n" + tree("", pages, hidden=False))
    books = notebooks.write(root / "docs" / "notebooks", source / "notebooks")
    shutil.copytree(root / "docs" / "notebooks", source / "extra" / "_downloads" / "notebooks")
    listed(source / "notebooks" / "index.md", "Notebooks", "Each was run when this page was made.", books)


def rooted(source: Path) -> None:
    """Tables of contents: that of the results, and the site's own."""
    results = sorted(path.stem for path in (source / "results").glob("*.md"))
    listed(source / "results" / "index.md", "Results", "Tables of what was measured, each with the program that measures it.", results)
    text = tree("Begin", ["tutorial", "capabilities", "pictures/index", "notebooks/index"])
    text += tree("Use", ["commands", "python/index", "c/index", "c-conventions", "examples", "packages"])
    text += tree("Know", ["notation", "common-subdivision", "results/index", "architecture", "bibliography", "dependencies"])
    appended(source / "index.md", text)


def main(root: Path, source: Path, program: str, meshes: str | None) -> int:
    """Gather all; 1 where the tutorial says what its commands do not."""
    shutil.rmtree(source, ignore_errors=True)
    source.mkdir(parents=True)
    shutil.copy(root / "docs" / "site" / "conf.py", source)
    copied(root, source)
    missing = tutorial.run(root, program, source / "tutorial")
    for line in missing:
        print(f"docs/tutorial.md: no command printed {line!r}", file=sys.stderr)
    pictured(root, source, program, meshes)
    exampled(root, source)
    generated(root, source, program)
    rooted(source)
    return 1 if missing else 0


if __name__ == "__main__":
    given = sys.argv[1:]
    sys.exit(main(Path(given[0]).resolve(), Path(given[1]), given[2], given[3] if len(given) > 3 else None))
