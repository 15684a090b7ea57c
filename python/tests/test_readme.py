"""The examples of the pages run, and the package has the metadata that it should have."""

from importlib import metadata

import numpy as np
import pytest

import ricci
from conftest import ROOT
from readme import run


def test_the_example_of_the_front_page_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = run(ROOT / "README.md")
    assert found["flat"].converged
    assert np.isfinite(found["uv"]).all()


def test_the_examples_of_the_tutorial_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = run(ROOT / "docs" / "tutorial.md")
    assert (found["part"].summary.turned_faces, found["part"].defects) == (47, [])
    assert found["flat"].converged
    assert found["patches"].summary.distance <= 1e-4
    assert (tmp_path / "part.step").read_text(encoding="utf-8").startswith("ISO-10303-21;")


def test_the_examples_of_the_package_run(tmp_path, monkeypatch):
    pytest.importorskip("pyarrow")
    monkeypatch.chdir(tmp_path)
    found = run(ROOT / "python" / "README.md")
    assert found["flat"].converged
    assert len(found["cover"]) == 19
    assert (found["wrong_at"].element, found["wrong_at"].index) == ("vertex", 7)
    assert found["found"].failures == []
    assert (tmp_path / "flat.obj").exists()


def test_the_package_has_the_version_of_its_library():
    try:
        installed = metadata.version("ricci")
    except metadata.PackageNotFoundError:
        pytest.skip("the package runs from its source tree, not from a wheel")
    assert installed == ricci.__version__


def test_a_library_of_another_version_is_refused(tmp_path):
    from ricci._library import _open

    class Other:
        def ricci_version_number(self):
            return 2_000

    class Opener:
        def dlopen(self, _):
            return Other()

    import ricci._library as library

    original = library.ffi
    library.ffi = Opener()
    try:
        with pytest.raises(ImportError, match=r"is version 0\.2, this package is made for 0\.1"):
            _open(tmp_path / "libricci.so")
    finally:
        library.ffi = original
