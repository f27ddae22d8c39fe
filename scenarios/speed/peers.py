"""Peers for the speed: filterpy, python-control, scipy and padasip, each at the same task."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy import signal
from scipy.integrate import solve_ivp

from core import estimation
from core.block import FloatArray, Oscillator
from core.board.board import Board
from core.device.oscillator import transition
from core.kernel import kernel
from core.plant.nonlinear import Nonlinear
from core.record import Record, Vector, vector
from scenarios.speed.timing import cpu_ns


def filterpy_step(board: Board, steps: int = 300) -> Callable[[], float]:
    """Return the measurement of filterpy's bank on the same six models, ns per step."""
    from filterpy.kalman import KalmanFilter, MMAEFilterBank

    filters = []
    section = board.spec.diagnosers["kalman"]
    context = board.spec.context()
    for hypothesis in section.params.hypotheses:  # type: ignore[attr-defined]
        device = hypothesis.oscillator(context.device)
        phi = np.array(transition(device.mass, device.damping, device.stiffness, context.dt_ms)).reshape(2, 2)
        gamma = np.array([[(1.0 - phi[0, 0]) * device.static_gain], [-phi[1, 0] * device.static_gain]])
        kalman = KalmanFilter(dim_x=2, dim_z=1, dim_u=1)
        kalman.F, kalman.B, kalman.H = phi, gamma, np.array([[1.0, 0.0]])
        kalman.Q, kalman.R = gamma @ gamma.T * 0.09, np.array([[0.0025]])
        filters.append(kalman)
    bank = MMAEFilterBank(filters, [1.0 / len(filters)] * len(filters), dim_x=2, H=filters[0].H)

    def measure() -> float:
        def work() -> None:
            for i in range(steps):
                bank.predict(u=np.array([[np.sin(0.25 * i)]]))
                bank.update(np.array([[0.01 * i]]))

        return cpu_ns(work, steps)

    return measure


def interconnected_sample(board: Board, samples: int = 20) -> Callable[[], float]:
    """Return the measurement of python-control's simulation of the same adaptive loop, ns per sample of 10 us."""
    from scenarios.speed.interconnected import adaptive_loop, simulate

    loop = adaptive_loop(board.spec.context())
    return lambda: cpu_ns(lambda: simulate(loop, board.dt_ms * samples), samples)


def lsim_sample(device: Oscillator, voltage: FloatArray) -> Callable[[], float]:
    """Return the measurement of ``scipy.signal.lsim`` on the same record, ns per sample."""
    system = (
        [device.force / device.mass],
        [1.0, device.damping / device.mass, device.stiffness / device.mass],
    )
    t = np.arange(len(voltage)) * 0.01
    return lambda: cpu_ns(lambda: signal.lsim(system, voltage, t), len(voltage))


def forced_response_sample(device: Oscillator, voltage: FloatArray) -> Callable[[], float]:
    """Return the measurement of ``control.forced_response`` on the same record, ns per sample."""
    import control

    system = control.tf2ss([device.force], [device.mass, device.damping, device.stiffness])
    t = np.arange(len(voltage)) * 0.01
    return lambda: cpu_ns(lambda: control.forced_response(system, t, voltage), len(voltage))


def solved(board: Board, samples: int, *, rtol: float = 1e-3, atol: float = 1e-6) -> FloatArray:
    """Return displacement and velocity of the nonlinear plant of a bench by ``solve_ivp``, sample by sample, from rest.

    The voltage is the sine of the reference, held over each sample; the tolerances are the defaults of scipy unless
    given.
    """
    device, p = board.spec.context().device, board.wiring.packed(board.wiring.row("plant"))
    cubic = Nonlinear.Packed(p).cubic
    sine = board.spec.reference.params
    step = 2e-3 * np.pi * sine.frequency_hz * board.dt_ms  # type: ignore[attr-defined]

    def motion(_t: float, x: FloatArray, force: float) -> list[float]:
        return [x[1], (force - device.damping * x[1] - device.stiffness * x[0] - cubic * x[0] ** 3) / device.mass]

    states = np.zeros((samples + 1, 2))
    for i in range(samples):
        force = device.force * sine.amplitude_v * np.sin(step * i)  # type: ignore[attr-defined]
        states[i + 1] = solve_ivp(motion, (0.0, board.dt_ms), states[i], args=(force,), rtol=rtol, atol=atol).y[:, -1]
    return states


def solved_sample(board: Board, samples: int = 200) -> Callable[[], float]:
    """Return the measurement of the same, ns per sample."""
    return lambda: cpu_ns(lambda: solved(board, samples), samples)


class PeerEstimate(Record):
    """Estimate of four parameters, lower triangle of its covariance, regressor, scratch numbers."""

    theta: Vector = vector(4)
    covariance: Vector = vector(10)
    regressor: Vector = vector(4)
    product: Vector = vector(4)


@kernel
def estimate_record(
    s: PeerEstimate, regressors: FloatArray, measured: FloatArray, forgetting: float, limit: float
) -> None:
    """Run recursive least squares with four parameters over a record.

    Parameters
    ----------
    s : Estimate
    regressors, measured : ndarray, shape (m, 4) and (m,)
        The record.
    forgetting, limit : float
        Forgetting factor and largest trace.
    """
    n = 4  # known at compile time, so that the loops are unrolled
    for i in range(regressors.shape[0]):
        error = measured[i]
        for j in range(n):
            s.regressor[j] = regressors[i, j]
            error -= s.theta[j] * regressors[i, j]
        estimation.estimate(s.theta, s.covariance, s.regressor, s.product, n, error, forgetting, forgetting, limit)


def estimate_start(covariance: float) -> PeerEstimate:
    """Return the state of ``estimate_record`` before the first sample."""
    start = PeerEstimate.zeros()
    start.covariance[:] = estimation.diagonal(4, covariance)
    return start


def regressors_of(u: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the regressors [u, u, -y, -y] of a record and the measurements they should explain."""
    return np.column_stack([u[1:-1], u[:-2], -y[1:-1], -y[:-2]]), y[2:]


def estimate_sample(regressors: FloatArray, measured: FloatArray) -> Callable[[], float]:
    """Return the measurement of recursive least squares with four parameters, ns per update."""
    start = estimate_start(1e8)

    def measure() -> float:
        s = PeerEstimate(start.array.copy())
        return cpu_ns(lambda: estimate_record(s, regressors, measured, 0.98, 1e10), len(measured))

    return measure


def padasip_sample(regressors: FloatArray, measured: FloatArray, updates: int = 2000) -> Callable[[], float]:
    """Return the measurement of padasip's filter on the same record, ns per update."""
    import padasip

    def measure() -> float:
        peer = padasip.filters.FilterRLS(n=4, mu=0.98, eps=1e-8, w="zeros")

        def work() -> None:
            for i in range(updates):
                peer.adapt(measured[i], regressors[i])

        return cpu_ns(work, updates)

    return measure
