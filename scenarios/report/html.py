"""Reports as one HTML file that needs nothing else: its style, its tables."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from datetime import UTC, datetime
from html import escape
from typing import Any

import tomlkit

from core.format import format_short
from scenarios.key import code_version

STYLE = """
:root { color-scheme: light dark }
body { font: 15px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 70rem; padding: 0 1rem }
table { border-collapse: collapse; margin: .5rem 0 1.5rem; font-variant-numeric: tabular-nums }
th, td { padding: .15rem .6rem; text-align: right; border-bottom: 1px solid #8884 }
th:first-child, td:first-child { text-align: left }
.wide { overflow-x: auto } .side { display: flex; flex-wrap: wrap; gap: 1.5rem; align-items: start }
svg text { font: 11px system-ui, sans-serif; fill: currentColor } svg .title { font-weight: 600 }
svg .x { text-anchor: middle } svg .y { text-anchor: end } svg .grid { stroke: #8884; fill: none }
svg .mark { stroke: #888; stroke-dasharray: 2 2 }
.keys { font-size: 13px } .key { margin-right: 1rem; white-space: nowrap } pre { overflow-x: auto }
.miss { color: #c33 } footer { opacity: .7; margin-top: 3rem }
"""


def page(title: str, body: str) -> str:
    """Wrap a body into an HTML document that loads nothing."""
    now = datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        f'<meta name="viewport" content="width=device-width"><style>{STYLE}</style></head>'
        f"<body><h1>{escape(title)}</h1>"
        f"{body}<footer>CombBench, code {code_version()}, written {now}</footer></body></html>\n"
    )


def table(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """Write a table; numbers with six digits."""
    titles = "".join(f"<th>{escape(name)}</th>" for name in head)
    body = "".join("<tr>" + "".join(f"<td>{escape(say(cell))}</td>" for cell in row) + "</tr>" for row in rows)
    return f'<div class="wide"><table><thead><tr>{titles}</tr></thead><tbody>{body}</tbody></table></div>'


def say(value: Any) -> str:
    """Write a cell of a table."""
    return format_short(value, "", 6) if isinstance(value, float) else str(value)


def as_toml(document: dict[str, Any]) -> str:
    """Write a document as TOML, which has no null."""
    return tomlkit.dumps(_without_null(document))


def _without_null(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _without_null(entry) for name, entry in value.items() if entry is not None}
    return [_without_null(entry) for entry in value] if isinstance(value, list) else value
