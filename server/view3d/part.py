"""The nodes of a scene as data, and the properties of a moment; here um become the units of viser.

One scene unit is 100 um: viser drops changes below about 1e-5 of a value, so metres would not move.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from server.view3d.colours import Color, in_batch
from server.view3d.solids import Box, FloatArray, Mesh, Place, merge

UM_PER_UNIT = 100.0


@dataclass(frozen=True, eq=False)
class ScenePart:
    """A node of the scene.

    Parameters
    ----------
    kind : str
        The method of viser that adds it, without ``add_``.
    properties : dict
        The arguments of that method.
    """

    kind: str
    properties: dict[str, Any]


class ScenePicture:
    """The scene of a moment.

    Parameters
    ----------
    added : dict of str to Part
        The parts that are on the device at this moment only; a part that stays is the same object.
    """

    def __init__(self, added: dict[str, ScenePart]) -> None:
        self.added = added
        self.nodes: dict[str, dict[str, Any]] = {}
        """The properties of the other nodes, by their names."""

    def set(self, name: str, **properties: Any) -> None:
        """Give a node some properties."""
        self.nodes.setdefault(name, {}).update(properties)


def units(um: ArrayLike) -> NDArray[np.float32]:
    """Return places in scene units."""
    return (np.asarray(um) / UM_PER_UNIT).astype(np.float32)


def place(x: float, y: float = 0.0, z: float = 0.0) -> Place:
    """Return one place in scene units."""
    return x / UM_PER_UNIT, y / UM_PER_UNIT, z / UM_PER_UNIT


def solid(mesh: Mesh, color: Color, **options: Any) -> ScenePart:
    """Return a rigid mesh, or a mesh whose vertices are moved."""
    shape = {"vertices": units(mesh.vertices), "faces": mesh.faces.astype(np.uint32)}
    return ScenePart("mesh_simple", {**shape, "color": color, "flat_shading": True, "side": "double", **options})


def batch(places: FloatArray, size: Place, color: Color) -> ScenePart:
    """Return boxes of one size as one batch; places and size in um."""
    box = merge([Box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))])
    properties = {
        "vertices": box.vertices.astype(np.float32),
        "faces": box.faces.astype(np.uint32),
        "batched_wxyzs": np.tile((1.0, 0.0, 0.0, 0.0), (len(places), 1)),
        "batched_positions": units(places),
        "batched_scales": np.tile(size, (len(places), 1)) / UM_PER_UNIT,
        "batched_colors": in_batch(color),
        "flat_shading": True,
        "lod": "off",
    }
    return ScenePart("batched_meshes_simple", properties)


def label(lines: Iterable[str], where: Place = (0.0, 0.0, 0.0), *, visible: bool = True) -> ScenePart:
    """Return words above a place, um."""
    x, y, z = place(*where)
    properties = {"text": "\n".join(lines), "position": (x, y, z + 0.12), "anchor": "bottom-center"}
    return ScenePart("label", {**properties, "visible": visible})


def frame(x: float = 0.0, y: float = 0.0) -> ScenePart:
    """Return a frame at a place that carries other parts, um."""
    return ScenePart("frame", {"show_axes": False, "position": place(x, y)})


def lines(points: FloatArray, color: Color) -> ScenePart:
    """Return lines between pairs of points, shape (lines, 2, 3), um."""
    return ScenePart(
        "line_segments", {"points": units(points), "colors": color, "thickness": 2.0, "thickness_units": "screen"}
    )
