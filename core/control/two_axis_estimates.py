"""Data of adaptive controllers of two axes: the desired motion, gains, estimates, and the claim on the rate."""

from __future__ import annotations

from core.control.two_axis import TwoAxisMeasuredPorts
from core.ports import output, tap
from core.record import Record

NOT_EXCITING = (
    "not persistently exciting: with one frequency along both axes, or two that hardly differ, nothing tells the rate "
    "from stiffness and damping; it is not trusted"
)


class HeldTones(Record):
    """Amplitudes, frequencies in turns per ms and in rad per unit of time, by how much a held force is larger.

    Half a sample, the unit of time, a twelfth of the squared sample in that unit, a beat.
    """

    amplitude_x: float
    amplitude_y: float
    cycles_x: float
    cycles_y: float
    omega_x: float
    omega_y: float
    larger_x: float
    larger_y: float
    ahead_ms: float
    unit_ms: float
    ripple: float
    beat_ms: float


class Gains(Record):
    """Gains per sample of stiffness, damping and rate, and the gain of the velocity error."""

    stiffness: float
    damping: float
    rate: float
    velocity: float


class Basis(Record):
    """Whether the motion is exciting; whole beats; errors per change in them; whether a model is in place; factors."""

    exciting: float
    beats_ms: float
    of_stiffness: float
    of_damping: float
    of_rate: float
    cancelled: float
    held: float
    repeats: float


class RateClaim(Record):
    """Begin of these beats; the estimates then; least and most rate; whether a bound is claimed, and its rate."""

    begun_ms: float
    kxy: float
    skew: float
    dxy: float
    omega: float
    least: float
    most: float
    made: float
    bound: float
    of: float


class AxisEstimates(Record):
    """Stiffness, antisymmetric stiffness, damping and rate, per unit of mass; the rate that is read, and its claim."""

    kxx: float
    kxy: float
    kyy: float
    skew: float
    dxx: float
    dxy: float
    dyy: float
    omega: float
    rate: float
    claim: RateClaim


class PackedLaw(Record):
    """The desired motion, gains, bounds of the rate, forces per unit of acceleration, masses, y.

    Factor of the rotation in the law's rate, and the share that the low-pass keeps.
    """

    asked: HeldTones
    gains: Gains
    basis: Basis
    force_x: float
    force_y: float
    mass_x: float
    mass_y: float
    mean_mass: float
    stretch: float
    angular_gain: float
    kept: float


class TwoAxisEstimatePorts(TwoAxisMeasuredPorts):
    """Forces along both axes, the rate, and the other estimates."""

    x: float = output("uN", "force along x this controller asks for")
    y: float = output("uN", "force along y this controller asks for")
    rate: float = output("deg/s", "estimated angular rate")
    trusted: float = output("1", "1 while the bound is at most a quarter of the rate, else 0")
    bound: float = output("deg/s", "most by which a rate that keeps still is misread, by the estimates; 1e6 if unknown")
    error_x: float = tap("um", "displacement along x minus the one asked for")
    error_y: float = tap("um", "displacement along y minus the one asked for")
    kxx: float = tap("N/m", "estimated stiffness along x")
    kxy: float = tap("N/m", "estimated cross stiffness")
    kyy: float = tap("N/m", "estimated stiffness along y")
    skew: float = tap("N/m", "antisymmetric stiffness, which no device has: what sampling leaves over")
    dxx: float = tap("uN ms/um", "estimated damping along x")
    dxy: float = tap("uN ms/um", "estimated cross damping")
    dyy: float = tap("uN ms/um", "estimated damping along y")
    unexciting: float = tap("1", "1 while it drives with frequencies that hardly beat", warning=NOT_EXCITING)
