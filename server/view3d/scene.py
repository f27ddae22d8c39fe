"""The scene of one bench: the shuttle moves and turns, the beams bend, marks show the faults."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from server.view3d.colours import (
    ATTENTION,
    ESTIMATE,
    FIXED,
    GROUND,
    LIGHT,
    MOVING,
    REFERENCE,
    SILICON,
    Color,
    blend,
    in_batch,
)
from server.view3d.layout import UM_PER_UNIT, Box, FloatArray, Layout, Mesh, merge
from server.view3d.marks import LEFT, RIGHT, Marks, Place, ball, marks
from server.view3d.pose import Laser, Pose, seen
from server.view3d.stage import Stage
from server.view3d.suspension import Flexure, flexure

SIDES = ((1, "right", RIGHT), (-1, "left", LEFT))
BEAM_UM, ABOVE_UM, BELOW_UM, SPOT_UM = 3.0, 130.0, 90.0, 5.0
"""Sizes of the light, large enough to see."""


class ResonatorScene(Stage):
    """The resonator of one bench.

    Parameters
    ----------
    layout : Layout
        Where the parts are.
    """

    def __init__(self, layout: Layout) -> None:
        super().__init__()
        self._layout = layout
        self._shown = Pose()
        self._marks = Marks(layout)
        self._added: list[Any] = []
        self._lights: list[Any] = []
        self._build()

    def show(self, pose: Pose) -> None:
        """Move the parts; nothing is sent if nothing changed."""
        before, self._shown = self._shown, pose
        if pose == before:
            return
        with self._server.atomic():
            if seen(pose.faults) != seen(before.faults) or pose.contact != before.contact:
                self._show_faults(pose)
            self._move(pose, before)
            for (_, name, bit), warning, earlier in zip(SIDES, pose.warnings, before.warnings, strict=True):
                short = bool(pose.short & bit)
                if (warning, short) != (earlier, bool(before.short & bit)):
                    moving = blend(MOVING, ATTENTION, 1.0 if short else warning)
                    self._fingers[name].batched_colors = in_batch(moving)
                    self._stators[name].batched_colors = in_batch(ATTENTION if short else FIXED)
            if pose.lasers != before.lasers:
                self._show_lasers(pose.lasers)
            if (pose.caption, pose.when) != (before.caption, before.when):
                self.say(pose.caption, pose.when)
        self._server.flush()

    def _move(self, pose: Pose, before: Pose) -> None:
        """Place all moving parts."""
        x, y, turn = pose.displacement_um, pose.shift_um, pose.turn
        self._shuttle.position = (x / UM_PER_UNIT, y / UM_PER_UNIT, 0.0)
        if turn != before.turn:
            self._shuttle.wxyz = (math.cos(turn / 2), 0.0, 0.0, math.sin(turn / 2))
        for (_, name, _), lateral in zip(SIDES, pose.combs_um, strict=True):
            fingers = self._fingers[name]
            # the fingers are true to scale in their gaps; only the arm that carries them is exaggerated
            fingers.position = (x / UM_PER_UNIT, lateral / UM_PER_UNIT, 0.0)
            if turn != before.turn:
                places = self._places[name].copy()
                places[:, 0] -= turn * places[:, 1]
                fingers.batched_positions = places.astype(np.float32) / UM_PER_UNIT
        for beams, bending in zip(self._beams, self._flexures, strict=True):
            beams.vertices = bending.bent(x, y, turn).astype(np.float32)
        self._reference.position = (pose.reference_um / UM_PER_UNIT, 0.0, 0.0)
        if (pose.estimate_um is None) != (before.estimate_um is None):
            self._estimate.visible = pose.estimate_um is not None
        if pose.estimate_um is not None:
            self._estimate.position = (pose.estimate_um / UM_PER_UNIT, 0.0, 0.0)

    def _show_faults(self, pose: Pose) -> None:
        """Show each fault on the part it acts on."""
        before, now = self._marks, marks(pose.faults, self._layout)
        self._marks = now
        for handle in self._added:
            handle.remove()
        self._added = []
        for solid in now.solids:
            path = f"/shuttle/{solid.name}" if solid.on_shuttle else f"/{solid.name}"
            self._added.append(self.mesh(path, solid.mesh, ATTENTION))
        labels: dict[Place, list[str]] = dict(now.labels)
        if pose.contact:
            side = 1 if abs(pose.combs_um[0]) >= abs(pose.combs_um[1]) else -1
            place = (side * self._layout.stator_um, 0.45 * self._layout.comb_um, self._layout.top_um)
            labels[place] = [*labels.get(place, []), "Fingers touch"]
        for number, (place, lines) in enumerate(labels.items()):
            self._added.append(self.label(f"/labels/{number}", lines, place))
        if (now.damage, now.share) != (before.damage, before.share):
            self._bend(now)
        for beams, share, earlier in zip(self._beams, now.beams, before.beams, strict=True):
            if share != earlier:
                beams.color = blend(SILICON, ATTENTION, share)
        if now.film != before.film:
            self._film.visible = now.film > 0.0
            self._film.opacity = 0.3 * now.film
        if now.bases != before.bases:
            self._bases.color = blend(FIXED, ATTENTION, now.bases)

    def _bend(self, now: Marks) -> None:
        """Choose the shape of the suspension by its damage; only the side at +y can be damaged."""
        for i, side in enumerate((1, -1)):
            self._flexures[i] = flexure(self._layout, side, now.damage, now.share)
            self._beams[i].faces = self._flexures[i].faces.astype(np.uint32)

    def _show_lasers(self, lasers: tuple[Laser, ...]) -> None:
        """Show the beams of light, which do not move."""
        for handle in self._lights:
            handle.remove()
        self._lights = []
        top = self._layout.top_um
        for number, laser in enumerate(lasers):
            low = -BELOW_UM if laser.is_through else top
            centre = (laser.place_um, 0.0, (top + ABOVE_UM + low) / 2)
            beam = merge([Box(centre, (BEAM_UM, BEAM_UM, top + ABOVE_UM - low))])
            spot = ball((laser.place_um, 0.0, top + 0.5), SPOT_UM, stretch=(1.0, 1.0, 0.1))
            self._lights += [
                self.mesh(f"/light/{number}", beam, LIGHT, opacity=0.6),
                self.mesh(f"/spot/{number}", spot, LIGHT),
            ]

    def _build(self) -> None:
        """Build all parts, once."""
        layout = self._layout
        self.mesh("/ground", layout.ground(), GROUND)
        self.mesh("/anchors", layout.anchors(), FIXED)
        self._bases = self.mesh("/bases", layout.bases(), FIXED)
        self._film = self.mesh("/film", layout.film(), ATTENTION, opacity=0.2, visible=False)
        self._stators = {name: self._comb(f"/stators/{name}", layout.stators(side), FIXED) for side, name, _ in SIDES}
        self._places = {name: layout.fingers(side) for side, name, _ in SIDES}
        self._fingers = {name: self._comb(f"/fingers/{name}", self._places[name], MOVING) for _, name, _ in SIDES}
        self._shuttle = self.frame("/shuttle", (0.0, 0.0, 0.0))
        self.mesh("/shuttle/plate", layout.shuttle(), MOVING)
        self._flexures: list[Flexure] = [flexure(layout, side) for side in (1, -1)]
        self._beams = [
            self.mesh(f"/beams/{name}", Mesh(bending.bent(0.0, 0.0, 0.0), bending.faces), SILICON)
            for name, bending in zip(("plus", "minus"), self._flexures, strict=True)
        ]
        self._reference = self._ghost("/reference", REFERENCE)
        self._estimate = self._ghost("/estimate", ESTIMATE)
        self._estimate.visible = False

    def _ghost(self, name: str, color: Color) -> Any:
        """Add the outline of a shuttle that is elsewhere."""
        ghost = self.frame(name, (0.0, 0.0, 0.0))
        self.lines(f"{name}/outline", self._layout.outline(), color)
        return ghost

    def _comb(self, name: str, places: FloatArray, color: Color) -> Any:
        """Add all fingers of a kind."""
        return self.batch(name, places, self._layout.finger_size, color)
