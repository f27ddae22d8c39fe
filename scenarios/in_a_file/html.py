"""The page of a bench: the page that was built, the bench's code and its numbers."""

from __future__ import annotations

import html
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from core.errors import InputError
from scenarios.in_a_file.bench_file import BenchFile
from scenarios.in_a_file.pack import packed, text_of

SCRIPT, STYLE = "page.js", "page.css"
POLICY = "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval'; style-src 'unsafe-inline'"
"""It asks no server for anything, and the browser holds it to that."""
SHARED_POLICY = (
    "default-src 'none'; script-src 'self' file: 'unsafe-inline' 'wasm-unsafe-eval'; "
    "style-src 'self' file: 'unsafe-inline'"
)
"""The same, with the shared parts of its own folder."""
PAGE = """<!doctype html>
<html lang="en" data-mantine-color-scheme="dark">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="dark light">
<title>{title}</title>
{style}
</head>
<body>
<p>{summary}</p>
<noscript><p>The bench is computed by this page: allow scripts to see it run.</p></noscript>
<script type="text/plain" id="code">{code}</script>
<script type="text/plain" id="pack">{pack}</script>
{script}
</body>
</html>
"""


@dataclass(frozen=True)
class BuiltPage:
    """Script and style sheet of the page of a bench in a file."""

    script: str
    style: str

    @staticmethod
    def of(folder: Path) -> BuiltPage:
        """Read both from the folder of the build.

        Raises
        ------
        InputError
            When the page has not been built.
        """
        try:
            return BuiltPage(*((folder / name).read_text("utf-8") for name in (SCRIPT, STYLE)))
        except OSError:
            raise InputError("the page has not been built", "--html", "build it: make setup in a checkout") from None


def html_of(bench: BenchFile, built: BuiltPage | None, version: str, **beside: Any) -> str:
    """Return the page of a bench.

    Parameters
    ----------
    bench : BenchFile
        The bench.
    built : BuiltPage, optional
        Script and style sheet that become a part of it; without them it takes both from its folder.
    version : str
        Of this project; the page says by which it was made.
    beside : dict
        Added to its document.
    """
    if built is None:
        style = f'<link rel="stylesheet" href="{STYLE}">'
        script = f'<script src="{SCRIPT}"></script>'
    else:
        style = "<style>" + built.style.replace("</", r"<\/") + "</style>"
        script = "<script>" + built.script.replace("</", r"<\/") + "</script>"
    return PAGE.format(
        policy=SHARED_POLICY if built is None else POLICY,
        title=html.escape(bench.document["title"]),
        summary=html.escape(bench.document["summary"]),
        style=style,
        code=text_of(bench.code),
        pack=text_of(packed({**bench.document, "version": version, **beside})),
        script=script,
    )
