"""The marks of the faults that only a gyroscope has."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from server.view3d.colours import FIXED, SILICON, Color
from server.view3d.gyroscope.parts import BASE_UM, DISC_UM, MASS_UM, TOP_UM, finger, fold
from server.view3d.marks import Marks
from server.view3d.pose import Active
from server.view3d.solids import Box, Place, merge, turned

TILT = 0.15
"""Angle of a turned suspension, rad; the true angle is invisibly small."""
AXIS_UM = 330.0
EDGE = (-0.62 * DISC_UM, 0.62 * DISC_UM, TOP_UM)
PLACES: dict[str, Place] = {
    "plate": (-0.6 * MASS_UM, -0.6 * MASS_UM, TOP_UM),
    "beams": fold("x"),
    "film": (-0.62 * DISC_UM, -0.62 * DISC_UM, TOP_UM),
    "fingers": (90.0, BASE_UM - 30.0, TOP_UM),
    "drive": (BASE_UM - 30.0, -90.0, TOP_UM),
    "sensor": (0.0, -BASE_UM + 60.0, TOP_UM),
    **dict.fromkeys(("frame", "shock", "shocked"), EDGE),
    "": (0.62 * DISC_UM, 0.62 * DISC_UM, TOP_UM),
}
"""Places of marks and labels, um from the middle of the device; a label without a part is at the edge."""


class GyroscopeMarks(Marks):
    """All marks of the faults of a moment."""

    root = "/first"
    springs = ("flexures-x", "flexures-y")
    colors: ClassVar[dict[str, Color]] = {**dict.fromkeys(springs, SILICON), "stators-x": FIXED, "stators-y": FIXED}
    gas, opacity = "gas", 0.15
    carrier, mass_um, shock_um = "mass", 40.0, 90.0

    def __init__(self, faults: Sequence[Active]) -> None:
        super().__init__(faults, PLACES, TOP_UM)

    def _quadrature(self, fault: Active) -> Place:
        angle = TILT if fault.severity > 0.0 else -TILT
        for name, size in (("axis-x", (AXIS_UM, 3.0, 3.0)), ("axis-y", (3.0, AXIS_UM, 3.0))):
            self.solids[name] = turned(Box((0.0, 0.0, TOP_UM + 4.0), size), angle)
        return 0.5 * AXIS_UM, 0.5 * AXIS_UM * angle, TOP_UM

    def _drive_loss(self, fault: Active) -> None:
        self.tint(0.3 + 0.7 * fault.severity, "stators-x")
        for side in (-1, 1):
            lead = Box((side * (BASE_UM + 18.0), 0.0, TOP_UM), (26.0, 7.0, 5.0))
            self.solids[f"lead-{side}"] = turned(lead, 0.6)

    def _sense_stiffness(self, fault: Active) -> Place:
        self.tint(0.4 + 6.0 * abs(fault.severity), "flexures-y")
        return fold("y")

    def _finger_pair_short(self, fault: Active) -> Place:
        axis = "x" if getattr(fault.params, "axis", "y") == "x" else "y"
        moving, fixed = finger(axis, 2.0, True), finger(axis, 2.5, False)
        self.solids[f"{axis}/shorted-moving"] = merge([moving])
        self.solids["shorted-fixed"] = merge([fixed])
        x, y, _ = fixed.centre
        return x, y, TOP_UM

    def _package_leak(self, _: Active) -> None:
        self.tint(1.0, "gas")
