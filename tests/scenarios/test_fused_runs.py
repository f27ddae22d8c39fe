"""Long runs use the code of segments: code that is kept, or code that they compile."""

from __future__ import annotations

from typing import Any

import pytest

from core.compile.segment import Segment, code_of
from scenarios import run as module
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build, run

SAMPLES = 600


@pytest.mark.parametrize(
    ("very_long", "is_kept", "rows"), [(2 * SAMPLES, False, 4), (2 * SAMPLES, True, 2), (0, False, 2)]
)
def test_a_run_uses_code_that_is_kept_and_compiles_when_it_is_very_long(
    monkeypatch: pytest.MonkeyPatch, very_long: int, is_kept: bool, rows: int
) -> None:
    scenario = with_values(get("ch3-mrac-spring-x2"), {"samples": SAMPLES, "expect": []})
    short, compiled = run(scenario), list[Segment]()
    assert not short.board.fuses

    def made(segment: Segment) -> bytes:
        compiled.append(segment)
        return code_of(segment)

    def kept(segment: Segment) -> bytes | None:
        return code_of(segment) if is_kept else None

    for name, value in {"LONG": SAMPLES, "VERY_LONG": very_long, "code_of": made, "kept_code_of": kept}.items():
        monkeypatch.setattr(module, name, value)
    long = run(scenario)
    assert long.board.fuses and long.digest == short.digest and len(compiled) == (2 if very_long == 0 else 0)
    assert bool(long.board.unfused) is (rows > 2)


def test_a_board_with_a_part_from_outside_walks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "LONG", 0)
    monkeypatch.setattr(module, "VERY_LONG", 0)
    scenario: Any = with_values(get("ch3-mrac-spring-x2"), {"samples": 50, "expect": []})
    result = run(scenario, law=lambda sample: 1.0)
    assert result.board.tick == 50 and not result.board.unfused and build(scenario).fuses is False
