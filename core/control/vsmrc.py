"""Variable structure model reference control."""

from __future__ import annotations

from typing import Any

from core.block import Block, Context, Equation, Oscillator, Stage, parameter
from core.control.controller import unsuited_order
from core.control.sliding import (
    BOUNDARY_LAYER,
    LAYER_EQUATION,
    SURFACE,
    SwitchingPacked,
    SwitchingParams,
    SwitchingPorts,
    SwitchingState,
    fill_switching,
    switch,
)
from core.control.velocity import velocity
from core.voltage import moves


class Vsmrc(Block):
    r"""Variable structure model reference control, :math:`u=\theta_{nom}^Tw+(c_r|r|+c_y|y|)\,\mathrm{sat}(s/\Phi)`.

    The law does not adapt: it switches with the largest error its gains may have. A boundary layer leaves an offset,
    because within it the switching is a plain gain.
    """

    title = "Variable structure MRC"
    place = 11
    equations = (
        Equation("law", r"u=\theta_{nom}^T[r,y,\dot y]+(c_r|r|+c_y|y|)\,\mathrm{sat}(s/\Phi)", "4.3.1"),
        Equation(
            "surface", r"s=y_m-y\;\text{(first order)},\quad s=g_1(y_m-y)+\dot y_m-\dot y\;\text{(second)}", "4.1"
        ),
        LAYER_EQUATION,
    )
    structure = (
        SURFACE,
        Stage("Nominal gains and bounds", "reference measured velocity", "equivalent switching", ("law",)),
        BOUNDARY_LAYER,
        Stage("Law", "equivalent switching surface", "voltage", ("law",)),
    )

    class Params(SwitchingParams):
        """How much the nominal gains may be wrong by."""

        nominal: bool = parameter(True, "feed the gains that match the nominal device; off leaves all to the switching")
        reference_bound: float = parameter(0.2, "voltage switched per volt of reference, c_r", ge=0, le=100)
        output_bound_v_um: float | None = parameter(
            None, "voltage switched per displacement, c_y; unless given, what holds the device there", "V/um", ge=0
        )

    class Packed(SwitchingPacked):
        """Whether the nominal gains are fed, bounds on their error, order of the plant."""

        nominal: float
        reference_bound: float
        output_bound: float
        second_order: float

    State = SwitchingState
    Ports = SwitchingPorts

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse a model of another kind than the plant."""
        return unsuited_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        device, bound = context.device, params.output_bound_v_um
        if bound is None:
            bound = abs(device.stiffness / device.force) if device.force != 0.0 else 0.0
        p = cls.Packed.blank()
        fill_switching(p, params, context)
        p.output_bound = bound
        p.second_order = device.mass > 0.0
        return p

    @staticmethod
    def step(p: Packed, s: SwitchingState, x: SwitchingPorts) -> None:
        """Match the model with nominal gains, and switch with the bounds on their error."""
        y = x.measured
        r = x.reference
        u, middle, end = moves(x)
        v = velocity(p.velocity, s.velocity, x.velocity, y, u, middle, end) / p.velocity.rate
        e = x.model - y
        surface = e
        if p.second_order != 0.0:
            surface = p.surface_gain * e + x.model_velocity / p.velocity.rate - v
        nominal = p.model.gain * r + (p.plant.a2 - p.model.a2) * y + (p.plant.a1 - p.model.a1) * v
        nominal *= p.nominal / p.plant.gain
        amplitude = p.reference_bound * abs(r) + p.output_bound * abs(y)
        x.voltage = nominal + switch(p, s, x, e, surface, nominal, amplitude, p.plant.gain)
