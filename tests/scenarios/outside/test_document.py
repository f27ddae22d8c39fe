"""The document of other languages is right: its blocks run unchanged, and their output equals the printed output."""

from __future__ import annotations

import contextlib
import io
import re
from pathlib import Path
from typing import Any

from core.board.outside import Sample
from scenarios.outside.process import SAMPLE

DOCUMENT = Path(__file__).resolve().parents[3] / "docs" / "other-languages.md"


def test_its_blocks() -> None:
    text = DOCUMENT.read_text()
    code = re.findall(r"```python\n(.*?)```\n\n```text\n(.*?)```", text, re.S)
    assert code and len(code) == text.count("```python")
    names: dict[str, Any] = {"__name__": "document"}
    for number, (block, said) in enumerate(code):
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(block, f"other-languages.md, block {number}", "exec"), names)
        assert printed.getvalue() == said


def test_its_message_is_the_sample() -> None:
    text = DOCUMENT.read_text()
    assert f"`{', '.join(Sample._fields)}`" in text and f"| {SAMPLE.size} |" in text
