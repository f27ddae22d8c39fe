"""Every block of the catalogue is on a bench of the library: a scenario shows its use."""

from __future__ import annotations

from collections.abc import Iterator

from core import registry
from core.block import LOOP
from core.board.commands import Inject, SetValues, Switch
from core.board.spec import Spec
from core.board.wiring import needed
from scenarios.library import library
from scenarios.schema import Scenario


def blocks_of(spec: Spec) -> Iterator[tuple[str, str]]:
    """Yield family and name of every block that works on a bench: sensors that run, controllers that drive."""
    yield "plant", spec.plant.block.name
    if not spec.axes or "waveform_drive" in spec.driving.values():
        yield "reference", spec.reference.block.name
    for generator in spec.generators.values():
        yield generator.block.family, generator.block.name
    for name in spec.driving.values():
        yield "control", spec.controllers[name].block.name
    for name in needed(spec):
        yield "sense", spec.sensors[name].block.name
    named = {
        "identify": spec.identifiers,
        "diagnose": spec.diagnosers,
        "supervise": spec.supervisors,
        "readout": spec.readouts,
    }
    for family, sections in named.items():
        for section in sections.values():
            yield family, section.block.name


def used_by(scenario: Scenario) -> set[tuple[str, str]]:
    """Return family and name of every block a scenario uses, those its events bring included."""
    found = {entry for spec in (scenario.spec, *scenario.twins.values()) for entry in blocks_of(spec)}
    for command in (command for commands in scenario.events for command in commands):
        if isinstance(command, Inject):
            found.add(("faults", command.fault))
        elif isinstance(command, Switch):
            found.add(("control", command.switch))
        elif isinstance(command, SetValues) and "controller.kind" in command.set:
            found.add(("control", str(command.set["controller.kind"])))
    return found


def test_a_scenario_shows_each_block() -> None:
    used = set[tuple[str, str]]().union(*(used_by(scenario) for scenario in library()))
    own = {
        (family, name)
        for family in registry.FAMILIES
        if family != LOOP  # they are on every bench
        for name, block in registry.blocks(family).items()
        if block.__module__.startswith("core.")
    }
    assert own - used == set()
