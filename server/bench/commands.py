"""Commands to a bench: commands of the board, and commands that run the bench."""

from __future__ import annotations

from typing import Annotated, Any, Literal, get_args

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from core.board.commands import (
    COMMANDS,
    FIELDS,
    HealFaults,
    Inject,
    MakeSafe,
    ResetTrip,
    SetValues,
    Switch,
    parse_command,
)
from core.errors import InputError, from_validation, unknown
from server.store.earlier import KINDS, parse_earlier

DEFAULT_SCALE = 0.002
MIN_SCALE, MAX_SCALE = 1e-6, 1.0

MAX_STEP = 10_000
MAX_PENDING = 100
"""Commands that may wait for their moment."""


class RunCommand(BaseModel):
    """A command that controls the pace of the bench; it changes no bit of the board's results."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


class Start(RunCommand):
    """Let time run."""

    kind: Literal["start"] = "start"


class Pause(RunCommand):
    """Stop time at the next tick edge."""

    kind: Literal["pause"] = "pause"


class Step(RunCommand):
    """Pause, then run some ticks at once."""

    kind: Literal["step"] = "step"
    ticks: int = Field(1, ge=1, le=MAX_STEP)


class StepPeriod(RunCommand):
    """Pause, then run one period of the drive at once."""

    kind: Literal["step_period"] = "step_period"


class Reset(RunCommand):
    """Begin the scenario again at tick 0, with other values if some are given."""

    kind: Literal["reset"] = "reset"
    values: dict[str, Any] = Field({}, description="Dotted paths of the scenario; any field, live or not")
    before_tick: int | None = Field(
        None, ge=0, le=2**53, description="Then run, as fast as possible to shortly before this tick"
    )


class FastForward(RunCommand):
    """Run as fast as possible for a while, then continue at the time scale.

    It ends shortly before a tick: the given tick, else the tick of the next command that waits. If only commands wait
    whose moment is not known, it ends once one of them has taken effect; if none waits, at the end of the scenario.
    """

    kind: Literal["fast_forward"] = "fast_forward"
    before_tick: int | None = Field(
        None, ge=0, le=2**53, description="Shortly before this tick; null: before what waits"
    )


class Undo(RunCommand):
    """Take the last change of the bench back, from now on: a fault, a value, a controller, a reset."""

    kind: Literal["undo"] = "undo"


class Redo(RunCommand):
    """Make the change again that was taken back last."""

    kind: Literal["redo"] = "redo"


class TimeScale(RunCommand):
    """Change how fast device time runs."""

    kind: Literal["time_scale"] = "time_scale"
    value: float | None = Field(
        ge=MIN_SCALE, le=MAX_SCALE, description="Device seconds per wall second; null: as fast as possible"
    )


class Seek(RunCommand):
    """Go to a tick of the recording that is played, or of the past that is shown."""

    kind: Literal["seek"] = "seek"
    tick: int = Field(ge=0, le=2**53)


class Loop(RunCommand):
    """Play a span of the recording again and again; without one, play it to its end."""

    kind: Literal["loop"] = "loop"
    start_tick: int | None = Field(None, ge=0, le=2**53)
    end_tick: int | None = Field(None, ge=0, le=2**53)


RunsTime = Start | Pause | Step | StepPeriod | Reset | TimeScale | FastForward | Seek | Loop
"""Commands to the time of a bench; only a recording that is played takes the last two, and a reset, in this way."""

Runs = Start | Pause | Step | StepPeriod | Reset | Undo | Redo | TimeScale | FastForward | Seek | Loop
"""All commands that run a bench."""

RUN_KINDS: dict[str, type[RunCommand]] = {run.model_fields["kind"].default: run for run in get_args(Runs)}


def parse(document: Any) -> Any:
    """Check a command of either sort, of the board in the notation of today or in the earlier one.

    Raises
    ------
    InputError
        One line naming the field.
    """
    if not isinstance(document, dict):
        raise InputError("a command must be an object", "command")
    if "kind" not in document and not document.keys().isdisjoint(FIELDS):
        return parse_command(document)
    kind = document.get("kind")
    if kind is None:
        raise InputError(f"needs a kind, or one of {', '.join(COMMANDS)}", "kind")
    if not isinstance(kind, str) or kind not in {**RUN_KINDS, **KINDS}:
        raise unknown("command", kind, [*RUN_KINDS, *KINDS], "kind")
    if kind in KINDS:
        return parse_earlier(document)
    model = RUN_KINDS[kind]
    try:
        return model.model_validate(document)
    except ValidationError as error:
        raise from_validation(error, {"": list(model.model_fields)}) from None


Command = Annotated[
    Runs | Inject | HealFaults | SetValues | Switch | MakeSafe | ResetTrip,
    BeforeValidator(parse),
]
"""For models and routes: `parse` reads it, the union describes it."""
