"""Runs the commands of the tutorial: its pictures are those that they make, and what it prints is what they print."""

from __future__ import annotations

import re
import subprocess
import tempfile
from pathlib import Path

BLOCK = re.compile(r"^```(sh|text)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def run(root: Path, program: str, pictures: Path) -> list[str]:
    """Run it in an empty folder and copy its pictures; the lines of its page that no command has printed."""
    page = (root / "docs" / "tutorial.md").read_text(encoding="utf-8")
    missing, printed = [], ""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "docs").symlink_to(root / "docs")
        for kind, text in BLOCK.findall(page):
            if kind == "sh":
                script = f'set -e\nricci() {{ "{Path(program).resolve()}" "$@"; }}\n{text}'
                printed += subprocess.run(["bash", "-c", script], cwd=folder, check=True, capture_output=True, text=True).stdout
            else:
                said = {line.strip() for line in printed.splitlines()}
                missing += [line for line in text.splitlines() if line.strip() not in said and line.strip() != "…"]
        pictures.mkdir(parents=True, exist_ok=True)
        for picture in re.findall(r"!\[[^\]]*\]\(tutorial/([^)]+)\)", page):
            (pictures / picture).write_bytes((folder / picture).read_bytes())
    return missing
