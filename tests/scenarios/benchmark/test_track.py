"""Tracks of the benchmark: the draws follow from the seed alone, and stay within the ranges of the track."""

from __future__ import annotations

import hashlib

import pytest

from core.errors import InputError
from scenarios.benchmark.seeds import seed_list
from scenarios.benchmark.track import ONSET, WARM, WITHIN, share, track, tracks

NAMES = ["known", "severity", "closed_loop", "drift", "sensor"]
SEEDS = seed_list("public", tuple(NAMES)).cases


def test_the_tracks_are_those_of_the_protocol() -> None:
    assert [*tracks()] == NAMES
    with pytest.raises(InputError) as refused:
        track("driftt")
    assert refused.value.field == "--track" and "drift" in str(refused.value)


def test_shares_are_the_bits_of_a_hash() -> None:
    """53 bits of SHA-256 over seed and name, in [0, 1): the same on every machine, and none follows from another."""
    assert share("00", "fault") == (int(hashlib.sha256(b"00 fault").hexdigest()[:16], 16) >> 11) / 2**53
    found = [share(f"{i:032x}", "fault") for i in range(20_000)]
    assert 0.0 <= min(found) and max(found) < 1.0
    assert sum(found) / len(found) == pytest.approx(0.5, abs=4 * 12**-0.5 / 20_000**0.5)


@pytest.mark.parametrize("name", NAMES)
def test_cases_follow_from_their_seeds(name: str) -> None:
    one, again, other = (track(name).case(seed) for seed in (SEEDS[name][0], SEEDS[name][0], SEEDS[name][1]))
    assert one == again and one.hash == again.hash != other.hash
    assert one.document["seed"] != other.document["seed"]


@pytest.mark.parametrize("name", NAMES)
def test_cases_vary_over_devices_noise_and_references_within_their_ranges(name: str) -> None:
    chosen = track(name)
    cases = [chosen.case(seed) for seed in SEEDS[name]]
    drawn = chosen.scenario["device"]["geometry"]
    for number, (low, high) in drawn.items():
        values = [case.document["device"]["geometry"][number] for case in cases]
        assert low <= min(values) < low + 0.1 * (high - low) and high - 0.1 * (high - low) < max(values) <= high
    assert {case.document["reference"]["kind"] for case in cases} == {one["kind"] for one in chosen.references}
    assert len({str(case.document.get("sensors", case.document["sensor"])) for case in cases}) == len(cases)
    assert ONSET[0] <= min(case.onset for case in cases) and max(case.onset for case in cases) < ONSET[1]
    assert all(case.document["samples"] == case.onset + WITHIN for case in cases)


@pytest.mark.parametrize("name", NAMES)
def test_every_fault_of_a_track_happens_and_truth_is_its_class(name: str) -> None:
    chosen = track(name)
    cases = [chosen.case(seed) for seed in SEEDS[name]]
    assert {case.truth for case in cases} == set(range(1, len(chosen.classes)))
    for case in cases:
        event = case.document["events"][-1]
        allowed = [one for one in chosen.faults if one.fault == event["fault"]]
        assert event["at_sample"] == case.onset > WARM
        assert any(
            [*chosen.classes][case.truth] == one.truth and within(one.severity, event["severity"]) for one in allowed
        )


def within(severity: object, value: float) -> bool:
    low, high = severity if isinstance(severity, tuple) else (severity, severity)
    return low <= value <= high


@pytest.mark.parametrize("name", NAMES)
def test_classes_share_out_the_hypotheses(name: str) -> None:
    chosen = track(name)
    said = [item for group in chosen.classes.values() for item in group]
    assert sorted(said) == sorted(item.name for item in chosen.hypotheses)
    first, *_ = chosen.classes
    assert first == "healthy" and chosen.hypotheses[0].is_nominal


def test_healthy_runs_have_no_fault_but_the_drift() -> None:
    for name in NAMES:
        events = track(name).healthy(SEEDS[name][0]).document.get("events", [])
        assert [event["fault"] for event in events] == (["stiffness"] if name == "drift" else [])
