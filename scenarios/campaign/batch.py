"""Carries out the runs of a batch, those of one structure abreast."""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Sequence
from typing import Any

from core.board.abreast import Abreast
from core.board.board import Board
from core.board.changes import check
from core.board.pattern import Pattern, Uneven
from core.board.pending import Pending, Queue
from core.errors import InputError
from core.lanes.numbers import WIDTH
from scenarios.campaign.outcome import Outcome, outcome, summed
from scenarios.run import DEFAULT_SAMPLES, figures, watched
from scenarios.schema import Scenario

FEWEST = 3
"""Runs that are worth the loop of many."""
MOST_NUMBERS = 16_000_000
"""Numbers of the traces of runs abreast; longer ones run alone."""
Run = tuple[Scenario, int]


def outcomes(runs: Sequence[Run]) -> list[Outcome]:
    """Carry out runs, each a scenario and a seed; return their outcomes in the same order."""
    found: dict[int, Outcome] = {}
    groups: dict[Any, list[int]] = defaultdict(list)
    shapes: dict[int, Any] = {}
    for number, (scenario, _) in enumerate(runs):
        if id(scenario) not in shapes:
            shapes[id(scenario)] = shape(scenario)
        groups[shapes[id(scenario)]].append(number)
    for key, numbers in groups.items():
        if key is not None and len(numbers) >= FEWEST:
            found |= _abreast(runs, numbers)
    return [found[number] if number in found else outcome(*run) for number, run in enumerate(runs)]


def shape(scenario: Scenario) -> Any:
    """Return what runs must share to run abreast; None for one that runs alone."""
    if scenario.study is not None or scenario.twins or any(c.when for event in scenario.events for c in event):
        return None
    spec = scenario.spec
    blocks = tuple((name, section.block, section.every) for name, section in spec.parts())
    return blocks, tuple(spec.driving.items()), spec.measuring, spec.dt_ms, scenario.samples


def _abreast(runs: Sequence[Run], numbers: list[int]) -> dict[int, Outcome]:
    """Carry out runs of one shape, `WIDTH` at a time; those that cannot go on abreast are left out."""
    scenario = runs[numbers[0]][0]
    samples = scenario.samples or DEFAULT_SAMPLES
    found: dict[int, Outcome] = {}
    try:
        board = Board(scenario.spec)
        board.pending = waiting(scenario, board)
        pattern, names = Pattern(board), watched(board)
    except (InputError, Uneven):
        return found
    if samples * len(names) * WIDTH > MOST_NUMBERS:
        return found
    for start in range(0, len(numbers), WIDTH):
        chosen = numbers[start : start + WIDTH]
        if len(chosen) >= FEWEST:
            found |= _together(pattern, names, samples, runs, chosen)
    return found


def _together(
    pattern: Pattern, names: list[str], samples: int, runs: Sequence[Run], chosen: list[int]
) -> dict[int, Outcome]:
    began = time.perf_counter()
    try:
        scenarios = [runs[number][0] for number in chosen]
        specs = [runs[number][0].spec.with_seed(runs[number][1]) for number in chosen]
        waits = {number: waiting(scenario, pattern.board) for number, scenario in {id(s): s for s in scenarios}.items()}
        queues = [waits[id(scenario)].copy() for scenario in scenarios]
        boards = Abreast(pattern, specs, queues, names, samples)
        came = boards.run(samples)
    except (InputError, Uneven):
        return {}
    found = {}
    for lane, number in enumerate(chosen):
        if came[lane]:
            scenario, board, trace = runs[number][0], boards.boards[lane], boards.trace(lane)
            found[number] = summed(scenario, board, figures(board, trace, scenario), board.digest(), trace)
    elapsed = (time.perf_counter() - began) / len(chosen)
    for outcome_ in found.values():
        outcome_.elapsed_s = elapsed
    return found


def waiting(scenario: Scenario, board: Board) -> Queue:
    """Return the commands of a scenario as they wait at its first tick.

    Raises
    ------
    InputError
        When one could never be carried out.
    """
    queue = Queue()
    for position, commands in enumerate(scenario.events):
        for command in commands:
            try:
                check(board, command)
            except InputError as error:
                raise error.under(f"events.{position}") from None
            queue.add(Pending(command, "scenario", command.tick(board.dt_ms) or 0))
    return queue
