"""The mark of each fault on the part it acts on; a fault without a mark gets a label at the part it names."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from core.format import format_count, format_short
from server.view3d.colours import ATTENTION, Color, blend
from server.view3d.part import ScenePart, ScenePicture, label, solid
from server.view3d.pose import Active
from server.view3d.solids import Box, Mesh, Place, arrow, merge


class Marks:
    """All marks of the faults of a moment.

    A method with the name of a fault marks it, here the faults that all devices have. It may return the place of the
    label.

    Parameters
    ----------
    faults : sequence of Active
        The faults that act.
    places : dict
        Place of the label of each part, um; of the parts that are not on the device under ``""``, of a shock under
        ``"shocked"``, with its arrow at ``"shock"``.
    top_um : float
        Height of the upper surface.
    """

    root: ClassVar[str] = ""
    """Name of the device in the scene."""
    colors: ClassVar[dict[str, Color]]
    """The parts that take the colour of attention, and their colours without it."""
    springs: ClassVar[tuple[str, ...]]
    gas: ClassVar[str]
    opacity: ClassVar[float]
    """Opacity of the gas when a fault acts on it."""
    carrier: ClassVar[str]
    """The part that an added mass rides on."""
    mass_um: ClassVar[float]
    shock_um: ClassVar[float]
    """Length of the arrow of a shock."""

    def __init__(self, faults: Sequence[Active], places: dict[str, Place], top_um: float) -> None:
        self.places, self.top_um = places, top_um
        self.solids: dict[str, Mesh] = {}
        """Solids on the device; ``part/solid`` is carried by a part that moves."""
        self.labels: dict[Place, list[str]] = {}
        self.tints: dict[str, float] = dict.fromkeys((*self.colors, self.gas), 0.0)
        """How much of the colour of attention parts take."""
        for fault in faults:
            draw = getattr(self, f"_{fault.block.name}", None)
            where = draw(fault) if draw is not None else None
            self.write(words(fault), where or places.get(fault.block.shows, places[""]))

    def write(self, text: str, where: Place) -> None:
        """Write words at a place, under the words that it has."""
        self.labels.setdefault(where, []).append(text)

    def tint(self, share: float, *parts: str) -> None:
        """Let parts take more of the colour of attention."""
        for part in parts:
            self.tints[part] = max(self.tints[part], min(1.0, share))

    def parts(self, origin_um: float) -> dict[str, ScenePart]:
        """Return solids and labels as parts of the scene; the device is at a place along x."""
        parts = {f"{self.root}/{name}": solid(mesh, ATTENTION) for name, mesh in self.solids.items()}
        for number, ((x, y, z), lines) in enumerate(self.labels.items()):
            parts[f"/labels/{number}"] = label(lines, (x + origin_um, y, z))
        return parts

    def colour(self, picture: ScenePicture) -> None:
        """Colour the parts that faults act on."""
        for name, color in self.colors.items():
            picture.set(f"{self.root}/{name}", color=blend(color, ATTENTION, self.tints[name]))
        gas = self.tints[self.gas]
        picture.set(f"{self.root}/{self.gas}", visible=gas > 0.0, opacity=self.opacity * gas)

    def _added_mass(self, fault: Active) -> Place:
        (x, y, _), height = self.places["plate"], 1.5 * min(20.0, max(2.0, 100.0 * abs(fault.severity)))
        box = Box((x, y, self.top_um + height / 2), (self.mass_um, self.mass_um, height))
        self.solids[f"{self.carrier}/added-mass"] = merge([box])
        return x, y, self.top_um + height

    def _stiffness(self, fault: Active) -> None:
        self.tint(0.3 + 2.0 * abs(fault.severity), *self.springs)

    def _ageing(self, fault: Active) -> None:
        self.tint(0.3 + 0.15 * fault.severity, *self.springs)

    def _damping(self, fault: Active) -> None:
        self.tint(0.25 + 0.5 * abs(fault.severity), self.gas)

    def _shock(self, fault: Active) -> Place:
        length = self.shock_um if fault.severity > 0.0 else -self.shock_um
        along_y = getattr(fault.params, "axis", "x") == "y"
        self.solids["shock"] = arrow(self.places["shock"], length, along_y)
        return self.places["shocked"]


def words(fault: Active) -> str:
    """Return the name of a fault, with its severity if that has a unit."""
    unit, severity = fault.block.outputs[0].unit, fault.severity
    if unit == "1":
        return fault.block.title
    amount = format_count(severity, unit) if unit in ("week", "pair") else format_short(severity, unit, 3)
    return f"{fault.block.title} {amount}"
