"""A waveform of the bench as a force: the motion it makes against the forced response of the two coupled axes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.board.board import Board
from core.errors import InputError
from tests.lab import make, play
from tests.two_axis import DAMPING, GYRO, MASS, STIFFNESS, STILL, TURN, replay

KHZ = 100.0
WAVE: dict[str, Any] = {**STILL, "slots.drive": "waveform_drive", "controller.kind": "open_loop_rate"}
GAIN = "controllers.waveform_drive.gain_un_v"


def bench(waveform: dict[str, Any], values: dict[str, Any] | None = None) -> Board:
    return make({**WAVE, "waveform": waveform, **(values or {})}, base=GYRO)


def pass_over(board: Board, ticks: int) -> None:
    end = board.tick + ticks
    while board.tick < end:
        board.advance(end - board.tick)


def response(hz: float, dps: float) -> np.ndarray:
    """Return x and y per force along x and along y at a frequency: (K - w^2 m + jw(D + 2m Omega S))^-1."""
    w = 2e-3 * np.pi * hz
    turned = 2.0 * MASS * np.radians(dps) * 1e-3 * TURN
    return np.linalg.inv(STIFFNESS - MASS * w * w * np.eye(2) + 1j * w * (DAMPING + turned))


def held(hz: float) -> complex:
    """Return the output of a converter for a tone: weaker by sin(a)/a, later by a, half a sample."""
    a = np.pi * hz / (1e3 * KHZ)
    return complex(np.sin(a) / a * np.exp(-1j * a))


@pytest.mark.parametrize("axis", ["x", "y"])
@pytest.mark.parametrize("drive", ["held", "analogue"])
def test_tones_tell_the_frequency_response_of_both_axes(axis, drive):
    """After 3 s, 15 times the decay time of a swing, tones at and off the modes move both axes as they should."""
    tones = [1000.0, 2800.0, 2890.0, 3760.0, 5000.0]
    wave = {"kind": "multi_sine", "amplitude_v": 0.5, "tones": [{"frequency_hz": hz} for hz in tones]}
    axis_of = {"controllers.waveform_drive.axis": axis, GAIN: 0.04}
    board = bench(wave, {"drive.kind": drive, "rate.deg_per_s": 2000.0, **axis_of})
    pass_over(board, 300_000)
    trace = play(board, 10_000)  # whole periods of every tone
    number = "xy".index(axis)
    assert not np.any(trace[f"drive.{'yx'[number]}.force"])
    for hz in tones:
        expected = 0.02 * response(hz, 2000.0)[:, number] * (held(hz) if drive == "held" else 1.0)
        for q, of in zip("xy", expected, strict=True):
            # a tone is sin, so the imaginary part of its phasor
            swing = np.fft.rfft(trace[f"plant.{q}"])[round(hz / 10.0)] * 2j / 10_000
            assert abs(swing - of) < 1e-3 * abs(expected).max(), (hz, q)


@pytest.mark.parametrize(
    "waveform",
    [
        {"kind": "chirp", "start_hz": 2000.0, "stop_hz": 4500.0, "duration_ms": 20.0},
        {"kind": "square", "frequency_hz": 2893.0},
        {"kind": "prbs"},
        {"kind": "step", "start_ms": 1.0},
    ],
    ids=lambda one: one["kind"],
)
def test_any_reference_is_a_force(waveform):
    """The motion equals the matrix exponential under g r(t), with r from the generator."""
    trace = play(bench({**waveform, "amplitude_v": 2.0}, {GAIN: -0.25}), 3000)
    np.testing.assert_array_equal(trace["drive.x.force"], -0.25 * trace["waveform.voltage"])
    assert np.ptp(trace["drive.x.force"]) >= 0.5
    motion = np.column_stack([trace["plant.x"], trace["plant.y"]])
    np.testing.assert_allclose(motion, replay(trace), atol=1e-11)


def test_the_rate_is_read_on_the_swing_that_a_waveform_makes():
    """A tone off the mode by 0.3 Hz of 0.42: its swing lags by 35 degrees, and carries the rate all the same.

    Under a forced drive, whose carrier is the force at resonance, the reading falls by the cosine of the lag.
    """
    device = {"id": "gyro-c", "gyroscope": {"stiffness_xy_n_m": 0.0}}
    mass, damping, stiffness = 1.42, 7.4945e-3, 863.7569
    hz = 1e3 * np.sqrt(stiffness / mass) / (2 * np.pi) + 0.3
    w = 2e-3 * np.pi * hz
    lag = np.angle(1j * w * damping / (stiffness - mass * w * w + 1j * w * damping))
    assert abs(np.degrees(lag)) == pytest.approx(35.5, abs=0.5)
    wave = {"kind": "sine", "frequency_hz": hz, "amplitude_v": 1.0}
    drives = {"waveform_drive": {"gain_un_v": 0.9}, "forced_drive": {"force_un": 0.9, "frequency_hz": hz}}
    read = {}
    for drive, values in drives.items():
        board = bench(
            wave,
            {
                "device": device,
                "rate.deg_per_s": 100.0,
                "slots.drive": drive,
                f"controllers.{drive}": values,
                "controllers.open_loop_rate.correct_phase": True,
            },
        )
        pass_over(board, 400_000)
        read[drive] = board.value("open_loop_rate.rate")
    assert read["waveform_drive"] == pytest.approx(100.0, rel=0.01)
    # a held force comes half a sample later
    assert read["forced_drive"] == pytest.approx(100.0 * np.cos(abs(lag) + 0.5 * w * board.dt_ms), rel=0.02)


def test_a_waveform_is_silent_unless_asked_for_and_wants_volts():
    assert not np.any(play(make(WAVE, base=GYRO), 100)["plant.x"])
    with pytest.raises(InputError) as caught:
        bench({"kind": "sine", "amplitude_um": 1.0})
    assert (caught.value.field, caught.value.message) == (
        "waveform.amplitude_um",
        "no constant voltage alone displaces this device; give amplitude_v",
    )
    with pytest.raises(InputError, match="needs exactly one"):
        bench({"kind": "sine"})
    with pytest.raises(InputError, match="has no waveform"):
        make({"waveform": {"kind": "sine", "amplitude_v": 1.0}})
