"""Every row of the index has a test."""

import pathlib
import re

import pytest
from conftest import CASES, rows

HERE = pathlib.Path(__file__).parent


def test_every_row_of_the_index_has_a_test():
    if not rows():
        pytest.skip(f"{CASES} is absent")
    marked = set()
    for test in HERE.glob("test_*.py"):
        marked.update(re.findall(r'mark\.row\("([^"]+)"\)', test.read_text()))
    missing = [row["file"] for row in rows() if row["file"] not in marked]
    assert not missing, f"rows without a test: {missing}"
