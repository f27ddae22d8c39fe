"""Texts for people: units and powers of ten are printed, never typed, wherever they are read."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from core.registry import catalog
from scenarios.campaign.sweep import Sweep
from scenarios.campaign.tally import PointTally, Spread
from scenarios.lectures import lecture, lecture_ids
from scenarios.library import get, ids
from scenarios.report.campaign import campaign_report

TYPED = re.compile(r"(?<![\w.{])u[mNV]\b|\d\s?us\b|(?<![\w.])\d+(?:\.\d+)?e[-+]?\d+\b|\+/-")
"""A unit or a power of ten as it is typed: in um, 20 us, 1e-9."""


def of_scenarios() -> Iterator[tuple[str, str]]:
    """Yield the texts of the library."""
    for name in ids():
        head = get(name).head
        yield from ((name, text) for text in (head.title, head.summary, head.claim, head.source))
        for entry in head.expect:
            yield from ((name, text) for text in (entry.published, entry.note, entry.reason, entry.text()))
        for mark in head.printed:
            yield from ((name, text) for text in (mark.words, mark.number, mark.reading))


def of_catalogue() -> Iterator[tuple[str, str]]:
    """Yield the texts of the blocks."""
    for card in catalog():
        yield from ((card.name, text) for text in (card.title, card.summary, *card.weaknesses))
        yield from ((f"{card.name}.{one.name}", one.meaning) for one in card.parameters)
        yield from ((card.name, one.why or "") for one in card.equations)


def of_lectures() -> Iterator[tuple[str, str]]:
    """Yield the texts of the lectures."""
    for name in lecture_ids():
        head = lecture(name).head
        yield name, head.summary
        for cue in head.cues:
            yield from ((name, text) for text in (cue.title, cue.say, cue.ask, cue.see))


def test_no_text_has_a_unit_or_a_power_of_ten_as_it_is_typed() -> None:
    texts = [*of_scenarios(), *of_catalogue(), *of_lectures()]
    assert len(texts) > 3000
    assert not [(where, text) for where, text in texts if TYPED.search(text)]


def test_a_report_writes_figures_as_they_are_printed() -> None:
    sweep = Sweep({"schema": 1, "scenario": "ch5-seven-step", "grid": {"sensor.noise_um": [1e-6, 0.02]}})
    figure: dict[str, Any] = {"control.rms_error_um": Spread(2, 7.09e-7, 7e-10, 7e-7, 7.1e-7)}
    points = [PointTally({"sensor.noise_um": noise}, 2, 2, 0, [], [], figure, {}) for noise in (1e-6, 0.02)]
    text = re.sub(r"<(style|pre)>.*?</\1>|<[^>]+>", " ", campaign_report(sweep, points), flags=re.DOTALL)
    assert not TYPED.search(text), TYPED.search(text)
    assert "709.00\u00a0±\u00a00.70" in text and "rms error, fm" in text
