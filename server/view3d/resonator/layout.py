"""The measures of a comb resonator, its parts and their places in um, from its drawing."""

from __future__ import annotations

import numpy as np

from core.device.geometry import Geometry
from server.view3d.solids import Box, FloatArray, Mesh, Place, View, merge

HEIGHTS, WIDTHS = 4.0, 2.5
"""Factor on heights, and on widths of beams and trusses: a film of 2 um is invisible across 800 um."""
GROUND_UM = 2.0
FILM_UM = 2.0 * HEIGHTS
BASE_UM = 30.0
NOTCH_UM = 32.0
"""Half width of the waist, where the inner beams pass on their way to the anchors."""
WAIST_UM = 12.5


class Layout:
    """The parts of a folded-flexure comb resonator.

    Parameters
    ----------
    geometry : Geometry
        The drawing.
    """

    def __init__(self, geometry: Geometry) -> None:
        g = self.geometry = geometry
        self.thick_um = HEIGHTS * g.thickness_um
        self.beam_um, self.truss_um = WIDTHS * g.beam_um, WIDTHS * g.truss_um
        self.z = GROUND_UM + FILM_UM + self.thick_um / 2
        self.finger_um = g.finger_width_um - 2 * g.comb_bias_um
        self.pitch_um = 2 * (self.finger_um + g.gap_um)
        self.inner_um, self.outer_um = g.truss_segment_um / 2, 1.5 * g.truss_segment_um
        self.plate_um = g.plate_length_um / 2
        self.arm_um = self.plate_um + g.arm_width_um
        self.tip_um = self.arm_um + g.finger_length_um
        self.stator_um = self.tip_um - g.overlap_um
        self.beam_from_um = g.plate_width_um / 2
        self.beam_to_um = self.beam_from_um + g.beam_length_um
        self.half_width_um = max(self.beam_to_um + g.truss_um, g.arm_length_um / 2) + 28
        self.half_length_um = self.stator_um + g.finger_length_um + BASE_UM + 10

    def ground(self) -> Mesh:
        """Return the plane under everything."""
        size = (2 * self.half_length_um, 2 * self.half_width_um, GROUND_UM)
        return merge([Box((0, 0, GROUND_UM / 2), size)])

    def film(self) -> Mesh:
        """Return the gas between plate and ground."""
        size = (2 * self.tip_um, self.geometry.arm_length_um, FILM_UM * 0.8)
        return merge([Box((0, 0, GROUND_UM + FILM_UM / 2), size)])

    @property
    def top_um(self) -> float:
        """Height of the upper surface of the polysilicon."""
        return GROUND_UM + FILM_UM + self.thick_um

    @property
    def base_um(self) -> float:
        """Distance of the middle of a stator's base from the centre."""
        return self.stator_um + self.geometry.finger_length_um + BASE_UM / 2

    def anchors(self) -> Mesh:
        """Return the two anchors of the suspension."""
        width, height = 2 * self.inner_um + 6, self.top_um
        return merge(Box((0, side * (self.beam_from_um - 10), height / 2), (width, 20, height)) for side in (-1, 1))

    def bases(self) -> Mesh:
        """Return the bases of the two stators."""
        length = max(self.geometry.arm_length_um, self.comb_um + self.pitch_um)
        size = (BASE_UM, length, self.top_um)
        return merge(Box((side * self.base_um, 0, self.top_um / 2), size) for side in (-1, 1))

    def shuttle(self) -> Mesh:
        """Return the rigid plate with its grating, and the arms that carry the fingers."""
        g = self.geometry
        t, boxes = self.thick_um, []
        for side in (-1, 1):
            middle = side * (NOTCH_UM + self.plate_um) / 2
            boxes.append(Box((middle, 0, self.z), (self.plate_um - NOTCH_UM, g.plate_width_um, t)))
            arm = side * (self.plate_um + g.arm_width_um / 2)
            boxes.append(Box((arm, 0, self.z), (g.arm_width_um, g.arm_length_um, t)))
            # Strips next to the grating, and lugs out to the outer beams.
            boxes.append(Box((0, side * (WAIST_UM + 6) / 2, self.z), (2 * NOTCH_UM, WAIST_UM - 6, t)))
        boxes += [Box((x, 0, self.z), (2, 12, t)) for x in np.arange(-30.0, 31.0, 4.0)]
        return merge(boxes)

    def outline(self) -> FloatArray:
        """Return the edges of plate and arms, ``(n, 2, 3)``, just above them."""
        g, top = self.geometry, self.top_um + 1.0
        edges = []
        for side in (-1, 1):
            for x, y in (
                ((self.plate_um, self.arm_um), g.arm_length_um / 2),
                ((NOTCH_UM, self.plate_um), g.plate_width_um / 2),
            ):
                corners = [(x[0], -y), (x[1], -y), (x[1], y), (x[0], y)]
                points = [(side * a, b, top) for a, b in corners]
                edges += [(points[k], points[(k + 1) % 4]) for k in range(4)]
        return np.array(edges)

    def views(self) -> dict[str, View]:
        """Return the presets of the camera.

        Tall pictures have +x to the right; in wide pictures the device is turned, +x up.
        """
        top, length, width = self.top_um, self.half_length_um, self.half_width_um
        whole = ((-length, length), (-width, width), (0.0, top))
        tips = (0.39 * self.comb_um, 0.5 * self.comb_um + self.geometry.gap_um)
        comb = ((self.plate_um, self.base_um), tips, (0.0, top))
        beams = ((-2 * self.outer_um, 2 * self.outer_um), (-20.0, self.beam_to_um + 25.0), (0.0, top))
        return {
            "whole": (whole, (-80, 56), (190, 54)),
            "top": (whole, (-90, 89.9), (180, 89.9)),
            "side": (whole, (-90, 14), (180, 14)),
            "fingers": (comb, (-90, 62), (-90, 62)),
            "beams": (beams, (-80, 56), (190, 56)),
        }

    def places(self) -> dict[str, Place]:
        """Return the places of marks and labels; a label without a part is at the edge."""
        top, half = self.top_um, self.geometry.arm_length_um / 2
        shock = -0.88 * self.half_width_um
        return {
            "plate": (-0.6 * self.plate_um, 0.0, top + 20),
            "beams": (self.outer_um, self.beam_from_um + 0.5 * self.geometry.beam_length_um, top),
            "trusses": (0.0, self.beam_to_um, top),
            "film": (-self.arm_um, -0.6 * half, top),
            "fingers": (self.tip_um, -0.6 * half, top),
            "drive": (self.base_um, 0.0, top),
            "sensor": (0.0, 0.0, top + 60),
            "frame": (-self.half_length_um, -0.8 * self.half_width_um, top),
            "shock": (0.0, shock, top),
            "shocked": (0.0, 0.8 * shock, top + 6.0),  # further in, because the words are wider than the arrow
            "": (-self.half_length_um, 0.8 * self.half_width_um, top),
        }

    @property
    def comb_um(self) -> float:
        """Extent of the combs along y, between the outermost fingers."""
        return (self.geometry.fingers - 1) * self.pitch_um

    def fingers(self, side: float) -> FloatArray:
        """Return where the moving fingers of one side are, um."""
        y = np.linspace(-self.comb_um / 2, self.comb_um / 2, self.geometry.fingers)
        return self._comb(side * (self.arm_um + self.tip_um) / 2, y)

    def stators(self, side: float) -> FloatArray:
        """Return where the fixed fingers of one side are, um."""
        half = (self.comb_um + self.pitch_um) / 2
        y = np.linspace(-half, half, self.geometry.fingers + 1)
        return self._comb(side * (self.stator_um + self.geometry.finger_length_um / 2), y)

    @property
    def finger_size(self) -> Place:
        """Length, width and height of a finger, um."""
        return self.geometry.finger_length_um, self.finger_um, self.thick_um

    def _comb(self, x: float, y: FloatArray) -> FloatArray:
        """Place one finger per ``y``."""
        return np.column_stack([np.full(len(y), x), y, np.full(len(y), self.z)])
