"""The site's recipe for Sphinx: `make docs` builds it into out/site, to be opened from disk or published as it is."""

from __future__ import annotations

import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "extensions"))

# Notebooks call `plantar`: this environment's, also where that is not on the path.
os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])

from plantar import __version__

project = "plantar"
author = "the authors of plantar"
version = release = __version__
language = "en"

extensions = [
    "myst_nb",  # Markdown by myst_parser, and notebooks
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "command_reference",
    "cpp_reference",
    "raised_errors",
]
exclude_patterns = ["extensions"]

# Notebooks are stored without outputs and run when the site is built, each in a folder of its own.
nb_execution_mode = "force"
nb_execution_in_temp = True
nb_execution_timeout = 300  # s for a cell: the first one plays the twin
nb_execution_raise_on_error = True
nb_merge_streams = True
nb_ipywidgets_js = {}  # it would come from the network

myst_heading_anchors = 4  # links such as formats.md#large-files, as in the repository's own view of the pages
suppress_warnings = ["myst.xref_ambiguous"]

default_role = "code"  # docstrings quote code with single backticks, as the pages do
napoleon_numpy_docstring = False
napoleon_use_rtype = False  # "Returns" are sentences, not types
autodoc_preserve_defaults = True
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
autodoc_member_order = "bysource"
autodoc_class_signature = "separated"
autodoc_default_options = {"exclude-members": "__init__, __new__"}

html_theme = "furo"
html_title = f"plantar {__version__}"
html_static_path = ["extensions/static"]
html_css_files = ["site.css"]
html_show_sphinx = False
html_show_search_summary = False  # it would load pages, which a browser forbids on disk
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#1d4e89", "color-brand-content": "#1d4e89"},
    "dark_css_variables": {"color-brand-primary": "#8ab8e6", "color-brand-content": "#8ab8e6"},
}
