"""Conditions on signals: '<signal> > <value>'."""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import dataclass

from core.errors import InputError, finite, unknown

_FORM = re.compile(r"^\s*(\S+)\s*(>|<)\s*(\S+)\s*$")


@dataclass(frozen=True)
class Condition:
    """A signal above or below a value."""

    signal: str
    sign: float
    threshold: float

    def holds(self, value: float) -> bool:
        """Say whether a value of the signal meets it."""
        return self.sign * (value - self.threshold) > 0.0


def parse_condition(text: str, seen: Collection[str]) -> Condition:
    """Read a condition on one of the signals that can be seen.

    Raises
    ------
    InputError
        When it is not of the form, the signal does not exist or the value is no number.
    """
    found = _FORM.match(text)
    if not found:
        raise InputError(f"must be '<signal> > <value>' or '<signal> < <value>', got {text!r}", "when")
    signal, comparison, value = found.groups()
    if signal not in seen:
        raise unknown("signal", signal, sorted(seen), "when")
    try:
        threshold = finite(float(value), "when")
    except ValueError:
        raise InputError(f"{value!r} is not a finite number", "when") from None
    return Condition(signal, 1.0 if comparison == ">" else -1.0, threshold)
