"""Recovery by counting peaks and valleys, with linear interpolation between them."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np

from core.block import Context, Equation, FloatArray, Port, parameter
from core.sense.doppler import Doppler
from core.sense.grating import OFFSET, WAVE, level
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

SOURCE, HYSTERESIS, TOLERANCE, FOLLOW, GRATING = range(5)
LAST, LIGHT, HEIGHT, TRUE, MOVING, DISPLACEMENT, ERROR, EXTREMES, DIRECTION, WRONG_WAY = range(10)
STARTED, SURE, EVEN, ODD, BEHIND, SENSE, BEST, REST = range(8)


def peak_valley_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Count and interpolate."""
    half = math.pi / p[GRATING + WAVE]  # half a pitch, from one extreme to the next
    if s[STARTED] == 0.0:
        s[STARTED] = 1.0
        s[EVEN] = level(p, GRATING, p[GRATING + OFFSET])
        s[ODD] = level(p, GRATING, p[GRATING + OFFSET] + half)
        s[BEHIND] = math.floor((begin_at(w[io[LAST]]) - p[GRATING + OFFSET]) / half)
        s[SENSE] = 1.0
        s[SURE] = 0.0
        s[REST] = -1.0
    value = w[io[LIGHT]] if p[SOURCE] == 0.0 else w[io[HEIGHT]]
    if math.isfinite(value):
        # way made from the extreme behind to the one ahead, 0 to 1 in intensity
        even = s[BEHIND] - 2.0 * math.floor(0.5 * s[BEHIND]) == 0.0
        start = s[EVEN] if even else s[ODD]
        end = s[ODD] if even else s[EVEN]
        way = (value - start) / (end - start)
        if s[SURE] == 0.0:
            # the first change says which way it goes
            if s[REST] < 0.0:
                s[REST] = way
            if abs(way - s[REST]) > p[HYSTERESIS]:
                s[SURE] = 1.0
                if way < s[REST]:
                    s[BEHIND] += 1.0
                    s[SENSE] = -1.0
                    way = 1.0 - way
                s[BEST] = way
        elif way > s[BEST]:
            s[BEST] = way
        elif way < s[BEST] - p[HYSTERESIS]:
            s[BEHIND] += s[SENSE]
            if s[BEST] > 1.0 - p[TOLERANCE]:
                # full swing: a fringe extreme, and the motion goes on
                reached = start + s[BEST] * (end - start)
                if even:
                    s[ODD] += p[FOLLOW] * (reached - s[ODD])
                else:
                    s[EVEN] += p[FOLLOW] * (reached - s[EVEN])
            else:
                s[SENSE] = -s[SENSE]
            way = 1.0 - way
            s[BEST] = way
        if math.isfinite(way):
            way = min(max(way, 0.0), 1.0)
            if s[SURE] != 0.0 and s[BEST] > 1.0 - p[TOLERANCE] and way < s[BEST]:
                # past a fringe extreme, if only just: the motion is taken to go on
                way = 2.0 - way
            w[io[DISPLACEMENT]] = p[GRATING + OFFSET] + half * (s[BEHIND] + s[SENSE] * way)
    w[io[ERROR]] = w[io[DISPLACEMENT]] - w[io[TRUE]]
    w[io[EXTREMES]] = s[BEHIND]
    w[io[DIRECTION]] = s[SENSE] if s[SURE] != 0.0 else 0.0
    w[io[WRONG_WAY]] = 1.0 if s[SURE] != 0.0 and s[SENSE] * w[io[MOVING]] < 0.0 else 0.0


class PeakValley(Sensor):
    r"""Counts extremes of the light, half a pitch each, and interpolates between them (2.2.2, 2.2.3).

    An extreme of full swing is a fringe and the motion goes on; one that is not is a turn. A turn near a fringe
    extreme looks like a fringe, so the direction gets lost there: for a sine of 4 um in 4 of 10 positions of the
    grating, with the transient at its start in 9 of 10, whatever the noise. It is shown because the text has no more
    than this to say of its unit.

    Linear interpolation alone errs by :math:`\tfrac\Lambda2\sqrt{\tfrac1{12}+\tfrac18-\tfrac2{\pi^2}}`, 151 nm at
    4 um.
    """

    title = "Peak and valley counter"
    inputs = (
        LAST_PORT,
        Port("light", "1", "light through the wafer", source="through_wafer.intensity"),
        Port("height", "um", "integrated Doppler signal", source="doppler.height"),
        TRUE_PORT,
        Port("moving", "um/ms", "true velocity, for the verdict only", source="plant.velocity"),
    )
    outputs = (RECOVERED_PORT,)
    taps = (
        ERROR_PORT,
        Port("extremes", "1", "fringe extreme last passed, counted from an opening under the beam"),
        Port("direction", "1", "direction it believes in, 0 until the first motion"),
        Port("wrong_way", "1", "1 while that is opposite to the true motion"),
    )
    equations = (
        Equation(
            "displacement",
            r"x=x_0+\frac{\Lambda}{2}\Big(n\pm\frac{|I-I_n|}{|I_{n\pm1}-I_n|}\Big)",
            "2.2.2, 2.2.3 in words",
        ),
    )

    class Params(SensorParams):
        """What it counts, and what it calls an extreme."""

        light: Literal["through_wafer", "doppler"] = parameter("through_wafer", "which optical signal it reads")
        hysteresis: float = parameter(0.1, "share of the swing an extreme must be left by", ge=0.01, le=0.9)
        tolerance: float = parameter(0.08, "share of the swing that may lack of a full one", ge=0.001, le=0.9)
        follow: float = parameter(0.1, "share by which the levels follow each extreme", ge=0, le=1)

    @classmethod
    def _light(cls, params: Any, context: Context) -> ThroughWafer.Params | Doppler.Params:
        """Return the grating and the beam of the signal it reads, as calibrated."""
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
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step, with the grating as calibrated."""
        own = [params.light == "doppler", params.hysteresis, params.tolerance, params.follow]
        return np.array([*own, *cls._light(params, context).packed(context)])

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Whether it has run and is sure, levels, extreme behind, direction, best way made, way at rest."""
        return np.zeros(8)

    step = peak_valley_step
