from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

import scenarios  # noqa: F401  (first: it gives compiled kernels their cache)
from core import registry
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.measure.sensing import good_squares, whole_periods
from scenarios.run import run
from scenarios.schema import Scenario
from tests.library_pass import result


def aligned(error: np.ndarray, ambiguity_um: float) -> tuple[np.ndarray, int]:
    whole = whole_periods(np.array_split(error, 3), ambiguity_um)
    return good_squares(error, np.zeros(len(error)), ambiguity_um, whole), whole


def test_the_fringe_the_count_began_on_is_left_open():
    error = np.full(1000, 8.0)
    error[:30] += 4.0
    squares, whole = aligned(error, 4.0)
    assert whole == 2 and squares.tolist() == [0.0] * 970


def test_what_is_not_a_number_is_bad_and_nothing_is_lost_without_error():
    assert aligned(np.zeros(10), 4.0)[0].tolist() == [0.0] * 10
    assert aligned(np.array([0.0, np.nan, np.inf, 0.1]), 4.0)[0].tolist() == [0.0, 0.1 * 0.1]
    assert aligned(np.full(3, np.nan), 4.0)[0].tolist() == []


def test_a_sensor_without_a_grating_loses_nothing_however_far_off_it_is():
    squares, whole = aligned(np.array([4.0, -9.0, np.nan, -np.inf]), 0.0)
    assert squares.tolist() == [16.0, 81.0] and whole == 0


def test_of_equally_good_alignments_the_smallest_is_taken():
    assert aligned(np.array([0.0, 0.0, 4.0, 4.0]), 4.0)[1] == 0


def test_each_sensor_of_chapter_two_keeps_its_expectations_and_says_why():
    for name in ("ch2-capacitive", "ch2-through-wafer", "ch2-doppler", "ch2-dual-beam"):
        summary = result(name)["gallery"]
        assert summary["ok"] and all(entry["note"] for entry in summary["expectations"]), summary["expectations"]


def sensed(name: str, **values: object) -> dict[str, float]:
    paths = {path.replace("__", "."): value for path, value in values.items()}
    return run(with_values(get(name), paths)).metrics


def test_white_noise_wider_than_the_pitch_of_a_grating_is_told_in_full():
    """The root mean square of n samples of N(0, s^2) is s to 1/sqrt(2n), five times that for the one draw there is."""
    metrics = sensed("ch5-seven-step", sensor__noise_um=1.5)
    assert metrics["sensing.rms_error_nm"] == pytest.approx(1500.0, rel=5 / np.sqrt(2 * 9000))
    assert metrics["sensing.direction_lost_fraction"] == 0.0


@pytest.mark.parametrize(("sensor", "bias_um"), [("ideal", 4.0), ("ideal", 7.3), ("capacitive", -8.0)])
def test_a_bias_of_an_absolute_sensor_is_its_error(sensor, bias_um):
    document = {
        "schema": 1,
        "id": "biased",
        "title": "Biased",
        "duration_ms": 5,
        "device": {"id": "lcr-350"},
        "sensor": {"kind": sensor},
        "events": [{"at_ms": 0.0, "fault": "sensor_bias", "severity": bias_um}],
    }
    metrics = run(Scenario.load(document)).metrics
    assert metrics["sensing.rms_error_nm"] == pytest.approx(1e3 * abs(bias_um), rel=1e-3)
    assert metrics["sensing.direction_lost_fraction"] == 0.0


def test_each_sensor_says_its_own_ambiguity():
    """A sensor with the light of a grating has its pitch, the others none; the default pitch is 4 um everywhere."""
    found = {}
    for name, block in registry.blocks("sense").items():
        if any(port.name == "displacement" for port in block.outputs):
            spec = get("ch2-dual-beam").spec
            found[name] = block.ambiguity_um(block.Params(), spec.context())
    grating = {"single_beam", "quadrature", "quadrature_kalman", "peak_valley"}
    assert found == {name: 4.0 if name in grating else 0.0 for name in found} and grating < set(found)


LIGHT = {"ch2-dual-beam": "dual_beam", "ch2-through-wafer": "through_wafer", "ch2-doppler": "doppler"}


def test_the_period_is_the_pitch_of_the_grating_of_the_sensor():
    """A pitch of 5 um of its own grating is its period, and the pitch of another grating has no effect on it."""
    for name, own in LIGHT.items():
        for light in LIGHT.values():
            spec = with_values(get(name), {f"sensors.{light}.pitch_um": 5.0}).spec
            sensor = spec.sensors[spec.measuring]
            found = sensor.block.ambiguity_um(sensor.params, spec.context())
            assert found == (5.0 if light == own else 4.0), (name, light)


def test_the_counter_tells_the_interpolation_error_of_the_grating_it_reads():
    """Half a pitch times the root of 1/12 + 1/8 - 2/pi^2, the error of a straight line between extremes of a cosine."""
    wide = with_values(get("ch2-doppler"), {"sensors.doppler.pitch_um": 8.0}).spec
    straight = quad(lambda s: (s - 0.5 * (1.0 - np.cos(np.pi * s))) ** 2, 0.0, 1.0)[0]
    assert wide.context().sensor_noise_um == pytest.approx(4.0 * np.sqrt(straight), rel=1e-9)


def test_only_what_the_sensor_in_use_told_counts():
    """A thousand times the density makes 12 um until the other sensor takes over; the figure belongs to the second."""
    document = {
        "schema": 1,
        "id": "exchanged",
        "title": "Exchanged",
        "duration_ms": 30,
        "device": {"id": "lcr-350"},
        "sensor": {"kind": "capacitive", "noise_af_rthz": 100.0},
        "sensors": {"ideal": {"noise_um": 0.01}},
        "events": [{"at_ms": 10.0, "set": {"sensor.kind": "ideal"}}],
    }
    assert run(Scenario.load(document)).metrics["sensing.rms_error_nm"] == pytest.approx(10.0, rel=0.1)
