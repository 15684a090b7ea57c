"""Pages of the C headers: their comments and declarations as reStructuredText with the directives of Sphinx's C domain."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

# A comment for readers, a section's title, or a declaration up to its semicolon.
PIECE = re.compile(
    r"/\*\*(?P<doc>.*?)\*/"
    r"|/\* -{20,}\n(?P<section>.*?)\*/"
    r"|/\*(?P<comment>.*?)\*/"
    r"|^#(?P<line>(?:[^\n]*\\\n)*[^\n]*)$"
    r"|(?P<code>[^\s/#][^;{]*(?:\{.*?^\}[^;\n]*)?;?)",
    re.DOTALL | re.MULTILINE,
)
NAME = re.compile(r"\b(?:ricci_\w+|RICCI_\w+)\b")
# The comment before a member, or the member.
FIELD = re.compile(r"/\*\*(.*?)\*/|([^/\s][^;]*);", re.DOTALL)
CONSTANT = re.compile(r"/\*\*(.*?)\*/|([^/\s][^;,]*)[;,]?", re.DOTALL)
MARKS = re.compile(r"\b(?:RICCI_API_VOID|RICCI_API|RICCI_EXPERIMENTAL)\b\s*")


@dataclass
class Declaration:
    """One declaration with its comment; members are those of a struct or the numbers of an enum."""

    kind: str
    name: str
    text: str
    doc: str = ""
    experimental: bool = False
    members: list[Declaration] = field(default_factory=list)


@dataclass
class Header:
    """A header: its name, its leading comment, and sections of declarations, the first without a title."""

    name: str
    lead: str
    sections: list[tuple[str, list[Declaration]]]


def stripped(comment: str) -> str:
    """The text of a comment without its stars."""
    lines = [re.sub(r"^\s*\* ?", "", line).rstrip() for line in comment.strip().splitlines()]
    return "\n".join(lines).strip("\n")


def members_of(body: str, kind: str) -> list[Declaration]:
    """The fields of a struct, or the constants of an enum, each with the comment before it."""
    found, doc = [], ""
    for piece in (CONSTANT if kind == "enumerator" else FIELD).finditer(body):
        if piece[1] is not None:
            doc = stripped(piece[1])
            continue
        text = " ".join(piece[2].split())
        names = [text.split("=")[0].strip()] if kind == "enumerator" else re.findall(r"(\w+)(?:\[\w+\])*\s*(?:,|$)", text)
        base = text if len(names) == 1 else re.sub(r"\w+\s*,.*$", "", text)
        found += [Declaration(kind, name, base if len(names) == 1 else base + name, doc) for name in names]
        doc = ""
    return found


def declaration(code: str, doc: str) -> Declaration | None:
    """What a piece of code declares; None for what is no part of the interface."""
    experimental = "RICCI_EXPERIMENTAL" in code
    text = " ".join(MARKS.sub("", code).rstrip(";").split())
    if text.startswith(("extern", "}")) or not text:
        return None
    if found := re.match(r"typedef struct (\w+) \{", text):
        body = code[code.index("{") + 1 : code.rindex("}")]
        return Declaration("struct", found[1], found[1], doc, experimental, members_of(body, "member"))
    if found := re.match(r"typedef struct (\w+) \w+$", text):
        return Declaration("struct", found[1], found[1], doc, experimental)
    if text.startswith("enum"):
        body = code[code.index("{") + 1 : code.rindex("}")]
        return Declaration("enum", "", "", doc, experimental, members_of(body, "enumerator"))
    if text.startswith("typedef"):
        name = (re.search(r"\(\*(\w+)\)", text) or re.search(r"(\w+)$", text))[1]
        return Declaration("type", name, text.removeprefix("typedef "), doc, experimental)
    signature = text.split("{")[0].strip()
    name = re.search(r"(\w+)\(", signature)[1]
    return Declaration("function", name, signature.removeprefix("static inline "), doc, experimental)


def parsed(path: Path) -> Header:
    """A header's comments and declarations."""
    lead, sections, doc = "", [("", [])], ""
    code = re.sub(r"^#ifdef __cplusplus\n.*?^#endif\n", "", path.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
    for piece in PIECE.finditer(code):
        kind, text = piece.lastgroup, piece[piece.lastgroup]
        if kind == "doc":
            doc = stripped(text)
        elif kind == "section":
            sections.append((stripped(text), []))
        elif kind == "comment":
            lead = lead or stripped(text)
        else:
            if kind == "line":
                found = re.match(r"define (RICCI_\w+) (.+)", text, re.DOTALL) if doc or "RICCI_VERSION" in text else None
                made = Declaration("macro", found[1], found[1], doc + f"\n\nIts value: `{found[2]}`") if found else None
            else:
                made = declaration(text, doc)
            doc = ""
            if made:
                sections[-1][1].append(made)
    return Header(path.name, lead, [part for part in sections if part[0] or part[1]])


class Writer:
    """Writes headers; it knows the kind of every name, so that prose leads to what it names."""

    def __init__(self, headers: list[Header]) -> None:
        self.kinds: dict[str, str] = {}
        for header in headers:
            for _, listed in header.sections:
                for one in listed:
                    self.kinds[one.name] = one.kind
                    self.kinds |= {member.name: member.kind for member in one.members if member.kind == "enumerator"}

    def words(self, text: str) -> str:
        """A text in which names are links, and signs of the markup stand for themselves."""
        out = ""
        for k, part in enumerate(re.split(r"(`[^`]*`|\b(?:ricci_\w+|RICCI_\w+)\b(?:\(\))?)", text)):
            if k % 2 == 0:
                # Markup ends before a space or a sign only.
                if out and re.match(r"[^\s'\")\]}>/:.,;!?-]", part):
                    out += "\\ "
                out += re.sub(r"([\\*|])", r"\\\1", re.sub(r"(\w)_(?!\w)", r"\1\\_", part))
                continue
            if re.search(r"[^\s'\"(\[{</:-]$", out):
                out += "\\ "
            name = part.removesuffix("()")
            kind = self.kinds.get(name)
            role = "func" if kind == "function" else kind
            out += f":c:{role}:`{name}`" if role else f"``{part.strip('`')}``"
        return out

    def prose(self, text: str) -> list[str]:
        """Paragraphs, lists and blocks of code of a comment."""
        lines: list[str] = []
        for block in re.split(r"\n\s*\n", text):
            rows = block.splitlines()
            if all(row.startswith("    ") for row in rows if row):
                lines += ["", ".. code-block:: c", "", *rows]
                continue
            lines.append("")
            for row in rows:
                item = re.match(r"\s*- (.*)", row)
                lines += ["", "* " + self.words(item[1])] if item else [("  " if self._inside(lines) else "") + self.words(row.strip())]
        return lines

    @staticmethod
    def _inside(lines: list[str]) -> bool:
        """Whether the paragraph at the end of these lines is that of an item of a list."""
        for line in reversed(lines):
            if not line:
                return False
            if line.startswith("* "):
                return True
        return False

    def described(self, doc: str) -> list[str]:
        """A comment's text, its return values and its arguments as fields."""
        head, *parts = re.split(r"^@(?=return|param)", doc, flags=re.MULTILINE)
        lines = self.prose(head.strip()) if head.strip() else []
        fields = []
        for part in parts:
            words = " ".join(part.split()).split(" ", 1)
            if words[0] == "return":
                fields.append(":returns: " + self.words(words[1]))
            else:
                name, told = words[1].split(" ", 1)
                fields.append(f":param {name}: " + self.words(told.strip()))
        return [*lines, "", *sorted(fields, key=lambda line: line.startswith(":returns"))]

    def one(self, made: Declaration) -> list[str]:
        """A declaration with its comment and its members, without those that only keep room."""
        told = self.described(made.doc)
        if made.experimental:
            told += ["", "*Experimental: a later version may change it.*"]
        if made.kind == "enum":
            lines = [*told, ""]
            inner = ""
        else:
            lines = ["", f".. c:{made.kind}:: {made.text}", "", *("   " + line if line else "" for line in told), ""]
            inner = "   "
        for member in made.members:
            if member.name != "reserved":
                lines += [inner + line if line else "" for line in self.one(member)]
        return lines

    def page(self, header: Header) -> str:
        """The page of a header."""
        title, _, rest = header.lead.partition("\n")
        title = title.removeprefix("ricci: ").strip()
        rest = re.sub(r"\n?SPDX-License-Identifier:[^\n]*\n", "\n", rest)
        name = f"ricci/{header.name}"
        lines = [name, "=" * len(name), "", self.words(title[0].upper() + title[1:]), *self.prose(rest.strip("\n"))]
        for name, listed in header.sections:
            if name:
                head, _, more = name.partition("\n")
                lines += ["", head, "-" * len(head), *self.prose(more.strip("\n"))]
            for one in listed:
                lines += self.one(one)
        return "\n".join(lines) + "\n"


def write(include: Path, folder: Path) -> list[str]:
    """A page in `folder` for each header in `include`; their names."""
    headers = [parsed(path) for path in sorted(include.glob("*.h"), key=lambda path: (path.stem != "ricci", path.stem))]
    writer = Writer(headers)
    folder.mkdir(parents=True, exist_ok=True)
    for header in headers:
        (folder / f"{header.name.removesuffix('.h')}.rst").write_text(writer.page(header), encoding="utf-8")
    return [header.name.removesuffix(".h") for header in headers]
