"""The library: the experiments of the dissertation and some more, one TOML file each, with claim and verdict."""

from __future__ import annotations

from functools import cache
from importlib.resources import files

from core.board.commands import Inject, Switch
from core.board.spec import Spec
from core.errors import unknown
from core.registry import blocks
from scenarios.schema import Scenario


@cache
def ids() -> tuple[str, ...]:
    """Return the id of every scenario in the order of the text: chapters, gyroscopes, appendices. It names the file."""
    names = [entry.name for entry in files(__name__).iterdir() if entry.name.endswith(".toml")]
    ids = [name.removesuffix(".toml") for name in names]
    return tuple(sorted(ids, key=lambda name: (name.startswith("app"), not name.startswith("first"), name)))


@cache
def library() -> tuple[Scenario, ...]:
    """Return every scenario of the library in the order of the text: its chapters, then its appendices."""
    return tuple(_read(name) for name in ids())


def is_demo(name: str) -> bool:
    """Return whether a scenario is made for first visits and lectures; its id says so."""
    return name.endswith("first-look") or name.startswith("demo-")


def get(name: str) -> Scenario:
    """Return one scenario of the library; no other is read.

    Raises
    ------
    InputError
        When there is none of that id.
    """
    if name not in ids():
        raise unknown("scenario", name, ids(), "scenario")
    return _read(name)


@cache
def topics(scenario: Scenario) -> list[str]:
    """Return the topics of a scenario, in the words of the catalogue."""
    controllers, faults = blocks("control"), blocks("faults")
    specs: list[Spec] = [scenario.spec, *scenario.twins.values()]
    topics = [str(scenario.document.get("device", {}).get("id", ""))]
    driving = [name for spec in specs for name in spec.driving.values()]
    commands = [command for event in scenario.events for command in event]
    driving += [command.switch for command in commands if isinstance(command, Switch)]
    topics += [controllers[name].title if name in controllers else name for name in driving]
    for spec in specs:
        found = [*spec.diagnosers.values(), *spec.identifiers.values(), *spec.readouts.values()]
        topics += [section.block.title for section in found]
        topics.append(spec.sensors[spec.measuring].block.title)
    injected = [command.fault for command in commands if isinstance(command, Inject)]
    topics += [faults[name].title if name in faults else name for name in injected]
    return list(dict.fromkeys(topic for topic in topics if topic))


@cache
def _read(name: str) -> Scenario:
    return Scenario.load((files(__name__) / f"{name}.toml").read_text("utf-8"))
