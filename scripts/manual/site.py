"""The source of the site: all pages in Markdown, and the files that they show or offer."""

from __future__ import annotations

import shutil
from pathlib import Path

from manual import blocks, interface, library, names
from manual.documents import Documents, readers_of, title_of
from manual.markdown import menu
from manual.plan import ROOT, SECTIONS

GENERATED = ("reference/python", "reference/rest/index", "reference/blocks/index", "reference/errata")
LAST = ("reference/library", "reference/unit-names")
"""Generated pages in the menu of the reference, before and after its documents."""


def pages() -> tuple[dict[str, str], dict[str, Path]]:
    """Return the pages by address, and the files by their place in the source."""
    documents = Documents()
    found = documents.pages()
    for source in (blocks, interface, library, names):
        found |= source.pages()
    for name in SECTIONS:
        found[f"{name}/index"] = _section(name, found)
    found["index"] = _first(documents, found)
    return found, documents.files


def write(folder: Path) -> None:
    """Write the source of the site into a folder."""
    texts, files = pages()
    for address, text in texts.items():
        file = folder / f"{address}.md"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    for place, path in files.items():
        (folder / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, folder / place)


def listed(name: str) -> list[str]:
    """Return the pages of a section in the order of the menu."""
    own = [f"{name}/{Path(document).stem.lower()}" for document in SECTIONS[name].documents]
    return [*GENERATED, *own, *LAST] if name == "reference" else own


def _section(name: str, found: dict[str, str]) -> str:
    """Write the first page of a section: its pages with their readers."""
    section = SECTIONS[name]
    below = [(address.removeprefix(f"{name}/"), found[address]) for address in listed(name)]
    lines = [f"- [{title_of(text)}]({page}.md){_readers(text)}" for page, text in below]
    return (
        "\n\n".join([f"# {section.title}", section.purpose, "\n".join(lines), menu(page for page, _ in below)]) + "\n"
    )


def _readers(text: str) -> str:
    readers = readers_of(text)
    return f"  \n  For {readers}" if readers else ""


def _first(documents: Documents, found: dict[str, str]) -> str:
    """Write the first page: the beginning of the README, and the sections with their pages."""
    head = (ROOT / "README.md").read_text().partition("\n```")[0]
    parts = [documents.linked(head, "README.md", "index")]
    for name, section in SECTIONS.items():
        links = " · ".join(f"[{title_of(found[address])}]({address}.md)" for address in listed(name))
        parts.append(f"## [{section.title}]({name}/index.md)\n\n{section.purpose}\n\n{links}")
    return "\n\n".join([*parts, menu(f"{name}/index" for name in SECTIONS)]) + "\n"
