"""The units of docs/own-units.md that begin with a state, identify, and detect without hypotheses: their laws."""

from __future__ import annotations

import re
from dataclasses import fields
from typing import Any

import numpy as np
import pytest
from scipy.signal import cont2discrete, lfilter

from core.block import Context, Oscillator
from core.own.offered import BUILTINS
from core.own.values import public
from scenarios.run import RunResult, run
from tests.core.own.test_own_units import examples, with_unit
from tests.core.own.texts import ROOT

FAULT = {"events": [{"fault": "added_mass", "severity": 0.05, "at_sample": 3000}]}
QUIET = {"sensor.noise_um": 0.0, "plant.drive_noise_v": 0.0}


@pytest.fixture(scope="module")
def texts() -> dict[str, str]:
    _, _, *more = examples()
    return dict(zip(("smoothed_integral", "tone_ratio", "residual_power"), more, strict=True))


def result(texts: dict[str, str], name: str, place: str, values: dict[str, Any]) -> RunResult:
    return run(with_unit(name, texts[name], {place: name, **values}, "first-look"), 7, taps=True)


def test_the_integral_begins_at_its_state_and_keeps_its_law(texts: dict[str, str]) -> None:
    """u_n = u_{n-1} + h/(T g) sum w_i e_{n-i}, within the reach of the drive; w sums to 1."""
    step = {"kind": "step", "amplitude_v": 5.0}
    values = {"controllers.smoothed_integral.start_v": 2.0, "reference": step, "samples": 3000, **QUIET}
    one = result(texts, "smoothed_integral", "controller.kind", values)
    context = one.scenario.spec.context()
    error = one.signal("model.displacement") - one.signal("sensor.displacement")
    smooth = lfilter(np.array([1.0, 2.0, 2.0, 1.0]) / 6.0, 1.0, error)
    wanted = 2.0 + np.cumsum(smooth) * context.dt_ms / (5.0 * context.device.static_gain)
    np.testing.assert_allclose(one.signal("smoothed_integral.voltage"), wanted, rtol=1e-9)
    # 30 ms are six time constants of the loop
    left = 5.0 * context.device.static_gain - one.signal("plant.displacement")[-1]
    assert abs(left) < 2.0 * np.exp(-6.0) * abs(context.device.static_gain) * 3.0


def test_the_ratio_at_the_tone_is_mass_and_damping(texts: dict[str, str]) -> None:
    """k - m w^2 + j w b = F U/Y; the image at twice the tone leaves a ripple, whose mean over a period is 0."""
    events = [{**FAULT["events"][0], "at_sample": 6000}]
    values = {"events": events, **QUIET, "samples": 12000}
    one = result(texts, "tone_ratio", "identifiers.mine.kind", values)
    for name, before, after in (("mass", 1.0, 1.05), ("stiffness", 1.0, 1.0), ("damping", 1.0, 1.0)):
        estimate = one.signal(f"mine.estimate.{name}")
        assert estimate[5950:6000].mean() == pytest.approx(before, abs=1e-4)
        assert estimate[-50:].mean() == pytest.approx(after, abs=1e-4)
    image = 1.0 / (2.0 * 2e-3 * np.pi * 2000.0 * 5.0)  # of the two means, after a memory of 5 ms
    assert one.summary()["metrics"]["identify.mine.error_pct"] < 100.0 * 2.0 * image


def test_the_power_of_the_residual_detects_without_hypotheses(texts: dict[str, str]) -> None:
    one = result(texts, "residual_power", "diagnosers.mine.kind", {**FAULT, "samples": 6000})
    context = one.scenario.spec.context()
    device, dt = context.device, context.dt_ms
    a = np.array([[0.0, 1.0], [-device.stiffness / device.mass, -device.damping / device.mass]])
    b = np.array([[0.0], [device.force / device.mass]])
    phi, push, *_ = cont2discrete((a, b, np.eye(2), np.zeros((2, 1))), dt)
    motion, moved = np.zeros(2), []
    for voltage in [0.0, *one.signal("drive.voltage")[:-1]]:
        motion = phi @ motion + push[:, 0] * voltage
        moved.append(motion[0])
    residual = one.signal("sensor.displacement") - moved
    np.testing.assert_allclose(one.signal("mine.residual"), residual, atol=1e-9)
    kept = np.exp(-dt / 2.0)
    power = lfilter([1.0 - kept], [1.0, -kept], (residual / context.assumed_noise_um) ** 2)
    np.testing.assert_allclose(one.signal("mine.power"), power, rtol=1e-9)
    alarm = one.signal("mine.alarm")
    np.testing.assert_array_equal(alarm, power > 4.0)
    first = int(np.argmax(alarm))
    assert 3000 < first < 3200
    figures = one.summary()["metrics"]
    assert figures["diagnosis.mine.detection_samples"] == first - 3000
    assert figures["diagnosis.mine.false_alarm_fraction"] == 0.0


def test_a_healed_fault_is_healthy_again_for_a_diagnoser_without_hypotheses(texts: dict[str, str]) -> None:
    """A threshold below the power of noise alone is a false alarm in all healthy samples, and in those alone."""
    events = [{"fault": "added_mass", "severity": 0.05, "at_sample": 1000}, {"heal": "all", "at_sample": 2000}]
    values = {"events": events, "samples": 3000, "diagnosers.mine.threshold": 0.1}
    figures = result(texts, "residual_power", "diagnosers.mine.kind", values).summary()["metrics"]
    assert figures["diagnosis.mine.false_alarm_fraction"] == 1.0
    assert figures["diagnosis.mine.detection_samples"] == 0.0


def test_the_document_names_every_fact_and_every_function() -> None:
    text = (ROOT / "docs" / "own-units.md").read_text("utf-8")
    named = {name for span in re.findall(r"`([^`\n]+)`", text) for name in re.findall(r"\w+", span)}
    types = {"bool", "str", "list", "tuple", "float", "int"}
    later = {"drawing", "sensors", "banks"}  # tables for library blocks; a unit may not read them
    assert {one.name for one in fields(Context)} - later <= named
    assert public(Oscillator) <= named
    assert {*BUILTINS} - types <= named
