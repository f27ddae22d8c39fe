"""Mechanics across the drive: a drawing against figures of an independent prototype and against closed forms."""

from __future__ import annotations

from dataclasses import asdict

import numpy as np
import pytest
from scipy import integrate, optimize

from core.device.catalogue import device
from core.device.geometry import Geometry
from core.device.lateral import comb_square_um2, lateral, shuttle_moment_um4
from scenarios.measure.lateral import device_pull_in, lateral_metrics
from tests.lab import inject, make, play

LCR = device({"id": "lcr-350"}).drawing


@pytest.mark.parametrize(
    ("name", "value", "tolerance"),
    [
        ("gap_um", 2.1, 1e-9),
        ("stator_tip_um", 126.13, 1e-4),
        ("inertia_kg_m2", 9.573e-18, 5e-3),
        ("lateral_stiffness_n_m", 205.4, 0.03),
        ("rotation_stiffness_nm", 4.51e-7, 0.03),
        ("lateral_reach_um", 9.40, 0.02),
        ("rotation_reach_um", 39.7, 0.06),
        ("lateral_damping_ns_m", 4.57e-7, 5e-3),
        ("rotation_damping_nms", 2.90e-14, 5e-3),
        ("squeeze_ns_m", 2.22e-7, 5e-3),
    ],
)
def test_reference_drawing_against_an_independent_prototype(name, value, tolerance):
    """The reaches by a frame program at large displacements, the rest by another program from the same drawing."""
    assert asdict(lateral(LCR))[name] == pytest.approx(value, rel=tolerance)


@pytest.mark.parametrize(("x", "stiffness"), [(0.0, 205.0), (2.0, 196.0), (5.0, 160.0), (10.0, 96.0), (15.0, 58.0)])
def test_stiffness_sideways_falls_with_the_travel(x, stiffness):
    """By a frame program at large displacements."""
    across = lateral(LCR)
    found = across.lateral_stiffness_n_m / (1.0 + (x / across.lateral_reach_um) ** 2)
    assert found == pytest.approx(stiffness, rel=0.04)


def test_moment_of_the_shuttle_is_that_of_its_parts():
    """Plate and arms as double integrals, fingers one by one."""
    solid = LCR.model_copy(update={"openings_um2": 0.0})

    def box(x0, x1, y0, y1):
        return integrate.dblquad(lambda y, x: x * x + y * y, x0, x1, y0, y1)[0]

    whole = box(-95, 95, -37.5, 37.5) + 2 * box(95, 106.132, -345, 345)
    for i in range(87):
        y = -344.0 + 8.0 * i
        whole += 2 * box(106.132, 166.132, y - 0.95, y + 0.95)
    assert shuttle_moment_um4(solid) == pytest.approx(whole, rel=1e-9)
    assert comb_square_um2(LCR) == pytest.approx(np.mean((-344.0 + 8.0 * np.arange(87)) ** 2), rel=1e-12)
    assert LCR.far_finger_um == 344.0


def test_stiffer_thicker_wider():
    """Everything elastic goes with E, the squeeze film with (t/g)^3, the inertia with the density."""
    base = asdict(lateral(LCR))
    for change, factors in (
        ({"youngs_modulus_gpa": 328.0}, {"lateral_stiffness_n_m": 2.0, "rotation_stiffness_nm": 2.0}),
        ({"density_kg_m3": 4660.0}, {"inertia_kg_m2": 2.0}),
        ({"thickness_um": 4.0}, {"squeeze_ns_m": 8.0, "inertia_kg_m2": 2.0, "lateral_stiffness_n_m": 2.0}),
    ):
        other = asdict(lateral(LCR.model_copy(update=change)))
        for name, factor in factors.items():
            assert other[name] / base[name] == pytest.approx(factor, rel=1e-9), name


# -- plants and figures follow the device


def pull_in(**values):
    board = make({"device": {"id": "lcr-350"}, "plant": {"model": "planar", "thermal_noise": False}, **values})
    board.advance(1)
    return lateral_metrics(board)["device.pull_in_v"]


def test_the_plant_in_the_plane_follows_the_drawing():
    """With the trusses as thin as the beams it turns at 11.1 V instead of 28.1 V; drawn wider the gap adds g^1.5."""
    assert pull_in() == pytest.approx(28.08, rel=5e-3)
    # etched a little less, so that the stiffness along x stays
    drawn = LCR.model_copy(update={"truss_width_um": 2.0})
    bias = optimize.brentq(lambda b: drawn.model_copy(update={"beam_bias_um": b}).stiffness_n_m() - 0.0538, 0.1, 0.3)
    thin = {"device.geometry.truss_width_um": 2.0, "device.geometry.beam_bias_um": bias}
    assert pull_in(**thin) == pytest.approx(11.13, rel=0.02)
    # closed form with the gap of the drawing; its tips move with nothing else
    assert pull_in(**{"device.geometry.finger_gap_um": 4.1}) == pytest.approx(28.08 * 2**1.5, rel=5e-3)
    assert pull_in(**{"plant.rotation_stiffness_nm": 4 * 4.51e-7}) == pytest.approx(2 * 28.08, rel=5e-3)


@pytest.mark.parametrize("name", ["ch3", "ch4", "lcr-350", "fabricated-1", "table-1-1-400-std"])
def test_every_device_has_a_pull_in(name):
    """V is proportional to one over the root of the force constant; without a drawing the suspension is LCR-350's."""
    found = device_pull_in(device({"id": name}))
    gradient = device({"id": name}).capacitance_gradient
    if device({"id": name}).geometry is None:
        assert found == pytest.approx(28.08 * (1.4673e-9 / gradient) ** 0.5, rel=5e-3)
    board = make({"device": {"id": name}})
    play(board, 2)
    assert lateral_metrics(board)["device.pull_in_v"] == found


def test_faults_of_the_suspension_follow_the_drawing():
    """An adhesion on trusses as thin as the beams: 0.0753/0.0538 instead of 1.46."""
    ratios = []
    for width in (4.0, 2.0):
        board = make({"device": {"id": "lcr-350", "geometry": {"truss_width_um": width}}})
        board.advance(1)
        inject(board, point_adhesion=1.0)
        board.advance(1)
        ratios.append(board.value("effects.stiffness_scale"))
    assert ratios == pytest.approx([1.4575, 0.0753 / 0.0538], rel=0.01)


def test_default_drawing_is_that_of_the_reference_device():
    assert asdict(lateral(Geometry())) == pytest.approx(asdict(lateral(LCR)), rel=1e-3)
