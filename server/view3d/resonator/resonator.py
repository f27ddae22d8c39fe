"""The comb resonator of a bench: the shuttle moves and turns, the beams bend, the fingers keep their true gaps."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np

from core.block import BlockParams
from core.board.history import History
from core.board.spec import Spec
from core.board.wiring import needed
from core.device.frame import Damage
from core.diagnose.hypothesis import names_of
from core.plant.plane import PlaneParams
from core.sense.dual_beam import DualBeam
from server.bench.bench import LiveBench
from server.bench.description import period_of
from server.view3d.colours import ATTENTION, ESTIMATE, FIXED, GROUND, LIGHT, MOVING, REFERENCE, SILICON, blend, in_batch
from server.view3d.device import DeviceModel, finite
from server.view3d.motion import TURN_EXAGGERATIONS, WANTED_TURN_UM, caption, exaggeration, moment, warning
from server.view3d.part import ScenePart, ScenePicture, batch, frame, lines, place, solid, units
from server.view3d.pose import Pose
from server.view3d.resonator.layout import Layout
from server.view3d.resonator.marks import ResonatorMarks
from server.view3d.resonator.suspension import flexure
from server.view3d.solids import Box, FloatArray, View, ball, merge

SIDES = ((1, "right", 1), (-1, "left", 2))
"""The combs, and the bits of a short at them."""
BEAMS = ((1, "plus"), (-1, "minus"))
BEAM_UM, ABOVE_UM, BELOW_UM, SPOT_UM = 3.0, 130.0, 90.0, 5.0
"""Sizes of the light, large enough to see."""
ALONG, TURNED = ("plant.displacement", "model.displacement"), "plant.rotation"
SIGNALS = (*ALONG, TURNED, "plant.shift", "plant.contact", "plant.short", "sensor.displacement")
LASERS = ("through_wafer", "dual_beam", "doppler")
"""Sensors that look at the grating with light."""
APART_UM = 11.0
"""Least distance of two beams of light, so that they are seen to be two."""
LATELY = 31
"""Ticks within which the signals of a sensor that runs are not all 0."""
STEPS = 50
"""Number of shades and sizes of a severity or a warning; it is small, so that they seldom change."""


@dataclass(frozen=True)
class Laser:
    """A beam: where it meets the grating, um, exaggerated; whether it goes through the wafer."""

    place_um: float
    is_through: bool


@dataclass(frozen=True)
class ResonatorPose(Pose):
    """One moment.

    Parameters
    ----------
    displacement_um, reference_um, estimate_um : float
        Of the shuttle, its reference model and the winner of the first bank, exaggerated; no estimate without bank, and
        no reference beside a record, which another voltage drove.
    shift_um : float
        Sideways, true to scale.
    turn : float
        Rotation in rad, exaggerated.
    combs_um : tuple of float
        Sideways displacement of the fingers at +x and -x, true to scale.
    warnings : tuple of float
        Share of the colour of attention that these fingers take.
    short : int
        Bits of the combs that are shorted.
    lasers : tuple of Laser
        Beams of light on the grating.
    """

    displacement_um: float = 0.0
    reference_um: float | None = 0.0
    estimate_um: float | None = None
    shift_um: float = 0.0
    turn: float = 0.0
    combs_um: tuple[float, float] = (0.0, 0.0)
    warnings: tuple[float, float] = (0.0, 0.0)
    short: int = 0
    lasers: tuple[Laser, ...] = ()


class ResonatorModel(DeviceModel[ResonatorPose]):
    """A comb resonator; a device without a drawing is drawn as the reference device."""

    blank = ResonatorPose()

    def __init__(self, session: LiveBench) -> None:
        self._has_reference = session.board.spec.record is None
        own = [name for name in SIGNALS if self._has_reference or name != "model.displacement"]
        super().__init__(session, (*own, *_bank(session)))
        places = dict(zip(self._signals, self._indices, strict=True))
        self._along = [places[name] for name in ALONG if name in places]
        self._turned = [places[TURNED]] if TURNED in places else []
        self._own = [name for name in SIGNALS if name in places]
        self.layout = Layout(session.board.spec.device.drawing)
        self._light = {
            name: [signal.index for signal in session.signals if signal.name.startswith(f"{name}.")] for name in LASERS
        }
        self._factor = self._turn_factor = 1.0
        self._shining: tuple[Laser, ...] = ()
        self._beams: dict[str, ScenePart] = {}
        self._damage: tuple[Damage | None, float] = (None, 0.0)
        self._flexures = {name: flexure(self.layout, side) for side, name in BEAMS}

    def views(self) -> dict[str, View]:
        """Return the presets of the camera."""
        return self.layout.views()

    def parts(self) -> dict[str, ScenePart]:
        """Return the parts that are always there."""
        layout = self.layout
        parts = {
            "/ground": solid(layout.ground(), GROUND),
            "/anchors": solid(layout.anchors(), FIXED),
            "/bases": solid(layout.bases(), FIXED),
            "/film": solid(layout.film(), ATTENTION, opacity=0.0, visible=False),
        }
        for side, name, _ in SIDES:
            parts[f"/stators/{name}"] = batch(layout.stators(side), layout.finger_size, FIXED)
            parts[f"/fingers/{name}"] = batch(layout.fingers(side), layout.finger_size, MOVING)
        parts |= {"/shuttle": frame(), "/shuttle/plate": solid(layout.shuttle(), MOVING)}
        parts |= {f"/beams/{name}": solid(beams.unbent, SILICON) for name, beams in self._flexures.items()}
        ghosts = {"/reference": REFERENCE} if self._has_reference else {}
        for ghost, color in {**ghosts, "/estimate": ESTIMATE}.items():
            parts |= {ghost: frame(), f"{ghost}/outline": lines(layout.outline(), color)}
        return parts

    def read(self, head: int, rate_ticks_s: float, looked: int | None) -> tuple[ResonatorPose, int]:
        """Return the motion of the device, and the tick that is shown."""
        session, history = self._session, self._session.history
        spec = session.board.spec
        period = period_of(session)
        tick, is_strobed = moment(head, period, rate_ticks_s, time.monotonic())
        tick = max(tick, history.first_tick)
        values = finite(history.read(self._indices, tick, tick + 1))[:, 0]
        own, models = values[: len(self._own)].tolist(), values[len(self._own) :]
        known = dict.fromkeys(SIGNALS, 0.0) | dict(zip(self._own, own, strict=True))
        x, reference, turn, shift, contact, short, measured = (known[name] for name in SIGNALS)
        self._magnify(history, head - round(3 * (period or 1000)), head)
        plant = spec.plant.params
        turns = isinstance(plant, PlaneParams)
        combs = combs_of(shift, 1e-3 * turn, self.layout.tip_um, plant)
        gap = self.layout.geometry.gap_um
        pose = ResonatorPose(
            displacement_um=x * self._factor,
            reference_um=reference * self._factor if self._has_reference else None,
            estimate_um=self._estimate(measured, models),
            shift_um=shift,
            turn=1e-3 * turn * self._turn_factor,
            combs_um=combs,
            warnings=(_step(warning(combs[0], gap)), _step(warning(combs[1], gap))),
            contact=int(contact),
            short=int(short),
            lasers=self._lasers(spec, needed(spec) if looked is None else self._lit(looked)),
            caption=caption(self._factor, self._turn_factor if turns else None, is_strobed),
        )
        return pose, tick

    def _magnify(self, history: History, start: int, end: int) -> None:
        """Choose the exaggerations from the minima and maxima of some ticks."""

        def largest(columns: list[int]) -> float:
            return float(np.abs(finite(history.columns(columns, start, end, 1))).max(initial=0.0)) if columns else 0.0

        self._factor = exaggeration(largest(self._along), self._factor)
        ends_um = 1e-3 * largest(self._turned) * self.layout.geometry.arm_length_um / 2
        self._turn_factor = exaggeration(ends_um, self._turn_factor, WANTED_TURN_UM, TURN_EXAGGERATIONS)

    def _estimate(self, measured: float, values: FloatArray) -> float | None:
        """Return the prediction of the winner of the bank: measured minus its residual."""
        if not len(values):
            return None
        winner = int(values[0])
        return (measured - float(values[1 + winner])) * self._factor if 0 <= winner < len(values) - 1 else None

    def _lit(self, tick: int) -> set[str]:
        """Return the sensors with light that ran at a tick: the signals of the others rest at 0."""
        read = self._session.history.read
        return {name for name, signals in self._light.items() if read(signals, tick - LATELY, tick + 1).any()}

    def _lasers(self, spec: Spec, in_use: set[str]) -> tuple[Laser, ...]:
        """Return the places where the light of sensors meets the grating."""
        beams: dict[float, bool] = {}
        for name in LASERS:
            if name in in_use:
                beams.setdefault(0.0, name != "doppler")
                params = spec.sensors[name].params
                spacing = params.spacing_um if isinstance(params, DualBeam.Params) else 0.0
                if spacing:
                    beams[math.copysign(max(APART_UM, abs(spacing) * self._factor), spacing)] = True
        return tuple(Laser(*beam) for beam in beams.items())

    def mark(self, pose: ResonatorPose) -> ResonatorMarks:
        """Return the marks of a pose; only the side at +y can be damaged."""
        marks = ResonatorMarks(pose.faults, self.layout)
        if pose.contact:
            marks.touch(1 if abs(pose.combs_um[0]) >= abs(pose.combs_um[1]) else -1)
        if (marks.damage, marks.share) != self._damage:
            self._damage = marks.damage, marks.share
            self._flexures = {name: flexure(self.layout, side, *self._damage) for side, name in BEAMS}
        return marks

    def move(self, picture: ScenePicture, pose: ResonatorPose) -> None:
        """Place the parts as in a pose."""
        x, y, turn = pose.displacement_um, pose.shift_um, pose.turn
        picture.set("/shuttle", position=place(x, y), wxyz=(math.cos(turn / 2), 0.0, 0.0, math.sin(turn / 2)))
        if self._has_reference:
            picture.set("/reference", position=place(pose.reference_um or 0.0))
        picture.set("/estimate", position=place(pose.estimate_um or 0.0), visible=pose.estimate_um is not None)
        for name, beams in self._flexures.items():
            picture.set(f"/beams/{name}", faces=beams.faces, vertices=units(beams.bent(x, y, turn)))
        for (side, name, bit), lateral, closed in zip(SIDES, pose.combs_um, pose.warnings, strict=True):
            short = bool(pose.short & bit)
            places = self.layout.fingers(side)
            places[:, 0] -= turn * places[:, 1]
            picture.set(
                f"/fingers/{name}",
                # the fingers are true to scale in their gaps; only the arm that carries them is exaggerated
                position=place(x, lateral),
                batched_positions=units(places),
                batched_colors=in_batch(blend(MOVING, ATTENTION, 1.0 if short else closed)),
            )
            picture.set(f"/stators/{name}", batched_colors=in_batch(ATTENTION if short else FIXED))
        if pose.lasers != self._shining:
            self._shining, self._beams = pose.lasers, _beams(pose.lasers, self.layout.top_um)
        picture.added = picture.added | self._beams


def combs_of(shift_um: float, turn: float, tip_um: float, plant: BlockParams) -> tuple[float, float]:
    r"""Return how far the fingers at +x and -x are off centre where they are farthest, :math:`y\pm\theta X_r`.

    Parameters
    ----------
    shift_um, turn : float
        Sideways displacement of the centre; rotation in rad.
    tip_um : float
        Distance of the finger tips from the centre.
    plant : BlockParams
        The plant: combs may be off centre as made.
    """
    middle, angle = shift_um, turn
    if isinstance(plant, PlaneParams):
        middle, angle = middle + plant.misalignment_um, angle + 1e-3 * plant.misalignment_mrad
    return middle + angle * tip_um, middle - angle * tip_um


def _beams(lasers: tuple[Laser, ...], top_um: float) -> dict[str, ScenePart]:
    """Return the beams of light, which do not move."""
    parts = {}
    for number, laser in enumerate(lasers):
        low = -BELOW_UM if laser.is_through else top_um
        centre = (laser.place_um, 0.0, (top_um + ABOVE_UM + low) / 2)
        beam = merge([Box(centre, (BEAM_UM, BEAM_UM, top_um + ABOVE_UM - low))])
        spot = ball((laser.place_um, 0.0, top_um + 0.5), SPOT_UM, stretch=(1.0, 1.0, 0.1))
        parts[f"/light/{number}"] = solid(beam, LIGHT, opacity=0.6)
        parts[f"/spot/{number}"] = solid(spot, LIGHT)
    return parts


def _bank(session: LiveBench) -> tuple[str, ...]:
    """Return the winner and the residuals of the first bank that runs at every sample, if there is one."""
    known = {signal.name for signal in session.signals}
    spec = session.board.spec
    for name, section in spec.diagnosers.items():
        hypotheses = names_of(section.params)
        signals = (f"{name}.winner", *(f"{name}.residual.{item}" for item in hypotheses))
        if spec.turns(section) == 1 and hypotheses and known.issuperset(signals):
            return signals
    return ()


def _step(share: float) -> float:
    """Round a share."""
    return round(share * STEPS) / STEPS
