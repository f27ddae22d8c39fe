"""The law of Leland: an axis held to a sine, the other at zero; against known rates, and against force to rebalance."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from core.device.catalogue import device
from scenarios.run import RunResult, run
from scenarios.schema import Scenario

DEG = math.pi / 180.0


def bench(ms: float, khz: float, **parts: Any) -> RunResult:
    document = {
        "sample_rate_khz": khz,
        "duration_ms": ms,
        "plant": {"model": "gyroscope", "thermal_noise": False},
        "slots": {"drive": "drive_tracking"},
        **parts,
    }
    return run(Scenario.load(document))


@pytest.mark.parametrize("dps", [300.0, -120.0])
@pytest.mark.parametrize(("name", "khz"), [("gyro-a", 200.0), ("gyro-b", 1000.0), ("gyro-c", 200.0)])
def test_rate_and_quadrature_come_to_what_is_there(name, khz, dps):
    """The rate with the cross damping in it, d_xy/2m, and k_xy/2mw; within half a percent of a held force."""
    table = device({"id": name}).gyroscope
    assert table is not None
    o = table.two_axis()
    result = bench(
        300.0 if name != "gyro-c" else 1500.0,
        khz,
        device={"id": name},
        rate={"kind": "constant", "deg_per_s": dps},
        controller={"kind": "sense_axis_sync", "follow": "rest"},
    )
    rate = dps + o.damping_xy / (2e-3 * o.coriolis_mass) / DEG
    quadrature = o.stiffness_xy / (2e-3 * o.coriolis_mass * o.drive_frequency) / DEG
    found = result.metrics
    half = 0.5 * o.drive_frequency / khz
    assert found["rate.quadrature_dps"] == pytest.approx(quadrature * half / math.sin(half), rel=5e-3)
    assert found["rate.read_dps"] == pytest.approx(rate, rel=0.01, abs=1e-5 * abs(quadrature))


@pytest.mark.parametrize(("sigma", "learns"), [(0.3, 0.01), (1.0, 0.02)])
def test_over_a_period_it_is_force_to_rebalance(sigma, learns):
    """Matched modes: the integral of force to rebalance with g = 2 sigma lambda w, y damped by 2 m sigma more."""
    mass, stiffness, damping = 1.8e-7, 64.0, 1.8e-6
    table = {
        "mass_x_kg": mass,
        "stiffness_x_n_m": stiffness,
        "stiffness_y_n_m": stiffness,
        "stiffness_xy_n_m": 0.0,
        "damping_x_ns_m": damping,
        "damping_xy_ns_m": 0.0,
        "damping_y_ns_m": damping,
    }
    w = 1e-3 * math.sqrt(stiffness / mass)
    parts: dict[str, Any] = {"rate": {"kind": "step", "deg_per_s": 100.0, "start_ms": 100.0}}
    law = {"kind": "sense_axis_sync", "follow": "rest", "rate_per_ms": learns, "damping_per_ms": sigma}
    lyapunov = bench(400.0, 1000.0, device={"id": "gyro-a", "gyroscope": table}, controller=law, **parts)
    damped = {**table, "damping_y_ns_m": damping + 2e3 * mass * sigma}
    loop = {"kind": "force_to_rebalance", "integral_gain_per_ms3": 2.0 * sigma * learns * w, "bandwidth_hz": 1e4}
    integral = bench(400.0, 1000.0, device={"id": "gyro-a", "gyroscope": damped}, controller=loop, **parts)

    y, other = lyapunov.signal("plant.y")[110_000:], integral.signal("plant.y")[110_000:]
    assert np.abs(y).max() > 1e-4
    np.testing.assert_allclose(y, other, atol=0.02 * np.abs(y).max())
