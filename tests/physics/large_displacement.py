"""A frame of beams at large displacements, written apart from the product's own: corotational elements, many a beam.

Crisfield, Non-linear Finite Element Analysis of Solids and Structures 1 (1991), 7.3: the chord of each element is
followed exactly, and within it the beam is an Euler-Bernoulli beam. Bowing and the loss of stiffness sideways follow
from the geometry; nothing is fitted.
"""

from __future__ import annotations

import itertools

import numpy as np

from core.device.geometry import Geometry

PARTS = 6
"""Elements of a beam."""


class Frame:
    """The suspension of a drawing, damaged on the side at +y if it is; units um, uN.

    ``adhesion`` is the share of the inner beam at +x, from its root, of a point held to the ground; ``lost`` are the
    segments of the truss that are gone, 2 the end at +x.
    """

    def __init__(self, geometry: Geometry, adhesion: float | None = None, lost: tuple[int, ...] = ()) -> None:
        places: list[tuple[float, float]] = []
        self.elements: list[tuple[int, int, float, float]] = []
        self.fixed: list[int] = []
        self.rigid: list[int] = []
        modulus, t = 1e3 * geometry.youngs_modulus_gpa, geometry.thickness_um
        w, wt = geometry.beam_um, geometry.truss_um
        beam = (modulus * w * t, modulus * t * w**3 / 12)
        truss = (modulus * wt * t, modulus * t * wt**3 / 12)

        def chain(a: int, b: int, parts: int, kind: tuple[float, float]) -> None:
            start, end, last = np.array(places[a]), np.array(places[b]), a
            for i in range(1, parts):
                places.append(tuple(start + (end - start) * i / parts))
                self.elements.append((last, len(places) - 1, *kind))
                last = len(places) - 1
            self.elements.append((last, b, *kind))

        for side in (1, -1):
            tops = []
            for i, at in enumerate((-1.5, -0.5, 0.5, 1.5)):
                x, foot = at * geometry.truss_segment_um, 0.5 * side * geometry.plate_width_um
                places += [(x, foot), (x, foot + side * geometry.beam_length_um)]
                root, top = len(places) - 2, len(places) - 1
                (self.rigid if i in (0, 3) else self.fixed).append(root)
                foothold = root
                if adhesion is not None and side > 0 and i == 2:
                    places.append((x, foot + adhesion * geometry.beam_length_um))
                    foothold = len(places) - 1
                    self.fixed.append(foothold)
                    chain(root, foothold, PARTS, beam)
                chain(foothold, top, PARTS, beam)
                tops.append(top)
            for j, (a, b) in enumerate(itertools.pairwise(tops)):
                if side < 0 or j not in lost:
                    chain(a, b, 2, truss)
        self.places = np.array(places)
        held = {*self.fixed, *self.rigid}
        self.free = [3 * i + j for i in range(len(places)) if i not in held for j in range(3)]

    def assembled(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return inner forces and their tangent at displacements (ux, uy, turn) of each node."""
        a, b, ea, ei = (np.array(column) for column in zip(*self.elements, strict=True))
        at = np.hstack([3 * a[:, None] + np.arange(3), 3 * b[:, None] + np.arange(3)])
        drawn, moved = self.places[b] - self.places[a], u[at]
        chord = drawn + moved[:, 3:5] - moved[:, 0:2]
        first, length = np.hypot(*drawn.T), np.hypot(*chord.T)
        c, s = chord.T / length
        turn = np.arctan2(drawn[:, 0] * chord[:, 1] - drawn[:, 1] * chord[:, 0], np.sum(drawn * chord, axis=1))
        t1, t2 = moved[:, 2] - turn, moved[:, 5] - turn
        normal = ea * (length - first) / first
        m1, m2 = 2 * ei / first * (2 * t1 + t2), 2 * ei / first * (t1 + 2 * t2)
        nil = np.zeros_like(c)
        r, z = np.array([-c, -s, nil, c, s, nil]).T, np.array([s, -c, nil, -s, c, nil]).T
        turned = z / length[:, None]
        strain = np.stack([r, np.eye(6)[2] - turned, np.eye(6)[5] - turned], axis=1)
        inner = np.array([[ea, nil, nil], [nil, 4 * ei, 2 * ei], [nil, 2 * ei, 4 * ei]]).transpose(2, 0, 1)
        own = strain.transpose(0, 2, 1) @ (inner / first[:, None, None]) @ strain
        own += (normal / length)[:, None, None] * z[:, :, None] * z[:, None, :]
        both = r[:, :, None] * z[:, None, :]
        own += ((m1 + m2) / (length * length))[:, None, None] * (both + both.transpose(0, 2, 1))
        force, tangent = np.zeros(len(u)), np.zeros((len(u), len(u)))
        np.add.at(force, at, np.einsum("eij,ei->ej", strain, np.array([normal, m1, m2]).T))
        np.add.at(tangent, (at[:, :, None], at[:, None, :]), own)
        return force, tangent

    def settle(self, travel: float, steps: int) -> np.ndarray:
        """Return all displacements with the shuttle moved along x; by symmetry nothing shifts or turns it."""
        u = np.zeros(3 * len(self.places))
        for share in np.linspace(0, 1, steps + 1)[1:]:
            for node in self.rigid:
                u[3 * node] = travel * share
            for _ in range(40):
                force, tangent = self.assembled(u)
                move = np.linalg.solve(tangent[np.ix_(self.free, self.free)], -force[self.free])
                u[self.free] += move
                if np.abs(move).max() < 1e-10:
                    break
        return u

    def stiffness(self, travel: float) -> tuple[float, np.ndarray]:
        """Return the force along x and the stiffness of the shuttle in (x, y, theta) at a travel."""
        u = self.settle(travel, max(1, round(travel)))
        force, tangent = self.assembled(u)
        rigid = np.array([3 * i + j for i in self.rigid for j in range(3)])
        inner = np.linalg.solve(tangent[np.ix_(self.free, self.free)], tangent[np.ix_(self.free, rigid)])
        condensed = tangent[np.ix_(rigid, rigid)] - tangent[np.ix_(rigid, self.free)] @ inner
        shape, curved = np.zeros((len(rigid), 3)), 0.0
        for i, node in enumerate(self.rigid):
            x, y = self.places[node]  # lever about the centre of the shuttle, which has moved with it
            shape[3 * i : 3 * i + 3] = [[1, 0, -y], [0, 1, x], [0, 0, 1]]
            curved -= force[3 * node] * x + force[3 * node + 1] * y  # the roots move on circles
        whole = shape.T @ condensed @ shape
        whole[2, 2] += curved
        return float(sum(force[3 * i] for i in self.rigid)), whole

    def follow(self, travel: float) -> tuple[float, float, float]:
        """Return the force along x that holds the shuttle at a travel, and where it shifts and turns to, free to."""
        u, shift, turn = np.zeros(3 * len(self.places)), 0.0, 0.0
        drawn = self.places[self.rigid]
        carried = np.zeros((len(u), len(self.free) + 2))
        carried[self.free, range(len(self.free))] = 1.0
        for share in np.linspace(0, 1, max(1, round(abs(travel))) + 1)[1:]:
            for _ in range(60):
                c, s = np.cos(turn), np.sin(turn)
                turned = drawn @ np.array([[c, s], [-s, c]])
                for node, at, now in zip(self.rigid, drawn, turned, strict=True):
                    u[3 * node : 3 * node + 3] = [travel * share + now[0] - at[0], shift + now[1] - at[1], turn]
                    carried[3 * node : 3 * node + 3, -2:] = [[0, -now[1]], [1, now[0]], [0, 1]]
                force, tangent = self.assembled(u)
                move = np.linalg.solve(carried.T @ tangent @ carried, -carried.T @ force)
                u[self.free] += move[:-2]
                shift, turn = shift + move[-2], turn + move[-1]
                if np.abs(move).max() < 1e-8:  # Newton: the rest is its square
                    break
        return float(sum(force[3 * i] for i in self.rigid)), float(shift), float(turn)
