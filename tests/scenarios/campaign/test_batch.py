"""Runs abreast in a campaign have the figures, the digest and the verdicts of runs alone."""

from __future__ import annotations

import copy
from typing import Any

import pytest

from scenarios.campaign import batch
from scenarios.campaign.outcome import RunOutcome, outcome
from scenarios.campaign.sweep import Sweep
from scenarios.edit import with_values
from scenarios.library import get, library
from scenarios.run import run
from scenarios.schema import Scenario

TICKS = 800


def said(found: RunOutcome) -> str:
    return str(found.model_dump(exclude={"elapsed_s"}))


def must_run_alone(scenario: Scenario) -> bool:
    """Say whether no run of a scenario may go abreast: it has twins or supervisors, or commands that need the samples.

    Such a command waits for a condition, or makes the bench safe.
    """
    commands = scenario.document.get("events", [])
    needs_samples = any("when" in command or "make_safe" in command for command in commands)
    return bool(scenario.twins or scenario.spec.supervisors or needs_samples)


def cut(scenario: Scenario) -> Scenario:
    document = {key: value for key, value in scenario.document.items() if key != "duration_ms"}
    return Scenario.load({**document, "samples": min(TICKS, scenario.samples or TICKS)})


@pytest.fixture
def abreast(monkeypatch: Any) -> Any:
    """Count the runs that are carried out alone."""
    alone: list[int] = []
    monkeypatch.setattr(batch, "outcome", lambda *run: alone.append(run[1]) or outcome(*run))
    return alone


@pytest.mark.long
@pytest.mark.timeout(600)
def test_the_library(abreast):
    """All runs go abreast but those that must run alone; a run that trips has to be repeated alone."""
    together = 0
    for scenario in (cut(entry) for entry in library() if entry.study is None):
        runs = [(scenario, seed) for seed in (1, 2, 3)]
        abreast.clear()
        found, ran_alone = batch.outcomes(runs), [*abreast]
        assert ran_alone == [one.seed for one in found if must_run_alone(scenario) or one.trip], scenario.id
        together += not ran_alone
        for one, ours in zip(runs, found, strict=True):
            assert said(ours) == said(outcome(*one)), scenario.id
    assert together > 50


@pytest.mark.long
@pytest.mark.timeout(600)
def test_two_hundred_points(abreast):
    ranges = {
        "device.bias_v": {"min": 4.0, "max": 8.0},
        "device.force_n_per_v": {"min": 5e-9, "max": 8e-9},
        "sensor.noise_um": {"min": 0.01, "max": 0.1},
        "plant.drive_noise_v": {"min": 0.0, "max": 0.02},
        "diagnosers.kalman.probability_floor": {"min": 1e-4, "max": 1e-2},
        "reference.amplitude_v": {"min": 6.0, "max": 12.0},
    }
    sweep = Sweep(
        {
            "scenario": "ch5-seven-step",
            "set": {"samples": 4500},
            "seeds": "7:8",
            "latin_hypercube": {"points": 100, "seed": 3, "ranges": ranges},
        }
    )
    runs = [(Scenario.load(point.document), seed) for point in sweep.points for seed in sweep.seeds]
    found = batch.outcomes(runs)
    assert len(found) == 200 and not abreast
    for one, ours in zip(runs, found, strict=True):
        assert said(ours) == said(outcome(*one))
    assert found[0].digest == run(runs[0][0], 7).digest != found[1].digest


@pytest.mark.parametrize(
    ("values", "is_alone"),
    [
        ({}, False),
        ({"twins": {"other": {"controller": {"kind": "pid"}}}}, True),
        ({"supervisor": {"kind": "shutdown", "diagnoser": "kalman"}}, True),
        ({"events": [{"heal": "all", "when": "plant.displacement > 0.1"}]}, True),
        ({"events": [{"make_safe": "the end of the day", "at_sample": 9}]}, True),
        ({"events": [{"heal": "all", "at_sample": 9}]}, False),
    ],
)
def test_runs_that_must_run_alone_have_no_shape(values, is_alone):
    scenario = Scenario.load({**cut(get("ch5-seven-step")).document, **values})
    assert (batch.shape(scenario) is None, must_run_alone(scenario)) == (is_alone, is_alone)


def test_seeds_of_one_scenario_and_those_of_another(abreast):
    scenarios = [cut(get(name)) for name in ("ch5-seven-step", "ch3-stvsc-mass")]
    runs = [(scenarios[number % 2], number) for number in range(12)]
    found = batch.outcomes(runs)
    assert not abreast and [entry.seed for entry in found] == list(range(12))
    for one, ours in zip(runs, found, strict=True):
        assert said(ours) == said(outcome(*one))


def test_points_that_share_what_they_do_not_change(abreast):
    ranges = {"device.mass_kg": {"min": 2.0e-10, "max": 2.4e-10}, "plant.drive_noise_v": {"min": 0.0, "max": 0.02}}
    document = {"scenario": cut(get("ch5-seven-step")).document, "seeds": "3:4", "set": {"samples": 2100}}
    sweep = Sweep({**document, "latin_hypercube": {"points": 4, "ranges": ranges}})
    documents, runs, scenario = [point.document for point in sweep.points], [], None
    assert documents[0]["events"] is documents[1]["events"] and documents[0]["device"] != documents[1]["device"]
    for one in documents:
        scenario = Scenario.load(one, like=scenario)
        runs += [(scenario, seed) for seed in sweep.seeds]
    found = batch.outcomes(runs)
    assert not abreast and len({entry.digest for entry in found}) == 8
    for one, (_, seed), ours in zip([one for one in documents for _ in range(2)], runs, found, strict=True):
        assert said(ours) == said(outcome(Scenario.load(copy.deepcopy(one)), seed))


def test_points_of_which_each_has_another_sensor_noise(abreast):
    """A bank assumes the noise of the sensor unless it is given: a fact that follows from another one."""
    base = cut(get("ch5-seven-step"))
    runs = [(with_values(base, {"sensor.noise_um": noise}), 1) for noise in (0.05, 0.1, 0.2)]
    found = batch.outcomes(runs)
    assert abreast == []
    assert [said(one) for one in found] == [said(outcome(*run)) for run in runs]


def test_a_run_that_trips_is_told_of_as_it_is_alone(abreast):
    scenario = cut(get("ch5-seven-step"))
    tight = Scenario.load({**scenario.document, "guard": {"travel_um": 0.45}})
    runs = [(tight, 1), (scenario, 2), (tight, 3), (scenario, 4)]
    found = batch.outcomes(runs)
    assert [bool(entry.trip) for entry in found] == [True, False, True, False] and sorted(abreast) == [1, 3]
    assert [said(entry) for entry in found] == [said(outcome(*one)) for one in runs]


def test_a_block_that_a_command_exchanges(abreast):
    document = {**cut(get("ch5-seven-step")).document, "events": [{"at_sample": 5, "set": {"plant.model": "planar"}}]}
    found = batch.outcomes([(Scenario.load(document), seed) for seed in (1, 2, 3)])
    assert len(abreast) == 3
    assert [said(entry) for entry in found] == [said(outcome(Scenario.load(document), seed)) for seed in (1, 2, 3)]


def test_warnings_are_those_of_a_run_alone_in_their_order(abreast):
    """Warnings of taps that rise, of blocks before the first tick, and of changes by a command; shadows warn of
    nothing."""
    slow, slower = ({"kind": "arx_bank", "every": every} for every in (5, 20))
    thin = {"at_sample": 200, "set": {"controller.layer_um": 1e-4}}
    tone = {"at_sample": 120, "set": {"reference.frequency_hz": 4000.0}}
    benches = (
        ("ch5-seven-step", {"diagnosers.slow": slow, "events": [tone]}, 2),
        ("ch3-stvsc-mass", {"controller.layer_um": 1e-4, "diagnosers.slow": slower}, 2),
        ("ch3-stvsc-mass", {"events": [thin], "diagnosers.slow": slower}, 2),
        ("ch3-stvsc-mass", {"controller.layer_um": 1e-4, "diagnosers.slow": slower, "events": [tone]}, 3),
        ("ch5-seven-step", {"controllers.stvsc.layer_um": 1e-4}, 0),
    )
    for name, values, count in benches:
        scenario = with_values(cut(get(name)), values)
        found = batch.outcomes([(scenario, seed) for seed in (1, 2, 3)])
        assert not abreast and len(found[0].warnings) == count, found[0].warnings
        for ours in found:
            assert said(ours) == said(outcome(scenario, ours.seed))
            assert ours.warnings == run(scenario, ours.seed).warnings
