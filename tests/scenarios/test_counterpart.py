"""The same scenario with its controllers taken away, and what the library says of it."""

from __future__ import annotations

import pytest

from scenarios.campaign.single import beside, compared
from scenarios.counterpart import counterpart
from scenarios.edit import with_values
from scenarios.library import get, library
from scenarios.run import run

CONTROLLED = [scenario for scenario in library() if counterpart(scenario) is not None]


def test_every_controller_that_drives_is_replaced_and_faults_stay():
    events = [
        {"at_sample": 5, "switch": "mrac", "cold": True},
        {"at_sample": 6, "set": {"controller.adaptation_gain": 2.0, "sensor.noise_um": 0.1}},
        {"at_sample": 7, "set": {"controller.kind": "stvsc"}},
        {"at_sample": 8, "fault": "added_mass", "severity": 0.1},
    ]
    twins = {"other": {"controller": {"kind": "pid"}}, "plain": {"sensor": {"noise_um": 0.2}}}
    base = with_values(get("ch3-mrac-spring-x2"), {"events": events, "twins": twins})
    for kind in ("open_loop", "pid"):
        other = counterpart(base, kind)
        assert other is not None and other.spec.seed == base.spec.seed
        assert {spec.active for spec in (other.spec, *other.twins.values())} == {kind}
        assert other.head.events == [
            {"at_sample": 5, "switch": kind},
            {"at_sample": 6, "set": {"sensor.noise_um": 0.1}},
            {"at_sample": 8, "fault": "added_mass", "severity": 0.1},
        ]


def test_it_is_the_open_loop_to_the_bit():
    alone = with_values(get("ch3-mrac-spring-x2"), {"controller": {"kind": "open_loop"}})
    assert compared(get("ch3-mrac-spring-x2"), [1])["open_loop"][0].metrics == run(alone).metrics


def test_scenarios_without_a_controller_have_none():
    for name in ("ch5-seven-step", "ch1-beam-width", "appB-mit", "ch6-gyro-imperfections", "ch5-noise-over"):
        assert counterpart(get(name)) is None, name
        summary = beside(run(get(name)))
        assert all(entry["open_loop"] is None and entry["pid"] is None for entry in summary["expectations"])


def test_of_a_gyroscope_only_the_sense_axis_is_opened():
    other = counterpart(get("ch6-sense-axis-sync"))
    assert other is not None and other.spec.driving == {"drive": "drive_tracking", "sense": "open_loop_rate"}
    assert counterpart(get("ch6-sense-axis-sync"), "pid") is None


@pytest.mark.parametrize("scenario", CONTROLLED, ids=lambda scenario: scenario.id)
def test_what_praises_a_controller_is_missed_without_it(scenario):
    """By twice the tolerance; anything else says why it compares with nothing."""
    others = compared(scenario, [scenario.spec.seed])
    for entry in scenario.head.expect:
        assert entry.compare, f"{entry.metric} says neither what it is compared with nor why with nothing"
        against = {"open_loop": ["open_loop"], "pid": ["open_loop", "pid"], "none": []}[entry.compare]
        for kind in against:
            measured = others[kind][0].metrics.get(entry.metric)
            assert entry.missed_twice(measured), f"{entry.metric} {entry.text()}: {kind} gives {measured}"


def test_only_those_with_a_controller_compare():
    for scenario in library():
        if scenario not in CONTROLLED:
            assert not any(entry.compare for entry in scenario.head.expect), scenario.id
