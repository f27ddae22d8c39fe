"""Numbers as people read them; the page is held to the same texts by the same table."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from core.format import (
    UNITS,
    format_beside,
    format_count,
    format_figure,
    format_in,
    format_number,
    format_on,
    format_percent,
    format_short,
    format_si,
    format_spread,
    format_within,
    plain_scale,
    tick_labels,
    typeset,
    unit_scale,
    unit_text,
)

CASES: dict[str, Any] = json.loads(Path("web/src/testing/cases/format.json").read_text("utf-8"))
FORMATS = {"si": format_si, "short": format_short, "in": format_in}
LOWERED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
PREFIX = {"T": 1e12, "G": 1e9, "M": 1e6, "k": 1e3, "": 1.0, "m": 1e-3, "µ": 1e-6}
PREFIX |= {"n": 1e-9, "p": 1e-12, "f": 1e-15, "a": 1e-18}


@pytest.mark.parametrize(("name", "case"), [(name, case) for name in FORMATS for case in CASES[name]])
def test_texts_are_those_of_the_page(name: str, case: list[Any]) -> None:
    """The page and Python write a value as the same text."""
    *one, text = case
    assert FORMATS[name](*one) == text


def test_shares_and_figures_are_those_of_the_page() -> None:
    """Shares keep the digits that tell them from none and all, counts are whole."""
    for share, decimals, text in CASES["percent"]:
        assert format_percent(share, decimals) == text
    for metric, value, digits, text in CASES["figure"]:
        assert format_figure(metric, value, digits) == text
    assert format_percent(math.nan) == "–"


def test_spreads_and_plain_units_are_those_of_the_page() -> None:
    """A deviation decides the decimals of its mean; figures beside each other share a unit without powers of ten."""
    for metric, mean, std, text in CASES["spread"]:
        assert format_spread(metric, mean, std) == text
    for metric, mean, std, unit, text in CASES["spreadWithUnit"]:
        assert format_spread(metric, mean, std, unit) == text
    for metric, value, digits, unit, text in CASES["withUnit"]:
        assert format_figure(metric, value, digits, unit) == text
    for value, tolerance, unit, text in CASES["within"]:
        assert format_within(value, tolerance, unit) == text
    for value, figure, digits, text in CASES["beside"]:
        assert format_beside(value, figure, digits) == text
    for unit, values, factor, text in CASES["plain"]:
        assert plain_scale(unit, values) == (pytest.approx(factor, rel=1e-12), text)


def test_units_are_those_of_the_page() -> None:
    """Each unit is written as itself."""
    assert set(UNITS) == set(CASES["units"])
    for unit, text in CASES["units"].items():
        assert format_short(1.0, unit) == text
    for unit, text in CASES["text"].items():
        assert unit_text(unit) == text
    for ticks, texts in CASES["ticks"]:
        assert tick_labels(ticks) == texts


@pytest.mark.parametrize("digits", [2, 3, 4, 6])
def test_what_is_written_reads_back(digits: int) -> None:
    """A text read back is the value within half of its last digit, and below 1000 of its unit."""
    random = np.random.default_rng(1)
    for value in random.choice((-1.0, 1.0), 2000) * 10.0 ** random.uniform(-30, 30, 2000):
        for text in (format_si(value, "V", digits), format_short(value, "V", digits)):
            found = re.fullmatch(r"(−?)(\d{1,3}(?:\.\d+)?)(?:×10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))?\u00a0([TGMkmµnpfa]?)V", text)
            assert found, text
            sign, number, power, prefix = found.groups()
            size = float(number) * 10.0 ** int((power or "0").translate(LOWERED)) * PREFIX[prefix]
            assert float(number) < 1000.0
            assert (-size if sign else size) == pytest.approx(value, rel=0.5 * 10.0 ** (1 - digits) * 1.000001)


def test_small_things() -> None:
    """Missing values, zeros of whole numbers, one and many."""
    assert [format_si(value, "V") for value in (math.nan, math.inf, -math.inf)] == ["–"] * 3
    assert [format_short(float(whole), "V", 3) for whole in range(1000)] == [f"{whole}\u00a0V" for whole in range(1000)]
    assert [format_count(n, "sample") for n in (1, 12345)] == ["1\u00a0sample", "12\u202f345\u00a0samples"]
    assert format_number(-0.0001, 2) == "0.00"
    assert format_on(unit_scale("um", 4.1), -0.003) == "−0.003\u00a0µm"


def test_a_value_and_its_deviation_share_one_power_and_no_line_breaks_between_them() -> None:
    """Read back, both equal their values before within half of the last digit that is shown."""
    random = np.random.default_rng(2)
    sizes = 10.0 ** random.uniform(-12, 6, 1000)
    for mean, std in zip(sizes, sizes * 10.0 ** random.uniform(-5, 1, 1000), strict=True):
        for unit in ("um", "N s/m", "deg", ""):
            text = format_spread("", mean, std, unit)
            assert not re.search(r"[ \u2009e]", text.replace("deg", "")), text
            found = re.fullmatch(
                r"\(?([\d.\u202f]+)\u00a0±\u00a0(<\u00a0)?([\d.\u202f]+)\)?(?:×10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))?(?:\u00a0.+)?", text
            )
            assert found, text
            shown, bound, spread, _ = found.groups()
            assert len(shown.partition(".")[2]) == len(spread.partition(".")[2]), text
            scale = unit_scale(unit, max(mean, std))
            last = 0.5000001 * 10.0 ** -len(spread.partition(".")[2])
            assert abs(float(shown.replace("\u202f", "")) - mean * scale.factor) <= last
            assert bound or abs(float(spread.replace("\u202f", "")) - std * scale.factor) <= last


def test_texts_of_people_are_typeset_and_names_are_left_alone() -> None:
    """Units get their sign, powers of ten are raised, paths and words stay."""
    assert typeset("Beams 0.2 um narrower, h = 20us, a drum") == "Beams 0.2\u00a0µm narrower, h = 20\u00a0µs, a drum"
    assert typeset("beyond 8 um, in um, 3 um/V, uN um") == "beyond 8\u00a0µm, in µm, 3\u00a0µm/V, µN µm"
    assert typeset("Q = R = 1e-4, -0.0002e-6, 0.4242e-6") == "Q = R = 10⁻⁴, -0.0002×10⁻⁶, 0.4242×10⁻⁶"
    assert typeset("1e6 V, 100.5e12, 20000e-6, 1e+300") == "10⁶ V, 100.5×10¹², 20000×10⁻⁶, 10³⁰⁰"
    left = (
        "set reference.amplitude_um = 1, tell us, drum, beam 2e, fe80e1, bench 96769085e426, 123456789e12, 1234e5678…"
    )
    assert typeset(left) == left
