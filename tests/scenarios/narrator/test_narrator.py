"""Every sentence of the narrator and every number in it, counted and computed again from the trace by other code."""

from __future__ import annotations

import math
from collections import Counter, UserDict
from functools import cache
from typing import Any, cast

import numpy as np
import pytest

from core.board.commands import parse_command
from core.format import format_percent, format_short, format_si
from scenarios.library import get
from scenarios.narrator.doings import MEASURED, MODEL
from scenarios.narrator.narrator import Narrator
from scenarios.narrator.samples import NarratorSignals
from scenarios.narrator.sentence import Sentence
from scenarios.narrator.settling import Settling
from scenarios.narrator.verdicts import Verdicts, WinnerTurns
from scenarios.run import RunResult, build, run
from tests.scenarios.narrator.random_bench import random_bench, told

SEEDS = range(1, 11)
"""Benches of the short suite; the long one has `MORE` of them, and some that are drawn."""
MORE = range(11, 51)


@cache
def result(seed: int) -> RunResult:
    return told(seed)


def single(values: Any) -> Any:
    """Return values as a recording has them."""
    return np.asarray(values).astype(np.float32).astype(np.float64)


def rms(values: Any) -> float:
    return math.sqrt(sum(value * value for value in values.tolist()) / len(values))


def expected_verdicts(found: RunResult) -> list[tuple[int, str, int, int, int]]:
    """Count verdicts one by one: (tick, diagnoser, old, new, first of the twenty)."""
    verdicts = []
    for name, section in found.board.spec.diagnosers.items():
        every, held, run_of, winner, start = section.every, 0, 0, None, 0
        for tick in range(0, found.samples, every):
            now = int(found.signal(f"{name}.winner")[tick])
            if now != winner:
                winner, run_of, start = now, 0, tick
            run_of += 1
            if run_of == 20 and now not in (-1, held):
                verdicts.append((tick, name, held, now, start))
                held = now
    return sorted(verdicts)


def expected_settled(found: RunResult, doings: list[tuple[int, str]]) -> list[tuple[int, int, float, float]]:
    """Go through blocks of a hundred ticks: (tick, since, error, limit)."""
    model, measured = single(found.signal("model.displacement")), single(found.signal("sensor.displacement"))
    settled = []
    for position, (since, _) in enumerate(doings):
        end = doings[position + 1][0] if position + 1 < len(doings) else found.samples
        was_over = False
        for at in range(since, end - 99, 100):
            error, motion = rms((model - measured)[at : at + 100]), rms(model[at : at + 100])
            if error > 0.05 * motion:
                was_over = True
            elif was_over and error <= 0.025 * motion:
                settled.append((at + 99, since, error, 0.025 * motion))
                break
    return settled


def doings(found: RunResult) -> list[tuple[int, str]]:
    """List the events of the scenario before its end or a trip: (tick, kind)."""
    kinds = {"fault": "fault", "heal": "heal", "switch": "switch"}
    events = [(event["at_sample"], next(kinds[key] for key in event if key in kinds)) for event in done(found)]
    return [event for event in events if event[0] < found.samples]


def done(found: RunResult) -> list[dict[str, Any]]:
    events: list[dict[str, Any]] = found.scenario.document["events"]
    return events


def of(found: RunResult, *kinds: str) -> list[Sentence]:
    return [said for said in found.narration if said.kind in kinds]


KINDS = ("trip", "switch", "heal", "fault", "verdict", "false_verdict", "settled")


def test_the_benches_of_the_seeds_show_every_kind() -> None:
    counts = Counter(said.kind for seed in SEEDS for said in result(seed).narration)
    assert min(counts[kind] for kind in KINDS) > 1, counts


@pytest.mark.long
def test_every_sentence_and_number_follows_from_the_trace_on_many_benches(drawn_seed: int) -> None:
    seeds = [*MORE, *range(drawn_seed, drawn_seed + 20)]
    counts = Counter(said.kind for seed in MORE for said in result(seed).narration)
    assert min(counts[kind] for kind in KINDS) > 3, counts
    for seed in seeds:
        test_one_sentence_for_each_switch_verdict_fault_and_trip(seed)
        test_the_numbers_of_a_verdict_follow_from_the_trace(seed)
        test_the_numbers_of_faults_switches_and_trips_follow_from_the_trace(seed)
        test_the_numbers_of_settling_follow_from_the_trace(seed)


@pytest.mark.parametrize("seed", SEEDS)
def test_one_sentence_for_each_switch_verdict_fault_and_trip(seed: int) -> None:
    found = result(seed)
    told_of = [(said.tick, said.kind) for said in of(found, "fault", "heal", "switch")]
    assert told_of == doings(found)
    ticks = [tick for tick, *_ in expected_verdicts(found)]
    assert [said.tick for said in of(found, "verdict", "false_verdict")] == ticks
    assert [said.tick for said in of(found, "trip")] == ([found.trip.tick] if found.trip else [])
    ticks = [tick for tick, *_ in expected_settled(found, doings(found))]
    assert [said.tick for said in of(found, "settled")] == ticks
    assert [said.tick for said in found.narration] == sorted(said.tick for said in found.narration)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_numbers_of_a_verdict_follow_from_the_trace(seed: int) -> None:
    found = result(seed)
    verdicts = of(found, "verdict", "false_verdict")
    expected = expected_verdicts(found)
    ports = Counter(said.signals[0] for said in verdicts)
    assert sum(ports.values()) == len(expected)
    by_name = {(tick, name): rest for tick, name, *rest in expected}
    for said in verdicts:
        name = said.signals[0].partition(".")[0]
        old, new, start = by_name[said.tick, name]
        section = found.board.spec.diagnosers[name]
        params: Any = section.params
        labels = [one.name for one in params.hypotheses]
        numbers = {"time_ms": said.tick * found.board.dt_ms}
        numbers["probability"] = single(found.signal(f"{name}.probability.{labels[new]}"))[said.tick]
        verdict_ticks = slice(said.tick - 19 * section.every, said.tick + 1, section.every)
        for which, at in (("new", new), ("old", old)):
            residual = single(found.signal(f"{name}.residual.{labels[at]}"))[verdict_ticks]
            assert len(residual) == 20
            numbers[f"{which}_um"] = rms(residual)
        truth = found.signal(f"{name}.truth")
        numbers["truth"] = truth[said.tick]
        changes = [tick for tick in range(1, said.tick + 1) if truth[tick] != truth[tick - 1]]
        if truth[said.tick] == new and changes:
            numbers["delay_samples"] = max(0, start - changes[-1])
            numbers["since_ms"] = start * found.board.dt_ms
        assert said.numbers == pytest.approx(numbers, rel=1e-9)
        assert said.kind == ("verdict" if truth[said.tick] == new else "false_verdict")
        assert said.span == (min(start, changes[-1]) if changes else start, said.tick)
        for which in ("new_um", "old_um"):
            assert f"misses the measurement by {format_si(numbers['new_um'], 'um', 3)}" in said.text
            assert format_si(numbers[which], "um", 3) in said.text
        assert format_percent(numbers["probability"]) in said.text


@pytest.mark.parametrize("seed", SEEDS)
def test_the_numbers_of_faults_switches_and_trips_follow_from_the_trace(seed: int) -> None:
    found = result(seed)
    events = {event["at_sample"]: event for event in done(found)}
    error = single(found.signal("model.displacement")) - single(found.signal("sensor.displacement"))
    for said in of(found, "fault", "heal", "switch"):
        event, numbers = events[said.tick], {"time_ms": said.tick * found.board.dt_ms}
        if said.kind == "switch":
            numbers |= {"error_um": rms(error[said.tick - 100 : said.tick]), "span_ticks": 100.0}
            assert format_si(numbers["error_um"], "um", 3) in said.text
        else:
            numbers |= {"severity": event["severity"]} if said.kind == "fault" else {"faults": 1.0}
            fault = event.get("fault") or event["heal"][0]
            noun = {"added_mass": "mass", "stiffness": "stiffness", "damping": "damping"}.get(fault)
            if noun is not None:
                scale = single(found.signal(f"effects.{noun}_scale"))
                if scale[said.tick] != scale[said.tick - 1]:
                    numbers[f"{noun}_scale"] = scale[said.tick]
                    times = "again" if scale[said.tick] == 1.0 else f"{format_short(scale[said.tick], '', 3)} times"
                    assert f"the {noun} is {times} the healthy value" in said.text
        assert said.numbers == pytest.approx(numbers, rel=1e-9)
    for said in of(found, "trip"):
        assert found.trip is not None
        guard: Any = found.board.spec.guard.params
        value = found.board.value("plant.displacement")
        assert said.numbers == {"time_ms": found.trip.time_ms, "value": value, "limit": guard.travel_um}
        assert abs(value) > guard.travel_um
        assert format_si(abs(value), "um", 3) in said.text and format_si(guard.travel_um, "um", 3) in said.text


@pytest.mark.parametrize("seed", SEEDS)
def test_the_numbers_of_settling_follow_from_the_trace(seed: int) -> None:
    found = result(seed)
    for said, (tick, since, error, limit) in zip(
        of(found, "settled"), expected_settled(found, doings(found)), strict=True
    ):
        times = {"time_ms": tick * found.board.dt_ms, "settling_ms": (tick + 1 - since) * found.board.dt_ms}
        assert said.numbers == pytest.approx({**times, "error_um": error, "limit_um": limit}, rel=1e-9)
        assert said.span == (since, tick)


@pytest.mark.parametrize("seed", [2, 5, 8])
def test_slices_of_any_size_tell_the_same(seed: int) -> None:
    rng, scenario = np.random.default_rng(seed), random_bench(seed)
    board = build(scenario)
    narrator = Narrator(board.spec, list(board.signals))
    said: list[Sentence] = []
    while board.tick < (scenario.samples or 0):
        rows = board.advance(min(int(rng.integers(1, 60)), (scenario.samples or 0) - board.tick))
        said += narrator.follow(board.log, rows)
        if not rows.count:
            break
    assert said == result(seed).narration and said


@pytest.mark.parametrize("seed", [1, 3])
def test_a_copy_goes_on_alone(seed: int) -> None:
    scenario = random_bench(seed)
    board = build(scenario)
    narrator = Narrator(board.spec, list(board.signals))
    said: list[Sentence] = []
    while (rows := board.advance(min(307, (scenario.samples or 0) - board.tick))).count:
        twin = narrator.copy()
        first = twin.follow(board.log, rows)  # would disturb the other if they shared anything
        assert narrator.follow(board.log, rows) == first
        said += first
    assert said == result(seed).narration


def test_what_is_done_while_time_stands_is_told_when_its_tick_has_run_and_a_trip_at_once() -> None:
    board = build(get("first-look"))
    narrator = Narrator(board.spec, list(board.signals))
    narrator.follow(board.log, board.advance(300))
    board.apply(parse_command({"fault": "added_mass", "severity": 0.05}))
    board.apply(parse_command({"switch": "mrac"}))
    assert narrator.follow(board.log, board.advance(0)) == []
    said = narrator.follow(board.log, board.advance(1))
    assert [(one.tick, one.kind) for one in said] == [(300, "switch"), (300, "fault")]
    board.apply(parse_command({"make_safe": "the driver has gone"}))
    (trip,) = narrator.follow(board.log, board.advance(0))
    assert (trip.tick, trip.kind) == (301, "trip") and "the driver has gone" in trip.text


@pytest.mark.parametrize(("scenario", "seed"), [("ch5-seven-step", 1), ("ch5-seven-step", 2), ("first-look", 3)])
def test_a_quiet_run_has_no_sentence(scenario: str, seed: int) -> None:
    document = {key: value for key, value in get(scenario).document.items() if key not in ("events", "expect")}
    quiet = type(get(scenario)).load({**document, "samples": 5000})
    assert run(quiet, seed, narrate=True).narration == []


def test_the_seven_steps_in_order() -> None:
    found = run(get("ch5-seven-step"), narrate=True)
    kinds = [said.kind for said in found.narration if said.kind != "settled"]
    assert kinds == [
        *("fault", "verdict", "fault", "verdict", "heal", "fault", "verdict", "fault", "verdict"),
        *("heal", "fault", "verdict", "heal", "verdict"),
    ]
    delays = [int(said.numbers["delay_samples"]) for said in found.narration if said.kind == "verdict"]
    assert delays == found.board.scores()["kalman"].delays[1:]  # the first belongs to the healthy start


def test_a_gyroscope_misses_by_what_noise_does_not_explain() -> None:
    found = run(get("gyro-diagnosis"), narrate=True, taps=True)
    first = next(said for said in found.narration if said.kind in ("verdict", "false_verdict"))
    name, label = first.signals[0].split(".probability.")
    assert found.board.spec.diagnosers[name].every == 1
    nis = single(found.signal(f"{name}.nis.{label}"))[first.tick - 19 : first.tick + 1]
    assert first.numbers["new_normalised"] == pytest.approx(math.sqrt(nis.mean()), rel=1e-9)
    assert f"{format_si(first.numbers['new_normalised'], '', 3)} times what noise explains" in first.text


def test_an_error_that_stays_at_the_edge_while_the_fault_acts_is_not_back() -> None:
    """Open loop, an error of 5 % of the motion that rises and falls by a hundredth of itself."""
    ticks = np.arange(40_000)
    model = np.sin(ticks / 50.0)
    error = 0.05 * (1.0 + 0.01 * np.sin(ticks / 700.0)) * model

    def told(error: Any) -> list[str]:
        settling, samples = Settling(0.01), {MODEL: model, MEASURED: model - error}
        settling.follow(Sentence(tick=0, kind="fault", text="", signals=[], span=(0, 0), numbers={}))
        return [said.kind for said in settling.look(cast(NarratorSignals, Traces(samples)), len(ticks))]

    assert told(error) == []
    assert told(np.where(ticks < 20_000, error, 0.02 * model)) == ["settled"]


def test_a_winner_that_flickers_costs_no_look_at_its_residuals() -> None:
    """On 5000 ticks with another winner at every third tick; the last of them may still win often enough."""
    bench = get("ch5-seven-step").spec
    looks: list[str] = []

    class Counted:
        first, end, began = 100, 5100, 0

        def __contains__(self, name: object) -> bool:
            return str(name).startswith("kalman.residual.")

        def values(self, name: str, *_: int) -> Any:
            looks.append(name)
            return np.zeros(3)

    (name,) = bench.diagnosers
    verdicts = Verdicts(name, bench.diagnosers[name], 1, bench.dt_ms, alone=True)
    ticks = [*range(100, 5100, 3)]
    changes = {f"{name}.winner": WinnerTurns(ticks, [at % 2 + 1 for at in range(len(ticks))])}
    verdicts._held = 0
    assert [*verdicts.look(cast(NarratorSignals, Counted()), changes)] == []
    assert len(looks) == 2


class Traces(UserDict[str, Any]):
    """Signals by name, as a narrator reads them."""

    def values(self, name: str, since: int, until: int) -> Any:  # type: ignore[override]
        return self.data[name][since:until]
