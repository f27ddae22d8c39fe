r"""Kernels that controllers and identifiers estimate with: least squares on half a covariance, state filters.

A covariance is stored as its lower triangle, row by row, so that rounding cannot make it asymmetric.
"""

from __future__ import annotations

from core.device.oscillator import transition, within
from core.kernel import SMALL, flush_tiny, kernel
from core.record import Record, Vector
from core.voltage import Motion, Moves, add_moves

HIGHEST = 1e10
"""Largest trace of a covariance without a limit of its own: the rounding of a larger one outweighs a sample."""


def triangle(n: int) -> int:
    """Return the numbers in the lower triangle of an n by n matrix."""
    return n * (n + 1) // 2


def diagonal(n: int, value: float) -> list[float]:
    """Return the lower triangle of a multiple of the unit matrix."""
    return [value if row == column else 0.0 for row in range(n) for column in range(row + 1)]


@kernel
def entry(row: int, column: int) -> int:
    """Return the place of an element in the lower triangle."""
    return row * (row + 1) // 2 + column if row >= column else column * (column + 1) // 2 + row


class StateFilter(Record):
    r"""Packed :math:`1/(s+\lambda)^2` for an interval: its transition, :math:`2\lambda`, :math:`\lambda^2`, and h."""

    phi11: float
    phi12: float
    phi21: float
    phi22: float
    twice_pole: float
    square: float
    h: float


class DrivenFilter(StateFilter, Moves):
    """A state filter of a voltage, and the effect of one volt more in the middle or at the end than at the start."""


def fill_filter(p: StateFilter, pole: float, h: float) -> None:
    """Pack a state filter."""
    p.phi11, p.phi12, p.phi21, p.phi22 = transition(1.0, 2.0 * pole, pole * pole, h)
    p.twice_pole, p.square, p.h = 2.0 * pole, pole * pole, h


def filter_of(pole: float, h: float) -> StateFilter:
    """Return a state filter."""
    packed = StateFilter.blank()
    fill_filter(packed, pole, h)
    return packed


def driven_filter_of(pole: float, h: float, analogue: bool) -> DrivenFilter:
    """Return a state filter of a voltage."""
    packed = DrivenFilter.blank()
    fill_filter(packed, pole, h)
    effects = within(1.0, 2.0 * pole, pole * pole, h) if analogue else (0.0, 0.0, 0.0, 0.0)
    packed.middle1, packed.middle2, packed.end1, packed.end2 = effects
    return packed


@kernel
def filter_input(p: StateFilter, s: Motion, before: float, now: float) -> None:
    r"""Advance :math:`\ddot q+2\lambda\dot q+\lambda^2q=x` over an interval, exact for an input on a straight line.

    A held input has ``before`` equal to ``now``. For a measured input the line between two samples is right to second
    order; a held one would lag by half a sample.

    Parameters
    ----------
    p : StateFilter
    s : Motion
        q and its derivative.
    before, now : float
        Input at the start and at the end of the interval.
    """
    slope = (now - before) / (p.h * p.square)
    rest = (before - p.twice_pole * slope) / p.square
    q = s.x - rest
    rate = s.v - slope
    s.x = flush_tiny(p.phi11 * q + p.phi12 * rate + rest + slope * p.h)
    s.v = flush_tiny(p.phi21 * q + p.phi22 * rate + slope)


@kernel
def filter_voltage(p: DrivenFilter, s: Motion, u: float, middle: float, end: float) -> None:
    """Advance a state filter under a voltage ``u``, more by ``middle`` and ``end`` in the middle and at the end."""
    filter_input(p, s, u, u)
    add_moves(p, s, middle, end)


@kernel
def filtered_second_derivative(p: StateFilter, s: Motion, now: float) -> float:
    """Return the filtered second derivative of the input."""
    return float(now - p.twice_pole * s.v - p.square * s.x)


@kernel
def trace_of(covariance: Vector, n: int) -> float:
    """Return the trace of a covariance."""
    total = 0.0
    for i in range(n):
        total += covariance[entry(i, i)]
    return total


@kernel
def estimate(
    theta: Vector,
    covariance: Vector,
    regressor: Vector,
    product: Vector,
    n: int,
    error: float,
    noise: float,
    forgetting: float,
    limit: float,
) -> float:
    r"""Update an estimate by one sample of least squares with forgetting, and return its gain :math:`\phi^TP\phi`.

    .. math:: K=\frac{P\phi}{r+\phi^TP\phi},\quad \theta\leftarrow\theta+Ke,\quad
        P\leftarrow\frac{P-K\phi^TP}{\mu}

    so that :math:`P^{-1}\leftarrow\mu(P^{-1}+\phi\phi^T/r)`: with :math:`r=\mu` the usual discrete recursion, with
    :math:`r=m^2\mu/h,\;\mu=e^{-Bh}` the exact sample of the continuous law with rate B and normaliser m. A covariance
    whose trace would grow beyond the limit stays unchanged (Ioannou and Sun, Robust Adaptive Control, 4.3.6): the
    estimate continues to learn, and parameters that are not excited do not wind up.

    Parameters
    ----------
    theta, covariance, regressor, product : vectors
        The estimate, the lower triangle of its covariance, the regressor and n scratch numbers.
    n : int
        Number of parameters.
    error : float
        Measured value minus the prediction of the estimate.
    noise : float
        Variance r of that error, > 0.
    forgetting : float
        Factor mu per sample, in (0, 1].
    limit : float
        Largest trace of the covariance, 0 for `HIGHEST`.
    """
    information = 0.0
    before = 0.0
    lost = 0.0
    row = 0
    for i in range(n):
        total = 0.0
        for j in range(i):
            total += covariance[row + j] * regressor[j]
        at = row + i
        before += abs(covariance[at])
        # the rest of the row is in the column below the diagonal
        for j in range(i, n):
            total += covariance[at] * regressor[j]
            at += j + 1
        product[i] = total
        information += regressor[i] * total
        lost += total * total
        row += i + 1
    inverse = 1.0 / (noise + information)
    for i in range(n):
        theta[i] += product[i] * inverse * error
    after = (before - lost * inverse) / forgetting
    # the sizes, since rounding may have made a large covariance indefinite
    if abs(after) <= max(limit if limit > 0.0 else HIGHEST, before):
        grow = 1.0 / forgetting
        at = 0
        small = False
        for i in range(n):
            gain = product[i] * inverse
            for j in range(i + 1):
                value = (covariance[at] - gain * product[j]) * grow
                small |= abs(value) < SMALL
                covariance[at] = value
                at += 1
        if small:
            for i in range(at):
                covariance[i] = flush_tiny(covariance[i])
    return information


@kernel
def project_onto(theta: Vector, covariance: Vector, n: int, which: int, low: float, high: float) -> None:
    r"""Bring one parameter back into its bounds, and move the others with it by their covariance.

    .. math:: \theta\leftarrow\theta+\frac{Pe_i}{P_{ii}}(\text{bound}-\theta_i)

    The result is the nearest estimate within the bounds in the metric of :math:`P^{-1}`, so the projection never undoes
    the gain of the update.
    """
    value = theta[which]
    missing = min(max(value, low), high) - value
    variance = covariance[entry(which, which)]
    if missing == 0.0:
        return
    if variance > 0.0:
        for i in range(n):
            theta[i] += covariance[entry(i, which)] / variance * missing
    theta[which] = min(max(value, low), high)
