"""Units of the bench in the base units of FMI."""

from __future__ import annotations

import math
import re
from collections import defaultdict

BASE = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")
KNOWN: dict[str, tuple[float, dict[str, int]]] = {
    "m": (1.0, {"m": 1}),
    "s": (1.0, {"s": 1}),
    "g": (9.80665, {"m": 1, "s": -2}),  # an acceleration on this bench, but mg is a mass
    "mg": (1e-6, {"kg": 1}),
    "A": (1.0, {"A": 1}),
    "K": (1.0, {"K": 1}),
    "rad": (1.0, {"rad": 1}),
    "deg": (math.pi / 180.0, {"rad": 1}),
    "h": (3600.0, {"s": 1}),
    "Hz": (1.0, {"s": -1}),
    "N": (1.0, {"kg": 1, "m": 1, "s": -2}),
    "Pa": (1.0, {"kg": 1, "m": -1, "s": -2}),
    "V": (1.0, {"kg": 1, "m": 2, "s": -3, "A": -1}),
    "F": (1.0, {"kg": -1, "m": -2, "s": 4, "A": 2}),
    "J": (1.0, {"kg": 1, "m": 2, "s": -2}),
    "W": (1.0, {"kg": 1, "m": 2, "s": -3}),
}
PREFIXES = {"k": 1e3, "M": 1e6, "m": 1e-3, "u": 1e-6, "n": 1e-9, "p": 1e-12, "f": 1e-15}
PART = re.compile(r"([A-Za-z]+)(?:\^(\d+))?")


def base_unit(text: str) -> tuple[float, dict[str, int]] | None:
    """Return the factor and the exponents of a unit; nothing for a unit that is not known."""
    above, slash, below = text.partition("/")
    factor, exponents = 1.0, defaultdict[str, int](int)
    for part, sign in ((above, 1), (below.strip("()"), -1)) if slash else ((above, 1),):
        for word in part.split():
            if word == "1":
                continue
            match = PART.fullmatch(word)
            known = _known(match[1]) if match else None
            if match is None or known is None:
                return None
            power = sign * int(match[2] or 1)
            factor *= known[0] ** power
            for name, exponent in known[1].items():
                exponents[name] += power * exponent
    return factor, {name: exponents[name] for name in BASE if exponents[name]}


def _known(word: str) -> tuple[float, dict[str, int]] | None:
    if word in KNOWN:
        return KNOWN[word]
    prefix, rest = word[:1], word[1:]
    if prefix in PREFIXES and rest in KNOWN:
        factor, exponents = KNOWN[rest]
        return PREFIXES[prefix] * factor, exponents
    return None
