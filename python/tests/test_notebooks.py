"""The notebooks of the documentation run from their first cell to their last, in a folder of their own, and what they assert holds.

RICCI_NOTEBOOKS is a folder for the notebooks with their outputs, of which the pages of the documentation are made.
"""

import json
import os
import re
from pathlib import Path

import pytest

from conftest import ROOT

BOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
NEEDS = {"cortex": ["nibabel"], "cohort": ["pyarrow", "cloudpickle"]}


def test_there_are_eight_with_a_title_and_without_outputs():
    assert len(BOOKS) == 8
    for path in BOOKS:
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        assert cells[0]["source"][0].startswith("# "), path.name
        assert not any(cell.get("outputs") or cell.get("execution_count") for cell in cells), path.name
        assert any("assert " in "".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"), path.name


@pytest.mark.parametrize("path", BOOKS, ids=lambda path: path.stem)
def test_notebooks_run(path, tmp_path):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    for package in ("ipykernel", *NEEDS.get(path.stem, [])):
        pytest.importorskip(package)
    book = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(book, timeout=240, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}).execute()
    outputs = [output for cell in book.cells if cell.cell_type == "code" for output in cell.outputs]
    pages = [output["data"]["text/html"] for output in outputs if "text/html" in output.get("data", {})]
    assert any("data:image/png" in page or "<iframe srcdoc" in page for page in pages) or path.stem == "cohort"
    assert not [output for output in outputs if output.output_type == "stream" and re.search("Warning|Traceback", output.text)]
    if folder := os.environ.get("RICCI_NOTEBOOKS"):
        nbformat.write(book, Path(folder) / path.name)
