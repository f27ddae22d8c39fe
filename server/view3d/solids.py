"""Solids as triangle meshes, um: boxes, balls, arrows, upright prisms and arcs of a ring."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Place = tuple[float, float, float]
View = tuple[tuple[tuple[float, float], ...], tuple[float, float], tuple[float, float]]
"""The view of a camera: a box in um, and azimuth and elevation for a tall and for a wide picture."""


@dataclass(frozen=True)
class Box:
    """An upright box: centre and size in um."""

    centre: Place
    size: Place


@dataclass(frozen=True, eq=False)
class Mesh:
    """A triangle mesh, um."""

    vertices: FloatArray
    faces: IntArray


_CORNERS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
_FACES = np.array(
    [
        [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
        [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
    ]
)  # fmt: skip


def merge(boxes: Iterable[Box]) -> Mesh:
    """Join boxes into one mesh."""
    vertices, faces = [], []
    for number, box in enumerate(boxes):
        vertices.append(_CORNERS * box.size + box.centre)
        faces.append(_FACES + 8 * number)
    return Mesh(np.vstack(vertices), np.vstack(faces))


def turned(box: Box, angle: float) -> Mesh:
    """Return a box turned about the vertical through its centre."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return Mesh((_CORNERS * box.size) @ turn.T + np.array(box.centre), _FACES)


def ball(centre: Place, radius: float, stretch: Place = (1.0, 1.0, 1.0)) -> Mesh:
    """Return an icosahedron."""
    g = (1.0 + 5.0**0.5) / 2.0
    corners = [(0.0, a, b * g) for a in (-1, 1) for b in (-1, 1)]
    points = np.array([np.roll(corner, k) for k in range(3) for corner in corners])
    near = np.linalg.norm(points[:, None] - points[None], axis=2) < 2.01
    faces = [
        (i, j, k)
        for i in range(12)
        for j in range(i + 1, 12)
        for k in range(j + 1, 12)
        if near[i, j] and near[j, k] and near[i, k]
    ]
    scaled = points / np.linalg.norm(points[0]) * radius * np.array(stretch)
    return Mesh(scaled + centre, np.array(faces))


def arrow(centre: Place, length: float, along_y: bool) -> Mesh:
    """Return a flat arrow whose length has the sign of its direction."""
    half, head, t = length / 2, 0.3 * length, 6.0
    outline = [(-half, -3.0), (half - head, -3.0), (half - head, -9.0), (half, 0.0)]
    outline += [(half - head, 9.0), (half - head, 3.0), (-half, 3.0)]
    flat = np.array([(y, x) if along_y else (x, y) for x, y in outline])
    sides = [f for i in range(7) for j in [(i + 1) % 7] for f in ((i, j, j + 7), (i, j + 7, i + 7))]
    caps = [(0, 1, 5), (0, 5, 6), (2, 3, 4)]
    faces = [*sides, *caps, *[(a + 7, b + 7, c + 7) for a, b, c in caps]]
    return Mesh(_upright(flat, 0.0, t) + centre, np.array(faces))


def prism(outline: FloatArray, low: float, high: float) -> Mesh:
    """Return an upright prism over a convex outline, shape (n, 2), um."""
    n = len(outline)
    i = np.arange(n)
    j = (i + 1) % n
    caps = np.stack([np.zeros(n - 2, int), i[1:-1], i[2:]], axis=1)
    faces = np.vstack([np.stack([i, j, j + n], 1), np.stack([i, j + n, i + n], 1), caps[:, ::-1], caps + n])
    return Mesh(_upright(outline, low, high), faces)


def circle(radius: float, corners: int) -> FloatArray:
    """Return the outline of a disc, shape (corners, 2)."""
    angles = np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False)
    return radius * np.column_stack([np.cos(angles), np.sin(angles)])


def arc(inner: float, outer: float, low: float, high: float, start: float, sweep: float, steps: int = 72) -> Mesh:
    """Return an arc of a ring; radii and heights in um, angles in rad."""
    angles = start + sweep * np.linspace(0.0, 1.0, steps + 1)
    unit = np.column_stack([np.cos(angles), np.sin(angles)])
    edges = np.vstack([inner * unit, outer * unit])
    n = steps + 1
    faces = []
    for a in range(steps):
        ring = (a, a + n, a + 3 * n, a + 2 * n)  # inner and outer edge, below and above
        for p, q in zip(ring, (*ring[1:], ring[0]), strict=True):
            faces += [(p, q, q + 1), (p, q + 1, p + 1)]
    for a in (0, steps):
        faces += [(a, a + n, a + 3 * n), (a, a + 3 * n, a + 2 * n)]
    return Mesh(_upright(edges, low, high), np.array(faces))


def _upright(points: FloatArray, low: float, high: float) -> FloatArray:
    """Return points at two heights."""
    return np.vstack([np.column_stack([points, np.full(len(points), z)]) for z in (low, high)])
