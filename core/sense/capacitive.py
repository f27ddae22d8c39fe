"""Capacitive displacement sensor: two combs, difference and sum."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import Context, Equation, parameter
from core.device.geometry import drawn
from core.kernel import kernel
from core.noise import normal
from core.ports import BlockPorts, output, reads, tap
from core.record import Record, stream
from core.sense.sensor import TRUE_PORT, Sensor, SensorParams
from core.units import FF_PER_F, UM_PER_M

NODES = np.array([-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831, 0.9061798459386640])
WEIGHTS = np.array([0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665, 0.2369268850561891])


@kernel
def squeezed(p: Capacitive.Packed, side: float, overlap: float, y: float, theta: float) -> float:
    r"""Return the overlap a straight comb would need for the capacitance of a shifted and turned one.

    :math:`\int\frac{d\xi}{1-(\eta/g)^2},\;\eta=y+\theta\xi`, five-point Gauss; contact counts as 0.999 of the gap.
    """
    if y == 0.0 and theta == 0.0:
        return overlap
    half = 0.5 * overlap
    total = 0.0
    for i in range(5):
        xi = side * (p.start + half * (1.0 + NODES[i]))
        u = (y + theta * xi) / p.gap
        total += WEIGHTS[i] / (1.0 - min(u * u, 0.998))
    return half * total


class Capacitive(Sensor):
    r"""Difference of two comb capacitances (2.2.1.1-2), :math:`C_{sp,sn}=C_{s0}\pm\frac{\partial C_s}{\partial x}x`.

    Exact for an ideal comb. The sum does not depend on the displacement; it depends on motions that narrow gaps on one
    side, :math:`C\propto\int\frac{d\xi}{g-\eta}+\frac{d\xi}{g+\eta},\;\eta=y+\theta\xi`: lateral motion and rotation,
    which no displacement sensor shows.
    """

    title = "Capacitive sensor"
    equations = (
        Equation(
            "capacitances",
            r"C_{sp}=C_{s0}+\tfrac{\partial C_s}{\partial x}x,\;C_{sn}=C_{s0}-\tfrac{\partial C_s}"
            r"{\partial x}x",
            "2.2.1.1-2",
        ),
        Equation("displacement", r"z=\frac{C_{sp}-C_{sn}}{2\,\partial C_s/\partial x}"),
        Equation("sum", r"C_{sp}+C_{sn}=n\varepsilon_0t\oint\left[\frac{1}{g-\eta}+\frac{1}{g+\eta}\right]d\xi"),
    )

    class Params(SensorParams):
        """Combs and readout."""

        overlap_um: float | None = parameter(
            None, "undeflected overlap of the fingers; the device's own unless given", "um", gt=0, le=1000
        )
        gap_um: float | None = parameter(
            None,
            "gap between the fingers, the capacitance is proportional to one over it; the device's own unless given",
            "um",
            gt=0,
            le=100,
        )
        comb_start_um: float | None = parameter(
            None, "where the overlap begins, from the centre; as drawn unless given", "um", ge=0, le=1e4
        )
        noise_af_rthz: float = parameter(
            0.1, "noise density of the difference (assumed)", "aF/rtHz", ge=0, le=1e6, equation="2.2.1"
        )

    class Packed(Record):
        """Both combs and their noise, in um and fF: slope, overlap, gap, where the overlap begins, noise of each."""

        gradient: float
        overlap: float
        gap: float
        start: float
        noise: float
        positive_key: float = stream("sensor.capacitive.positive")
        negative_key: float = stream("sensor.capacitive.negative")

    class Ports(BlockPorts):
        """Reads the motion in the plane; writes capacitances and displacement."""

        sensed: float = reads("plant.displacement", "um", "displacement of the combs")
        true: float = TRUE_PORT
        lateral: float = reads("plant.shift?", "um", "true lateral displacement, where the plant has one")
        rotation: float = reads("plant.rotation?", "mrad", "true rotation, where the plant has one")
        displacement: float = output("um", "measured displacement")
        sum: float = output("fF", "sum of both capacitances: sees lateral motion and rotation")
        positive: float = tap("fF", "capacitance of the comb that closes towards +x")
        negative: float = tap("fF", "capacitance of the opposite comb")
        error: float = tap("um", "measured minus true displacement")

    @classmethod
    def noise_ff(cls, params: Any, context: Context) -> float:
        """Return the standard deviation of the difference in one sample, white up to half the sample rate."""
        return float(params.noise_af_rthz * 1e-3 * math.sqrt(500.0 / context.dt_ms))

    @classmethod
    def _gap_um(cls, params: Any, context: Context) -> float:
        """Return the gap between the fingers of the sensing combs."""
        return drawn(context).gap_um if params.gap_um is None else float(params.gap_um)

    @classmethod
    def _gradient(cls, params: Any, context: Context) -> float:
        r"""Return :math:`\partial C_s/\partial x` of one comb, fF/um: the device's, scaled by one over the gap."""
        nominal = context.capacitance_gradient * FF_PER_F / UM_PER_M
        return nominal * (drawn(context).gap_um / cls._gap_um(params, context))

    @classmethod
    def noise_um(cls, params: Any, context: Context) -> float:
        """Return the noise of the difference as displacement."""
        gradient = cls._gradient(params, context)
        return cls.noise_ff(params, context) / (2.0 * gradient) if gradient else 0.0

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step: fF and um; each comb carries half the variance of the difference."""
        comb = drawn(context)
        p = cls.Packed.blank()
        p.gradient = cls._gradient(params, context)
        p.overlap = comb.overlap_um if params.overlap_um is None else params.overlap_um
        p.gap = cls._gap_um(params, context)
        p.start = comb.stator_tip_um if params.comb_start_um is None else params.comb_start_um
        p.noise = cls.noise_ff(params, context) / math.sqrt(2.0)
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Read both combs; displacement from the difference."""
        displacement = x.sensed
        y = x.lateral
        theta = 1e-3 * x.rotation
        positive = p.gradient * squeezed(p, 1.0, p.overlap + displacement, y, theta)
        positive += p.noise * normal(p.positive_key, x.tick)
        negative = p.gradient * squeezed(p, -1.0, p.overlap - displacement, y, theta)
        negative += p.noise * normal(p.negative_key, x.tick)
        z = (positive - negative) / (2.0 * p.gradient) if p.gradient != 0.0 else 0.0
        x.displacement = z
        x.sum = positive + negative
        x.positive = positive
        x.negative = negative
        x.error = z - x.true
