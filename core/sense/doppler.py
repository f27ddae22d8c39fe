"""Doppler velocimeter normal to the chip: pulses at the edges of the grating, and their integral."""

from __future__ import annotations

import math
from typing import Any

from core.block import Context, Equation, parameter
from core.elementary import exp
from core.kernel import flush_tiny
from core.noise import normal
from core.ports import BlockPorts, output, reads
from core.record import Record, stream
from core.sense.grating import G, Grating, GratingParams, pack_grating, series
from core.sense.sensor import Sensor


class Doppler(Sensor):
    r"""Apparent velocity of the surface under a beam normal to the chip (2.2.3), :math:`h'(x)\,\dot x`.

    The beam measures motion along itself, so only the edges of the polysilicon show, as pulses of alternating sign. The
    integral of the pulses is the height under the beam, the same function of displacement as the light through the
    wafer: it has the same ambiguity of direction. Only the height of a pulse depends on the speed.

    The integral leaks, since the noise of the velocity would make it wander.
    """

    title = "Doppler velocimeter"
    equations = (
        Equation("signal", r"v_\perp=h'(x)\,\dot x+v", "2.2.3.1 in words"),
        Equation("height", r"h(x)=d\,(1-o(x))=\int v_\perp\,dt"),
    )

    class Params(GratingParams):
        """Grating, beam and velocimeter."""

        depth_um: float = parameter(2.0, "height of the bars, the structural thickness", "um", gt=0, le=1000)
        noise_um_ms: float = parameter(
            0.1, "standard deviation of the velocity of a sample (assumed)", "um/ms", ge=0, le=1e4
        )
        leak_ms: float = parameter(20.0, "time constant of the integral", "ms", gt=0, le=1e6)

        def packed(self, kind: type[G], context: Context) -> G:
            """Return the packed grating of the height; all other fields of the record are blank."""
            amplitudes = [-self.depth_um * a for a in self.shape()]
            mean = self.depth_um * (1.0 - self.opening)
            return pack_grating(kind, mean, self.pitch_um, self.offset(context.seed), amplitudes)

    class Packed(Grating):
        """The height over the grating, the noise and its stream, sample interval, share of the integral kept."""

        noise_um_ms: float
        key: float = stream("sensor.doppler")
        dt_ms: float
        decay: float

    class State(Record):
        """Whether it has run, the velocity of the last sample, the integral."""

        started: float
        last: float
        integral: float

    class Ports(BlockPorts):
        """Reads the motion; writes the apparent velocity and the height."""

        true: float = reads("plant.displacement", "um", "true displacement")
        moving: float = reads("plant.velocity", "um/ms", "true velocity")
        velocity: float = output("um/ms", "apparent velocity normal to the chip")
        height: float = output("um", "its integral: height of the surface under the beam")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p: Doppler.Packed = params.packed(cls.Packed, context)
        p.dt_ms = context.dt_ms
        p.decay = exp(-context.dt_ms / params.leak_ms)
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Read the apparent velocity and integrate it."""
        height, slope, _ = series(p, x.true)
        signal = slope * x.moving + p.noise_um_ms * normal(p.key, x.tick)
        if s.started == 0.0:
            s.started = 1.0
            s.integral = height - p.mean
            s.last = signal
        elif math.isfinite(signal):
            s.integral = flush_tiny(p.decay * s.integral + 0.5 * p.dt_ms * (s.last + signal))
            s.last = signal
        x.velocity = signal
        x.height = p.mean + s.integral
