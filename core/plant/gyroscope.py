r"""Vibrating gyroscope: one mass on two axes of a plane that turns."""

from __future__ import annotations

from core.block import Equation
from core.plant.two_axis_body import TwoAxisMotion
from core.plant.two_axis_plant import TwoAxisPlant, TwoAxisPorts, move, start
from core.record import Record

EQUATIONS = (
    Equation("motion", r"M\ddot q+(D+2m_c\Omega S)\dot q+Kq=F,\quad S=\begin{bmatrix}0&-1\\1&0\end{bmatrix}", "6.1"),
    Equation(
        "imperfections",
        r"k_{xx}=k_1\cos^2\alpha+k_2\sin^2\alpha,\;k_{xy}=(k_1-k_2)\sin\alpha\cos\alpha,\;"
        r"k_{yy}=k_1\sin^2\alpha+k_2\cos^2\alpha;\quad d_{ij}\text{ alike with }\gamma",
        "6.1.3",
        printed=r"\text{6.1.5: anisoelasticity and anisoinertia angles}",
        why="6.1.3 gives the second angle to the damping; no inertia is turned, so the word is read as gamma",
    ),
    Equation(
        "units of 1/w0",
        r"\frac{k}{m\omega_0^2}=355.3,\,532.9,\,70.99,\quad\frac{d}{m\omega_0}=0.01,\,0.002,\quad"
        r"\omega_0=1000\,\mathrm{rad/s}",
        "device gyro-a",
        printed=r"\omega_0=1\,\mathrm{kHz}",
        why="the set of the literature follows from m, K and D with 1000 rad/s; 1 kHz makes the stiffness 39.5 times "
        "smaller",
    ),
    Equation("series", r"q(t)=\sum_na_n(t/h)^n,\quad\Omega\text{ and, when held, }F\text{ constant over a sample}"),
    Equation("thermal force", r"S_F=2k_BTD\ \text{(two-sided matrix)}"),
    Equation(
        "line of oscillation", r"\tan2\theta=\frac{2(xy+\dot x\dot y/\omega^2)}{x^2-y^2+(\dot x^2-\dot y^2)/\omega^2}"
    ),
)


class Gyroscope(TwoAxisPlant):
    r"""A mass on two axes of a plane that turns: quadrature, cross damping, unequal axes, thermal noise.

    .. math:: M\ddot q+(D+2m_c\Omega S)\dot q+Kq=F,\quad q=(x,y)

    Exact to rounding for a held force and for a force that is a parabola over a sample, with the rate held. The forces
    of :math:`\dot\Omega` and :math:`\Omega^2` are left out, as in the text: relative to the elastic force they are
    smaller by :math:`\dot\Omega/\omega^2` and :math:`\Omega^2/\omega^2`, the latter 9e-9 for 100 deg/s at 3 kHz.
    """

    title = "Gyroscope"
    axes = ("x", "y")
    equations = EQUATIONS

    class State(Record):
        """The device as it is now, with its motion."""

        motion: TwoAxisMotion

    class Ports(TwoAxisPorts):
        """The ports of a gyroscope."""

    @staticmethod
    def step(p: TwoAxisPlant.Packed, s: State, x: Ports) -> None:
        """Advance over the interval that ends now; the first tick only sets the start."""
        start(p, x)
        move(p.body, s.motion, x)
