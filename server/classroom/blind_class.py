"""A hidden fault for each student of a class: each gets another device, noise and fault, which stay on the server."""

from __future__ import annotations

import asyncio
import secrets
from typing import Any

from core.device.drawn import device_of
from core.errors import InputError
from scenarios.schema import Scenario
from server.bench.bench import LiveBench
from server.bench.build import read_scenario
from server.classroom.blind import bank_of, hide
from server.classroom.blinds import OF_DRAW, Blinds, hidden_on
from server.classroom.classes import Classes
from server.classroom.hiding import Blind
from server.errors import REFUSED, why
from server.security.person import Person

LEFT_OUT = frozenset(
    {"events", "samples", "duration_ms", "expect", "printed", "metrics", "claim", "note", "faults", "twins"}
)
"""Parts of a scenario that would reveal the fault, or that do not belong to the bench."""


async def begin_for(
    classes: Classes, blinds: Blinds, students: list[Person], source: str | dict[str, Any], shows: bool
) -> list[str]:
    """Give students a blind bench each; return the errors, by name.

    Parameters
    ----------
    classes : Classes
        Their classes, from whose secret all is drawn.
    blinds : Blinds
        Store of the hidden faults.
    students : list of Person
        The students.
    source : str or dict
        The scenario of the bench; its events are left out.
    shows : bool
        Whether the diagnosers may be looked at meanwhile.

    Raises
    ------
    InputError
        If no bench can be made of the scenario; nothing has changed then.
    """
    scenario = await asyncio.to_thread(quiet, source)
    exercise = secrets.token_hex(6)
    failed: list[str] = []
    for person in students:
        try:
            await _begin(classes, blinds, person, scenario, exercise, shows)
        except REFUSED as error:
            failed.append(f"{person.name}: {why(error)}")
    return failed


async def _begin(
    classes: Classes, blinds: Blinds, person: Person, scenario: Scenario, exercise: str, shows: bool
) -> None:
    """Give a student a blind bench, drawn from the secret of the class."""
    device, noise, which, moment = [
        await classes.draw(person, exercise, purpose) for purpose in ("device", "noise", "fault", "moment")
    ]

    def hidden(made: LiveBench) -> Blind:
        return hide(made.board, scenario.spec.document, secrets.token_hex(8), shows, which, moment / OF_DRAW)

    wanted = {
        "source": scenario.document,
        "values": device_of(scenario.spec.device, device),
        "seed": noise,
        "paused": False,
        "time_scale": None,
        "own_scale": True,
    }
    await classes.benches.replace(
        person, wanted, hidden, lambda made: [blinds.noting(made, person, hidden_on(made), exercise)]
    )


def quiet(source: str | dict[str, Any]) -> Scenario:
    """Return a scenario in which nothing happens, of a resonator with a bank of hypotheses.

    Raises
    ------
    InputError
        If it is of something else.
    """
    whole = read_scenario(source)
    check(whole)
    return Scenario.load({key: value for key, value in whole.document.items() if key not in LEFT_OUT})


def check(scenario: Scenario) -> None:
    """Refuse a scenario on whose bench no fault can be hidden.

    Raises
    ------
    InputError
        If it is of something else than a resonator with a bank of hypotheses.
    """
    if scenario.study is not None or scenario.spec.device.usual_plant != "linear":
        raise InputError("is no bench of a resonator", "scenario", "take one of chapter 5")
    bank_of(scenario.spec)
