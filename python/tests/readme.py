"""The Python examples of a page: python readme.py PAGE... runs the blocks of each page one after the other, in one namespace."""

import re
import sys
from pathlib import Path


def examples(page):
    """The code of the page's ```python blocks."""
    return re.findall(r"^```python\n(.*?)^```", Path(page).read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)


def run(page):
    """Run them in the current folder."""
    blocks = examples(page)
    assert blocks, f"{page} has no Python example"
    namespace = {"__name__": "readme"}
    for block in blocks:
        exec(compile(block, str(page), "exec"), namespace)
    return namespace


if __name__ == "__main__":
    for name in sys.argv[1:]:
        run(name)
        print(f"the Python examples of {name} ran")
