"""The marks of the faults that only a comb resonator has, and of fingers that touch."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, ClassVar

from core.device.frame import Damage
from core.faults.broken_truss import EXTENTS, BrokenTruss
from core.faults.debris import Debris
from core.faults.point_adhesion import PointAdhesion
from core.faults.short_circuit import ShortCircuit
from server.view3d.colours import FIXED, SILICON, Color
from server.view3d.marks import Marks
from server.view3d.pose import Active
from server.view3d.resonator.layout import FILM_UM, GROUND_UM, Layout
from server.view3d.solids import Box, Place, ball, merge, turned

DOT_UM, CHUNK_UM = 7.0, 5.0
"""Sizes large enough to see; none of them is to scale."""


class ResonatorMarks(Marks):
    """All marks of the faults of a moment.

    Parameters
    ----------
    faults : sequence of Active
        The faults that act.
    layout : Layout
        Where the parts are.
    """

    springs = ("beams/plus", "beams/minus")
    colors: ClassVar[dict[str, Color]] = {**dict.fromkeys(springs, SILICON), "bases": FIXED}
    gas, opacity = "film", 0.3
    carrier, mass_um, shock_um = "shuttle", 30.0, 70.0

    def __init__(self, faults: Sequence[Active], layout: Layout) -> None:
        self.layout = layout
        self.damage: Damage | None = None
        """The damage of the suspension."""
        self.share = 0.0
        """The present share of the damage."""
        super().__init__(faults, layout.places(), layout.top_um)

    def hurt(self, share: float, **damage: Any) -> None:
        """Damage the suspension."""
        self.damage, self.share = replace(self.damage or Damage(), **damage), max(self.share, share)

    def touch(self, side: int) -> None:
        """Mark the comb at +x or -x, because its fingers touch."""
        self.write("Fingers touch", (side * self.layout.stator_um, 0.45 * self.layout.comb_um, self.top_um))

    def _point_adhesion(self, fault: Active) -> Place:
        params = fault.given(PointAdhesion.Params)
        x = self.layout.inner_um if params.beam == "inner" else self.layout.outer_um
        y = self.layout.beam_from_um + params.position * self.layout.geometry.beam_length_um
        self.solids["adhesion"] = ball((x, y, self.layout.z), DOT_UM)
        self.hurt(fault.share, adhesion=(params.beam, params.position))
        return x, y, self.top_um + DOT_UM

    def _broken_truss(self, fault: Active) -> Place:
        lost = EXTENTS[fault.given(BrokenTruss.Params).extent][0].lost_ends
        self.hurt(fault.share, lost_ends=lost)
        segment = self.layout.geometry.truss_segment_um
        y = self.layout.beam_to_um + self.layout.truss_um / 2
        middle = (sum(lost) / len(lost) - 1.0) * segment
        if fault.share >= 1.0:
            size = (0.94 * len(lost) * segment, self.layout.truss_um, self.layout.thick_um)
            self.solids["broken-truss"] = turned(Box((middle + 5.0, y + 8.0, self.layout.z), size), -0.25)
        else:
            size = (2.0, self.layout.truss_um + 4.0, self.layout.thick_um + 4.0)
            self.solids["broken-truss"] = merge([Box((middle, y, self.layout.z), size)])
        return middle, 0.82 * y, self.top_um

    def _debris(self, fault: Active) -> Place:
        params = fault.given(Debris.Params)
        side = -1.0 if params.comb == "left" else 1.0
        x, y = side * (self.layout.stator_um + self.layout.geometry.overlap_um / 2), params.place_um
        self.solids["debris"] = ball((x, y, self.top_um), CHUNK_UM, stretch=(1.5, 1.0, 0.8))
        return x, y, self.top_um + CHUNK_UM

    def _stiffness_one_side(self, fault: Active) -> None:
        self.tint(0.3 + 2.0 * abs(fault.severity), "beams/plus")
        self.hurt(1.0, side_scale=1.0 + fault.severity)

    _vacuum_loss = Marks._damping

    def _stiction(self, _: Active) -> Place:
        x, y = -(self.layout.plate_um + self.layout.geometry.arm_width_um / 2), -self.layout.geometry.arm_length_um / 2
        size = (2.5 * self.layout.geometry.arm_width_um, 30.0, FILM_UM)
        self.solids["stiction"] = merge([Box((x, y, GROUND_UM + FILM_UM / 2), size)])
        return x, y - 15.0, self.top_um

    def _short_circuit(self, fault: Active) -> Place:
        # the comb itself takes the colour, for every cause of a short
        side = -1.0 if fault.given(ShortCircuit.Params).comb == "left" else 1.0
        return side * self.layout.stator_um, -0.3 * self.layout.geometry.arm_length_um, self.top_um

    def _drive_gain(self, fault: Active) -> None:
        self.tint(0.4 + abs(fault.severity), "bases")
