"""The scene of gyroscopes: one or two on a frame, its rate, and the force that makes one follow the other."""

from __future__ import annotations

from typing import Any

import numpy as np

from server.view3d.colours import GROUND, Color
from server.view3d.gyroscope import parts
from server.view3d.gyroscope.body import Body
from server.view3d.gyroscope.marks import GyroscopeMarks, marks
from server.view3d.gyroscope.parts import RIM_UM, TOP_UM, Parts
from server.view3d.gyroscope.pose import GyroscopePose
from server.view3d.layout import UM_PER_UNIT, Mesh
from server.view3d.marks import arrow
from server.view3d.pose import seen
from server.view3d.stage import Stage

FORCE: Color = (31, 184, 143)
FORCE_UM, LIFT_UM = 150.0, 40.0
"""Length of the arrow of the largest force, and its height above the masses."""
NAMES = ("first", "partner")


class GyroscopeScene(Stage):
    """The gyroscopes of one bench.

    Parameters
    ----------
    layout : Parts
        Where the parts are.
    """

    def __init__(self, layout: Parts) -> None:
        super().__init__()
        self._layout = layout
        self._shown = GyroscopePose()
        self._marks = GyroscopeMarks()
        self._added: list[Any] = []
        self.mesh("/ground", layout.ground(), GROUND)
        self._bodies = [Body(self, f"/{name}", centre) for name, centre in zip(NAMES, layout.centres, strict=False)]
        if len(self._bodies) > 1:
            for name, (x, _) in zip(NAMES, layout.centres, strict=True):
                self.label(f"/names/{name}", [name], (x, -RIM_UM - 20.0, 0.0))
        self._name_axes()
        self._rate = self.label("/rate", [""], (0.0, -RIM_UM - 20.0, 0.0))
        self._force = self.mesh("/force", pushing(1.0), FORCE, visible=False)
        self._force_words = self.label("/force-words", [""], (0.0, FORCE_UM, TOP_UM + LIFT_UM))
        self._force_words.visible = False

    def show(self, pose: GyroscopePose) -> None:
        """Move the parts; nothing is sent if nothing changed."""
        before, self._shown = self._shown, pose
        if pose == before:
            return
        with self._server.atomic():
            if seen(pose.faults) != seen(before.faults):
                self._show_faults(pose)
            for body, (x, y), orbit in zip(self._bodies, pose.places, pose.orbits, strict=True):
                body.move(x, y, orbit)
                if pose.turn != before.turn:
                    body.turn(pose.turn)
            if pose.rate != before.rate:
                self._rate.text = f"rate {pose.rate}"
            self._show_force(pose, before)
            if (pose.caption, pose.when) != (before.caption, before.when):
                self.say(pose.caption, pose.when)
        self._server.flush()

    def _show_force(self, pose: GyroscopePose, before: GyroscopePose) -> None:
        """Show the force that makes the first follow its partner."""
        is_there = pose.force is not None
        if is_there != (before.force is not None):
            self._force.visible = self._force_words.visible = is_there
        if pose.force is not None and pose.force != before.force:
            self._force.vertices = pushing(pose.force).vertices.astype(np.float32)
        if pose.largest_force != before.largest_force:
            self._force_words.text = f"force that follows, up to {pose.largest_force}"

    def _show_faults(self, pose: GyroscopePose) -> None:
        """Show each fault on the part of the first device it acts on."""
        before, self._marks = self._marks, marks(pose.faults)
        for handle in self._added:
            handle.remove()
        first = self._bodies[0]
        self._added = [first.add(solid.name, solid.mesh, solid.rides) for solid in self._marks.solids]
        for number, ((x, y, z), lines) in enumerate(self._marks.labels.items()):
            self._added.append(self.label(f"/labels/{number}", lines, (x + first.centre[0], y, z)))
        first.tint(self._marks, before)

    def _name_axes(self) -> None:
        """Write the functions of the combs next to the combs of the first device."""
        x, y = self._bodies[0].centre
        for axis, words in (("x", "x: drive"), ("y", "y: sense")):
            u, v, z = parts.base(axis)
            self.label(f"/axes/{axis}", [words], (x + u, y + v, z))


def pushing(share: float) -> Mesh:
    """Return the arrow of a force along y between two devices, as a share of the largest."""
    length = FORCE_UM * share
    mesh = arrow((0.0, length / 2, 0.0), length, True)
    return Mesh(mesh.vertices * (2.0, 1.0, 1.0) + (0.0, 0.0, (TOP_UM + LIFT_UM) / UM_PER_UNIT), mesh.faces)
