"""Measurements of a step over a window, the condition of its end, and the points of answers one after another."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from core.errors import InputError
from scenarios import sheets
from scenarios.sheets.look import known_limits, limits_of, look, measure, signals_of, value_text, wanted_text
from scenarios.sheets.progress import MOST_RECORDINGS, Progress
from scenarios.sheets.sheet import Hold, Limits, Sheet

DT_MS, TONE_HZ = 0.01, 1000.0
PHASE = 2.0 * np.pi * TONE_HZ * 1e-3 * DT_MS * np.arange(200)


class Window:
    """Two periods of a tone on a bench that believes something."""

    dt_ms = DT_MS

    def __init__(self, **score: Any) -> None:
        said = {"names": ["healthy", "m+5"], "samples": 5, "winner": 1, "unexplained": False, **score}
        self.board = SimpleNamespace(
            spec=SimpleNamespace(tone_hz=TONE_HZ),
            scores=lambda: {"kalman": SimpleNamespace(**said)},
            faults={"added_mass": SimpleNamespace(severity=0.05)},
        )

    def samples(self, signal: str) -> Any:
        return {
            "x": -0.5 + 3.0 * np.cos(PHASE - np.pi / 3),
            "steps": np.repeat([0.0, -1.0], 100),
            "reference.voltage": 2.0 * np.cos(PHASE),
        }[signal]


def limits(**fields: Any) -> Limits:
    ends = {} if "equals" in fields else {"between": (0.0, 1.0)}
    return Limits.model_validate({"label": "A", **ends, **fields})


@pytest.mark.parametrize(
    ("kind", "signal", "value"),
    [
        ("value", "steps", -1.0),
        ("mean", "x", -0.5),
        ("rms", "x", math.sqrt(0.25 + 4.5)),
        ("peak", "x", 3.5),
        ("swing", "x", 3.0),
        ("share", "steps", 0.5),
        ("amplitude", "x", 3.0),
        ("phase", "x", -60.0),
    ],
)
def test_a_window_is_measured_as_its_name_says(kind: str, signal: str, value: float) -> None:
    assert measure(limits(signal=signal, measure=kind), Window()) == pytest.approx(value, rel=1e-3)


def test_a_measure_is_divided_by_that_of_another_signal() -> None:
    found = measure(limits(signal="x", measure="amplitude", over="reference.voltage"), Window())
    assert found == pytest.approx(1.5)


def test_a_verdict_is_what_is_believed_and_none_while_nothing_fits() -> None:
    verdict = limits(verdict="kalman", equals="m+5")
    assert measure(verdict, Window()) == "m+5"
    assert measure(verdict, Window(unexplained=True)) is None
    assert measure(verdict, Window(samples=0)) is None
    assert measure(verdict, Window(winner=2)) is measure(verdict, Window(winner=-1)) is None
    assert measure(limits(fault="added_mass"), Window()) == 0.05
    assert measure(limits(fault="stiffness"), Window()) == 0.0


def hold(*conditions: Limits, **fields: Any) -> Hold:
    return Hold(id="run", kind="hold", points=1.0, for_ms=1.0, conditions=list(conditions), **fields)


def test_conditions_hold_within_their_ends_both_included() -> None:
    for low, high, holds in (
        (3.0, 4.0, True),
        (3.5, 4.0, True),
        (2.0, 3.5, True),
        (3.6, 4.0, False),
        (2.0, 3.4, False),
    ):
        step = hold(limits(signal="x", measure="peak", between=(low, high)), limits(verdict="kalman", equals="m+5"))
        window = Window()
        window.samples = lambda _: np.array([-3.5, 1.0])  # type: ignore[method-assign]
        assert [found.holds for found in look(step, limits_of(step, {}), window)] == [holds, True]
    assert [found.holds for found in look(step, [None, None], Window(winner=0))] == [False, False]


def test_ends_the_wrong_way_round_hold_never() -> None:
    step = hold(limits(signal="x", between=(2.0, 1.0)), limits(signal="x", between=("left_out", 2.0)))
    with pytest.raises(InputError, match="is above"):
        limits_of(step, {})
    assert known_limits(step, {}) == [None, None]
    assert wanted_text(step.conditions[1], None) == "" and value_text(step.conditions[1], None) == "–"


def test_a_step_needs_the_signals_that_it_names_and_the_reference_for_a_phase() -> None:
    both = hold(limits(signal="x", over="y"), limits(verdict="kalman", equals="m+5"), trace=["z", "x"])
    assert signals_of(both) == ["x", "y", "z"]
    assert signals_of(hold(limits(signal="x", measure="phase"))) == ["x", "reference.voltage"]


def opened() -> tuple[Sheet, Progress]:
    """Return the first sheet at its first question: 2 points, three attempts, the amplitude is 2 um."""
    sheet, progress = sheets.get("first-look"), Progress(facts={"amplitude": 2.0, "growth": 3.0})
    progress.go_on(sheet, "running", 10)
    return sheet, progress


def test_the_best_answer_counts_and_only_those_that_earn_nothing_cost() -> None:
    sheet, progress = opened()
    step = sheet.step("amplitude")
    assert step is not None and step.kind == "question"
    state = progress.of(step)
    progress.answer(sheet, "amplitude", "2 V", 20)  # the wrong unit earns a half
    assert (state.share, state.lost, state.done) == (0.5, 0.0, False)
    progress.answer(sheet, "amplitude", "99 um", 30)
    assert (state.share, state.lost, state.done) == (0.5, step.costs, False)
    progress.answer(sheet, "amplitude", "2 um", 40)
    assert (state.share, state.lost, state.done, state.tick) == (1.0, step.costs, True, 40)
    sheet, progress = opened()
    progress.answer(sheet, "amplitude", "2 um", 20)
    assert progress.of(step).done  # a right answer needs no other


def test_so_many_recordings_are_handed_in_each_once() -> None:
    progress = Progress()
    for number in [*range(MOST_RECORDINGS), 0]:
        progress.keep(str(number))
    assert len(progress.recordings) == MOST_RECORDINGS
    with pytest.raises(InputError, match="at most 20"):
        progress.keep("another")
