"""The sections of the site, and the documents of the checkout in each."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
SITE = ROOT / "docs" / "site"
"""The folder of the built site; the server serves it under ``/docs``."""


class Section(NamedTuple):
    """A part of the site.

    Attributes
    ----------
    title, purpose : str
        Heading, and a sentence for readers who look for a page.
    documents : tuple of str
        Paths in the checkout, in the order of the menu.
    """

    title: str
    purpose: str
    documents: tuple[str, ...]


NOTEBOOKS = ("first-run", "own-controller", "own-diagnoser", "lqg", "campaign", "design")
DESIGN = ("tick", "blocks", "bits", "units", "live", "stream", "classes", "runs", "verdicts", "testing", "layout")

SECTIONS = {
    "tutorials": Section(
        "Tutorials",
        "Lessons to follow from the first line to the last.",
        (
            *(f"docs/{name}.md" for name in ("walk-through", "python", "rest", "own-units")),
            *(f"docs/notebooks/{name}.ipynb" for name in NOTEBOOKS),
        ),
    ),
    "how-to": Section(
        "How-to guides",
        "Steps to a certain goal, for readers who know the bench.",
        (
            *(f"docs/{name}.md" for name in ("your-device", "teaching", "sheets", "lectures", "lti", "in-a-file")),
            *(f"docs/{name}.md" for name in ("other-languages", "generated-clients", "scaling")),
            *(f"docs/{name}.md" for name in ("behind-a-proxy", "container")),
            *("SECURITY.md", "SUPPORT.md", "CONTRIBUTING.md"),
        ),
    ),
    "reference": Section(
        "Reference",
        "Every name, block, route, command and setting, generated from the code.",
        (
            *(f"docs/{name}.md" for name in ("command-line", "settings", "scenario", "benchmark", "claims", "figures")),
            "CHANGELOG.md",
        ),
    ),
    "explanation": Section(
        "Explanation",
        "The design of CombBench and the reasons for it.",
        ("ARCHITECTURE.md", *(f"docs/design/{name}.md" for name in DESIGN)),
    ),
}
FOLDERS = {"README.md": "index", "docs/notebooks": "tutorials/index", "docs/design": "explanation/index"}
"""Pages of the site that stand for a file or a folder of the checkout."""


def places() -> dict[str, str]:
    """Return the address of each document in the site, by its path in the checkout."""
    return {
        document: f"{name}/{Path(document).stem.lower()}"
        for name, section in SECTIONS.items()
        for document in section.documents
    }
