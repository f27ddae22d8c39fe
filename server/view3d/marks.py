"""The mark of each fault on the part it acts on; a fault without a mark gets a label at the part it names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from core.device.frame import Damage
from core.faults.broken_truss import EXTENTS, BrokenTruss
from core.faults.debris import Debris
from core.faults.point_adhesion import PointAdhesion
from core.faults.shock import Shock
from core.faults.short_circuit import ShortCircuit
from core.format import format_count, format_short
from server.view3d.layout import FILM_UM, GROUND_UM, UM_PER_UNIT, Box, Layout, Mesh, merge
from server.view3d.pose import Active

RIGHT, LEFT = 1, 2
"""Bits of the combs that are shorted."""
DOT_UM, CHUNK_UM, MASS_UM = 7.0, 5.0, 30.0
"""Sizes large enough to see; none of them is to scale."""

Place = tuple[float, float, float]


@dataclass(frozen=True)
class Solid:
    """A solid on the device, um, and whether it moves with the shuttle."""

    name: str
    mesh: Mesh
    on_shuttle: bool = False


@dataclass
class Marks:
    """All marks of the faults of a moment.

    Parameters
    ----------
    layout : Layout
        Where the parts are.
    solids : list of Solid
        Solids on the device.
    labels : dict
        Words, by their place, um.
    beams : list of float
        How much of the colour of attention the beams at +y and -y take.
    film : float
        The same for the gas under the plate.
    bases : float
        The same for the stators, where the drive comes in.
    damage, share : Damage or None, float
        The damage of the suspension, and its present share.
    """

    layout: Layout
    solids: list[Solid] = field(default_factory=list)
    labels: dict[Place, list[str]] = field(default_factory=dict)
    beams: list[float] = field(default_factory=lambda: [0.0, 0.0])
    film: float = 0.0
    bases: float = 0.0
    damage: Damage | None = None
    share: float = 0.0

    def hurt(self, share: float, **damage: Any) -> None:
        """Damage the suspension."""
        self.damage, self.share = replace(self.damage or Damage(), **damage), max(self.share, share)

    def add(self, name: str, mesh: Mesh, *, on_shuttle: bool = False) -> None:
        """Put a solid on the device."""
        self.solids.append(Solid(name, mesh, on_shuttle))

    def tint(self, plus: float, minus: float) -> None:
        """Tint the beams of both sides."""
        self.beams = [max(self.beams[0], plus), max(self.beams[1], minus)]

    def show(self, fault: Active) -> None:
        """Add the mark of one more fault."""
        draw = getattr(self, f"_{fault.block.name}", None)
        place = draw(fault) if draw is not None else None
        self.labels.setdefault(place or place_of(fault.block.shows, self.layout), []).append(words(fault))

    def _added_mass(self, fault: Active) -> Place:
        x, height = -0.6 * self.layout.plate_um, 1.5 * min(20.0, max(2.0, 100.0 * abs(fault.severity)))
        box = Box((x, 0.0, self.layout.top_um + height / 2), (MASS_UM, MASS_UM, height))
        self.add("added-mass", merge([box]), on_shuttle=True)
        return x, 0.0, self.layout.top_um + height

    def _point_adhesion(self, fault: Active) -> Place:
        params = fault.given(PointAdhesion.Params)
        x = self.layout.inner_um if params.beam == "inner" else self.layout.outer_um
        y = self.layout.beam_from_um + params.position * self.layout.geometry.beam_length_um
        self.add("adhesion", ball((x, y, self.layout.z), DOT_UM))
        self.hurt(fault.share, adhesion=(params.beam, params.position))
        return x, y, self.layout.top_um + DOT_UM

    def _broken_truss(self, fault: Active) -> Place:
        lost = EXTENTS[fault.given(BrokenTruss.Params).extent][0].lost_ends
        self.hurt(fault.share, lost_ends=lost)
        segment = self.layout.geometry.truss_segment_um
        y = self.layout.beam_to_um + self.layout.truss_um / 2
        middle = (sum(lost) / len(lost) - 1.0) * segment
        if fault.share >= 1.0:
            size = (0.94 * len(lost) * segment, self.layout.truss_um, self.layout.thick_um)
            self.add("broken-truss", turned(Box((middle + 5.0, y + 8.0, self.layout.z), size), -0.25))
        else:
            size = (2.0, self.layout.truss_um + 4.0, self.layout.thick_um + 4.0)
            self.add("broken-truss", merge([Box((middle, y, self.layout.z), size)]))
        return middle, 0.82 * y, self.layout.top_um

    def _debris(self, fault: Active) -> Place:
        params = fault.given(Debris.Params)
        side = -1.0 if params.comb == "left" else 1.0
        x, y = side * (self.layout.stator_um + self.layout.geometry.overlap_um / 2), params.place_um
        self.add("debris", ball((x, y, self.layout.top_um), CHUNK_UM, stretch=(1.5, 1.0, 0.8)))
        return x, y, self.layout.top_um + CHUNK_UM

    def _stiffness(self, fault: Active) -> None:
        share = min(1.0, 0.3 + 2.0 * abs(fault.severity))
        self.tint(share, share)

    def _stiffness_one_side(self, fault: Active) -> None:
        self.tint(min(1.0, 0.3 + 2.0 * abs(fault.severity)), 0.0)
        self.hurt(1.0, side_scale=1.0 + fault.severity)

    def _ageing(self, fault: Active) -> None:
        share = min(1.0, 0.3 + 0.15 * fault.severity)
        self.tint(share, share)

    def _damping(self, fault: Active) -> None:
        self.film = max(self.film, min(1.0, 0.25 + 0.5 * abs(fault.severity)))

    _vacuum_loss = _damping

    def _stiction(self, _: Active) -> Place:
        x, y = -(self.layout.plate_um + self.layout.geometry.arm_width_um / 2), -self.layout.geometry.arm_length_um / 2
        size = (2.5 * self.layout.geometry.arm_width_um, 30.0, FILM_UM)
        self.add("stiction", merge([Box((x, y, GROUND_UM + FILM_UM / 2), size)]))
        return x, y - 15.0, self.layout.top_um

    def _short_circuit(self, fault: Active) -> Place:
        # the comb itself takes the colour, for every cause of a short
        side = -1.0 if fault.given(ShortCircuit.Params).comb == "left" else 1.0
        return side * self.layout.stator_um, -0.3 * self.layout.geometry.arm_length_um, self.layout.top_um

    def _shock(self, fault: Active) -> Place:
        sign = 1.0 if fault.severity > 0.0 else -1.0
        along_y = fault.given(Shock.Params).axis == "y"
        y = -0.88 * self.layout.half_width_um
        self.add("shock", arrow((0.0, y, self.layout.top_um), 70.0 * sign, along_y))
        return 0.0, 0.8 * y, self.layout.top_um + 6.0  # further in, because the words are wider than the arrow

    def _drive_gain(self, fault: Active) -> None:
        self.bases = max(self.bases, min(1.0, 0.4 + abs(fault.severity)))


def marks(faults: Sequence[Active], layout: Layout) -> Marks:
    """Return the marks of all faults that act."""
    shown = Marks(layout)
    for fault in faults:
        shown.show(fault)
    return shown


def place_of(part: str, layout: Layout) -> Place:
    """Return the place of the label of a part; labels of parts that are not on the device are at its edge."""
    top = layout.top_um
    half = layout.geometry.arm_length_um / 2
    places: dict[str, Place] = {
        "plate": (-0.6 * layout.plate_um, 0.0, top + 20),
        "beams": (layout.outer_um, layout.beam_from_um + 0.5 * layout.geometry.beam_length_um, top),
        "trusses": (0.0, layout.beam_to_um, top),
        "film": (-layout.arm_um, -0.6 * half, top),
        "fingers": (layout.tip_um, -0.6 * half, top),
        "drive": (layout.base_um, 0.0, top),
        "sensor": (0.0, 0.0, top + 60),
        "frame": (-layout.half_length_um, -0.8 * layout.half_width_um, top),
    }
    return places.get(part, (-layout.half_length_um, 0.8 * layout.half_width_um, top))


def words(fault: Active) -> str:
    """Return the name of a fault, with its severity if that has a unit."""
    unit, severity = fault.block.outputs[0].unit, fault.severity
    if unit == "1":
        return fault.block.title
    amount = format_count(severity, unit) if unit in ("week", "pair") else format_short(severity, unit, 3)
    return f"{fault.block.title} {amount}"


def ball(centre: Place, radius: float, stretch: Place = (1.0, 1.0, 1.0)) -> Mesh:
    """Return an icosahedron."""
    g = (1.0 + 5.0**0.5) / 2.0
    corners = [(0.0, a, b * g) for a in (-1, 1) for b in (-1, 1)]
    points = np.array([np.roll(corner, k) for k in range(3) for corner in corners])
    near = np.linalg.norm(points[:, None] - points[None], axis=2) < 2.01
    faces = [
        (i, j, k)
        for i in range(12)
        for j in range(i + 1, 12)
        for k in range(j + 1, 12)
        if near[i, j] and near[j, k] and near[i, k]
    ]
    scaled = points / np.linalg.norm(points[0]) * radius * np.array(stretch)
    return Mesh((scaled + centre) / UM_PER_UNIT, np.array(faces))


def turned(box: Box, angle: float) -> Mesh:
    """Return a box turned about the vertical through its centre."""
    flat = merge([Box((0.0, 0.0, 0.0), box.size)])
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return Mesh(flat.vertices @ turn.T + np.array(box.centre) / UM_PER_UNIT, flat.faces)


def arrow(centre: Place, length: float, along_y: bool) -> Mesh:
    """Return a flat arrow whose length has the sign of its direction."""
    half, head, t = length / 2, 0.3 * length, 6.0
    outline = [(-half, -3.0), (half - head, -3.0), (half - head, -9.0), (half, 0.0)]
    outline += [(half - head, 9.0), (half - head, 3.0), (-half, 3.0)]
    flat = np.array([(y, x) if along_y else (x, y) for x, y in outline])
    corners = [np.column_stack([flat, np.full(7, z)]) for z in (0.0, t)]
    sides = [f for i in range(7) for j in [(i + 1) % 7] for f in ((i, j, j + 7), (i, j + 7, i + 7))]
    caps = [(0, 1, 5), (0, 5, 6), (2, 3, 4)]
    faces = [*sides, *caps, *[(a + 7, b + 7, c + 7) for a, b, c in caps]]
    return Mesh((np.vstack(corners) + centre) / UM_PER_UNIT, np.array(faces))
