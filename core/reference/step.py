"""Step."""

from __future__ import annotations

from core.block import Equation, parameter
from core.kernel import kernel
from core.reference.waveform import ReferenceParams, Waveform


class StepReference(Waveform):
    r"""Step, :math:`r(t)=r_0+A\,1(t-t_0)`."""

    title = "Step"
    equations = (Equation("reference", r"r(t)=r_0+A\,1(t-t_0)"),)

    class Params(ReferenceParams):
        """Parameters of a step."""

        start_ms: float = parameter(0.0, "moment of the step", "ms", ge=0)

    class Packed(Waveform.Packed):
        """Moment of the step."""

        start_ms: float

    @staticmethod
    @kernel
    def shape(p: Packed, t: float) -> float:
        """Zero before the moment, one from it on."""
        return 1.0 if t >= p.start_ms else 0.0
