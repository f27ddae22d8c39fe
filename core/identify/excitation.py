"""Excitation monitor."""

from __future__ import annotations

from core.block import Equation, Stage
from core.identify.filtered import Filtered, N, RegressorFilterParams, follow_voltage, observe
from core.identify.identifier import ExcitationPorts, between_updates, excite


class Excitation(Filtered):
    r"""Measures whether this input separates mass, stiffness and damping (A.9).

    .. math:: \alpha_1=\lambda_{min}\Big(\frac1\delta\int_{t-\delta}^t\varphi\varphi^T\,d\tau\Big),\quad
        \varphi=\frac1{(s+\lambda)^2}[u,-\dot y,-y]^T

    Three parameters need three directions: a constant gives one and a tone two, so a step and a single tone are
    flagged, two tones just pass and four pass well. A transient counts, so the first window after a change passes too.
    Sensor noise does not count: its contribution to the mean is taken out.
    """

    title = "Excitation monitor"
    equations = (
        Equation(
            "persistent excitation",
            r"\alpha_2I\ge\int_{t}^{t+\delta}\varphi\varphi^T\,d\tau\ge\alpha_1I",
            "A.9.1",
        ),
    )
    structure = (
        Stage("Filters", "applied measured", "phi"),
        Stage("Windows", "phi", "excitation excitation_relative identifiable", ("persistent excitation",)),
    )

    class Params(RegressorFilterParams):
        """Window, threshold and filters."""

    Ports = ExcitationPorts

    @staticmethod
    def step(p: Filtered.Packed, s: Filtered.State, x: ExcitationPorts) -> None:
        """Filter, and judge the regressor window by window."""
        follow_voltage(p, s, x)
        if between_updates(p, x):
            return
        observe(p, s, x)
        excite(p, p.noise, s.gram, s.phi, N, x)
