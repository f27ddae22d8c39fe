"""Gyroscopes against closed forms: imperfections, rate read in open and closed loop, two devices in step."""

from __future__ import annotations

import cmath
import math
from typing import Any

import pytest

from scenarios.run import run
from scenarios.schema import Scenario

DEG = math.pi / 180.0


class Device:
    """A gyroscope in SI units, from its principal values, and what theory says of it."""

    def __init__(self, **values: float) -> None:
        self.values = values
        self.mx = values["mass_x_kg"]
        self.my = values.get("mass_y_kg", self.mx)
        k = [values["stiffness_x_n_m"], values.get("stiffness_xy_n_m", 0.0), values["stiffness_y_n_m"]]
        d = [values["damping_x_ns_m"], values.get("damping_xy_ns_m", 0.0), values["damping_y_ns_m"]]
        self.kx, self.kxy, self.ky = self._turned(k, values.get("alpha_deg", 0.0) * DEG)
        self.dx, self.dxy, self.dy = self._turned(d, values.get("gamma_deg", 0.0) * DEG)
        self.amplitude = values["drive_amplitude_um"]

    @staticmethod
    def _turned(entries: list[float], angle: float) -> tuple[float, float, float]:
        x, xy, y = entries
        c, s = math.cos(angle), math.sin(angle)
        return x * c * c + y * s * s - 2 * xy * s * c, (x - y) * s * c + xy * (c * c - s * s), x * s * s + y * c * c

    @property
    def w(self) -> float:
        """The lower root of det(K - w^2 M), to which x is driven."""
        x, y = self.kx / self.mx, self.ky / self.my
        return math.sqrt(0.5 * (x + y) - math.sqrt(0.25 * (x - y) ** 2 + self.kxy**2 / (self.mx * self.my)))

    def sense(self, w: float) -> complex:
        return complex(self.ky - self.my * w * w, w * self.dy)

    def coupled(self, w: float) -> complex:
        return -complex(self.kxy, w * self.dxy) / self.sense(w)


SOFT = {"mass_x_kg": 1.8e-7, "stiffness_x_n_m": 63.955, "stiffness_y_n_m": 95.92, "damping_x_ns_m": 1.8e-6}
MODEL = Device(**SOFT, damping_y_ns_m=2.4e-6, alpha_deg=2.0, gamma_deg=2.0, drive_amplitude_um=1.0)
PLANT = Device(**SOFT, damping_y_ns_m=2.4e-6, alpha_deg=4.0, gamma_deg=5.0, drive_amplitude_um=1.0)
LIGHT = Device(
    mass_x_kg=4e-8,
    stiffness_x_n_m=20.0,
    stiffness_y_n_m=26.0,
    damping_x_ns_m=9e-7,
    damping_y_ns_m=1.5e-6,
    alpha_deg=-3.0,
    gamma_deg=8.0,
    drive_amplitude_um=2.5,
)
DUAL = Device(
    mass_x_kg=1.42e-6,
    mass_y_kg=1.58e-6,
    stiffness_x_n_m=863.7569,
    stiffness_y_n_m=987.2898,
    stiffness_xy_n_m=0.272048,
    damping_x_ns_m=7.4945e-6,
    damping_y_ns_m=8.7964e-5,
    drive_amplitude_um=5.0,
)


def measured(device: Device, ms: float, khz: float = 100.0, noise: bool = False, **bench: Any) -> dict[str, float]:
    """Run a bench of a device and return the metrics."""
    document = {
        "schema": 1,
        "sample_rate_khz": khz,
        "duration_ms": ms,
        "device": {"id": "gyro-a", "gyroscope": {"stiffness_xy_n_m": 0.0, "damping_xy_ns_m": 0.0, **device.values}},
        "plant": {"model": "gyroscope", "thermal_noise": noise},
        **bench,
    }
    return run(Scenario.load(document)).metrics


def turning(deg_per_s: float) -> dict[str, Any]:
    return {"kind": "constant", "deg_per_s": deg_per_s}


def step(deg_per_s: float, at_ms: float) -> dict[str, Any]:
    return {"kind": "step", "deg_per_s": deg_per_s, "start_ms": at_ms}


@pytest.mark.parametrize(("device", "khz"), [(MODEL, 50.0), (PLANT, 200.0), (LIGHT, 50.0)], ids=["2-2", "4-5", "light"])
def test_open_loop_figures(device, khz):
    found = measured(
        device, 1600, khz, rate=step(100, 800), slots={"drive": "drive_tracking"}, controller={"kind": "open_loop_rate"}
    )
    w, g = device.w, device.coupled(device.w)
    tilt = 0.5 * math.atan2(2 * g.real, 1 - abs(g) ** 2) / DEG
    zero = (device.dxy - device.kxy * device.dy / (device.ky - device.my * w * w)) / (2 * device.my) / DEG
    scale = 1e6 * device.amplitude * 2 * device.my * w / abs(device.sense(w)) * DEG
    assert found["gyro.tilt_deg"] == pytest.approx(tilt, rel=1e-3)
    assert tilt == pytest.approx(device.values["alpha_deg"], rel=1e-3)
    assert found["rate.zero_dps"] == pytest.approx(zero, rel=5e-3)
    assert found["rate.scale_pm_per_dps"] == pytest.approx(scale, rel=2e-3)
    assert found["rate.bandwidth_hz"] == pytest.approx(20 * math.sqrt(math.sqrt(2) - 1), abs=0.4)


def test_the_figures_of_the_text_devices():
    """2 and 4 degrees, 10.0 and 18.37 deg/s, 3.705 pm per deg/s without angles."""
    zeros = [(d.dxy - d.kxy * d.dy / (d.ky - d.my * d.w**2)) / (2 * d.my) / DEG for d in (MODEL, PLANT)]
    assert zeros == pytest.approx([10.0, 18.37], abs=0.01)
    straight = Device(**SOFT, damping_y_ns_m=2.4e-6, drive_amplitude_um=1.0)
    found = measured(
        straight, 900, rate=turning(100), slots={"drive": "drive_tracking"}, controller={"kind": "open_loop_rate"}
    )
    assert found["rate.scale_pm_per_dps"] == pytest.approx(3.705, rel=5e-3)


@pytest.mark.parametrize(("khz", "before"), [(50.0, 0.0), (100.0, -50.0)])
def test_open_loop_scale_of_a_dual_mass_device(khz, before):
    """258.6 pm per deg/s, with the mass of y in the Coriolis force."""
    points = [{"at_ms": 1500.0, "deg_per_s": before}, {"at_ms": 1500.001, "deg_per_s": 100.0}]
    found = measured(DUAL, 3000, khz, rate={"kind": "profile", "points": points}, controller={"kind": "open_loop_rate"})
    w = DUAL.w
    scale = 1e6 * 5.0 * 2 * 1.58e-6 * w / abs(DUAL.sense(w)) * DEG
    assert scale == pytest.approx(258.6, abs=0.1)
    assert found["rate.scale_pm_per_dps"] == pytest.approx(scale, rel=1.5e-3)


@pytest.mark.parametrize(
    ("khz", "quadrature", "lead_deg"),
    [(50.0, 200.0, 0.0), (50.0, -80.0, 3.0), (100.0, 200.0, 3.0), (200.0, -80.0, 0.0)],
)
def test_half_a_sample_reads_as_a_rate(khz, quadrature, lead_deg):
    """A held force lags half a sample and is weaker by sin(a)/a; the loop asks for that much more."""
    w = math.sqrt(DUAL.kx / DUAL.mx)
    device = Device(**{**DUAL.values, "stiffness_xy_n_m": 2 * DUAL.my * w * quadrature * DEG})
    controller = {"kind": "force_to_rebalance", "advance": False, "phase_error_deg": lead_deg}
    found = measured(device, 1500, khz, controller=controller)
    half = w * 0.5e-3 / khz
    expected = quadrature * math.sin(half - lead_deg * DEG) * half / math.sin(half)
    assert found["rate.zero_dps"] == pytest.approx(expected, abs=0.05)
    advanced = measured(device, 1500, khz, rate=turning(100), controller={"kind": "force_to_rebalance"})
    # the images of the staircase, beyond half the sample rate, add 3 parts in 10 000 at 50 kHz
    assert advanced["rate.read_dps"] == pytest.approx(100 * half / math.sin(half), rel=4e-4)
    assert advanced["gyro.tilt_deg"] == pytest.approx(0.0, abs=1e-5)


@pytest.mark.parametrize(
    ("drive", "controller"),
    [
        ("drive_loop", {"kind": "force_to_rebalance"}),
        ("drive_tracking", {"kind": "force_to_rebalance"}),
        ("drive_tracking", {"kind": "sense_axis_sync", "follow": "rest"}),
    ],
)
def test_a_force_is_a_rate_by_the_frequency_of_the_carrier(drive, controller):
    """Cross stiffness as strong as in set A: the mode is 3.7 % below the frequency of x with y at zero.

    The drive loop finds the latter, drive tracking holds the former; both read 2m times the force per speed.
    """
    skew = Device(
        mass_x_kg=1.8e-7,
        stiffness_x_n_m=63.955,
        stiffness_y_n_m=95.92,
        stiffness_xy_n_m=12.779,
        damping_x_ns_m=2.4e-5,
        damping_y_ns_m=2.4e-5,
        drive_amplitude_um=1.0,
    )
    found = measured(skew, 900, 200.0, rate=step(3000, 450), slots={"drive": drive}, controller=controller)
    w = skew.w if drive == "drive_tracking" else math.sqrt(skew.kx / skew.mx)
    more = (half := w * 0.5e-3 / 200.0) / math.sin(half)
    assert found["rate.read_dps"] - found["rate.zero_dps"] == pytest.approx(3000 * more, rel=2e-3)
    assert found["rate.quadrature_dps"] == pytest.approx(skew.kxy / (2 * skew.my * w) / DEG * more, rel=2e-3)


def test_force_to_rebalance_settles_or_rings_on_the_split():
    """An integral of y, m g/|k_yy - m w^2| per ms, behind a low-pass of 50 Hz; 5 % is left after ln 20 of it."""

    def loop(gain: float) -> dict[str, float]:
        return measured(
            DUAL, 2400, rate=step(100, 700), controller={"kind": "force_to_rebalance", "integral_gain_per_ms3": gain}
        )

    w = math.sqrt(DUAL.kx / DUAL.mx)
    for gain in (0.1, 0.2):
        pole = gain * DUAL.my / abs(DUAL.sense(w)) * 1e6
        settled = math.log(20) / pole + 1e3 / (2 * math.pi * 50)
        assert loop(gain)["rate.settling_ms"] == pytest.approx(settled, rel=0.02)
    document = {
        "device": {"id": "gyro-c"},
        "plant": {"model": "gyroscope", "thermal_noise": False},
        "controller": {"kind": "force_to_rebalance", "integral_gain_per_ms3": 0.8},
        "duration_ms": 1500,
    }
    result = run(Scenario.load(document))
    assert result.trip is not None and result.trip.signal == "plant.y"


PAIR = {"model": "gyroscope_pair", "thermal_noise": False, "partner": {"id": "gyro-2-2"}}


@pytest.mark.parametrize("drive", ["drive_tracking", "drive_loop"])
def test_sense_axes_in_step(drive):
    """The force is |(k_yy - m w^2 + j w d_yy) y_m + (k_xy + j w d_xy) A|, 33 times that along x."""
    free = measured(PLANT, 1200, plant=PAIR, slots={"drive": drive})
    held = measured(PLANT, 1200, plant=PAIR, slots={"drive": drive}, controller={"kind": "sense_axis_sync"})
    w = PLANT.w
    follows = MODEL.coupled(w)
    force = PLANT.sense(w) * follows + complex(PLANT.kxy, w * PLANT.dxy)
    apart = abs(PLANT.coupled(w) - follows) * 1e3 / math.sqrt(2)
    assert free["sync.error_rms_nm"] == pytest.approx(apart, rel=2e-3)
    assert held["sync.error_rms_nm"] < 0.1
    assert held["sync.force_un"] == pytest.approx(abs(force), rel=5e-3)
    assert held["sync.force_un"] > 30 * free["sync.drive_force_un"]
    assert held["gyro.tilt_deg"] == pytest.approx(2.0, rel=5e-3)
    assert held["rate.zero_dps"] == pytest.approx(10.0, rel=0.01)
    difference = cmath.phase(PLANT.coupled(w) / follows) / DEG
    assert free["rate.phase_difference_deg"] == pytest.approx(difference, abs=2e-4)


@pytest.mark.parametrize("khz", [100.0])
def test_a_drive_loop_makes_the_partner_swing_with_the_first(khz):
    """One carrier, at the resonance of the first: the first needs d w A, the partner what keeps it off its own."""
    document = {
        "device": {"id": "gyro-4-5"},
        "plant": PAIR,
        "slots": {"drive": "drive_loop"},
        "sample_rate_khz": khz,
        "duration_ms": 800,
    }
    result = run(Scenario.load(document))
    tail = slice(-int(50 * khz), None)
    swing, partner = (result.signal(f"plant.{axis}")[tail] for axis in ("x", "partner_x"))
    assert abs(partner - swing).max() < 1e-4
    first, second = (math.sqrt(2) * result.signal(f"drive.{axis}.force")[tail].std() for axis in ("x", "partner_x"))
    # y swings freely, and pulls at x
    w, g, h = PLANT.w, PLANT.coupled(PLANT.w), MODEL.coupled(PLANT.w)
    needed = [
        abs(d.kx - d.mx * w * w + 1j * w * d.dx + (d.kxy + 1j * w * d.dxy) * over) * d.amplitude
        for d, over in ((PLANT, g), (MODEL, h))
    ]
    assert [first, second] == pytest.approx(needed, rel=5e-3)


@pytest.mark.parametrize("khz", [200.0])
def test_y_at_rest_leaves_the_cross_damping(khz):
    controller = {"kind": "sense_axis_sync", "follow": "rest"}
    found = measured(PLANT, 1200, khz, slots={"drive": "drive_tracking"}, controller=controller)
    assert found["rate.zero_dps"] == pytest.approx(PLANT.dxy / (2 * PLANT.my) / DEG, rel=0.012)
    assert found["gyro.tilt_deg"] == pytest.approx(0.0, abs=0.01)


@pytest.mark.parametrize("heavier", [1.0, 1.58 / 1.42, 1.5])
def test_the_line_of_oscillation_turns_back(heavier):
    """By m_c/sqrt(m_x m_y) of the angle turned, evenly, whatever the masses."""
    device = Device(**{**DUAL.values, "mass_y_kg": heavier * 1.42e-6, "stiffness_y_n_m": heavier * 880.0})
    found = measured(device, 2500, rate=turning(150), controller={"kind": "whole_angle"}, metrics={"since_ms": 500})
    assert found["rate.angle_error_deg"] == pytest.approx(0.0, abs=0.15)
    assert found["rate.error_pct"] == pytest.approx(0.0, abs=0.15)
