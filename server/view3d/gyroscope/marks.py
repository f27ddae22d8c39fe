"""The mark of each fault of a gyroscope on its part; a fault without a mark is a label at its part."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from server.view3d.gyroscope.parts import AXES, BASE_UM, DISC_UM, MASS_UM, TOP_UM, finger, fold
from server.view3d.layout import Box, Mesh, merge
from server.view3d.marks import Place, arrow, turned, words
from server.view3d.pose import Active

TILT = 0.15
"""Angle of a turned suspension, rad; the true angle is invisibly small."""
AXIS_UM = 330.0


@dataclass(frozen=True)
class Solid:
    """A solid on the device, and the part that carries it: nothing, the mass, or the bars of an axis."""

    name: str
    mesh: Mesh
    rides: str = ""


@dataclass
class GyroscopeMarks:
    """All marks of the faults of a moment.

    Parameters
    ----------
    solids : list of Solid
        Solids on the device.
    labels : dict
        Words, by their place, um from the middle of the device.
    flexures, stators : dict
        How much of the colour of attention the beams and the fixed combs of each axis take.
    gas : float
        The same for the gas.
    """

    solids: list[Solid] = field(default_factory=list)
    labels: dict[Place, list[str]] = field(default_factory=dict)
    flexures: dict[str, float] = field(default_factory=lambda: dict.fromkeys(AXES, 0.0))
    stators: dict[str, float] = field(default_factory=lambda: dict.fromkeys(AXES, 0.0))
    gas: float = 0.0

    def show(self, fault: Active) -> None:
        """Add the mark of one more fault."""
        draw = getattr(self, f"_{fault.block.name}", None)
        place = draw(fault) if draw is not None else None
        self.labels.setdefault(place or place_of(fault.block.shows), []).append(words(fault))

    def _quadrature(self, fault: Active) -> Place:
        angle = TILT if fault.severity > 0.0 else -TILT
        for name, size in (("axis-x", (AXIS_UM, 3.0, 3.0)), ("axis-y", (3.0, AXIS_UM, 3.0))):
            self.solids.append(Solid(name, turned(Box((0.0, 0.0, TOP_UM + 4.0), size), angle)))
        return 0.5 * AXIS_UM, 0.5 * AXIS_UM * angle, TOP_UM

    def _drive_loss(self, fault: Active) -> Place:
        self.stators["x"] = min(1.0, 0.3 + 0.7 * fault.severity)
        for side in (-1, 1):
            lead = Box((side * (BASE_UM + 18.0), 0.0, TOP_UM), (26.0, 7.0, 5.0))
            self.solids.append(Solid(f"lead-{side}", turned(lead, 0.6)))
        return place_of("drive")

    def _sense_stiffness(self, fault: Active) -> Place:
        self._tint("y", 0.4 + 6.0 * abs(fault.severity))
        return fold("y")

    def _stiffness(self, fault: Active) -> None:
        for axis in AXES:
            self._tint(axis, 0.3 + 2.0 * abs(fault.severity))

    def _ageing(self, fault: Active) -> None:
        for axis in AXES:
            self._tint(axis, 0.3 + 0.15 * fault.severity)

    def _finger_pair_short(self, fault: Active) -> Place:
        axis = "x" if fault.params.model_dump().get("axis") == "x" else "y"
        moving, fixed = finger(axis, 2.0, True), finger(axis, 2.5, False)
        self.solids += [Solid("shorted-moving", merge([moving]), axis), Solid("shorted-fixed", merge([fixed]))]
        x, y, _ = fixed.centre
        return x, y, TOP_UM

    def _package_leak(self, _: Active) -> Place:
        self.gas = 1.0
        return place_of("film")

    def _damping(self, fault: Active) -> Place:
        self.gas = max(self.gas, min(1.0, 0.25 + 0.5 * abs(fault.severity)))
        return place_of("film")

    def _added_mass(self, fault: Active) -> Place:
        place, height = -0.6 * MASS_UM, 1.5 * min(20.0, max(2.0, 100.0 * abs(fault.severity)))
        box = Box((place, place, TOP_UM + height / 2), (40.0, 40.0, height))
        self.solids.append(Solid("added-mass", merge([box]), "mass"))
        return place, place, TOP_UM + height

    def _shock(self, fault: Active) -> Place:
        along_y = fault.params.model_dump().get("axis") == "y"
        place = (-0.62 * DISC_UM, 0.62 * DISC_UM, TOP_UM)
        length = 90.0 if fault.severity > 0.0 else -90.0
        self.solids.append(Solid("shock", arrow(place, length, along_y)))
        return place

    def _tint(self, axis: str, share: float) -> None:
        """Let the beams of an axis take more of the colour of attention."""
        self.flexures[axis] = max(self.flexures[axis], min(1.0, share))


def marks(faults: Sequence[Active]) -> GyroscopeMarks:
    """Return the marks of all faults that act."""
    shown = GyroscopeMarks()
    for fault in faults:
        shown.show(fault)
    return shown


def place_of(part: str) -> Place:
    """Return the place of the label of a part; labels of parts that are not on the device are at its edge."""
    places: dict[str, Place] = {
        "plate": (-0.6 * MASS_UM, -0.6 * MASS_UM, TOP_UM),
        "beams": fold("x"),
        "film": (-0.62 * DISC_UM, -0.62 * DISC_UM, TOP_UM),
        "fingers": (90.0, BASE_UM - 30.0, TOP_UM),
        "drive": (BASE_UM - 30.0, -90.0, TOP_UM),
        "sensor": (0.0, -BASE_UM + 60.0, TOP_UM),
        "frame": (-0.62 * DISC_UM, 0.62 * DISC_UM, TOP_UM),
    }
    return places.get(part, (0.62 * DISC_UM, 0.62 * DISC_UM, TOP_UM))
