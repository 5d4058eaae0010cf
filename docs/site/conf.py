# conf.py: how Sphinx makes the site; tools/docs/make_docs.py copies it beside the pages and runs it.
import os
import sys

sys.path.insert(0, os.environ["OPENRT_DOCS_TOOLS"])
from vrml_lexer import NodeLexer, VrmlLexer  # noqa: E402

project = "OpenRT"
author = "the OpenRT authors"
copyright = author  # noqa: A001
version = release = os.environ.get("OPENRT_VERSION", "")
extensions = ["myst_parser"]
try:
    import sphinx_copybutton  # noqa: F401
    extensions.append("sphinx_copybutton")
except ImportError:
    pass
myst_enable_extensions = ["colon_fence"]
myst_heading_anchors = 4
suppress_warnings = ["myst.header", "misc.highlighting_failure"]
html_theme = "furo"
html_title = "OpenRT " + version
html_static_path = ["static"]
html_css_files = ["site.css"]
html_show_sphinx = False
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {"navigation_with_keys": True, "top_of_page_button": None}
html_permalinks_icon = "#"
pygments_style = "friendly"
pygments_dark_style = "monokai"
highlight_language = "text"
primary_domain = None
toc_object_entries_show_parents = "hide"
c_id_attributes = ["RT_API", "RTS_EXPORT", "XS_EXPORT"]


def setup(app):
    app.add_lexer("vrml", VrmlLexer)
    app.add_lexer("node", NodeLexer)
