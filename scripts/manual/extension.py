"""The part of Sphinx that the site needs: mathematics as MathML, and scripts and styles in files of their own.

The content policy of the server permits no script and no ``<style>`` inside a page, and the theme writes one of each.
"""

from __future__ import annotations

import re
from html import escape
from pathlib import Path
from typing import Any

from docutils.nodes import SkipNode
from sphinx.application import Sphinx

from scenarios.report.mathml import mathml

INLINE = re.compile(r"<(script|style)((?:\s(?!src=)[\w-]+(?:=\"[^\"]*\")?)*)>(.*?)</\1>", re.S)
"""A script without a source, or a style, with its attributes and its text."""
SUFFIX = {"script": "js", "style": "css"}


def inline_equation(writer: Any, node: Any) -> None:
    """Write an equation inside a line."""
    writer.body.append(mathml(node.astext(), is_block=False))
    raise SkipNode


def block_equation(writer: Any, node: Any) -> None:
    """Write an equation with a line of its own."""
    writer.body.append(f'<div class="math">{mathml(node.astext(), is_block=True)}</div>\n')
    raise SkipNode


def to_files(app: Sphinx, failure: Exception | None) -> None:
    """Move the scripts and styles inside pages into files."""
    if failure is not None or app.builder.name not in ("html", "dirhtml"):
        return
    kept: dict[tuple[str, str], str] = {}
    folder = Path(app.outdir)
    for file in sorted(folder.rglob("*.html")):
        up = "../" * (len(file.relative_to(folder).parts) - 1)

        def outside(found: re.Match[str], up: str = up) -> str:
            kind, attributes, text = found[1], found[2], found[3].strip()
            name = kept.setdefault((kind, text), f"_static/inside-{len(kept)}.{SUFFIX[kind]}")
            if kind == "style":
                return f'<link rel="stylesheet" href="{escape(up + name)}">'
            return f'<script{attributes} src="{escape(up + name)}"></script>'

        file.write_text(INLINE.sub(outside, file.read_text()))
    for (_, text), name in kept.items():
        (folder / name).write_text(f"{text}\n")


def setup(app: Sphinx) -> dict[str, Any]:
    """Add both to Sphinx."""
    app.add_html_math_renderer("mathml", (inline_equation, None), (block_equation, None))
    app.connect("build-finished", to_files)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
