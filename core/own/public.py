"""Signals for the inputs of user units: signals that exist in a laboratory, none of the truth.

A sensor senses the plant and a fault changes it, so they alone see it; neither may drive or judge.
"""

from __future__ import annotations

import ast
import re

from core.control.two_axis import DrivePorts, RatePorts
from core.loop.effects import Effects
from core.own.mistakes import nearest
from core.own.text import refuse
from core.ports import INPUT, BlockPorts, Port

MOST_LABELS = 64
LONGEST_TEXT = 300
IDENTIFIER = re.compile(r"[a-z][a-z0-9_]{0,31}")
DRIVEN = ("drive.voltage", "drive.middle", "drive.end")
REFERENCE = ("reference.voltage", "reference.middle", "reference.end")
MEASURED = ("sensor.displacement",)
OBSERVED = (*MEASURED, "plant.missing?")
MOTION = tuple(
    f"sensor.{axis}.{name}{mark}"
    for axis, mark in (("x", ""), ("y", ""), ("partner_x", "?"), ("partner_y", "?"))
    for name in ("displacement", "velocity")
)
CARRIER = ("@drive.sine", "@drive.cosine", "@drive.amplitude", "@drive.frequency")
AXES = ("x", "y")
SLOTS = {"drive": DrivePorts, "sense": RatePorts}
"""Axes that units for gyroscopes declare; the slots of controllers, and the ports that others expect of each."""


PUBLIC: dict[str, tuple[str, ...]] = {
    "reference": (),
    "control": (*REFERENCE, "model.displacement", "model.velocity", *MEASURED, *DRIVEN, "@engaged"),
    "control, axes": (*MOTION, *CARRIER, "@engaged", "@tuning.softening"),
    "readout": ("@active.rate",),
    "diagnose": (*OBSERVED, *DRIVEN, *REFERENCE),
    "identify": (*OBSERVED, *DRIVEN, *REFERENCE),
    "supervise": (
        "{diagnoser}.winner",
        "{diagnoser}.unexplained",
        *MEASURED,
        "model.displacement",
        *DRIVEN,
        *REFERENCE,
    ),
    "sense": ("plant.displacement", "plant.velocity", "@true.displacement", *MEASURED),
    "faults": (*(f"effects.{port.name}" for port in Effects.outputs), *DRIVEN),
}
"""Sources of the inputs of each family; what ends in ``?`` is not on every bench, and must be read so."""

ALARMS = ("alarm",)
"""Outputs by which a diagnoser without hypotheses is known; the board measures its delays and false alarms."""
FIRST_OUTPUTS = {
    "control": ("voltage",),
    "sense": ("displacement",),
    "diagnose": ("probability", *ALARMS),
    "identify": ("estimate",),
    "supervise": ("request",),
    "faults": ("severity",),
}
"""Outputs that other blocks read; a unit of a family has at least one of its family."""


def check_ports(node: ast.AST, family: str, ports: type[BlockPorts]) -> None:
    """Refuse ports that a unit of this family may not have."""
    slot = slot_of(ports)
    sources = PUBLIC[f"{family}, axes" if slot else family]
    for port in ports.declared:
        if port.kind == INPUT and not {port.source, port.source.removesuffix("?")} & {*sources}:
            text = f"{port.name} reads {port.source}, which a unit of {family} may not"
            refuse(node, text + (nearest(port.source, sources) or "; it reads no signal"))
        if port.each not in ("", "hypotheses") or (port.each and family != "diagnose"):
            refuse(node, f"{port.name} has a number for each {port.each}; a diagnoser may say hypotheses")
        if port.vector and not port.labels and not port.each:
            refuse(node, f"{port.name} is a vector without labels; name its items by labels=(...)")
        if bool(port.labels or port.each) != port.vector:
            refuse(node, f"{port.name} has labels and is no Vector")
        if len(port.labels) > MOST_LABELS or any(not IDENTIFIER.fullmatch(label) for label in port.labels):
            refuse(node, f"{port.name} has labels that are no names of small letters, digits and _")
        if max(map(len, (port.name, port.unit, port.meaning, port.warning))) > LONGEST_TEXT:
            refuse(node, f"{port.name} has a text of more than {LONGEST_TEXT} characters")
        if port.vector and port.kind == INPUT:
            refuse(node, f"{port.name} is a vector that is read")
    names = {port.name: port for port in ports.declared}
    for base in ports.__mro__[1:]:
        for port in getattr(base, "declared", ()):
            if _shape(names[port.name]) != _shape(port):
                refuse(node, f"{port.name} is another port in {base.__qualname__}, which others read")
    wanted = () if slot else FIRST_OUTPUTS.get(family, ())
    if wanted and not any(name in names and names[name].kind != INPUT for name in wanted):
        refuse(node, f"has no output {' or '.join(wanted)}, which others read; declare it in Ports by output(...)")


def _shape(port: Port) -> tuple[object, ...]:
    """Return the properties of a port that others rely on: whether it is read or written, and its numbers."""
    return port.kind, port.vector, port.labels, port.each


def slot_of(ports: type[BlockPorts]) -> str:
    """Return the slot of a controller with these ports; "" for one displacement."""
    return next((slot for slot, base in SLOTS.items() if issubclass(ports, base)), "")
