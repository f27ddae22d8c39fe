"""Doppler velocimeter normal to the chip: pulses at the edges of the grating, and their integral."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import TICK, Context, Equation, FloatArray, Port, parameter, settled
from core.noise import key, normal
from core.sense.grating import GratingParams, pack_grating, series
from core.sense.sensor import Sensor

NOISE, KEY, DT, DECAY, GRATING = range(5)
TRUE, VELOCITY, SIGNAL, HEIGHT = range(4)
STARTED, LAST, SUM = range(3)


def doppler_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Read the apparent velocity and integrate it."""
    x = w[io[TRUE]]
    height, slope, _ = series(p, GRATING, x)
    signal = slope * w[io[VELOCITY]] + p[NOISE] * normal(p[KEY], w[TICK])
    if s[STARTED] == 0.0:
        s[STARTED] = 1.0
        s[SUM] = height - p[GRATING]
        s[LAST] = signal
    elif math.isfinite(signal):
        s[SUM] = settled(p[DECAY] * s[SUM] + 0.5 * p[DT] * (s[LAST] + signal))
        s[LAST] = signal
    w[io[SIGNAL]] = signal
    w[io[HEIGHT]] = p[GRATING] + s[SUM]


class Doppler(Sensor):
    r"""Apparent velocity of the surface under a beam normal to the chip (2.2.3), :math:`h'(x)\,\dot x`.

    The beam sees motion along itself, so only the edges of the polysilicon show, as pulses of alternating sign.
    The integral of the pulses is the height under the beam, the same function of displacement as the light through
    the wafer: it has the same ambiguity of direction. Only the height of a pulse tells the speed.

    The integral leaks, since the noise of the velocity would make it wander.
    """

    title = "Doppler velocimeter"
    inputs = (
        Port("true", "um", "true displacement", source="plant.displacement"),
        Port("moving", "um/ms", "true velocity", source="plant.velocity"),
    )
    outputs = (
        Port("velocity", "um/ms", "apparent velocity normal to the chip"),
        Port("height", "um", "its integral: height of the surface under the beam"),
    )
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

        def packed(self, context: Context) -> list[float]:
            """Return the packed grating of the height."""
            amplitudes = [-self.depth_um * a for a in self.shape()]
            mean = self.depth_um * (1.0 - self.opening)
            return pack_grating(mean, self.pitch_um, self.offset(context.seed), amplitudes)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        decay = math.exp(-context.dt_ms / params.leak_ms)
        own = [params.noise_um_ms, key(context.seed, "sensor.doppler"), context.dt_ms, decay]
        return np.array(own + params.packed(context))

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Whether it has run, the velocity of the sample before, the integral."""
        return np.zeros(3)

    step = doppler_step
