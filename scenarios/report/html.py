"""Reports as one HTML file that needs nothing else: templates, filled in with every text escaped."""

from __future__ import annotations

from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from core.format import format_number, format_short
from scenarios.key import code_version
from scenarios.report.palette import style
from scenarios.report.svg import paint

if TYPE_CHECKING:
    from jinja2 import Environment


@cache
def _templates() -> Environment:
    """Return the templates; their engine is loaded with the first report."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    templates = Environment(
        loader=FileSystemLoader(Path(__file__).parent / "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    templates.filters |= {"say": say, "paint": paint}  # the painter escapes the texts in a chart
    return templates


def page(template: str, title: str, **values: Any) -> str:
    """Fill in a template; each of its values must be given."""
    now = datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")
    common = {"title": title, "style": style(), "version": code_version(), "written": now}
    return _templates().get_template(template).render(**common, **values)


def say(value: Any) -> str:
    """Write a cell of a table: counts whole, other numbers with six digits."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return str(value)
    return format_number(value, 0) if isinstance(value, int) else format_short(value, "", 6)


def as_toml(document: dict[str, Any]) -> str:
    """Write a document as TOML, which has no null."""
    import tomlkit

    return tomlkit.dumps(_without_null(document))


def _without_null(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _without_null(entry) for name, entry in value.items() if entry is not None}
    return [_without_null(entry) for entry in value] if isinstance(value, list) else value
