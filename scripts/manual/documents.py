"""Documents and notebooks of the checkout as pages of the site: links lead to pages, or to files of the checkout."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path, PurePosixPath
from typing import Any

from pygments.lexers import find_lexer_class_by_name
from pygments.util import ClassNotFound

from manual.plan import FOLDERS, ROOT, places

FENCE = re.compile(r"(^```.*?^```$)", re.M | re.S)
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s#]*)(#[^)\s]+)?\)")
FILES = "files"
"""Folder of the site's source with the files that pages show or offer."""


class Documents:
    """Pages of documents, and the files that they show or offer."""

    def __init__(self) -> None:
        self._places = places()
        self.files: dict[str, Path] = {}

    def pages(self) -> dict[str, str]:
        """Return the pages by their address, and fill `files`."""
        return {address: self._page(source, address) for source, address in self._places.items()}

    def linked(self, text: str, source: str, address: str) -> str:
        """Return the text of a document with links for the place of its page.

        Parameters
        ----------
        text : str
            Markdown.
        source, address : str
            Path of the document in the checkout; address of the page.
        """
        parts = FENCE.split(text)
        return "".join(
            _fence(part) if number % 2 else LINK.sub(lambda found: self._link(found, source, address), part)
            for number, part in enumerate(parts)
        )

    def _page(self, source: str, address: str) -> str:
        text = (ROOT / source).read_text()
        if source.endswith(".ipynb"):
            text = self._notebook(json.loads(text), source)
        return self.linked(text, source, address)

    def _notebook(self, notebook: dict[str, Any], source: str) -> str:
        """Return the cells of a notebook as Markdown, with its readers and the notebook itself."""
        cells = [(cell["cell_type"], "".join(cell["source"])) for cell in notebook["cells"]]
        texts = [text if kind == "markdown" else f"```python\n{text}\n```" for kind, text in cells]
        title, _, first = texts[0].partition("\n")
        name = Path(source).name
        readers = f"For people who work in notebooks. The cells are those of [`{name}`]({name})."
        return "\n\n".join([title, readers, first.strip(), *texts[1:]]) + "\n"

    def _link(self, found: re.Match[str], source: str, address: str) -> str:
        mark, words, target, heading = found[1], found[2], found[3], found[4] or ""
        if target.startswith(("http:", "https:", "mailto:")) or not target:
            return found[0]
        path = os.path.normpath(PurePosixPath(source).parent / target)
        if (to := self._places.get(path)) or (to := FOLDERS.get(path)):
            is_whole = path in FOLDERS
            return f"{mark}[{words}]({_relative(f'{to}.md', address)}{'' if is_whole else heading})"
        if not (ROOT / path).is_file():  # a folder of the checkout has no page
            return words
        self.files[f"{FILES}/{path}"] = ROOT / path
        return f"{mark}[{words}]({_relative(f'{FILES}/{path}', address)})"


def _relative(target: str, address: str) -> str:
    return os.path.relpath(target, PurePosixPath(address).parent)


def _fence(text: str) -> str:
    """Return a block of code; a language without colours is text."""
    language, rest = text[3:].split("\n", 1)
    try:
        find_lexer_class_by_name(language or "text")
    except ClassNotFound:
        language = "text"
    return f"```{language or 'text'}\n{rest}"


def readers_of(text: str) -> str:
    """Return the readers of a page: its first sentence that begins with *For*."""
    found = re.search(r"^For (.+?)(?:\.|:)(?:\s|$)", text, re.M | re.S)
    return " ".join(found[1].split()) if found else ""


def title_of(text: str) -> str:
    """Return the title of a page."""
    return text.partition("\n")[0].removeprefix("# ")
