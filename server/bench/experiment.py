"""Experiments of benches: a bench is written as an experiment, and is brought back to its tick."""

from __future__ import annotations

import json
from typing import Any

from core.board.board import Board
from core.board.packages import TABLE, carried
from core.errors import InputError
from core.own.admission import kept_with
from scenarios.edit import with_values
from scenarios.run import build
from scenarios.schema import Scenario
from server.bench.bench import LiveBench
from server.errors import ApiError
from server.store.experiment import THIS_VERSION, Experiment


def experiment_of(session: LiveBench) -> Experiment:
    """Return the experiment of a bench (a job of the engine).

    Raises
    ------
    ApiError
        For a recording that is played: it is kept already.
    """
    if session.replay_of:
        raise ApiError(409, "conflict", "a recording that is played is no experiment", hint="share the bench it is of")
    board = session.board
    document = {**session.scenario.document, **board.base}
    events = board.save()["events"]
    if named := carried({**document, "events": events}).get(TABLE):  # commands may name other packages
        document[TABLE] = named
    plain = json.loads(json.dumps({"scenario": document, "events": events}, default=str))
    return Experiment(
        **plain,
        tick=board.tick,
        digest=board.digest(),
        version=THIS_VERSION,
        running=session.is_started,
        time_scale=session.time.pacer.scale,
    )


def beginning_of(scenario: Scenario, board: Board, time_scale: float | None) -> Experiment:
    """Return the experiment that a scenario is before anything has been done."""
    return Experiment(
        scenario=json.loads(json.dumps(scenario.document, default=str)),
        events=board.save()["events"],
        tick=0,
        digest=board.digest(),
        version=THIS_VERSION,
        running=True,
        time_scale=time_scale,
    )


def rebuilt(experiment: Experiment, most_ticks: int, values: dict[str, Any] | None = None) -> tuple[Scenario, Board]:
    """Return the scenario of an experiment, and its board at tick 0 with all that was done waiting.

    ``values`` are written over the scenario.

    Raises
    ------
    InputError
        If the values do not fit the scenario or the commands.
    ApiError
        If it is longer than may be repeated, or this version cannot read it.
    """
    if experiment.tick > most_ticks:
        text = f"it has run for {experiment.tick} ticks; at most {most_ticks} are repeated (max_run_ticks)"
        raise ApiError(409, "too_long", text, hint="open its scenario instead, from tick 0")
    values = values or {}
    try:
        with kept_with(values):
            scenario = with_values(Scenario.load(experiment.scenario), values)
            return scenario, build(Scenario.load({**scenario.document, "events": experiment.events}))
    except InputError as error:
        if values:
            raise
        text = f"this version cannot repeat it: {error}"
        raise ApiError(409, "conflict", text, hint=f"it was made with {experiment.version}") from None


def forward(session: LiveBench, tick: int) -> bool:
    """Bring a new bench to a tick, and carry out the commands that wait for it; return whether it came there."""
    board = session.board
    while board.tick < tick and session.advance(tick - board.tick):
        pass
    if isinstance(board, Board) and board.tick == tick:
        board.apply_due()
        session.done_otherwise()
    return board.tick == tick


def repeat(session: LiveBench, experiment: Experiment) -> bool:
    """Bring a new bench to the tick of an experiment; return whether its bits equal the original bits."""
    return forward(session, experiment.tick) and session.board.digest() == experiment.digest
