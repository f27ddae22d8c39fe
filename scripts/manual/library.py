"""The page of the library: every scenario with its claim."""

from __future__ import annotations

from manual.markdown import code, page, shown, table
from scenarios.library import get, ids


def pages() -> dict[str, str]:
    """Return the page by its address."""
    about = "`combbench run ID` runs a scenario, and the gallery of the page opens it."
    rows = [
        (code(name), shown(head.title), shown(head.claim or ""), shown(head.source))
        for name in ids()
        for head in [get(name).head]
    ]
    text = table(("id", "title", "claim", "source"), rows)
    return {"reference/library": page("Library of scenarios", "For people who look for an experiment.", [about, text])}
