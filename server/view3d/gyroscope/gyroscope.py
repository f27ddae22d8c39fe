"""The gyroscopes of a bench: one or two on a frame, each with its orbit, and the rate and the force as arrows."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from core.board.spec import Spec
from core.control.sense_axis_sync import SenseAxisSync
from core.format import format_short
from server.bench.bench import LiveBench
from server.bench.description import period_of
from server.view3d.colours import ATTENTION, FIXED, GROUND, LIGHT, MOVING, SILICON
from server.view3d.device import DeviceModel, finite
from server.view3d.flexure import rigid
from server.view3d.gyroscope import parts
from server.view3d.gyroscope.marks import GyroscopeMarks
from server.view3d.gyroscope.orbit import caption, full_scale, magnified, met
from server.view3d.gyroscope.parts import AXES, GROUND_UM, RIM_UM, TOP_UM, Ground
from server.view3d.motion import SEEN_HZ, STROBE_HZ
from server.view3d.part import ScenePart, ScenePicture, frame, label, lines, place, solid, units
from server.view3d.pose import Pose
from server.view3d.solids import FloatArray, Mesh, View, arc, arrow, ball

BAR, TURN, FORCE = (58, 134, 186), (240, 190, 60), (31, 184, 143)
ABOVE_UM = 12.0
"""Height of the orbit above the mass."""
FRONT = -0.5 * math.pi
"""Where the arc of the rate begins: at the front."""
FORCE_UM, LIFT_UM = 150.0, 40.0
"""Length of the arrow of the largest force, and its height above the masses."""
NAMES = ("first", "partner")
PERIODS, LONG = 3.2, 400.0
"""Drive periods looked at: for the strobe and the orbit, and for the largest values."""
ORBIT_PERIODS, ORBIT_POINTS = 2.0, 96
RING_STEPS = 180
"""Number of lengths of the arc that shows a rate; it is small, so that noise seldom moves it."""


@dataclass(frozen=True)
class GyroscopePose(Pose):
    """One moment.

    Parameters
    ----------
    places : tuple of tuple of float
        x and y of each mass, exaggerated, um.
    orbits : tuple of ndarray, shape (points, 2)
        The same over the last periods; they change only with the places.
    turn : float
        The rate as a share of the rate of half the ring, signed.
    rate : str
        The rate in words.
    force : float or None
        The force with which the first follows its partner, as a share of its largest; none where it does not follow.
    largest_force : str
        That largest force in words.
    """

    places: tuple[tuple[float, float], ...] = ()
    orbits: tuple[FloatArray, ...] = field(default=(), compare=False)
    turn: float = 0.0
    rate: str = ""
    force: float | None = None
    largest_force: str = ""


class GyroscopeModel(DeviceModel[GyroscopePose]):
    """One gyroscope, or two on one frame."""

    blank = GyroscopePose()

    def __init__(self, session: LiveBench) -> None:
        axes = session.board.spec.axes
        super().__init__(session, [*(f"plant.{axis}" for axis in axes), "rate.rate", f"drive.{axes[1]}.force"])
        self._ground = Ground(axes)
        self.origin_um = self._ground.centres[0]
        self._factors = (1.0, 1.0)
        self._half_ring = 100.0
        # all by their vertices: a browser draws a new place earlier than new vertices, and beams would come off
        self._moving = {
            "plate": (parts.mass(), MOVING),
            "bars": (parts.bars(), BAR),
            "dot": (rigid(ball((0.0, 0.0, TOP_UM + ABOVE_UM), 4.5), np.eye(2)), LIGHT),
            **{f"flexures-{axis}": (parts.flexures(axis), SILICON) for axis in AXES},
        }

    def views(self) -> dict[str, View]:
        """Return the presets of the camera."""
        return self._ground.views()

    def parts(self) -> dict[str, ScenePart]:
        """Return the parts that are always there."""
        found = {"/ground": solid(self._ground.mesh(), GROUND)}
        for name, x in zip(NAMES, self._ground.centres, strict=False):
            found[f"/{name}"] = frame(x)
            found |= {f"/{name}/{part}": one for part, one in self._body().items()}
            if len(self._ground.centres) > 1:
                found[f"/names/{name}"] = label([name], (x, -RIM_UM - 20.0, 0.0))
        for axis, words in zip(AXES, ("x: drive", "y: sense"), strict=True):
            x, y, z = parts.base(axis)
            found[f"/axes/{axis}"] = label([words], (x + self.origin_um, y, z))
        found["/rate"] = label([""], (0.0, -RIM_UM - 20.0, 0.0))
        found["/force"] = solid(pushing(1.0), FORCE, visible=False)
        found["/force-words"] = label([""], (0.0, FORCE_UM, TOP_UM + LIFT_UM), visible=False)
        return found

    def read(self, head: int, rate_ticks_s: float, _looked: int | None) -> tuple[GyroscopePose, int]:
        """Return the motion of the masses, and the tick that is shown."""
        session, history = self._session, self._session.history
        period = period_of(session) or 1.0
        first = max(head - math.ceil(PERIODS * period), history.first_tick)
        recent = finite(history.read(self._indices, first, head))
        largest = np.abs(finite(history.columns(self._indices, head - round(LONG * period), head, 1))).max(axis=(1, 2))
        self._magnify(largest)
        is_strobed = rate_ticks_s > SEEN_HZ * period
        at = None
        if is_strobed:
            at = met(recent[0 if largest[0] >= largest[1] else 1], (time.monotonic() * STROBE_HZ) % 1.0)
        at = recent.shape[1] - 1 if at is None else at
        scaled = recent[:-2].reshape(-1, 2, recent.shape[1]) * np.array(self._factors)[:, None]
        start = max(0, recent.shape[1] - round(ORBIT_PERIODS * period))
        step = max(1, (recent.shape[1] - start) // ORBIT_POINTS)
        rate, force = recent[-2:, at].tolist()
        follows = _follows(session.board.spec)
        pose = GyroscopePose(
            places=tuple((x, y) for x, y in scaled[:, :, at].tolist()),
            orbits=tuple(orbit[:, start::step].T for orbit in scaled),
            turn=round(rate / self._half_ring * RING_STEPS) / RING_STEPS,
            rate=f"rate {_signed(rate, self._half_ring)}",
            force=force / float(largest[-1]) if follows and largest[-1] > 0.0 else None,
            largest_force=format_short(float(largest[-1]), "uN", 2) if follows else "",
            caption=caption(self._factors, self._half_ring, is_strobed),
        )
        return pose, first + at

    def _magnify(self, largest: FloatArray) -> None:
        """Choose the exaggerations from the largest recent values, one pair of factors for all masses."""
        x, y = largest[:-2].reshape(-1, 2).max(axis=0).tolist()
        self._factors = magnified((x, y), self._factors)
        self._half_ring = full_scale(float(largest[-2]), self._half_ring)

    def mark(self, pose: GyroscopePose) -> GyroscopeMarks:
        """Return the marks of a pose."""
        return GyroscopeMarks(pose.faults)

    def move(self, picture: ScenePicture, pose: GyroscopePose) -> None:
        """Place the parts as in a pose."""
        for name, (x, y), orbit in zip(NAMES, pose.places, pose.orbits, strict=False):
            for part, (moving, _) in self._moving.items():
                picture.set(f"/{name}/{part}", vertices=units(moving.bent(x, y)))
            for part, (along, across) in (("mass", (x, y)), ("x", (x, 0.0)), ("y", (0.0, y))):
                picture.set(f"/{name}/{part}", position=place(along, across))
            picture.set(f"/{name}/turn", vertices=units(turning(pose.turn).vertices))
            if len(orbit) > 1:
                points = np.column_stack([orbit, np.full(len(orbit), TOP_UM + ABOVE_UM)])
                picture.set(f"/{name}/orbit", points=units(np.stack([points[:-1], points[1:]], axis=1)))
        is_pushed = pose.force is not None
        picture.set("/rate", text=pose.rate)
        picture.set("/force", visible=is_pushed)
        if pose.force is not None:
            picture.set("/force", vertices=units(pushing(pose.force).vertices))
        picture.set("/force-words", visible=is_pushed, text=f"force that follows, up to {pose.largest_force}")

    def _body(self) -> dict[str, ScenePart]:
        """Return the parts of one device."""
        return {
            "anchors": solid(parts.anchors(), FIXED),
            "rim": solid(parts.rim(), SILICON),
            **{f"stators-{axis}": solid(parts.stators(axis), FIXED) for axis in AXES},
            **{name: solid(moving.unbent, color) for name, (moving, color) in self._moving.items()},
            **{carrier: frame() for carrier in ("mass", *AXES)},
            "orbit": lines(np.zeros((1, 2, 3)), LIGHT),
            "gas": solid(parts.gas(), ATTENTION, opacity=0.0, visible=False),
            "turn": solid(turning(0.0), TURN),
        }


def _follows(spec: Spec) -> bool:
    """Return whether a driving controller makes a device follow its partner."""
    driving = (spec.controllers[name].params for name in spec.driving.values())
    return any(isinstance(params, SenseAxisSync.Params) and params.follow == "partner" for params in driving)


def _signed(rate: float, half_ring: float) -> str:
    """Write a rate with its sign, as fine as the ring shows it."""
    shown = round(rate / half_ring, 2) * half_ring
    return ("+" if shown > 0.0 else "") + format_short(shown, "deg/s", 3)


@lru_cache(2)
def turning(share: float) -> Mesh:
    """Return the arrow along the rim, the longer the faster; it points the way the frame turns."""
    sweep = math.pi * max(-1.0, min(1.0, share))
    low, high, middle = GROUND_UM + 8.0, GROUND_UM + 14.0, RIM_UM - 7.0
    band = arc(middle - 6.0, middle + 6.0, low, high, FRONT, sweep)
    reach = math.copysign(0.11 * (abs(sweep) > 0.0), sweep)
    along = np.array([sweep, sweep + reach, sweep])
    radii = np.array([middle - 18.0, middle, middle + 18.0])
    tip = np.column_stack([radii * np.cos(FRONT + along), radii * np.sin(FRONT + along), np.full(3, high + 1.0)])
    under = tip - (0.0, 0.0, high + 1.0 - low)
    n = len(band.vertices)
    faces = np.array([(0, 1, 2), (3, 5, 4), (0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4), (2, 0, 3), (2, 3, 5)]) + n
    return Mesh(np.vstack([band.vertices, tip, under]), np.vstack([band.faces, faces]))


def pushing(share: float) -> Mesh:
    """Return the arrow of a force along y between two devices, as a share of the largest."""
    length = FORCE_UM * share
    mesh = arrow((0.0, length / 2, 0.0), length, True)
    return Mesh(mesh.vertices * (2.0, 1.0, 1.0) + (0.0, 0.0, TOP_UM + LIFT_UM), mesh.faces)
