"""Step."""

from __future__ import annotations

from typing import Any

from core.block import Context, Equation, kernel, parameter
from core.reference.waveform import FIRST, ReferenceParams, Waveform, playing


@kernel
def after(p: Any, t: float) -> float:
    """Zero before the moment, one from it on."""
    return 1.0 if t >= p[FIRST] else 0.0


class StepReference(Waveform):
    r"""Step, :math:`r(t)=r_0+A\,1(t-t_0)`."""

    title = "Step"
    equations = (Equation("reference", r"r(t)=r_0+A\,1(t-t_0)"),)

    class Params(ReferenceParams):
        """Parameters of a step."""

        start_ms: float = parameter(0.0, "moment of the step", "ms", ge=0)

    @classmethod
    def shape_parameters(cls, params: Any, context: Context) -> list[float]:
        """Moment of the step."""
        return [params.start_ms]

    step = playing(after)
