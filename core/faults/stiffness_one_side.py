"""Beam stiffness of one side."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import Context, Equation, FloatArray, Port, parameter
from core.device.frame import Damage
from core.device.geometry import drawn
from core.faults.fault import Fault, FaultParams
from core.faults.structure import STRUCTURE, Bending, effects, packed, structure_step


class StiffnessOneSide(Fault):
    r"""Young's modulus of beams and truss of the side at +y: :math:`k\to k(1+s/2)`, and a rotation with the travel.

    Its stiffness sideways and in rotation is that of the frame of beams with one side stiffer.
    """

    title = "Beam stiffness, one side"
    shows = "beams"
    changes = (
        "stiffness of the suspension, by half the severity, in every plant; stiffness sideways and in rotation, and a "
        "rotation with the travel, in the planar plant only"
    )
    suggested = 0.1
    inputs = STRUCTURE
    outputs = (Port("severity", "1", "added stiffness of one side, share of nominal"),)
    equations = (Equation("effect", r"k_{s,1}\to k_{s,1}(1+s),\quad k=k_{s,1}+k_{s,2}", "1.3.1, 3.1.3.2"),)

    class Params(FaultParams):
        """Severity is a share of the nominal stiffness of the side at +y."""

        severity: float = parameter(0.0, "added stiffness of one side, share of nominal", "1", gt=-0.95, le=20)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack severity, profile and effects."""
        common = super().pack(params, context)
        whole = [0.0] * 9
        if params.severity != 0.0:
            whole = effects(drawn(context), Damage(side_scale=1.0 + params.severity), Bending())
            whole[0] = 0.5 * params.severity
        return np.array(packed(common, 1.0, whole))

    step = structure_step
