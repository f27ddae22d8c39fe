"""The suspension: the frame of beams against closed forms and another program's figures, the faults against it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import optimize

from core.device.catalogue import device
from core.device.frame import Damage, along_x, stiffness, stiffness_ratio
from core.device.geometry import Geometry
from core.device.pull_in import rotation_pull_in_v
from core.faults.point_adhesion import PointAdhesion
from core.faults.structure import linear
from scenarios.measure.lateral import geometry_pull_in
from tests.lab import do, inject, make, phasor, play

LCR = device({"id": "lcr-350"}).geometry
assert LCR is not None
RIGID = LCR.model_copy(update={"truss_width_um": 60.0})
"""Trusses so wide that each side is four guided beams: 12EI/L^3 each."""


def adhesion_on_rigid_trusses(beam: str, share: float) -> float:
    """Stiffness ratio with guided beams in units of 12EI/L^3: springs in series and parallel, healthy 2 = 1 + 1.

    A beam held at a share of its length is a beam of the rest of it to the truss, and of that share to its root.
    """
    to_truss = (1.0 - share) ** -3
    if beam == "inner":
        ground = 1.0 + to_truss
        side = 2.0 * ground / (2.0 + ground)
    else:
        side = share**-3 + (2.0 + to_truss) / (3.0 + to_truss)
    return 0.5 * (1.0 + side)


def with_truss(width_um: float) -> Geometry:
    """The reference with other trusses, etched so that the stiffness along x stays 0.0537 N/m."""

    def drawn(bias: float) -> Geometry:
        return LCR.model_copy(update={"truss_width_um": width_um, "beam_bias_um": bias})

    return drawn(optimize.brentq(lambda bias: along_x(stiffness(drawn(bias))) - 0.0537, 0.1, 0.3))


def test_frame_against_the_closed_form_of_the_folded_flexure():
    for width in (2.0, 3.0, 4.0, 10.0):
        geometry = LCR.model_copy(update={"truss_width_um": width})
        assert along_x(stiffness(geometry)) == pytest.approx(geometry.stiffness_n_m(), rel=5e-3)
    assert along_x(stiffness(LCR)) == pytest.approx(0.05369, rel=1e-3)
    k = stiffness(LCR)
    np.testing.assert_allclose(k, k.T, atol=1e-6 * k[2, 2])
    # by symmetry a healthy suspension couples nothing
    assert abs(k[0, 1]) < 1e-9 and abs(k[0, 2]) < 1e-6 and abs(k[1, 2]) < 1e-3


@pytest.mark.parametrize(
    ("truss", "sideways", "turning"),
    [(2.0, 26.7, 7.09e-8), (3.0, 84.7, 2.26e-7), (4.0, 205.4, 4.51e-7), (6.0, 641.0, 8.19e-7), (10.0, 1698.0, 1.07e-6)],
)
def test_frame_against_another_frame_program(truss, sideways, turning):
    """Stiffness along y and against rotation by an independent program, at the same stiffness along x."""
    k = stiffness(with_truss(truss))
    assert k[1, 1] == pytest.approx(sideways, rel=0.03)
    assert k[2, 2] * 1e-12 == pytest.approx(turning, rel=0.03)


@pytest.mark.parametrize("beam", ["inner", "outer"])
@pytest.mark.parametrize("share", [0.25, 0.5, 0.75, 0.9])
def test_adhesion_on_rigid_trusses_is_springs_in_series(beam, share):
    found = stiffness_ratio(RIGID, Damage(adhesion=(beam, share)))
    assert found == pytest.approx(adhesion_on_rigid_trusses(beam, share), rel=0.01)


def test_limits_of_damaged_suspensions():
    # 36EI/24EI: an inner beam held next to its truss holds the truss
    assert stiffness_ratio(RIGID, Damage(adhesion=("inner", 0.99))) == pytest.approx(36 / 24, rel=0.01)
    # one outer beam of four lost: 1 in series with 2 beside 1, over 2
    assert stiffness_ratio(RIGID, Damage(lost_ends=(2,))) == pytest.approx(5 / 6, rel=0.01)
    assert stiffness_ratio(RIGID, Damage(lost_ends=(0, 1, 2))) == pytest.approx(1 / 2, rel=0.01)
    assert stiffness_ratio(LCR, Damage(side_scale=1.3)) == pytest.approx(1.15, rel=2e-3)


def test_the_text_s_adhesion_and_broken_truss():
    assert stiffness_ratio(LCR, Damage(adhesion=("inner", 0.75))) == pytest.approx(1.4575, rel=0.01)
    assert stiffness_ratio(LCR, Damage(adhesion=("inner", 0.5))) == pytest.approx(1.31, rel=0.01)
    assert stiffness_ratio(LCR, Damage(adhesion=("outer", 0.5))) == pytest.approx(4.95, rel=0.01)
    assert stiffness_ratio(LCR, Damage(adhesion=("outer", 0.75))) == pytest.approx(2.17, rel=0.01)
    assert stiffness_ratio(LCR, Damage(lost_ends=(2,))) == pytest.approx(0.830, rel=0.01)


@pytest.mark.parametrize(
    ("share", "said"),
    [(0.75, "2.2 at three quarters"), (0.5, "5.0 at the middle"), (0.3, "19 at 0.3"), (0.1, "461 at 0.1")],
)
def test_the_card_of_an_adhesion_says_how_stiff_an_outer_beam_makes_it(share, said):
    """Near its root a held outer beam is a stub: with rigid trusses springs in series give 19.4 at 0.3, 501 at 0.1."""
    found = stiffness_ratio(LCR, Damage(adhesion=("outer", share)))
    number = said.partition(" ")[0]
    assert said in " ".join((PointAdhesion.__doc__ or "").split())
    assert f"{found:.{1 if '.' in number else 0}f}" == number
    assert found == pytest.approx(adhesion_on_rigid_trusses("outer", share), rel=0.1)


@pytest.mark.parametrize(
    ("damage", "turn"),
    [(Damage(adhesion=("inner", 0.75)), 31.4), (Damage(lost_ends=(2,)), -12.5), (Damage(lost_ends=(0, 1, 2)), -44.6)],
)
def test_a_hurt_side_turns_the_shuttle(damage, turn):
    """Rotation per travel by another frame program; the sign: the softer side, at +y, runs ahead, x - theta y > x."""
    assert linear(Geometry(), damage)[3] * 1e6 == pytest.approx(turn, rel=0.06)


def test_pull_in_of_a_drawing_scales_as_it_should():
    gradient = LCR.capacitance_gradient()
    assert rotation_pull_in_v(4.51e-7, gradient, 2.1, 126.13, 40.0) == pytest.approx(28.08, rel=5e-3)
    assert geometry_pull_in(LCR, gradient) == pytest.approx(28.08, rel=5e-3)
    # g^1.5: the gradient itself falls with the gap
    wider = rotation_pull_in_v(4.51e-7, gradient * 2.1 / 4.2, 4.2, 126.13, 40.0)
    assert wider / rotation_pull_in_v(4.51e-7, gradient, 2.1, 126.13, 40.0) == pytest.approx(2**1.5, rel=1e-12)
    for truss, volts in ((2.0, 11.13), (3.0, 19.9), (6.0, 37.9), (10.0, 43.3)):
        assert geometry_pull_in(with_truss(truss), gradient) == pytest.approx(volts, rel=0.02)
    for segment in (20.0, 45.0, 60.0):
        other = LCR.model_copy(update={"truss_segment_um": segment})
        found = geometry_pull_in(other, gradient) / geometry_pull_in(LCR, gradient)
        expected = (turning_of_trusses(other) / turning_of_trusses(LCR)) ** 0.5
        assert found == pytest.approx(expected, rel=0.03)


def turning_of_trusses(geometry: Geometry) -> float:
    """Stiffness against rotation of axial springs k_a = EA/L on bending trusses, uN um.

    Outer beams pull a truss by P at 1.5 s, inner ones hold it by 3P at 0.5 s (balance of moments). The bending energy
    of half a truss is P^2 s^3 / 4EI, so 1.5 s theta = 10 P / k_a + P s^3 / 2EI, and the moment of both sides is 6 s P.
    """
    e, s, t = geometry.youngs_modulus_gpa * 1e3, geometry.truss_segment_um, geometry.thickness_um
    axial = e * geometry.beam_um * t / geometry.beam_length_um
    bending = e * t * geometry.truss_um**3 / 12
    return 9 * s * s / (10 / axial + s**3 / (2 * bending))


def test_stiffness_against_rotation_in_closed_form():
    assert stiffness(LCR)[2, 2] == pytest.approx(turning_of_trusses(LCR), rel=0.03)


# -- the faults carry it to the plants


@pytest.mark.parametrize("plant", ["linear", "nonlinear", "planar"])
@pytest.mark.parametrize(
    ("fault", "parameters", "ratio"),
    [
        ("point_adhesion", {"beam": "inner", "position": 0.75}, 1.4575),
        ("point_adhesion", {"beam": "outer", "position": 0.75}, 2.17),
        ("broken_truss", {"extent": "end"}, 0.830),
        ("broken_truss", {"extent": "whole"}, 0.49),
        ("stiffness_one_side", {}, 1.5),
    ],
)
def test_static_displacement_under_faults(plant, fault, parameters, ratio):
    values = {
        "device.id": "lcr-350",
        "device.bias_v": 1.0,
        "plant.model": plant,
        "reference": {"kind": "constant", "amplitude_v": 2.0},
    }
    found = []
    for severity in (0.0, 1.0):
        board = make(values)
        if severity:
            do(board, {"fault": fault, "severity": severity, "parameters": parameters})
        found.append(play(board, 1500)["plant.displacement"][-1])
    assert found[0] / found[1] == pytest.approx(ratio, rel=0.01)


@pytest.mark.parametrize(
    ("fault", "omega", "ratio"),
    [("point_adhesion", 1.0, 1.459), ("point_adhesion", 2.9, 1.473), ("broken_truss", 1.0, 0.830)],
)
def test_effort_to_follow_the_healthy_device(fault, omega, ratio):
    """|G_healthy/G_faulty| at a tone in krad/s: the factor of the voltage that a controller needs."""
    sine = {"kind": "sine", "amplitude_v": 4.0, "frequency_hz": 500.0 * omega / np.pi}
    found = []
    for severity in (0.0, 1.0):
        board = make({"device.id": "lcr-350", "reference": sine, "drive.kind": "analogue"})
        inject(board, **{fault: severity})
        x = play(board, 6000)["plant.displacement"][4000:]
        found.append(abs(phasor(x, sine["frequency_hz"], 0.01, 4000)))
    assert found[0] / found[1] == pytest.approx(ratio, rel=0.01)


def test_half_an_adhesion_is_half_its_effect():
    board = make({"device.id": "lcr-350"})
    inject(board, point_adhesion=0.5)
    trace = play(board, 3)
    whole = stiffness_ratio(LCR, Damage(adhesion=("inner", 0.75)))
    assert trace["effects.stiffness_scale"][-1] == pytest.approx(1 + 0.5 * (whole - 1), rel=1e-12)


def test_parameters_of_a_fault_are_checked():
    from core.errors import InputError

    board = make({})
    for parameters, field in (({"beam": "middle"}, "parameters.beam"), ({"bean": 1}, "parameters.bean")):
        with pytest.raises(InputError) as caught:
            do(board, {"fault": "point_adhesion", "severity": 1.0, "parameters": parameters})
        assert caught.value.field == field
    with pytest.raises(InputError) as caught:
        do(board, {"fault": "point_adhesion", "severity": 1.5})
    assert caught.value.field == "severity"
    assert board.faults == {} and PointAdhesion.name not in board.faults
