"""Formats numbers for people, in reports, pictures, 3D and events.

The page formats them the same way (``web/src/ui/format.ts``); ``web/src/testing/cases/format.json`` tests that both
write the same text for the same value.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from decimal import ROUND_HALF_UP, Context, Decimal
from functools import cache
from typing import NamedTuple

MINUS, THIN, SPACE, NOTHING = "−", "\u202f", "\u00a0", "–"
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
PLUS_MINUS = f"{SPACE}±{SPACE}"
IMMENSE = 1e15
"""From this size on, fixed decimals would show a row of digits that mean nothing."""
WHOLE_DIGITS = 9
"""Digits of a whole figure with a unit."""
LEAST_PLAIN, MOST_PLAIN = 1e-3, 1e6
"""Numbers without a prefix are written out in full between these sizes."""

UNITS = {
    **{"m": (1.0, "m"), "mm": (1e-3, "m"), "um": (1e-6, "m"), "nm": (1e-9, "m")},
    **{"s": (1.0, "s"), "ms": (1e-3, "s"), "us": (1e-6, "s"), "ns": (1e-9, "s"), "s/s": (1.0, "s/s")},
    **{"m/s": (1.0, "m/s"), "um/ms": (1e-3, "m/s")},
    **{"V": (1.0, "V"), "mV": (1e-3, "V"), "Hz": (1.0, "Hz"), "kHz": (1e3, "Hz")},
    **{"rad": (1.0, "rad"), "mrad": (1e-3, "rad")},
    **{"N": (1.0, "N"), "uN": (1e-6, "N"), "nN": (1e-9, "N"), "N/m": (1.0, "N/m"), "uN/um": (1.0, "N/m")},
    **{"N/V": (1.0, "N/V"), "uN/V": (1e-6, "N/V"), "N s/m": (1.0, "N·s/m"), "um/V": (1e-6, "m/V")},
    **{"kg": (1e3, "g"), "mg": (1e-3, "g"), "F": (1.0, "F"), "fF": (1e-15, "F"), "Pa": (1.0, "Pa")},
    **{"A": (1.0, "A"), "W": (1.0, "W"), "B": (1.0, "B")},
}
"""Units that take prefixes: the factor to the base unit, and its name."""

PREFIXES = tuple(zip((1e12, 1e9, 1e6, 1e3, 1.0, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 1e-18), "TGMk mµnpfa", strict=True))
MAYBE_MICRO = re.compile("u[msNVg]")
POWER = re.compile(r"\b(?=\d{1,3}[.e]|[\d.]+e[-+])(\d+(?:\.\d+)?)e([-+]?\d{1,3})\b")
"""A number with a power of ten; many digits before one without a sign are a part of an id, such as 96769085e426."""
_EXACT = Context(prec=100, rounding=ROUND_HALF_UP)


class UnitScale(NamedTuple):
    """How numbers of one unit are shown: the shown value is the value times the factor, with a number of decimals."""

    factor: float
    unit: str
    decimals: int
    exponent: str = ""


def unit_scale(unit: str, magnitude: float, digits: int = 4) -> UnitScale:
    """Return the scale on which the largest shown value reads as 1 to 999 of a prefixed unit."""
    to_base, name = UNITS.get(unit, (1.0, unit_text(unit)))
    size = round_to(abs(magnitude) * to_base, digits)  # a size that rounds up to 1000 takes the next prefix
    chosen = _prefix(size or to_base) if unit in UNITS else _plain(size)
    if chosen is not None:
        scale, prefix = chosen
        return UnitScale(to_base / scale, prefix.strip() + name, _decimals_for(size / scale, digits))
    power = 3 * (_power(size) // 3)
    exponent = f"×10{str(power).translate(RAISED)}" if power else ""
    return UnitScale(to_base / 10.0**power, name, _decimals_for(size / 10.0**power, digits), exponent)


def plain_scale(unit: str, values: Sequence[float]) -> tuple[float, str]:
    """Return a factor and the unit in which figures next to each other read without a power of ten.

    It is their own unit where it does, else the same with a prefix.
    """
    sizes = [abs(value) for value in values if math.isfinite(value)]
    if unit not in UNITS or all(map(_is_plain, sizes)):
        return 1.0, unit_text(unit)
    return unit_scale(unit, max(sizes))[:2]


def format_number(value: float, decimals: int) -> str:
    """Write a number with fixed decimals, a real minus sign and grouped thousands."""
    if not math.isfinite(value):
        return NOTHING
    if abs(value) >= IMMENSE:
        return format_si(value, "")
    text = _fixed(abs(value), decimals)
    whole, _, fraction = text.partition(".")
    grouped = f"{int(whole):,}".replace(",", THIN) if len(whole) > 4 else whole
    sign = MINUS if value < 0.0 and float(text) != 0.0 else ""
    return sign + grouped + (f".{fraction}" if fraction else "")


def format_si(value: float, unit: str, digits: int = 4) -> str:
    """Write a value with an SI-prefixed unit and all its significant digits, as for measured values."""
    return format_on(unit_scale(unit, value, digits), value) if math.isfinite(value) else NOTHING


def format_short(value: float, unit: str, digits: int = 4) -> str:
    """Write a value with an SI-prefixed unit in as few digits as it needs, as for chosen values."""
    if not math.isfinite(value):
        return NOTHING
    scale = unit_scale(unit, value, digits)
    return format_on(scale._replace(decimals=_decimals_of(value * scale.factor, scale.decimals)), value)


def format_on(scale: UnitScale, value: float) -> str:
    """Write a value on a scale chosen beforehand."""
    if not math.isfinite(value):
        return NOTHING
    return _with_unit(format_number(value * scale.factor, scale.decimals) + scale.exponent, scale.unit)


def format_in(value: float, unit: str, decimals: int) -> str:
    """Write a value in its own unit with fixed decimals."""
    return _with_unit(format_number(value, decimals), unit_text(unit)) if math.isfinite(value) else NOTHING


def format_percent(share: float, decimals: int = 1) -> str:
    """Write a share as a percentage; a share close to 0 or 100 % keeps its distinctive digits."""
    return _part(share * 100.0, 100.0, "%", decimals)


def format_share(share: float, decimals: int = 4) -> str:
    """Write a share as a part of one, distinct from 0 and 1 in the same way."""
    return _part(share, 1.0, "", decimals)


def format_figure(metric: str, value: float | None, digits: int = 4, unit: str = "") -> str:
    """Write a measured figure by the name of its metric, None as a dash; a count is written as a whole number."""
    if value is None:
        return NOTHING
    if metric.endswith("_fraction"):
        return format_share(value, digits)
    if not float(value).is_integer():
        return format_si(value, unit, digits)
    return format_short(value, unit, WHOLE_DIGITS) if unit else format_number(value, 0)


def format_spread(metric: str, mean: float, std: float, unit: str = "") -> str:
    """Write a mean and its standard deviation, to the second digit of the deviation, in one unit with one prefix.

    "709.00 ± 0.70 nm"; no line breaks inside it.
    """
    scale = unit_scale(unit, max(abs(mean), std))
    if std == 0.0:
        figure = format_figure(metric, mean) if not scale.exponent and scale.factor == 1.0 else ""
        return _pair(figure or format_number(mean * scale.factor, scale.decimals), "0", scale)
    shown, spread = mean * scale.factor, std * scale.factor
    decimals = min(_decimals_for(spread, 2), _decimals_for(max(abs(shown), spread), 6))
    return _pair(format_number(shown, decimals), _least(spread, decimals), scale)


def format_within(value: float, tolerance: float, unit: str) -> str:
    """Write a value and the tolerance around it, both as they were chosen, in one unit with one prefix."""
    scale = unit_scale(unit, max(abs(value), tolerance), 6)
    shown, around = value * scale.factor, tolerance * scale.factor
    decimals = max(_decimals_of(one, _decimals_for(abs(one), 6)) for one in (shown, around))
    return _pair(format_number(shown, decimals), format_number(around, decimals), scale)


def format_beside(value: float, figure: float, digits: int) -> str:
    """Write a difference from a figure, or its deviation, with the decimals that the figure has."""
    if value == 0.0 or (float(value).is_integer() and float(figure).is_integer()):
        return format_number(value, 0)
    if not _is_plain(abs(figure)):
        return format_si(value, "", 3)
    return _least(value, _decimals_for(abs(figure), digits))


def format_count(count: float, noun: str) -> str:
    """Write a count with its noun, in the singular or the plural."""
    return _with_unit(format_number(count, 0), noun if abs(count) == 1 else f"{noun}s")


def tick_labels(ticks: Sequence[float]) -> list[str]:
    """Label the ticks of an axis with as many decimals as its steps need."""
    return labels_on(unit_scale("", max(map(abs, ticks), default=0.0)), ticks)


def labels_on(scale: UnitScale, ticks: Sequence[float]) -> list[str]:
    """Label the ticks of an axis whose title has the unit of its scale."""
    shown = [round_to(tick * scale.factor, 12) for tick in ticks]
    decimals = max((_decimals_of(tick, 9) for tick in shown), default=0)
    return [format_number(tick, decimals) + (scale.exponent if tick else "") for tick in shown]


@cache
def unit_text(unit: str) -> str:
    """Return a unit the way people write it; numbers without one, and mixed vectors, have none."""
    if unit in ("", "1", "mixed"):
        return ""
    parts = re.sub(r"\bu(?=[A-Za-z])", "µ", unit.replace("rt h", "√h").replace("rtHz", "√Hz"))
    return parts.replace("*", "·").replace(" ", "·").replace("^2", "²").replace("^3", "³")


def micro(text: str) -> str:
    """Return a text with its units as they are printed: "20 us, 3 um/V" is "20 µs, 3 µm/V"."""
    if not MAYBE_MICRO.search(text):
        return text
    counted = re.sub(r"(\d)\s?u([msNVg])\b", f"\\1{SPACE}µ\\2", text)
    return re.sub(r"(^|[\s(,;/*])u([mNV])\b(?!\s*=)", r"\1µ\2", counted)


def typeset(text: str) -> str:
    """Return a text with units and powers of ten as they are printed: "1.2e-6 um" is "1.2×10⁻⁶ µm"."""
    return POWER.sub(_powered, micro(text))


def _powered(found: re.Match[str]) -> str:
    factor, power = found[1], str(int(found[2])).translate(RAISED)
    return f"10{power}" if factor == "1" else f"{factor}×10{power}"


def round_to(value: float, digits: int) -> float:
    """Round a value to a number of significant digits; a half goes away from zero."""
    return float(_rounding(digits).create_decimal(Decimal(value)))


def _pair(value: str, spread: str, scale: UnitScale) -> str:
    """Join a value and its uncertainty, with the power of ten and the unit of both."""
    pair = f"{value}{PLUS_MINUS}{spread}"
    return _with_unit(f"({pair}){scale.exponent}" if scale.exponent else pair, scale.unit)


def _part(part: float, whole: float, unit: str, decimals: int) -> str:
    """Write a part of a whole; if it would read as none or all, it gets up to two more decimals, then a bound."""
    if not math.isfinite(part):
        return NOTHING
    ends, most = (0.0, whole), decimals + 2
    for kept in range(decimals, most + 1):
        if part in ends or float(_fixed(part, kept)) not in ends:
            return format_in(part, unit, kept)
    if not 0.0 <= part <= whole:
        return format_in(part, unit, decimals)
    least = 10.0**-most
    if part < whole / 2.0:
        return f"<{SPACE}{format_in(least, unit, most)}"
    return f">{SPACE}{format_in(whole - least, unit, most)}"


def _least(value: float, decimals: int) -> str:
    """Write a number; a number other than zero that would read as zero gets a bound."""
    if value != 0.0 and float(_fixed(value, decimals)) == 0.0:
        return f"<{SPACE}{format_number(10.0**-decimals, decimals)}"
    return format_number(value, decimals)


def _is_plain(size: float) -> bool:
    return size == 0.0 or LEAST_PLAIN <= size < MOST_PLAIN


def _plain(size: float) -> tuple[float, str] | None:
    return (1.0, "") if _is_plain(size) else None


def _prefix(size: float) -> tuple[float, str] | None:
    if size >= 1e3 * PREFIXES[0][0]:
        return None
    return next((prefix for prefix in PREFIXES if size >= prefix[0]), None)


def _decimals_for(shown: float, digits: int) -> int:
    return max(0, digits - 1 - _power(round_to(shown, digits))) if shown > 0.0 else digits - 1


def _decimals_of(value: float, most: int) -> int:
    """Return the fewest decimals that show a value as exactly as ``most`` decimals."""
    return len(_fixed(value, most).partition(".")[2].rstrip("0"))


def _power(size: float) -> int:
    return Decimal(repr(float(size))).adjusted() if size else 0


def _fixed(value: float, decimals: int) -> str:
    return f"{_EXACT.quantize(Decimal(value), _last(decimals)):f}"


@cache
def _rounding(digits: int) -> Context:
    return Context(prec=digits, rounding=ROUND_HALF_UP)


@cache
def _last(decimals: int) -> Decimal:
    """Return 1 in the last place of a number of decimals."""
    return Decimal(1).scaleb(-decimals)


def _with_unit(text: str, unit: str) -> str:
    if not unit:
        return text
    return text + unit if unit == "°" else text + SPACE + unit
