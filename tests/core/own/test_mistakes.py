"""All errors of a text come at once, each with its place and the text to write instead; none follows from another."""

from __future__ import annotations

import pytest

from core.own.mistakes import MOST_MISTAKES
from core.own.text import UnitError
from core.own.unit import unit
from scenarios.edit import with_values
from scenarios.library import get
from tests.core.own.test_own_units import source_of
from tests.core.own.texts import odd


def mistakes(text: str) -> list[str]:
    """Return the errors of a unit, without their places."""
    with pytest.raises(UnitError) as raised:
        unit("odd", text)
    return [one.message for one in raised.value.all]


def one_of(place: str, text: str) -> str:
    (message,) = mistakes(odd(place, text))
    return message


@pytest.mark.parametrize(
    ("place", "text", "way"),
    [
        ("top", "from core.elementary import sqrt", "write import math, and math.sqrt"),
        ("top", "from core.elementary import sinus", "did you mean sin?"),
        ("top", "from core.block import normal", "write from core.noise import normal"),
        ("top", "from numpy import array", "docs/own-units.md lists them"),
        ("attributes", "    Ports2 = 3", "allowed: title"),
        ("attributes", "    Params = BlockParams", "write class Params(BlockParams): and a docstring"),
        ("params", "speed: array = 1.0", "a parameter is a float, int, bool, str or Literal"),
        ("state", "array: float", "choose another one"),
        ("pack", "p.dt_ms = contxt.dt_ms", "did you mean context?"),
        ("pack", "p.dt_ms = math.radians(3.0)", "math has no radians that a unit may read; there are sqrt"),
        ("pack", "p.dt_ms = context.device.stifness", "did you mean stiffness?"),
        ("pack", "p.dt_ms = params.gian", "params has no gian that a unit may read; did you mean gain?"),
        ("pack", "while True:\n    pass", "a method has assignments, if, for and return"),
        ("pack", 'p.dt_ms = float(f"{1}")', "a method has numbers, texts, lists and calls"),
        ("step", "e = x.modell", "did you mean model?"),
        ("step", "s.b = e", "there are a, line, grid"),
        ("step", "x.seen = gian * e", "did you mean p.gain?"),
        ("step", "if e > 0.0:\n    k = 1.0\nx.seen = k", "assign it before this line, on every way to it"),
        ("step", "x.seen = math.exp(e)", "write from core.elementary import exp, and exp(...)"),
        ("step", "x.seen = sqrt(e)", "write import math, and math.sqrt"),
        ("step", "x.seen = expp(e)", "did you mean exp?"),
        ("step", "x.seen = e ** 2", "write products for a power"),
        ("step", "x.seen = p.taps", "but a vector; read an item, such as [0]"),
        ("step", "x.seen = e > 0.0", "write 1.0 if ... else 0.0"),
        ("step", "x.seen = [e, e]", "keep several numbers in a Vector of State or Packed"),
        ("step", "if e:\n    pass", "compare it, such as with != 0.0"),
        ("step", "p.gain = 2.0", "it writes fields of s, and outputs and taps of x"),
        ("step", "x.three = e", "of a vector an item, such as [0]"),
        ("step", "e + 1.0", "assign it, or leave it out"),
        ("step", "while e > 0.0:\n    e = 0.0", "write for i in range(n) with an if inside"),
        ("step", "for one in p.taps:\n    pass", "write for i in range(n), and read an item by [i]"),
        ("step", "for i in range(9000):\n    pass", "shorten the loop, or go on at the next sample"),
        ("step", "return\nx.seen = e", "leave it out"),
        ("step", "x.seen = e if e is not e else e", "a step has numbers"),
        ("ports", 'other: float = reads("plant.displacement", "um", "truth")', "did you mean"),
    ],
)
def test_an_error_says_the_way_out(place: str, text: str, way: str) -> None:
    assert way in one_of(place, text.removeprefix("    ") if place == "attributes" else text)


def test_all_errors_come_at_once_in_the_order_of_the_text() -> None:
    text = odd(
        top="from core.elementary import tan",
        state="array: float",
        pack="p.dt_ms = contxt.dt_ms\np.gain = nothing",
        step="e = x.modell\nx.seen = math.exp(1.0)\nx.seen = s.a",
    )
    with pytest.raises(UnitError) as raised:
        unit("odd", text)
    found = raised.value.all
    assert [(one.line, one.column) for one in found] == sorted((one.line, one.column) for one in found)
    names = ["tan", "array", "contxt", "nothing", "modell", "math.exp"]
    assert len(found) == len(names)
    lines = text.split("\n")
    assert all(name in lines[one.line - 1] for one, name in zip(found, names, strict=True))
    assert raised.value.hint.startswith("also line ") and raised.value.hint.count("line ") == len(names) - 1


@pytest.mark.parametrize(
    "more",
    [
        {"top": "from core.elementary import tan", "step": "x.seen = tan(e) + tan(1.0)"},
        {"step": "gone = x.gone\nother = gone + 1.0\nx.seen = other"},
        {"step": "for i in range(e):\n    last = p.taps[i]\nx.seen = last"},
        {"top": "@kernel\ndef twice(a):\n    return 2.0 * b", "step": "x.seen = twice(e)\nx.seen = twice(2.0)"},
        {"top": "LIMIT = nothing", "step": "x.seen = LIMIT", "pack": "p.gain = LIMIT"},
        {"state": "gone: nothing", "step": "s.gone = e\nx.seen = s.a"},
        {"ports": "gone: float = nothing", "step": "x.gone = x.model"},
    ],
)
def test_an_error_that_follows_from_another_is_not_shown(more: dict[str, str]) -> None:
    assert len(mistakes(odd(**{"place": "step", "text": "", **more}))) == 1


def test_a_text_of_errors_shows_the_first_of_them() -> None:
    found = mistakes(odd("step", "\n".join(f"x.seen = gone{i}" for i in range(50))))
    assert len(found) == MOST_MISTAKES and "gone0" in found[0]


def test_a_text_that_is_too_long_says_so_once() -> None:
    deep = "for i in range(3000):\n    for j in range(100):\n        x.seen = e\nx.seen = e\nx.seen = e"
    assert "shorten the loops" in one_of("step", deep)


def test_a_copy_that_no_bench_could_pack_is_refused_when_it_is_checked() -> None:
    """Numbers of two parts are for the library alone; a list within a list is for all."""
    with pytest.raises(UnitError, match="complex is not declared"):
        unit("force_to_rebalance", source_of("control", "force_to_rebalance"))
    table = {"square": {"source": source_of("reference", "square")}}
    scenario = with_values(get("first-look"), {"reference": {"kind": "square", "amplitude_v": 5.0}, "expect": []})
    own = type(scenario).load({**scenario.document, "units": table})
    assert own.spec.context().tone_hz == scenario.spec.context().tone_hz > 0.0
