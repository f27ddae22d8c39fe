"""The choice of a hidden fault, or of the hidden values of a game, for a bench."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from core.board.document import Document
from core.board.spec import Section, Spec
from core.diagnose.hypothesis import ModelList, NamedModel
from core.errors import InputError
from server.bench.pacing import usual_scale
from server.bench.replay import TickSource
from server.bench.status import HiddenQuestion, Played
from server.classroom.hiding import Blind

EARLIEST_S, LATEST_S = 1.0, 4.0
"""When the fault comes: seconds of wall time after the beginning, at the usual pace of the device."""

SHEET = ("sample_rate_khz", "device", "plant", "reference", "controller", "sensor", "sensors", "controllers", "slots")
"""Visible tables of the bench: the tables of the nominal device, not of the drawn device."""

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


def bank_of(spec: Spec) -> Section:
    """Return the diagnoser whose hypotheses are the answers.

    Raises
    ------
    InputError
        If the bench has none, plays a record, or has a supervisor, whose acts would tell the answer.
    """
    if spec.record is not None:
        raise InputError("plays a record, on which no fault can act", "scenario", "hide a fault on a simulated device")
    if spec.supervisors:
        raise InputError("has a supervisor, whose acts would tell the fault", "scenario", "leave the supervisor out")
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
