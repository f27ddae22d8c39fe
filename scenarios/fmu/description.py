"""The description of an FMU: its variables with units and meanings, as FMI 3.0 has it."""

from __future__ import annotations

from typing import Any
from xml.etree import ElementTree

from core.format import format_short
from core.units import MS_PER_S
from scenarios.fmu.layout import FmuLayout
from scenarios.fmu.source import ends, first_severity
from scenarios.fmu.unit_text import base_unit
from scenarios.schema import Scenario

MODEL = "combbench"
"""Name of the library."""
TICKS = 1000
"""Samples of the experiment that an importer suggests."""


def description(scenario: Scenario, one: FmuLayout, token: str, version: str) -> bytes:
    """Return ``modelDescription.xml``."""
    root = ElementTree.Element(
        "fmiModelDescription",
        fmiVersion="3.0",
        modelName=scenario.id,
        instantiationToken=token,
        description=f"{scenario.head.title or scenario.id}: {one.board.spec.device.id}, without its controllers",
        generationTool=f"CombBench {version}",
        variableNamingConvention="structured",
    )
    dt_s = one.board.dt_ms / MS_PER_S
    ElementTree.SubElement(
        root,
        "CoSimulation",
        modelIdentifier=MODEL,
        canHandleVariableCommunicationStepSize="true",
        fixedInternalStepSize=repr(dt_s),
        canGetAndSetFMUState="true",
        canSerializeFMUState="true",
    )
    variables = _variables(one)
    units = ElementTree.SubElement(root, "UnitDefinitions")
    for text in dict.fromkeys(entry["unit"] for entry in variables):
        unit = ElementTree.SubElement(units, "Unit", name=text)
        if (known := base_unit(text)) is not None:
            factor, exponents = known
            shown = {**{key: str(value) for key, value in exponents.items()}, "factor": repr(factor)}
            ElementTree.SubElement(unit, "BaseUnit", shown)
    ElementTree.SubElement(root, "DefaultExperiment", startTime="0.0", stopTime=repr(TICKS * dt_s), stepSize=repr(dt_s))
    listed = ElementTree.SubElement(root, "ModelVariables")
    for number, entry in enumerate(variables):
        ElementTree.SubElement(listed, "Float64", {"valueReference": str(number), **entry})
    structure = ElementTree.SubElement(root, "ModelStructure")
    outputs = [str(number) for number, entry in enumerate(variables) if entry["causality"] == "output"]
    for kind in ("Output", "InitialUnknown"):
        for reference in outputs:
            ElementTree.SubElement(structure, kind, valueReference=reference)
    ElementTree.indent(root)
    found: bytes = ElementTree.tostring(root, "utf-8", xml_declaration=True)
    return found


def _variables(one: FmuLayout) -> list[dict[str, str]]:
    """Return the variables in the order of their references."""
    found = [_variable("time", "s", "time of the simulation", "independent", "continuous")]
    for command in one.commands:
        meaning = "asked of the drive, held over the next step"
        found.append(_variable(command.name, command.unit, meaning, "input", "discrete", 0.0))
    for name, entry in one.faults.items():
        meaning = f"severity of the fault {entry['title']}{_grid(entry['variants'][0]['dependence'])}"
        low, high = ends(entry)
        limits = {key: repr(end) for key, end in (("min", low), ("max", high)) if abs(end) < float("inf")}
        first = first_severity(one, name)
        found.append({**_variable(f"severity.{name}", entry["unit"], meaning, "input", "discrete", first), **limits})
    for path, entry in one.values.items():
        limits = {"min": repr(float(entry["low"])), "max": repr(float(entry["high"]))}
        meaning = f"{entry['label']}{_grid(entry['dependence'])}"
        own = _variable(path, entry["unit"], meaning, "parameter", "tunable", entry["value"])
        found.append({**own, **limits})
    found += [_variable(one.name, one.unit, one.meaning, "output", "discrete") for one in one.outputs]
    return found


def _variable(
    name: str, unit: str, meaning: str, causality: str, variability: str, start: float | None = None
) -> dict[str, str]:
    entry: dict[str, Any] = {
        "name": name,
        "description": meaning,
        "causality": causality,
        "variability": variability,
        "unit": unit or "1",
    }
    return entry if start is None else {**entry, "start": repr(float(start))}


def _grid(entry: dict[str, Any]) -> str:
    """Return the words for the values of a grid."""
    if "grid" not in entry:
        return ""
    return f"; one of {', '.join(format_short(value, '') for value in entry['grid'])}"
