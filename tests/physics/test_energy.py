"""Forces in the plane against the energies they derive from, and the energy a free shuttle keeps."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest
from scipy import integrate

from core.plant.body import squeeze_factor
from core.plant.electrostatics import co_energy, comb
from core.plant.suspension import Suspension, elastic_energy, elastic_force
from tests.lab import do, phasor, play
from tests.physics.plane import STRENGTH, XR, XS, G, N, T, bench, insides


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


def packed_row(row: Row) -> Suspension:
    return Suspension(
        np.array(
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
    )


@pytest.mark.parametrize("row", rows())
def test_elastic_forces_are_the_gradient_of_the_energy(row):
    k = packed_row(row)

    def energy(x, y, theta):
        """The energy as it is written, over any numbers: complex steps give exact derivatives."""
        off, turned = y - k.sideways * x * x, theta - k.turn * x - k.turn_cubic * x**3
        return (
            k.stiffness * x**2 / 2
            + k.cubic * x**4 / 4
            + k.lateral_stiffness / (1 + x * x * k.lateral_softening) * off**2 / 2
            + k.rotation_stiffness / (1 + x * x * k.rotation_softening) * turned**2 / 2
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
    k = Suspension(s.suspension.array.copy())
    x, y, theta = trace["plant.displacement"], trace["plant.shift"], 1e-3 * trace["plant.rotation"]
    m, j = p.mass, 1 / p.per_inertia
    kinetic = 0.5 * m * (trace["plant.velocity"] ** 2 + trace["plant.shift_velocity"] ** 2)
    kinetic += 0.5 * j * (1e-3 * trace["plant.rotation_velocity"]) ** 2
    potential = [elastic_energy(k, *q) for q in zip(x, y, theta, strict=True)]
    tips = (XS, XR, 100.0, 100.0)
    stored = [co_energy(p.strength, G * G, 0.9 * G, tips, *q) for q in zip(x, y, theta, strict=True)]
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
        assert squeeze_factor(r) == pytest.approx(((1 - u) ** -3 + (1 + u) ** -3) / 2, rel=1e-12)


@pytest.mark.parametrize(("pressure", "fault"), [(101325.0, 0.0), (1e3, 0.0), (1e3, 4.0)])
def test_squeeze_film_is_rarefied(pressure, fault):
    """4 n mu L t^3/g^3 of a continuous gas over 1 + 9.638 Kn^1.159; a fault of the damping multiplies it."""
    board = bench(0.0, {"environment.pressure_pa": pressure})
    do(board, {"fault": "damping", "severity": fault})
    board.advance(2)
    _, s = insides(board)
    mu, path = 1.8459e-5, 67.0e-3 * 101325.0 / pressure
    film = 4 * N * mu * 40e-6 * (T / G) ** 3 / (1 + 9.638 * (path / G) ** 1.159)
    assert 2e-3 * s.squeeze == pytest.approx((1 + fault) * film, rel=5e-3)


def test_without_any_damping_nothing_shakes_it():
    still = {"lateral_damping_ns_m": 0.0, "rotation_damping_nms": 0.0, "squeeze_ns_m": 0.0, "thermal_noise": True}
    trace = play(bench(0.0, **still), 50)
    assert np.all(trace["plant.rotation"] == 0.0) and np.all(np.isfinite(trace["plant.displacement"]))
