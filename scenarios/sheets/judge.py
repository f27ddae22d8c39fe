"""Judges an answer: it earns all points of a step, a part of them or none, with a reason."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from core.errors import InputError, short
from core.format import format_percent, format_short, unit_text
from scenarios.sheets.expression import evaluate
from scenarios.sheets.quantity import parse_quantity, unit_of
from scenarios.sheets.sheet import Answered, Choice, NumberQuestion

SMALLEST = 1e-12
"""Tolerance of a number that should be 0 when the sheet gives only a relative one."""


class AnswerVerdict(NamedTuple):
    """The share of the points that an answer earns, and the reason."""

    share: float
    reason: str


def judge(step: Answered, text: str, facts: Mapping[str, float]) -> AnswerVerdict:
    """Judge an answer.

    Raises
    ------
    InputError
        When it cannot be read; that costs nothing.
    """
    asked = step.asks
    return _choice(asked, text) if isinstance(asked, Choice) else _number(asked, text, facts)


def can_judge(step: Answered, facts: Mapping[str, float]) -> bool:
    """Return whether an answer can be judged: not if it needs the measurement of a step that was left out."""
    asked = step.asks
    if isinstance(asked, NumberQuestion):
        try:
            for formula in (asked.value, *(mistake.value for mistake in asked.mistakes)):
                evaluate(formula, facts)
        except InputError:
            return False
    return True


def solution(step: Answered, facts: Mapping[str, float]) -> str:
    """Return the right answer in words; shown once the step is closed."""
    asked = step.asks
    if isinstance(asked, Choice):
        return ", ".join(option.text for option in asked.options if option.share == 1.0)
    return format_short(evaluate(asked.value, facts), asked.unit)


def _choice(asked: Choice, text: str) -> AnswerVerdict:
    for option in asked.options:
        if option.id == text:
            word = "right" if option.share == 1.0 else "partly right" if option.share else "wrong"
            return AnswerVerdict(option.share, f"{word}: {option.because}" if option.because else word)
    raise InputError(f"no option is called {short(text)}", "answer", f"one of {', '.join(o.id for o in asked.options)}")


def _number(asked: NumberQuestion, text: str, facts: Mapping[str, float]) -> AnswerVerdict:
    """Compare a number with the right one; the first of these cases that fits decides."""
    given = parse_quantity(text)
    to_base, base = unit_of(asked.unit)
    right = evaluate(asked.value, facts) * to_base
    if given.base == base:
        if _near(given.value, right, asked.within, asked.within_absolute * to_base):
            return AnswerVerdict(1.0, "right")
        if asked.partly is not None and _near(given.value, right, asked.partly.within, 0.0):
            return AnswerVerdict(asked.partly.share, f"within {format_percent(asked.partly.within, 0)}")
        if asked.wrong_unit and _is_prefix_away(given.value, right, asked.within):
            power = round(math.log10(abs(given.value / right)))
            return AnswerVerdict(asked.wrong_unit, f"right value, wrong unit: it is a factor of 1e{power} away")
        for mistake in asked.mistakes:
            if _near(given.value, evaluate(mistake.value, facts) * to_base, asked.within, 0.0):
                return AnswerVerdict(mistake.share, mistake.because)
        if asked.wrong_sign and _near(-given.value, right, asked.within, asked.within_absolute * to_base):
            return AnswerVerdict(asked.wrong_sign, "right value, wrong sign")
        if asked.right_sign and given.value * right > 0.0:
            return AnswerVerdict(asked.right_sign, "right sign, wrong value")
        return AnswerVerdict(0.0, "wrong")
    named = "no unit" if not given.base else "wrong unit"
    number = given.value / given.factor
    if asked.wrong_unit and (
        _near(number, right / to_base, asked.within, asked.within_absolute)
        or _is_prefix_away(number, right / to_base, asked.within)
    ):
        return AnswerVerdict(
            asked.wrong_unit, f"right value, {named}; it is asked in {unit_text(asked.unit) or 'no unit'}"
        )
    return AnswerVerdict(0.0, f"wrong, and {named}" if base else "wrong: it has no unit")


def _near(value: float, right: float, relative: float, absolute: float) -> bool:
    return abs(value - right) <= max(relative * abs(right), absolute, SMALLEST if right == 0.0 else 0.0)


def _is_prefix_away(value: float, right: float, relative: float) -> bool:
    """Whether a number is right except for a prefix of its unit."""
    if value == 0.0 or right == 0.0 or value * right < 0.0:
        return False
    power = 3 * round(math.log10(value / right) / 3.0)
    return _near(value / 10.0**power, right, relative, 0.0)
