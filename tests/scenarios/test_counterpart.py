"""The same scenario with its controllers taken away, and the comparisons of the library."""

from __future__ import annotations

import math

import pytest

from core.errors import InputError
from scenarios.campaign.batch import outcomes
from scenarios.campaign.single import beside, compared
from scenarios.comparator import FEEDFORWARD, POLES, SIZE
from scenarios.counterpart import counterpart, replaced
from scenarios.edit import with_values
from scenarios.library import get, ids, library
from scenarios.run import run
from scenarios.schema import Scenario
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


def test_a_slot_between_drive_and_sense_has_its_usual_controller():
    other = counterpart(get("ch6-mode-matching"))
    assert other is not None
    assert other.spec.driving == {"drive": "drive_loop", "tuning": "tuning_voltage", "sense": "open_loop_rate"}


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
            elif entry.compare != "none":
                measured = found["counterparts"]["open_loop"].get(entry.metric)
                if not entry.missed_twice(measured):
                    wrong.append(f"{name}: {entry.metric} {entry.text()}: the open loop gives {measured}")
    assert wrong == []


# -- the PID that claims are compared with


def has_room_for_a_pid(scenario: Scenario) -> bool:
    """Whether a PID could drive in place of another controller."""
    try:
        return not scenario.spec.axes and scenario.spec.active != "pid" and bool(tried(scenario, 1.3, 0.0))
    except InputError:  # of first order
        return False


def tried(scenario: Scenario, pole: float, feedforward: float) -> Scenario:
    """Return the scenario without faults, under a PID."""
    whole = [event for event in scenario.head.events if "fault" not in event]
    pid = {"kind": "pid", "pole": pole, "feedforward": feedforward}
    return with_values(scenario, {"controller": pid, "events": whole, "expect": [], "twins": {}})


def test_a_claim_for_a_controller_is_compared_with_a_pid_where_one_has_a_place():
    wrong = []
    for scenario in library():
        if scenario.head.comparator is not None and not scenario.id.startswith(("ch3-", "ch4-")):
            wrong.append(f"{scenario.id}: its comparator is not looked at below")
        kinds = {entry.compare for entry in scenario.head.expect} - {None, "none"}
        due = {"pid" if has_room_for_a_pid(scenario) else "open_loop"} if kinds else set()
        if kinds != due or (scenario.head.comparator is not None) != (due == {"pid"}):
            wrong.append(f"{scenario.id} compares with {kinds}, with {scenario.head.comparator}")
    assert wrong == []


def test_a_row_says_whether_the_pid_meets_its_claim_too():
    wrong = []
    for name, found in results().items():
        for entry, row in zip(get(name).head.expect, found["gallery"]["expectations"], strict=True):
            pid = found["counterparts"].get("pid", {}).get(entry.metric)
            if entry.compare == "pid" and entry.does_as_well(pid) != entry.pid_too:
                wrong.append(f"{name}: {entry.metric} {entry.text()}: the PID gives {pid}")
            if entry.compare == "pid" and (row["pid"], row["pid_too"]) != (pid, entry.pid_too):
                wrong.append(f"{name}: {entry.metric} has {row['pid']} beside it")
    assert wrong == []


@pytest.mark.parametrize("name", [name for name in ids() if name.startswith(("ch3-", "ch4-"))])
def test_the_comparator_is_the_best_of_its_family_on_the_healthy_device(name: str):
    """Twelve runs: the pole by its feedback alone, then the feed-forward with this pole."""
    scenario = get(name)
    if scenario.head.comparator is None:
        return
    family = [(pole, feedforward) for pole in POLES for feedforward in FEEDFORWARD]
    runs = outcomes([(tried(scenario, *member), scenario.spec.seed) for member in family])
    left = {
        member: math.inf if run.stopped else run.metrics["control.tail_rms_error_um"]
        for member, run in zip(family, runs, strict=True)
    }
    pole = min(POLES, key=lambda one: left[one, 0.0])
    feedforward = min(FEEDFORWARD, key=lambda one: left[pole, one])
    chosen = scenario.head.comparator
    assert math.isfinite(left[pole, feedforward]) and len(family) == SIZE == 12
    assert (chosen.pole, chosen.feedforward) == (pole, feedforward)
    assert chosen.name == f"best PID of 12: pole {pole:g}, feed-forward {feedforward:g}"


def test_another_bench_has_no_comparator_and_another_fault_has():
    scenario = get("ch3-mrac-damping-x5")
    assert scenario.verdict == "reproduced, by a PID too"
    for values in ({"events.0.severity": 0.5}, {"controller.adaptation_gain": 2.0}, {"seed": 3}, {"expect": []}):
        assert with_values(scenario, values).head.comparator == scenario.head.comparator
    for values in ({"reference.frequency_hz": 2000.0}, {"sensor.noise_um": 0.1}, {"duration_ms": 50}):
        other = with_values(scenario, values)
        assert other.head.comparator is None and counterpart(other, "pid") is None and other.verdict == "reproduced"
        assert compared(other, [1]).keys() == {"open_loop"}
        assert other.head.compared_with(other.head.expect[0]) == "no PID was tuned for this bench"
    with pytest.raises(InputError, match="pole must be one of"):
        with_values(scenario, {"comparator": {"pole": 1.4, "feedforward": 1.0}})
