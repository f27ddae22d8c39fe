"""Kalman filters side by side: the parts of a bank's step."""

from __future__ import annotations

import math

from core.diagnose.lanes import Filters, PackedFilters
from core.elementary import log
from core.kernel import flush_tiny, kernel, whole
from core.ports import output, tap
from core.record import Vector
from core.voltage import AppliedPorts, ObservedPorts, observed

TAKE_MIDDLE, TAKE_START, TAKE_PARABOLA = 0, 1, 2
"""The voltages a filter may assume over a tick."""
LEAST = 1e-12
"""Smallest residual covariance, as a share of R."""


class BankPorts(ObservedPorts):
    """Ports of every bank."""

    probability: Vector = output("1", "probability of the hypothesis", each="hypotheses")
    residual: Vector = tap("um", "measured minus predicted displacement", each="hypotheses")
    nis: Vector = tap(
        "1", "normalised residual squared, 1 on average for a true and well tuned model", each="hypotheses"
    )
    gain_displacement: Vector = tap("1", "Kalman gain of the displacement", each="hypotheses")
    gain_velocity: Vector = tap("1/ms", "Kalman gain of the velocity", each="hypotheses")


class StatePorts(BankPorts):
    """Ports of a bank whose models each estimate the state: also the corrected states and their covariances."""

    state_displacement: Vector = tap("um", "displacement under the hypothesis", each="hypotheses")
    state_velocity: Vector = tap("um/ms", "velocity under the hypothesis", each="hypotheses")
    variance_displacement: Vector = tap("um^2", "variance of this displacement", each="hypotheses", hidden=True)
    covariance: Vector = tap("um^2/ms", "covariance of displacement and velocity", each="hypotheses", hidden=True)
    variance_velocity: Vector = tap("um^2/ms^2", "variance of this velocity", each="hypotheses", hidden=True)


@kernel
def push(p: PackedFilters, s: Filters, x: AppliedPorts, low: int, high: int) -> float:
    """Write the effect of the voltage of the tick that ends now on the models from ``low`` to ``high``, and return it.

    An analogue drive moves within the tick on the parabola through its start, middle and end, as the plant sees it.
    """
    u = x.middle if p.taken == 0.0 else x.applied
    for i in range(low, high):
        s.pushed1[i] = p.push1[i] * u
        s.pushed2[i] = p.push2[i] * u
    if p.taken == 2.0:
        middle = x.middle - u
        end = x.end - u
        for i in range(low, high):
            s.pushed1[i] += p.middle1[i] * middle + p.end1[i] * end
            s.pushed2[i] += p.middle2[i] * middle + p.end2[i] * end
        u = x.middle
    return u


@kernel
def gauge(p: PackedFilters, s: Filters, u: float) -> None:
    """Keep the mean square of the voltage over the shuttle's own memory.

    A bank that runs every N ticks takes the square of their mean.
    """
    mean = u if p.every == 1.0 else (s.drive_sum + u) / p.every
    s.drive_sum = 0.0
    s.drive_level = flush_tiny(p.memory * s.drive_level + (1.0 - p.memory) * mean * mean)


@kernel
def predicted(p: PackedFilters, s: Filters, i: int) -> tuple[float, float]:
    """Return the state of a model one tick later."""
    x1 = s.x1[i]
    x2 = s.x2[i]
    return (
        p.tick11[i] * x1 + p.tick12[i] * x2 + s.pushed1[i],
        p.tick21[i] * x1 + p.tick22[i] * x2 + s.pushed2[i],
    )


@kernel
def drift(p: PackedFilters, s: Filters, low: int, high: int) -> None:
    """Predict the states of models over a tick, without a correction."""
    for i in range(low, high):
        x1, x2 = predicted(p, s, i)
        s.x1[i] = flush_tiny(x1)
        s.x2[i] = flush_tiny(x2)


@kernel
def between_updates(p: PackedFilters, s: Filters, x: AppliedPorts, low: int, high: int) -> bool:
    """Take the voltage of a tick; return whether a bank that runs every N of them skips this one.

    In that case its states follow the voltage, which changes at every tick: a bank that took it for held at its mean
    would be sure of the wrong model. The models from ``low`` to ``high`` run.
    """
    u = push(p, s, x, low, high)
    between = p.every != 1.0 and int(x.tick) % int(p.every) != 0
    if between:
        s.drive_sum += u
        drift(p, s, low, high)
    else:
        gauge(p, s, u)
    return between


@kernel
def driven(p: PackedFilters, s: Filters) -> bool:
    """Say whether the drive is large enough for residuals to be evidence."""
    return s.drive_level >= p.least_drive


@kernel
def informed(p: PackedFilters, s: Filters, x: ObservedPorts) -> bool:
    """Say whether this sample is evidence: it was measured, and the drive is large enough."""
    return math.isfinite(observed(x)) and driven(p, s)


@kernel
def filter_step(p: PackedFilters, s: Filters, i: int, z: float, first: bool, seen: bool) -> int:
    r"""Predict one filter, unless this is its first sample; correct it, if there is a measurement.

    .. math:: x^-=\Phi x+g,\quad P^-=\Phi P\Phi^T+W

    .. math:: r=z-Hx^-,\quad\psi=HP^-H^T+R,\quad K=P^-H^T/\psi,\quad x=x^-+Kr,\quad P=(I-KH)P^-

    with g the effect of the voltage, and W the covariance that the pseudo-noise since the last sample has caused.

    The conditions are the same for all filters, so the code selects values and does not branch: a loop over the filters
    then compiles to vector instructions. Returns 1 if the residual covariance has changed and its logarithm must be
    renewed.
    """
    printed = p.printed != 0.0
    c11 = s.p11[i]
    c12 = s.p12[i]
    c22 = s.p22[i]
    f11 = p.phi11[i]
    f12 = p.phi12[i]
    f21 = p.phi21[i]
    f22 = p.phi22[i]
    q1 = f11 * c11 + f12 * c12
    q2 = f11 * c12 + f12 * c22
    q3 = f21 * c11 + f22 * c12
    q4 = f21 * c12 + f22 * c22
    c11 = c11 if first else q1 * f11 + q2 * f12 + p.noise11[i]
    c12 = c12 if first else q1 * f21 + q2 * f22 + p.noise12[i]
    c22 = c22 if first else q3 * f21 + q4 * f22 + p.noise22[i]
    total = c11 + p.sensor
    # the text prints psi without R; without assumed noise that psi would go to zero
    psi = max(c11, LEAST * p.sensor) if printed else total
    inverse = 1.0 / psi
    innovation = 1.0 / total if printed else inverse
    k1 = c11 * innovation
    k2 = c12 * innovation
    correct_state(p, s, i, z, first, seen, k1, k2, inverse)
    s.p11[i] = c11 - k1 * c11 if seen else c11
    s.p12[i] = c12 - k1 * c12 if seen else c12
    s.p22[i] = c22 - k2 * c12 if seen else c22
    changed = 1 if psi != s.covariance[i] else 0
    s.covariance[i] = psi
    return changed


@kernel
def correct_state(
    p: PackedFilters,
    s: Filters,
    i: int,
    z: float,
    first: bool,
    seen: bool,
    k1: float,
    k2: float,
    inverse: float,
) -> None:
    """Predict the state of one filter and correct it by a known gain."""
    before1 = s.x1[i]
    before2 = s.x2[i]
    x1, x2 = predicted(p, s, i)
    x1 = before1 if first else x1
    x2 = before2 if first else x2
    residual = flush_tiny(z - x1) if seen else 0.0
    s.x1[i] = flush_tiny(x1 + k1 * residual)
    s.x2[i] = flush_tiny(x2 + k2 * residual)
    s.residual[i] = residual
    s.inverse[i] = inverse
    s.gain1[i] = k1
    s.gain2[i] = k2
    s.nis[i] = residual * residual * inverse


@kernel
def filters_step(p: PackedFilters, s: Filters, x: StatePorts, n: int) -> bool:
    """Predict and correct all filters; show their residuals, the squares over psi, the gains and the states.

    Returns whether a residual covariance has changed, so that its logarithm must be renewed.
    """
    z = observed(x)
    seen = math.isfinite(z)
    first = s.started == 0.0
    s.started = 1.0
    changed = 0
    if p.steady == 0.0:
        for i in range(whole(n)):
            changed += filter_step(p, s, i, z, first, seen)
    else:
        for i in range(n):
            psi = p.psi[i]
            correct_state(p, s, i, z, first, seen, p.gain1[i], p.gain2[i], p.inverse_psi[i])
            changed += 1 if psi != s.covariance[i] else 0
            s.covariance[i] = psi
    residuals = x.residual
    squares = x.nis
    gains1 = x.gain_displacement
    gains2 = x.gain_velocity
    for i in range(n):
        residuals[i] = s.residual[i]
        squares[i] = s.nis[i]
        gains1[i] = s.gain1[i]
        gains2[i] = s.gain2[i]
    show_states(p, s, x, n)
    return changed != 0


@kernel
def show_states(p: PackedFilters, s: Filters, x: StatePorts, n: int) -> None:
    """Show the corrected states and their covariances; steady gains have the covariances of the limit."""
    displacements = x.state_displacement
    velocities = x.state_velocity
    first = x.variance_displacement
    mixed = x.covariance
    second = x.variance_velocity
    steady = p.steady != 0.0
    for i in range(n):
        displacements[i] = s.x1[i]
        velocities[i] = s.x2[i]
        first[i] = p.steady11[i] if steady else s.p11[i]
        mixed[i] = p.steady12[i] if steady else s.p12[i]
        second[i] = p.steady22[i] if steady else s.p22[i]


@kernel
def take_logarithms(s: Filters, n: int) -> None:
    """Store half the logarithm of every residual covariance."""
    for i in range(n):
        s.half_log[i] = 0.5 * log(s.covariance[i])


@kernel
def judge(s: Filters, before: Vector, after: Vector, n: int, evidence: bool) -> float:
    """Add the log-likelihood of each residual to the logarithms ``before``, write ``after``; return the largest."""
    for i in range(whole(n)):
        likelihood = before[i] - (0.5 * s.nis[i] + s.half_log[i])
        after[i] = likelihood if evidence else before[i]
    best = -math.inf
    for i in range(n):
        best = max(best, after[i])
    return best


@kernel
def hand_over(s: Filters, source: int, target: int) -> None:
    """Copy the state and the covariance of one filter to another."""
    s.x1[target] = s.x1[source]
    s.x2[target] = s.x2[source]
    s.p11[target] = s.p11[source]
    s.p12[target] = s.p12[source]
    s.p22[target] = s.p22[source]
