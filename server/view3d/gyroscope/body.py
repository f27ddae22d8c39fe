"""The body of one gyroscope on the stage: its mass and bars move, its beams bend, its orbit is drawn above it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from server.view3d.colours import ATTENTION, FIXED, LIGHT, MOVING, SILICON, Color, blend
from server.view3d.gyroscope import parts
from server.view3d.gyroscope.marks import GyroscopeMarks
from server.view3d.gyroscope.parts import AXES, GROUND_UM, RIM_UM, TOP_UM
from server.view3d.gyroscope.solids import arc, rigid
from server.view3d.layout import UM_PER_UNIT, FloatArray, Mesh
from server.view3d.marks import ball
from server.view3d.stage import Stage
from server.view3d.suspension import Flexure

BAR: Color = (58, 134, 186)
TURN: Color = (240, 190, 60)
ABOVE_UM = 12.0
"""Height of the orbit above the mass."""
FRONT = -0.5 * math.pi
"""Where the arc of the rate begins: at the front."""


class Body:
    """The nodes of one device.

    Parameters
    ----------
    stage : Stage
        Its place.
    name : str
        First part of the names of its nodes.
    centre : tuple of float
        Its place, um.
    """

    def __init__(self, stage: Stage, name: str, centre: tuple[float, float]) -> None:
        self._stage, self.name, self.centre = stage, name, centre
        stage.frame(name, (*centre, 0.0))
        stage.mesh(f"{name}/anchors", parts.anchors(), FIXED)
        stage.mesh(f"{name}/rim", parts.rim(), SILICON)
        self._stators = {axis: stage.mesh(f"{name}/stators-{axis}", parts.stators(axis), FIXED) for axis in AXES}
        # all by their vertices: a browser draws a new place earlier than new vertices, and beams would come off
        dot = rigid(ball((0.0, 0.0, TOP_UM + ABOVE_UM), 4.5), np.eye(2))
        self._moving = [
            self._add("plate", parts.mass(), MOVING),
            self._add("bars", parts.bars(), BAR),
            self._add("dot", dot, LIGHT),
        ]
        self._flexures = {axis: self._add(f"flexures-{axis}", parts.flexures(axis), SILICON) for axis in AXES}
        self._carriers = {key: stage.frame(f"{name}/{key}", (0.0, 0.0, 0.0)) for key in ("mass", *AXES)}
        self._orbit = stage.lines(f"{name}/orbit", np.zeros((1, 2, 3)), LIGHT)
        self._gas = stage.mesh(f"{name}/gas", parts.gas(), ATTENTION, opacity=0.12, visible=False)
        self._turn = stage.mesh(f"{name}/turn", turning(0.0), TURN)

    def move(self, x: float, y: float, orbit: FloatArray) -> None:
        """Move the mass to a place, um, on its orbit, shape (points, 2)."""
        for handle, part in (*self._moving, *self._flexures.values()):
            handle.vertices = part.bent(x, y, 0.0).astype(np.float32)
        for key, place in (("mass", (x, y)), ("x", (x, 0.0)), ("y", (0.0, y))):
            self._carriers[key].position = (place[0] / UM_PER_UNIT, place[1] / UM_PER_UNIT, 0.0)
        if len(orbit) > 1:
            points = np.column_stack([orbit, np.full(len(orbit), TOP_UM + ABOVE_UM)]) / UM_PER_UNIT
            self._orbit.points = np.stack([points[:-1], points[1:]], axis=1).astype(np.float32)

    def turn(self, share: float) -> None:
        """Show a rate as a share of half the ring."""
        self._turn.vertices = turning(share).vertices.astype(np.float32)

    def tint(self, now: GyroscopeMarks, before: GyroscopeMarks) -> None:
        """Colour the parts that faults act on."""
        for axis in AXES:
            if now.flexures[axis] != before.flexures[axis]:
                self._flexures[axis][0].color = blend(SILICON, ATTENTION, now.flexures[axis])
            if now.stators[axis] != before.stators[axis]:
                self._stators[axis].color = blend(FIXED, ATTENTION, now.stators[axis])
        if now.gas != before.gas:
            self._gas.visible = now.gas > 0.0
            self._gas.opacity = 0.15 * now.gas

    def _add(self, name: str, part: Flexure, color: Color) -> tuple[Any, Flexure]:
        """Add a part that moves."""
        at_rest = Mesh(part.bent(0.0, 0.0, 0.0), part.faces)
        return self._stage.mesh(f"{self.name}/{name}", at_rest, color), part

    def add(self, name: str, mesh: Mesh, rides: str) -> Any:
        """Put the mark of a fault on a moving or a fixed part."""
        return self._stage.mesh("/".join(part for part in (self.name, rides, name) if part), mesh, ATTENTION)


def turning(share: float) -> Mesh:
    """Return the arrow along the rim, the longer the faster; it points the way the frame turns."""
    sweep = math.pi * max(-1.0, min(1.0, share))
    low, high, middle = GROUND_UM + 8.0, GROUND_UM + 14.0, RIM_UM - 7.0
    band = arc(middle - 6.0, middle + 6.0, low, high, FRONT, sweep)
    reach = math.copysign(0.11 * (abs(sweep) > 0.0), sweep)
    along = np.array([sweep, sweep + reach, sweep])
    radii = np.array([middle - 18.0, middle, middle + 18.0])
    tip = np.column_stack([radii * np.cos(FRONT + along), radii * np.sin(FRONT + along), np.full(3, high + 1.0)])
    under = tip - (0.0, 0.0, high + 1.0 - low)
    n = len(band.vertices)
    faces = np.array([(0, 1, 2), (3, 5, 4), (0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4), (2, 0, 3), (2, 3, 5)]) + n
    return Mesh(np.vstack([band.vertices, np.vstack([tip, under]) / UM_PER_UNIT]), np.vstack([band.faces, faces]))
