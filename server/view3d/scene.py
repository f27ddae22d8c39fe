"""The scene of one device: a viser server of its own with light, a caption, and the parts."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from server.view3d.device import DeviceModel
from server.view3d.part import ScenePart, ScenePicture
from server.view3d.pose import Pose
from server.view3d.private import PrivateServer


class Scene:
    """The picture of one bench.

    Parameters
    ----------
    device : Device
        Its parts, and how a pose moves them.
    """

    def __init__(self, device: DeviceModel[Any]) -> None:
        self._device = device
        self._private = PrivateServer()
        self._server = self._private.viser
        scene = self._server.scene
        # viser's own lights bleach every colour to white
        scene.configure_default_lights(False)
        scene.configure_environment_map(None)
        scene.add_light_ambient("/lights/around", intensity=1.5)
        scene.add_light_directional("/lights/above", intensity=1.8, position=(-4.0, -3.0, 9.0))
        scene.world_axes.visible = False
        # the page writes them at the edge of the picture, where no camera can lose them
        words = {name: scene.add_label(name, "", visible=False) for name in ("/caption", "/when")}
        self.nodes: dict[str, Any] = words | {name: self._put(name, part) for name, part in device.parts().items()}
        self.added: dict[str, Any] = {}
        """The nodes of faults and light."""
        self._picture = ScenePicture({})
        self._shown: Pose | None = None

    @property
    def path(self) -> Path:
        """The Unix socket of the scene, which only this user can open."""
        return self._private.path

    def close(self) -> None:
        """Stop the server and disconnect its clients."""
        self._private.stop()

    def show(self, pose: Pose) -> None:
        """Show a moment; nothing is sent if nothing changed."""
        if pose == self._shown:
            return
        self._shown = pose
        with self._server.atomic():
            before, self._picture = self._picture, self._device.picture(pose)
            picture = self._picture
            gone = [name for name, part in before.added.items() if picture.added.get(name) is not part]
            for name in gone:
                self.added.pop(name).remove()
            for name, part in picture.added.items():
                if name not in self.added:
                    self.added[name] = self._put(name, part)
            for name, properties in picture.nodes.items():
                known = before.nodes.get(name, {})
                for key, value in properties.items():
                    if value is not known.get(key):
                        setattr(self.nodes[name], key, value)  # viser sends it if it is not equal either
        self._server.flush()

    def _put(self, name: str, part: ScenePart) -> Any:
        """Add a node."""
        return getattr(self._server.scene, f"add_{part.kind}")(name, **part.properties)
