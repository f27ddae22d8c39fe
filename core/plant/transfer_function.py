"""A plant given by its transfer function, exact between samples."""

from __future__ import annotations

from typing import Any

from core.block import BlockParams, Context, Equation, Oscillator, parameter
from core.device.oscillator import held
from core.kernel import flush_tiny
from core.noise import normal
from core.plant.shuttle import PackedMotion, Shuttle, at_rest_sideways, coefficients
from core.record import Record


class TransferFunctionPlant(Shuttle):
    r"""A plant without units, :math:`a_2\ddot x+a_1\dot x+a_0x=b_0u`: chapter 4 and appendix B.

    Exact for a held drive, whatever the signs: :math:`1/(s-0.2)` grows, :math:`1/s^2` drifts. Faults of mass,
    damping and stiffness multiply :math:`a_2, a_1, a_0`; friction, shorts and sideways faults have nothing to act on.
    """

    title = "Transfer function"
    equations = (
        Equation("plant", r"a_2\ddot x+a_1\dot x+a_0x=b_0u", "4.3.1.1, 4.3.1, B.1.3"),
        Equation("between samples", r"x_{i+1}=\Phi x_i+\Gamma u_i,\quad\Phi=e^{Ah},\;\Gamma=\int_0^he^{A\tau}B\,d\tau"),
    )

    class Params(BlockParams):
        """Starting point and noise."""

        initial_displacement_um: float = parameter(
            0.0, "displacement at the start", "um", ge=-20, le=20, equation="4.3.1", live=False
        )
        initial_velocity_um_ms: float = parameter(0.0, "velocity at the start", "um/ms", live=False)
        drive_noise_v: float = parameter(0.0, "white noise on the drive voltage, rms per sample", "V", ge=0)

    class Packed(PackedMotion):
        """The motion, and the force per volt."""

        force: float

    class State(Record):
        """Coefficients of the transition kept, and the transition."""

        mass: float
        damping: float
        stiffness: float
        phi11: float
        phi12: float
        phi21: float
        phi22: float
        reach: float
        push: float

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse resonators: their force comes from a comb."""
        if device.time_unit_ms > 0.0:
            return ""
        return super().unsuited(device, model) or "this device is a resonator; choose linear"

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        plant = context.device
        p = cls.Packed.blank()
        p.mass = plant.mass
        p.damping = plant.damping
        p.stiffness = plant.stiffness
        p.force = plant.force
        p.dt_ms = context.dt_ms
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Shuttle.Ports) -> None:
        """Advance over the interval that ends now; the first tick only sets the start."""
        at_rest_sideways(x, 0.0)
        if x.tick == 0.0:
            x.displacement = p.initial_displacement_um
            x.velocity = p.initial_velocity_um_ms
            return
        m, b, k = coefficients(p, x)
        if m != s.mass or b != s.damping or k != s.stiffness:
            s.mass, s.damping, s.stiffness = m, b, k
            s.phi11, s.phi12, s.phi21, s.phi22, s.reach, s.push = held(m, b, k, p.dt_ms)
        # the voltage of an analogue generator counts with its mean over the sample
        u = (x.voltage + 4.0 * x.middle + x.end) / 6.0
        if x.middle == x.voltage and x.end == x.voltage:
            u = x.voltage
        u = x.drive_gain * u + x.drive_offset
        if p.drive_noise_v > 0.0:
            u += p.drive_noise_v * normal(p.drive_key, x.tick - 1.0)
        f = p.force * u - m * x.acceleration
        q = x.displacement
        v = x.velocity
        x.displacement = flush_tiny(s.phi11 * q + s.phi12 * v + s.reach * f)
        if m == 0.0:
            v = (f - k * x.displacement) / b
        else:
            v = s.phi21 * q + s.phi22 * v + s.push * f
        x.velocity = flush_tiny(v)
