"""What controllers in shadow and sensors with a model make of a voltage that moves between their samples."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.signal import cont2discrete

from core.plain import plain
from core.sense import tracker
from core.sense.tracker import Filter, TrackerParams
from core.voltage import AppliedPorts, Gathered
from tests.lab import make, play

OMEGA, RATE_KHZ = 4.0 * math.pi, 20
FAST: dict[str, Any] = {
    "sample_rate_khz": RATE_KHZ,
    "plant": {"model": "linear", "drive": "analogue", "thermal_noise": False},
    "reference": {"kind": "sine", "amplitude_v": 3.0, "frequency_hz": 2000.0},
}
"""Ten samples a period of an analogue drive: its start is 18 degrees early, its middle 1.6 % too much."""


@pytest.mark.parametrize("kind", ["vsc", "vsmrc"])
def test_the_velocity_of_an_observer_is_the_true_one(kind):
    """Of a device that is as the observer knows it there is nothing to correct."""
    found = {}
    for source in ("true", "observer"):
        own = {kind: {"velocity": source}}
        found[source] = play(make({**FAST, "controllers": own}), 2000)[f"{kind}.surface"][500:]
    np.testing.assert_allclose(found["observer"], found["true"], atol=1e-9)


def test_the_auxiliary_error_of_an_mrac_in_shadow_in_closed_form():
    r"""With gains that do not move, :math:`\eta=\theta^TG_m[w]-G_m[u]`, w held at the samples and u as it was."""
    document = {**FAST, "controllers": {"mrac": {"adaptation_gain": 1e-9}}}
    board = make(document)
    trace = play(board, 3000)
    device = board.spec.device.oscillator()
    m, b, k, force = device.mass, device.damping, device.stiffness, device.force
    h, pole = 1.0 / RATE_KHZ, device.natural_frequency
    theta = [trace[f"mrac.gain.{name}"][-1] for name in ("r", "w1", "w2", "y")]
    turn = np.exp(1j * OMEGA * h)
    y = force / (k - m * OMEGA**2 + 1j * OMEGA * b)
    # of a volt held over a sample, and of a volt that continues as a sine
    plant = (np.array([[0, 1], [-k / m, -b / m]]), np.array([[0.0], [force / m]]), np.eye(2)[:1], np.zeros((1, 1)))
    a, g, c, *_ = cont2discrete(plant, h)
    held = (c @ np.linalg.solve(turn * np.eye(2) - a, g)).item()
    decay = math.exp(-pole * h)
    w1 = pole / (1j * OMEGA + pole)
    w2 = (1.0 - decay) * y / (turn - decay)
    eta = 3.0 * (held * (theta[0] + theta[1] * w1 + theta[2] * w2 + theta[3] * y) - y)
    expected = np.imag(eta * turn ** np.arange(2000, 3000))
    assert np.max(np.abs(expected)) > 1e-3
    np.testing.assert_allclose(trace["mrac.auxiliary_error"][2000:], expected, atol=2e-3 * np.max(np.abs(expected)))


@pytest.mark.parametrize("every", [1, 3])
@pytest.mark.parametrize("drive", ["held", "analogue"])
def test_a_sensor_with_a_model_predicts_the_motion_under_a_voltage_that_moves(drive, every):
    """From the true state on, uncorrected: the steady motion under a sine, by its phasor, at every turn."""
    document = {**FAST, "sample_rate_khz": 100, "plant": {**FAST["plant"], "drive": drive}}
    spec = make(document).spec
    context, device, h = spec.context(every), spec.context().device, spec.dt_ms
    p, s, gathered = tracker.model_of(TrackerParams(), context), Filter.zeros(), Gathered.zeros()
    tracker.put_at_rest(s, TrackerParams(), context)
    a = np.array([[0.0, 1.0], [-device.stiffness / device.mass, -device.damping / device.mass]])
    b = np.array([0.0, device.force / device.mass])
    turn = np.exp(1j * OMEGA * h)
    phi = expm(a * h)
    held = np.linalg.solve(turn * np.eye(2) - phi, (phi - np.eye(2)) @ np.linalg.solve(a, b))
    state = held if drive == "held" else np.linalg.solve(1j * OMEGA * np.eye(2) - a, b)
    s.x, s.v = state.imag
    for tick in range(1, 601):
        parts = (0.0, 0.0, 0.0) if drive == "held" else (0.0, 0.5, 1.0)
        u = np.array([math.sin(OMEGA * h * (tick - 1 + part)) for part in parts])
        x = AppliedPorts(np.array([float(tick), 0.0, *u]), np.array([2, 3, 4]))
        if not plain(tracker.between_updates)(p, gathered, x):
            tracker.predict(p, s, gathered)
            gathered.begun = 0.0
            expected = (state * turn**tick).imag
            np.testing.assert_allclose([s.x, s.v], expected, atol=1e-6 * np.max(np.abs(state)))
