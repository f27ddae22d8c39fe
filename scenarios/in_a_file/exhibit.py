"""An exhibit: a scenario as one live page with its published run."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from scenarios.in_a_file.bench_file import bench_file
from scenarios.in_a_file.html import BuiltPage, html_of
from scenarios.in_a_file.published import published
from scenarios.schema import Scenario


@dataclass(frozen=True)
class Exhibit:
    """The text of the page, the part of its published run that it shows, and the commands that it has not."""

    text: str = field(repr=False)
    title: str
    record: dict[str, Any]
    left_out: list[str]


def exhibit(scenario: Scenario, built: BuiltPage | None, version: str, **beside: Any) -> Exhibit:
    """Return a scenario as a page; it runs once to its end for the published figures.

    Raises
    ------
    InputError
        When it cannot be a bench in a file.
    """
    made = bench_file(scenario)
    record = published(scenario)
    text = html_of(made, built, version, published=record, **beside)
    return Exhibit(text, made.document["title"], record, made.left_out)
