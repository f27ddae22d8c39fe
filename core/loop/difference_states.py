"""The states of difference equations: displacement and velocity as each hypothesis predicts them."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, Context, Equation
from core.device.oscillator import transition
from core.diagnose.arx import coefficients_of
from core.diagnose.hypothesis import BankParams, assumed_noise
from core.diagnose.lanes import LANE
from core.kernel import flush_tiny
from core.ports import reads, tap
from core.record import Choice, Record, Vector, vector
from core.voltage import Gathered, Interval, ObservedPorts, gather, interval_of, weighed_voltages


class DifferenceStates(Block):
    r"""Displacement and velocity as the difference equation of each hypothesis predicts them (5.3.2.4).

    .. math:: \hat y_k=z_i-r_k,\qquad \hat v_k=\frac{\Phi_{22}\hat y_k-a_2z_{i-1}+b_1u_{i-1}}{\Phi_{12}}

    A difference equation has no velocity, but two displacements and the voltage between them have one under each
    hypothesis. The covariance is the effect of white sensor noise in the two measurements of the prediction. Behind the
    filter 1/A(q) of the healthy device the prediction is nearly a simulation: the prediction before takes the place of
    the measurement, and the covariance is taken for 0. A bank that estimates its coefficients has doubts about them
    too, which are left out.
    """

    title = "States of difference equations"
    equations = (
        Equation("output", r"\hat z_k(t_i)=z_i-r_k", "5.3.2.4"),
        Equation("velocity", r"\hat v_k=(\Phi_{22}\hat y_k-a_2z_{i-1}+b_1u_{i-1})/\Phi_{12}", "from 5.3.3.1"),
    )
    every_tick = True
    Params = BankParams

    class Packed(Record):
        """Number of models, ticks between two updates, the nominal interval; of each model its equation and covariance.

        The velocity is the displacement times ``across``, less the displacement before times ``back``, and the voltage
        times ``pushed``. The displacement before is measured, unless the bank has a filter and simulates.
        """

        count: Choice
        every: Choice
        simulates: Choice
        interval: Interval
        across: Vector = vector(LANE)
        back: Vector = vector(LANE)
        pushed: Vector = vector(LANE)
        variance_displacement: Vector = vector(LANE)
        covariance: Vector = vector(LANE)
        variance_velocity: Vector = vector(LANE)

    class State(Record):
        """The voltage of the interval, the last measurement, the last displacement of each model."""

        gathered: Gathered
        last: float
        before: Vector = vector(LANE)

    class Ports(ObservedPorts):
        """Measurement, voltage and residuals; the states and their covariances, as a bank of filters shows them."""

        residual: Vector = reads("", "um", "residuals of the bank")
        state_displacement: Vector = tap("um", "displacement under the hypothesis", each="hypotheses")
        state_velocity: Vector = tap("um/ms", "velocity under the hypothesis", each="hypotheses")
        variance_displacement: Vector = tap("um^2", "variance of this displacement", each="hypotheses", hidden=True)
        covariance: Vector = tap("um^2/ms", "covariance of displacement and velocity", each="hypotheses", hidden=True)
        variance_velocity: Vector = tap("um^2/ms^2", "variance of this velocity", each="hypotheses", hidden=True)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        r"""Pack the equations of a bank, and the covariances of its predictions.

        White noise e of variance :math:`\sigma^2` in the two measurements before makes the errors
        :math:`\delta y=-a_1e_1-a_2e_2` and :math:`\delta v=(\Phi_{22}\,\delta y-a_2e_1)/\Phi_{12}`.
        """
        p = cls.Packed.blank()
        p.count, p.every = len(params.hypotheses), context.every
        p.interval = interval_of(context)
        noise_um = params.sensor_noise_um or assumed_noise(context)
        p.simulates = getattr(params, "prefilter", False)
        variance = 0.0 if p.simulates else noise_um * noise_um * params.assumed_noise_scale
        for i, (_, b1, a1, a2) in enumerate(coefficients_of(params, context)):
            device = params.hypotheses[i].oscillator(context.device)
            _, phi12, _, phi22 = transition(device.mass, device.damping, device.stiffness, context.dt_ms)
            across, back = phi22 / phi12, a2 / phi12
            first, second = -across * a1 - back, -across * a2
            p.across[i], p.back[i], p.pushed[i] = across, back, b1 / phi12
            p.variance_displacement[i] = variance * (a1 * a1 + a2 * a2)
            p.covariance[i] = -variance * (a1 * first + a2 * second)
            p.variance_velocity[i] = variance * (first * first + second * second)
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Follow the voltage; where the bank has judged a sample, show the states of its models."""
        gather(p.interval, s.gathered, x.applied, x.middle, x.end)
        if p.every != 1.0 and int(x.tick) % int(p.every) != 0:
            return
        _, later = weighed_voltages(p.interval, s.gathered)
        z = x.measured if math.isfinite(x.measured) else s.last
        for i in range(int(p.count)):
            displacement = z - x.residual[i]
            before = s.last if p.simulates == 0.0 else s.before[i]
            s.before[i] = flush_tiny(displacement)
            x.state_displacement[i] = displacement
            x.state_velocity[i] = p.across[i] * displacement - p.back[i] * before + p.pushed[i] * later
            x.variance_displacement[i] = p.variance_displacement[i]
            x.covariance[i] = p.covariance[i]
            x.variance_velocity[i] = p.variance_velocity[i]
        s.last = z
