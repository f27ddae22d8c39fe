"""Excitation monitor."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from core.block import Context, Equation, FloatArray, Port
from core.identify.filtered import GRAM, NOISE, PHI, Filtered, FilterParams, gathers, observe
from core.identify.identifier import EXCITATION, OWN_PORT, excite

FIRST = OWN_PORT


def excitation_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Filter, and judge the regressor window by window."""
    if gathers(p, s, w, io):
        return
    observe(p, s, w, io)
    excite(p, NOISE, s, GRAM, PHI, 3, w, io, FIRST)


class Excitation(Filtered):
    r"""Says whether this input tells mass, stiffness and damping apart (A.9).

    .. math:: \alpha_1=\lambda_{min}\Big(\frac1\delta\int_{t-\delta}^t\varphi\varphi^T\,d\tau\Big),\quad
        \varphi=\frac1{(s+\lambda)^2}[u,-\dot y,-y]^T

    Three parameters need three directions: a constant gives one and a tone two, so a step and a single tone are
    flagged, two tones just pass and four pass well. A transient counts, so the first window after a change passes too.
    Noise of the sensor does not: what it adds to the mean is taken out.
    """

    title = "Excitation monitor"
    outputs: ClassVar[tuple[Port, ...]] = EXCITATION
    taps: ClassVar[tuple[Port, ...]] = ()
    equations = (
        Equation(
            "persistent excitation",
            r"\alpha_2I\ge\int_{t}^{t+\delta}\varphi\varphi^T\,d\tau\ge\alpha_1I",
            "A.9.1",
        ),
    )

    class Params(FilterParams):
        """Window, threshold and filters."""

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        return np.array(cls.filters(params, context))

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Start with filters at rest."""
        return cls.begin(params, context)

    step = excitation_step
