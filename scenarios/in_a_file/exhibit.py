"""An exhibit: a scenario as one live page with its published run."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from scenarios.in_a_file.bench_file import BenchFile
from scenarios.in_a_file.html import BuiltPage, html_of
from scenarios.in_a_file.published import published
from scenarios.schema import Scenario


@dataclass(frozen=True)
class Exhibit:
    """The text of the page, and the part of its published run that it shows."""

    text: str = field(repr=False)
    record: dict[str, Any]


def exhibit(scenario: Scenario, made: BenchFile, built: BuiltPage | None, version: str, **beside: Any) -> Exhibit:
    """Return a scenario and its bench as a page; the scenario runs once to its end for the published figures."""
    record = published(scenario)
    return Exhibit(html_of(made, built, version, published=record, **beside), record)
