"""Sphinx's settings for the site."""

import re

import ricci

project = "ricci"
author = "the authors of ricci"
project_copyright = "the authors of ricci; MIT or Apache-2.0"
version = release = ricci.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["extra"]
html_theme = "furo"
html_title = f"ricci {version}"
html_extra_path = ["extra"]
html_show_sourcelink = False
html_copy_source = False

myst_heading_anchors = 4
# Pages begin where the repository's do; some of their parts skip a level.
suppress_warnings = ["myst.header"]

default_role = "py:obj"
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
napoleon_numpy_docstring = True
napoleon_google_docstring = False
napoleon_use_ivar = True
c_maximum_signature_line_length = 100
python_maximum_signature_line_length = 100
# Names of the libraries' own types stand in headers without being declared there.
nitpick_ignore_regex = [("c:identifier", ".*")]


def escaped(*event):
    """Bars of absolute values are no substitutions; the lines of a docstring are the last argument of its event."""
    lines = event[-1]
    lines[:] = [re.sub(r"(?<!\\)\|", r"\\|", line) if not line.lstrip().startswith(">>>") else line for line in lines]


def setup(app):
    """Called by Sphinx."""
    app.connect("autodoc-process-docstring", escaped)
