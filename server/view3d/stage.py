"""The stage of a scene: a viser server of its own with light, a caption, and meshes and labels put on it."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from server.view3d.colours import Color, in_batch
from server.view3d.layout import UM_PER_UNIT, FloatArray, Mesh, unit_box
from server.view3d.marks import Place
from server.view3d.private import PrivateServer


class Stage:
    """One viser server; a scene puts the parts of its device on it."""

    def __init__(self) -> None:
        self._private = PrivateServer()
        self._server = self._private.viser
        scene = self._server.scene
        # viser's own lights bleach every colour to white
        scene.configure_default_lights(False)
        scene.configure_environment_map(None)
        scene.add_light_ambient("/lights/around", intensity=1.5)
        scene.add_light_directional("/lights/above", intensity=1.8, position=(-4.0, -3.0, 9.0))
        scene.world_axes.visible = False
        # the page writes it at the edge of the picture, where no camera can lose it
        self._caption = scene.add_label("/caption", "", visible=False)
        self._when = scene.add_label("/when", "", visible=False)

    @property
    def path(self) -> Path:
        """The Unix socket of the scene, which only this user can open."""
        return self._private.path

    def close(self) -> None:
        """Stop the server and disconnect its clients."""
        self._private.stop()

    def say(self, caption: str, when: str) -> None:
        """Write the caption, and the moment if it is not the present."""
        self._caption.text, self._when.text = caption, when

    def mesh(self, name: str, mesh: Mesh, color: Color, **options: Any) -> Any:
        """Add a rigid mesh, or a mesh whose vertices are moved."""
        vertices, faces = mesh.vertices.astype(np.float32), mesh.faces.astype(np.uint32)
        return self._server.scene.add_mesh_simple(
            name, vertices, faces, color=color, flat_shading=True, side="double", **options
        )

    def batch(self, name: str, places: FloatArray, size: Place, color: Color) -> Any:
        """Add boxes of one size as one batch; places and size in um."""
        box = unit_box()
        return self._server.scene.add_batched_meshes_simple(
            name,
            box.vertices.astype(np.float32),
            box.faces.astype(np.uint32),
            batched_wxyzs=np.tile((1.0, 0.0, 0.0, 0.0), (len(places), 1)),
            batched_positions=places / UM_PER_UNIT,
            batched_scales=np.tile(size, (len(places), 1)) / UM_PER_UNIT,
            batched_colors=in_batch(color),
            flat_shading=True,
            lod="off",
        )

    def label(self, name: str, lines: Iterable[str], place: Place) -> Any:
        """Write words above a place, um."""
        x, y, z = (value / UM_PER_UNIT for value in place)
        return self._server.scene.add_label(name, "\n".join(lines), position=(x, y, z + 0.12), anchor="bottom-center")

    def frame(self, name: str, place: Place) -> Any:
        """Add a frame that carries other parts, um."""
        return self._server.scene.add_frame(name, show_axes=False, position=np.array(place) / UM_PER_UNIT)

    def lines(self, name: str, points: FloatArray, color: Color) -> Any:
        """Add lines between pairs of points, shape (lines, 2, 3), in scene units."""
        return self._server.scene.add_line_segments(name, points, color, thickness=2.0, thickness_units="screen")
