"""Calibration and diagnosis of devices that are simulated apart from the bench."""

from __future__ import annotations

import re

import numpy as np
import pytest

from core.errors import InputError
from core.measured_record import MeasuredRecord
from scenarios.library import get
from scenarios.records.calibration import calibrate
from scenarios.records.diagnosis import UNEXPLAINED, diagnose
from scenarios.records.fit import fit
from scenarios.records.shelf import RecordFolder
from scenarios.run import run
from scenarios.schema import Scenario
from tests.scenarios.records.foreign import DT, HEALTHY, NAMES, OTHERS, OUTSIDE, Foreign, draw, other_nominal
from tests.scenarios.records.study import bench_of


def record_of(one: Foreign) -> MeasuredRecord:
    return MeasuredRecord(1 / DT, one.drive.copy(), one.displacement.copy())


def right(one: Foreign, folder: RecordFolder) -> float:
    """Return the share of samples after the healthy stretch with the right verdict; 0 after a refusal."""
    found = diagnose(record_of(one), get("first-look"), 0, HEALTHY, folder)
    if found.result is None:
        return 0.0
    winner = np.stack([found.result.signal(f"kalman.probability.{name}") for name in NAMES]).argmax(axis=0)
    return float((winner == one.truth)[HEALTHY:].mean())


@pytest.mark.parametrize("seed", [1, 2])
def test_a_foreign_device_is_diagnosed_after_a_calibration_that_sees_no_label(seed: int, folder: RecordFolder) -> None:
    one = draw(seed)
    assert right(one, folder) >= 0.95
    found = calibrate(record_of(one), get("first-look").spec.nominal, 0, HEALTHY)
    for name, truth in one.ratios.items():
        estimate = getattr(found, name)
        assert abs(estimate.value - truth) < 4 * estimate.error, name
    step = found.quantum_um / 12**0.5
    assert found.noise_um == pytest.approx(np.hypot(one.drawn["noise"], step), rel=0.1)


@pytest.mark.parametrize("outside", OUTSIDE)
def test_a_device_outside_the_model_is_refused_in_a_sentence(outside: str) -> None:
    found = calibrate(record_of(draw(3, outside)), get("first-look").spec.nominal, 0, HEALTHY)
    assert found.refusal and not all(check.ok for check in found.checks)
    words = {"drifting delay": "delay", "stiction": "friction"}.get(outside, outside)
    assert words in found.refusal


def lossy(one: Foreign, share: float = 0.15) -> MeasuredRecord:
    """Return a record that lacks samples, one by one and in a stretch."""
    displacement, rng = one.displacement.copy(), np.random.default_rng(4)
    displacement[rng.random(len(displacement)) < share] = np.nan
    displacement[300:340] = np.nan
    return MeasuredRecord(1 / DT, one.drive.copy(), displacement)


@pytest.mark.parametrize("outside", ["friction", "second mode"])
def test_lost_samples_change_no_reason(outside: str) -> None:
    one, nominal = draw(3, outside, HEALTHY), get("first-look").spec.nominal
    whole, holes = calibrate(record_of(one), nominal), calibrate(lossy(one), nominal)
    words = [re.sub(r"[\d.-]+", "#", found.refusal) for found in (whole, holes)]
    assert words[0] == words[1] != ""
    shares = [re.findall(r"explains (\d+) %", found.refusal) for found in (whole, holes)]
    assert not shares[0] or abs(int(shares[0][0]) - int(shares[1][0])) <= 3


def test_lost_samples_refuse_no_device_that_fits() -> None:
    one, nominal = draw(1, samples=HEALTHY), get("first-look").spec.nominal
    whole, holes = calibrate(record_of(one), nominal), calibrate(lossy(one, 0.4), nominal)
    assert not holes.refusal and abs(holes.mass.value - whole.mass.value) < 4 * holes.mass.error
    assert 1.0 < holes.mass.error / whole.mass.error < 2.0


def test_a_single_tone_cannot_tell_mass_from_stiffness() -> None:
    t = np.arange(9000) * DT
    drive = 8 * np.sin(2 * np.pi * 2.0 * t)
    measured = np.sin(2 * np.pi * 2.0 * t - 1.0) + np.random.default_rng(1).normal(0, 0.02, 9000)
    found = calibrate(MeasuredRecord(1 / DT, drive, measured), get("first-look").spec.nominal, 0, HEALTHY)
    assert "cannot tell mass, damping and stiffness apart" in found.refusal and "two tones" in found.refusal


def test_a_healthy_record_of_the_bench_itself_has_no_fault(own: MeasuredRecord, folder: RecordFolder) -> None:
    healthy = MeasuredRecord(50.0, own.drive[:2000].copy(), own.displacement[:2000].copy())
    found = diagnose(healthy, get("ch5-seven-step"), 0, 1000, folder)
    assert not found.refusal and found.shares["kalman"]["healthy"] > 0.98
    assert found.shares["kalman"].get(UNEXPLAINED, 0.0) == 0.0


@pytest.mark.parametrize(
    ("first", "end", "text"), [(0, 100, "400 are the least"), (-1, 900, "within 0 and"), (0, 99999, "within 0 and")]
)
def test_a_stretch_that_cannot_calibrate_is_refused(first: int, end: int, text: str) -> None:
    with pytest.raises(InputError, match=text):
        calibrate(record_of(draw(1, samples=1000)), get("first-look").spec.nominal, first, end)


def test_a_voltage_that_rests_is_refused() -> None:
    rest = MeasuredRecord(50.0, np.zeros(1000), np.random.default_rng(1).normal(0, 0.01, 1000))
    with pytest.raises(InputError, match="does not move"):
        calibrate(rest, get("first-look").spec.nominal)


@pytest.mark.parametrize("moves", [[0.0, 0.0], [0.0, 1.0], [np.nan, 1.0]], ids=["never", "late", "lost"])
def test_a_displacement_that_rests_in_the_first_half_is_refused(moves: list[float]) -> None:
    rests = MeasuredRecord(50.0, np.random.default_rng(1).normal(size=4000), np.repeat(moves, 2000))
    with pytest.raises(InputError, match="the displacement does not move in the first half"):
        calibrate(rests, get("first-look").spec.nominal)


def test_a_slow_chirp_whose_first_half_ends_below_the_resonance_is_no_reason_against_the_model() -> None:
    """The first half knows little of the resonance in the second, and the refusal has to allow for that."""
    for seed in range(40, 46):
        nominal = other_nominal(seed)
        one = draw(seed, nominal=nominal, excitations=("slow chirp",))
        record = MeasuredRecord(1.0 / nominal.dt, one.drive.copy(), one.displacement.copy())
        found = calibrate(record, bench_of(nominal).spec.nominal, 0, HEALTHY)
        assert not found.refusal, (seed, found.refusal)


def test_a_loop_that_feeds_the_noise_back_shows_no_effect(folder: RecordFolder) -> None:
    bench = get("ch5-closed-loop")
    result = run(Scenario.load({**bench.document, "events": [], "expect": [], "samples": 8000}))
    drive, displacement = (np.array(result.signal(name)) for name in ("drive.voltage", "sensor.displacement"))
    found = diagnose(MeasuredRecord(50.0, drive, displacement), bench, 0, 4000, folder)
    assert found.outcome == "no fault", found.sentence


def test_a_bank_that_finds_a_fault_in_the_healthy_stretch_is_refused(folder: RecordFolder) -> None:
    """A slow tone hardly tells masses apart; with a process noise that is not there, the least spread wins."""
    slow = get("ch3-mrac-noise").document
    result = run(Scenario.load({**slow, "events": [], "expect": [], "duration_ms": 80}))
    drive, displacement = (np.array(result.signal(name)) for name in ("drive.voltage", "sensor.displacement"))
    bench = Scenario.load({**get("first-look").document, "device": slow["device"]})
    found = diagnose(MeasuredRecord(100.0, drive, displacement), bench, 0, 4000, folder)
    assert not found.calibration.refusal
    assert found.outcome == "refused" and found.result is None
    assert "kalman names m+10 in the healthy stretch, where there is none" in found.sentence


def test_the_numbers_are_fitted_to_both_halves() -> None:
    record, nominal = record_of(draw(1)), get("first-look").spec.nominal
    shape = DT, nominal.stiffness / nominal.mass, nominal.damping / nominal.mass
    half = fit(record.drive[: HEALTHY // 2], record.displacement[: HEALTHY // 2], *shape)
    mass = calibrate(record, nominal, 0, HEALTHY).mass
    assert mass.error / mass.value < 0.85 * np.sqrt(half.covariance[3, 3])


@pytest.mark.parametrize(("seed", "outside"), [(2712856665, "second mode"), (2712856656, "stiction")])
def test_an_effect_that_leaves_little_but_pulls_the_numbers_is_refused(seed: int, outside: str) -> None:
    nominal = other_nominal(seed)
    one = draw(seed, outside, nominal=nominal, excitations=OTHERS)
    record = MeasuredRecord(1.0 / nominal.dt, one.drive.copy(), one.displacement.copy())
    found = calibrate(record, bench_of(nominal).spec.nominal, 0, HEALTHY)
    assert [check.name for check in found.checks if not check.ok] == ["pulled"]
    assert re.search(r"the motion shows .*, which would change the (stiffness|damping) by", found.refusal)


@pytest.mark.long
def test_most_foreign_devices_are_diagnosed_and_intervals_cover_the_truth(folder: RecordFolder) -> None:
    shares, covered = [], []
    for seed in range(100, 160):
        one = draw(seed)
        shares.append(right(one, folder))
        found = calibrate(record_of(one), get("first-look").spec.nominal, 0, HEALTHY)
        for name, truth in one.ratios.items():
            low, high = getattr(found, name).interval
            covered.append(low <= truth <= high)
    assert np.mean([share >= 0.95 for share in shares]) >= 0.95
    assert 0.9 <= np.mean(covered) <= 0.99


@pytest.mark.long
@pytest.mark.parametrize("outside", OUTSIDE)
def test_devices_outside_the_model_get_no_confident_fault(outside: str, folder: RecordFolder) -> None:
    confident = 0
    for seed in range(200, 220):
        found = diagnose(record_of(draw(seed, outside)), get("first-look"), 0, HEALTHY, folder)
        wrong = [one for one in found.verdicts.get("kalman", []) if one.end <= HEALTHY and one.verdict in NAMES[1:]]
        confident += bool(wrong)
    assert confident == 0
