"""The controller in CONTRIBUTING.md, taken from there: it runs, and does what its equation says."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from core import registry
from core.block import Block
from scenarios.starters import starters
from tests.lab import RICH, do, make, play

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "CONTRIBUTING.md").read_text()
CODE = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)[0]


@pytest.fixture
def recipe(monkeypatch, tmp_path) -> type[Block]:
    module = ModuleType("core.control.pi")
    monkeypatch.setitem(sys.modules, module.__name__, module)
    file = tmp_path / "pi.py"
    file.write_text(CODE)
    exec(compile(CODE, str(file), "exec"), vars(module))
    known = registry.blocks("control")
    monkeypatch.setattr(
        registry, "blocks", lambda family: {**known, "pi": module.Pi} if family == "control" else BLOCKS(family)
    )
    return module.Pi


BLOCKS = registry.blocks


def test_the_recipe_obeys_its_equation(recipe):
    board = make({"controller.kind": "pi", "sample_rate_khz": 100}, base=RICH)
    trace = play(board, 400)
    error = trace["model.displacement"] - trace["sensor.displacement"]
    np.testing.assert_array_equal(trace["pi.error"], error)
    np.testing.assert_allclose(trace["pi.voltage"], -2.0 * error - 5.0 * np.cumsum(error) * 0.01, rtol=1e-12)


def test_it_takes_over_from_the_voltage_that_was_applied(recipe):
    """In shadow I = u - Kp e at every tick, so that the first voltage is u + Kp (e - e before) + Ki e dt."""
    board = make({"controller.kind": "open_loop"}, base=RICH)
    shadow = play(board, 300)
    do(board, {"switch": "pi"})
    after = play(board, 1)
    e, e_before = after["pi.error"][0], shadow["pi.error"][-1]
    applied = shadow["drive.voltage"][-2]  # over the sample that ended with the last tick in shadow
    assert after["pi.voltage"][0] == pytest.approx(applied - 2.0 * (e - e_before) - 5.0 * e * board.dt_ms, rel=1e-12)


def test_it_gives_the_same_bits_in_plain_python(recipe):
    fast, slow = (make({"controller.kind": "pi"}, base=RICH, compiled=compiled) for compiled in (True, False))
    play(fast, 60)
    play(slow, 60)
    assert fast.digest() == slow.digest()


def test_every_name_is_declared_once():
    """A port or a state is declared once, a parameter in the two tables; beyond that only the step names it."""
    step = CODE[CODE.index("def step") :]
    declared = CODE[: CODE.index("    @classmethod")]
    for name, places in (("error", 1), ("integral", 1), ("proportional_v_um", 2), ("integral_v_um_ms", 2)):
        assert len(re.findall(rf"^\s+{name}: float", declared, re.MULTILINE)) == places
        assert re.search(rf"[psx]\.{name}\b", step)
    assert len([line for line in CODE.splitlines() if line.strip()]) <= 60


def test_both_documents_show_the_file_that_the_page_offers():
    shown = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "own-units.md").read_text("utf-8"), re.DOTALL)[0]
    offered = (ROOT / "scenarios" / "starters" / "pi.py").read_text("utf-8")
    assert offered == CODE == shown
    assert {one.name: one.source for one in starters()}["pi"] == offered


@pytest.mark.parametrize(
    ("recipe", "example", "places"),
    [
        ("Add a verb to a bench", r"\bMakeSafe\b", ["core/board/*.py", "server/bench/commands.py"]),
        ("Add a verb to a bench", r"\bTimeScale\b", ["server/**/*.py"]),
        ("Add an export format", r"[\"']npz[\"']", ["server/**/*.py", "web/src/**/*.tsx"]),
        ("Add a limit for students", r"\bstudent_history_mb\b", ["server/**/*.py"]),
        ("Add a limit for students", r"\bstudent_events\b", ["server/settings.py", "server/api/*.py"]),
    ],
)
def test_a_recipe_names_every_file_that_its_example_touches(recipe, example, places):
    """The youngest verb, format and limit of the project show where the next one goes."""
    section = TEXT.split(f"\n## {recipe}\n")[1].split("\n## ")[0]
    paths = sorted(path for place in places for path in ROOT.glob(place) if ".test." not in path.name)
    touched = [str(path.relative_to(ROOT)) for path in paths if re.search(example, path.read_text("utf-8"))]
    assert len(touched) > 1
    assert [name for name in touched if f"`{name}`" not in section] == []
