"""The scene of one bench: a shuttle that moves, beams that bend, faults where they act."""

from __future__ import annotations

import contextlib
import io
from dataclasses import dataclass
from typing import Any

import numpy as np
import viser
from viser import _messages as viser_messages

from server.view3d.layout import UM_PER_UNIT, Layout, Mesh, unit_box

SILICON, MOVING, FIXED, GROUND = (150, 158, 170), (86, 180, 233), (110, 118, 130), (52, 58, 68)
GHOST, FAULT, GAS = (240, 228, 66), (213, 94, 0), (213, 94, 0)
MASS_UM = 30.0
STILL = (1.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Pose:
    """What the scene shows of one moment.

    Parameters
    ----------
    displacement_um, reference_um : float
        Of the shuttle and of its reference model, exaggerated.
    added_mass, stiffness, damping : float
        Severities of the faults at that moment.
    caption : str
        What is not as in nature.
    """

    displacement_um: float
    reference_um: float
    added_mass: float
    stiffness: float
    damping: float
    caption: str


class Scene:
    """One viser server on loopback, with the device of one bench.

    Parameters
    ----------
    layout : Layout
        Where the parts are.
    """

    def __init__(self, layout: Layout) -> None:
        self._layout = layout
        with contextlib.redirect_stdout(io.StringIO()):  # it prints a banner whatever it is told
            self._server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
        # Any client could open a public tunnel to this port with these.
        for message in (viser_messages.ShareUrlRequest, viser_messages.ShareUrlDisconnect):
            self._server._websock_server.unregister_handler(message)
        self._server.gui.configure_theme(dark_mode=True, show_logo=False, show_share_button=False)
        self._shown: Pose | None = None
        self._build()

    @property
    def port(self) -> int:
        """Port of the viser server on loopback."""
        return int(self._server.get_port())

    def show(self, pose: Pose) -> None:
        """Move the parts; nothing is sent if nothing changed."""
        if pose == self._shown:
            return
        before, self._shown = self._shown, pose
        with self._server.atomic():
            x = pose.displacement_um / UM_PER_UNIT
            self._shuttle.position = (x, 0.0, 0.0)
            for bone, share in ((1, 1.0), (2, 0.5), (3, 0.5)):
                self._suspension.bones[bone].position = (share * x, 0.0, 0.0)
            self._ghost.position = (pose.reference_um / UM_PER_UNIT, 0.0, 0.0)
            if before is None or before.caption != pose.caption:
                self._caption.text = pose.caption
            self._show_faults(pose, before)
        self._server.flush()

    def close(self) -> None:
        """Stop the server and let its clients go."""
        with contextlib.redirect_stdout(io.StringIO()):
            self._server.stop()

    def _show_faults(self, pose: Pose, before: Pose | None) -> None:
        """Show each fault on the part it acts on."""
        if before is None or before.added_mass != pose.added_mass:
            self._mass.visible = pose.added_mass != 0.0
            height = min(4.0, max(0.4, 20.0 * abs(pose.added_mass)))
            self._mass.scale = (MASS_UM / UM_PER_UNIT, MASS_UM / UM_PER_UNIT, height * 1.5 / UM_PER_UNIT)
        if before is None or before.stiffness != pose.stiffness:
            self._suspension.color = _blend(SILICON, FAULT, min(1.0, 5.0 * abs(pose.stiffness)))
        if before is None or before.damping != pose.damping:
            self._film.visible = pose.damping != 0.0
            self._film.opacity = min(0.75, 0.15 + 0.5 * abs(pose.damping))

    def _build(self) -> None:
        """Put everything in place, once; afterwards only positions and colours change."""
        scene, layout = self._server.scene, self._layout
        scene.configure_default_lights(True, cast_shadow=False)
        scene.world_axes.visible = False
        span = layout.half_width_um / UM_PER_UNIT
        self._server.initial_camera.position = (span * 0.3, -span * 0.9, span * 1.1)
        self._server.initial_camera.look_at = (0.0, 0.0, 0.0)
        self._mesh("/ground", layout.ground(), GROUND)
        self._mesh("/anchors", layout.anchors(), FIXED)
        self._film = self._mesh("/film", layout.film(), GAS, opacity=0.2, visible=False)
        self._comb("/stators", *layout.stators(), FIXED)
        self._shuttle = scene.add_frame("/shuttle", show_axes=False)
        self._mesh("/shuttle/plate", layout.shuttle(), MOVING)
        self._comb("/shuttle/fingers", *layout.fingers(), MOVING)
        box = unit_box()
        top = (layout.z + layout.geometry.thickness_um) / UM_PER_UNIT
        self._mass = self._mesh("/shuttle/added-mass", box, FAULT, visible=False)
        self._mass.position = (-0.62, 0.0, top)
        self._ghost = scene.add_frame("/reference", show_axes=False)
        outline = layout.outline()
        scene.add_line_segments("/reference/outline", outline, GHOST, thickness=2.0, thickness_units="screen")
        suspension = layout.suspension()
        self._suspension = scene.add_mesh_skinned(
            "/suspension",
            suspension.vertices.astype(np.float32),
            suspension.faces.astype(np.uint32),
            bone_wxyzs=(STILL,) * 4,
            bone_positions=((0.0, 0.0, 0.0),) * 4,
            skin_weights=suspension.weights,
            color=SILICON,
            flat_shading=True,
            side="double",
        )
        self._caption = scene.add_label("/caption", "", position=(0.0, span * 1.02, 0.1))

    def _mesh(self, name: str, mesh: Mesh, color: tuple[int, int, int], **more: Any) -> Any:
        """Add a rigid mesh."""
        vertices, faces = mesh.vertices.astype(np.float32), mesh.faces.astype(np.uint32)
        return self._server.scene.add_mesh_simple(
            name, vertices, faces, color=color, flat_shading=True, side="double", **more
        )

    def _comb(self, name: str, places: Any, scales: Any, color: tuple[int, int, int]) -> None:
        """Add all fingers of a kind as one batch."""
        box = unit_box()
        self._server.scene.add_batched_meshes_simple(
            name,
            box.vertices.astype(np.float32),
            box.faces.astype(np.uint32),
            batched_wxyzs=np.tile(np.array(STILL), (len(places), 1)),
            batched_positions=places,
            batched_scales=scales,
            batched_colors=color,
            flat_shading=True,
            lod="off",
        )


def _blend(first: tuple[int, int, int], second: tuple[int, int, int], share: float) -> tuple[int, int, int]:
    """Mix two colours."""
    red, green, blue = (round(a + (b - a) * share) for a, b in zip(first, second, strict=True))
    return red, green, blue
