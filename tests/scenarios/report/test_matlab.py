"""Names for MATLAB, by its own rule: a letter, then letters, digits and underscores, 63 at most, no keyword."""

from __future__ import annotations

import re

from hypothesis import given
from hypothesis import strategies as st

from scenarios.report.matlab import KEYWORDS, variables

VARIABLE = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,62}")
HOSTILE = ["m+5", "m-5", "m,5", "a-b", "a_b", "a.b", "Ω+5", "end", "5", "_", "+", "é", "x" * 80, "x" * 81, "names"]


def check(names: list[str]) -> dict[str, str]:
    found = variables(names, taken=["names"])
    assert list(found) == names
    assert len({*found.values(), "names"}) == len(names) + 1
    assert [name for name in found.values() if not VARIABLE.fullmatch(name) or name in KEYWORDS] == []
    return found


def test_hostile_names() -> None:
    found = check(HOSTILE)
    assert (found["m+5"], found["m-5"], found["a_b"]) == ("m_plus_5", "m_minus_5", "a_b")


def test_names_that_differ_in_their_signs_get_numbers() -> None:
    assert check(["m,5", "m;5", "m:5"]) == {"m,5": "m_5", "m;5": "m_5_2", "m:5": "m_5_3"}


def test_a_name_as_it_is_keeps_its_own() -> None:
    assert check(["plant.displacement", "tick", "time_ms"])["plant.displacement"] == "plant_displacement"


@given(st.lists(st.text(min_size=1, max_size=90), unique=True, max_size=20))
def test_any_names(names: list[str]) -> None:
    check(names)
