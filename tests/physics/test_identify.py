"""Identifiers against theory, against another library, and against the limits of their information."""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np
import pytest
from scipy.signal import cont2discrete, lfilter

from core.errors import InputError
from core.estimation import HIGHEST
from core.identify.filtered import noise_gram
from scenarios.library import get
from scenarios.run import run
from scenarios.speed.peers import estimate_record, estimate_start
from tests.lab import do, inject, make, play

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # stray backslashes in its documentation
    import padasip

ONE, TWO, FOUR = [1.0], [1.0, 2.9], [1.0, 2.9, 8.0, 16.0]
W0 = math.sqrt(0.0538 / 2.2090e-10) * 1e-3
NAMES = ("gain", "a1", "a2")


def bench(identifier: dict[str, Any], tones: list[float], values: dict[str, Any] | None = None, **faults: float):
    """Return a quiet bench driven by tones of 10 V at rad/ms, with one identifier and faults from the start."""
    lines = [{"frequency_hz": w * 1e3 / (2 * math.pi)} for w in tones]
    reference = {"kind": "multi_sine", "amplitude_v": 10.0, "tones": lines}
    board = make({"reference": reference, "identifiers": {"x": identifier}, **(values or {})})
    inject(board, **faults)
    return board


def errors(trace: dict[str, np.ndarray], at: int = -1) -> np.ndarray:
    """Return the relative errors of kp, a1 and a2, %."""
    found = [trace[f"x.coefficient.{name}"][at] / trace[f"x.coefficient_true.{name}"][at] - 1 for name in NAMES]
    return 100 * np.array(found)


def settled_ms(trace: dict[str, np.ndarray], within: float = 10.0) -> float:
    return (np.flatnonzero(trace["x.error_pct"] > within)[-1] + 1) * 0.01


# -- kp, a1, a2


def test_true_coefficients_are_those_of_the_device():
    trace = play(bench({"kind": "gradient"}, FOUR, added_mass=0.1, stiffness=0.3, damping=0.5, drive_gain=-0.2), 10)
    mass, stiffness, damping, force = (
        2.209e-10 * 1.1,
        0.0538 * 1.3,
        7.09e-7 * 1.5,
        -4 * 24 * 8.8541878128e-12 * 20 / 1.05,
    )
    rate = W0 * 1e3
    expected = [0.8 * force / (mass * rate**2) * 1e6, damping / (mass * rate), stiffness / (mass * rate**2)]
    np.testing.assert_allclose([trace[f"x.coefficient_true.{name}"][-1] for name in NAMES], expected, rtol=1e-9)


@pytest.mark.parametrize("kind", ["gradient", "least_squares"])
def test_four_tones_identify_and_one_does_not(kind):
    faults = {"added_mass": 0.05, "stiffness": 0.8}
    identifier = {"kind": kind, "adaptation_gain": 5.0} if kind == "gradient" else {"kind": kind}
    trace = play(bench(identifier, FOUR, **faults), 6000)
    assert np.abs(errors(trace)).max() < 3.0
    estimate = {part: trace[f"x.estimate.{part}"][-1] for part in ("mass", "stiffness", "damping")}
    assert estimate["mass"] == pytest.approx(1.05, abs=0.01) and estimate["stiffness"] == pytest.approx(1.8, abs=0.01)
    assert estimate["damping"] == pytest.approx(1.0, abs=0.03)
    one = play(bench(identifier, ONE, **faults), 6000)
    assert np.abs(errors(one)).min() > 4.0
    if kind == "gradient":
        assert np.abs(one["x.residual"][-700:]).max() < 1e-6


@pytest.mark.parametrize("pole", [0.7, 1.0, 1.5])
def test_holding_the_displacement_biases_by_half_a_sample(pole):
    """Held, y is seen h/2 late: of phi = [u, -y', -y]/D the last two, and z = y - (2 L s + L^2) y/D, by e^(-sh/2)."""
    values = {"kind": "least_squares", "start": "zero", "filter_pole": pole}
    line = errors(play(bench({**values, "between": "line"}, FOUR), 4000))
    held = errors(play(bench({**values, "between": "held"}, FOUR), 4000))
    assert np.abs(line).max() < 3.5
    if pole == 1.0:
        assert held[0] > 6.0 and held[1] > 8.0
    # by least squares over the four tones with that delay, in closed form
    h, a1, kp = 0.01 * W0, 7.09e-7 / math.sqrt(0.0538 * 2.209e-10), 1.0
    rows, right = [], []
    for w in FOUR:
        s = 1j * w / W0
        y = kp / (s * s + a1 * s + 1) * np.exp(-s * h / 2)  # the drive is held as well
        late = y * np.exp(-s * h / 2)
        over = (s + pole) ** 2
        u = (1 - np.exp(-s * h)) / (s * h) / over
        lhs = y * np.exp(0) - (2 * pole * s + pole**2) * late / over
        rows += [[part(u), part(-s * late / over), part(-late / over)] for part in (np.real, np.imag)]
        right += [lhs.real, lhs.imag]
    theory = np.linalg.lstsq(np.array(rows), np.array(right), rcond=None)[0]
    assert held[0] == pytest.approx(100 * (theory[0] - 1), abs=5.0)
    assert held[2] == pytest.approx(100 * (theory[2] - 1), abs=5.0)


def test_least_squares_is_the_information_form_of_the_equations():
    """P^-1 <- e^-Bh P^-1 + h phi phi'/m^2, and theta the weighted solution, with phi filtered here by scipy."""
    rate, alpha, trust, n, h = 300.0, 10.0, 40.0, 1500, 0.01 * W0
    own = {"forgetting_rate": rate, "normaliser": alpha, "initial_covariance": trust, "covariance_limit": 0.0}
    board = bench({"kind": "least_squares", "start": "zero", "range_ratio": 0.0, **own}, FOUR, stiffness=0.3)
    trace = play(board, n)
    u, y = trace["drive.voltage"], trace["sensor.displacement"]
    held, line = (
        [cont2discrete((top, [1.0, 2.0, 1.0]), h, method=method) for top in ([1.0], [1.0, 0.0], [1.0, 0.0, 0.0])]
        for method in ("zoh", "foh")
    )
    wu = lfilter(held[0][0].ravel(), held[0][1], u)
    # the filter of the bench starts at zero with its first sample; so does this one, because y begins at 0
    wy, dy, z = (lfilter(b.ravel(), a, y) for b, a, _ in line)
    information, weighted = np.eye(3) / trust, np.zeros(3)
    for i in range(1, n):
        phi = np.array([wu[i], -dy[i], -wy[i]])
        share = h / (1 + alpha * phi @ phi)
        decay = math.exp(-rate * 1e-5)
        information = decay * information + share * np.outer(phi, phi)
        weighted = decay * weighted + share * phi * z[i]
    found = [trace[f"x.coefficient.{name}"][-1] for name in NAMES]
    np.testing.assert_allclose(found, np.linalg.solve(information, weighted), rtol=1e-6)
    assert trace["x.covariance_trace"][-1] == pytest.approx(np.trace(np.linalg.inv(information)), rel=1e-6)


def test_forgetting_sets_the_pace_only_while_the_start_is_trusted():
    def ms(rate: float, trust: float) -> float:
        own = {"kind": "least_squares", "start": "zero", "forgetting_rate": rate, "initial_covariance": trust}
        return settled_ms(play(bench({**own, "range_ratio": 0.0, "covariance_limit": 1e9}, TWO), 1000))

    assert 2.3 < ms(10e3, 1.0) / ms(30e3, 1.0) < 4.0
    assert ms(10.0, 1e4) / ms(30.0, 1e4) == pytest.approx(1.0, abs=0.1)


def test_without_its_normaliser_the_gain_that_is_stable_depends_on_the_amplitude():
    """Sampled, the error of a step with phi is multiplied by 1 - h g phi'phi, and phi grows with the voltage."""

    def error(volts: float, **law: Any) -> float:
        own = {"kind": "gradient", "output_weight": 1.0, "range_ratio": 0.0, "adaptation_gain": 0.2, **law}
        board = bench(own, FOUR, {"reference.amplitude_v": volts}, stiffness=0.3)
        return float(play(board, 6000)["x.error_pct"][-1])

    assert error(1.0, normalise=False) < 30.0
    assert error(10.0, normalise=False) == 1e4
    assert error(10.0) < 30.0


def test_lyapunov_function_of_the_gradient_never_rises():
    trace = play(
        bench({"kind": "gradient", "output_weight": 1.0}, TWO, {"sample_rate_khz": 1000}, stiffness=0.3), 20_000
    )
    theta = np.column_stack([trace[f"x.coefficient.{name}"] - trace[f"x.coefficient_true.{name}"] for name in NAMES])
    v = np.sum(theta**2, axis=1)
    assert v[-1] < 0.9 * v[0] and np.diff(v).max() < 1e-6 * v[0]


def test_projection_keeps_coefficients_within_their_range():
    for kind in ("gradient", "least_squares"):
        trace = play(bench({"kind": kind, "range_ratio": 1.2}, FOUR, stiffness=0.8), 3000)
        ratio = trace["x.coefficient.a2"]
        assert ratio.max() == pytest.approx(1.2, abs=1e-9) and ratio.min() > 1 / 1.2 - 1e-9


def test_covariance_stays_below_its_limit_under_a_constant():
    def largest(limit: float) -> float:
        own = {"kind": "least_squares", "forgetting_rate": 1000.0, "covariance_limit": limit}
        values = {"reference": {"kind": "constant", "amplitude_v": 5.0}, "identifiers": {"x": own}}
        return play(make(values), 4000)["x.covariance_trace"].max()

    assert 1e9 < largest(0.0) <= HIGHEST
    assert largest(1e5) <= 1e5


def test_switched_off_it_holds_and_on_again_it_trusts_nothing():
    board = bench({"kind": "least_squares", "initial_covariance": 123.0}, FOUR)
    play(board, 2000)
    do(board, {"set": {"identifiers.x.enabled": False}})
    inject(board, stiffness=0.5)
    off = play(board, 1000)
    for name in NAMES:
        assert np.ptp(off[f"x.coefficient.{name}"]) == 0.0
    assert off["x.covariance_trace"][-1] < 200
    do(board, {"set": {"identifiers.x.enabled": True}})
    on = play(board, 3000)
    assert 2 * 123.0 < on["x.covariance_trace"][0] < 3 * 123.0  # the first sample tells of one direction of three
    assert on["x.estimate.stiffness"][-1] == pytest.approx(1.5, abs=0.02)


# -- excitation


@pytest.mark.parametrize("kind", ["excitation", "gradient", "recursive_least_squares"])
def test_one_tone_and_a_step_are_flagged_and_four_tones_pass(kind):
    for tones, identifiable in ((ONE, 0.0), ([W0], 0.0), (FOUR, 1.0)):
        trace = play(bench({"kind": kind}, tones), 8000)
        assert np.all(trace["x.identifiable"][4500:] == identifiable)
    step = {"reference": {"kind": "step", "amplitude_v": 5.0}, "identifiers": {"x": {"kind": kind}}}
    assert np.all(play(make(step), 8000)["x.identifiable"][4500:] == 0.0)


@pytest.mark.parametrize("kind", ["excitation", "gradient", "recursive_least_squares"])
@pytest.mark.parametrize("noise_um", [0.01, 0.1])
def test_noise_does_not_pass_for_excitation(kind, noise_um):
    for seed in (1, 6):
        values = {"sensor.noise_um": noise_um, "seed": seed}
        for tones, identifiable in ((ONE, 0.0), ([12.0], 0.0), (FOUR, 1.0)):
            assert np.all(play(bench({"kind": kind}, tones, values), 12_000)["x.identifiable"][4500:] == identifiable)
        step = {"reference": {"kind": "step", "amplitude_v": 5.0}, "identifiers": {"x": {"kind": kind}}}
        assert np.all(play(make({**values, **step}), 12_000)["x.identifiable"][4500:] == 0.0)


def test_noise_that_is_turned_up_live_is_taken_out_as_well():
    board = bench({"kind": "excitation"}, ONE, {"sensor.noise_um": 0.0})
    play(board, 4000)
    do(board, {"set": {"sensor.noise_um": 0.1}})
    assert np.all(play(board, 12_000)["x.identifiable"][2500:] == 0.0)


@pytest.mark.parametrize(("method", "held"), [("foh", 0.0), ("zoh", 1.0)])
def test_noise_in_the_regressor_is_that_of_its_filters(method, held):
    """White noise through a filter has the variance of its impulse response, and 1/(4 L^3), 1/(4 L) h in the limit."""
    pole, h, sigma = 1.3, 0.156, 0.05
    impulse = np.zeros(2000)
    impulse[1] = sigma
    y, dy = (
        lfilter(b.ravel(), a, impulse)
        for b, a, _ in (cont2discrete((top, [1.0, 2 * pole, pole**2]), h, method) for top in ([1.0], [1.0, 0.0]))
    )
    expected = [0.0, 0.0, dy @ dy, 0.0, dy @ y, y @ y]
    np.testing.assert_allclose(noise_gram(pole, h, held, sigma), expected, rtol=1e-6, atol=1e-12)
    fine = noise_gram(pole, 1e-3, held, sigma)
    assert fine[5] == pytest.approx(sigma**2 * 1e-3 / (4 * pole**3), rel=1e-3)
    assert fine[2] == pytest.approx(sigma**2 * 1e-3 / (4 * pole), rel=1e-2)


def test_excitation_is_the_smallest_eigenvalue_in_closed_form():
    from core.theory.persistency import excitation, gram_of_tones

    # tones of 1, 2, 4 and 8 per window, so that the mean over it is a mean of whole periods
    tones = [0.5 * math.pi * k for k in (1, 2, 4, 8)]
    trace = play(bench({"kind": "excitation", "excitation_window_ms": 4.0}, tones), 4000)
    kp = -4 * 24 * 8.8541878128e-12 * 20 / 1.05 / 0.0538 * 1e6
    plant = (kp, 7.09e-7 / math.sqrt(0.0538 * 2.209e-10), 1.0)
    theory = excitation(gram_of_tones([(10.0, w / W0) for w in tones], plant))
    assert trace["x.excitation"][-1] == pytest.approx(theory.smallest, rel=0.03)
    assert trace["x.excitation_relative"][-1] == pytest.approx(theory.relative, rel=0.03)


# -- the sampled plant


def test_recursive_least_squares_is_padasip():
    own = {"kind": "recursive_least_squares", "start": "zero", "forgetting": 0.97, "covariance_limit": 0.0}
    board = bench({**own, "initial_covariance": 1e4}, FOUR, {"sensor.noise_um": 0.05})
    trace = play(board, 800)
    u, y = trace["drive.voltage"], trace["sensor.displacement"]
    peer = padasip.filters.FilterRLS(n=4, mu=0.97, eps=1e-4, w="zeros")
    for i in range(2, 800):
        peer.adapt(y[i], np.array([u[i - 1], u[i - 2], -y[i - 1], -y[i - 2]]))
    found = [trace[f"x.coefficient.{name}"][-1] for name in ("b0", "b1", "a1", "a2")]
    np.testing.assert_allclose(found, peer.w, rtol=1e-6)
    assert trace["x.covariance_trace"][-1] == pytest.approx(np.trace(peer.R), rel=1e-6)


def test_recursive_least_squares_finds_the_sampled_plant_and_mass_stiffness_damping():
    trace = play(bench({"kind": "recursive_least_squares"}, FOUR, added_mass=0.1, stiffness=0.3, damping=0.5), 500)
    m, b, k = 2.209e-4 * 1.1, 7.09e-4 * 1.5, 0.0538 * 1.3
    force = -4 * 24 * 8.8541878128e-12 * 20 / 1.05 * 1e6
    rows = ([[0, 1], [-k / m, -b / m]], [[0], [force / m]], [[1, 0]], [[0]])
    system = tuple(np.array(part, dtype=float) for part in rows)
    a, g, c, *_ = cont2discrete(system, 0.01)
    expected = [(c @ g).item(), (c @ (a - np.trace(a) * np.eye(2)) @ g).item(), -np.trace(a), np.linalg.det(a)]
    for name, value in zip(("b0", "b1", "a1", "a2"), expected, strict=True):
        assert trace[f"x.coefficient_true.{name}"][-1] == pytest.approx(value, rel=1e-9)
        assert trace[f"x.coefficient.{name}"][-1] == pytest.approx(value, rel=1e-6)
    for part, value in (("mass", 1.1), ("stiffness", 1.3), ("damping", 1.5)):
        assert trace[f"x.estimate.{part}"][-1] == pytest.approx(value, rel=1e-5)


def test_dead_zone_and_reset():
    own = {"kind": "recursive_least_squares", "forgetting": 1.0, "initial_covariance": 100.0}
    idle = play(bench({**own, "dead_zone_um": 50.0}, FOUR, stiffness=0.5), 500)
    assert np.ptp(idle["x.coefficient.b0"]) == 0.0 and np.all(idle["x.covariance_trace"] == 400.0)
    board = bench({**own, "reset_below": 50.0}, FOUR)
    play(board, 400)
    trace = play(board, 600)["x.covariance_trace"]
    assert trace.min() >= 50.0 and trace.max() == pytest.approx(400.0)
    assert play(bench(own, FOUR), 1000)["x.covariance_trace"][-1] < 50.0


def test_wind_up_is_bounded_and_the_covariance_stays_definite():
    """A million noise-free samples of one sine at forgetting 0.86, then ten million zeros."""
    t = 0.25 * np.arange(1_000_002)
    u, y = np.sin(t), 0.4 * np.sin(t - 0.3)
    h, z = np.column_stack([u[1:-1], u[:-2], -y[1:-1], -y[:-2]]), y[2:]
    for limit in (1e10, 0.0):
        s = estimate_start(1e8)
        estimate_record(s, h, z, 0.86, limit)
        assert np.all(np.isfinite(s.array))
        matrix = np.zeros((4, 4))
        matrix[np.tril_indices(4)] = s.covariance
        matrix += np.tril(matrix, -1).T
        assert np.linalg.eigvalsh(matrix)[0] > 0.0 and np.trace(matrix) <= 1e10
        assert abs(h[-1] @ s.theta - z[-1]) < 1e-6
    s = estimate_start(1e8)
    zeros = np.zeros((1_000_000, 4))
    for _ in range(10):
        estimate_record(s, zeros, zeros[:, 0], 0.86, 1e10)
    assert np.all(np.isfinite(s.array)) and 0.0 < s.covariance[0] <= 1e10


# -- adaptive forgetting


def test_as_printed_it_does_not_look_at_the_data():
    """With gamma sigma^2 < 1 the ratio grows without end and the factor is the ramp 1 - mu i, whatever is measured."""
    own = {"kind": "adaptive_forgetting", "reading": "printed", "innovation_um": 0.01}
    for noise in (0.01, 0.05):
        trace = play(bench(own, FOUR, {"sensor.noise_um": noise}), 1000)["x.forgetting"]
        steps = np.diff(trace[20:])
        assert np.mean(steps < 0) > 0.97 and trace[-1] == pytest.approx(1 - 1e-4 * 1000, abs=0.003)
    # and with a variance far above the data it collapses and the factor climbs beyond 1
    trace = play(bench({**own, "innovation_um": 100.0}, FOUR, {"sensor.noise_um": 0.05}), 1000)["x.forgetting"]
    assert trace[-1] > 1.05


def test_ratio_of_the_innovations_is_their_mean_over_the_memory():
    own = {"kind": "adaptive_forgetting", "reading": "step", "innovation_um": 0.05, "step_size": 0.01}
    trace = play(bench(own, ONE, {"sensor.noise_um": 0.02, "sample_rate_khz": 20}), 800)
    square, factor, ratio = (trace["x.residual"] / 0.05) ** 2, trace["x.forgetting"], trace["x.innovation_ratio"]
    first = int(np.flatnonzero(ratio)[0])
    memory = np.concatenate([[1.0], factor[first:-1]])
    for i in (first, first + 1, first + 40, 799):
        weight = np.append(np.cumprod(memory[i - first : 0 : -1])[::-1], 1.0)
        assert ratio[i] == pytest.approx(weight @ square[first : i + 1] / weight.sum(), rel=1e-9)
    assert factor.min() < 0.8


def test_it_forgets_when_the_device_changes_and_only_then():
    values = {"sensor.noise_um": 0.02, "sample_rate_khz": 20}
    board = bench({"kind": "adaptive_forgetting", "initial_covariance": 1.0}, FOUR, values)
    calm = play(board, 2000)
    inject(board, stiffness=0.3)
    after = play(board, 60)
    assert np.mean(calm["x.forgetting"][200:] == 1.0) > 0.9
    assert after["x.forgetting"][:10].min() < 0.5
    assert after["x.estimate.stiffness"][-1] == pytest.approx(1.3, abs=0.05)
    # the corrected stepwise reading keeps to its limits, and is far slower
    slow = bench({"kind": "adaptive_forgetting", "initial_covariance": 1.0, "reading": "step"}, FOUR, values)
    play(slow, 2000)
    inject(slow, stiffness=0.3)
    trace = play(slow, 60)
    assert trace["x.forgetting"].max() <= 1.0 and trace["x.forgetting"].min() > 0.7
    assert abs(trace["x.estimate.stiffness"][-1] - 1.3) > 0.1


# -- on the bench


def test_a_lost_sample_is_left_out():
    board = bench({"kind": "recursive_least_squares"}, FOUR)
    play(board, 300)
    before = board.value("x.coefficient.a1")
    board.wiring.w[board.wiring.index["sensor.displacement"]] = math.nan
    assert math.isfinite(before) and math.isfinite(play(board, 10)["x.coefficient.a1"][-1])


def test_metrics_of_an_identifier():
    found = run(get("ch3-ffrls-b10")).metrics
    assert (
        found["identify.trusting.settling_ms"] > 2 * run(get("ch3-ffrls-b30")).metrics["identify.trusting.settling_ms"]
    )
    assert found["identify.doubting.error_pct"] < 3.0
    assert abs(found["identify.doubting.stiffness_error_pct"]) < 0.1


def test_bad_identifiers_are_named():
    for values, field in (
        ({"identifiers": {"x": {"kind": "kalman"}}}, "identifiers.x.kind"),
        ({"identifiers": {"X": {"kind": "gradient"}}}, "identifiers.X"),
        ({"identifiers": {"x": 3}}, "identifiers.x"),
        ({"identifiers": {"x": {"kind": "gradient", "adaptation_gain": 0}}}, "identifiers.x.adaptation_gain"),
        ({"identifiers": {"a": {"kind": "gradient"}}, "diagnosers": {"a": {"kind": "mmae"}}}, "identifiers.a"),
        ({"device": {"id": "double-integrator"}, "identifiers": {"x": {"kind": "gradient"}}}, "identifiers.x.kind"),
    ):
        with pytest.raises(InputError) as error:
            make(values if "device" not in values else {**values, "plant": {"model": "transfer_function"}})
        assert error.value.field == field
