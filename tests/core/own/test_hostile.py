"""Hostile texts: each is refused in one line, and nothing of it is executed."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from core.board.commands import SetValues
from core.errors import InputError
from core.own.text import UnitError
from core.own.unit import unit
from scenarios import own
from scenarios.library import get
from scenarios.run import build
from scenarios.schema import Scenario
from tests.core.own.hostile import corpus
from tests.core.own.texts import ROOT, odd


def look() -> dict[str, Any]:
    return get("first-look").document


def test_there_are_many() -> None:
    assert len({text for texts in corpus().values() for text in texts}) >= 300


def test_the_frame_they_are_put_into_is_a_unit() -> None:
    unit("odd", odd())


@pytest.mark.parametrize("place", ["whole", "step", "top", "attributes", "pack"])
def test_each_hostile_text_is_refused_in_one_line(
    place: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    let_in = []
    for text in corpus()[place]:
        before, said = set(sys.modules), ""
        try:
            unit("odd", text)
            build(Scenario.load({**look(), "units": {"odd": {"source": text}}}))
        except InputError as error:
            said = str(error)
        loaded = {"socket", "subprocess", "ctypes"} & (set(sys.modules) - before)
        is_executed = loaded or [*tmp_path.iterdir()] or capfd.readouterr() != ("", "")
        if not said or "\n" in said or len(said) >= 500 or is_executed:
            let_in.append((text[-300:], said, is_executed))
    assert let_in == []


def test_a_storm_of_numbers_that_are_none_stays_in_its_own_slots() -> None:
    storm = odd("step", "for i in range(5):\n    s.line[i] = 1e308 * 1e308 - 1e308 * 1e308\nx.seen = s.line[0]")
    plain, stormy = (build(Scenario.load({**look(), "units": {"odd": {"source": text}}})) for text in (odd(), storm))
    for board in (plain, stormy):
        board.advance(1000)
    assert np.isnan(stormy.value("odd.seen")) and stormy.trip is None
    assert stormy.digest() == plain.digest()


def test_a_step_that_is_slow_to_compile_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """The process that compiles has a limit of time; the caller continues."""
    code = (
        "import scenarios.own as own; own.MOST_S = 0; import sys; from tests.core.own.texts import PI;"
        "sys.argv = ['own']; import io, json; sys.stdin = io.StringIO(json.dumps(['pi', PI])); own.main()"
    )
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert ended.returncode != 0


def test_how_many_hypotheses_there_are_is_not_the_units_to_say() -> None:
    text = (ROOT / "docs" / "own-units.md").read_text("utf-8").split("```python\n")[2].partition("```")[0]
    lying = text.replace("p = cls.Packed.blank()", "p = cls.Packed.blank()\n        p.count = 1e6")
    scenario = Scenario.load(
        {**look(), "units": {"judge": {"source": lying}}, "diagnosers": {"mine": {"kind": "judge"}}, "expect": []}
    )
    board = build(scenario)
    assert board.wiring.parameters("mine").count == 6.0
    board.advance(200)
    assert board.trip is None


MEMORY = "        memory: float = parameter("


KNOWN = "a class within a unit is one of Params, Packed, State, Ports"


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            MEMORY,
            f'        count: float = parameter(40.0, "more", "1")\n{MEMORY}',
            "count is something else in BankParams",
        ),
        (MEMORY, f'        hypotheses: float = parameter(1.0, "none", "1")\n{MEMORY}', "hypotheses is something else"),
        (
            MEMORY,
            f'        model_fields: float = parameter(1.0, "none", "1")\n{MEMORY}',
            "model_fields is something else",
        ),
        ("class Params(BankParams)", "class Params(BlockParams)", "Params must be on BankParams"),
        ("class Params(BankParams)", "class Params(Record)", "declares|Params must be on"),
        ("class Packed(Judge.Packed)", "class Packed(Record)", "Packed must be on Judge.Packed"),
        ("class State(Record)", "class State(BankParams)", "declare each parameter|State must be on Record"),
        (
            "    class State(Record)",
            "    class Ports(Judge.Ports):\n"
            '        probability: Vector = output("1", "x", labels=("a",))\n\n'
            "    class State(Record)",
            "probability is another port in Judge.Ports",
        ),
        ("class State(Record)", "class rests(Record)", KNOWN),
        ("class State(Record)", "class packed(Record)", KNOWN),
    ],
)
def test_what_the_framework_counts_on_is_not_the_units_to_declare(old: str, new: str, said: str) -> None:
    """A parameter named count once stood for the number of hypotheses, so that loops went beyond their vectors."""
    text = (ROOT / "docs" / "own-units.md").read_text("utf-8").split("```python\n")[2].partition("```")[0]
    changed = text.replace("import Context, ", "import BlockParams, Context, ")
    changed = changed.replace("import Any\n", "import Any\nfrom core.ports import output\n").replace(old, new)
    assert changed.count(new) == 1
    with pytest.raises(UnitError, match=said):
        unit("judge", changed)


def test_a_fault_of_ones_own_cannot_come_while_the_board_runs() -> None:
    board = build(Scenario.load(look()))
    source = (ROOT / "core" / "faults" / "stiffness.py").read_text("utf-8")
    with pytest.raises(InputError) as raised:
        board.apply(SetValues(set={"units.softer.source": source}), "test")
    assert (raised.value.field, raised.value.code) == ("units", "not_live")


@pytest.mark.parametrize(
    ("name", "value", "said"), [("MOST_WAIT_S", 0.001, "is not compiled after"), ("sys", None, "cannot be compiled")]
)
def test_a_unit_that_is_not_compiled_apart_is_refused(
    name: str, value: Any, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if name == "sys":
        value = SimpleNamespace(executable="/bin/false", stdin=sys.stdin, platform=sys.platform)
    monkeypatch.setattr(own, name, value)
    monkeypatch.setattr(own, "folder", lambda: Path("."))
    monkeypatch.setattr(own, "get", lambda _: None)
    with pytest.raises(InputError, match=said):
        own.compile_apart("odd", odd())
