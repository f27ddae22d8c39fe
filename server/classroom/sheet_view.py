"""A sheet as a student sees it: the steps so far, with answers and points, and nothing of later steps."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, Field

from core.format import format_count, format_percent, format_short
from scenarios.sheets.expression import inserted
from scenarios.sheets.judge import can_judge, solution
from scenarios.sheets.look import known_limits, value_text, wanted_text
from scenarios.sheets.progress import AnyStep, Progress
from scenarios.sheets.sheet import Answered, BlindStep, Choice, Hold, NumberQuestion, Prediction, Sheet
from server.classroom.sheet_watch import Held

State = Literal["done", "open", "closed"]


class GivenView(BaseModel):
    """An answer, its points, and the reason; null while they are hidden."""

    text: str
    reason: str | None
    points: float | None


class ConditionView(BaseModel):
    """A condition of a step: the quantity, the required range, and whether it holds.

    A measured value is not shown: the student reads it from the instruments, and later steps grade it.
    """

    label: str
    now: str = Field(description="The setting, fault or verdict now; empty for a measured signal")
    wanted: str = Field(description="Empty if the sheet does not tell")
    holds: bool


class StepView(BaseModel):
    """A step that is open or done."""

    id: str
    kind: Literal["hold", "question", "prediction", "blind"]
    points: float
    earned: float | None = Field(description="Null while it is hidden")
    lost: float
    rule: str = Field(description="How it earns and loses points")
    question: str = ""
    options: dict[str, str] = Field({}, description="Answers to choose from: what to send, and its words")
    unit: str = ""
    tries_left: int | None = None
    answers: list[GivenView] = []
    hints: list[str] = Field([], description="Those taken")
    next_hint_costs: float | None = None
    conditions: list[ConditionView] = []
    held: str = Field("", description="How long the conditions hold, of how long they are to")
    held_share: float = 0.0
    solution: str | None = Field(None, description="Told once the step is done")
    given_up: bool = False
    can_go_on: bool = False


class SectionView(BaseModel):
    """A section; a closed one has only its heading."""

    heading: str
    state: State
    text: str = Field("", description="Markdown with mathematics between dollar signs")
    step: StepView | None = None
    after: str = Field("", description="Shown once the step is done")


class SheetView(BaseModel):
    """A sheet as a student sees it."""

    id: str
    title: str
    summary: str
    minutes: int
    points: float = Field(description="Points that it can earn")
    earned: float = Field(description="Points so far; wrong answers may make them less than 0")
    begun: bool
    done: bool
    bench: str | None = Field(description="The bench it is about; null: it is not there")
    recordings: list[str] = []
    intro: str
    sections: list[SectionView]


def view_of(sheet: Sheet, progress: Progress | None, bench: str | None, held: Held | None) -> SheetView:
    """Show a sheet; before it is begun, its introduction and its headings."""
    head, facts = sheet.head, progress.facts if progress else {}
    now = progress.open_step(sheet) if progress else None
    sections, behind = [], progress is None
    for section in sheet.sections:
        shown = SectionView(heading=section.heading, state="closed")
        if progress is not None and not behind:
            step = section.step
            is_done = step is None or progress.of(step).done
            shown.state = "done" if is_done else "open"
            shown.text = _text(section.text, facts)
            shown.step = _step(sheet, step, progress, held if step is now else None) if step else None
            shown.after = _text(section.after, facts) if is_done else ""
            behind = not is_done
        sections.append(shown)
    return SheetView(
        id=sheet.id,
        title=head.title,
        summary=head.summary,
        minutes=head.minutes,
        points=sheet.points,
        earned=progress.points(sheet) if progress else 0.0,
        begun=progress is not None,
        done=progress is not None and now is None,
        bench=bench,
        recordings=progress.recordings if progress else [],
        intro=_text(sheet.intro, facts) if progress else "",
        sections=sections,
    )


def _step(sheet: Sheet, step: AnyStep, progress: Progress, held: Held | None) -> StepView:
    """Show a step that is open or done."""
    state, told = progress.of(step), progress.is_told(sheet, step)
    shown = StepView(
        id=step.id,
        kind=step.kind,
        points=step.points,
        earned=state.points(step) if told else None,
        lost=state.lost,
        rule=rule_of(sheet, step),
        hints=[hint.text for hint in step.hints[: state.hints]],
        given_up=state.given_up,
        can_go_on=not state.done and not isinstance(step, Prediction),
    )
    if not state.done and state.hints < len(step.hints):
        shown.next_hint_costs = step.hints[state.hints].costs
    if isinstance(step, Answered):
        asked = step.asks
        shown.question = _text(step.question, progress.facts)
        shown.options = {o.id: o.text for o in asked.options} if isinstance(asked, Choice) else {}
        shown.unit = asked.unit if isinstance(asked, NumberQuestion) else ""
        shown.tries_left = 0 if state.done else step.tries - len(state.answers)
        words = {o.id: o.text for o in asked.options} if isinstance(asked, Choice) else {}
        shown.answers = [
            GivenView(
                text=words.get(given.text, given.text),
                reason=given.reason if told else None,
                points=round(given.share * step.points - given.lost, 3) if told else None,
            )
            for given in state.answers
        ]
        judged = can_judge(step, progress.facts)
        shown.can_go_on |= not state.done and not judged
        shown.solution = solution(step, progress.facts) if state.done and told and judged else None
    elif isinstance(step, Hold):
        _show_hold(shown, step, progress, held)
    return shown


def _text(text: str, facts: dict[str, float]) -> str:
    """Return a text with its numbers; a dash for one of a step that was left out."""
    return inserted(text, facts, missing="–")


def _show_hold(shown: StepView, step: Hold, progress: Progress, held: Held | None) -> None:
    """Show the range of each condition and whether it holds; of a setting, its value too."""
    state, ends = progress.of(step), known_limits(step, progress.facts)
    findings = held.findings if held else []
    for position, (condition, limits) in enumerate(zip(step.conditions, ends, strict=True)):
        found = findings[position] if position < len(findings) else None
        value = state.values.get(condition.label) if state.done else found.value if found else None
        shown.conditions.append(
            ConditionView(
                label=condition.label,
                now="" if condition.signal else value_text(condition, value),
                wanted=wanted_text(condition, limits),
                holds=(state.done and not state.given_up) or bool(found and found.holds),
            )
        )
    held_ms = step.for_ms if state.done and not state.given_up else min(held.held_ms, step.for_ms) if held else 0.0
    shown.held_share = held_ms / step.for_ms
    shown.held = f"held {format_short(held_ms, 'ms')} of {format_short(step.for_ms, 'ms')}"


def rule_of(sheet: Sheet, step: AnyStep) -> str:
    """Say how a step earns and loses points."""
    worth = points_text(step.points)
    if isinstance(step, Hold):
        return f"{worth} when this has held for {format_short(step.for_ms, 'ms')} of device time."
    if isinstance(step, BlindStep):
        return f"{worth} times the score of your answer to the fault that is hidden here, out of 100."
    said = [f"{worth}."]
    asked = step.asks
    if isinstance(asked, NumberQuestion):
        said = [f"{worth} within {_tolerance(asked)}."]
        if asked.partly is not None:
            said.append(
                f"Within {format_percent(asked.partly.within, 0)}: {points_text(asked.partly.share * step.points)}."
            )
        if asked.wrong_unit:
            said.append(f"Right value in the wrong unit: {points_text(asked.wrong_unit * step.points)}.")
        if asked.wrong_sign:
            said.append(f"Right value with the wrong sign: {points_text(asked.wrong_sign * step.points)}.")
        if asked.right_sign:
            said.append(f"Right sign: {points_text(asked.right_sign * step.points)}.")
    if isinstance(step, Prediction):
        run = next((s.heading for s in sheet.sections if s.step is not None and s.step.id == step.until), "the run")
        lost = f"a wrong one costs {points_text(step.costs)}" if step.costs else "a wrong one costs nothing"
        return " ".join([*said, f"Given once, and judged after “{run}”; {lost}."])
    said.append(f"A wrong answer costs {points_text(step.costs)}. {format_count(step.tries, 'attempt')}.")
    return " ".join(said)


def points_text(points: float) -> str:
    """Write a number of points."""
    return f"{format_short(points, '', 3)} {'point' if points == 1.0 else 'points'}"


def _tolerance(asked: NumberQuestion) -> str:
    if asked.within_absolute:
        return format_short(asked.within_absolute, asked.unit)
    return format_percent(asked.within, 0 if (asked.within * 100).is_integer() else 1)
