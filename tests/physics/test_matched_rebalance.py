"""Force to rebalance at matched modes: the loop of its closed form, its noise, a split that changes, its limit."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.signal import welch

from tests.tuned import BOLTZMANN, D_Y, K_Y, MASS_Y, OMEGA, ran, softening, split_hz, stiffness_of_y, volts_for

SIGMA = 0.5 * D_Y / MASS_Y
LIMIT = abs(stiffness_of_y(np.array(OMEGA), 0.0)) * D_Y / (2.0 * MASS_Y**2)
"""Gain at which the loop rings on the nominal split, 1/ms^3."""
REBALANCED: dict[str, Any] = {"controller": {"kind": "force_to_rebalance"}, "sample_rate_khz": 50}
UNCOUPLED: dict[str, Any] = {"device.gyroscope": {"stiffness_xy_n_m": 0.0}}


def at(split: float) -> dict[str, Any]:
    return {"controllers.tuning_voltage.voltage_v": volts_for(split) if split < 53.0 else 0.0}


def held_more(khz: float) -> float:
    """Return how much more force a held one needs than a continuous one."""
    half = OMEGA * 0.5 / khz
    return float(half / np.sin(half))


def loop(split: float, gain: float | None, khz: float = 50.0) -> tuple[complex, complex]:
    """Return p = D/2jwm, at which an envelope of y decays, and c of the loop c/(s^2 + p s + c) with a held force."""
    p = complex(stiffness_of_y(np.array(OMEGA), volts_for(split))) / (2j * OMEGA * MASS_Y)
    return p, (0.436 if gain is None else gain / LIMIT) * SIGMA * p / held_more(khz)


def rise(p: complex, c: complex, ms: np.ndarray) -> np.ndarray:
    """Return the answer to a unit step of the closed loop and the low-pass of 50 Hz, by partial fractions."""
    corner = 2e-3 * np.pi * 50.0
    poles = np.append(np.roots([1.0, p, c]), -corner)
    found = np.ones(len(ms), complex)
    for k, pole in enumerate(poles):
        found += c * corner / (pole * np.prod(pole - np.delete(poles, k))) * np.exp(pole * ms)
    return found.real


@pytest.mark.parametrize(("split", "gain"), [(53.16, None), (15.0, None), (0.0, None), (0.0, 0.8), (15.0, 0.2)])
def test_a_step_of_the_rate_is_read_as_the_closed_loop_says(split: float, gain: float | None) -> None:
    """A gain of 0.8 is beyond the limit at 53 Hz."""
    changes = REBALANCED | UNCOUPLED | at(split) | {"rate": {"kind": "step", "deg_per_s": 100.0, "start_ms": 400.0}}
    if gain is not None:
        changes["controllers.force_to_rebalance.integral_gain_per_ms3"] = gain
    result = ran(900.0, changes)
    assert result.trip is None
    read = result.signal("force_to_rebalance.rate")[20_000:]
    ms = 0.02 * np.arange(len(read))
    np.testing.assert_allclose(read, 100.0 * held_more(50.0) * rise(*loop(split, gain), ms), atol=1.0)


@pytest.mark.parametrize(("share", "is_stable"), [(0.85, True), (1.15, False)])
def test_it_rings_where_the_split_is_less_than_half_of_the_split_it_counts_with(share: float, is_stable: bool) -> None:
    """Stable while sigma^2 + rho (split - lambda rho) > 0, with the split rho of the nominal device."""
    known, c = loop(53.16, None)
    rho = -known.imag
    held_share = 0.436 / held_more(50.0)
    least = held_share * rho - SIGMA**2 / rho
    critical = 2.0 * OMEGA * MASS_Y * (least - rho) / K_Y
    assert critical == pytest.approx(-0.0152, abs=2e-4)
    p = SIGMA - 1j * (rho + share * (least - rho))
    assert (np.roots([1.0, p, c]).real.max() < 0.0) == is_stable
    fault = {"at_ms": 200.0, "fault": "sense_stiffness", "severity": share * critical}
    step = {"kind": "step", "deg_per_s": 100.0, "start_ms": 400.0}
    read = ran(800.0, REBALANCED | UNCOUPLED | {"events": [fault], "rate": step}).signal("force_to_rebalance.rate")
    expected = 100.0 * held_more(50.0) * rise(p, c, 0.02 * np.arange(20_000))
    if is_stable:
        np.testing.assert_allclose(read[20_000:], expected, atol=0.03 * np.abs(expected).max())
    else:
        away = np.abs(read - 100.0 * held_more(50.0))
        assert away[-3000:].max() > 1.5 * away[22_000:25_000].max()


@pytest.mark.parametrize("split", [53.16, 0.0])
def test_the_noise_of_the_rate_is_that_of_damping_and_pick_off_through_the_loop(split: float) -> None:
    """sqrt 2 sqrt(4 k T d)/(2 m w A) below the bandwidth of the loop; a pick-off counts by D(s), which y needs."""
    changes = {"plant.thermal_noise": True, "sensor.noise_pm_rthz": 0.5, "sample_rate_khz": 30}
    read = ran(9000.0, REBALANCED | UNCOUPLED | at(split) | changes).signal("force_to_rebalance.rate")[30_000:]
    hz, density = welch(read, fs=30_000.0, nperseg=60_000)
    used = (hz >= 0.5) & (hz <= 15.0)
    p, c = loop(split, None, 30.0)
    per_force = held_more(30.0) * np.degrees(1e3 / (2.0 * MASS_Y * OMEGA * 5.0))
    through, noise = np.zeros(len(hz)), np.zeros(len(hz))
    for s in (2e-3j * np.pi * hz, -2e-3j * np.pi * hz):
        share = np.abs(c / (s * s + p * s + c)) ** 2
        through += 0.5 * share
        noise += 0.5 * share * np.abs(2.0 * OMEGA * MASS_Y * (p + s)) ** 2
    thermal = (per_force * 1e6) ** 2 * 2.0 * 4.0 * BOLTZMANN * 300.0 * D_Y * 1e-3 * through
    pick_off = per_force**2 * 0.5 * (0.5e-6) ** 2 * noise
    expected = (thermal + pick_off) / (1.0 + (hz / 50.0) ** 2)
    assert np.sqrt((density[used] / expected[used]).mean()) == pytest.approx(1.0, abs=0.15)


def test_it_reads_rate_and_quadrature_while_mode_matching_works_and_the_spring_changes() -> None:
    """The split is 53 Hz, then 0, then 6, then 0; an open loop at a split of 6 Hz reads 41 % less."""
    fault = {"at_ms": 1400.0, "fault": "sense_stiffness", "severity": 0.003}
    changes = {"slots.tuning": "mode_matching", "rate.deg_per_s": 20.0, "events": [fault]}
    result = ran(2800.0, REBALANCED | changes)
    assert result.trip is None
    split, rate = result.signal("plant.split"), result.signal("force_to_rebalance.rate")
    quadrature, y = result.signal("force_to_rebalance.quadrature"), result.signal("plant.y")
    assert split[1410 * 50] > 5.0
    for tick in (1390 * 50, -1):
        assert abs(split[tick]) < 0.01 * split_hz(0.0)
        assert rate[tick] == pytest.approx(20.0 * held_more(50.0), abs=0.4)
        assert quadrature[tick] == pytest.approx(200.0 * held_more(50.0), rel=0.01)
    assert np.abs(y[1300 * 50 : 1390 * 50]).max() < 0.02  # the pilots; without the loop 0.62 um


@pytest.mark.parametrize("severity", [0.003, -0.003])
def test_matched_modes_hold_when_the_spring_changes_unseen(severity: float) -> None:
    """With D = j w d the loop s^2 + (sigma - j split) s + share sigma^2 is stable for every split."""
    event = {"at_ms": 600.0, "fault": "sense_stiffness", "severity": severity}
    changes = {"rate.deg_per_s": 20.0, "events": [event]}
    result = ran(1400.0, REBALANCED | UNCOUPLED | at(0.0) | changes)
    assert result.trip is None
    split = split_hz(np.sqrt(volts_for(0.0) ** 2 - severity * 987.2898 / softening(1.0)))
    assert result.signal("plant.split")[-1] == pytest.approx(split, rel=1e-3)
    assert result.signal("force_to_rebalance.rate")[-1] == pytest.approx(20.0 * held_more(50.0), rel=0.01)
