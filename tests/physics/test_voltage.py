"""The voltage of an interval: within a tick of an analogue drive, and over the ticks of a block that runs every N."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad_vec
from scipy.linalg import expm
from scipy.signal import cont2discrete

from core.control.controller import advance_lag, lag
from core.device.oscillator import within
from core.estimation import driven_filter_of, filter_voltage
from core.voltage import Motion
from tests.lab import inject, make, play
from tests.physics.bank import BENCH, FACTORS, FORCE, K, M, model
from tests.physics.bank import BETA as B
from tests.physics.test_identify import bench

QUIET: dict[str, Any] = {"model": "linear", "drive_noise_v": 0.0, "thermal_noise": False}
TONES = {"kind": "multi_sine", "amplitude_v": 5.0}
PLAIN = {"sensor": {"kind": "ideal", "noise_um": 0.0}, "reference": TONES}


def matrices(factors: tuple[float, float, float] = (1, 1, 1)) -> tuple[np.ndarray, np.ndarray]:
    """Continuous model in um, ms, V."""
    m, k, b = factors
    return np.array([[0, 1], [-K * k / (M * m) * 1e-6, -B * b / (M * m) * 1e-3]]), np.array([0, FORCE / (M * m)])


@pytest.mark.parametrize("zeta", [0.0, 0.1, 3.0])
def test_effect_of_a_parabola_by_quadrature(zeta):
    """x(h) = integral of exp(A(h-t)) B f(t), with f = 4 t/h (1 - t/h), then t/h (2 t/h - 1)."""
    m, k, h, gain = 0.5, 3.0, 0.7, 1.3
    a = np.array([[0.0, 1.0], [-k / m, -2.0 * zeta * math.sqrt(k * m) / m]])
    found = within(m, -a[1, 1] * m, k, h, gain)
    shapes = (lambda s: 4.0 * s * (1.0 - s), lambda s: s * (2.0 * s - 1.0))
    for i, shape in enumerate(shapes):
        theory, _ = quad_vec(lambda t: expm(a * (h - t))[:, 1] * gain / m * shape(t / h), 0.0, h, epsabs=1e-14)  # noqa: B023
        np.testing.assert_allclose(found[2 * i : 2 * i + 2], theory, rtol=1e-9, atol=1e-13)


def test_filters_of_a_voltage_follow_a_sine():
    """1/(s + p)^2 and 1/(s + p) of a sine in closed form; a parabola leaves an error of fourth order."""
    pole, h, omega = 1.3, 0.1, 0.8
    two, one = driven_filter_of(pole, h, True), lag(pole, h, True)
    motion, lagged, ticks = Motion.zeros(), 0.0, 400
    for i in range(ticks):
        u, middle, end = (math.sin(omega * h * (i + part)) for part in (0.0, 0.5, 1.0))
        filter_voltage(two, motion, u, middle - u, end - u)
        lagged = advance_lag(one, lagged, u, middle - u, end - u)
    phase = np.exp(1j * omega * h * ticks)
    response = 1.0 / (1j * omega + pole)
    theory = [(response**2 * phase).imag, (1j * omega * response**2 * phase).imag, (response * phase).imag]
    np.testing.assert_allclose([motion.x, motion.v, lagged], theory, atol=(omega * h) ** 4 / 100)


def independent(z: np.ndarray, u: np.ndarray, h: float, q: float, r: float) -> tuple[np.ndarray, np.ndarray]:
    """Return residuals and variances of a Kalman filter under the parabola through start, middle and end (columns)."""
    a, b = matrices()
    nodes, weights = np.polynomial.legendre.leggauss(24)
    at = 0.5 * h * (nodes + 1.0)
    kernels = np.array([expm(a * (h - t)) @ b for t in at]) * (0.5 * h * weights)[:, None]
    share = at / h
    lagrange = np.column_stack([(1 - share) * (1 - 2 * share), 4 * share * (1 - share), share * (2 * share - 1)])
    effect = kernels.T @ lagrange
    phi, gamma = expm(a * h), kernels.sum(axis=0)
    x, p = np.zeros(2), np.diag([1.0, 1e6 * K / M * 1e-12])
    residuals, variances = np.zeros(len(z)), np.zeros(len(z))
    for i in range(len(z)):
        if i:
            x, p = phi @ x + effect @ u[i - 1], phi @ p @ phi.T + q * np.outer(gamma, gamma)
        psi = p[0, 0] + r
        residuals[i], variances[i] = z[i] - x[0], psi
        gain = p[:, 0] / psi
        x, p = x + gain * residuals[i], p - np.outer(gain, p[0])
    return residuals, variances


def test_a_bank_under_an_analogue_drive_against_an_independent_filter():
    """Residuals at 20 kHz, ten samples a period; of a matched filter their squares over psi are 1 on average."""
    for seed in range(1, 6):
        own = {"kind": "mmae", "process_noise_v": 0.01}
        document = {**BENCH, "sample_rate_khz": 20, "seed": seed, "sensor": {"kind": "ideal", "noise_um": 0.01}}
        document |= {"plant": {**BENCH["plant"], "drive": "analogue"}, "diagnosers": {"kalman": own}}
        trace = play(make(document), 4000)
        times = 0.05 * (np.arange(4000)[:, None] + np.array([0.0, 0.5, 1.0]))
        u = 10.0 * np.sin(2.0 * math.pi * 2.0 * times)
        residuals, variances = independent(trace["sensor.displacement"], u, 0.05, 1e-4, 1e-4)
        np.testing.assert_allclose(trace["kalman.residual.healthy"], residuals, atol=1e-7)
        nis = residuals**2 / variances
        assert np.mean(nis[200:]) == pytest.approx(1.0, abs=4 * math.sqrt(2 / 3800))
        np.testing.assert_allclose(trace["kalman.nis.healthy"][200:], nis[200:], rtol=1e-3, atol=1e-5)


@pytest.mark.parametrize("every", [1, 2, 5])
@pytest.mark.parametrize("drive", ["held", "analogue"])
@pytest.mark.parametrize("kind", ["arx_bank", "self_tuning", "mmae", "regions"])
def test_a_true_model_explains_a_quiet_device_whatever_the_drive(kind, drive, every):
    """Of several tones, to the rounding of the sums: what moves within an interval is not lost."""
    own = {"kind": kind, "every": every, **({} if kind == "regions" else {"sensor_noise_um": 0.05})}
    plant = {**QUIET, "drive": drive}
    trace = play(make({**BENCH, **PLAIN, "plant": plant, "diagnosers": {"x": own}}), 1500)
    assert np.max(np.abs(trace["plant.displacement"])) > 0.5
    if kind == "regions":
        assert np.max(trace["x.loss"]) < 1e-9
    else:
        assert np.max(np.abs(trace["x.residual.healthy"])) < 1e-9


def phasors(factors: tuple[float, float, float], h: float, every: int, drive: str, hz: float) -> tuple[complex, ...]:
    """Phasor of the displacement of a device, and phasors of its forced motion by one interval and of the remaining
    error."""
    a, b = matrices(factors)
    turn = np.exp(2j * math.pi * hz * 1e-3 * h)
    if drive == "held":
        phi, gamma = model(factors, h)
        x = np.linalg.solve(turn * np.eye(2) - phi, gamma[:, 0])
    else:
        x = np.linalg.solve(2j * math.pi * hz * 1e-3 * np.eye(2) - a, b)
    whole = expm(a * h * every)
    g = turn**every * x - whole @ x
    return x[0], g[0], whole[0, 1] * g[1] - whole[1, 1] * g[0]


def missed(name: str, h: float, every: int, drive: str, hz: float) -> float:
    """Share of the response of a device that its difference equation misses, with the weights of the nominal device."""

    def equation(factors: tuple[float, float, float]) -> np.ndarray:
        phi, gamma = model(factors, h * every)
        g1, g2 = gamma[:, 0]
        return np.array([g1, phi[0, 1] * g2 - phi[1, 1] * g1, -np.trace(phi), np.linalg.det(phi)])

    b0, b1, a1, a2 = equation(FACTORS[name])
    n0, n1, _, _ = equation((1, 1, 1))
    _, alpha, beta = phasors((1, 1, 1), h, every, drive, hz)
    y, _, _ = phasors(FACTORS[name], h, every, drive, hz)
    shift = np.exp(2j * math.pi * hz * 1e-3 * h * every)
    return float(abs((b0 * alpha / n0 * shift + b1 * beta / n1) / (shift**2 + a1 * shift + a2) / y - 1.0))


@pytest.mark.parametrize(("rate_khz", "every", "drive"), [(100, 10, "held"), (20, 1, "analogue"), (100, 20, "held")])
def test_what_a_difference_equation_misses_of_another_device(rate_khz, every, drive):
    """In the residual of the true hypothesis, by the phasors; and the log says it of that which loses most."""
    own = {"kind": "arx_bank", "every": every}
    document = {**BENCH, "sample_rate_khz": rate_khz, "sensor": {"kind": "ideal", "noise_um": 0.0}}
    document |= {"plant": {**QUIET, "drive": drive}, "diagnosers": {"x": own}}
    h, hz = 1.0 / rate_khz, 2000.0
    for name, fault in {"m+10": ("added_mass", 0.1), "k+10": ("stiffness", 0.1), "b+30": ("damping", 0.3)}.items():
        board = make(document)
        inject(board, **{fault[0]: fault[1]})
        trace = play(board, 2000 * every)
        residual = trace[f"x.residual.{name}"][1000 * every :: every]
        y, _, _ = phasors(FACTORS[name], h, every, drive, hz)
        shift = np.exp(2j * math.pi * hz * 1e-3 * h * every)
        phi, _ = model(FACTORS[name], h * every)
        error = abs(shift**2 - np.trace(phi) * shift + np.linalg.det(phi)) * abs(10.0 * y)
        share = missed(name, h, every, drive, hz)
        assert np.sqrt(2.0 * np.mean(residual**2)) == pytest.approx(share * error, rel=0.02)
    worst = max(FACTORS, key=lambda name: missed(name, h, every, drive, hz))
    share = missed(worst, h, every, drive, hz)
    told = [entry.text for entry in board.log if entry.kind == "warning"]
    assert len(told) == (share > 1e-3)
    said = f": {100 * share:.2g} % of the response of {worst} at 2 kHz"
    assert all(said in text.replace("\u00a0", " ") for text in told)


@pytest.mark.parametrize("every", [1, 4])
@pytest.mark.parametrize("drive", ["held", "analogue"])
def test_a_sampled_plant_is_identified_exactly_whatever_the_drive(drive, every):
    """Of four tones, without noise; a mean of the ticks is short by (sin x/x)^2, and lost 0.3 N^2 %."""
    tones = [0.5 * math.pi * k for k in (1, 2, 4, 8)]
    own = {"kind": "recursive_least_squares", "start": "zero", "forgetting": 1 - 5e-4 * every, "every": every}
    trace = play(bench(own, tones, {"plant.drive": drive}), 12_000)
    assert trace["x.error_pct"][-1] < 1e-3
    for part in ("mass", "stiffness", "damping"):
        assert trace[f"x.estimate.{part}"][-1] == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("every", [1, 4])
@pytest.mark.parametrize("drive", ["held", "analogue"])
def test_a_filtered_voltage_is_exact_whatever_the_drive(drive, every):
    """Least squares over the tones in closed form: the line between two samples of y is all that is not exact."""
    tones, h = [0.5 * math.pi * k for k in (1, 2, 4, 8)], 0.01
    m, b, k, force = 2.209e-4, 7.09e-4, 0.0538, -4 * 24 * 8.8541878128e-12 * 20 / 1.05 * 1e6
    rate = math.sqrt(k / m)
    own = {"kind": "least_squares", "forgetting_rate": 100.0, "every": every, "normaliser": 0.0}
    trace = play(bench(own, tones, {"plant.drive": drive}), 20_000)
    plant = (np.array([[0, 1], [-k / m, -b / m]]), np.array([[0.0], [force / m]]), np.eye(2)[:1], np.zeros((1, 1)))
    filters = (np.array([[0, 1], [-(rate**2), -2 * rate]]), np.array([[0.0], [1.0]]), np.eye(2), np.zeros((2, 1)))
    held, line = cont2discrete(plant, h), cont2discrete(filters, h * every, method="foh")
    rows, right = [], []

    def response(system: Any, z: complex) -> np.ndarray:
        a, g, c, d, _ = system
        return (c @ np.linalg.solve(z * np.eye(2) - a, g) + d)[:, 0]

    filtered = cont2discrete(filters, h)
    for w in tones:
        z = np.exp(1j * w * h)
        y = response(held, z)[0] if drive == "held" else force / (k - m * w * w + 1j * b * w)
        u = response(filtered, z)[0] if drive == "held" else 1.0 / (1j * w + rate) ** 2
        q, slope = response(line, z**every) * y
        second = y - 2 * rate * slope - rate**2 * q
        for part in (np.real, np.imag):
            rows.append([part(rate**2 * u), part(-rate * slope), part(-(rate**2) * q)])
            right.append(part(second))
    theory = np.linalg.lstsq(np.array(rows), np.array(right), rcond=None)[0]
    found = [trace[f"x.coefficient.{name}"][-1] for name in ("gain", "a1", "a2")]
    np.testing.assert_allclose(found, theory, rtol=5e-3)
