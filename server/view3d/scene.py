"""The scene of one bench: the shuttle moves and turns, the beams bend, marks show the faults."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from server.view3d.layout import UM_PER_UNIT, Box, Layout, Mesh, merge, unit_box
from server.view3d.marks import LEFT, RIGHT, Marks, Place, ball, marks
from server.view3d.pose import Active, Laser, Pose
from server.view3d.private import PrivateServer
from server.view3d.suspension import Flexure, flexure

Color = tuple[int, int, int]

SILICON, MOVING, FIXED, GROUND = (150, 158, 170), (86, 180, 233), (110, 118, 130), (52, 58, 68)
REFERENCE, ESTIMATE, LIGHT = (223, 228, 234), (31, 184, 143), (240, 110, 190)
ATTENTION = (232, 64, 52)
SIDES = ((1, "right", RIGHT), (-1, "left", LEFT))
BEAM_UM, ABOVE_UM, BELOW_UM, SPOT_UM = 3.0, 130.0, 90.0, 5.0
"""Sizes of the light, large enough to see."""


class Scene:
    """One viser server with the device of one bench.

    Parameters
    ----------
    layout : Layout
        Where the parts are.
    """

    def __init__(self, layout: Layout) -> None:
        self._layout = layout
        self._private = PrivateServer()
        self._server = self._private.viser
        self._shown = Pose()
        self._marks = Marks(layout)
        self._added: list[Any] = []
        self._lights: list[Any] = []
        self._build()

    @property
    def path(self) -> Path:
        """The Unix socket of the scene, which only this user can open."""
        return self._private.path

    def show(self, pose: Pose) -> None:
        """Move the parts; nothing is sent if nothing changed."""
        before, self._shown = self._shown, pose
        if pose == before:
            return
        with self._server.atomic():
            if _seen(pose.faults) != _seen(before.faults) or pose.contact != before.contact:
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
            if pose.caption != before.caption:
                self._caption.text = pose.caption
        self._server.flush()

    def close(self) -> None:
        """Stop the server and disconnect its clients."""
        self._private.stop()

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
            self._added.append(self._mesh(path, solid.mesh, ATTENTION))
        labels: dict[Place, list[str]] = dict(now.labels)
        if pose.contact:
            side = 1 if abs(pose.combs_um[0]) >= abs(pose.combs_um[1]) else -1
            place = (side * self._layout.stator_um, 0.45 * self._layout.comb_um, self._layout.top_um)
            labels[place] = [*labels.get(place, []), "Fingers touch"]
        for number, (place, lines) in enumerate(labels.items()):
            x, y, z = (value / UM_PER_UNIT for value in place)
            label = self._server.scene.add_label(
                f"/labels/{number}", "\n".join(lines), position=(x, y, z + 0.12), anchor="bottom-center"
            )
            self._added.append(label)
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
        """Show the beams of light, which stand still."""
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
                self._mesh(f"/light/{number}", beam, LIGHT, opacity=0.6),
                self._mesh(f"/spot/{number}", spot, LIGHT),
            ]

    def _build(self) -> None:
        """Build all parts, once."""
        scene, layout = self._server.scene, self._layout
        # viser's own lights bleach every colour to white
        scene.configure_default_lights(False)
        scene.configure_environment_map(None)
        scene.add_light_ambient("/lights/around", intensity=1.5)
        scene.add_light_directional("/lights/above", intensity=1.8, position=(-4.0, -3.0, 9.0))
        scene.world_axes.visible = False
        self._mesh("/ground", layout.ground(), GROUND)
        self._mesh("/anchors", layout.anchors(), FIXED)
        self._bases = self._mesh("/bases", layout.bases(), FIXED)
        self._film = self._mesh("/film", layout.film(), ATTENTION, opacity=0.2, visible=False)
        self._stators = {name: self._comb(f"/stators/{name}", layout.stators(side), FIXED) for side, name, _ in SIDES}
        self._places = {name: layout.fingers(side) for side, name, _ in SIDES}
        self._fingers = {name: self._comb(f"/fingers/{name}", self._places[name], MOVING) for _, name, _ in SIDES}
        self._shuttle = scene.add_frame("/shuttle", show_axes=False)
        self._mesh("/shuttle/plate", layout.shuttle(), MOVING)
        self._flexures: list[Flexure] = [flexure(layout, side) for side in (1, -1)]
        self._beams = [
            self._mesh(f"/beams/{name}", Mesh(bending.bent(0.0, 0.0, 0.0), bending.faces), SILICON)
            for name, bending in zip(("plus", "minus"), self._flexures, strict=True)
        ]
        self._reference = self._ghost("/reference", REFERENCE)
        self._estimate = self._ghost("/estimate", ESTIMATE)
        self._estimate.visible = False
        # the page writes it at the edge of the picture, where no camera can lose it
        self._caption = scene.add_label("/caption", "", visible=False)

    def _ghost(self, name: str, color: Color) -> Any:
        """Add the outline of a shuttle that is elsewhere."""
        scene = self._server.scene
        ghost = scene.add_frame(name, show_axes=False)
        outline = self._layout.outline()
        scene.add_line_segments(f"{name}/outline", outline, color, thickness=2.0, thickness_units="screen")
        return ghost

    def _mesh(self, name: str, mesh: Mesh, color: Color, **options: Any) -> Any:
        """Add a rigid mesh, or one whose vertices are moved."""
        vertices, faces = mesh.vertices.astype(np.float32), mesh.faces.astype(np.uint32)
        return self._server.scene.add_mesh_simple(
            name, vertices, faces, color=color, flat_shading=True, side="double", **options
        )

    def _comb(self, name: str, places: Any, color: Color) -> Any:
        """Add all fingers of a kind as one batch."""
        box = unit_box()
        return self._server.scene.add_batched_meshes_simple(
            name,
            box.vertices.astype(np.float32),
            box.faces.astype(np.uint32),
            batched_wxyzs=np.tile((1.0, 0.0, 0.0, 0.0), (len(places), 1)),
            batched_positions=places / UM_PER_UNIT,
            batched_scales=np.tile(self._layout.finger_size, (len(places), 1)) / UM_PER_UNIT,
            batched_colors=in_batch(color),
            flat_shading=True,
            lod="off",
        )


def blend(first: Color, second: Color, share: float) -> Color:
    """Mix two colours."""
    red, green, blue = (round(a + (b - a) * share) for a, b in zip(first, second, strict=True))
    return red, green, blue


def in_batch(color: Color) -> NDArray[np.uint8]:
    """Return a colour for a batch: viser takes colours of batches as linear, all others as sRGB."""
    share = np.array(color) / 255.0
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    return np.asarray(np.round(255.0 * linear), dtype=np.uint8)


def _seen(faults: tuple[Active, ...]) -> list[Any]:
    """Return the visible part of the faults; a ramp moves in steps of two figures, not at every frame."""
    return [(fault.block, fault.params, f"{fault.severity:.2g}") for fault in faults]
