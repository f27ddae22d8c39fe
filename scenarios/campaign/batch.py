"""Carries out the runs of a batch; runs of one structure go abreast."""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Callable, Sequence
from itertools import chain
from typing import Any

import numpy as np

from core.block import FloatArray
from core.board.abreast import Abreast
from core.board.board import Board
from core.board.changes import check
from core.board.commands import MakeSafe
from core.board.lane import Lane
from core.board.lane_traces import LaneTraces
from core.board.observer import warnings
from core.board.pattern import Pattern, Uneven
from core.board.pending import PendingCommand, PendingQueue
from core.board.stages import stages
from core.compile.machine import WIDTH
from core.errors import InputError
from scenarios.campaign.outcome import RunOutcome, fault_of, odds_of, outcome, summed
from scenarios.measure.estimation import estimation_metrics
from scenarios.measure.metrics import measure
from scenarios.run import DEFAULT_SAMPLES
from scenarios.schema import Scenario
from scenarios.signals import watched

FEWEST = 3
"""Runs that are worth the loop of many."""
MOST_NUMBERS = 16_000_000
"""Numbers of the traces of runs abreast; longer ones run alone."""
Run = tuple[Scenario, int]


def outcomes(runs: Sequence[Run], on_tick: Callable[[int], None] = lambda _: None) -> list[RunOutcome]:
    """Carry out runs, each a scenario and a seed; return their outcomes in the same order.

    Parameters
    ----------
    runs : sequence of (Scenario, int)
        The runs.
    on_tick : callable
        Called every now and then with the ticks of all runs so far; it may raise to end them.
    """
    found: dict[int, RunOutcome] = {}
    groups: dict[Any, list[int]] = defaultdict(list)
    shapes: dict[int, Any] = {}
    for number, (scenario, _) in enumerate(runs):
        if id(scenario) not in shapes:
            shapes[id(scenario)] = shape(scenario)
        groups[shapes[id(scenario)]].append(number)

    def tell(ticks: int = 0) -> None:
        on_tick(ticks + sum(one.ticks for one in found.values()))

    for key, numbers in groups.items():
        if key is not None and len(numbers) >= FEWEST:
            _abreast(runs, numbers, found, tell)
    for number, one in enumerate(runs):
        if number not in found:
            found[number] = outcome(*one, tell)
            tell()
    return [found[number] for number in range(len(runs))]


def shape(scenario: Scenario) -> Any:
    """Return the properties that runs must share to run abreast; None for a run that runs alone."""
    commands = [command for event in scenario.events for command in event]
    spec, alone = scenario.spec, any(c.when or isinstance(c, MakeSafe) for c in commands)
    if scenario.study is not None or scenario.twins or spec.supervisors or alone:
        return None
    blocks = tuple((name, section.block, section.every) for name, section in spec.parts())
    rest = spec.measuring, spec.dt_ms, scenario.samples, scenario.asks_estimates
    return blocks, tuple(stages(spec)), tuple(spec.driving.items()), *rest


def _abreast(runs: Sequence[Run], numbers: list[int], found: dict[int, RunOutcome], tell: Callable[[], None]) -> None:
    """Carry out runs of one shape, `WIDTH` at a time, and add their outcomes; some have to continue alone."""
    scenario = runs[numbers[0]][0]
    samples = scenario.samples or DEFAULT_SAMPLES
    try:
        board = Board(scenario.spec)
        board.estimates = scenario.asks_estimates
        board.pending = waiting(scenario, board)
        pattern, told = Pattern(board), running_warnings(board)
    except (InputError, Uneven):
        return
    odds = [(name, *odds_of(board, name, scores.names)) for name, scores in board.scores().items()]
    sums = {fault_of(name): faults for name, healthy, _, faults in odds if healthy is not None and faults}
    summed_up = {*chain.from_iterable(sums.values())}
    names = [name for name in [*watched(board), *told] if name not in summed_up]
    queues = {id(scenario.events): board.pending.copy()}
    if samples * (len(names) + len(sums)) * WIDTH > MOST_NUMBERS:
        return
    traces = LaneTraces(board.wiring, names, samples, sums)
    for start in range(0, len(numbers), WIDTH):
        chosen = numbers[start : start + WIDTH]
        if len(chosen) >= FEWEST:
            found |= _together(pattern, traces, told, queues, runs, chosen)
            tell()


def _together(
    pattern: Pattern,
    traces: LaneTraces,
    told: dict[str, str],
    waits: dict[int, PendingQueue],
    runs: Sequence[Run],
    chosen: list[int],
) -> dict[int, RunOutcome]:
    """Carry out some runs; ``waits`` has the commands of the lists of events seen so far, by their identity."""
    began = time.perf_counter()
    try:
        specs = [runs[number][0].spec.with_seed(runs[number][1]) for number in chosen]
        for scenario in (runs[number][0] for number in chosen):
            if id(scenario.events) not in waits:
                waits[id(scenario.events)] = waiting(scenario, pattern.board)
        queues = [waits[id(runs[number][0].events)] for number in chosen]
        boards = Abreast(pattern, specs, queues, traces)
        came = boards.run(traces.samples)
    except (InputError, Uneven):
        return {}
    found = {}
    for lane, number in enumerate(chosen):
        if came[lane]:
            scenario, board, trace = runs[number][0], boards.boards[lane], boards.trace(lane)
            metrics = measure(board, trace, scenario.head.metrics)
            if scenario.asks_estimates:
                metrics |= estimation_metrics(board)
            said = warned(scenario, board, told, trace)
            found[number] = summed(scenario, board, metrics, board.digest(), trace, said)
    elapsed = (time.perf_counter() - began) / len(chosen)
    for outcome_ in found.values():
        outcome_.elapsed_s = elapsed
    return found


def running_warnings(board: Board) -> dict[str, str]:
    """Return the taps with warnings of the running blocks, and their texts."""
    wiring = board.wiring
    out = {wiring.instances[row].prefix for row in wiring.left_out}
    return {name: text for name, text in warnings(wiring).items() if name.rpartition(".")[0] not in out}


def warned(scenario: Scenario, board: Lane, told: dict[str, str], trace: dict[str, FloatArray]) -> list[str]:
    """Return the warnings that a run alone would have in its log, each once, in the order in which they came."""
    found = [(tick, text) for tick, spec in board.specs for text in spec.cautions]
    for name, text in told.items():
        if (risen := trace[name] > 0.0).any():
            found.append((int(np.argmax(risen)), text))
    found.sort(key=lambda one: one[0])
    return list(dict.fromkeys(chain(scenario.warnings, (text for _, text in found))))


def waiting(scenario: Scenario, board: Board) -> PendingQueue:
    """Return the commands of a scenario as they wait at its first tick.

    Raises
    ------
    InputError
        When one could never be carried out.
    """
    queue = PendingQueue()
    for position, commands in enumerate(scenario.events):
        for command in commands:
            try:
                check(board.spec, command)
            except InputError as error:
                raise error.under(f"events.{position}") from None
            queue.add(PendingCommand(command, "scenario", command.tick(board.dt_ms) or 0))
    return queue
