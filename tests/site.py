"""Looks at the pages that docs/site/build has made: site.py ROOT PLACE, the pages being in PLACE/site.

Every public name of the Python package and every function of the C headers has a place, every command and notebook a page; and the check of
links finds one that is dead.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

import ricci

root, place = map(Path, sys.argv[1:])
site = place / "site"
failures = []
passed = 0


def check(name, held):
    """Count a check, and name one that fails."""
    global passed
    passed += bool(held)
    if not held:
        failures.append(name)


def anchors(folder):
    """The names of places in all pages of a folder."""
    return set(re.findall(r'\bid="([^"]+)"', "".join(path.read_text(encoding="utf-8") for path in folder.rglob("*.html"))))


def links(pages):
    """What the check of links says of these pages."""
    folder = place / "small"
    folder.mkdir(exist_ok=True)
    for name, text in pages.items():
        (folder / name).write_text(text, encoding="utf-8")
    found = subprocess.run([sys.executable, root / "docs" / "site" / "links.py", folder], capture_output=True, text=True)
    return found.returncode, found.stderr


known = anchors(site / "python")
for name in ricci.__all__:
    if callable(getattr(ricci, name)):
        check(f"ricci.{name} has no place", f"ricci.{name}" in known)
known = anchors(site / "c")
for header in (root / "include" / "ricci").glob("*.h"):
    code = re.sub(r"/\*.*?\*/", "", header.read_text(encoding="utf-8"), flags=re.DOTALL)
    for name in set(re.findall(r"\b(ricci_\w+)\(", code)):
        check(f"{name} of {header.name} has no place", f"c.{name}" in known)
for book in (root / "docs" / "notebooks").glob("*.ipynb"):
    page = (site / "notebooks" / f"{book.stem}.html").read_text(encoding="utf-8")
    cells = json.loads(book.read_text(encoding="utf-8"))["cells"]
    check(f"{book.name} shows less code than it has", page.count("highlight-python") == sum(cell["cell_type"] == "code" for cell in cells))
    check(f"{book.name} shows no output", "cell-output" in page or "highlight-text" in page)
for page in ("tutorial", "notation", "c-conventions", "commands", "results/index", "command/flow", "command/spline-fit", "gallery/index"):
    check(f"there is no {page}.html", (site / f"{page}.html").exists())

good = {"a.html": '<a href="b.html#there">b</a>', "b.html": '<p id="there">b</p><a href="a.html">a</a>'}
check("good links are called dead", links(good)[0] == 0)
status, said = links({**good, "c.html": '<a href="b.html#gone">b</a>\n<img src="none.png"><a href="../away.html">c</a>'})
check("dead links pass", status == 1)
for problem in (
    "c.html:1: b.html#gone: no such anchor",
    "c.html:2: none.png: no such file",
    "c.html:2: ../away.html: leads out of the site",
):
    check(f"not found: {problem}", problem in said)

for name in failures:
    print(name, file=sys.stderr)
print(f"{passed} passed, {len(failures)} failed")
sys.exit(bool(failures))
