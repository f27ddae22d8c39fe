"""Fit of a bench: the blocks, sections and controllers that go with its plant, by the axes each declares."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import cast

from core.block import Block, Oscillator
from core.board.document import CHOSEN, ONE_DISPLACEMENT, PARKED, Document, generators
from core.board.instances import faults_of, feeds_forward
from core.board.library import library_of
from core.board.spec import Section, Spec
from core.device.transfer_function import slowest_pole
from core.errors import InputError, unknown
from core.loop.axis_drive import AxisDrive
from core.loop.model import Model
from core.registry import blocks

MOST_GROWTH = 100.0
"""Largest exponent of growth within a sample: the cube of the growth is still a number."""


def _misfit(block: type[Block], plant: type[Block]) -> str:
    """Say why a block does not go with a plant; nothing when it does."""
    axes = plant.axes or ()
    if block.plants and plant.name not in block.plants:
        return f"is for {' and '.join(block.plants)} only; the plant is {plant.name}"
    if block.name not in (only := plant.takes.get(block.family, (block.name,))):
        return f"cannot act on a {plant.name}, which takes {', '.join(only) or f'no {block.family}'}"
    for port in block.inputs:
        sensor = port.source.split(".")[0]
        if sensor in blocks("sense") and sensor not in plant.takes.get("sense", (sensor,)):
            return f"reads {sensor}, and a {plant.name} has only {', '.join(plant.takes['sense'])}"
    if block.fits(axes):
        return ""
    moves = f"{plant.name} moves along {', '.join(axes)}" if axes else f"{plant.name} has one displacement"
    if block.per_axis:
        return f"is for a plant with axes; {moves}"
    missing = [axis for axis in block.axes or () if axis not in axes]
    return f"needs {', '.join(missing)}; {moves}" if missing else f"is for one displacement; {moves}"


misfit = cast(Callable[[type[Block], type[Block]], str], lru_cache(maxsize=4096)(_misfit))
"""Blocks of a bench are compared with its plant again and again."""


def refuse_what_does_not_fit(doc: Document, plant: type[Block]) -> None:
    """Refuse sections that a bench with this plant cannot have."""
    absent = [key for key in generators() if key not in plant.generators]
    for key in (*absent, *(ONE_DISPLACEMENT if plant.axes else ())):
        if key in doc:
            inputs = ", ".join(plant.generators) or "reference"
            raise InputError(f"{plant.name} has no {key}; it has {inputs}", key, "leave it out")
    for one, (key, family) in PARKED.items():
        for name in doc.get(key, {}):
            if reason := misfit(library_of(doc).block(family, name, key), plant):
                field = f"{one}.kind" if doc[one].get("kind") == name else f"{key}.{name}"
                raise InputError(f"{name} {reason}", field, "leave it out")


def driving(doc: Document, plant: type[Block]) -> dict[str, str]:
    """Return the controller that drives in each slot; ``controller.kind`` names the controller of the last slot."""
    *others, last = plant.slots
    slots = doc.get("slots", {})
    for name in slots:
        if name == last:
            raise InputError(f"{name} is the last slot", f"slots.{name}", "set controller.kind")
        if name not in others:
            raise unknown("slot", name, others, f"slots.{name}")
    asked = {name: (slots[name], f"slots.{name}") for name in others}
    asked[last] = (doc["controller"]["kind"], "controller.kind")
    chosen = {}
    for slot, (kind, path) in asked.items():
        block = library_of(doc).block("control", kind, path)
        if block.slot != slot and not misfit(block, plant):
            raise InputError(f"{block.name} stands in slot {block.slot}", path, f"choose one of slot {slot}")
        chosen[slot] = block.name
    return chosen


def suited(spec: Spec) -> Spec:
    """Leave out controllers and sensors that do not suit this bench; refuse requested blocks that do not suit it."""
    nominal, plant = spec.nominal, spec.plant.block
    pair = nominal, Model.oscillator(spec.model.params, nominal)
    for path, grows in zip(("device.transfer_function", "model.denominator"), pair, strict=True):
        if slowest_pole(grows) * spec.dt_ms > MOST_GROWTH:
            text = f"grows by more than e^{MOST_GROWTH:g} from one sample to the next"
            raise InputError(text, path, "sample faster, or slow it down")
    *others, last = spec.driving
    fields = {
        "plant.model": plant,
        **{f"slots.{slot}": spec.library.block("control", spec.driving[slot]) for slot in others},
        "controller.kind": spec.library.block("control", spec.driving[last]),
        "sensor.kind": spec.sensors[spec.measuring].block,
    }
    if spec.is_analogue:
        _refuse_held(spec)
    if isinstance(drive := spec.drive.params, AxisDrive.Params):
        name, reason = AxisDrive.unable(drive, nominal, spec.partner, spec.axes)
        if reason:
            raise InputError(
                reason, f"drive.{name}", "by volts needs combs in the electrodes of every device; by force needs none"
            )
    for key in CHOSEN:
        fields |= {f"{key}.{name}.kind": section.block for name, section in getattr(spec, key).items()}
    fields |= {f"{key}.kind": section.block for key, section in spec.supervisors.items()}
    for path, block in fields.items():
        reason = (misfit(block, plant) if block is not plant else "") or block.unsuited(*pair)
        if reason:
            raise InputError(f"{block.name}: {reason}", path)
    present = faults_of(spec.axes, spec.library)
    for name in spec.faults:
        if name not in present:
            raise InputError(f"{name} {misfit(spec.library.block('faults', name), plant)}", f"faults.{name}")
    controllers, sensors = _for(pair, plant, spec.controllers), _for(pair, plant, spec.sensors)
    if controllers is spec.controllers and sensors is spec.sensors:
        return spec
    found = object.__new__(Spec)  # it keeps the values that were worked out so far
    vars(found).update(vars(spec), controllers=controllers, sensors=sensors)
    return found


def _refuse_held(spec: Spec) -> None:
    """Refuse an analogue drive for controllers whose command is held over a sample."""
    for name in spec.driving.values():
        if not feeds_forward(spec.controllers[name].block, spec.axes):
            able = " or ".join(
                name
                for name, block in spec.library.blocks("control").items()
                if feeds_forward(block, spec.axes) and not misfit(block, spec.plant.block)
            )
            text = f"analogue is for {able} only: what {name} asks for is held over a sample"
            raise InputError(text, "drive.kind", f"hold the drive, or let {able} drive")


def _for(pair: tuple[Oscillator, Oscillator], plant: type[Block], sections: dict[str, Section]) -> dict[str, Section]:
    left = {
        name: section
        for name, section in sections.items()
        if not misfit(section.block, plant) and not section.block.unsuited(*pair)
    }
    return sections if len(left) == len(sections) else left
