"""The hidden part of a bench until the answer, a fault or a game, and the visible signals meanwhile."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pydantic import BaseModel, Field

from core.board.commands import Command, Heal, Inject, ResetTrip, Set, Switch
from core.board.document import Document
from core.board.spec import Section, Spec
from core.diagnose.hypothesis import ModelList, NamedModel
from core.errors import InputError
from server.bench import commands
from server.bench.pacing import usual_scale
from server.bench.tape import TickSource
from server.errors import ApiError

ACTOR = "board"
"""Actor of the hidden fault in the log."""

EARLIEST_S, LATEST_S = 1.0, 4.0
"""When the fault comes: seconds of wall time after the beginning, at the usual pace of the device."""

COMMANDS = (
    commands.Start,
    commands.Pause,
    commands.Step,
    commands.StepPeriod,
    commands.TimeScale,
    Set,
    Switch,
    ResetTrip,
)
"""Commands that are allowed meanwhile: to time, to the reference and to the controller."""
MAY_SET = ("reference", "controller", "controllers")
"""First words of the parameters that may be set meanwhile."""

SIGNALS = ("reference", "sensor", "drive", "model.displacement", "model.velocity")
"""Signals that people see meanwhile: reference, measurement and drive; `model` follows the reference alone."""
OF_A_DIAGNOSER = ("probability", "winner", "residual", "nis", "information", "unexcited", "least_nis", "unexplained")
"""Ports of a diagnoser that may be seen if the exercise adds it; its score knows the truth."""

SHEET = ("sample_rate_khz", "device", "plant", "reference", "controller", "sensor", "sensors", "controllers", "slots")
"""Visible tables of the bench: the tables of the nominal device, not of the drawn device."""

REFUSAL = "a fault is hidden on this bench"
HINT = "answer or give up first, under Lesson › Hidden fault"
GAME_HINT = "hand in or end the game first, under Lesson › Games"

FAULTS: dict[str, tuple[str, Callable[[float], float]]] = {
    "mass": ("added_mass", lambda factor: factor - 1.0),
    "stiffness": ("stiffness", lambda factor: factor - 1.0),
    "damping": ("damping", lambda factor: factor - 1.0),
    "gain": ("drive_gain", lambda factor: factor - 1.0),
    "second_stiffness": ("sense_stiffness", lambda factor: factor - 1.0),
    "quadrature_dps": ("quadrature", lambda dps: dps),
    "drive_gain": ("drive_loss", lambda gain: 1.0 - gain),
}
"""The fault that makes a factor of a hypothesis true, and its severity."""


class Played(BaseModel):
    """The game that is played on a bench."""

    game: str
    seed: int


class HiddenQuestion(BaseModel):
    """The words people get about a hidden fault, or about the game that is played."""

    id: str
    game: Played | None = Field(None, description="Of a game, which has no answers; null for a hidden fault")
    answers: list[str] = Field(description="One of these is true, each as likely as the others")
    factors: list[dict[str, float]] = Field(description="How each differs from the nominal device")
    shows: list[str] = Field(description="Diagnosers that may be looked at; none unless the exercise is about trust")
    began_tick: int
    by_tick: int = Field(description="The fault has come by then, if there is one")


class Blind(BaseModel):
    """A hidden fault: the question, and its possible answers."""

    question: HiddenQuestion
    truth: str
    came_tick: int | None = Field(description="When the fault comes; null for a healthy device")
    faults: list[Document]
    sheet: Document
    may_set: list[str] = Field([], description="In a game: further parameters that may be set")
    may_inject: list[str] = Field([], description="In a game without hidden faults: the faults that may be tried")

    def inject(self, board: TickSource) -> None:
        """Let the fault wait for its moment."""
        for fault in self.faults:
            board.apply(Inject(**fault, at_sample=self.came_tick), ACTOR)

    def may_see(self, signal: str) -> bool:
        """Whether a signal is served meanwhile."""
        block, _, port = signal.partition(".")
        if block in self.question.shows:
            return port.partition(".")[0] in OF_A_DIAGNOSER
        return block in SIGNALS or signal in SIGNALS

    def check(self, command: Command | commands.RunCommand) -> None:
        """Refuse a command that would reveal or change the hidden fault.

        Raises
        ------
        ApiError
            The same line for all of them.
        """
        tries = bool(self.may_inject) and isinstance(command, Inject | Heal)
        is_free = tries or isinstance(command, COMMANDS)
        if isinstance(command, Set | Switch | ResetTrip | Inject | Heal):
            is_free &= command.at_sample is None and command.at_ms is None and command.when is None
        if isinstance(command, Set):
            is_free &= all(path.partition(".")[0] in MAY_SET or path in self.may_set for path in command.set)
        if isinstance(command, Inject):
            is_free &= command.fault in self.may_inject
        if not is_free and self.question.game is not None:
            raise ApiError(403, "blind", "this is not free to change in the game", hint=GAME_HINT)
        if not is_free:
            raise refusal("only time, the reference and the controller may be changed")


def refusal(what: str = "") -> ApiError:
    """Refuse a request that would reveal the fault."""
    return ApiError(403, "blind", f"{REFUSAL}; {what}" if what else REFUSAL, hint=HINT)


def bank_of(spec: Spec) -> Section:
    """Return the diagnoser whose hypotheses are the answers.

    Raises
    ------
    InputError
        If the bench has none.
    """
    for section in spec.diagnosers.values():
        if isinstance(section.params, ModelList):
            return section
    raise InputError("has no bank of hypotheses to choose an answer from", "scenario", "take one of chapter 5")


def faults_of(hypothesis: NamedModel) -> list[Document]:
    """Return the faults that make a hypothesis true; none for a healthy device."""
    said = hypothesis.model_dump(exclude_defaults=True, exclude={"name"})
    return [
        {"fault": FAULTS[factor][0], "severity": round(FAULTS[factor][1](value), 10)} for factor, value in said.items()
    ]


def hide(board: TickSource, sheet: Document, id_: str, shows: bool, which: int, when: float) -> Blind:
    """Choose the fault that a board hides from now on.

    Parameters
    ----------
    board : TickSource
        The board, healthy and with nothing that waits.
    sheet : dict
        Its bench as people may know it.
    id_ : str
        Of the question.
    shows : bool
        Whether people may look at the diagnosers, and have to decide whether to trust them.
    which : int
        Number that chooses among the answers, all of them as likely.
    when : float
        0 to 1: between the earliest and the latest moment.

    Raises
    ------
    InputError
        If the bench has no bank.
    """
    params: Any = bank_of(board.spec).params
    answers: list[NamedModel] = list(params.hypotheses)
    truth = answers[which % len(answers)]
    faults = faults_of(truth)
    ms_per_s = usual_scale(board) * 1e3
    latest = board.tick + round(LATEST_S * ms_per_s / board.dt_ms)
    came = board.tick + round((EARLIEST_S + when * (LATEST_S - EARLIEST_S)) * ms_per_s / board.dt_ms)
    return Blind(
        question=HiddenQuestion(
            id=id_,
            answers=[item.name for item in answers],
            factors=[item.model_dump(exclude_defaults=True, exclude={"name"}) for item in answers],
            shows=list(board.diagnosers) if shows else [],
            began_tick=board.tick,
            by_tick=latest,
        ),
        truth=truth.name,
        came_tick=came if faults else None,
        faults=faults,
        sheet={key: value for key, value in sheet.items() if key in SHEET},
    )


def play(played: Played, id_: str, sheet: Document, may_set: list[str], may_inject: list[str], shows: str) -> Blind:
    """Hide the values of a game: its bench has them from the first tick, and users see the same as with a hidden fault.

    Parameters
    ----------
    played : Played
        The game.
    id_ : str
        Of this bench's turn of it.
    sheet : dict
        The bench as people may know it.
    may_set, may_inject : list of str
        Parameters that may be set and faults that may be tried.
    shows : str
        The diagnoser that may be looked at.
    """
    question = HiddenQuestion(id=id_, game=played, answers=[], factors=[], shows=[shows], began_tick=0, by_tick=0)
    shown = {key: value for key, value in sheet.items() if key in SHEET}
    return Blind(
        question=question,
        truth="",
        came_tick=None,
        faults=[],
        sheet=shown,
        may_set=may_set,
        may_inject=may_inject,
    )
