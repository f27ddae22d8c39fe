"""H-infinity loop shaping against scipy: Riccati equations, norm, closed loop, and the devices it is stable for."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import solve_continuous_are

from core.block import FloatArray, Oscillator
from core.board.board import Board
from core.control.h_infinity import Designed, designed
from core.device.catalogue import device
from tests.lab import inject, make, play, rms
from tests.physics.loop import faulty, sampled

CASES = [(0.1028, 10.0, 1.1), (0.001, 3.0, 1.5), (2.0, 100.0, 1.01)]
S = 1j * np.logspace(-3, 3, 4001)


def solved(ratio: float, weight: float, above_least: float) -> tuple[float, FloatArray, FloatArray]:
    """Return the bound, and numerator and denominator of the controller with the weight, by scipy."""
    a = np.array([[0.0, 1.0], [-1.0, -2.0 * ratio]])
    b, c = np.array([[0.0], [weight]]), np.array([[1.0, 0.0]])
    x = solve_continuous_are(a, b, c.T @ c, np.eye(1))
    z = solve_continuous_are(a.T, c.T, b @ b.T, np.eye(1))
    bound = above_least * np.sqrt(1.0 + max(np.linalg.eigvals(x @ z).real))
    enters = bound**2 * np.linalg.solve(((1.0 - bound**2) * np.eye(2) + x @ z).T, z @ c.T)
    inner, leaves = a - b @ b.T @ x + enters @ c, -b.T @ x
    denominator = np.poly(inner)
    numerator = np.poly(inner + enters @ leaves) - denominator
    return bound, -weight * numerator[1:], denominator[1:]


@pytest.mark.parametrize(("ratio", "weight", "above"), CASES)
def test_the_controller_is_the_controller_of_scipy(ratio: float, weight: float, above: float) -> None:
    own, (bound, numerator, denominator) = designed(ratio, weight, above), solved(ratio, weight, above)
    wanted = [bound, *numerator, *denominator]
    np.testing.assert_allclose([own.bound, own.c1, own.c0, own.d1, own.d0], wanted, rtol=1e-7)


@pytest.mark.parametrize(("ratio", "weight", "above"), CASES)
def test_the_norm_is_below_its_bound_and_above_the_least(ratio: float, weight: float, above: float) -> None:
    own = designed(ratio, weight, above)
    g = weight / (S * S + 2.0 * ratio * S + 1.0)
    k = law(own, S) / weight
    norm = np.sqrt((1.0 + abs(k) ** 2) * (1.0 + abs(g) ** 2)) / abs(1.0 + g * k)  # of rank one: the product of lengths
    assert own.bound / above <= norm.max() * (1.0 + 1e-9)
    assert norm.max() <= own.bound * (1.0 + 1e-9)


def law(own: Designed, s: FloatArray | complex) -> FloatArray:
    found: FloatArray = (own.c1 * s + own.c0) / (s * s + own.d1 * s + own.d0)
    return found


def poles(one: Oscillator, nominal: Oscillator, own: Designed) -> FloatArray:
    """Return the poles of the loop with a device, in units of 1/w0 of the nominal one."""
    rate = nominal.natural_frequency
    below = [one.mass * rate**2, one.damping * rate, one.stiffness]
    below = np.array(below) / nominal.stiffness
    return np.roots(np.polyadd(np.polymul(below, [1.0, own.d1, own.d0]), [own.c1, own.c0]))


def test_every_device_nearer_than_its_margin_is_stable_and_the_bounds_of_the_text_are_inside() -> None:
    """The text bounds the process by 20 % of stiffness and 3 % of mass and damping, at most (chapter 1)."""
    nominal, weight = device({"id": "ch3"}).oscillator(), 10.0
    own = designed(nominal.damping_ratio, weight, 1.1)

    def gap(one: Oscillator) -> float:
        """Return the largest chordal distance of two weighed devices; both wind alike, so it is the nu-gap."""
        rate = nominal.natural_frequency
        of = [
            weight * nominal.stiffness / (each.mass * (rate * S) ** 2 + each.damping * rate * S + each.stiffness)
            for each in (nominal, one)
        ]
        lengths = np.sqrt((1.0 + abs(of[0]) ** 2) * (1.0 + abs(of[1]) ** 2))
        return float((abs(of[0] - of[1]) / lengths).max())

    inside = 0
    for stiffness in (0.8, 1.2, 1.8, 0.4):
        for mass in (0.97, 1.03, 1.5):
            for damping in (0.97, 1.03, 0.5):
                one = faulty(nominal, mass=mass, stiffness=stiffness, damping=damping)
                is_of_the_text = stiffness in (0.8, 1.2) and mass != 1.5 and damping != 0.5
                assert not is_of_the_text or gap(one) < 1.0 / own.bound
                if gap(one) < 1.0 / own.bound:
                    inside += 1
                    assert poles(one, nominal, own).real.max() < 0.0
    assert inside >= 8


def bench(**own: float) -> Board:
    reference = {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 461.5}
    return make({"controller": {"kind": "h_infinity", **own}, "reference": reference})


@pytest.mark.parametrize("weight", [3.0, 10.0])
def test_the_loop_is_the_loop_of_the_matrices(weight: float) -> None:
    board = bench(weight=weight)
    nominal, dt = board.spec.context(1).device, board.dt_ms
    inject(board, added_mass=0.05, stiffness=0.8)
    trace = play(board, 1500)
    own, volts = designed(nominal.damping_ratio, weight, 1.1), nominal.stiffness / nominal.force
    over, push = sampled(Oscillator(1.0, own.d1, own.d0, 1.0), dt * nominal.natural_frequency)
    (a, b), (am, bm) = sampled(faulty(nominal, mass=1.05, stiffness=1.8), dt), sampled(nominal, dt)
    x, y, law_state, before, found = np.zeros(2), np.zeros(2), np.zeros(2), 0.0, []
    for r in trace["reference.voltage"]:
        e = y[0] - x[0]
        law_state = over @ law_state + push[:, 0] * (before + e) / 2.0
        before = e
        u = r + volts * np.array([own.c0, own.c1]) @ law_state
        found.append((x[0], u))
        x, y = a @ x + b[:, 0] * u, am @ y + bm[:, 0] * r
    for name, column in zip(("plant.displacement", "h_infinity.voltage"), np.transpose(found), strict=True):
        np.testing.assert_allclose(trace[name], column, atol=1e-9 * np.abs(column).max())


def test_it_leaves_a_third_of_the_error_without_control() -> None:
    board, free = bench(), make({"reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 461.5}})
    left = []
    for one in (board, free):
        inject(one, added_mass=0.05, ageing=4.0)
        trace = play(one, 4000)
        left.append(rms((trace["model.displacement"] - trace["plant.displacement"])[2000:]))
    assert left[0] < 0.4 * left[1]
