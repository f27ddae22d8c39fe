"""Reads a sheet and tries all of it on the bench it begins with, before a student sees it."""

from __future__ import annotations

from core.board.board import Board
from core.errors import InputError, unknown
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build
from scenarios.sheets.begin import begin
from scenarios.sheets.expression import evaluate, inserted
from scenarios.sheets.look import limits_of, setting_of
from scenarios.sheets.read import at, line_of, read_sheet
from scenarios.sheets.sheet import Answered, Choice, Hold, NumberQuestion, Sheet, SheetSection


def check(text: str, name: str) -> Sheet:
    """Read a sheet and try all of it on the bench it begins with.

    Raises
    ------
    InputError
        One line: sheet, line, step, field.
    """
    sheet = read_sheet(text, name)
    lines = text.replace("\r\n", "\n").split("\n")
    try:
        beginning = begin(sheet, lambda _: 0)
        board = build(with_values(get(sheet.head.bench.scenario), beginning.values))
    except InputError as error:
        raise at(name, line_of(lines, 0, len(lines), error.field), "", error) from None
    facts = dict(beginning.facts)
    _try(sheet, lines, SheetSection("", sheet.intro, None, "", 1), facts, board)
    for section in sheet.sections:
        _try(sheet, lines, section, facts, board)
    return sheet


def _try(sheet: Sheet, lines: list[str], section: SheetSection, facts: dict[str, float], board: Board) -> None:
    """Try the formulas, signals and settings of a section; the facts of its step exist from then on."""
    step = section.step
    try:
        inserted(section.text, facts)
        if isinstance(step, Hold):
            _try_hold(step, facts, board)
        elif isinstance(step, Answered):
            _try_answer(step, facts)
        inserted(section.after, facts)
    except InputError as error:
        line = line_of(lines, section.step_line or section.line - 1, len(lines), error.field)
        raise at(sheet.id, line, step.id if step else "", error) from None


def _try_hold(step: Hold, facts: dict[str, float], board: Board) -> None:
    limits_of(step, facts)
    known = {signal.name for signal in board.signals}
    for position, condition in enumerate(step.conditions):
        field = f"conditions.{position}"
        for name, signal in (("signal", condition.signal), ("over", condition.over)):
            if signal is not None and signal not in known:
                raise unknown("signal", signal, sorted(known), f"{field}.{name}")
        if condition.setting is not None:
            try:
                setting_of(board.spec, condition.setting)
            except InputError as error:
                raise error.under(field) from None
        if condition.verdict is not None:
            names = {key: score.names for key, score in board.scores().items()}
            if condition.verdict not in names:
                raise unknown("diagnoser", condition.verdict, names, f"{field}.verdict")
            if condition.equals not in names[condition.verdict]:
                raise unknown("hypothesis", condition.equals, names[condition.verdict], f"{field}.equals")
        if condition.name is not None:
            facts[f"{step.id}_{condition.name}"] = 1.0
    for position, signal in enumerate(step.trace):
        if signal not in known:
            raise unknown("signal", signal, sorted(known), f"trace.{position}")


def _try_answer(step: Answered, facts: dict[str, float]) -> None:
    inserted(step.question, facts, "question")
    asked = step.asks
    if isinstance(asked, Choice):
        return
    assert isinstance(asked, NumberQuestion)
    evaluate(asked.value, facts, "number.value")
    for position, mistake in enumerate(asked.mistakes):
        evaluate(mistake.value, facts, f"number.mistakes.{position}.value")
