"""Recovery by counting peaks and valleys, with linear interpolation between them."""

from __future__ import annotations

import math
from typing import Any, Literal

from core.block import Context, Equation, parameter
from core.elementary import floor
from core.ports import BlockPorts, reads, tap
from core.record import Record
from core.sense.doppler import Doppler
from core.sense.grating import Grating, level
from core.sense.sensor import (
    ERROR_PORT,
    LAST_PORT,
    RECOVERED_PORT,
    TRUE_PORT,
    Sensor,
    SensorParams,
    begin_at,
    calibrated,
)
from core.sense.through_wafer import ThroughWafer


class PeakValley(Sensor):
    r"""Counts extremes of the light, half a pitch each, and interpolates between them (2.2.2, 2.2.3).

    An extreme of full swing is a fringe and the motion continues; any other extreme is a turn. A turn near a fringe
    extreme looks like a fringe, so the unit loses the direction there: for a sine of 4 um in 4 of 10 positions of the
    grating, with the transient at its start in 9 of 10, at any noise. It is on the bench because the text describes its
    unit no further than this.

    Linear interpolation alone errs by :math:`\tfrac\Lambda2\sqrt{\tfrac1{12}+\tfrac18-\tfrac2{\pi^2}}`, 151 nm at
    4 um.
    """

    title = "Peak and valley counter"
    equations = (
        Equation(
            "displacement",
            r"x=x_0+\frac{\Lambda}{2}\Big(n\pm\frac{|I-I_n|}{|I_{n\pm1}-I_n|}\Big)",
            "2.2.2, 2.2.3 in words",
        ),
    )

    class Params(SensorParams):
        """The counted edges, and the threshold of an extreme."""

        light: Literal["through_wafer", "doppler"] = parameter("through_wafer", "which optical signal it reads")
        hysteresis: float = parameter(0.1, "share of the swing an extreme must be left by", ge=0.01, le=0.9)
        tolerance: float = parameter(0.08, "share of the swing that may lack of a full one", ge=0.001, le=0.9)
        follow: float = parameter(0.1, "share by which the levels follow each extreme", ge=0, le=1)

    class Packed(Grating):
        """The signal over the grating, whether that is the height, and the threshold of an extreme."""

        reads_height: float
        hysteresis: float
        tolerance: float
        follow: float

    class State(Record):
        """Whether it has run and is sure, levels, last extreme, direction, farthest way so far, initial way."""

        started: float
        sure: float
        even: float
        odd: float
        behind: float
        direction: float
        best: float
        rest: float

    class Ports(BlockPorts):
        """Reads two optical signals; writes the displacement recovered from one of them."""

        last: float = LAST_PORT
        light: float = reads("through_wafer.intensity", "1", "light through the wafer")
        height: float = reads("doppler.height", "um", "integrated Doppler signal")
        true: float = TRUE_PORT
        moving: float = reads("@true.velocity", "um/ms", "true velocity, for the verdict only")
        displacement: float = RECOVERED_PORT
        error: float = ERROR_PORT
        extremes: float = tap("1", "fringe extreme last passed, counted from an opening under the beam")
        direction: float = tap("1", "direction it believes in, 0 until the first motion")
        wrong_way: float = tap("1", "1 while that is opposite to the true motion")

    @classmethod
    def _light(cls, params: Any, context: Context) -> ThroughWafer.Params | Doppler.Params:
        """Return the calibrated grating and beam of the signal it reads."""
        if params.light == "doppler":
            return calibrated(context, "doppler", Doppler.Params)
        return calibrated(context, "through_wafer", ThroughWafer.Params)

    @classmethod
    def noise_um(cls, params: Any, context: Context) -> float:
        """Return the error of the linear interpolation."""
        pitch = cls.ambiguity_um(params, context)
        return 0.5 * pitch * math.sqrt(1.0 / 12.0 + 1.0 / 8.0 - 2.0 / math.pi**2)

    @classmethod
    def ambiguity_um(cls, params: Any, context: Context) -> float:
        """Return the pitch of the grating it looks at."""
        return cls._light(params, context).pitch_um

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step, with the grating as calibrated."""
        p = cls._light(params, context).packed(cls.Packed, context)
        p.reads_height = params.light == "doppler"
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Count and interpolate."""
        half = math.pi / p.wave  # half a pitch, from one extreme to the next
        if s.started == 0.0:
            s.started = 1.0
            s.even = level(p, p.offset)
            s.odd = level(p, p.offset + half)
            s.behind = floor((begin_at(x.last) - p.offset) / half)
            s.direction = 1.0
            s.sure = 0.0
            s.rest = -1.0
        value = x.light if p.reads_height == 0.0 else x.height
        if math.isfinite(value):
            # share of the way from the last extreme to the next, 0 to 1 in intensity
            even = s.behind - 2.0 * floor(0.5 * s.behind) == 0.0
            start = s.even if even else s.odd
            end = s.odd if even else s.even
            way = (value - start) / (end - start)
            if s.sure == 0.0:
                # the first change shows the direction
                if s.rest < 0.0:
                    s.rest = way
                if abs(way - s.rest) > p.hysteresis:
                    s.sure = 1.0
                    if way < s.rest:
                        s.behind += 1.0
                        s.direction = -1.0
                        way = 1.0 - way
                    s.best = way
            elif way > s.best:
                s.best = way
            elif way < s.best - p.hysteresis:
                s.behind += s.direction
                if s.best > 1.0 - p.tolerance:
                    # full swing: a fringe extreme, and the motion continues
                    reached = start + s.best * (end - start)
                    if even:
                        s.odd += p.follow * (reached - s.odd)
                    else:
                        s.even += p.follow * (reached - s.even)
                else:
                    s.direction = -s.direction
                way = 1.0 - way
                s.best = way
            if math.isfinite(way):
                way = min(max(way, 0.0), 1.0)
                if s.sure != 0.0 and s.best > 1.0 - p.tolerance and way < s.best:
                    # just past a fringe extreme: the motion is assumed to continue
                    way = 2.0 - way
                x.displacement = p.offset + half * (s.behind + s.direction * way)
        x.error = x.displacement - x.true
        x.extremes = s.behind
        x.direction = s.direction if s.sure != 0.0 else 0.0
        x.wrong_way = 1.0 if s.sure != 0.0 and s.direction * x.moving < 0.0 else 0.0
