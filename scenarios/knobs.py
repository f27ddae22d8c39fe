"""Numbers of a scenario that are worth turning to see where a claim begins to hold."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel, Field

from core.board.commands import Inject
from core.board.document import Document
from core.board.live import section_at, value_at
from core.cards import ParameterCard, parameter_cards
from core.registry import block
from scenarios.expectation import Expectation
from scenarios.schema import Scenario

TRUE_ONES = ("sensor.noise_um", "plant.drive_noise_v", "reference.amplitude_v", "reference.amplitude_um")
NAMED = ("gain", "forgetting", "rate", "covariance", "noise", "slope", "floor", "anchor", "layer", "bound")
"""Words in the names of parameters that set how a controller, a diagnoser or an identifier works."""
WIDER = ("gain", "noise", "covariance", "rate", "anchor", "frequency")
"""Words in the names of parameters that are varied by factors: a decade to either side."""
LEAST_NOISE = 0.1
"""Upper end for a noise that is 0."""
MOST = 16


class Knob(BaseModel):
    """A number of a scenario, and the range over which it may be looked for."""

    path: str
    label: str
    unit: str
    value: float
    low: float
    high: float
    is_log: bool
    is_fitted: bool = Field(description="Chosen so that the figure agrees with the text")
    is_live: bool = Field(description="Whether a live bench can be given another value as it runs")
    fault: str | None = Field(None, description="The fault whose severity it is")


def knobs(scenario: Scenario, entry: Expectation) -> list[Knob]:
    """Return the parameters to vary for a claim: fitted fields, severities, then noise and parts of the claim."""
    paths = dict.fromkeys(
        [
            *entry.fitted,
            *(f"events.{position}.severity" for position in range(len(scenario.events))),
            *TRUE_ONES,
            *_parts(scenario, entry.metric),
        ]
    )
    found = [knob for path in paths if (knob := _knob(scenario, path, path in entry.fitted)) is not None]
    return found[:MOST]


def _parts(scenario: Scenario, metric: str) -> Iterator[str]:
    """Yield the paths of the active blocks in the parts of a metric."""
    family, _, rest = metric.removeprefix("twins.").partition(".")
    groups = {"diagnosis": "diagnosers", "estimation": "diagnosers", "identify": "identifiers"}
    head = f"{groups[family]}.{rest.partition('.')[0]}" if family in groups else "controller"
    section = section_at(scenario.spec, head)
    if section is not None:
        for name in type(section.params).model_fields:
            if any(word in name for word in NAMED):
                yield f"{head}.{name}"


def _knob(scenario: Scenario, path: str, is_fitted: bool) -> Knob | None:
    head, _, leaf = path.rpartition(".")
    card, value, fault = _card(scenario, head, leaf)
    if isinstance(value, bool) or not isinstance(value, int | float) or (card and card.type != "number"):
        return None
    low, high, is_log = usual_range(leaf, float(value), card)
    if not low < high:
        return None
    return Knob(
        path=path,
        label=_label(path, card, fault),
        unit=card.unit if card is not None else "",
        value=value,
        low=low,
        high=high,
        is_log=is_log,
        is_fitted=is_fitted,
        is_live=card is not None and card.live,
        fault=fault,
    )


def _card(scenario: Scenario, head: str, leaf: str) -> tuple[ParameterCard | None, Any, str | None]:
    """Return the card of a parameter, its value, and the fault whose severity it is."""
    parts = head.split(".")
    if parts[0] == "events":
        command = next((one for one in scenario.events[int(parts[1])] if isinstance(one, Inject)), None)
        if command is None:
            return None, None, None
        params = block("faults", command.fault).Params
        card = next((one for one in parameter_cards(params) if one.name == leaf), None)
        return card, _at(scenario.document, f"{head}.{leaf}"), command.fault
    section = section_at(scenario.spec, head)
    if section is None:
        return None, _at(scenario.document, f"{head}.{leaf}"), None
    card = next((one for one in parameter_cards(section.block.Params) if one.name == leaf), None)
    return card, value_at(scenario.spec, f"{head}.{leaf}"), None


def _at(document: Document, path: str) -> Any:
    """Return the value at a path of a document, None where the path does not exist."""
    found: Any = document
    for part in path.split("."):
        if isinstance(found, dict):
            found = found.get(part)
        elif isinstance(found, list) and part.isdigit() and int(part) < len(found):
            found = found[int(part)]
        else:
            return None
    return found


def usual_range(leaf: str, value: float, card: ParameterCard | None) -> tuple[float, float, bool]:
    """Return the range around a value, within the allowed limits."""
    least = card.minimum if card is not None and card.minimum is not None else -1e300
    most = card.maximum if card is not None and card.maximum is not None else 1e300
    is_log = value > 0.0 and any(word in leaf for word in WIDER)
    if "forgetting" in leaf and 0.0 < value <= 1.0:
        low, high, is_log = 0.5, 0.999, False
    elif is_log:
        low, high = value / 10.0, value * 10.0
    elif value == 0.0:
        low, high = 0.0, LEAST_NOISE if "noise" in leaf else 1.0
    else:
        low, high = sorted((0.0, 2.0 * value))
    least += 1e-3 * abs(least) if leaf == "severity" and least < 0.0 else 0.0  # its own end is not allowed
    low, high = max(low, least), min(high, most)
    return low, high, is_log and low > 0.0


def _label(path: str, card: ParameterCard | None, fault: str | None) -> str:
    if fault is not None:
        return f"{block('faults', fault).title}, severity (event {int(path.split('.')[1]) + 1})"
    leaf = path.rpartition(".")[2]
    return card.meaning or card.label if card is not None else leaf.replace("_", " ")
