"""The device as a controller knows it: its motion over a sample, and the voltage of the model's motion."""

from __future__ import annotations

from typing import Any

from core.block import BlockParams, Context, Oscillator, parameter
from core.control.controller import ControllerPorts
from core.device.oscillator import held, within
from core.kernel import kernel
from core.ports import reads
from core.record import Record
from core.voltage import Tick


class FollowingPorts(ControllerPorts):
    """Ports of a controller that moves the device as the model moves, by the voltage of `followed`."""

    model_velocity: float = reads("model.velocity", "um/ms", "velocity of the model")


class KnownParams(BlockParams):
    """The device that a law is designed for, as factors on the nominal device."""

    mass_ratio: float = parameter(1.0, "mass that the law assumes, over nominal", gt=0.01, le=100)
    stiffness_ratio: float = parameter(1.0, "stiffness that the law assumes, over nominal", gt=0.01, le=100)
    damping_ratio: float = parameter(1.0, "damping that the law assumes, over nominal", gt=0.01, le=100)
    gain_ratio: float = parameter(1.0, "drive gain that the law assumes, over nominal", gt=0.01, le=100)


RATIOS = tuple(KnownParams.model_fields)


def known(params: Any, context: Context) -> Oscillator:
    """Return the device that a law with `KnownParams` is designed for."""
    device = context.device
    return Oscillator(
        mass=device.mass * params.mass_ratio,
        damping=device.damping * params.damping_ratio,
        stiffness=device.stiffness * params.stiffness_ratio,
        force=device.force * params.gain_ratio,
        time_unit_ms=device.time_unit_ms,
    )


class Following(Record):
    r"""Volts per volt of the reference, per velocity and per displacement of the model.

    .. math:: u_m=\frac{m\ddot y_m+\beta\dot y_m+ky_m}{F},\qquad \ddot y_m=\frac{F_mr-\beta_m\dot y_m-k_my_m}{m_m}
    """

    reference: float
    velocity: float
    displacement: float


def over_sample(device: Oscillator, context: Context) -> Tick:
    """Return a device over a sample: its transition, and its motion under a voltage."""
    numbers = device.mass, device.damping, device.stiffness, context.dt_ms
    tick = Tick.zeros()
    tick.phi11, tick.phi12, tick.phi21, tick.phi22, first, second = held(*numbers)
    tick.push1, tick.push2 = first * device.force, second * device.force
    if context.analogue:
        tick.middle1, tick.middle2, tick.end1, tick.end2 = within(*numbers, device.force)
    return tick


def following(device: Oscillator, model: Oscillator) -> Following:
    """Return the weights of the voltage under which a device moves as the model; 0 without any force."""
    found, share = Following.zeros(), device.mass / model.mass
    if device.force != 0.0:
        found.reference = share * model.force / device.force
        found.velocity = (device.damping - share * model.damping) / device.force
        found.displacement = (device.stiffness - share * model.stiffness) / device.force
    return found


@kernel
def followed(p: Following, x: FollowingPorts) -> float:
    """Return the voltage under which the nominal device moves as the model."""
    return p.reference * x.reference + p.velocity * x.model_velocity + p.displacement * x.model
