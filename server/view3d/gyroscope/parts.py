"""The parts of a schematic gyroscope: a mass, bars that move along one axis each and carry the combs, beams between.

The bars at x move along x alone and those at y along y alone, so that a mass that moves along both needs no room in the
combs. The sizes are chosen to be seen; the equations know none of them.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from server.view3d.flexure import Flexure, beam, join, rigid
from server.view3d.solids import Box, FloatArray, Mesh, Place, View, arc, circle, merge, prism

GROUND_UM, LOW_UM, TOP_UM = 4.0, 14.0, 30.0
"""Heights of the ground, and of the lower and upper surface of moving parts."""
MASS_UM, BAR_UM, BAR_LENGTH_UM, BAR_WIDTH_UM = 100.0, 172.0, 80.0, 12.0
"""Half the mass, place of the bars, half their length, their width."""
RETURN_UM, ANCHOR_UM, FOLD_UM = 232.0, 71.0, 140.0
"""Where beams come back to the anchors, where these are, and where beams fold."""
TIP_UM, STATOR_UM, BASE_UM, PITCH_UM, FINGER_UM = 260.0, 222.0, 313.0, 16.0, 4.0
"""Tips of moving and of fixed fingers, the base of the fixed ones, pitch and width."""
DISC_UM, RIM_UM = 345.0, 359.0
"""Radius of the frame and of its rim."""
BEAM_UM, TRUSS_UM = 4.0, 8.0
COUPLING_UM = 60.0
APART_UM = 410.0
"""Half the distance of the two masses of a pair."""
AXES = ("x", "y")


class Ground:
    """The frame that carries one gyroscope or two.

    Parameters
    ----------
    axes : tuple of str
        Axes of the plant: two for each mass.
    """

    def __init__(self, axes: tuple[str, ...]) -> None:
        self.centres = (0.0,) if len(axes) == 2 else (-APART_UM, APART_UM)

    def mesh(self) -> Mesh:
        """Return its surface."""
        outline = circle(RIM_UM, 96)
        outline[:, 0] += np.where(outline[:, 0] >= 0.0, 1.0, -1.0) * self.centres[-1]
        return prism(outline, 0.0, GROUND_UM)

    def views(self) -> dict[str, View]:
        """Return the presets of the camera: x to the right, or up for a pair in a tall picture."""
        tall = -90 if len(self.centres) == 1 else 180
        first, x, reach = self.centres[0], self.centres[-1], RIM_UM + 16.0
        high = (0.0, TOP_UM)
        whole = ((-x - reach, x + reach), (-reach - 50.0, reach), high)
        combs = ((first + BAR_UM, first + BASE_UM + 15.0), (-FOLD_UM, FOLD_UM), high)
        beams = ((first + MASS_UM - 30.0, first + RETURN_UM + 15.0), (40.0, RETURN_UM - 20.0), high)
        return {
            "whole": (whole, (tall, 58), (-90, 58)),
            "top": (whole, (tall, 89.9), (-90, 89.9)),
            "side": (whole, (-90, 14), (-90, 14)),
            "fingers": (combs, (-90, 62), (-90, 62)),
            "beams": (beams, (-90, 62), (-90, 62)),
        }


def rim() -> Mesh:
    """Return the ring around a device."""
    return arc(DISC_UM, RIM_UM, GROUND_UM, GROUND_UM + 8.0, 0.0, 2.0 * np.pi, 96)


def gas() -> Mesh:
    """Return the gas around a device."""
    return prism(circle(DISC_UM - 4.0, 48), GROUND_UM + 2.0, TOP_UM + 16.0)


def mass() -> Flexure:
    """Return the proof mass: a plate with the holes that let the etch through."""
    holes, hole = 3, 14.0
    pitch = 2 * MASS_UM / holes
    middle, t = (LOW_UM + TOP_UM) / 2, TOP_UM - LOW_UM
    solid = (pitch - hole) / 2
    edges = [-MASS_UM + number * pitch for number in range(holes + 1)]
    spans = [(max(-MASS_UM, edge - solid), min(MASS_UM, edge + solid)) for edge in edges]
    boxes = [Box((0.0, (low + high) / 2, middle), (2 * MASS_UM, high - low, t)) for low, high in spans]
    for edge in edges[:-1]:
        y = edge + pitch / 2
        boxes += [Box(((low + high) / 2, y, middle), (high - low, hole, t)) for low, high in spans]
    return rigid(merge(boxes), np.eye(2))


def anchors() -> Mesh:
    """Return the anchors of all beams."""
    places = [(arm, RETURN_UM, side * ANCHOR_UM) for arm in range(4) for side in (-1, 1)]
    return merge(_box(arm, u, v, 20.0, 18.0, GROUND_UM, TOP_UM) for arm, u, v in places)


def bars() -> Flexure:
    """Return all bars with their fingers; each follows the mass along its axis alone."""
    found, length = [], TIP_UM - BAR_UM - BAR_WIDTH_UM / 2
    for axis in AXES:
        for arm in _arms(axis):
            bar = _box(arm, BAR_UM, 0.0, BAR_WIDTH_UM, 2 * BAR_LENGTH_UM, LOW_UM, TOP_UM)
            fingers = _comb(arm, TIP_UM - length / 2, length, range(-3, 4))
            found.append(rigid(merge([bar, *fingers]), along(axis)))
    return join(found)


def stators(axis: str) -> Mesh:
    """Return the fixed combs of an axis."""
    boxes, length = [], BASE_UM - STATOR_UM
    for arm in _arms(axis):
        boxes.append(_box(arm, BASE_UM, 0.0, 18.0, 8 * PITCH_UM, GROUND_UM, TOP_UM))
        boxes += _comb(arm, STATOR_UM + length / 2, length, np.arange(-3.5, 4.0))
    return merge(boxes)


def _comb(arm: int, u: float, length: float, numbers: Iterable[float]) -> list[Box]:
    """Return fingers with their middle at ``u`` along an arm, and so many pitches to its left."""
    return [_box(arm, u, number * PITCH_UM, length, FINGER_UM, LOW_UM, TOP_UM) for number in numbers]


def finger(axis: str, number: float, is_moving: bool) -> Box:
    """Return a finger of the comb at +x or +y by its place in it, a little larger than it is."""
    start, end = (BAR_UM, TIP_UM) if is_moving else (STATOR_UM, BASE_UM)
    size = (end - start + 2.0, FINGER_UM + 3.0)
    return _box(_arms(axis)[0], (start + end) / 2, number * PITCH_UM, *size, LOW_UM - 1.0, TOP_UM + 3.0)


def flexures(axis: str) -> Flexure:
    """Return all beams that bend when the mass moves along an axis, with the trusses between them."""
    still, whole, moved = np.zeros((2, 2)), np.eye(2), along(axis)
    parts = []
    for arm in _arms(axis):
        for side in (-1, 1):
            root, far = side * BAR_LENGTH_UM, side * FOLD_UM
            legs = (
                ((BAR_UM, root), (BAR_UM, far), (moved, 0.5 * moved)),
                ((RETURN_UM, far), (RETURN_UM, root), (0.5 * moved, still)),
            )
            for start, end, follow in legs:
                parts.append(beam(_at(arm, *start), _at(arm, *end), BEAM_UM, LOW_UM, TOP_UM, np.stack(follow)))
            reach = RETURN_UM - BAR_UM + 10.0
            truss = _box(arm, (BAR_UM + RETURN_UM) / 2, far, reach, TRUSS_UM, LOW_UM, TOP_UM)
            parts.append(rigid(merge([truss]), 0.5 * moved))
    # the bars of the other axis do not follow, so the beams to them bend too
    for arm in {0, 1, 2, 3}.difference(_arms(axis)):
        for side in (-1, 1):
            start, end = _at(arm, MASS_UM, side * COUPLING_UM), _at(arm, BAR_UM - 6.0, side * COUPLING_UM)
            parts.append(beam(start, end, BEAM_UM, LOW_UM, TOP_UM, np.stack([whole, whole - moved])))
    return join(parts)


def along(axis: str) -> FloatArray:
    """Return the factors of a part that follows the mass along one axis alone."""
    return np.diag([float(axis == name) for name in AXES])


def base(axis: str) -> Place:
    """Return the place of the words on the comb at +x or +y."""
    x, y = _at(_arms(axis)[0], BASE_UM, 0.0)
    return x, y, TOP_UM


def fold(axis: str) -> Place:
    """Return the place of the words on the beams of an axis."""
    x, y = _at(_arms(axis)[0], BAR_UM, FOLD_UM)
    return x, y, TOP_UM


def _arms(axis: str) -> tuple[int, int]:
    """Return the two arms of an axis; arm n points 90 n degrees from +x."""
    return (0, 2) if axis == "x" else (1, 3)


def _at(arm: int, u: float, v: float) -> tuple[float, float]:
    """Return the place ``u`` along an arm and ``v`` to its left."""
    return ((u, v), (-v, u), (-u, -v), (v, -u))[arm]


def _box(arm: int, u: float, v: float, length: float, width: float, low: float, high: float) -> Box:
    """Return an upright box on an arm."""
    x, y = _at(arm, u, v)
    size = (length, width) if arm % 2 == 0 else (width, length)
    return Box((x, y, (low + high) / 2), (*size, high - low))
