r"""Stiffness of the folded suspension as a frame of beams, whole or damaged.

Every beam is one exact Euler-Bernoulli element (nothing loads it between its ends), the trusses are elements too and
the shuttle is rigid. All nodes other than the shuttle are condensed out, which leaves the 3 x 3 stiffness in
(x, y, theta) about the centre of the grating. Displacements are small: the model leaves out stretching and the loss of
lateral stiffness with travel.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from core.block import FloatArray
from core.device.geometry import Geometry
from core.matrix import product, solved

Beam = Literal["inner", "outer"]
SEGMENT = (-1.5, -0.5, 0.5, 1.5)
"""Places of the four beams of a side along its truss, in truss segments."""


@dataclass(frozen=True)
class Damage:
    """Damage of a suspension.

    Parameters
    ----------
    adhesion : tuple, optional
        Beam, and share of its length from its root (0) to the truss (1), at which a point sticks to the ground; the
        beam is the +x beam on the +y side.
    lost_ends : tuple of int
        Truss segments that are gone on the side at +y: 2 is the end at +x, 1 the middle; (0, 1, 2) is the whole truss.
    side_scale : float
        Young's modulus of the side at +y over nominal.
    """

    adhesion: tuple[Beam, float] | None = None
    lost_ends: tuple[int, ...] = ()
    side_scale: float = 1.0


@dataclass(frozen=True)
class Shape:
    """Nodes of a suspension and their motion with the shuttle.

    Parameters
    ----------
    points : ndarray, shape (nodes, 2)
        Undeformed positions of the nodes, um.
    elements : list of (int, int)
        The nodes at both ends of each beam, or part of a beam or truss.
    response : ndarray, shape (nodes, 3, 3)
        Displacement (x, y, theta) of each node per displacement of the shuttle.
    """

    points: FloatArray
    elements: list[tuple[int, int]]
    response: FloatArray


@dataclass
class _Mesh:
    """Nodes and elements: (first node, second node, E, width)."""

    points: list[tuple[float, float]] = field(default_factory=list)
    elements: list[tuple[int, int, float, float]] = field(default_factory=list)
    fixed: list[int] = field(default_factory=list)
    rigid: list[int] = field(default_factory=list)

    def node(self, x: float, y: float) -> int:
        self.points.append((x, y))
        return len(self.points) - 1


def _mesh(geometry: Geometry, damage: Damage) -> _Mesh:
    mesh = _Mesh()
    foot = 0.5 * geometry.plate_width_um
    for side in (1.0, -1.0):
        modulus = geometry.youngs_modulus_gpa * (damage.side_scale if side > 0.0 else 1.0)
        tops = []
        for i, place in enumerate(SEGMENT):
            x = place * geometry.truss_segment_um
            root = mesh.node(x, side * foot)
            top = mesh.node(x, side * (foot + geometry.beam_length_um))
            (mesh.rigid if i in (0, 3) else mesh.fixed).append(root)
            stuck = damage.adhesion
            if stuck is not None and side > 0.0 and i == (2 if stuck[0] == "inner" else 3):
                middle = mesh.node(x, foot + stuck[1] * geometry.beam_length_um)
                mesh.fixed.append(middle)
                pairs = [(root, middle), (middle, top)]
            else:
                pairs = [(root, top)]
            mesh.elements += [(a, b, modulus, geometry.beam_um) for a, b in pairs]
            tops.append(top)
        for i in range(3):
            if side < 0.0 or i not in damage.lost_ends:
                mesh.elements.append((tops[i], tops[i + 1], modulus, geometry.truss_um))
    return mesh


def stiffness(geometry: Geometry, damage: Damage | None = None) -> FloatArray:
    r"""Return the stiffness of the suspension about the centre of the grating.

    Parameters
    ----------
    geometry : Geometry
        The drawing.
    damage : Damage, optional
        Its damage.

    Returns
    -------
    ndarray, shape (3, 3)
        In (x, y, theta): N/m, uN/rad for the couplings, uN um/rad for the rotation.
    """
    whole, carried = _assembled(geometry, _mesh(geometry, damage or Damage()))
    reduced = product(carried.T, whole, carried)
    edge, corner = reduced[:-3, -3:], reduced[-3:, -3:]
    return corner + product(edge.T, _following(reduced))


def shape(geometry: Geometry, damage: Damage | None = None) -> Shape:
    """Return the displacement of every node of the suspension when the shuttle moves slowly."""
    mesh = _mesh(geometry, damage or Damage())
    whole, carried = _assembled(geometry, mesh)
    response = product(carried, np.vstack([_following(product(carried.T, whole, carried)), np.eye(3)]))
    return Shape(np.array(mesh.points), [(a, b) for a, b, _, _ in mesh.elements], response.reshape(-1, 3, 3))


def _assembled(geometry: Geometry, mesh: _Mesh) -> tuple[FloatArray, FloatArray]:
    """Return the stiffness of all nodes, and the nodes that each freedom moves: the free nodes, then the shuttle."""
    n = len(mesh.points)
    whole = np.zeros((3 * n, 3 * n))
    for a, b, modulus, width in mesh.elements:
        # GPa is 1e3 uN/um^2
        places = [*range(3 * a, 3 * a + 3), *range(3 * b, 3 * b + 3)]
        whole[np.ix_(places, places)] += _element(
            mesh.points[a], mesh.points[b], modulus * 1e3, width, geometry.thickness_um
        )
    free = [i for i in range(n) if i not in mesh.fixed and i not in mesh.rigid]
    carried = np.zeros((3 * n, 3 * len(free) + 3))
    for j, i in enumerate(free):
        carried[3 * i : 3 * i + 3, 3 * j : 3 * j + 3] = np.eye(3)
    for i in mesh.rigid:
        x, y = mesh.points[i]
        carried[3 * i : 3 * i + 3, -3:] = [[1.0, 0.0, -y], [0.0, 1.0, x], [0.0, 0.0, 1.0]]
    return whole, carried


def _following(reduced: FloatArray) -> FloatArray:
    """Return the displacement of the free nodes per displacement of the shuttle."""
    return -solved(reduced[:-3, :-3], reduced[:-3, -3:])


def along_x(stiffness: FloatArray) -> float:
    """Return the stiffness along x with the shuttle free to move sideways and to turn, N/m."""
    side = stiffness[1:, 0]
    return float(stiffness[0, 0] - product(side[None], solved(stiffness[1:, 1:], side[:, None])).item())


def stiffness_ratio(geometry: Geometry, damage: Damage) -> float:
    """Return the stiffness along x over the stiffness of the whole suspension."""
    return along_x(stiffness(geometry, damage)) / along_x(stiffness(geometry))


def _element(a: tuple[float, float], b: tuple[float, float], modulus: float, width: float, depth: float) -> FloatArray:
    """Return the stiffness of one beam element in the axes of the device."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    length = math.sqrt(dx * dx + dy * dy)
    axial = modulus * width * depth / length
    bend = modulus * depth * width * width * width / 12.0 / (length * length * length)
    near, far = 4.0 * length * length * bend, 2.0 * length * length * bend
    lever, shear = 6.0 * length * bend, 12.0 * bend
    local = np.array(
        [
            [axial, 0.0, 0.0, -axial, 0.0, 0.0],
            [0.0, shear, lever, 0.0, -shear, lever],
            [0.0, lever, near, 0.0, -lever, far],
            [-axial, 0.0, 0.0, axial, 0.0, 0.0],
            [0.0, -shear, -lever, 0.0, shear, -lever],
            [0.0, lever, far, 0.0, -lever, near],
        ]
    )
    c, s = dx / length, dy / length
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    both = np.kron(np.eye(2), turn)
    return product(both.T, local, both)
