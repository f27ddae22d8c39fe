"""Figures that are usually quoted of a device, with the equation of each."""

from __future__ import annotations

from dataclasses import dataclass

from core.block import Equation


@dataclass(frozen=True)
class DeviceFigure:
    """A figure: its name among the metrics of a device, words, unit and equation."""

    name: str
    label: str
    unit: str
    equation: Equation


QUANTITIES = (
    DeviceFigure("mass_kg", "Mass", "kg", Equation("effective mass", r"m=m_s+\tfrac14m_t+\tfrac{12}{35}m_b", "1.3.3")),
    DeviceFigure(
        "stiffness_n_m",
        "Stiffness",
        "N/m",
        Equation(
            "whole suspension",
            r"k=\frac{2Etw^3}{L^3}\,\frac{L_t^2+14\alpha L_tL+36\alpha^2L^2}{4L_t^2+41\alpha L_tL+36\alpha^2L^2},"
            r"\quad\alpha=\left(\frac{w_t}{w}\right)^3",
            "1.3.4",
            printed="the stiffness of one side, with the length of the truss",
            why="it belongs to all eight beams, k = 2 k_s, and the length is the distance between adjacent beams",
        ),
    ),
    DeviceFigure(
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
    DeviceFigure(
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
    DeviceFigure("quality_factor", "Quality factor", "1", Equation("quality factor", r"Q=\sqrt{km}/\beta", "1.3.1")),
    DeviceFigure(
        "static_gain_um_per_v",
        "Static gain",
        "um/V",
        Equation("static displacement per volt", r"x/v=F/k", "1.3.1"),
    ),
    DeviceFigure(
        "force_n_per_v",
        "Force per volt",
        "N/V",
        Equation(
            "push-pull comb",
            r"F=4n\varepsilon_0\frac tgV_b",
            "1.3.2",
            printed="identical voltages on both stators, t the length of a finger (5.2.1)",
            why="identical stators pull alike and the forces cancel; they are at plus and minus the bias, and t is "
            "the structural thickness",
        ),
    ),
    DeviceFigure(
        "pull_in_v",
        "Pull-in bias",
        "V",
        Equation(
            "the shuttle turns into its stators by itself",
            r"V_b=\sqrt{\frac{k_\theta g^3}{4n\varepsilon_0t\,(X_r^3-X_s^3)/3}}",
            "3.2.2",
            printed="unstable beyond a third of the gap",
            why="a third holds for a plate with one electrode; a finger is between two, and the aligned device "
            "turns at a bias without any travel",
        ),
    ),
    DeviceFigure(
        "fringing_factor",
        "Fringing",
        "1",
        Equation(
            "field of the cross-section, over plates",
            r"\frac{dC}{dx}\bigg/\frac{2n\varepsilon_0t}g,\quad\frac{dC}{dx}=n\left(C'_{engaged}-C'_{stator}\right)",
            "1.5",
        ),
    ),
    DeviceFigure(
        "levitation_nn_per_v2",
        "Levitation",
        "nN/V^2",
        Equation(
            "upwards, of one comb; the plant is planar and does not rise",
            r"\frac{F_z}{V^2}=\tfrac12nL_0\frac{dC'}{dz}",
            "Tang, Lim and Howe 1992",
        ),
    ),
    DeviceFigure(
        "lift_nm",
        "Lift at the bias",
        "nm",
        Equation(
            "balance; the plant is planar and does not rise",
            r"k_zz=(V_1^2+V_2^2)\,\frac{F_z(z)}{V^2},\quad k_z=k_x\left(\frac tw\right)^2",
            "Tang, Lim and Howe 1992",
        ),
    ),
    *(
        DeviceFigure(
            f"gyro.mode_hz.{n}",
            f"Mode {n}",
            "Hz",
            Equation("coupled mode", r"f=\frac{|\lambda|}{2\pi},\quad\det(M\lambda^2+D\lambda+K)=0", "6.1.3"),
        )
        for n in (1, 2)
    ),
    *(
        DeviceFigure(
            f"gyro.quality_factor.{n}",
            f"Quality factor of mode {n}",
            "1",
            Equation("coupled mode", r"Q=-\frac{|\lambda|}{2\,\mathrm{Re}\,\lambda}", "6.1.3"),
        )
        for n in (1, 2)
    ),
    DeviceFigure("gyro.split_hz", "Split of the modes", "Hz", Equation("split", r"f_2-f_1", "6.1.3")),
    DeviceFigure(
        "gyro.axis_deg",
        "Axis of stiffness",
        "deg",
        Equation("principal axis nearest to x", r"\tfrac12\arctan\frac{2k_{xy}}{k_{xx}-k_{yy}}", "6.1.3"),
    ),
    DeviceFigure(
        "gyro.tilt_deg",
        "Tilt of the locus",
        "deg",
        Equation("long axis", r"\tfrac12\arctan\frac{2\,\mathrm{Re}\,G}{1-|G|^2},\quad G=y/x", "6.1.5"),
    ),
    DeviceFigure(
        "gyro.scale_pm_per_dps",
        "Scale factor",
        "pm/(deg/s)",
        Equation(
            "open loop", r"\frac{|y|}{\Omega}=\frac{2m_c\omega_1A}{|k_{yy}-m_y\omega_1^2+j\omega_1d_{yy}|}", "6.1.2"
        ),
    ),
    DeviceFigure(
        "gyro.zero_rate_dps",
        "Zero rate output",
        "deg/s",
        Equation(
            "open loop",
            r"\Omega_0=\frac1{2m_c}\left[d_{xy}-\frac{k_{xy}d_{yy}}{k_{yy}-m_y\omega_1^2}\right]",
            "6.1.2",
        ),
    ),
    DeviceFigure(
        "gyro.quadrature_dps",
        "Quadrature as a rate",
        "deg/s",
        Equation("cross stiffness, y held at zero", r"\Omega_q=\frac{k_{xy}}{2m_c\omega_x}", "6.1.3"),
    ),
    DeviceFigure(
        "gyro.damping_rate_dps",
        "Cross damping as a rate",
        "deg/s",
        Equation("cross damping", r"\Omega_d=\frac{d_{xy}}{2m_c}", "6.1.3"),
    ),
    DeviceFigure(
        "gyro.floor_deg_per_h_rthz",
        "Thermal floor",
        "deg/h/rtHz",
        Equation("Brownian force, one-sided", r"\Omega_n=\frac{\sqrt2\sqrt{4k_BTd_{yy}}}{2m_c\omega_xA}", "6.1.2"),
    ),
    DeviceFigure(
        "gyro.arw_deg_per_rt_h",
        "Angle random walk",
        "deg/rt h",
        Equation("Brownian force, two-sided", r"N=\Omega_n/\sqrt2", "6.1.2"),
    ),
    *(
        DeviceFigure(
            f"gyro.mass_{axis}_kg",
            f"Mass along {axis}",
            "kg",
            Equation(
                f"plate, frame of {axis}, flexures",
                rf"m_{axis}=m_p+m_{{f{axis}}}+2\left(\tfrac{{12}}{{35}}m_{{b{axis}}}+\tfrac14m_{{t{axis}}}\right)"
                rf"+m_{{b{other}}}+m_{{t{other}}}",
                "1.3.3",
            ),
        )
        for axis, other in (("x", "y"), ("y", "x"))
    ),
    DeviceFigure(
        "gyro.coriolis_mass_kg",
        "Mass the rate acts on",
        "kg",
        Equation("moves along both axes", r"m_c=m_p+\tfrac12(m_{bx}+m_{tx}+m_{by}+m_{ty})", "6.1.2"),
    ),
    *(
        DeviceFigure(
            f"gyro.stiffness_{axis}_n_m",
            f"Stiffness along {axis}",
            "N/m",
            Equation("two folded flexures", rf"k_{axis}=2k(L_{axis},w_{axis})", "1.3.4"),
        )
        for axis in ("x", "y")
    ),
    *(
        DeviceFigure(
            f"gyro.force_{axis}_nn_per_v2",
            f"Comb force along {axis}",
            "nN/V^2",
            Equation("per bias and volt", r"\frac{F}{V_bv}=4n\varepsilon_0\frac tg", "1.3.2"),
        )
        for axis in ("x", "y")
    ),
    DeviceFigure(
        "gyro.feed_through_pm_un_af",
        "Feed-through per parasitic capacitance",
        "pm/uN/aF",
        Equation(
            "charge over charge",
            r"\frac s{C_p}=\frac1{\kappa_x\kappa_y},\quad\kappa=2\frac{dC}{dx}V_b",
            "not in the text",
        ),
    ),
    DeviceFigure(
        "gyro.feed_through_dps_af",
        "Rate per parasitic capacitance",
        "deg/s/aF",
        Equation(
            "open loop, x at resonance",
            r"\frac{|\Omega_p|}{C_p}=\frac{d_{xx}\,|k_{yy}-m_y\omega_1^2|}{4m_c\kappa_x\kappa_y}",
            "not in the text",
        ),
    ),
    DeviceFigure(
        "gyro.softening_n_m_per_v2",
        "Softening along y",
        "N/m/V^2",
        Equation(
            "parallel plates",
            r"-\frac{k_e}{V^2}=\frac1{2}\frac{d^2C}{dy^2}=\frac{2\varepsilon_0A}{g^3}",
            "not in the text",
        ),
    ),
    DeviceFigure(
        "gyro.matching_v",
        "Tuning at matched modes",
        "V",
        Equation(
            "y rings with x",
            r"V_m=\sqrt{\frac{(k_{yy}-m_yk_{xx}/m_x)\,g^3}{2\varepsilon_0A}}",
            "not in the text",
        ),
    ),
    DeviceFigure(
        "gyro.pull_in_v",
        "Pull-in of the tuning electrode",
        "V",
        Equation(
            "nothing is left of the spring along y",
            r"V_{pi}=\sqrt{\frac{(k_{yy}-k_{xy}^2/k_{xx})\,g^3}{2\varepsilon_0A}}",
            "not in the text",
        ),
    ),
    DeviceFigure(
        "gyro.sense_ff_per_um",
        "Capacitance along y",
        "fF/um",
        Equation("difference of the two sides", r"\frac{dC}{dy}=4n\varepsilon_0\frac tg", "2.2.1.1"),
    ),
    DeviceFigure(
        "gyro.sense_af_per_dps",
        "Capacitance per rate",
        "aF/(deg/s)",
        Equation("open loop", r"\frac{dC}{d\Omega}=\frac{dC}{dy}\,\frac{|y|}{\Omega}", "6.1.2"),
    ),
)
