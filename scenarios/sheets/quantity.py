"""Numbers with units as people type them: "2.48 kHz", "−0.55 µm/V", "4.9"."""

from __future__ import annotations

import math
import re
from typing import NamedTuple

from core.errors import InputError, short
from core.format import MINUS, PREFIXES, RAISED, UNITS, unit_text

_FORM = re.compile(r"^([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(.*)$", re.DOTALL)
_PREFIX = {prefix.strip(): scale for scale, prefix in PREFIXES if prefix.strip()} | {"u": 1e-6, "μ": 1e-6}
_BASES = {name for _, name in UNITS.values()}
LONGEST = 80
LOWERED = {raised: chr(plain) for plain, raised in RAISED.items()}


class Quantity(NamedTuple):
    """A value in the base of its unit, such as Hz or m, and that base; no unit has an empty one."""

    value: float
    base: str
    factor: float
    """Multiplier of the typed number."""


def unit_of(text: str) -> tuple[float, str]:
    """Return the factor of a unit to its base, and the base; any prefix is read, other units are their own base."""
    plain = _tidy(text)
    known = {_tidy(name): found for name, found in UNITS.items()} | {_tidy(unit_text(n)): f for n, f in UNITS.items()}
    if plain in known:
        return known[plain][0], _tidy(known[plain][1])
    bases = {_tidy(base) for base in _BASES}
    if plain in bases:
        return 1.0, plain
    if plain[:1] in _PREFIX and plain[1:] in bases:
        return _PREFIX[plain[:1]], plain[1:]
    return 1.0, {"°": "deg", "degrees": "deg", "percent": "%"}.get(plain, plain)


def parse_quantity(text: str) -> Quantity:
    """Read a number with its unit.

    Raises
    ------
    InputError
        When it does not begin with a number.
    """
    plain = " ".join(text.split())
    if len(plain) > LONGEST:
        raise InputError(f"has more than {LONGEST} characters", "answer")
    plain = re.sub(r"[·×] ?10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)", lambda power: f"e{power[1].translate(LOWERED)}", plain)
    plain = plain.replace(MINUS, "-").replace("·10^", "e").replace("×10^", "e").replace(" e", "e")
    if re.match(r"^[+-]?\d+,\d", plain):
        raise InputError("needs a decimal point, 2.48 and not 2,48", "answer")
    found = _FORM.match(plain)
    if not found or not math.isfinite(number := float(found[1])):
        raise InputError(f"begins with no number: {short(text)}", "answer", "write it like 2.48 kHz")
    factor, base = unit_of(found[2])
    return Quantity(number * factor, base, factor)


def _tidy(unit: str) -> str:
    """Return a unit in one spelling."""
    return unit.strip().replace("µ", "u").replace("μ", "u").replace("·", "").replace("*", "").replace(" ", "")
