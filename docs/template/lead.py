r"""Lead compensation."""

from __future__ import annotations

from typing import Any

from core.block import Block, BlockParams, Context, Equation, parameter
from core.control.controller import ControllerPorts
from core.elementary import exp
from core.kernel import flush_tiny
from core.ports import tap
from core.record import Record


class Lead(Block):
    r"""Lead compensation of the tracking error, :math:`C(s)=K\frac{1+Ts}{1+\alpha Ts}`.

    Franklin, Powell and Emami-Naeini, Feedback Control of Dynamic Systems, chapter 6. The lag is exact for an error
    that is held over a sample.
    """

    title = "Lead"
    equations = (
        Equation("law", r"u=r+K\left(\frac e\alpha+\Bigl(1-\frac1\alpha\Bigr)w\right),\quad \alpha T\dot w=e-w"),
    )

    class Params(BlockParams):
        """Gain, time and ratio."""

        gain_v_um: float = parameter(-5.0, "gain at rest, K", "V/um", ge=-1e3, le=1e3)
        time_ms: float = parameter(0.1, "time of the lead, T", "ms", gt=1e-6, le=1e3)
        ratio: float = parameter(0.2, "time of the lag over that of the lead", gt=1e-3, le=1)

    class Packed(Record):
        """Remainder of the lag after a sample, and the gains of error and lag."""

        decay: float
        of_error: float
        of_lag: float

    class State(Record):
        """The lag, and the error held over the last sample."""

        lag: float
        error: float

    class Ports(ControllerPorts):
        """The ports of every controller, and the error."""

        error: float = tap("um", "model minus measured displacement")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the lag over a sample, and the gains."""
        p = cls.Packed.blank()
        p.decay = exp(-context.dt_ms / (params.ratio * params.time_ms))
        p.of_error = params.gain_v_um / params.ratio
        p.of_lag = params.gain_v_um - p.of_error
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Advance the lag by the error of the sample that ends now; compute the voltage."""
        s.lag = flush_tiny(p.decay * s.lag + (1.0 - p.decay) * s.error)
        s.error = x.model - x.measured
        x.error = s.error
        x.voltage = x.reference + p.of_error * s.error + p.of_lag * s.lag
