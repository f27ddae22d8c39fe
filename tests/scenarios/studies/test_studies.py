"""Studies: found by name, checked like blocks, run like scenarios; and the sweep on a live board."""

from __future__ import annotations

import math

import pytest

from core.device.identification import tone
from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.measure.sweep_sine import sweep_sine
from scenarios.run import run
from scenarios.schema import Scenario
from scenarios.studies import studies
from tests.lab import QUIET, do, make, play


@pytest.mark.parametrize(
    ("device", "field"), [({"id": "second-order-gain"}, "device.id"), ({"id": "lcr-350", "bias_v": 0}, "device.bias_v")]
)
def test_what_has_no_mass_or_is_not_moved_is_not_swept(device, field):
    with pytest.raises(InputError) as error:
        run(Scenario.load({"schema": 1, "device": device, "study": {"kind": "swept_sine"}}))
    assert error.value.field == field


def test_a_study_takes_values_like_any_other_part():
    narrow = with_values(get("ch1-beam-width"), {"study.widths_um": [2.0], "study.reduction_um": 0.3})
    assert run(narrow).metrics["beam_width.softer_2_um_pct"] == pytest.approx(100 * (1 - 0.85**3))
    few = with_values(get("ch1-process-spread"), {"study.draws": 500})
    assert run(few, 1).metrics != run(few, 2).metrics
    assert run(few, 1).digest == run(few, 1).digest


@pytest.mark.parametrize(
    ("study", "field"),
    [
        ({}, "study.kind"),
        ({"kind": "study"}, "study.kind"),
        ({"kind": "process_spred"}, "study.kind"),
        ({"kind": "process_spread", "drawz": 1}, "study.drawz"),
        ({"kind": "process_spread", "draws": 0}, "study.draws"),
    ],
)
def test_what_is_no_study_is_refused(study, field):
    with pytest.raises(InputError) as error:
        Scenario.load({"schema": 1, "study": study})
    assert error.value.field == field


def test_a_study_says_what_it_cannot_do():
    with pytest.raises(InputError) as error:
        run(Scenario.load({"schema": 1, "device": {"id": "ch3"}, "study": {"kind": "process_spread"}}))
    assert error.value.field == "device.id"
    with pytest.raises(InputError, match=r"device\.id: .*choose a resonator"):
        run(with_values(get("appA-persistency"), {"device.id": "unstable-first-order"}))
    first = run(with_values(get("appA-spr"), {"device.id": "unstable-first-order"})).metrics
    assert first["spr.chapter_4_model"] == 2.0 and "spr.displacement" not in first
    assert set(studies()) >= {"process_spread", "frequency_response", "beam_width", "printed_table", "swept_sine"}


def swept(**document):
    return run(Scenario.load({"schema": 1, "study": {"kind": "swept_sine"}, **document})).metrics


def test_a_sweep_returns_the_device():
    found = swept(device={"id": "ch3"})
    assert found["sweep.f_peak_hz"] == pytest.approx(2457.4, rel=3e-3)
    assert found["sweep.quality_factor"] == pytest.approx(4.862, rel=1e-2)
    assert found["sweep.read_f_peak_hz"] == pytest.approx(2457.4, rel=3e-3)
    assert found["sweep.read_f0_hz"] == pytest.approx(2483.8, rel=1e-3)
    assert found["sweep.read_quality_half_power"] == pytest.approx(4.862, rel=1e-2)
    assert found["sweep.read_quality_phase_slope"] == pytest.approx(4.862, rel=1e-2)
    assert found["sweep.mass_kg"] == pytest.approx(2.2090e-10, rel=1e-3)
    assert found["sweep.static_gain_um_per_v"] == pytest.approx(found["device.static_gain_um_per_v"], rel=1e-3)
    assert 0 < found["sweep.mass_error_kg"] < 1e-3 * found["sweep.mass_kg"]
    assert 0.9 < found["sweep.coherence"] <= 1.0


def test_a_sweep_sees_faults_and_air():
    events = [{"at_sample": 0, "fault": "added_mass", "severity": 0.05}]
    found = swept(device={"id": "ch3"}, environment={"pressure_pa": 1000.0}, events=events)
    assert found["sweep.mass_kg"] == pytest.approx(1.05 * 2.2090e-10, rel=1e-3)
    assert found["sweep.quality_factor"] == pytest.approx(35 * 1.05**0.5, rel=0.1)
    assert found["device.quality_factor"] == pytest.approx(35, rel=0.1)  # the device in its air, without the fault


def test_a_sweep_of_a_live_board_leaves_it_alone():
    board, twin = make(), make()
    for one in (board, twin):
        do(one, {"switch": "pid"})
        do(one, {"fault": "stiffness", "severity": 0.2})
        play(one, 100)
    found = sweep_sine(board, points=9, cycles=20).found
    assert found.stiffness_n_m == pytest.approx(1.2 * 0.0538, rel=2e-3)
    play(board, 100), play(twin, 100)
    assert board.digest() == twin.digest() and board.spec.active == "pid"


def test_a_sweep_that_cannot_be_is_refused():
    board = make()
    with pytest.raises(InputError, match="below stop_hz"):
        sweep_sine(board, start_hz=3000, stop_hz=2000)
    with pytest.raises(InputError, match="sample rate"):
        sweep_sine(board, stop_hz=60_000)


@pytest.mark.parametrize(("omega", "effort"), [(1000.0, 1.751), (2900.0, 1.772)])
def test_adaptive_control_of_an_aged_device_with_more_mass_takes_the_effort_of_the_closed_form(omega, effort):
    """Case 1 of 3.1.3.2, the text's almost 80 %."""
    reference = {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": omega / (2 * math.pi)}
    document = {
        **QUIET,
        "schema": 1,
        "duration_ms": 60,
        "reference": reference,
        "controller": {"kind": "mrac", "adaptation_gain": 1.0},
        "events": [
            {"at_sample": 0, "fault": "ageing", "severity": 4.0},
            {"at_sample": 0, "fault": "added_mass", "severity": 0.05},
        ],
    }
    found = run(Scenario.load(document)).metrics
    assert found["control.effort_ratio"] == pytest.approx(effort, rel=2e-3)
    assert found["control.displacement_ratio"] == pytest.approx(1.0, rel=1e-3)


def test_a_tone_far_above_the_resonance_on_the_board():
    board = make({"sample_rate_khz": 2000, "reference.frequency_hz": 25_000.0, "reference.amplitude_v": 10.0})
    play(board, 20_000)  # 10 ms: the transient is over
    seen = play(board, 8_000)
    found = tone(25_000.0, board.dt_ms, seen["drive.voltage"], seen["plant.displacement"], held=True)
    static = board.spec.device.metrics()["static_gain_um_per_v"]
    assert 20 * math.log10(abs(found.response / static)) == pytest.approx(-40.03, abs=0.05)
