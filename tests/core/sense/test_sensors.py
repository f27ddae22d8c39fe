"""The wiring of sensors: running sensors, their order, and the information about them."""

from __future__ import annotations

import numpy as np
import pytest

from core.board.wiring import needed
from core.errors import InputError
from tests.core.sense.bench import make
from tests.lab import do, play, rms


def test_only_what_the_sensor_in_use_needs_runs():
    assert needed(make({"sensor.kind": "ideal"}).spec) == {"ideal"}
    assert needed(make({"sensor.kind": "quadrature_kalman"}).spec) == {"quadrature_kalman", "quadrature", "dual_beam"}
    both = make({"sensor.kind": "quadrature", "sensors.single_beam.always": True}).spec
    assert needed(both) == {"quadrature", "dual_beam", "single_beam", "through_wafer"}


def test_what_runs_follows_a_change_of_the_sensor_in_use():
    board = make({"sensor.kind": "ideal"})
    own = ["dual_beam.first", "dual_beam.second", "quadrature.displacement", "quadrature.turn", "quadrature.error"]
    seen = []
    for kind in ("ideal", "quadrature", "ideal"):
        if kind != board.spec.measuring:
            do(board, {"set": {"sensor.kind": kind}})
        trace = play(board, 100)
        assert trace["sensor.displacement"].all()
        seen.append([trace[name].any() for name in own])
    assert seen == [[False] * 5, [True] * 5, [False] * 5]


def test_recovery_sees_the_light_of_the_same_tick():
    keys = [instance.key for instance in make().wiring.instances]
    for recovery in ("peak_valley", "single_beam", "quadrature"):
        for light in ("through_wafer", "doppler", "dual_beam"):
            assert keys.index(light) < keys.index(recovery)


def test_light_cannot_be_fed_to_a_controller():
    with pytest.raises(InputError, match="puts out no displacement"):
        make({"sensor.kind": "through_wafer"})


def test_one_sensor_does_not_disturb_the_noise_of_another():
    alone = play(make({"sensor.kind": "quadrature"}), 500)
    beside = play(make({"sensor.kind": "quadrature", "sensors.single_beam.always": True}), 500)
    np.testing.assert_array_equal(alone["dual_beam.first"], beside["dual_beam.first"])


@pytest.mark.parametrize("quantum_um", [0.0, 0.05, 0.2])
def test_filters_are_told_the_noise_of_noise_and_converter(quantum_um):
    """Rounding to steps a motion crosses adds an even spread over one, q^2/12."""
    board = make({"sensor": {"kind": "ideal", "noise_um": 0.03, "quantum_um": quantum_um}})
    told = board.spec.context().sensor_noise_um
    assert told == pytest.approx(np.sqrt(0.03**2 + quantum_um**2 / 12), rel=1e-12)
    trace = play(board, 20_000)
    assert rms(trace["sensor.displacement"] - trace["plant.displacement"]) == pytest.approx(told, rel=0.03)


@pytest.mark.parametrize("kind", ["capacitive", "peak_valley", "quadrature", "quadrature_kalman", "single_beam"])
def test_a_loop_can_be_closed_on_any_sensor(kind):
    board = make(
        {"sensor.kind": kind, "controller.kind": "pid", "reference.amplitude_v": 1.0, "guard.travel_um": 1000.0}
    )
    trace = play(board, 2000)
    assert all(np.isfinite(values).all() for values in trace.values())
    assert trace["sensor.displacement"].any()
