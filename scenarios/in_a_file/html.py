"""The HTML file of a bench: the page that was built, the bench's code and its numbers in one text."""

from __future__ import annotations

import html
from pathlib import Path

from core.errors import InputError
from scenarios.in_a_file.bench_file import BenchFile
from scenarios.in_a_file.pack import packed, text_of

SCRIPT, STYLE = "page.js", "page.css"
POLICY = "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval'; style-src 'unsafe-inline'"
"""It asks no server for anything, and the browser holds it to that."""
PAGE = """<!doctype html>
<html lang="en" data-mantine-color-scheme="dark">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="dark light">
<title>{title}</title>
<style>{style}</style>
</head>
<body>
<p>{summary}</p>
<noscript><p>The bench is computed by this page: allow scripts to see it run.</p></noscript>
<script type="text/plain" id="code">{code}</script>
<script type="text/plain" id="pack">{pack}</script>
<script>{script}</script>
</body>
</html>
"""


def html_of(bench: BenchFile, built: Path, version: str) -> str:
    """Return the file.

    Parameters
    ----------
    bench : BenchFile
        The bench.
    built : Path
        The folder with script and style sheet of the page.
    version : str
        Of this project; the file says by which it was made.

    Raises
    ------
    InputError
        When the page has not been built.
    """
    try:
        script, style = ((built / name).read_text("utf-8") for name in (SCRIPT, STYLE))
    except OSError:
        raise InputError("the page has not been built", "--html", "build it: make setup in a checkout") from None
    return PAGE.format(
        policy=POLICY,
        title=html.escape(bench.document["title"]),
        summary=html.escape(bench.document["summary"]),
        style=style.replace("</", r"<\/"),
        code=text_of(bench.code),
        pack=text_of(packed({**bench.document, "version": version})),
        script=script.replace("</", r"<\/"),
    )
