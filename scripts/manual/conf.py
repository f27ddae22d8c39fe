"""Settings of Sphinx for the site."""

from server.version import VERSION


def colours(page: str, side: str, hover: str, line: str, text: str, quiet: str, link: str, code: str) -> dict[str, str]:
    """Return the colours of the site, from those of the page of the bench."""
    return {
        "color-background-primary": page,
        "color-background-secondary": side,
        "color-background-hover": hover,
        "color-background-border": line,
        "color-foreground-primary": text,
        "color-foreground-secondary": quiet,
        "color-foreground-muted": quiet,
        "color-inline-code-background": code,
        "color-code-background": code,
        **dict.fromkeys(("color-brand-primary", "color-brand-content", "color-brand-visited"), link),
    }


FONT = {"font-stack": "system-ui, sans-serif"}
LIGHT = colours("#ffffff", "#f3f5f8", "#e6ebf1", "#d5dce3", "#1a1f26", "#56616e", "#2c55c8", "#f3f5f8")
DARK = colours("#11161b", "#161b21", "#27303a", "#2a333d", "#e8ecf1", "#9aa6b4", "#8fb0ff", "#1e252d")

project = "CombBench"
author = "CombBench authors"
copyright = "CombBench authors, MIT licence"
version = release = VERSION
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "manual.extension"]
language = "en"
default_role = "code"

myst_enable_extensions = ["deflist"]
myst_heading_anchors = 4

autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
python_use_unqualified_type_names = True
napoleon_google_docstring = False
napoleon_use_rtype = False

html_theme = "furo"
html_title = "CombBench"
html_favicon = "../../web/public/comb.svg"
html_static_path = ["static"]
html_css_files = ["manual.css"]
html_math_renderer = "mathml"
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {"light_css_variables": FONT | LIGHT, "dark_css_variables": DARK}
