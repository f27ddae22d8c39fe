"""The pose: one moment of a bench as the scene shows it, read from its history."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from core.block import BlockParams
from core.board.commands import Inject
from core.board.history import Float32Array, History
from core.board.instances import faults_of
from core.board.spec import Spec
from core.board.wiring import needed
from core.diagnose.hypothesis import names_of
from core.faults.fault import Fault, FaultParams
from core.format import format_in
from core.plant.plane import PlaneParams
from core.sense.dual_beam import DualBeam
from server.bench.bench import LiveBench
from server.bench.description import period_of
from server.view3d.layout import FloatArray, Layout
from server.view3d.motion import (
    TURN_EXAGGERATIONS,
    WANTED_TURN_UM,
    caption,
    closed_share,
    exaggeration,
    moment,
    warning,
)

MOVED = ("plant.displacement", "model.displacement", "plant.rotation")
SIGNALS = (*MOVED, "plant.shift", "plant.contact", "plant.short", "sensor.displacement")
LASERS = ("through_wafer", "dual_beam", "doppler")
"""Sensors that look at the grating with light."""
APART_UM = 11.0
"""Least distance of two beams of light, so that they are seen to be two."""
LATELY = 31
"""Ticks within which the signals of a sensor that runs are not all 0."""
STEPS = 50
"""Number of shades and sizes of a severity or a warning; it is small, so that they seldom change."""


P = TypeVar("P", bound=FaultParams)


@dataclass(frozen=True)
class Active:
    """A fault that acts at the moment shown."""

    block: type[Fault]
    params: FaultParams
    severity: float

    @property
    def share(self) -> float:
        """Severity over the injected severity."""
        return self.severity / self.params.severity if self.params.severity else 1.0

    def given(self, kind: type[P]) -> P:
        """Return the parameters it was injected with, of the class its block has."""
        assert isinstance(self.params, kind)
        return self.params


@dataclass(frozen=True)
class Laser:
    """A beam: where it meets the grating, um, exaggerated; whether it goes through the wafer."""

    place_um: float
    is_through: bool


@dataclass(frozen=True)
class Pose:
    """One moment.

    Parameters
    ----------
    displacement_um, reference_um, estimate_um : float
        Of the shuttle, its reference model and the winner of the first bank, exaggerated; no estimate without bank.
    shift_um : float
        Sideways, true to scale.
    turn : float
        Rotation in rad, exaggerated.
    combs_um : tuple of float
        Sideways displacement of the fingers at +x and -x, true to scale.
    warnings : tuple of float
        Share of the colour of attention that these fingers take.
    contact, short : int
        Whether fingers touch; bits of the combs that are shorted.
    faults : tuple of Active
        The faults that act.
    lasers : tuple of Laser
        Beams of light on the grating.
    caption : str
        The differences from the true motion, in words.
    when : str
        The moment in words, if it is not the present.
    """

    displacement_um: float = 0.0
    reference_um: float = 0.0
    estimate_um: float | None = None
    shift_um: float = 0.0
    turn: float = 0.0
    combs_um: tuple[float, float] = (0.0, 0.0)
    warnings: tuple[float, float] = (0.0, 0.0)
    contact: int = 0
    short: int = 0
    faults: tuple[Active, ...] = ()
    lasers: tuple[Laser, ...] = ()
    caption: str = ""
    when: str = ""


class Observer:
    """Reads the moments of one bench.

    Parameters
    ----------
    session : LiveBench
        The bench.
    layout : Layout
        Where the parts of its device are.
    """

    def __init__(self, session: LiveBench, layout: Layout) -> None:
        self._session, self._layout = session, layout
        self._faults: dict[str, type[Any]] = faults_of(session.board.spec.axes, session.board.spec.library)
        self._bank = _bank(session)
        names = (*SIGNALS, *(f"faults.{name}" for name in self._faults), *self._bank)
        self._indices = session.indices(names)
        self._light = {
            name: [signal.index for signal in session.signals if signal.name.startswith(f"{name}.")] for name in LASERS
        }
        self._known: dict[str, Any] = {}
        self._factor = self._turn_factor = 1.0

    def pose(self, looked: int | None = None) -> Pose:
        """Return the pose of a tick of the history; else the present pose, or the pose of the strobe."""
        session, history = self._session, self._session.history
        spec = session.board.spec
        looked = kept(history, looked)
        head = history.end_tick if looked is None else looked + 1
        if head <= history.first_tick:
            return Pose()
        period = period_of(session)
        # A bench that runs as fast as possible is strobed like a bench in real time.
        rate = (session.status.achieved_scale if session.is_running else 0.0) / (session.dt_ms * 1e-3)
        at = moment(head, period, rate if looked is None else 0.0, time.monotonic())
        tick = max(at.tick, history.first_tick)
        values = history.read(self._indices, tick, tick + 1)[:, 0].astype(float)
        values[~np.isfinite(values)] = 0.0
        x, reference, turn, shift, contact, short, measured = values[: len(SIGNALS)].tolist()
        end = len(SIGNALS) + len(self._faults)
        self._magnify(history.columns(self._indices[: len(MOVED)], head - round(3 * (period or 1000)), head, 1))
        plant = spec.plant.params
        turns = isinstance(plant, PlaneParams)
        combs = combs_of(shift, 1e-3 * turn, self._layout.tip_um, plant)
        gap = self._layout.geometry.gap_um
        return Pose(
            displacement_um=x * self._factor,
            reference_um=reference * self._factor,
            estimate_um=self._estimate(measured, values[end:]),
            shift_um=shift,
            turn=1e-3 * turn * self._turn_factor,
            combs_um=combs,
            warnings=(_step(warning(closed_share(combs[0], gap))), _step(warning(closed_share(combs[1], gap)))),
            contact=int(contact),
            short=int(short),
            faults=acting(session, self._faults, self._known, values[len(SIGNALS) : end], looked),
            lasers=self._lasers(spec, needed(spec) if looked is None else self._lit(looked)),
            caption=caption(self._factor, self._turn_factor if turns else None, at.is_strobed),
            when=when(session, looked),
        )

    def _magnify(self, recent: Float32Array) -> None:
        """Choose the exaggerations from recent minima and maxima."""
        largest = np.where(np.isfinite(recent), np.abs(recent), 0.0).max(axis=(1, 2))
        self._factor = exaggeration(float(largest[:2].max()), self._factor)
        ends_um = 1e-3 * float(largest[2]) * self._layout.geometry.arm_length_um / 2
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


def kept(history: History, looked: int | None) -> int | None:
    """Return a tick that is looked at if the history has it."""
    return looked if looked is not None and history.first_tick <= looked < history.end_tick else None


def when(session: LiveBench, looked: int | None) -> str:
    """Return in words which moment is looked at."""
    return f"at {format_in(looked * session.dt_ms, 'ms', 3)}" if looked is not None else ""


def acting(
    session: LiveBench,
    faults: dict[str, type[Any]],
    known: dict[str, Any],
    severities: FloatArray,
    looked: int | None = None,
) -> tuple[Active, ...]:
    """Return the faults that act, as at a tick; one healed a moment ago is still ``known`` by its last parameters."""
    known |= dict(session.board.faults)
    if looked is not None and severities.any():
        known = known | _injected(session, faults, looked)
    return tuple(
        Active(block, known[name], severity)
        for (name, block), severity in zip(faults.items(), severities.tolist(), strict=True)
        if severity != 0.0 and name in known
    )


def _injected(session: LiveBench, faults: dict[str, type[Any]], tick: int) -> dict[str, Any]:
    """Return the parameters that each fault was last given by a tick, as the log has them."""
    found: dict[str, Any] = {}
    for event in session.events.after(0)[1]:
        name = event.command.get("fault") if event.command is not None else None
        if event.tick <= tick and event.kind == Inject.kind and name in faults:
            found[name] = faults[name].Params.model_validate(event.new)
    return found


def seen(faults: tuple[Active, ...]) -> list[Any]:
    """Return the visible part of the faults; a ramp moves in steps of two figures, not at every frame."""
    return [(fault.block, fault.params, f"{fault.severity:.2g}") for fault in faults]
