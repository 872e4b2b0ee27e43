"""The site: `sphinx-build notebooks build/site`."""

from __future__ import annotations

import html
import os
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "site"))

import equations
import pages
from docutils import nodes
from sphinx import addnodes

import zerodrift

OWNER, _, NAME = os.environ.get("GITHUB_REPOSITORY", "").partition("/")      # where the site is published from a repository
ABOUT = "Mechanisms in Python whose joints stay closed to rounding error: simulation, reactions, films, a drawing board, in the plane and in space"
POLICY = "default-src 'self'; script-src 'self' 'unsafe-inline'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; font-src 'self' data:; object-src 'none'"

project, author, release = "zerodrift", "the zerodrift developers", zerodrift.__version__
extensions = ["myst_nb", "numpydoc", "sphinx.ext.autodoc", "sphinx.ext.autosummary"]
exclude_patterns = ["site", "generated/extra"]
templates_path = ["site/templates"]
source_suffix = {".rst": "restructuredtext", ".md": "myst-nb", ".ipynb": "myst-nb"}

nb_render_markdown_format = "myst"      # with tables
nb_execution_mode = "off"               # stored outputs are shown; the test suite executes the notebooks
myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
myst_update_mathjax = False
html_math_renderer = "mathml"
suppress_warnings = ["mystnb.unknown_mime_type"]

autosummary_generate = True
autodoc_member_order = "bysource"
autodoc_typehints = "none"              # signatures are short: types stand beside the arguments
numpydoc_show_class_members = False
nitpick_ignore_regex = [        # types of other packages, classes behind public functions, and names of arguments and attributes
    ("py:class", r"(numpy|matplotlib|collections|pathlib|np|concurrent|cffi|ffi)\b.*"), ("py:class", r"zerodrift\.[a-z_]\w*\..*"),
    ("py:class", r"(?!zerodrift)[^.]*"), ("py:class", r"sympy\..*"), ("py:obj", r"[a-z_]\w*"),
    ("py:obj", r"(numba|sympy|concurrent)\..*"), ("py:obj", r"(D|Heaviside)"), ("py:obj", r".*[(\[].*"),
    ("py:obj", r"([A-Z]\w*|system)\.[a-z_]\w*"),
]
default_role = "py:obj"
numpydoc_xref_param_type = False

html_theme = "pydata_sphinx_theme"
html_title = "zerodrift"
html_theme_options = {"show_prev_next": False, "navbar_align": "left", "secondary_sidebar_items": ["page-toc", "notebook"],
                      "icon_links": [{"name": "Repository", "url": f"https://github.com/{OWNER}/{NAME}", "icon": "fa-brands fa-github"},
                                     {"name": "Issues", "url": f"https://github.com/{OWNER}/{NAME}/issues", "icon": "fa-solid fa-circle-dot"}]
                      if OWNER else []}
html_copy_source, html_sourcelink_suffix = True, ""       # notebooks can be downloaded
html_domain_indices = False
html_extra_path = ["generated/extra", "../LICENSE", "../CITATION.cff", "../CHANGELOG.md"]      # films of the gallery first
html_favicon = "site/templates/icon.svg"
html_baseurl = f"https://{OWNER}.github.io/{NAME}/" if OWNER else ""
html_static_path, html_css_files = ["site/templates/site.css", "site/mechanisms.png", "site/templates/tables.js", "generated/fonts"], ["site.css"]
html_js_files = [("tables.js", {"defer": ""})]
html_context = {"default_mode": "auto"}


def describe(app: object, page: str, template: str, context: dict, doctree: object) -> None:
    """Description, picture for links, and a policy: a page loads what is of this site alone."""
    tags = {"description": ABOUT, "og:title": context.get("title", project), "og:description": ABOUT,
            "og:image": f"{html_baseurl}_static/mechanisms.png"}
    context["metatags"] = context.get("metatags", "") + f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">' + "".join(
        f'<meta {"property" if name.startswith("og") else "name"}="{name}" content="{html.escape(text, quote=True)}">' for name, text in tags.items())


def links(app: object, doctree: nodes.document, page: str) -> None:
    """The first sentence of each page, or two short ones, beside its link in the list of its section."""
    if not page.endswith("/index"):
        return
    for tree in list(doctree.findall(addnodes.toctree)):
        lines = nodes.bullet_list()
        for _, name in tree["entries"]:
            first = next(app.env.get_doctree(name).findall(nodes.paragraph), nodes.paragraph())
            text = "".join(each.astext() for each in first.findall(nodes.Text) if not isinstance(each.parent, nodes.raw))
            link = nodes.reference("", app.env.titles[name].astext(), internal=True, refuri=app.builder.get_relative_uri(page, name))
            sentence = re.match(r".{0,30}.*?(?=[.?](\s|$)|:?$)[.?]?", " ".join(text.split()))[0]
            lines += nodes.list_item("", nodes.paragraph("", "", link, nodes.inline("", f": {sentence}")))
        tree.replace_self(lines)


def setup(app: object) -> None:
    """Write the generated pages before Sphinx looks for files; equations are MathML."""
    app.add_html_math_renderer("mathml", (equations.inline, None), (equations.block, None))
    app.connect("doctree-read", equations.offline)
    app.connect("html-page-context", describe)
    app.connect("doctree-resolved", links)
    pages.write(Path(__file__).parent / "generated")
