r"""Two gyroscopes on one frame."""

from __future__ import annotations

from typing import Any

from pydantic import Field, field_validator

from core.block import Context
from core.device.catalogue import device
from core.device.device import Device
from core.errors import InputError
from core.kernel import flush_tiny
from core.plant.gyroscope import EQUATIONS
from core.plant.two_axis_body import TwoAxisBody, TwoAxisMotion, pack_body, push_x, push_y, take
from core.plant.two_axis_motion import advance
from core.plant.two_axis_plant import TwoAxisPlant, TwoAxisPorts, move, start
from core.ports import output, reads
from core.record import Record
from core.units import RAD_MS_PER_DEG_S

USUAL = {"id": "gyro-2-2"}


class GyroscopePair(TwoAxisPlant):
    r"""Two gyroscopes on one frame, which turns and shakes both: the gyroscope of the bench, and a partner.

    Each obeys :math:`M\ddot q+(D+2m_c\Omega S)\dot q+Kq=F` for itself, and only forces can couple them (6.1.4, 6.1.5).
    The partner starts without motion. Faults belong to the first; the environment is common, and the gas damps the
    partner as much as the first.
    """

    title = "Pair of gyroscopes"
    axes = ("x", "y", "partner_x", "partner_y")
    equations = EQUATIONS

    class Params(TwoAxisPlant.Params):
        """The partner, besides start and noise."""

        partner: Device = Field(
            default_factory=lambda: device(USUAL),
            description="the second gyroscope: a name in the catalogue, and values that replace its own",
            json_schema_extra={"unit": "", "live": False, "equation": "6.1.5"},
        )

        @field_validator("partner", mode="before")
        @classmethod
        def _built(cls, value: Any) -> Any:
            """Build the partner as the bench builds its device.

            Raises
            ------
            ValueError
                For a value that is not allowed, or a device with one axis.
            """
            if not isinstance(value, dict):
                return value
            try:
                partner = device({**USUAL, **value})
            except InputError as error:
                raise ValueError(f"{error.field.removeprefix('device.')}: {error.message}") from None
            if partner.two_axes is None:
                raise ValueError(f"{partner.id} has one axis; choose a gyroscope")
            return partner

    class Packed(TwoAxisPlant.Packed):
        """In addition the partner."""

        partner: TwoAxisBody

    class State(Record):
        """Both devices as they are now, with their motion."""

        motion: TwoAxisMotion
        partner: TwoAxisMotion

    class Ports(TwoAxisPorts):
        """In addition the forces on the partner, the effects of the environment on it, and its motion."""

        partner_force_x: float = reads("drive.partner_x.force", "uN", "force on the partner along x")
        partner_middle_x: float = reads("drive.partner_x.middle", "uN", "the same half a sample later")
        partner_end_x: float = reads("drive.partner_x.end", "uN", "the same one sample later")
        partner_force_y: float = reads("drive.partner_y.force", "uN", "force on the partner along y")
        partner_middle_y: float = reads("drive.partner_y.middle", "uN", "the same half a sample later")
        partner_end_y: float = reads("drive.partner_y.end", "uN", "the same one sample later")
        partner_stiffness_scale: float = reads(
            "environment.stiffness_scale", "1", "stiffness over nominal without any fault"
        )
        partner_damping_scale: float = reads("environment.damping_scale", "1", "damping over nominal without any fault")
        partner_x: float = output("um", "true displacement of the partner along x")
        partner_y: float = output("um", "true displacement of the partner along y")
        partner_x_velocity: float = output("um/ms", "true velocity of the partner along x")
        partner_y_velocity: float = output("um/ms", "true velocity of the partner along y")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Any:
        """Pack both devices."""
        p = super().pack(params, context)
        second: Any = params.partner.oscillator()
        pack_body(p.partner, second, context, "plant.partner", thermal_noise=params.thermal_noise)
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Advance both over the interval that ends now; the first tick only sets the start."""
        start(p, x)
        move(p.body, s.motion, x)
        if x.tick == 0.0:
            x.partner_x, x.partner_y, x.partner_x_velocity, x.partner_y_velocity = 0.0, 0.0, 0.0, 0.0
            return
        m = s.partner
        take(p.partner, m, 1.0, x.partner_stiffness_scale, x.partner_damping_scale)
        push_x(m, x.partner_force_x, x.partner_middle_x, x.partner_end_x, x.acceleration)
        push_y(m, x.partner_force_y, x.partner_middle_y, x.partner_end_y, x.acceleration_side)
        m.x, m.y = x.partner_x, x.partner_y
        m.x_velocity, m.y_velocity = x.partner_x_velocity, x.partner_y_velocity
        advance(p.partner, m, x.rate * RAD_MS_PER_DEG_S, x.tick - 1.0)
        x.partner_x, x.partner_y = flush_tiny(m.x), flush_tiny(m.y)
        x.partner_x_velocity, x.partner_y_velocity = flush_tiny(m.x_velocity), flush_tiny(m.y_velocity)
