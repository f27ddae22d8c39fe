r"""Surfaces that bend: each vertex follows the moving body, :math:`r=r_0+F\,(x,y,\theta)^T`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from server.view3d.solids import FloatArray, IntArray, Mesh

RINGS = 5
"""Cross-sections of a beam between two parts."""


@dataclass(frozen=True, eq=False)
class Flexure:
    """A surface that bends.

    Parameters
    ----------
    rest : ndarray, shape (vertices, 3)
        Places of the vertices without load, um.
    follow : ndarray, shape (vertices, 2, 3)
        Their displacement along x and y per displacement (x, y, theta) of the moving body.
    faces : ndarray, shape (triangles, 3)
        The surface.
    """

    rest: FloatArray
    follow: FloatArray
    faces: IntArray

    def bent(self, x: float, y: float, turn: float = 0.0) -> FloatArray:
        """Return the vertices in um, for a displacement of the body in um and rad."""
        moved = self.rest.copy()
        moved[:, :2] += self.follow @ np.array((x, y, turn))
        return moved

    @property
    def unbent(self) -> Mesh:
        """The surface without load."""
        return Mesh(self.rest, self.faces)


def swept(middle: FloatArray, follow: FloatArray, across: FloatArray, thick_um: float) -> Flexure:
    """Return a bar of rectangular rings along a line.

    Parameters
    ----------
    middle, follow : ndarray, shape (rings, 3), (rings, 2, 3)
        The points of the line, um, and how they follow.
    across : ndarray, shape (3,)
        From the line to the side of the bar, um.
    thick_um : float
        Its height.
    """
    up = np.array([0.0, 0.0, thick_um / 2])
    ring = np.stack([-across - up, across - up, across + up, up - across])
    rest = (middle[:, None, :] + ring[None, :, :]).reshape(-1, 3)
    return Flexure(rest, np.repeat(follow, 4, axis=0), _tube(len(middle)))


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
    across = np.array([-along[1], along[0], 0.0]) / np.hypot(*along) * width / 2
    middle = np.column_stack([np.asarray(start) + s[:, None] * along, np.full(RINGS, (low + high) / 2)])
    share = (3.0 * s * s - 2.0 * s**3)[:, None, None]
    bent = (1.0 - share) * follow[0] + share * follow[1]
    return swept(middle, np.concatenate([bent, np.zeros((RINGS, 2, 1))], axis=2), across, high - low)


def rigid(mesh: Mesh, follow: FloatArray) -> Flexure:
    """Return a part that does not bend, with its displacement per displacement of the mass along x and y."""
    moving = np.column_stack([follow, np.zeros(2)])
    return Flexure(mesh.vertices, np.tile(moving, (len(mesh.vertices), 1, 1)), mesh.faces)


def join(parts: Sequence[Flexure]) -> Flexure:
    """Join bending parts into one surface."""
    first = np.cumsum([0, *(len(part.rest) for part in parts[:-1])])
    return Flexure(
        np.vstack([part.rest for part in parts]),
        np.vstack([part.follow for part in parts]),
        np.vstack([part.faces + start for part, start in zip(parts, first, strict=True)]),
    )


def _tube(rings: int) -> IntArray:
    """Return the faces of a tube of square rings, closed at both ends."""
    faces = [[0, 1, 2], [0, 2, 3]]
    for a in range(0, 4 * (rings - 1), 4):
        for i in range(4):
            j = (i + 1) % 4
            faces += [[a + i, a + j, a + 4 + j], [a + i, a + 4 + j, a + 4 + i]]
    last = 4 * (rings - 1)
    return np.array([*faces, [last, last + 2, last + 1], [last, last + 3, last + 2]])
