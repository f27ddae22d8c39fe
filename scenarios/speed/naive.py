"""The same loop as one writes it in an afternoon: numpy, one small array operation after the other.

Plant, PID, direct MRAC and a bank of Kalman filters, in the equations of the text. It gives the same results as the
board (a test compares them) and is the peer for the cost of a sample.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from core.block import FloatArray, Oscillator
from core.board.board import Board
from core.control.controller import lag, matching
from core.control.mrac import Mrac
from core.control.pid import Pid
from core.device.oscillator import transition
from core.diagnose.hypothesis import assumed_noise
from scenarios.speed.timing import cpu_ns

KEYS = ("plant", "open_loop", "pid", "mrac", "kalman")
"""Blocks of the board that the loop replaces."""


def held(device: Oscillator, dt_ms: float) -> tuple[FloatArray, FloatArray]:
    """Return the transition of a device over a sample and the effect of a volt that is held."""
    phi = np.array(transition(device.mass, device.damping, device.stiffness, dt_ms)).reshape(2, 2)
    return phi, (np.eye(2) - phi) @ np.array([device.static_gain, 0.0])


class NaiveLoop:
    """Plant, two laws in shadow of the open loop, and a bank.

    Parameters
    ----------
    board : Board
        The bench with the same blocks: its device, laws and hypotheses.
    noise_v : float
        Noise of the drive, rms.
    seed : int
        Of the noise.
    """

    def __init__(self, board: Board, noise_v: float, seed: int = 0) -> None:
        context = board.spec.context()
        device, self.dt = context.device, context.dt_ms
        self.noise, self.random = noise_v, np.random.default_rng(seed)
        self.phi, self.gamma = held(device, self.dt)
        self.x = np.zeros(2)

        self.pid = Pid.Packed(Pid.packed(Pid.Params(), context))
        self.integral = self.derivative = self.last_error = 0.0
        self.started = False

        self.law = Mrac.Packed(Mrac.packed(Mrac.Params(), context))
        self.theta, copy = np.zeros(4), self.law.copy
        self.theta[:] = matching(*self._of(self.law.plant), self.law.model, self.law.filter_pole)
        self.alpha = 1.0 / self.theta[0]
        self.filter = np.array([[copy.phi11, copy.phi12], [copy.phi21, copy.phi22]])
        self.push = np.array([copy.push1, copy.push2])
        self.lag = lag(self.law.filter_pole, self.law.h, analogue=False)
        self.weights = np.array([1.0, 1.0, self.law.weight, self.law.weight])
        self.w, self.w_filtered, self.u_filtered = np.zeros(4), np.zeros((2, 4)), np.zeros(2)

        params = board.spec.diagnosers["kalman"].params
        self.floor, self.q = params.probability_floor, params.process_noise_v**2  # type: ignore[attr-defined]
        self.r = (params.sensor_noise_um or assumed_noise(context)) ** 2  # type: ignore[attr-defined]
        self.models = [held(one.oscillator(device), self.dt) for one in params.hypotheses]  # type: ignore[attr-defined]
        start = params.initial_std_um * np.array([1.0, device.natural_frequency])  # type: ignore[attr-defined]
        self.estimates = [np.zeros(2) for _ in self.models]
        self.covariances = [np.diag(start**2) for _ in self.models]
        self.probability = np.full(len(self.models), 1.0 / len(self.models))
        self.is_driven = False

    @staticmethod
    def _of(plant: object) -> tuple[float, float, float]:
        return plant.a1, plant.a2, plant.gain  # type: ignore[attr-defined]

    def sample(self, reference: float, model: float, applied: float) -> tuple[float, float, float]:
        """Advance by a sample with the applied voltage; return the displacement and the voltages of the laws."""
        if self.started:
            voltage = applied + self.noise * self.random.standard_normal()
            self.x = self.phi @ self.x + self.gamma * voltage
        y = float(self.x[0])
        pid, mrac = self._pid(reference, model, y, applied), self._mrac(reference, model, y, applied)
        self._bank(y, applied)
        self.started = True
        return y, pid, mrac

    def _pid(self, reference: float, model: float, y: float, applied: float) -> float:
        p, e = self.pid, model - y
        before = self.last_error if self.started else e
        self.derivative = p.decay * self.derivative + (1.0 - p.decay) * (e - before) / self.dt
        self.last_error = e
        rest = p.feedforward * reference + p.kp * e + p.kd * self.derivative
        self.integral = applied - rest  # another law drives: ready to take over
        return float(rest + self.integral)

    def _mrac(self, reference: float, model: float, y: float, applied: float) -> float:
        p = self.law
        if self.started:
            self.w_filtered = self.filter @ self.w_filtered + np.outer(self.push, self.w)
            self.u_filtered = self.filter @ self.u_filtered + self.push * applied
            w1 = self.lag.decay * self.w[1] + self.lag.push * applied
            w2 = self.lag.decay * self.w[2] + self.lag.push * self.w[3]
        else:
            w1 = w2 = 0.0
        self.w = np.array([reference, w1, w2, y])
        w_bar = self.w_filtered[0]
        eta = self.theta @ w_bar - self.u_filtered[0]
        size = 1.0 + np.sum(self.weights * w_bar**2) + eta**2
        error = (y - model) + self.alpha * eta
        rate = p.h * p.adaptation_gain / size
        self.theta = self.theta - p.sign * rate * error * self.weights * w_bar
        self.alpha -= rate * error * eta
        return float(self.theta @ self.w)

    def _bank(self, y: float, applied: float) -> None:
        likelihood = np.zeros(len(self.models))
        for k, (phi, gamma) in enumerate(self.models):
            x, covariance = self.estimates[k], self.covariances[k]
            if self.started:
                x = phi @ x + gamma * applied
                covariance = phi @ covariance @ phi.T + np.outer(gamma, gamma) * self.q
            residual = y - x[0]
            psi = covariance[0, 0] + self.r
            gain = covariance[:, 0] / psi
            self.estimates[k] = x + gain * residual
            self.covariances[k] = covariance - np.outer(gain, covariance[0])
            likelihood[k] = np.exp(-0.5 * residual**2 / psi) / np.sqrt(psi)
        self.is_driven = self.is_driven or applied != 0.0
        if not self.is_driven:  # residuals of a device without motion are no evidence
            return
        shares = self.probability * likelihood
        shares = np.maximum(shares / shares.sum(), self.floor)
        self.probability = shares / shares.sum()


def naive_sample(board: Board, noise_v: float, samples: int = 200) -> Callable[[], float]:
    """Return the measurement of the loop, ns per sample, under a sine as reference."""
    loop = NaiveLoop(board, noise_v)
    sine = np.sin(0.15 * np.arange(samples)).tolist()

    def work() -> None:
        for voltage in sine:
            loop.sample(5.0 * voltage, -2.0 * voltage, 5.0 * voltage)

    return lambda: cpu_ns(work, samples)
