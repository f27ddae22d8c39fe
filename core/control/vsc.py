"""Variable structure control with the gains of the nominal device."""

from __future__ import annotations

from typing import Any

from core.block import Block, Context, Equation, Oscillator, Stage
from core.control.controller import unsuited_second_order
from core.control.sliding import (
    BOUNDARY_LAYER,
    GAINS_EQUATION,
    LAYER_EQUATION,
    SURFACE,
    SURFACE_EQUATION,
    SlidingPacked,
    SlidingParams,
    SwitchingPorts,
    SwitchingState,
    fill_sliding,
    slide,
)
from core.control.velocity import velocity
from core.voltage import moves


class Vsc(Block):
    r"""Variable structure control with fixed gains, :math:`u=u_{eq}+\rho M\,\mathrm{sat}(s/\Phi)`.

    The gains belong to the nominal device. If the true device needs more than they allow for, the law does not reach
    the surface; the self-tuning law exists for that case.
    """

    title = "Variable structure control"
    place = 9
    equations = (
        Equation("law", r"u=u_{eq}+\rho M\,\mathrm{sat}(s/\Phi),\quad M=\sum|K_{e,i}e_i|+|K_{p,i}x_i|+|K_mr|", "3.2.4"),
        SURFACE_EQUATION,
        GAINS_EQUATION,
        LAYER_EQUATION,
    )
    structure = (
        SURFACE,
        Stage("Equivalent control", "error measured velocity reference", "equivalent switching", ("gains",)),
        BOUNDARY_LAYER,
        Stage("Law", "equivalent switching surface", "voltage", ("law",)),
    )
    Params = SlidingParams
    Packed = SlidingPacked
    State = SwitchingState
    Ports = SwitchingPorts

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants and models that are not of second order."""
        return unsuited_second_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> SlidingPacked:
        """Pack the parameters for the step."""
        p = SlidingPacked.blank()
        fill_sliding(p, params, context)
        return p

    @staticmethod
    def step(p: SlidingPacked, s: SwitchingState, x: SwitchingPorts) -> None:
        """Slide with the nominal coefficients."""
        y = x.measured
        u, middle, end = moves(x)
        v = velocity(p.velocity, s.velocity, x.velocity, y, u, middle, end) / p.velocity.rate
        x.voltage = slide(p, s, x, y, v, p.plant.a1, p.plant.a2, p.plant.gain, 0.0, False)
