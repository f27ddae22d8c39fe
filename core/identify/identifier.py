r"""Ports, parameters and excitation that all identifiers share.

Displacement is in um, voltage in V and time in units of :math:`1/\omega_0`, the unit of :math:`\theta=[k_p,a_1,a_2]` of
:math:`\ddot y+a_1\dot y+a_2y=k_pu`. Outputs are mass, stiffness and damping over their nominal values; the force per
volt is taken as known.
"""

from __future__ import annotations

import math
from typing import Any, ClassVar

from core.block import Block, BlockParams, Context, Oscillator, Stage, parameter
from core.estimation import triangle
from core.kernel import kernel
from core.ports import output, reads, tap
from core.record import Choice, Record, Vector, vector
from core.theory.persistency import add_outer_product, smallest_eigenvalue
from core.voltage import ObservedPorts

PHYSICAL = ("mass", "stiffness", "damping")
EXCITATION = "smallest eigenvalue of the mean of phi phi' over the last window, less noise"
EXCITATION_RELATIVE = "the same with every component of phi scaled to a unit mean square"
IDENTIFIABLE = "1 while this input tells all parameters apart"
"""Meanings of the excitation taps, for all identifiers and for the monitor."""

DEVICE = Stage("Device", "coefficient", "estimate error_pct")
JUDGED = Stage("Excitation", "phi", "excitation excitation_relative identifiable")
"""Stages behind every estimate."""
MOST = 4
"""Largest number of parameters of an identifier."""
BAD_PCT = 1e4
"""Error shown for an estimate that makes no sense."""


class ExcitationParams(BlockParams):
    """How the excitation is judged."""

    excitation_window_ms: float = parameter(
        20.0, "window of the excitation", "ms", equation="A.9.1", gt=0, le=1e6, live=False
    )
    least_excitation: float = parameter(
        1e-5, "least relative excitation that counts as identifiable", "1", equation="A.9.1", ge=0, le=1
    )


class IdentifierParams(ExcitationParams):
    """Parameters of every identifier."""

    enabled: bool = parameter(True, "estimate; off holds the estimate, and on again trusts it no longer")


class Gram(Record):
    """Samples of the window so far, the sum of their phi phi' (a lower triangle), scratch, and the last verdict."""

    samples: float
    products: Vector = vector(triangle(MOST))
    scratch: Vector = vector(MOST * MOST)
    smallest: float
    relative: float


class IdentifierPorts(ObservedPorts):
    """The voltage and displacement an identifier is given, and the truth its estimate is compared with."""

    mass_scale: float = reads("effects.mass_scale", "1", "true mass over nominal")
    stiffness_scale: float = reads("effects.stiffness_scale", "1", "true stiffness over nominal")
    damping_scale: float = reads("effects.damping_scale", "1", "true damping over nominal")
    drive_gain: float = reads("effects.drive_gain", "1", "voltage at the comb over voltage applied")


class EstimatePorts(IdentifierPorts):
    """Estimate and truth; each kind of identifier names its own coefficients."""

    estimate: Vector = output("1", "estimated mass, stiffness and damping over nominal", labels=PHYSICAL)
    error_pct: float = output("%", "largest relative error of the estimated coefficients")
    truth: Vector = tap("1", "true mass, stiffness and damping over nominal", labels=PHYSICAL)
    coefficient: Vector = tap("mixed", "estimated coefficients")
    coefficient_true: Vector = tap("mixed", "true coefficients")
    residual: float = tap("um", "residual of the estimate")
    excitation: float = tap("mixed", EXCITATION)
    excitation_relative: float = tap("1", EXCITATION_RELATIVE)
    identifiable: float = tap("1", IDENTIFIABLE)


class ExcitationPorts(IdentifierPorts):
    """The excitation alone."""

    excitation: float = output("mixed", EXCITATION)
    excitation_relative: float = output("1", EXCITATION_RELATIVE)
    identifiable: float = output("1", IDENTIFIABLE)


class Identifier(Block):
    """Base of every identifier."""

    every_tick: ClassVar[bool] = True

    class Packed(Record):
        """Samples of a window, least relative excitation, interval in 1/w0, ticks between two updates."""

        window: float
        least_excitation: float
        h: float
        every: Choice

    class State(Record):
        """The window of the excitation."""

        gram: Gram

    Ports = IdentifierPorts

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants without mass, damping or spring."""
        whole = min(device.mass, device.damping, device.stiffness) > 0.0
        return "" if whole else "needs a device with mass, damping and spring"

    @classmethod
    def fill_shared(cls, p: Packed, params: Any, context: Context) -> None:
        """Pack the numbers that every identifier needs."""
        p.window = max(1, round(params.excitation_window_ms / context.dt_ms))
        p.h = context.dt_ms * context.device.natural_frequency
        p.every = context.every


def coefficients(device: Oscillator) -> tuple[float, float, float]:
    """Return kp, a1 and a2 of a device, in um, V and 1/w0; without stators to pull kp is 1."""
    w = device.natural_frequency
    mass = device.mass
    return (device.force / (mass * w * w)) or 1.0, device.damping / (mass * w), device.stiffness / (mass * w * w)


@kernel
def between_updates(p: Identifier.Packed, x: IdentifierPorts) -> bool:
    """Say whether an identifier that runs every N ticks only gathers the voltage of this tick."""
    return bool(p.every != 1.0 and int(x.tick) % int(p.every) != 0)


@kernel
def excite(
    p: Identifier.Packed,
    noise: Vector,
    gram: Gram,
    regressor: Vector,
    n: int,
    x: EstimatePorts | ExcitationPorts,
) -> None:
    """Gather the Gram matrix, and at the end of each window judge it less twice the share that sensor noise adds.

    Noise moves the regressor in every direction without information about the device. If its mean were taken out only
    once, half of the windows would still show some of it. ``noise`` is the lower triangle of the mean noise.
    """
    add_outer_product(gram.products, regressor, n)
    gram.samples += 1.0
    size = n * (n + 1) // 2
    if gram.samples >= p.window:
        for i in range(size):
            gram.products[i] -= 2.0 * gram.samples * noise[i]
        gram.smallest = smallest_eigenvalue(gram.products, gram.scratch, n, False) / gram.samples
        gram.relative = smallest_eigenvalue(gram.products, gram.scratch, n, True)
        gram.samples = 0.0
        for i in range(size):
            gram.products[i] = 0.0
    x.excitation = gram.smallest
    x.excitation_relative = gram.relative
    x.identifiable = 1.0 if gram.relative > p.least_excitation else 0.0


@kernel
def show_truth(x: EstimatePorts) -> None:
    """Write the true mass, stiffness and damping."""
    x.truth[0] = x.mass_scale
    x.truth[1] = x.stiffness_scale
    x.truth[2] = x.damping_scale


@kernel
def worst(theta: Vector, true: Vector, n: int) -> float:
    """Return the largest relative error of n coefficients, %."""
    largest = 0.0
    for i in range(n):
        value = abs(theta[i] / true[i] - 1.0)
        if not math.isfinite(value):
            return BAD_PCT
        largest = max(largest, value)
    return min(100.0 * largest, BAD_PCT)
