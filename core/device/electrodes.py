r"""Electrodes of a device with two axes: combs that push and pull along an axis, plates that soften its spring."""

from __future__ import annotations

from dataclasses import replace
from typing import Self

from pydantic import model_validator

from core.block import BlockParams, parameter
from core.device.geometry import Geometry
from core.device.ranges import BiasV, Fingers, LengthUm
from core.device.two_axis import PushPull, TuningPlates, TwoAxis
from core.units import EPSILON_0, PM_PER_UM, rate_deg_s

SIDES = 2.0
"""Each rotor finger has a gap on both sides; plates face both sides of the mass."""
PER_UM = 1e6
"""uN/V^2 of a permittivity in F/m."""


class Comb(BlockParams):
    r"""Two combs along an axis, with the rotor at 0 V between stators at :math:`V_b+v` and :math:`V_b-v`.

    .. math:: F=\tfrac12\frac{dC}{dx}\left[(V_b+v)^2-(V_b-v)^2\right]=2\frac{dC}{dx}V_bv,\quad
        \frac{dC}{dx}=2n\varepsilon_0\frac tg

    Numbers that are not given are taken from the drawing, if the device has one. The force is the force of plates.
    """

    bias_v: BiasV = parameter(10.0, "bias of both combs", "V", equation="1.3.2", live=False)
    fingers: Fingers | None = parameter(None, "rotor fingers per side; as drawn unless given", live=False)
    thickness_um: LengthUm | None = parameter(None, "structural thickness; as drawn unless given", "um", live=False)
    gap_um: LengthUm | None = parameter(None, "gap between fingers as etched; as drawn unless given", "um", live=False)

    @model_validator(mode="after")
    def _biased(self) -> Self:
        if self.bias_v <= 0.0:
            raise ValueError("bias_v must be above 0: without a bias a comb pulls the same to both sides")
        return self

    def push_pull(self, drawn: Geometry | None) -> PushPull:
        """Return the combs in the units of the loop.

        Raises
        ------
        ValueError
            If a number is neither given nor drawn.
        """
        own = {"fingers": self.fingers, "thickness_um": self.thickness_um, "gap_um": self.gap_um}
        missing = [name for name, value in own.items() if value is None]
        if missing and drawn is None:
            raise ValueError(f"needs {', '.join(missing)}: this device has no drawing to take them from")
        fingers = self.fingers or (drawn.fingers if drawn else 0)
        thickness = self.thickness_um or (drawn.thickness_um if drawn else 0.0)
        gap = self.gap_um or (drawn.gap_um if drawn else 1.0)
        return PushPull(SIDES * fingers * EPSILON_0 * PER_UM * thickness / gap, self.bias_v)


class TuningElectrode(BlockParams):
    r"""Plates that face the mass across y on both sides, and take stiffness away, :math:`k_e=-2\varepsilon_0AV^2/g^3`.

    The softening is linear: at a tenth of the gap the true one is 2 % more. Plates at the same voltage on both sides do
    not move a mass that is centred.
    """

    plates: Fingers = parameter(20, "plates on each side", live=False)
    length_um: LengthUm = parameter(400.0, "length of a plate that faces the mass", "um", live=False)
    thickness_um: LengthUm = parameter(60.0, "structural thickness", "um", live=False)
    gap_um: LengthUm = parameter(3.0, "gap as etched; the gap behind a plate is wide", "um", live=False)

    def tuning_plates(self) -> TuningPlates:
        """Return the plates in the units of the loop."""
        area = self.plates * self.length_um * self.thickness_um
        return TuningPlates(SIDES * EPSILON_0 * PER_UM * area, self.gap_um)


class Electrodes(BlockParams):
    """Electrodes of a device with two axes; each may be missing. A drawn device has the combs of its drawing."""

    drive: Comb | None = parameter(None, "combs along x", live=False)
    sense: Comb | None = parameter(None, "combs along y", live=False)
    tuning: TuningElectrode | None = parameter(None, "plates that soften the spring along y", live=False)

    def on(self, device: TwoAxis, drawn_x: Geometry | None, drawn_y: Geometry | None) -> TwoAxis:
        """Return a device with these electrodes.

        Raises
        ------
        ValueError
            If a number of a comb is neither given nor drawn.
        """
        return replace(
            device,
            comb_x=_combs("drive", self.drive, drawn_x),
            comb_y=_combs("sense", self.sense, drawn_y),
            tuning=None if self.tuning is None else self.tuning.tuning_plates(),
        )


def _combs(name: str, comb: Comb | None, drawn: Geometry | None) -> PushPull | None:
    """Return the combs of an electrode; a drawing has combs even where no others are given."""
    if comb is None and drawn is None:
        return None
    try:
        return (comb or Comb()).push_pull(drawn)
    except ValueError as error:
        raise ValueError(f"electrodes.{name} {error}") from None


def figures(device: TwoAxis) -> dict[str, float]:
    r"""Return the figures of the electrodes of a device: forces per bias and volt, and the voltages of tuning.

    .. math:: V_{pi}=\sqrt{\frac{(k_{yy}-k_{xy}^2/k_{xx})g^3}{2\varepsilon_0A}},\quad
        V_m=\sqrt{\frac{(k_{yy}-m_yk_{xx}/m_x)g^3}{2\varepsilon_0A}}
    """
    found = {
        f"gyro.force_{axis}_nn_per_v2": 2e3 * comb.gradient
        for axis, comb in (("x", device.comb_x), ("y", device.comb_y))
        if comb is not None
    }
    if device.comb_x is not None and device.comb_y is not None:
        per_pm = 1.0 / (device.comb_x.per_volt * device.comb_y.per_volt)  # pm/uN of 1 aF
        spring = device.sense(device.drive_frequency).real
        passed = rate_deg_s(per_pm * device.damping * abs(spring) / (4.0 * device.coriolis_mass)) / PM_PER_UM
        found |= {"gyro.feed_through_pm_un_af": per_pm, "gyro.feed_through_dps_af": passed}
    if (plates := device.tuning) is not None:
        found["gyro.softening_n_m_per_v2"] = plates.per_v2
        found["gyro.pull_in_v"] = plates.pull_in_v(device.free_stiffness_y)
        apart = device.stiffness_y - device.mass_y * device.stiffness / device.mass
        if apart > 0.0:
            found["gyro.matching_v"] = plates.pull_in_v(apart)
    return found
