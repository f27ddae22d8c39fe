"""The questions of a lab sheet that a file can judge: numbers, within their tolerance.

A file holds no secret. The right answer to a question with few choices would be found by trying, so such questions stay
with the teacher; so do steps that watch the bench, and hidden faults, whose truth only a server can keep.
"""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass
from typing import Any

from core.errors import InputError
from core.format import format_short
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.schema import Scenario
from scenarios.sheets.begin import begin
from scenarios.sheets.expression import evaluate
from scenarios.sheets.judge import can_judge
from scenarios.sheets.sheet import INSERTED, Answered, NumberQuestion, Sheet


@dataclass(frozen=True)
class FileSheet:
    """A lab sheet in a file: the bench that it begins with, its questions for numbers, and a line about the others."""

    scenario: Scenario
    document: dict[str, Any]


def file_sheet(sheet: Sheet) -> FileSheet:
    """Return a lab sheet for a file; every copy of it has the same device and the same numbers.

    Raises
    ------
    InputError
        When it asks for no number that its file can judge.
    """
    beginning = begin(sheet, lambda purpose: _seed(sheet.id, purpose))
    asked, left = [], 0
    for section in sheet.sections:
        step = section.step
        if not isinstance(step, Answered) or step.number is None or not can_judge(step, beginning.facts):
            left += step is not None
            continue
        asked.append(
            {
                "heading": section.heading,
                "text": inserted(section.text, beginning.facts),
                "question": inserted(step.question, beginning.facts),
                "points": step.points,
                "tries": step.tries,
                **_number(step.number, beginning.facts),
            }
        )
    if not asked:
        raise InputError(f"sheet {sheet.id} asks for no number that a file can judge", "--sheet")
    rest = f"{left} other step{'s' * (left != 1)} of the sheet: with your teacher." if left else ""
    document = {
        "title": sheet.head.title,
        "intro": inserted(sheet.intro, beginning.facts),
        "questions": asked,
        "rest": rest,
    }
    return FileSheet(with_values(get(sheet.head.bench.scenario), beginning.values), document)


def inserted(text: str, facts: dict[str, float]) -> str:
    """Return a text with its formulas as numbers; a formula over a measurement becomes three dots."""

    def number(found: Any) -> str:
        try:
            return format_short(evaluate(found[1], facts), found[2] or "")
        except InputError:
            return "..."

    return _plain(INSERTED.sub(number, text))


def _plain(text: str) -> str:
    """Return the words of Markdown: no displayed equation, no marks of emphasis, a line for each paragraph."""
    words = re.sub(r"\$([^$\\]+)\$", r"\1", re.sub(r"\$\$.*?\$\$", "", text, flags=re.DOTALL))
    paragraphs = re.split(r"\n\s*\n", re.sub(r"\*+([^*\n]+)\*+", r"\1", words))
    return "\n\n".join(" ".join(one.split("\n")).strip() for one in paragraphs if one.strip())


def _number(asked: NumberQuestion, facts: dict[str, float]) -> dict[str, Any]:
    return {
        "value": evaluate(asked.value, facts),
        "unit": asked.unit,
        "within": asked.within,
        "within_absolute": asked.within_absolute,
        "partly": asked.partly.model_dump() if asked.partly is not None else None,
    }


def _seed(*words: str) -> int:
    return int.from_bytes(hashlib.sha256("\0".join(words).encode()).digest()[:8], "big")
