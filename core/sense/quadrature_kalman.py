"""Recovery from two beams with a Kalman filter that knows the device and the voltage."""

from __future__ import annotations

import math
from typing import Any

from core.block import Context, Equation
from core.elementary import floor
from core.ports import BlockPorts, reads, tap
from core.record import Record
from core.sense.dual_beam import DualBeam
from core.sense.quadrature import QuadratureSensor
from core.sense.sensor import (
    ERROR_PORT,
    LAST_PORT,
    RECOVERED_PORT,
    SLIPS_PORT,
    TRUE_PORT,
    begin_at,
    calibrated,
    slips,
)
from core.sense.tracker import (
    MOTION,
    Filter,
    Tracked,
    Tracker,
    TrackerParams,
    between_updates,
    correct,
    model_of,
    predict,
    put_at_rest,
)
from core.voltage import AppliedPorts, Gathered


class PhasePorts(BlockPorts):
    """Where to take over, and the phase."""

    last: float = LAST_PORT
    turn: float = reads("quadrature.turn", "1", "phase of the pair, in turns")


class QuadratureKalman(Tracker):
    r"""The phase of two beams through a Kalman filter on :math:`(x,\dot x,f)`, unwrapped about its prediction (6.3).

    The filter knows the nominal device and the voltage; the slow force :math:`f` takes up the errors of the model.
    """

    title = "Quadrature with Kalman filter"
    equations = (
        MOTION,
        Equation(
            "residual", r"r=\Lambda\left\langle\frac{\varphi}{2\pi}-\frac{x^--x_0}{\Lambda}\right\rangle_{\pm1/2}"
        ),
    )

    class Params(TrackerParams):
        """Its assumptions about the shuttle."""

    class Packed(Record):
        """Pitch and offset of the grating, variance of the phase as displacement, the model."""

        pitch: float
        offset: float
        noise: float
        model: Tracked

    class State(Record):
        """Whether it has run, the filter, the voltage."""

        started: float
        filter: Filter
        drive: Gathered

    class Ports(PhasePorts, AppliedPorts):
        """Reads the phase and the voltage; writes the displacement."""

        true: float = TRUE_PORT
        displacement: float = RECOVERED_PORT
        error: float = ERROR_PORT
        residual: float = tap("um", "phase, as displacement, minus prediction")
        slips: float = SLIPS_PORT

    @classmethod
    def noise_um(cls, params: Any, context: Context) -> float:
        """Return the noise of the phase as displacement; the filter's own error is smaller but not white."""
        return QuadratureSensor.noise_um(calibrated(context, "quadrature", QuadratureSensor.Params), context)

    @classmethod
    def ambiguity_um(cls, params: Any, context: Context) -> float:
        """Return the pitch of the grating it looks at."""
        return calibrated(context, "dual_beam", DualBeam.Params).pitch_um

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        pair = calibrated(context, "dual_beam", DualBeam.Params)
        noise = max(cls.noise_um(params, context), 1e-6)
        p = cls.Packed.blank()
        p.pitch, p.offset = pair.pitch_um, pair.offset(context.seed)
        p.noise = noise * noise
        p.model = model_of(params, context)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Whether it has run, the filter, no voltage yet."""
        s = cls.State.zeros()
        put_at_rest(s.filter, params, context)
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Predict, unwrap the phase about the prediction, correct."""
        if between_updates(p.model, s.drive, x):
            return
        if s.started == 0.0:
            s.started = 1.0
            s.filter.x = begin_at(x.last)
        else:
            predict(p.model, s.filter, s.drive)
        s.drive.begun = 0.0
        ahead = (s.filter.x - p.offset) / p.pitch - x.turn
        residual = p.pitch * (floor(ahead + 0.5) - ahead) if math.isfinite(ahead) else 0.0
        correct(s.filter, residual, 1.0, p.noise)
        error = s.filter.x - x.true
        x.displacement = s.filter.x
        x.error = error
        x.residual = residual
        x.slips = slips(error, p.pitch)
