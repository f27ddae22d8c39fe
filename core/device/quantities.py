"""Figures that are usually quoted of a device, with the equation of each."""

from __future__ import annotations

from dataclasses import dataclass

from core.block import Equation


@dataclass(frozen=True)
class Quantity:
    """A figure: its name among the metrics of a device, words, unit and equation."""

    name: str
    label: str
    unit: str
    equation: Equation


QUANTITIES = (
    Quantity("mass_kg", "Mass", "kg", Equation("effective mass", r"m=m_s+\tfrac14m_t+\tfrac{12}{35}m_b", "1.3.3")),
    Quantity(
        "stiffness_n_m",
        "Stiffness",
        "N/m",
        Equation(
            "whole suspension",
            r"k=\frac{2Etw^3}{L^3}\,\frac{L_t^2+14\alpha L_tL+36\alpha^2L^2}{4L_t^2+41\alpha L_tL+36\alpha^2L^2},"
            r"\quad\alpha=\left(\frac{w_t}{w}\right)^3",
            "1.3.4",
            printed="the stiffness of one side, with the length of the truss",
            why="it is that of all eight beams, k = 2 k_s, and the length is that between adjacent beams",
        ),
    ),
    Quantity(
        "damping_ns_m",
        "Damping",
        "N s/m",
        Equation(
            "air that shears",
            r"\beta=\mu\left[(A_s+\tfrac12A_t+\tfrac12A_b)\left(\tfrac1d+\tfrac1\delta\right)+\tfrac{A_c}{g}\right]",
            "1.3.7",
            printed=r"\beta=\mu\left[(A_s+\tfrac12A_t+\tfrac12A_b)\left(\tfrac1t+\tfrac1\delta\right)"
            r"+\tfrac{A_c}{g}\right]",
            why="the gap under the plate is the gas film d, not the structural thickness t of 1.3.2; along x the air "
            "shears, it is not squeezed",
        ),
    ),
    Quantity(
        "f0_hz",
        "Resonance",
        "Hz",
        Equation(
            "resonance",
            r"f_0=\frac1{2\pi}\sqrt{k/m}",
            "1.3.5",
            printed=r"\omega_n=\sqrt{k_s/m}",
            why="with the spring of one side alone it comes out lower by the root of two; the number 1.3.5 is also "
            "given to the ratio of the widths",
        ),
    ),
    Quantity("quality_factor", "Quality factor", "1", Equation("quality factor", r"Q=\sqrt{km}/\beta", "1.3.1")),
    Quantity(
        "static_gain_um_per_v",
        "Static gain",
        "um/V",
        Equation("displacement at rest per volt", r"x/v=F/k", "1.3.1"),
    ),
    Quantity(
        "force_n_per_v",
        "Force per volt",
        "N/V",
        Equation(
            "push-pull comb",
            r"F=4n\varepsilon_0\frac tgV_b",
            "1.3.2",
            printed="identical voltages on both stators, t the length of a finger (5.2.1)",
            why="identical stators pull alike and the forces cancel; they stand at plus and minus the bias, and t is "
            "the structural thickness",
        ),
    ),
    Quantity(
        "pull_in_v",
        "Pull-in bias",
        "V",
        Equation(
            "the shuttle turns into its stators by itself",
            r"V_b=\sqrt{\frac{k_\theta g^3}{4n\varepsilon_0t\,(X_r^3-X_s^3)/3}}",
            "3.2.2",
            printed="unstable beyond a third of the gap",
            why="a third holds for a plate with one electrode; a finger stands between two, and the aligned device "
            "turns at a bias without any travel",
        ),
    ),
)
