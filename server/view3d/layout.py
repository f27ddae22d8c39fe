"""Where the parts of a comb resonator are: boxes and meshes in um, from its drawing.

One scene unit is 100 um: viser drops changes below about 1e-5 of a value, so metres would not move.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.device.geometry import Geometry

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

UM_PER_UNIT = 100.0
GROUND_UM = 0.5
FILM_UM = 2.0
BASE_UM = 30.0
NOTCH_UM = 32.0
"""Half width of the waist, where the inner beams pass on their way to the anchors."""
BEAM_SEGMENTS = 14
WAIST_UM = 12.5


@dataclass(frozen=True)
class Box:
    """An upright box: centre and size in um."""

    centre: tuple[float, float, float]
    size: tuple[float, float, float]


@dataclass(frozen=True)
class Mesh:
    """A triangle mesh in scene units."""

    vertices: FloatArray
    faces: IntArray


@dataclass(frozen=True)
class Skinned(Mesh):
    """A mesh that bends; ``weights`` ``(vertices, bones)`` says which bone moves a vertex how far."""

    weights: FloatArray


_CORNERS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
_FACES = np.array(
    [
        [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
        [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
    ]
)  # fmt: skip


def unit_box() -> Mesh:
    """Return a box of one scene unit, to be scaled."""
    return Mesh(_CORNERS.copy(), _FACES.copy())


def merge(boxes: Iterable[Box]) -> Mesh:
    """Join boxes into one mesh."""
    vertices, faces = [], []
    for number, box in enumerate(boxes):
        vertices.append((_CORNERS * box.size + box.centre) / UM_PER_UNIT)
        faces.append(_FACES + 8 * number)
    return Mesh(np.vstack(vertices), np.vstack(faces))


class Layout:
    """The parts of a folded-flexure comb resonator.

    Parameters
    ----------
    geometry : Geometry
        The drawing.
    """

    def __init__(self, geometry: Geometry) -> None:
        g = self.geometry = geometry
        self.z = GROUND_UM + FILM_UM + g.thickness_um / 2
        self.finger_um = g.finger_width_um - 2 * g.comb_bias_um
        self.pitch_um = 2 * (self.finger_um + g.gap_um)
        self.inner_um, self.outer_um = g.truss_segment_um / 2, 1.5 * g.truss_segment_um
        self.plate_um = g.plate_length_um / 2
        self.arm_um = self.plate_um + g.arm_width_um
        self.tip_um = self.arm_um + g.finger_length_um
        self.stator_um = self.tip_um - g.overlap_um
        self.beam_from_um = g.plate_width_um / 2
        self.beam_to_um = self.beam_from_um + g.beam_length_um
        self.half_width_um = max(self.beam_to_um + g.truss_um, g.arm_length_um / 2) + 20
        self.half_length_um = self.stator_um + g.finger_length_um + BASE_UM + 10

    def ground(self) -> Mesh:
        """Return the plane under everything."""
        size = (2 * self.half_length_um, 2 * self.half_width_um, GROUND_UM)
        return merge([Box((0, 0, GROUND_UM / 2), size)])

    def film(self) -> Mesh:
        """Return the gas between plate and ground."""
        size = (2 * self.tip_um, self.geometry.arm_length_um, FILM_UM * 0.8)
        return merge([Box((0, 0, GROUND_UM + FILM_UM / 2), size)])

    def anchors(self) -> Mesh:
        """Return the two anchors of the suspension and the bases of the stators."""
        height = GROUND_UM + FILM_UM + self.geometry.thickness_um
        width = 2 * self.inner_um + 6
        boxes = [Box((0, side * (self.beam_from_um - 10), height / 2), (width, 20, height)) for side in (-1, 1)]
        base = self.stator_um + self.geometry.finger_length_um + BASE_UM / 2
        length = max(self.geometry.arm_length_um, self.comb_um + self.pitch_um)
        boxes += [Box((side * base, 0, height / 2), (BASE_UM, length, height)) for side in (-1, 1)]
        return merge(boxes)

    def shuttle(self) -> Mesh:
        """Return the rigid plate with its grating, and the arms that carry the fingers."""
        g = self.geometry
        t, boxes = g.thickness_um, []
        for side in (-1, 1):
            middle = side * (NOTCH_UM + self.plate_um) / 2
            boxes.append(Box((middle, 0, self.z), (self.plate_um - NOTCH_UM, g.plate_width_um, t)))
            arm = side * (self.plate_um + g.arm_width_um / 2)
            boxes.append(Box((arm, 0, self.z), (g.arm_width_um, g.arm_length_um, t)))
            # Strips beside the grating, and lugs out to the outer beams.
            boxes.append(Box((0, side * (WAIST_UM + 6) / 2, self.z), (2 * NOTCH_UM, WAIST_UM - 6, t)))
        boxes += [Box((x, 0, self.z), (2, 12, t)) for x in np.arange(-30.0, 31.0, 4.0)]
        return merge(boxes)

    def outline(self) -> FloatArray:
        """Return the edges of plate and arms, ``(n, 2, 3)`` in scene units, just above them."""
        g, top = self.geometry, self.z + self.geometry.thickness_um
        edges = []
        for side in (-1, 1):
            for x, y in (
                ((self.plate_um, self.arm_um), g.arm_length_um / 2),
                ((NOTCH_UM, self.plate_um), g.plate_width_um / 2),
            ):
                corners = [(x[0], -y), (x[1], -y), (x[1], y), (x[0], y)]
                points = [(side * a, b, top) for a, b in corners]
                edges += [(points[k], points[(k + 1) % 4]) for k in range(4)]
        return np.array(edges) / UM_PER_UNIT

    @property
    def comb_um(self) -> float:
        """Extent of the combs along y, between the outermost fingers."""
        return (self.geometry.fingers - 1) * self.pitch_um

    def fingers(self) -> tuple[FloatArray, FloatArray]:
        """Return positions and scales of the moving fingers, in scene units."""
        y = np.linspace(-self.comb_um / 2, self.comb_um / 2, self.geometry.fingers)
        return self._comb((self.arm_um + self.tip_um) / 2, y)

    def stators(self) -> tuple[FloatArray, FloatArray]:
        """Return positions and scales of the fixed fingers, in scene units."""
        half = (self.comb_um + self.pitch_um) / 2
        y = np.linspace(-half, half, self.geometry.fingers + 1)
        return self._comb(self.stator_um + self.geometry.finger_length_um / 2, y)

    def _comb(self, x: float, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Place one finger per ``y`` on both sides."""
        places = np.array([[side * x, value, self.z] for side in (-1.0, 1.0) for value in y])
        size = (self.geometry.finger_length_um, self.finger_um, self.geometry.thickness_um)
        return places / UM_PER_UNIT, np.tile(np.array(size) / UM_PER_UNIT, (len(places), 1))

    def suspension(self) -> Skinned:
        r"""Return the eight beams and two trusses, weighted to four bones.

        Bones are anchors, shuttle, upper truss, lower truss. With the weight
        :math:`h(s)=3s^2-2s^3` along a beam, moving a bone bends the beam exactly as a guided-guided
        beam bends: no approximation is left.
        """
        g = self.geometry
        parts: list[Skinned] = []
        for side, truss in ((1.0, 2), (-1.0, 3)):
            for x, root in (
                (-self.outer_um, 1), (-self.inner_um, 0), (self.inner_um, 0), (self.outer_um, 1)
            ):  # fmt: skip
                parts.append(self._beam(x, side, root, truss))
            y = side * (self.beam_to_um + g.truss_um / 2)
            mesh = merge([Box((0, y, self.z), (2 * self.outer_um + g.beam_um, g.truss_um, g.thickness_um))])
            parts.append(Skinned(mesh.vertices, mesh.faces, np.tile(np.eye(4)[truss], (8, 1))))
        starts = np.cumsum([0] + [len(part.vertices) for part in parts[:-1]])
        return Skinned(
            np.vstack([part.vertices for part in parts]),
            np.vstack([part.faces + start for part, start in zip(parts, starts, strict=True)]),
            np.vstack([part.weights for part in parts]),
        )

    def _beam(self, x: float, side: float, root: int, truss: int) -> Skinned:
        """Return one beam from its root (anchor or shuttle) to its truss."""
        g = self.geometry
        s = np.linspace(0.0, 1.0, BEAM_SEGMENTS + 1)
        y = side * (self.beam_from_um + s * g.beam_length_um)
        w, t = g.beam_um / 2, g.thickness_um / 2
        ring = [(-w, -t), (w, -t), (w, t), (-w, t)]
        vertices = np.array([[x + dx, yy, self.z + dz] for yy in y for dx, dz in ring]) / UM_PER_UNIT
        faces = []
        for k in range(BEAM_SEGMENTS):
            a, b = 4 * k, 4 * (k + 1)
            for i in range(4):
                j = (i + 1) % 4
                faces += [[a + i, a + j, b + j], [a + i, b + j, b + i]]
        bend = np.repeat(3 * s**2 - 2 * s**3, 4)
        weights = np.zeros((len(vertices), 4))
        weights[:, root] = 1 - bend
        weights[:, truss] = bend
        return Skinned(vertices, np.array(faces), weights)
