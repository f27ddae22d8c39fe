"""The same scenario with its controllers taken away, and the comparisons of the library."""

from __future__ import annotations

from scenarios.campaign.single import beside, compared
from scenarios.counterpart import counterpart, replaced
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from tests.library_pass import results


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


def test_a_claim_for_a_controller_is_missed_without_it():
    """By twice the tolerance; any other expectation says why it compares with nothing."""
    wrong = []
    for name, found in results().items():
        scenario = get(name)
        if not replaced(scenario, "open_loop"):
            wrong += [f"{name} compares without a controller" for entry in scenario.head.expect if entry.compare]
            continue
        for entry in scenario.head.expect:
            if not entry.compare:
                wrong.append(f"{name}: {entry.metric} is compared with nothing and gives no reason")
            for kind in {"open_loop": ["open_loop"], "pid": ["open_loop", "pid"]}.get(entry.compare, []):
                measured = found["counterparts"][kind].get(entry.metric)
                if not entry.missed_twice(measured):
                    wrong.append(f"{name}: {entry.metric} {entry.text()}: {kind} gives {measured}")
    assert wrong == []
