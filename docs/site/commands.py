"""Pages of the command: what `ricci help` prints for each command, with a page for each."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

# A list of commands, or of shapes, in a help text.
LISTED = re.compile(r"^(?:Commands|Shapes):\n((?:  .*\n)+)", re.MULTILINE)


def help_of(program: str, words: list[str]) -> str:
    """The help text of a command, or of the whole."""
    return subprocess.run([program, *words, "--help"], capture_output=True, text=True, check=True).stdout


def named(text: str) -> list[str]:
    """The commands that a help text lists."""
    found = LISTED.search(text)
    names = re.findall(r"^  (\S+)", found[1], re.MULTILINE) if found else []
    return [name for name in names if name != "help"]


def pages(program: str, words: list[str]) -> dict[str, list[str]]:
    """The help of a command and of those below it: the words after `ricci`, joined by dashes, and the lines of a page."""
    text = help_of(program, words)
    below = named(text)
    head, _, rest = text.partition("\n\n")
    title = " ".join(["ricci", *words])
    lines = [f"# `{title}`", "", head.strip().replace("\n", " "), "", "```text", rest.strip("\n"), "```", ""]
    if below:
        lines += [f"- [`{title} {name}`]({'-'.join([*words, name])}.md)" for name in below]
        lines += ["", "```{toctree}", ":hidden:", "", *("-".join([*words, name]) for name in below), "```", ""]
    found = {"-".join(words): lines}
    for name in below:
        found |= pages(program, [*words, name])
    return found


def write(program: str, folder: Path) -> list[str]:
    """A page in `folder` for each command; the names of those directly below `ricci`."""
    folder.mkdir(parents=True, exist_ok=True)
    names = named(help_of(program, []))
    for name in names:
        for stem, lines in pages(program, [name]).items():
            (folder / f"{stem}.md").write_text("\n".join(lines), encoding="utf-8")
    return names
