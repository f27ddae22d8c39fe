"""Markdown of generated pages: text that is shown as it is, tables, mathematics."""

from __future__ import annotations

import re
from collections.abc import Iterable

SPECIAL = re.compile(r"([\\<>*\[\]|{}])")
MARKED = re.compile(r"(:math:`[^`]+`|``[^`]+``|`[^`]+`)")
"""Mathematics and code in a docstring."""


def shown(text: str) -> str:
    """Return a text of the code as Markdown: mathematics and code keep their marks, signs of Markdown are escaped."""
    parts = MARKED.split(text)
    return "".join(_marked(part) if number % 2 else SPECIAL.sub(r"\\\1", part) for number, part in enumerate(parts))


def _marked(part: str) -> str:
    return f"{{math}}{part[6:]}" if part.startswith(":math:") else f"`{part.strip('`')}`"


def code(text: object) -> str:
    """Return a name or a value as code, or nothing for an empty one; a grave accent in it is left out."""
    written = str(text).replace("`", "")
    return f"`{written}`" if written else ""


def block(latex: str) -> str:
    """Return an equation with a line of its own."""
    return f"```{{math}}\n{latex}\n```"


def table(heads: tuple[str, ...], rows: Iterable[Iterable[str]]) -> str:
    """Return a table, or nothing where it has no rows; a bar in a cell does not end the cell."""
    lines = ["| " + " | ".join(re.sub(r"(?<!\\)\|", r"\\|", cell) for cell in row) + " |" for row in rows]
    return "\n".join([f"| {' | '.join(heads)} |", "|---" * len(heads) + "|", *lines]) if lines else ""


def page(title: str, readers: str, parts: Iterable[str]) -> str:
    """Return a page with its title and its readers; empty parts are left out."""
    return "\n\n".join([f"# {title}", readers, *filter(None, parts)]) + "\n"


def menu(pages: Iterable[str]) -> str:
    """Return the part of the menu that lists pages, relative to this one."""
    return "\n".join(["```{toctree}", ":hidden:", "", *pages, "```"])
