"""A bench, ready to be wired: its sections, each a block with validated parameters."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from operator import attrgetter
from typing import Any, Literal, cast

from pydantic import Field

from core.block import Block, BlockParams, Context, Oscillator
from core.board.document import Document, sections
from core.board.library import Library, library_of
from core.device.device import Device
from core.diagnose.hypothesis import hypotheses_of
from core.loop.axis_drive import AxisDrive
from core.loop.drive import Drive
from core.loop.environment import Environment
from core.loop.model import Model
from core.measured_record import PlayedRecord, record_of
from core.plant.record import RecordPlant
from core.table import Table

ALONE = ("environment", "plant", "reference", "model", "drive", "board", "guard")
GROUPS = ("sensors", "generators", "controllers", "identifiers", "diagnosers", "supervisors", "readouts")
"""Sections of a bench, and tables of sections by name."""
ALL_ALONE, ALL_GROUPS = attrgetter(*ALONE), attrgetter(*GROUPS)


@dataclass(frozen=True)
class Section:
    """One chosen block with its parameters."""

    block: type[Block]
    params: BlockParams
    every: int = 1


MOST_SEED = 2**53
"""Largest seed: whole in every floating-point number it passes through."""


class BoardSettings(Table):
    """The numbers of a bench that belong to no block."""

    sample_rate_khz: float = Field(100.0, ge=0.1, le=1e5, description="ticks for each ms of device time")
    seed: int = Field(1, ge=0, le=MOST_SEED, description="the seed of all noise")
    without_driver: Literal["hold", "safe"] = Field(
        "hold",
        description="the reaction of a live bench of several persons whose driver leaves: hold continues, safe trips",
    )


def fields() -> tuple[str, ...]:
    """Return the keys a bench may have."""
    return (*BoardSettings.model_fields, *sections())


@dataclass(frozen=True)
class Spec:
    """A bench, ready to be wired.

    ``document`` is its source in normal form: ``controllers`` and ``sensors`` hold the parameters of the controller and
    the sensor in use. ``driving`` names the controller of each slot, ``faults`` holds the faults that act. A plant with
    axes has neither reference nor model; these two sections then do nothing. ``supervisors`` has at most one.
    ``offered`` has all sensors and controllers that fit the plant, even where they do not suit the device.
    """

    document: Document
    frame: BoardSettings
    device: Device
    environment: Section
    plant: Section
    reference: Section
    model: Section
    drive: Section
    board: Section
    guard: Section
    measuring: str
    sensors: dict[str, Section]
    driving: dict[str, str]
    generators: dict[str, Section]
    controllers: dict[str, Section]
    identifiers: dict[str, Section]
    diagnosers: dict[str, Section]
    supervisors: dict[str, Section]
    readouts: dict[str, Section]
    faults: dict[str, BlockParams] = field(default_factory=dict)
    offered: dict[str, dict[str, Section]] = field(default_factory=dict, repr=False, compare=False)

    @cached_property
    def library(self) -> Library:
        """The blocks it may have."""
        return library_of(self.document)

    @property
    def dt_ms(self) -> float:
        """Sample interval of the board."""
        return 1.0 / self.frame.sample_rate_khz

    @property
    def seed(self) -> int:
        """Seed of all noise."""
        return self.frame.seed

    @property
    def tone_hz(self) -> float:
        """Frequency of the reference in Hz, 0 where it has no tone or more than one."""
        reference: Any = self.reference.block
        return float(reference.tone_hz(self.reference.params))

    @property
    def axes(self) -> tuple[str, ...]:
        """Axes the plant moves along; none for one displacement."""
        return self.plant.block.axes or ()

    @property
    def active(self) -> str:
        """The controller that drives in the last slot."""
        return list(self.driving.values())[-1]

    @cached_property
    def record(self) -> PlayedRecord | None:
        """The record that the plant plays, if it is one."""
        params = self.plant.params
        return record_of(params.record, "plant.record") if isinstance(params, RecordPlant.Params) else None

    @property
    def is_analogue(self) -> bool:
        """Whether the drive moves between samples."""
        return bool(cast(Drive.Params | AxisDrive.Params, self.drive.params).kind == "analogue")

    @cached_property
    def nominal(self) -> Oscillator:
        """The nominal device."""
        return self.device.oscillator()

    @cached_property
    def partner(self) -> Oscillator | None:
        """The second device of a pair, nominal."""
        partner = getattr(self.plant.params, "partner", None)
        return partner.oscillator() if isinstance(partner, Device) else None

    @cached_property
    def banks(self) -> dict[str, dict[str, Oscillator]]:
        """The devices that each diagnoser chooses between, by the names of its hypotheses."""
        banks = {key: hypotheses_of(section.params) for key, section in self.diagnosers.items()}
        return {key: {one.name: one.oscillator(self.nominal) for one in bank} for key, bank in banks.items() if bank}

    @cached_property
    def surroundings(self) -> tuple[float, float]:
        """Factors of stiffness and damping in the environment, before any fault."""
        return Environment.scales(self.environment.params, self.context())

    @cached_property
    def quoted(self) -> dict[str, float]:
        """Figures of the device in its environment, before any fault."""
        return self.device.metrics(*self.surroundings, self.context().temperature_k)

    @property
    def tones(self) -> list[tuple[float, float]]:
        """Frequency and amplitude of the tones of the reference."""
        waveform: Any = self.reference.block
        found: list[tuple[float, float]] = waveform.tones(self.reference.params, self.context())
        return found

    @cached_property
    def cautions(self) -> list[str]:
        """Warnings about the loss by the blocks' assumptions of the voltage, at its strongest tone."""
        _, hz = max((abs(volts), hz) for hz, volts in (*self.tones, (0.0, 0.0)))
        found = []
        for name, section in {**self.identifiers, **self.diagnosers}.items():
            text = section.block.caution(section.params, self.context(self.turns(section)), hz)
            found += [f"{name} {text}"] if text else []
        return found

    def parts(self) -> Iterator[tuple[str, Section]]:
        """Yield every section with its name."""
        for name in ALONE:
            yield name, getattr(self, name)
        for name in GROUPS:
            yield from getattr(self, name).items()

    def has_sections_of(self, other: Spec) -> bool:
        """Say whether this bench and another have the very same sections, in the same order."""
        if any(own is not another for own, another in zip(ALL_ALONE(self), ALL_ALONE(other), strict=True)):
            return False
        groups = zip(ALL_GROUPS(self), ALL_GROUPS(other), strict=True)
        return all(
            own is another or (list(own) == list(another) and all(own[name] is another[name] for name in own))
            for own, another in groups
        )

    def turns(self, section: Section) -> int:
        """Return the ticks between two runs of a block that reads measurements: it waits for the sensor's next one."""
        return math.lcm(section.every, self.sensors[self.measuring].every)

    def context(self, every: int = 1, axis: str = "") -> Context:
        """Return the facts that a block may know if it runs every so many ticks, for its axis if it has one."""
        found = self._contexts.get((every, axis))
        if found is None:
            if self._sown is not None:
                found = self._sown.context(every, axis).with_facts(seed=self.seed)
            else:
                found = self.context(every).with_facts(axis=axis) if axis else self._context(every)
            self._contexts[every, axis] = found
        return found

    @cached_property
    def _sown(self) -> Spec | None:
        """The bench whose seed has been changed to get this one."""
        return None

    @cached_property
    def _contexts(self) -> dict[tuple[int, str], Context]:
        """Contexts worked out so far: every block asks for one, and again at each change of a fault."""
        return {}

    def _context(self, every: int) -> Context:
        sensor, known = self.sensors[self.measuring], self._known(every)
        # the noise of a sample of the sensor, however often the block that asks runs
        block: Any = sensor.block
        own = block.noise_um(sensor.params, known if sensor.every == every else self._known(sensor.every))
        return known.with_facts(sensor_noise_um=float(own), sensor_every=sensor.every)

    def _known(self, every: int) -> Context:
        nominal, drive = self.nominal, self.drive.params
        return Context(
            dt_ms=self.dt_ms * every,
            every=every,
            seed=self.seed,
            device=nominal,
            model=Model.oscillator(self.model.params, nominal),
            partner=self.partner,
            drawing=self.device.drawing,
            temperature_k=cast(Environment.Params, self.environment.params).temperature_k,
            stator_voltages=self.device.stators_v,
            capacitance_gradient=self.device.capacitance_gradient,
            analogue=self.is_analogue,
            limit_v=Drive.reach(drive) if isinstance(drive, Drive.Params) else 0.0,
            limit_un=AxisDrive.reach_un(drive, nominal, self.partner) if isinstance(drive, AxisDrive.Params) else 0.0,
            tone_hz=self.tone_hz,
            sensors={name: section.params for name, section in self.sensors.items()},
            banks=self.banks,
        )

    def with_seed(self, seed: int) -> Spec:
        """Return this bench with other noise; it keeps the values that were worked out for this bench."""
        if seed == self.seed:
            return self
        spec = object.__new__(Spec)
        frame = self.frame.model_copy(update={"seed": seed})
        document = {**self.document, "seed": seed}
        known = {"quoted": self.quoted, "cautions": self.cautions}
        vars(spec).update(vars(self), frame=frame, document=document, _contexts={}, _sown=self, **known)
        return spec

    def with_faults(self, faults: dict[str, BlockParams]) -> Spec:
        """Return this bench with other faults; it keeps the values that were worked out for this bench."""
        spec = object.__new__(Spec)
        vars(spec).update(vars(self), faults=faults)
        return spec


OF_CONTEXT = ("frame", "device", "environment", "drive", "reference", "model", "measuring", "sensors", "diagnosers")
"""Parts of a bench that blocks may know of."""
