"""Every public name has an example in its documentation, and the examples give what they say."""

import doctest
import importlib.util
import inspect
import re

import pytest

import ricci

# Classes of errors and of options are described where they are raised and taken.
NAMES = [
    name
    for name in ricci.__all__
    if name != "__version__"
    and not (inspect.isclass(getattr(ricci, name)) and issubclass(getattr(ricci, name), Exception | dict) and name != "RicciError")
]
NEEDS = {
    "to_trimesh": "trimesh",
    "to_meshio": "meshio",
    "to_pyvista": "pyvista",
    "to_gifti": "nibabel",
    "from_gifti": "nibabel",
    "Gifti": "nibabel",
    "to_polyscope": "polyscope",
    "cohort": "pyarrow",
    "CohortResult": "pyarrow",
}


@pytest.mark.parametrize("name", NAMES)
def test_examples_give_what_they_say(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = inspect.getdoc(getattr(ricci, name)) or ""
    found = doctest.DocTestParser().get_doctest(text, {"ricci": ricci, "__name__": "__main__"}, name, None, None)
    assert found.examples, f"{name} has no example"
    assert re.search(r"^Examples\n--------\n", text, re.MULTILINE)
    if name in NEEDS and importlib.util.find_spec(NEEDS[name]) is None:
        pytest.skip(f"{NEEDS[name]} is not installed")
    told = []
    doctest.DocTestRunner(verbose=False).run(found, out=told.append)
    assert not told, "".join(told)


def test_documentation_does_not_send_readers_to_headers():
    for name in NAMES:
        value = getattr(ricci, name)
        for text in (inspect.getdoc(value), *(inspect.getdoc(m) for _, m in inspect.getmembers(value) if inspect.isfunction(m))):
            assert not re.search(r"\b\w+\.h\b|\bricci_\w+\(", text or ""), name
