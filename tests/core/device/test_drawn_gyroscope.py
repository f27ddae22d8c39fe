"""Gyroscopes from a drawing: masses, stiffness and damping once more from beam shapes, 1.3.4 and 1.3.7 in SI units."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.device.catalogue import device
from core.device.device import Device
from core.device.geometry import Geometry
from core.device.two_axis import TwoAxis
from core.errors import InputError
from scenarios.run import run
from scenarios.schema import Scenario

UM, EPSILON_0, KT, PER_DEG = 1e-6, 8.8541878128e-12, 1.380649e-23 * 300.0, math.pi / 180.0
MU = 1.716e-5 * (300 / 273.15) ** 1.5 * 383.55 / 410.4
SLIP_PA_M = MU * math.sqrt(math.pi * 287.05 * 300 / 2)
"""Mean free path times pressure."""
LCR = {"id": "lcr-350", "drawn_gyroscope": {}}
E, RHO, T, FILM, GAP, SEGMENT = 164e9, 2330.0, 2.0, 2.0033, 2.1, 30.0
TRUSS = 4.0 - 2 * 0.23835


def made(**drawn: Any) -> dict[str, float]:
    return device({"id": "lcr-350", "drawn_gyroscope": drawn}).metrics()


class Axis:
    """One axis of a gyroscope with the plate and arms of LCR-350; lengths in um, areas in um^2, the rest SI."""

    def __init__(self, length: float, width: float, fingers: int) -> None:
        self.length, self.width, self.fingers = length, width - 2 * 0.23835, fingers
        self.beams, self.trusses = 8 * length * self.width, 2 * 3 * SEGMENT * TRUSS
        self.frame = 2 * 11.132 * 690 + 2 * fingers * 60 * 1.9
        self.combs = 4 * fingers * 40 * T

    def stiffness(self) -> float:
        """Two suspensions by 1.3.4."""
        a, s, length = (TRUSS / self.width) ** 3, SEGMENT, self.length
        top = s**2 + 14 * a * s * length + 36 * a**2 * length**2
        bottom = 4 * s**2 + 41 * a * s * length + 36 * a**2 * length**2
        return 2 * 2 * E * T * UM * (self.width / length) ** 3 * top / bottom


PLATE = 190 * 75 - 3665.7
X, Y = Axis(350, 2.0, 87), Axis(340, 2.0, 87)
S = (np.arange(20_000) + 0.5) / 20_000
BEND = 3 * S**2 - 2 * S**3
MOTION = np.concatenate([1 - BEND / 2, BEND / 2])
"""Motion of outer and inner beams of a flexure, over the motion of its moving end; its trusses move by half."""


def mass(bent: Axis, carried: Axis) -> float:
    """From the kinetic energy."""
    shares = 2 * (np.mean(MOTION**2) * bent.beams + 0.25 * bent.trusses)
    return RHO * T * UM**3 * (PLATE + bent.frame + shares + carried.beams + carried.trusses)


def coriolis(x: Axis, y: Axis) -> float:
    """From the work of the rate: each part by its motion along x times that along y."""
    both = sum(np.mean(MOTION) * each.beams + 0.5 * each.trusses for each in (x, y))
    return RHO * T * UM**3 * (PLATE + both)


def damping(bent: Axis, carried: Axis, pascal: float) -> float:
    """1.3.7 at 1 atm, by slip at the pressure and with a structural quality factor of 20 000."""
    m, k = mass(bent, carried), bent.stiffness()
    omega = math.sqrt(k / m)
    plan = PLATE + bent.frame + bent.beams + bent.trusses + carried.beams + carried.trusses

    def gas(pressure: float, slip: float) -> float:
        path = slip * SLIP_PA_M / pressure / UM
        depth = math.sqrt(2 * MU / (pressure / (287.05 * 300) * omega)) / UM
        areas = plan / (FILM + 2 * path) + plan / (depth + 2 * path) + bent.combs / (GAP + 2 * path)
        return MU * UM * areas

    printed = gas(101325, 0.0)
    structural = m * omega / printed / 2e4
    return printed * ((1 - structural) * gas(pascal, 1.0) / gas(101325, 1.0) + structural)


@pytest.mark.parametrize("y", [Y, Axis(280, 2.4, 60), Axis(500, 1.6, 20)], ids=["catalogue", "stiff", "soft"])
@pytest.mark.parametrize("pascal", [100.0, 1.0, 5000.0])
def test_masses_stiffness_and_damping_follow_from_the_parts(y: Axis, pascal: float) -> None:
    beams = {"sense_beam_length_um": y.length, "sense_beam_width_um": y.width + 2 * 0.23835}
    drawn = {**LCR, "drawn_gyroscope": {**beams, "sense_fingers": y.fingers, "package_pa": pascal}}
    found = device(drawn).oscillator()
    assert isinstance(found, TwoAxis)
    assert [found.mass, found.mass_y] == pytest.approx([1e6 * mass(X, y), 1e6 * mass(y, X)], rel=1e-6)
    assert found.coriolis_mass == pytest.approx(1e6 * coriolis(X, y), rel=1e-6)
    assert [found.stiffness, found.stiffness_y] == pytest.approx([X.stiffness(), y.stiffness()], rel=1e-9)
    wanted = [1e3 * damping(X, y, pascal), 1e3 * damping(y, X, pascal)]
    assert [found.damping, found.damping_y] == pytest.approx(wanted, rel=1e-6)
    assert found.stiffness_xy == found.damping_xy == 0.0


def test_without_gas_the_suspension_is_left_and_in_open_air_the_film_of_1_3_7() -> None:
    vacuum, air = made(package_pa=0.01), made(package_pa=101325)
    assert vacuum["gyro.quality_factor.1"] == pytest.approx(2e4, rel=0.02)
    assert air["damping_ns_m"] == pytest.approx(damping(X, Y, 101325), rel=1e-6)
    assert air["gyro.quality_factor.1"] < 10


def test_figures_of_the_catalogue_are_those_of_theory_and_those_it_states() -> None:
    entry = device({"id": "gyro-lcr-350"})
    found = entry.metrics()
    mx, my, mc, kx, ky = mass(X, Y), mass(Y, X), coriolis(X, Y), X.stiffness(), Y.stiffness()
    c, s = math.cos(0.05 * PER_DEG), math.sin(0.05 * PER_DEG)
    kxy, omega, amplitude = (kx - ky) * s * c, math.sqrt(kx / mx), 5e-6
    dy = damping(Y, X, 100.0)
    assert found["gyro.split_hz"] == pytest.approx((math.sqrt(ky / my) - omega) / (2 * math.pi), rel=1e-4)
    assert found["gyro.quadrature_dps"] == pytest.approx(kxy / (2 * mc * omega) / PER_DEG, rel=1e-4)
    scale = 2 * mc * omega * amplitude / abs(complex(ky - my * omega**2, omega * dy)) * PER_DEG
    assert found["gyro.scale_pm_per_dps"] == pytest.approx(1e12 * scale, rel=1e-4)
    floor = 3600 * math.sqrt(8 * KT * dy) / (2 * mc * omega * amplitude) / PER_DEG
    assert found["gyro.floor_deg_per_h_rthz"] == pytest.approx(floor, rel=1e-5)
    gradient = 4 * 87 * EPSILON_0 * T / GAP
    assert found["gyro.force_x_nn_per_v2"] == pytest.approx(1e9 * gradient, rel=1e-9)
    assert found["gyro.sense_ff_per_um"] == pytest.approx(1e15 * gradient * UM, rel=1e-9)
    assert found["gyro.sense_af_per_dps"] == pytest.approx(1e18 * gradient * scale, rel=1e-4)
    stated = re.search(r"([\d.]+) pm and ([\d.]+) aF per deg/s, thermal floor ([\d.]+) deg/h/rtHz", entry.source)
    assert stated is not None
    names = ("gyro.scale_pm_per_dps", "gyro.sense_af_per_dps", "gyro.floor_deg_per_h_rthz")
    assert [float(text) for text in stated.groups()] == pytest.approx([found[name] for name in names], rel=2e-3)


BEAMS = st.tuples(st.floats(150.0, 600.0), st.floats(1.2, 4.0), st.integers(4, 87))


@given(BEAMS, BEAMS, st.floats(1.0, 1000.0))
@settings(max_examples=60, deadline=None)
def test_x_and_y_may_be_exchanged(first: Any, second: Any, pascal: float) -> None:
    def built(x: Any, y: Any) -> TwoAxis:
        drawing = dict(zip(("beam_length_um", "beam_width_um", "fingers"), x, strict=True))
        sense = dict(zip(("sense_beam_length_um", "sense_beam_width_um", "sense_fingers"), y, strict=True))
        both = device({"id": "lcr-350", "geometry": drawing, "drawn_gyroscope": {**sense, "package_pa": pascal}})
        found = both.oscillator()
        assert isinstance(found, TwoAxis)
        return found

    one, other = built(first, second), built(second, first)
    assert [one.mass, one.stiffness, one.damping] == [other.mass_y, other.stiffness_y, other.damping_y]
    assert one.coriolis_mass == other.coriolis_mass < min(one.mass, one.mass_y)


@given(st.floats(0.5, 20.0), st.floats(20.0, 400.0))
@settings(max_examples=40, deadline=None)
def test_modes_do_not_depend_on_the_thickness_and_go_with_the_root_of_the_modulus(thick: float, modulus: float) -> None:
    usual = made(package_pa=1.0)
    layer = {"thickness_um": thick, "youngs_modulus_gpa": modulus}
    found = device({**LCR, "geometry": layer, "drawn_gyroscope": {"package_pa": 1.0}}).metrics()
    for n in (1, 2):
        ratio = found[f"gyro.mode_hz.{n}"] / usual[f"gyro.mode_hz.{n}"]
        assert ratio == pytest.approx(math.sqrt(modulus / 164.0), rel=1e-6)


LENGTHS = [name for name in Geometry.model_fields if name.endswith("_um") and "bias" not in name]
ANY = st.floats(-3.0, 5.0).map(lambda power: 10.0**power)


@given(st.dictionaries(st.sampled_from(LENGTHS), ANY), ANY, ANY, st.integers(1, 100_000), st.floats(-2.0, 6.0))
@settings(max_examples=150, deadline=None)
def test_a_drawing_is_refused_or_gives_finite_figures(
    lengths: dict[str, float], length: float, width: float, fingers: int, power: float
) -> None:
    drawn = {"sense_beam_length_um": length, "sense_beam_width_um": width, "sense_fingers": fingers}
    drawing = {"beam_bias_um": 0.0, "comb_bias_um": 0.0, "openings_um2": 0.0, "arm_length_um": 1e5, **lengths}
    least = min(drawing.get("overlap_um", 40.0), drawing.get("finger_length_um", 60.0)) / 4
    swing = {"package_pa": 10.0**power, "drive_amplitude_um": max(least, 1e-3)}
    try:
        found = device({"id": "lcr-350", "geometry": drawing, "drawn_gyroscope": {**drawn, **swing}}).metrics()
    except InputError as error:
        assert error.field.startswith("device") and "\n" not in error.message
        return
    assert all(math.isfinite(value) for value in found.values())
    assert min(found[f"gyro.mass_{axis}_kg"] for axis in "xy") > found["gyro.coriolis_mass_kg"] > 0.0


def test_the_package_keeps_its_air() -> None:
    def figures(**environment: float) -> dict[str, float]:
        return run(Scenario.load({"device": LCR, "samples": 2, "environment": environment})).metrics

    usual, thin, hot = figures(), figures(pressure_pa=1.0), figures(temperature_k=400.0)
    assert thin["gyro.quality_factor.1"] == usual["gyro.quality_factor.1"]
    assert hot["environment.damping_scale"] == 1.0
    assert hot["gyro.stiffness_x_n_m"] == pytest.approx((1 - 63e-4) * usual["gyro.stiffness_x_n_m"], rel=1e-9)


def test_a_bench_reads_the_rate_with_the_scale_of_the_drawing() -> None:
    bench = {
        "device": {"id": "gyro-lcr-350"},
        "sample_rate_khz": 100,
        "duration_ms": 600,
        "plant": {"thermal_noise": False},
        "rate": {"kind": "step", "deg_per_s": 100.0, "start_ms": 300.0},
        "slots": {"drive": "drive_loop"},
    }
    found = run(Scenario.load({**bench, "controller": {"kind": "open_loop_rate"}})).metrics
    assert found["rate.scale_pm_per_dps"] == pytest.approx(found["gyro.scale_pm_per_dps"], rel=2e-3)
    assert found["rate.zero_dps"] == pytest.approx(found["gyro.zero_rate_dps"], rel=5e-3)


@pytest.mark.parametrize(
    ("values", "field", "words"),
    [
        ({"drawn_gyroscope": {"sense_beam_width_um": 0.4}}, "device", "along y.*nothing is left of the beams"),
        ({"geometry": {"openings_um2": 20_000.0}}, "device", "nothing is left of the proof mass"),
        ({"drawn_gyroscope": {"sense_fingers": 88}}, "device", "88 fingers along y take 698 um of an arm of 690 um"),
        ({"geometry": {"fingers": 100}}, "device", "100 fingers along x"),
        ({"drawn_gyroscope": {"drive_amplitude_um": 20.0}}, "device", "drive_amplitude_um must be below 20"),
        ({"geometry": {"overlap_um": 3.0}}, "device", "drive_amplitude_um must be below 3"),
        ({"drawn_gyroscope": {"package_pa": 0.0}}, "device.drawn_gyroscope.package_pa", "must be >= 0.01"),
        ({"drawn_gyroscope": {"fingers": 3}}, "device.drawn_gyroscope.fingers", "sense_fingers"),
        ({"geometry": {"film_gap_um": 0.01}, "drawn_gyroscope": {"package_pa": 1e6}}, "device", "both modes"),
        ({"mass_kg": 1e-9}, "device", "leave out mass_kg"),
        ({"gyroscope": {"mass_x_kg": 1e-9}}, "device.gyroscope.stiffness_x_n_m", "required"),
    ],
)
def test_parts_that_do_not_fit_are_refused(values: dict[str, Any], field: str, words: str) -> None:
    with pytest.raises(InputError, match=words) as error:
        device({"id": "gyro-lcr-350", **values})
    assert error.value.field == field


def test_a_gyroscope_is_given_in_one_way() -> None:
    given_too = device({"id": "gyro-c"}).gyroscope
    with pytest.raises(ValueError, match="belong in its drawing; leave out gyroscope"):
        Device.model_validate({**device(LCR).model_dump(), "gyroscope": given_too})
    with pytest.raises(InputError, match="needs a geometry"):
        device({"id": "double-integrator", "transfer_function": None, "drawn_gyroscope": {}})
