"""Figures of a run against closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.errors import InputError
from scenarios.campaign.single import run_seeds
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.measure.metrics import delay_ratios, first_peak, fundamental, step_lengths
from scenarios.run import run
from scenarios.schema import Scenario
from scenarios.seeds import parse_seeds
from tests.lab import document

M, BETA, K = 2.2090e-10, 7.09e-7, 0.0538


def metrics(values: dict[str, Any], ms: float = 60.0, **head: Any) -> dict[str, float]:
    return run(Scenario.load({**document(values), "duration_ms": ms, **head})).metrics


def response(f: float, mass=1.0, stiffness=1.0, damping=1.0) -> complex:
    w = 2 * math.pi * f
    return 1 / (K * stiffness - M * mass * w**2 + 1j * BETA * damping * w)


def test_delays_are_taken_over_those_of_one_diagnoser():
    figures = {
        **{f"diagnosis.fixed.delay_samples.{step}": delay for step, delay in ((1, 0.0), (2, 12.0), (3, 10.0))},
        **{f"diagnosis.fast.delay_samples.{step}": delay for step, delay in ((1, 4.0), (2, 6.0))},
    }
    assert delay_ratios(figures, ["fixed", "fast", "verdicts"], "fixed") == {"compare.fast.delay_samples.2": 0.5}
    found = run(get("ch5-adaptive-forgetting")).metrics
    ratio = found["diagnosis.adaptive.delay_samples.2"] / found["diagnosis.fixed.delay_samples.2"]
    assert found["compare.adaptive.delay_samples.2"] == ratio and "compare.fixed.delay_samples.2" not in found
    with pytest.raises(InputError, match="diagnoser") as refused:
        with_values(get("ch5-adaptive-forgetting"), {"metrics.beside": "fixt"})
    assert refused.value.field == "metrics.beside"


@given(
    amplitude=st.floats(0.01, 100),
    phase=st.floats(-3.1, 3.1),
    offset=st.floats(-10, 10),
    frequency=st.floats(100, 5000),
    first=st.integers(0, 10_000),
)
def test_fundamental_is_the_phasor(amplitude, phase, offset, frequency, first):
    t = (first + np.arange(2000)) * 1e-5
    found = fundamental(offset + amplitude * np.sin(2 * np.pi * frequency * t + phase), frequency, 0.01, first)
    assert abs(found) == pytest.approx(amplitude, rel=1e-8)
    assert np.exp(1j * np.angle(found)) == pytest.approx(np.exp(1j * phase), abs=1e-8)


@pytest.mark.parametrize("frequency", [300.0, 2000.0, 4000.0])
def test_amplitude_and_phase(frequency):
    values = {
        "plant.drive": "analogue",
        "reference": {"kind": "sine", "amplitude_v": 4.0, "frequency_hz": frequency, "phase_deg": 30.0},
    }
    found = metrics(values)
    force = 4 * 24 * 8.8541878128e-12 * (2 / 2.1) * 20.0
    expected = -force * 4e6 * response(frequency) * np.exp(1j * np.radians(30))
    assert found["control.amplitude_um"] == pytest.approx(abs(expected), rel=2e-4)
    assert found["control.phase_deg"] == pytest.approx(np.degrees(np.angle(expected)), abs=0.02)
    assert found["control.effort_ratio"] == pytest.approx(1.0, abs=1e-9)
    assert found["control.effort_rms_v"] == pytest.approx(4 / math.sqrt(2), rel=2e-3)


@pytest.mark.parametrize(
    ("fault", "factors"),
    [
        ({"stiffness": 1.0}, {"stiffness": 2.0}),
        ({"stiffness": 0.2}, {"stiffness": 1.2}),
        ({"damping": 4.0}, {"damping": 5.0}),
    ],
)
def test_effort_ratio_is_that_of_the_responses(fault, factors):
    frequency = 2.9e3 / (2 * math.pi)
    values = {
        "controller": {"kind": "mrac", "adaptation_gain": 1.0},
        "reference": {"kind": "sine", "amplitude_v": 8.0, "frequency_hz": frequency},
    }
    events = [{"at_sample": 0, "fault": name, "severity": size} for name, size in fault.items()]
    found = metrics(values, 100.0, events=events)
    expected = abs(response(frequency) / response(frequency, **factors))
    assert found["control.effort_ratio"] == pytest.approx(expected, rel=0.005)


def test_errors_settling_and_overshoot_by_hand():
    values = {"reference": {"kind": "step", "amplitude_v": 10.0}, "model": {"kind": "direct"}}
    result = run(Scenario.load({**document(values), "samples": 1500}))
    x, model = result.signal("plant.displacement"), result.signal("model.displacement")
    e, final = x - model, model[-1]
    found = result.metrics
    assert found["control.rms_error_um"] == pytest.approx(math.sqrt(np.mean(e**2)))
    assert found["control.peak_error_um"] == pytest.approx(abs(final), rel=1e-9)
    assert found["control.tail_rms_error_um"] == pytest.approx(math.sqrt(np.mean(e[1125:] ** 2)))
    sigma = BETA / (2 * M) * 1e-3
    envelope = math.log(50) / sigma
    assert envelope * 0.8 < found["control.settling_ms"] < envelope * 1.1
    outside = np.flatnonzero(np.abs(e) > 0.02 * abs(final))
    assert found["control.settling_ms"] == pytest.approx((outside[-1] + 1) * 0.01)
    zeta = BETA / (2 * math.sqrt(K * M))
    assert found["control.overshoot_pct"] == pytest.approx(
        100 * math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2)), abs=0.5
    )
    assert found["control.effort_rms_v"] == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("start_ms", "offset_v", "amplitude_v"),
    [(0.0, 0.0, 10.0), (5.0, 0.0, 10.0), (5.0, 0.0, -10.0), (20.0, 6.0, 4.0), (20.0, 6.0, -6.0), (20.0, -2.0, 8.0)],
)
def test_overshoot_is_over_the_last_step_wherever_it_is_and_begins(start_ms, offset_v, amplitude_v):
    """exp(-pi z / sqrt(1 - z^2)) of the height of the step, up or down, once the earlier motion has decayed."""
    values = {
        "sample_rate_khz": 200,
        "reference": {"kind": "step", "amplitude_v": amplitude_v, "offset_v": offset_v, "start_ms": start_ms},
        "model": {"kind": "direct"},
    }
    zeta = BETA / (2 * math.sqrt(K * M))
    expected = 100 * math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2))
    assert metrics(values, 40.0)["control.overshoot_pct"] == pytest.approx(expected, abs=0.1)


def test_there_is_no_overshoot_without_a_step_or_with_one_in_the_tail():
    for reference in ({"kind": "constant", "amplitude_v": 0.0}, {"kind": "square", "amplitude_v": 5.0}):
        assert "control.overshoot_pct" not in metrics({"reference": reference}, 40.0)
    late = {"kind": "step", "amplitude_v": 10.0, "start_ms": 35.0}
    assert "control.overshoot_pct" not in metrics({"reference": late}, 40.0)


def test_since_and_tail_choose_the_stretch():
    values = {"reference": {"kind": "step", "amplitude_v": 10.0}, "model": {"kind": "direct"}}
    whole = metrics(values, 15.0)
    late = metrics(values, 15.0, metrics={"since_ms": 5.0})
    assert late["control.rms_error_um"] < 0.01 * whole["control.rms_error_um"]
    assert late["control.settling_ms"] == 0.0
    half = metrics(values, 15.0, metrics={"tail_share": 0.9})
    assert half["control.tail_rms_error_um"] > 10 * whole["control.tail_rms_error_um"]


@pytest.mark.parametrize("options", [{"since": 1}, {"since_ms": "soon"}, {"tail_share": True}])
def test_bad_metric_options(options):
    with pytest.raises(InputError):
        metrics({}, 1.0, metrics=options)


def test_device_metrics():
    found = metrics({}, 1.0)
    assert found["device.f0_hz"] == pytest.approx(math.sqrt(K / M) / (2 * math.pi))
    assert found["device.quality_factor"] == pytest.approx(math.sqrt(K * M) / BETA)
    assert found["device.static_gain_um_per_v"] == pytest.approx(-0.30093, rel=1e-4)
    assert run(Scenario.load({**document(), "samples": 1})).metrics["device.mass_kg"] == M


def test_step_lengths():
    assert step_lengths(np.array([0, 0, 1, 1, 1, -1, 0])) == [2, 3, 1]
    assert step_lengths(np.array([3.0])) == [1]


# -- several seeds


def test_seeds_give_means_and_spreads():
    scenario = Scenario.load(
        {**document({"sensor.noise_um": 0.1, "controller": {"kind": "pid"}}), "samples": 2000, "expect": []}
    )
    found = run_seeds(scenario, range(3, 7))
    single = [run(scenario, seed).metrics for seed in range(3, 7)]
    for name, value in found["metrics"].items():
        column = [entry[name] for entry in single]
        assert value == pytest.approx(np.mean(column), rel=1e-12)
        assert found["metrics_std"][name] == pytest.approx(np.std(column, ddof=1), rel=1e-9, abs=1e-15)
    assert found["metrics_std"]["control.rms_error_um"] > 0
    assert found["seeds"] == [3, 6] and found["tripped_runs"] == 0


@pytest.mark.parametrize("text", ["", "1", "1:", ":2", "3:2", "a:b", "-1:2", "1:2:3", "1.0:2"])
def test_bad_seeds(text):
    with pytest.raises(InputError) as error:
        parse_seeds(text)
    assert error.value.field == "--seeds"


def test_seeds_include_both_ends():
    assert list(parse_seeds("4:6")) == [4, 5, 6] and list(parse_seeds("7:7")) == [7]


def test_first_peak_is_over_the_first_peak_of_the_model():
    t = np.arange(1000) * 1e-3
    model = np.sin(2 * np.pi * 2 * t)
    for sign in (1.0, -1.0):
        assert first_peak(sign * 1.3 * model, sign * model) == pytest.approx(30.0, abs=1e-6)
        assert first_peak(sign * 0.8 * model, sign * model) == pytest.approx(-20.0, abs=1e-6)
    late = np.where(t < 0.4, model, 5.0)  # the model turns again at 3/8 s: a later peak is not the first peak
    assert first_peak(late, model) == pytest.approx(0.0, abs=1e-6)
    assert first_peak(model, np.zeros(1000)) is None
    assert first_peak(model, t) is None
