"""Sideways motion and rotation: forces against energies, heat, pull-in, folds, contact, exchange of plants."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from scipy import integrate

from core.board import program
from core.plant import body, plane
from core.plant.electrostatics import co_energy, comb
from core.plant.equilibrium import bias_pull_in
from core.plant.suspension import elastic_energy, elastic_force
from scenarios.lateral_metrics import lateral_metrics
from tests.lab import do, make, phasor, play, rms

EPS = 8.8541878128e-12
N, T, G, XS, XR = 87, 2.0, 2.1, 126.13, 166.13
STRENGTH = N * EPS * T * 1e6 * G  # n eps0 t g, uN um^2/V^2
KT = 1.380649e-23 * 300.0
STILL = {"reference": {"kind": "constant", "amplitude_v": 0.0}}
SOFT_ADHESION = {
    "lateral_stiffness_n_m": 26.9,
    "lateral_reach_um": 40.0,
    "rotation_stiffness_nm": 8.05e-8,
    "rotation_reach_um": 1e6,
    "cubic_n_m3": 2.4e7,
    "sideways_per_m": 858.0,
    "turn_rad_m": 185.0,
    "turn_cubic_rad_m3": 1.28e11,
}
"""The suspension with thin trusses and an adhesion; its k1 of 0.0753 N/m goes to the device."""


def bench(bias: float = 10.0, values: dict[str, Any] | None = None, **plant: Any):
    return make(
        {
            "device": {"id": "lcr-350", "bias_v": bias},
            "plant": {"model": "planar", "thermal_noise": False, **plant},
            **STILL,
            **(values or {}),
        }
    )


def insides(board):
    """Packed parameters and state of the plant after a tick."""
    board.advance(1)
    wiring = board.wiring
    return wiring.p[wiring.table[wiring.row("plant"), program.P_OFFSET] :], wiring.state_of("plant")


# -- forces are derivatives of energies


def random_states(n: int = 100):
    random = np.random.default_rng(5)
    while n:
        x, y, theta = random.uniform(-15, 15), random.uniform(-0.8, 0.8), random.uniform(-6e-3, 6e-3)
        if abs(y) + abs(theta) * (XR + 15) < 0.85 * G:
            n -= 1
            yield x, y, theta, random.uniform(0, 900), random.uniform(0, 900)


def exact_co_energy(x, y, theta, right, left):
    """The integral over the overlap in closed form, or by quadrature where it is nearly singular."""

    def one(a, b):
        if abs(theta) < 1e-4:
            return integrate.quad(lambda s: 2 * G / (G * G - (y + theta * s) ** 2), a, b, epsabs=0, epsrel=1e-13)[0]
        part = lambda s: math.log((G + y + theta * s) / (G - y - theta * s)) / theta  # noqa: E731
        return part(b) - part(a)

    a = STRENGTH / G
    return 0.5 * a * (right * one(XS, XR + x) + left * one(-XR + x, -XS))


def test_electrostatic_forces_are_the_gradient_of_the_exact_co_energy():
    for x, y, theta, right, left in random_states():
        tips = (XS, XR, right, left)
        exact = exact_co_energy(x, y, theta, right, left)
        assert co_energy(STRENGTH, G * G, 0.9 * G, tips, x, y, theta) == pytest.approx(exact, rel=1e-6)
        first = np.array(comb(G * G, 0.9 * G, XS, 0.5 * (XR - XS + x), 1.0, y, theta)[:3])
        second = np.array(comb(G * G, 0.9 * G, XS, 0.5 * (XR - XS - x), -1.0, y, theta)[:3])
        force = STRENGTH * (right * first + left * second)
        own, true = [], []
        for step in ((1e-4, 0, 0), (0, 1e-5, 0), (0, 0, 1e-7)):
            h = sum(step)
            ahead, behind = np.array([x, y, theta]) + step, np.array([x, y, theta]) - step
            own.append(
                (co_energy(STRENGTH, G * G, 0.9 * G, tips, *ahead) - co_energy(STRENGTH, G * G, 0.9 * G, tips, *behind))
                / (2 * h)
            )
            true.append((exact_co_energy(*ahead, right, left) - exact_co_energy(*behind, right, left)) / (2 * h))
        scale = STRENGTH * (right + left) / (G * G)
        np.testing.assert_allclose(force, own, rtol=1e-6, atol=1e-7 * scale)
        np.testing.assert_allclose(force, true, rtol=2e-5, atol=1e-6 * scale)


def test_force_along_x_is_that_at_the_rotor_tip():
    """By the fundamental theorem dC/dx is the integrand at the moving end."""
    for x, y, theta, *_ in random_states(20):
        if abs(y) + abs(theta) * (XR + 15) < 0.5 * G:
            along = comb(G * G, 0.9 * G, XS, 0.5 * (XR - XS + x), 1.0, y, theta)[0]
            tip = y + theta * (XR + x)
            assert along == pytest.approx(1 / (G * G - tip * tip), rel=1e-6)


@dataclass(frozen=True)
class Row:
    """A suspension fitted to an independent frame program, in SI units; the reaches in um."""

    k1: float
    k3: float
    ky: float
    reach_y: float
    kt: float
    reach_t: float
    ys2: float
    th1: float
    th3: float


def rows():
    return [
        Row(0.0538, 0.0, 205.4, 9.4, 4.51e-7, 39.7, 0.0, 0.0, 0.0),
        Row(0.0784, 1e8, 204, 15.6, 4.95e-7, 37.8, 1089, 31.4, 1.18e11),
        Row(0.0753, 2.4e7, 26.9, 40, 8.05e-8, 1e6, 858, 185, 1.28e11),
    ]


def packed_row(row: Row) -> np.ndarray:
    return np.array(
        [
            row.k1,
            row.k3 * 1e-12,
            row.ky,
            row.reach_y**-2,
            row.kt * 1e12,
            row.reach_t**-2,
            row.ys2 * 1e-6,
            row.th1 * 1e-6,
            row.th3 * 1e-18,
        ]
    )


@pytest.mark.parametrize("row", rows())
def test_elastic_forces_are_the_gradient_of_the_energy(row):
    k = packed_row(row)

    def energy(x, y, theta):
        """The energy as it is written, over any numbers: complex steps give exact derivatives."""
        off, turned = y - k[6] * x * x, theta - k[7] * x - k[8] * x**3
        return (
            k[0] * x**2 / 2
            + k[1] * x**4 / 4
            + k[2] / (1 + x * x * k[3]) * off**2 / 2
            + k[4] / (1 + x * x * k[5]) * turned**2 / 2
        )

    for x, y, theta, *_ in random_states():
        assert elastic_energy(k, x, y, theta) == pytest.approx(energy(x, y, theta), rel=1e-12)
        gradient = [
            energy(x + 1e-30j, y, theta).imag / 1e-30,
            energy(x, y + 1e-30j, theta).imag / 1e-30,
            energy(x, y, theta + 1e-30j).imag / 1e-30,
        ]
        np.testing.assert_allclose(-np.array(elastic_force(k, x, y, theta)), gradient, rtol=1e-9)


@pytest.mark.parametrize("turn", [0.0, 31.4])
def test_energy_is_kept_without_damping(turn):
    frictionless = {"lateral_damping_ns_m": 0.0, "rotation_damping_nms": 0.0, "squeeze_ns_m": 0.0}
    board = bench(
        10.0,
        {"device.damping_ns_m": 1e-30},
        initial_displacement_um=5.0,
        turn_rad_m=turn,
        turn_cubic_rad_m3=turn * 1e9,
        sideways_per_m=turn * 10,
        step_us=0.25 if turn == 0.0 else 0.05,  # the method itself damps y at 153 kHz, by 3e-6 of a step of 0.25 us
        **frictionless,
    )
    p, s = insides(board)
    trace = play(board, 400)
    k = s[:9].copy()
    x, y, theta = trace["plant.displacement"], trace["plant.shift"], 1e-3 * trace["plant.rotation"]
    m, j = p[0], 1 / p[plane.PER_INERTIA]
    kinetic = 0.5 * m * (trace["plant.velocity"] ** 2 + trace["plant.shift_velocity"] ** 2)
    kinetic += 0.5 * j * (1e-3 * trace["plant.rotation_velocity"]) ** 2
    potential = [elastic_energy(k, *q) for q in zip(x, y, theta, strict=True)]
    tips = (XS, XR, 100.0, 100.0)
    stored = [co_energy(p[plane.STRENGTH], G * G, 0.9 * G, tips, *q) for q in zip(x, y, theta, strict=True)]
    total = kinetic + np.array(potential) - (np.array(stored) - stored[0])
    assert np.ptp(total) / total[0] < 1e-6
    assert (np.ptp(theta) > 1e-4) == (turn != 0.0)


def test_without_rotation_it_is_the_linear_plant():
    values = {"reference": {"kind": "sine", "amplitude_v": 3.0, "frequency_hz": 2000.0}}
    plane_, line = play(bench(10.0, values), 1000), play(bench(10.0, {**values, "plant.model": "linear"}), 1000)
    np.testing.assert_allclose(plane_["plant.displacement"], line["plant.displacement"], atol=1e-6 * 4.2)
    # |k / (k - m w^2 + j beta w)| = 2.573 times 545.5 nm/V at 3 V, and a negative gain
    far = phasor(
        play(bench(10.0, {**values, "drive.kind": "analogue"}), 3000)["plant.displacement"][2000:], 2000, 0.01, 2000
    )
    assert abs(far) == pytest.approx(4.210, rel=5e-3)
    assert math.degrees(np.angle(-far)) == pytest.approx(-25.22, abs=0.3)


def test_squeeze_film_between_two_stators():
    for u in (0.0, 0.3, -0.7):
        r = 1 / (1 - u * u)
        assert body.squeeze_factor(r) == pytest.approx(((1 - u) ** -3 + (1 + u) ** -3) / 2, rel=1e-12)


@pytest.mark.parametrize(("pressure", "fault"), [(101325.0, 0.0), (1e3, 0.0), (1e3, 4.0)])
def test_squeeze_film_is_rarefied(pressure, fault):
    """4 n mu L t^3/g^3 of a continuous gas over 1 + 9.638 Kn^1.159; a fault of the damping multiplies it."""
    board = bench(0.0, {"environment.pressure_pa": pressure})
    do(board, {"kind": "inject", "fault": "damping", "severity": fault})
    board.advance(2)
    _, s = insides(board)
    mu, path = 1.8459e-5, 67.0e-3 * 101325.0 / pressure
    film = 4 * N * mu * 40e-6 * (T / G) ** 3 / (1 + 9.638 * (path / G) ** 1.159)
    assert 2e-3 * s[body.C_SQUEEZE] == pytest.approx((1 + fault) * film, rel=5e-3)


def test_without_any_damping_nothing_shakes_it():
    still = {"lateral_damping_ns_m": 0.0, "rotation_damping_nms": 0.0, "squeeze_ns_m": 0.0, "thermal_noise": True}
    trace = play(bench(0.0, **still), 50)
    assert np.all(trace["plant.rotation"] == 0.0) and np.all(np.isfinite(trace["plant.displacement"]))


# -- heat


@pytest.mark.slow
@pytest.mark.parametrize("factor", [1.0, 5.0])
def test_thermal_motion_obeys_equipartition(factor):
    """kT/2 in each of x, y and theta, whatever the damping: 0.2775 nm, 4.49 pm, 95.8 nrad."""
    board = bench(0.0, thermal_noise=True)
    if factor != 1.0:
        do(board, {"kind": "inject", "fault": "damping", "severity": factor - 1})
    play(board, 2000)
    trace = play(board, 400_000 if factor == 1.0 else 200_000)
    assert rms(trace["plant.displacement"]) == pytest.approx(math.sqrt(KT / 0.0538) * 1e6, rel=0.03)
    assert rms(trace["plant.displacement"]) == pytest.approx(0.2775e-3, rel=0.03)
    assert rms(trace["plant.shift"]) == pytest.approx(math.sqrt(KT / 205.4) * 1e6, rel=0.04)
    assert rms(trace["plant.rotation"]) == pytest.approx(math.sqrt(KT / 4.51e-7) * 1e3, rel=0.04)
    assert rms(trace["plant.rotation"]) == pytest.approx(95.8e-6, rel=0.04)


# -- pull-in by the bias


def test_pull_in_by_the_bias_alone():
    closed = math.sqrt(4.51e-7 * (G * 1e-6) ** 3 / (4 * N * EPS * T * 1e-6 * (XR**3 - XS**3) * 1e-18 / 3))
    assert closed == pytest.approx(28.08, rel=5e-3)
    assert bias_pull_in(*insides(bench())) == pytest.approx(closed, rel=1e-4)
    for values, volts in (
        ({"misalignment_mrad": 0.1}, 26.85),
        ({"misalignment_mrad": 0.5}, 24.48),
        ({"misalignment_um": 0.1}, 27.79),
    ):
        assert bias_pull_in(*insides(bench(**values))) == pytest.approx(volts, rel=0.01)
    # sideways alone, with the rotation held: k_y g^3 = 4 n eps t L V^2
    stiff = insides(bench(rotation_stiffness_nm=1e-5))
    sideways = math.sqrt(205.4 * (G * 1e-6) ** 3 / (4 * N * EPS * T * 1e-6 * 40e-6))
    assert sideways == pytest.approx(87.8, rel=5e-3)
    assert bias_pull_in(*stiff) == pytest.approx(sideways, rel=1e-3)


def test_pull_in_of_a_perfect_device_waits_for_noise():
    quiet = bench(29.0)
    trace = play(quiet, 200)
    assert quiet.trip is None and np.all(trace["plant.lateral"] == 0.0)
    assert play(bench(27.5, thermal_noise=True), 500)["plant.contact"].max() == 0.0
    times = []
    for seed in range(1, 6):
        noisy = bench(29.0, {"seed": seed}, thermal_noise=True)
        play(noisy, 200)
        assert noisy.trip is not None and "touched" in noisy.trip.reason
        times.append(lateral_metrics(noisy)["lateral.contact_ms"])
    assert 0.1 < min(times) and max(times) < 0.6


# -- folds


def folded(bias, fault=None, parameters=None, **plant):
    board = bench(bias, **plant)
    if fault:
        do(board, {"kind": "inject", "fault": fault, "severity": 1.0, "parameters": parameters or {}})
    board.advance(2)
    return lateral_metrics(board)


@pytest.mark.parametrize(
    ("bias", "fault", "parameters", "volts", "travel"),
    [
        (10, None, None, 19.61, 10.70),
        (20, None, None, 9.67, None),
        (10, "point_adhesion", {}, 17.4, 7.66),
        (20, "point_adhesion", {}, 8.00, None),
        (10, "broken_truss", {}, 14.0, None),
        (20, "broken_truss", {}, 4.82, None),
        (10, "broken_truss", {"extent": "whole"}, 8.26, None),
    ],
)
def test_largest_drive_against_another_program(bias, fault, parameters, volts, travel):
    """Voltages by an independent prototype with the rows of its own frame program."""
    found = folded(bias, fault, parameters)
    assert found["lateral.fold_v"] == pytest.approx(volts, rel=0.025)
    if travel:
        assert found["lateral.fold_um"] == pytest.approx(travel, rel=0.01)


def test_lateral_displacement_at_the_fold_is_no_third_of_the_gap():
    found = folded(10, misalignment_mrad=0.1)
    assert found["lateral.fold_v"] == pytest.approx(18.5, rel=0.01)
    assert found["device.pull_in_v"] == pytest.approx(26.85, rel=0.01)
    assert 0.1 * G < found["lateral.fold_lateral_um"] < 0.2 * G < G / 3


def test_the_shuttle_goes_where_the_fold_says():
    """Held just below the fold it stays; just beyond, it touches."""
    at = folded(10, misalignment_mrad=0.1)["lateral.fold_v"]
    for volts, contact in ((0.985 * at, False), (1.02 * at, True)):
        reference = {"kind": "sine", "amplitude_v": -volts, "frequency_hz": 50.0}
        board = bench(10, {"reference": reference}, misalignment_mrad=0.1)
        play(board, 520)
        assert (board.trip is not None) == contact


# -- contact and short


def ramped(step_us: float, **values: Any):
    """4.75 V/ms on the device with thin trusses and an adhesion, at 5 V of bias."""
    ramp = {"kind": "sine", "amplitude_v": 475.0, "frequency_hz": 10.0 / (2 * math.pi)}
    return bench(
        5.0,
        {"device.stiffness_n_m": 0.0753, "reference": ramp, "drive.kind": "analogue", **values},
        step_us=step_us,
        near_step_us=min(step_us, 0.1),
        **SOFT_ADHESION,
    )


def test_contact_time_does_not_depend_on_the_step():
    times = []
    for step in (0.25, 0.1, 0.05):
        board = ramped(step)
        trace = play(board, 400)
        assert board.trip is not None and np.all(np.isfinite(trace["plant.lateral"]))
        times.append(lateral_metrics(board)["lateral.contact_ms"])
    assert np.ptp(times) < 1e-3
    assert times == pytest.approx([1.855] * 3, abs=0.01)  # the same ramp by an independent prototype
    fine = ramped(0.1, sample_rate_khz=1000)
    assert abs(play(fine, 4000)["plant.displacement"][-1]) == pytest.approx(2.40, rel=0.03)


def test_a_short_stays_until_the_board_is_reset():
    board = ramped(0.25, **{"guard.stop_on_contact": False})
    play(board, 250)
    assert board.value("plant.short") != 0.0
    do(board, {"kind": "set", "values": {"reference": {"kind": "constant", "amplitude_v": 0.0}}})
    trace = play(board, 500)
    assert np.all(trace["plant.short"] == trace["plant.short"][0]) and trace["plant.short"][0] != 0.0
    assert np.all(np.isfinite(trace["plant.displacement"]))
    stopped = ramped(0.25)
    play(stopped, 400)
    do(stopped, {"kind": "reset_trip"})
    assert stopped.value("plant.short") == 0.0


def test_insulated_fingers_stay_latched_without_any_drive():
    """Hysteresis: the bias alone holds what the drive has pulled in."""
    board = ramped(0.25, **{"guard.stop_on_contact": False, "plant.short_on_contact": False})
    play(board, 250)
    do(board, {"kind": "set", "values": {"reference": {"kind": "constant", "amplitude_v": 0.0}}})
    trace = play(board, 500)
    assert trace["plant.contact"][-100:].min() == 1.0 and trace["plant.short"].max() == 0.0
    assert abs(trace["plant.lateral"][-1]) == pytest.approx(G - 0.15, abs=0.02)


# -- plants are exchanged while running


def test_plants_are_exchanged_while_running():
    values = {"reference": {"kind": "sine", "amplitude_v": 3.0, "frequency_hz": 2000.0}}
    board = bench(3.0, values, turn_rad_m=30.0)  # the slaved plant has no rest at 10 V
    first = play(board, 100)
    assert abs(first["plant.rotation"]).max() > 0.01
    for model in ("linear", "planar", "slaved_lateral", "nonlinear", "planar"):
        # what only the old plant has is left behind
        before = board.value("plant.displacement")
        do(board, {"kind": "set", "values": {"plant.model": model}})
        trace = play(board, 40)
        assert abs(trace["plant.displacement"][0] - before) < 1.0
        if model in ("linear", "nonlinear"):
            for tap in ("lateral", "shift", "shift_velocity", "rotation", "rotation_velocity", "contact", "short"):
                assert np.all(trace[f"plant.{tap}"] == 0.0)
    assert board.trip is None
