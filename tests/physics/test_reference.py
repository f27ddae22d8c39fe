"""References against their formulas."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from scipy import signal, stats

from core import registry
from core.block import Block, BlockParams, Context, Oscillator
from tests.lab import make, play

DT = 0.01
T = np.arange(3000) * DT


def voltage(n: int = 3000, **table: Any) -> np.ndarray:
    return play(make({"reference": table, "guard": {"travel_um": 1000.0}}), n)["reference.voltage"]


def played(block: type[Block], params: BlockParams, context: Context, tick: int) -> np.ndarray:
    """Return what plays at a tick: now, half a sample and one sample later."""
    x = block.Ports(np.array([float(tick), 0.0, 0.0, 0.0, 0.0]), np.array([2, 3, 4]))
    block.step(block.Packed(block.packed(params, context)), block.state(params, context), x)
    return x.signals[2:]


@pytest.mark.parametrize(("frequency", "phase"), [(1000.0, 0.0), (333.3, 77.0), (0.0, 90.0), (2000.0, -400.0)])
def test_sine(frequency, phase):
    found = voltage(kind="sine", amplitude_v=3.0, frequency_hz=frequency, phase_deg=phase, offset_v=0.5)
    expected = 0.5 + 3 * np.sin(2 * np.pi * frequency * T / 1e3 + np.radians(phase))
    np.testing.assert_allclose(found, expected, atol=1e-11)


def test_multi_sine():
    tones = [(159.155, 1.0, 0.0), (461.5, 0.5, 30.0), (2000.0, -0.25, -90.0)]
    found = voltage(
        kind="multi_sine",
        amplitude_v=4.0,
        offset_v=-1.0,
        tones=[{"frequency_hz": f, "amplitude": a, "phase_deg": p} for f, a, p in tones],
    )
    expected = -1 + 4 * sum(a * np.sin(2 * np.pi * f * T / 1e3 + np.radians(p)) for f, a, p in tones)
    np.testing.assert_allclose(found, expected, atol=1e-11)


def test_chirp_against_scipy():
    found = voltage(2500, kind="chirp", amplitude_v=2.0, start_hz=500.0, stop_hz=5000.0, duration_ms=10.0)
    one = 2 * signal.chirp(T[:1000] / 1e3, 500.0, 0.01, 5000.0, phi=-90)
    np.testing.assert_allclose(found[:1000], one, atol=1e-9)
    np.testing.assert_allclose(found[1001:2000], one[1:], atol=1e-9)  # and again from the start


@pytest.mark.parametrize("every", [2, 3, 7])
@pytest.mark.parametrize("drive", ["held", "analogue"])
def test_what_plays_every_few_ticks_is_the_same_wave_held_over_them(every, drive):
    tables = {"plant": {"model": "linear", "drive": drive}, "guard": {"travel_um": 1000.0}}
    wave = {"kind": "sine", "amplitude_v": 3.0, "frequency_hz": 700.0}
    each = play(make({**tables, "reference": wave}), 500)["reference.voltage"]
    found = play(make({**tables, "reference": {**wave, "every": every}}), 500)["reference.voltage"]
    np.testing.assert_array_equal(found, each[np.arange(500) // every * every])


@pytest.mark.parametrize("duty", [0.5, 0.25, 1.0])
def test_square(duty):
    found = voltage(kind="square", amplitude_v=5.0, frequency_hz=250.0, duty=duty, offset_v=1.0)
    inside = np.arange(3000) % 400 / 400
    away = np.abs(inside - duty) > 1e-6  # ticks that fall on an edge may round either way
    away &= inside > 1e-6
    assert np.array_equal(found[away], np.where(inside < duty, 6.0, -4.0)[away])


def test_step_and_constant():
    found = voltage(300, kind="step", amplitude_v=5.0, start_ms=1.5, offset_v=1.0)
    assert np.array_equal(found, np.where(np.arange(300) >= 150, 6.0, 1.0))
    assert np.all(voltage(50, kind="constant", amplitude_v=-2.0, offset_v=0.5) == -1.5)


def test_prbs_is_a_fair_coin_for_each_chip():
    board = {"kind": "prbs", "amplitude_v": 0.2, "chip_rate_hz": 10_000.0, "offset_v": 0.1}
    found = voltage(200_000, **board)
    np.testing.assert_allclose(np.unique(found), [-0.1, 0.3])
    chips = found.reshape(-1, 10)
    # a tick on the edge of a chip may round into the one before
    assert np.all(chips[:, 1:] == chips[:, 1:2])
    bits = np.sign(chips[:, 5] - 0.1)
    assert stats.binomtest(int(np.sum(bits > 0)), len(bits)).pvalue > 1e-3
    for lag in range(1, 20):
        assert abs(np.mean(bits[lag:] * bits[:-lag])) < 4.5 / math.sqrt(len(bits))
    again = voltage(1000, **board)
    assert np.array_equal(again, found[:1000])
    other = play(make({"reference": board, "seed": 2}), 1000)["reference.voltage"]
    assert not np.array_equal(other, found[:1000])


@pytest.mark.parametrize("kind", sorted(registry.blocks("reference")))
def test_values_between_samples_are_those_of_a_finer_clock(kind):
    """Half a sample and one sample later, for a generator; held, for a converter."""
    block = registry.block("reference", kind)
    device = Oscillator(mass=2.2e-4, damping=7e-4, stiffness=0.0538, force=-0.0162)
    # no edge falls on a tick or between two by the width of a rounding
    odd = {"prbs": {"chip_rate_hz": 7777.7}, "square": {"frequency_hz": 2111.1}, "step": {"start_ms": 0.1234}}
    params = block.Params(amplitude_v=3.0, **odd.get(kind, {}))

    def values(tick: int, dt: float, analogue: bool) -> np.ndarray:
        context = Context(dt_ms=dt, every=1, seed=1, device=device, model=device, analogue=analogue)
        return played(block, params, context, tick)

    for tick in range(40):
        now, middle, end = values(tick, DT, True)
        fine = [values(2 * tick + i, DT / 2, False)[0] for i in range(3)]
        np.testing.assert_allclose([now, middle, end], fine, atol=1e-9)
        assert len(set(values(tick, DT, False))) == 1


def test_sine_is_exact_after_hours():
    tick = 36_000_000_017  # 100 h at 100 kHz
    block = registry.block("reference", "sine")
    device = Oscillator(mass=2.2e-4, damping=7e-4, stiffness=0.0538, force=-0.0162)
    params = block.Params(amplitude_v=1.0, frequency_hz=1000.0)
    context = Context(dt_ms=DT, every=1, seed=1, device=device, model=device)
    cycles = Fraction(tick, 100) % 1
    assert played(block, params, context, tick)[0] == pytest.approx(math.sin(2 * math.pi * float(cycles)), abs=1e-6)
