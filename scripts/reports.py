"""The outcomes of tests as pytest, vitest and Playwright write them: JUnit's XML."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

COLOUR = re.compile(r"\x1b\[[\d;]*m")
TELLING = re.compile(
    r"^(E  |>|\s*(Error|Locator|Expected|Received|AssertionError)\b|\s+> *\d+ \||\s+[-+] \S|server said)"
)
MOST_LINES, WIDTH = 8, 200


@dataclass(frozen=True)
class Outcome:
    """How one test ended: passed, failed or skipped, and the text of a failure."""

    name: str
    state: str
    seconds: float
    text: str = ""

    @property
    def reason_lines(self) -> list[str]:
        """The lines that say why the test failed; none if it did not."""
        if self.state != "failed":
            return []
        lines = COLOUR.sub("", self.text).splitlines()
        told = [line for line in lines if TELLING.match(line)] or lines
        return [f"FAILED {self.name}", *(line.rstrip()[:WIDTH] for line in told[:MOST_LINES])]


def read(path: Path) -> list[Outcome]:
    """Read a report; a step that broke off may have written none."""
    try:
        root = ElementTree.parse(path).getroot()
    except (OSError, ElementTree.ParseError):
        return []
    return [_outcome(case) for case in root.iter("testcase")]


def _outcome(case: ElementTree.Element) -> Outcome:
    name = f"{case.get('classname', '')}::{case.get('name', '')}"
    seconds = float(case.get("time") or 0.0)
    for state, tags in (("failed", ("failure", "error")), ("skipped", ("skipped",))):
        for tag in tags:
            if (found := case.find(tag)) is not None:
                return Outcome(name, state, seconds, f"{found.get('message', '')}\n{found.text or ''}")
    return Outcome(name, "passed", seconds)
