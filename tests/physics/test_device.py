"""Devices against the equations of the dissertation as corrected, written out here once more."""

from __future__ import annotations

import math

import pytest

from core.device.catalogue import device, devices
from core.device.device import Device
from core.device.geometry import Geometry
from core.errors import InputError

LENGTH, SEGMENT, WIDE, THICK, YOUNG = 350e-6, 30e-6, 2e-6 - 2 * 0.23835e-6, 2e-6, 164e9


def suspension(truss_width: float) -> float:
    alpha = (truss_width / WIDE) ** 3
    top = SEGMENT**2 + 14 * alpha * SEGMENT * LENGTH + 36 * alpha**2 * LENGTH**2
    bottom = 4 * SEGMENT**2 + 41 * alpha * SEGMENT * LENGTH + 36 * alpha**2 * LENGTH**2
    return 2 * YOUNG * THICK * WIDE**3 / LENGTH**3 * top / bottom


def test_reference_layout_gives_the_device_of_chapter_3():
    found = device({"id": "lcr-350"}).metrics()
    assert found["mass_kg"] == pytest.approx(2.2090e-10, rel=1e-3)
    assert found["stiffness_n_m"] == pytest.approx(0.05380, rel=1e-3)
    assert found["damping_ns_m"] == pytest.approx(7.090e-7, rel=1e-3)
    assert found["f0_hz"] == pytest.approx(2483.78, rel=1e-3)
    assert found["quality_factor"] == pytest.approx(4.8623, rel=2e-3)
    assert found["force_n_per_v"] == pytest.approx(2.93453e-9 * 10, rel=1e-3)
    assert found["static_gain_um_per_v"] == pytest.approx(-0.5455, rel=2e-3)


def test_stiffness_is_the_equation_and_the_trusses_take_part():
    k = Geometry(beam_bias_um=0.23835).stiffness_n_m()
    assert k == pytest.approx(suspension(4e-6 - 2 * 0.23835e-6), rel=1e-9)
    rigid = 24 * YOUNG * (THICK * WIDE**3 / 12) / LENGTH**3
    assert rigid == pytest.approx(0.05408, rel=1e-3)
    assert k / rigid == pytest.approx(0.05380 / 0.05408, rel=1e-3)
    assert Geometry(beam_bias_um=0.23835, truss_width_um=400.0).stiffness_n_m() == pytest.approx(rigid, rel=1e-6)
    # alpha = 1: trusses as soft as the beams
    soft = Geometry(beam_bias_um=0.0, beam_width_um=1.6069, truss_width_um=1.6069, truss_segment_um=90.0)
    assert soft.stiffness_n_m() == pytest.approx(0.0538, rel=2e-3)
    alike = 24 * YOUNG * (THICK * 1.6069e-6**3 / 12) / LENGTH**3
    assert alike == pytest.approx(0.0635, rel=2e-3)


def test_mass_by_rayleigh():
    geometry = Geometry(beam_bias_um=0.23835)
    rho_t = 2330 * 2e-6
    beams = 8 * 350e-6 * WIDE
    trusses = 2 * 90e-6 * (4e-6 - 2 * 0.23835e-6)
    fingers = 2 * 87 * 60e-6 * 1.9e-6
    shuttle = 190e-6 * 75e-6 - 3665.7e-12 + 2 * 11.132e-6 * 690e-6 + fingers
    expected = rho_t * (shuttle + trusses / 4 + 12 * beams / 35)
    assert geometry.mass_kg() == pytest.approx(expected, rel=1e-9)
    # longer beams weigh 12/35 of themselves
    longer = Geometry(beam_bias_um=0.23835, beam_length_um=450.0).mass_kg() - geometry.mass_kg()
    assert longer == pytest.approx(rho_t * 12 / 35 * 8 * 100e-6 * WIDE, rel=1e-9)


def test_damping_is_couette_and_stokes():
    geometry = Geometry(beam_bias_um=0.23835)
    mu = 1.716e-5 * (300 / 273.15) ** 1.5 * 383.55 / (300 + 110.4)
    assert mu == pytest.approx(1.8459e-5, rel=1e-4)
    omega = math.sqrt(geometry.stiffness_n_m() / geometry.mass_kg())
    delta = math.sqrt(2 * mu / (101325 / (287.05 * 300) * omega))
    assert delta == pytest.approx(44.84e-6, rel=1e-3)
    shuttle, beams, trusses, combs = 45782e-12, 4265e-12, 634e-12, 27840e-12
    expected = mu * ((shuttle + trusses / 2 + beams / 2) * (1 / 2.0033e-6 + 1 / delta) + combs / 2.1e-6)
    assert geometry.damping_ns_m(300.0) == pytest.approx(expected, rel=1e-3)
    assert geometry.damping_ns_m(400.0) / geometry.damping_ns_m(300.0) == pytest.approx(1.24, abs=0.02)


def test_chapter_3_and_4_devices():
    third, fourth = device({"id": "ch3"}).metrics(), device({"id": "ch4"}).metrics()
    assert third["f0_hz"] == pytest.approx(2483.78, rel=1e-5)
    assert third["quality_factor"] == pytest.approx(4.8623, rel=1e-4)
    assert fourth["f0_hz"] == pytest.approx(2082.27, rel=1e-5)
    assert fourth["quality_factor"] == pytest.approx(4.2595, rel=1e-4)
    assert third["force_n_per_v"] == pytest.approx(4 * 24 * 8.8541878128e-12 * 2 / 2.1 * 20, rel=1e-12)
    assert third["static_gain_um_per_v"] == pytest.approx(-0.30093, rel=1e-4)
    assert fourth["static_gain_um_per_v"] == pytest.approx(-0.42818, rel=1e-4)


def test_force_given_at_the_bias_scales_with_the_stators():
    given = device({"id": "ch3", "force_n_per_v": 6.375e-9, "bias_v": 6.0})
    assert given.signed_force_n_per_v == pytest.approx(-6.375e-9, rel=1e-12)
    lopsided = device({"id": "ch3", "force_n_per_v": 6.375e-9, "bias_v": 6.0, "opposite_bias_v": 0.0})
    assert lopsided.signed_force_n_per_v == pytest.approx(-6.375e-9 / 2, rel=1e-12)
    flipped = device({"id": "ch3", "bias_v": -20.0})
    assert flipped.signed_force_n_per_v == pytest.approx(-device({"id": "ch3"}).signed_force_n_per_v, rel=1e-12)


def test_a_value_given_beside_a_geometry_wins():
    found = device({"id": "lcr-350", "mass_kg": 1e-10})
    assert found.metrics()["mass_kg"] == 1e-10
    assert found.metrics()["stiffness_n_m"] == device({"id": "lcr-350"}).metrics()["stiffness_n_m"]
    thick = device({"id": "lcr-350", "geometry": {"thickness_um": 4.0}})
    assert thick.metrics()["stiffness_n_m"] == pytest.approx(2 * device({"id": "lcr-350"}).metrics()["stiffness_n_m"])


@pytest.mark.parametrize(
    ("overrides", "field"),
    [
        ({"id": "ch9"}, "device.id"),
        ({"mass_kg": -1.0}, "device.mass_kg"),
        ({"mass_kg": math.nan}, "device.mass_kg"),
        ({"mass_g": 1.0}, "device.mass_g"),
        ({"id": "lcr-350", "geometry": {"beam_length_um": 0}}, "device.geometry.beam_length_um"),
        ({"id": "lcr-350", "geometry": {"beam_length_nm": 1}}, "device.geometry.beam_length_nm"),
        ({"force_n_per_v": 1e-9, "bias_v": 0.0}, "device"),
    ],
)
def test_bad_devices_are_refused_by_field(overrides, field):
    with pytest.raises(InputError) as error:
        device(overrides)
    assert error.value.field == field


def test_every_catalogue_device_is_complete_and_says_where_it_comes_from():
    for entry in devices():
        assert entry.title and entry.source
        assert all(math.isfinite(value) for value in entry.metrics().values())
        oscillator = entry.oscillator()
        if entry.usual_plant == "linear":  # a comb pulls to -x
            assert oscillator.static_gain < 0
        else:
            assert oscillator.force != 0 and math.isfinite(oscillator.static_gain)
    with pytest.raises(ValueError, match="needs"):
        Device(mass_kg=1e-10)
