"""Checks the links of a site: links.py FOLDER [--external].

Every link inside it must lead to a file of it, and its anchor to an element of that file. With --external other addresses are asked for.
"""

from __future__ import annotations

import argparse
import sys
import urllib.error
import urllib.request
from concurrent.futures import ThreadPoolExecutor
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

# Attributes that name a file or a place.
NAMING = {"a": "href", "link": "href", "img": "src", "script": "src", "iframe": "src", "source": "src"}


class Page(HTMLParser):
    """The links of a page, with their lines, and the names of its elements."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[tuple[int, str]] = []
        self.names: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Called for each element."""
        given = dict(attrs)
        self.names |= {name for name in (given.get("id"), given.get("name") if tag == "a" else None) if name}
        address = given.get(NAMING.get(tag, ""))
        if address:
            self.links.append((self.getpos()[0], address))


def wrong(folder: Path, pages: dict[Path, Page], path: Path, address: str) -> str | None:
    """What is wrong with a link inside the site; None for a good one."""
    parts = urlsplit(address)
    target = path if not parts.path else (path.parent / unquote(parts.path)).resolve()
    if target.is_dir():
        target = target / "index.html"
    if not target.is_relative_to(folder):
        return "leads out of the site"
    if not target.exists():
        return "no such file"
    if parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].names:
        return "no such anchor"
    return None


def answers(address: str) -> str | None:
    """What is wrong with an address outside the site."""
    try:
        request = urllib.request.Request(address, headers={"User-Agent": "Mozilla/5.0 (link check)"})
        with urllib.request.urlopen(request, timeout=30):
            return None
    except (urllib.error.URLError, OSError, ValueError) as error:
        return str(error)


def main() -> int:
    """Check; 1 where a link is dead."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--external", action="store_true", help="ask for addresses outside the site, too")
    given = parser.parse_args()
    folder = given.folder.resolve()
    pages = {path.resolve(): Page(path.read_text(encoding="utf-8")) for path in sorted(folder.rglob("*.html"))}
    if not pages:
        print(f"{folder} has no pages", file=sys.stderr)
        return 1
    inside = dead = 0
    outside: set[str] = set()
    for path, page in pages.items():
        for line, address in page.links:
            if address.startswith(("data:", "javascript:", "mailto:")):
                continue
            if urlsplit(address).scheme or address.startswith("//"):
                outside.add(address)
                continue
            inside += 1
            if problem := wrong(folder, pages, path, address):
                dead += 1
                print(f"{path.relative_to(folder)}:{line}: {address}: {problem}", file=sys.stderr)
    if given.external:
        with ThreadPoolExecutor(8) as pool:
            for address, problem in zip(sorted(outside), pool.map(answers, sorted(outside)), strict=True):
                if problem:
                    dead += 1
                    print(f"{address}: {problem}", file=sys.stderr)
    asked = "asked for" if given.external else "not asked for"
    print(f"{len(pages)} pages, {inside} links inside the site, {len(outside)} addresses outside it ({asked}), {dead} dead")
    return 1 if dead else 0


if __name__ == "__main__":
    sys.exit(main())
