# SPDX-License-Identifier: BSD-3-Clause
"""Settings of Sphinx; build.py stages the pages and runs it."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import docstrings  # noqa: E402
import mmbrdf  # noqa: E402: the package that was built
from pygments.lexers.special import TextLexer  # noqa: E402

project = "mmbrdf"
author = "the mmbrdf contributors"
copyright = "the mmbrdf contributors, BSD-3-Clause"
version = release = mmbrdf.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc"]
source_suffix = {".md": "markdown"}
root_doc = "index"
language = "en"
highlight_language = "text"
pygments_style = "friendly"
pygments_dark_style = "monokai"
nitpicky = True
# Of other libraries there are no pages here; and the types that pybind11 writes into signatures are no objects of Sphinx.
nitpick_ignore_regex = [
    ("cpp:identifier", r"(std|Real)(::.*)?"),
    (
        "cpp:identifier",
        r"RowColumns|SvdCache|Extreme|inside|no_side",
    ),  # of the library's own, and enumerators without a scope
    ("py:.*", r".*"),
]

myst_enable_extensions = ["colon_fence"]
myst_heading_anchors = 4
myst_url_schemes = ("http", "https", "mailto", "doi")

autodoc_member_order = "groupwise"
autodoc_default_options = {"members": True, "undoc-members": True, "imported-members": True}
autodoc_typehints = "none"
add_module_names = False
toc_object_entries_show_parents = "hide"

html_theme = "furo"
html_title = f"mmbrdf {version}"
html_static_path = [str(Path(__file__).parent / "static")]
html_css_files = ["site.css"]
html_show_sphinx = False
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {
    "navigation_with_keys": True,
    "light_css_variables": {"color-brand-primary": "#14507a", "color-brand-content": "#14507a"},
    "dark_css_variables": {"color-brand-primary": "#7fb8e0", "color-brand-content": "#7fb8e0"},
}


suppress_warnings = ["misc.highlighting_failure"]  # ellipses in examples of C++


def setup(app):
    app.add_lexer("csv", TextLexer)
    app.connect("autodoc-process-docstring", docstrings.process_docstring)
    app.connect("autodoc-process-signature", docstrings.process_signature)
    app.connect("autodoc-skip-member", docstrings.skip_member)
