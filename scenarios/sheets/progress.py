"""The progress of a student with a sheet: the open step, the answers, the points won and lost."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from core.errors import InputError
from scenarios.sheets.judge import can_judge, judge
from scenarios.sheets.sheet import Answered, BlindStep, Hold, Prediction, Sheet, SheetQuestion

MOST_RECORDINGS = 20
"""Recordings handed in with a sheet."""
AnyStep = Hold | SheetQuestion | Prediction | BlindStep


class Given(BaseModel):
    """An answer and its points."""

    text: str
    share: float
    lost: float
    reason: str
    tick: int


class StepProgress(BaseModel):
    """The work at a step."""

    answers: list[Given] = []
    hints: int = 0
    share: float = 0.0
    lost: float = 0.0
    done: bool = False
    given_up: bool = False
    tick: int = 0
    values: dict[str, float | str | None] = {}
    trace: dict[str, Any] = {}
    hidden: str = ""
    """Id of the question by which the step has hidden a fault."""

    def points(self, step: AnyStep) -> float:
        """Return the points of the step so far; wrong answers and hints can bring them below 0."""
        return round(self.share * step.points - self.lost, 3)


class Progress(BaseModel):
    """The progress of a student."""

    facts: dict[str, float] = {}
    steps: dict[str, StepProgress] = {}
    recordings: list[str] = []

    def of(self, step: AnyStep) -> StepProgress:
        """Return the work at a step."""
        return self.steps.setdefault(step.id, StepProgress())

    def open_step(self, sheet: Sheet) -> AnyStep | None:
        """Return the first step that is not done; later steps are closed."""
        return next((step for step in sheet.steps if not self.of(step).done), None)

    def is_told(self, sheet: Sheet, step: AnyStep) -> bool:
        """Whether the points of a step may be shown: of a prediction, once the run it was made for is done."""
        if not isinstance(step, Prediction):
            return True
        run = sheet.step(step.until)
        return run is None or self.of(run).done

    def points(self, sheet: Sheet) -> float:
        """Return the sum of the points that the student may know."""
        return round(sum(self.of(step).points(step) for step in sheet.steps if self.is_told(sheet, step)), 3)

    def answer(self, sheet: Sheet, step_id: str, text: str, tick: int) -> None:
        """Take an answer to the step that is open.

        Raises
        ------
        InputError
            When the step is not open, or the answer cannot be read.
        """
        step = self.must_be_open(sheet, step_id)
        if not isinstance(step, Answered):
            raise InputError("is done at the bench, not answered", "step", code="conflict")
        if not can_judge(step, self.facts):
            raise InputError("is about an unmeasured quantity: skip this question", "step", code="conflict")
        verdict, state = judge(step, text, self.facts), self.of(step)
        lost = step.costs if verdict.share == 0.0 else 0.0
        state.answers.append(Given(text=text, share=verdict.share, lost=lost, reason=verdict.reason, tick=tick))
        state.share = max(state.share, verdict.share)
        state.lost = round(state.lost + lost, 6)
        if verdict.share == 1.0 or len(state.answers) >= step.tries:
            state.done, state.tick = True, tick

    def take_hint(self, sheet: Sheet, step_id: str) -> None:
        """Take the next hint of the step that is open.

        Raises
        ------
        InputError
            When there is none.
        """
        step = self.must_be_open(sheet, step_id)
        state = self.of(step)
        if state.hints >= len(step.hints):
            raise InputError("has no other hint", "step", code="conflict")
        state.lost = round(state.lost + step.hints[state.hints].costs, 6)
        state.hints += 1

    def go_on(self, sheet: Sheet, step_id: str, tick: int) -> None:
        """Close the open step with its points.

        Raises
        ------
        InputError
            For a prediction that can be given, without which there is no run.
        """
        step = self.must_be_open(sheet, step_id)
        if isinstance(step, Prediction) and can_judge(step, self.facts):
            raise InputError("a prediction comes before the run: give one", "step", code="conflict")
        state = self.of(step)
        state.done, state.given_up, state.tick = True, True, tick

    def held(self, step: Hold, values: list[float | str | None], trace: dict[str, Any], tick: int) -> None:
        """Close a step whose conditions have held."""
        state = self.of(step)
        if state.done:
            return
        state.done, state.share, state.tick, state.trace = True, 1.0, tick, trace
        for condition, value in zip(step.conditions, values, strict=True):
            state.values[condition.label] = value
            if condition.name is not None and isinstance(value, float):
                self.facts[f"{step.id}_{condition.name}"] = value

    def keep(self, recording_id: str) -> None:
        """Hand in a recording with the sheet, by its id.

        Raises
        ------
        InputError
            When there are too many.
        """
        if recording_id not in self.recordings:
            if len(self.recordings) >= MOST_RECORDINGS:
                raise InputError(f"at most {MOST_RECORDINGS} are handed in", "recording", code="limit")
            self.recordings.append(recording_id)

    def must_be_open(self, sheet: Sheet, step_id: str) -> AnyStep:
        """Return the step that is open, if it is this one.

        Raises
        ------
        InputError
            When it is done, or another comes first.
        """
        step, now = sheet.step(step_id), self.open_step(sheet)
        if step is None:
            raise InputError(f"the sheet has no step {step_id[:40]}", "step", code="not_found")
        if self.of(step).done:
            raise InputError("is done and cannot be changed", "step", code="conflict")
        if now is not step:
            first = now.id if now else ""
            raise InputError(f"is closed until step {first} is done", "step", code="conflict")
        return step
