"""Solids of a schematic device: upright prisms, arcs of a ring, and beams that bend between two parts."""

from __future__ import annotations

import numpy as np

from server.view3d.layout import UM_PER_UNIT, FloatArray, Mesh
from server.view3d.suspension import Flexure, tube

RINGS = 5
"""Cross-sections of a beam that bends."""


def prism(outline: FloatArray, low: float, high: float) -> Mesh:
    """Return an upright prism over a convex outline, shape (n, 2), um."""
    n = len(outline)
    i = np.arange(n)
    j = (i + 1) % n
    caps = np.stack([np.zeros(n - 2, int), i[1:-1], i[2:]], axis=1)
    faces = np.vstack([np.stack([i, j, j + n], 1), np.stack([i, j + n, i + n], 1), caps[:, ::-1], caps + n])
    return Mesh(_upright(outline, low, high), faces)


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


def beam(
    start: tuple[float, float], end: tuple[float, float], width: float, low: float, high: float, follow: FloatArray
) -> Flexure:
    """Return a beam between two parts, flat at both ends.

    Parameters
    ----------
    start, end : tuple of float
        Its ends, um.
    width, low, high : float
        Its width, and its lower and upper height, um.
    follow : ndarray, shape (2, 2, 2)
        For each end, the displacement of that end along x and y per displacement of the mass along x and y.
    """
    s = np.linspace(0.0, 1.0, RINGS)
    along = np.subtract(end, start)
    across = np.array([-along[1], along[0]]) / np.hypot(*along) * width / 2
    middle = np.asarray(start) + s[:, None] * along
    corners = [(-across, low), (across, low), (across, high), (-across, high)]
    rest = np.stack([np.column_stack([middle + side, np.full(RINGS, z)]) for side, z in corners], axis=1)
    share = (3.0 * s * s - 2.0 * s**3)[:, None, None]
    bent = (1.0 - share) * follow[0] + share * follow[1]
    moving = np.concatenate([bent, np.zeros((RINGS, 2, 1))], axis=2)
    return Flexure(rest.reshape(-1, 3), np.repeat(moving, 4, axis=0), tube(RINGS))


def rigid(mesh: Mesh, follow: FloatArray) -> Flexure:
    """Return a part that does not bend.

    Parameters
    ----------
    mesh : Mesh
        The undeformed part.
    follow : ndarray, shape (2, 2)
        Its displacement along x and y per displacement of the mass along x and y.
    """
    moving = np.column_stack([follow, np.zeros(2)])
    return Flexure(mesh.vertices * UM_PER_UNIT, np.tile(moving, (len(mesh.vertices), 1, 1)), mesh.faces)


def join(parts: list[Flexure]) -> Flexure:
    """Join bending parts into one surface."""
    first = np.cumsum([0, *(len(part.rest) for part in parts[:-1])])
    return Flexure(
        np.vstack([part.rest for part in parts]),
        np.vstack([part.follow for part in parts]),
        np.vstack([part.faces + start for part, start in zip(parts, first, strict=True)]),
    )


def _upright(points: FloatArray, low: float, high: float) -> FloatArray:
    """Return points at two heights, in scene units."""
    levels = [np.column_stack([points, np.full(len(points), z)]) for z in (low, high)]
    return np.vstack(levels) / UM_PER_UNIT
