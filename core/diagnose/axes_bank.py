"""Kalman bank of two axes, with the rate as one more unknown."""

from __future__ import annotations

import math
from typing import Any, cast

from core.block import Context, Equation, Stage, parameter
from core.device.two_axis import TwoAxis
from core.diagnose.axes_filter import AxesFilter, correct, is_seen, predict, variance_of
from core.diagnose.axes_hypothesis import AxesModels
from core.diagnose.axes_model import FORCES, AxesModel, fill
from core.diagnose.bank import Bank
from core.diagnose.lanes import LANE
from core.diagnose.weights import floored, take_floored_softmax, winner_of
from core.elementary import exp, log
from core.kernel import flush_tiny
from core.ports import BlockPorts, output, reads, tap
from core.record import Choice, Record, Records, Vector, tail, vector
from core.units import MS_PER_S, rate_deg_s, rate_rad_ms

LEAST_NOISE = 1e-6
"""Sensor noise assumed at least, over the amplitude the device is meant to swing with."""

DPS = rate_deg_s(1.0)
"""deg/s in a rad/ms."""


class AxesBank(Bank):
    r"""A Kalman filter of both axes for each hypothesis, which also estimates the rate; weighed by its residuals.

    .. math:: x^-=(\Phi+\Omega N)x+\Gamma u,\quad r=z-Hx^-,\quad\psi=\psi_0+SMS^T,\quad
        \ell_k\leftarrow\ell_k-\tfrac12r^T\psi^{-1}r-\tfrac12\ln\det\psi

    Rotation pushes y in step with the velocity of x, a spring between the axes in step with its displacement, so the
    filters separate them within a period. Each hypothesis has a rate of its own. With the rate taken for noise of the
    force, the verdict is right in 50 to 99 % of the 200 ms after a fault of ``gyro-a`` and a step to 300 deg/s 100 ms
    later; as a state, in 98 % and more.

    All residuals are weighed by the covariance of the nominal device, so that no model wins by its assumption about the
    noise. The assumed noise is larger than the true noise, so that a filter soon follows a fault: along x, whose swing
    lasts long, more than along y. Wrong assumptions favour some model by thousandths of a nat per sample, which decides
    where nothing else does, so a rival gains on the winner only by evidence beyond ``least_evidence_nat``.
    """

    title = "Kalman bank of two axes"
    axes = ("x", "y")
    residuals = ("residual_x", "residual_y")
    covariances = ("covariance_x", "covariance_xy", "covariance_y")
    gains = tuple((f"gain_{state}_x", f"gain_{state}_y") for state in ("x", "y", "x_velocity", "y_velocity", "rate"))
    weighed = "the probabilities before, the winner raised by the least evidence that counts"
    lengths = ("hypotheses",)
    weaknesses = (
        "Held at its amplitude, a device with half the drive and one with twice the damping take the same force. Where "
        "the axes are hardly coupled only the first milliseconds tell them apart: on gyro-c twice the damping is taken "
        "for half the drive in 37 % of the 200 ms after it came, on gyro-a in 0.1 %.",
        "What rests has no stiffness: with y rebalanced on gyro-c the noise assumed favours a model stiffer "
        "along y by 1 % by some 0.002 nat per sample, right or wrong; with a least_evidence_nat of 0 it is believed "
        "within a second.",
        "A step of the rate by 300 deg/s is followed within milliseconds; up to 300 samples behind it are wrong.",
    )
    equations = (
        Equation(
            "motion",
            r"x^-=(\Phi+\Omega N)x+\Gamma u,\quad x=x^-+Kr+V\Delta\Omega,\quad r=z-Hx^-",
            "5.2.3.1 for the plant of 6.1",
        ),
        Equation(
            "rate",
            r"V^-=\Phi V+Nx,\; S=HV^-,\; V=V^--KS,\quad\Delta\Omega=MS^T\psi^{-1}r,\; M\leftarrow "
            r"M-M^2S^T\psi^{-1}S+q",
            "Friedland 1969",
        ),
        Equation(
            "probabilities",
            r"\ell_k\leftarrow\ell_k-\tfrac12r^T\psi^{-1}r-\tfrac12\ln\det\psi,"
            r"\quad p_k=\max(\mathrm{softmax}_k\,\ell,\;p_{min})",
            "5.2.3.2.6 with a floor",
        ),
    )
    structure = (
        Stage(
            "Kalman filters",
            "x_measured y_measured x_force y_force",
            "residual_x residual_y covariance_x covariance_xy covariance_y nis rate",
            ("motion", "rate"),
        ),
        Stage("Likelihoods", "weight nis covariance_x covariance_xy covariance_y", "likelihood", ("probabilities",)),
        Stage("Weights", "likelihood", "weight probability", ("probabilities",)),
    )

    class Params(AxesModels):
        """Assumptions of the filters."""

        drive_noise: float = parameter(
            0.02, "assumed noise of the force along x, rms per sample over the force that swings x", "1", ge=0, le=100
        )
        sense_noise: float = parameter(
            0.003, "assumed noise of the force along y, over the same force", "1", ge=0, le=100
        )
        sensor_noise_um: float | None = parameter(
            None, "assumed sensor noise; the sensor's own unless given", "um", gt=0, le=100
        )
        rate_std_dps: float = parameter(
            300.0, "uncertainty of the rate at the start, 0 to take it for 0", "deg/s", ge=0, le=1e6, live=False
        )
        rate_walk_dps_rt_s: float = parameter(100.0, "assumed random walk of the rate", "deg/s/rt s", ge=0, le=1e6)
        probability_floor: float = parameter(1e-6, "smallest probability", equation="5.2.3.2.6", ge=0, le=0.05)
        least_evidence_nat: float = parameter(
            0.02, "evidence per sample by which a rival must exceed the winner to gain on it", "nat", ge=0, le=100
        )
        least_swing_um: float = parameter(
            1e-2, "swing of x (rms over a period) below which residuals are no evidence", "um", ge=0, le=100
        )

    class Packed(Record):
        """Models, ticks between samples, walk of the rate per sample, share of the swing kept, limits; the models."""

        count: Choice
        every: Choice
        walk: float
        kept: float
        least: float
        least_evidence: float
        probability_floor: float
        log_floor: float
        models: Records[AxesModel] = tail()

    class State(Record):
        """Logarithms of probabilities, logarithms of a sample, forces of a tick, mean square of x; the filters."""

        weight: Vector = vector(LANE)
        likelihood: Vector = vector(LANE)
        forces: Vector = vector(FORCES)
        swing: float
        filters: Records[AxesFilter] = tail()

    class Ports(BlockPorts):
        """Displacements and forces in; probabilities and their causes out."""

        x_measured: float = reads("sensor.x.displacement", "um", "measured displacement along x")
        y_measured: float = reads("sensor.y.displacement", "um", "measured displacement along y")
        x_force: float = reads("drive.x.force", "uN", "force along x at the start of the sample that ends now")
        x_middle: float = reads("drive.x.middle", "uN", "the same in its middle")
        x_end: float = reads("drive.x.end", "uN", "the same at its end")
        y_force: float = reads("drive.y.force", "uN", "force along y at the start of the sample that ends now")
        y_middle: float = reads("drive.y.middle", "uN", "the same in its middle")
        y_end: float = reads("drive.y.end", "uN", "the same at its end")
        probability: Vector = output("1", "probability of the hypothesis", each="hypotheses")
        residual_x: Vector = tap("um", "measured minus predicted displacement along x", each="hypotheses")
        residual_y: Vector = tap("um", "measured minus predicted displacement along y", each="hypotheses")
        covariance_x: Vector = tap("um^2", "covariance of the residuals along x", each="hypotheses")
        covariance_xy: Vector = tap("um^2", "the same between the axes", each="hypotheses")
        covariance_y: Vector = tap("um^2", "the same along y", each="hypotheses")
        nis: Vector = tap("1", "half the normalised residual squared, 1 on average for a true model", each="hypotheses")
        rate: Vector = tap("deg/s", "rate under the hypothesis", each="hypotheses")
        state_x: Vector = tap("um", "displacement along x under the hypothesis", each="hypotheses")
        state_y: Vector = tap("um", "displacement along y under the hypothesis", each="hypotheses")
        state_x_velocity: Vector = tap("um/ms", "velocity along x under the hypothesis", each="hypotheses")
        state_y_velocity: Vector = tap("um/ms", "velocity along y under the hypothesis", each="hypotheses")
        variance_x: Vector = tap("um^2", "variance of the displacement along x", each="hypotheses", hidden=True)
        variance_y: Vector = tap("um^2", "variance of the displacement along y", each="hypotheses", hidden=True)
        variance_x_velocity: Vector = tap(
            "um^2/ms^2", "variance of the velocity along x", each="hypotheses", hidden=True
        )
        variance_y_velocity: Vector = tap(
            "um^2/ms^2", "variance of the velocity along y", each="hypotheses", hidden=True
        )
        variance_rate: Vector = tap("deg^2/s^2", "variance of the rate", each="hypotheses", hidden=True)
        gain_x_x: Vector = tap("1", "Kalman gain of the displacement along x by residual_x", each="hypotheses")
        gain_x_y: Vector = tap("1", "Kalman gain of the displacement along x by residual_y", each="hypotheses")
        gain_y_x: Vector = tap("1", "Kalman gain of the displacement along y by residual_x", each="hypotheses")
        gain_y_y: Vector = tap("1", "Kalman gain of the displacement along y by residual_y", each="hypotheses")
        gain_x_velocity_x: Vector = tap("1/ms", "Kalman gain of the velocity along x by residual_x", each="hypotheses")
        gain_x_velocity_y: Vector = tap("1/ms", "Kalman gain of the velocity along x by residual_y", each="hypotheses")
        gain_y_velocity_x: Vector = tap("1/ms", "Kalman gain of the velocity along y by residual_x", each="hypotheses")
        gain_y_velocity_y: Vector = tap("1/ms", "Kalman gain of the velocity along y by residual_y", each="hypotheses")
        gain_rate_x: Vector = tap("deg/s/um", "Kalman gain of the rate by residual_x", each="hypotheses")
        gain_rate_y: Vector = tap("deg/s/um", "Kalman gain of the rate by residual_y", each="hypotheses")

    @classmethod
    def prior(cls, params: Any, before: list[float]) -> list[float]:
        r"""Return the probabilities, the winner's multiplied by :math:`e^\epsilon`, the least evidence."""
        raised = list(before)
        raised[before.index(max(before))] *= exp(params.least_evidence_nat)
        return [share / sum(raised) for share in raised]

    @classmethod
    def floor(cls, params: Any) -> float:
        """Return the smallest probability."""
        return float(params.probability_floor)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the models with their steady gains."""
        nominal = cast(TwoAxis, context.device)
        p = cls.Packed.blank(len(params.hypotheses))
        p.count, p.every = len(params.hypotheses), context.every
        p.walk = rate_rad_ms(params.rate_walk_dps_rt_s) ** 2 * context.dt_ms / MS_PER_S
        p.kept = exp(-context.dt_ms * nominal.natural_frequency / (2.0 * math.pi))
        p.least = params.least_swing_um**2
        p.least_evidence = params.least_evidence_nat
        p.probability_floor, p.log_floor = floored(params.probability_floor)
        noise_um = params.sensor_noise_um or max(context.sensor_noise_um, LEAST_NOISE * nominal.amplitude)
        swinging_un = nominal.damping * nominal.natural_frequency * nominal.amplitude
        assumed = swinging_un * params.drive_noise, swinging_un * params.sense_noise
        for model, hypothesis in zip(p.models, params.hypotheses, strict=True):
            fill(model, hypothesis.device(nominal), nominal, assumed, noise_um, context)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """All filters at zero, all hypotheses alike."""
        s = cls.State.zeros(len(params.hypotheses))
        s.weight[:] = -log(len(params.hypotheses))
        for f in s.filters:
            f.variance = rate_rad_ms(params.rate_std_dps) ** 2
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Predict every filter at every tick; where a sample comes, correct it and weigh the hypotheses."""
        n = int(p.count)
        s.forces[0] = x.x_force
        s.forces[1] = x.x_middle - x.x_force
        s.forces[2] = x.x_end - x.x_force
        s.forces[3] = x.y_force
        s.forces[4] = x.y_middle - x.y_force
        s.forces[5] = x.y_end - x.y_force
        for i in range(n):
            predict(p.models[i], s.filters[i], s.forces)
        if p.every != 1.0 and int(x.tick) % int(p.every) != 0:
            return
        winner = winner_of(x.probability, n)
        seen = is_seen(x.x_measured, x.y_measured)
        if seen:
            s.swing = flush_tiny(p.kept * s.swing + (1.0 - p.kept) * x.x_measured * x.x_measured)
        evidence = seen and s.swing >= p.least
        best = -math.inf
        for i in range(n):
            f = s.filters[i]
            f.variance += p.walk
            likelihood = s.weight[i]
            if seen:
                density = correct(p.models[i], f, x.x_measured, x.y_measured)
                if evidence:
                    # a rival with hardly more evidence than the winner gets none
                    likelihood += density + (p.least_evidence if i == winner else 0.0)
            s.likelihood[i] = likelihood
            best = max(best, likelihood)
            x.residual_x[i] = f.residual_x
            x.residual_y[i] = f.residual_y
            x.covariance_x[i] = f.psi_x
            x.covariance_xy[i] = f.psi_xy
            x.covariance_y[i] = f.psi_y
            x.nis[i] = f.nis
            x.rate[i] = DPS * f.rate
            x.state_x[i] = f.motion[0]
            x.state_y[i] = f.motion[1]
            x.state_x_velocity[i] = f.motion[2]
            x.state_y_velocity[i] = f.motion[3]
            x.variance_x[i] = variance_of(p.models[i], f, 0)
            x.variance_y[i] = variance_of(p.models[i], f, 1)
            x.variance_x_velocity[i] = variance_of(p.models[i], f, 2)
            x.variance_y_velocity[i] = variance_of(p.models[i], f, 3)
            x.variance_rate[i] = DPS * DPS * f.variance
            x.gain_x_x[i] = f.gain[0]
            x.gain_x_y[i] = f.gain[1]
            x.gain_y_x[i] = f.gain[2]
            x.gain_y_y[i] = f.gain[3]
            x.gain_x_velocity_x[i] = f.gain[4]
            x.gain_x_velocity_y[i] = f.gain[5]
            x.gain_y_velocity_x[i] = f.gain[6]
            x.gain_y_velocity_y[i] = f.gain[7]
            x.gain_rate_x[i] = DPS * f.rate_gain_x
            x.gain_rate_y[i] = DPS * f.rate_gain_y
        take_floored_softmax(s.weight, s.likelihood, x.probability, n, best, p.probability_floor, p.log_floor)
