"""Every controller, identifier and diagnoser declares its stages, and a stage names only existing ports and states."""

from __future__ import annotations

from typing import Any

import pytest

from core.block import Block, BlockParams, Equation, Stage
from core.cards import card, check_structure
from core.own.text import UnitError
from core.own.unit import unit
from core.ports import BlockPorts, output, reads, tap
from core.record import Record
from core.registry import blocks

FAMILIES = ("control", "identify", "diagnose")
OPENED = [entry for family in FAMILIES for entry in blocks(family).values()]
FROM_INSIDE = {"forced_drive": {"x", "frequency"}, "drive_tracking": {"frequency"}}
"""Ports that follow from parameters and time alone."""


class Gain(Block):
    """A law with a state and a tap."""

    title = "Gain"
    equations = (Equation("law", "u=ke"), Equation("error", "e=r-y"))
    Params = BlockParams

    class State(Record):
        """The error before."""

        before: float

    class Ports(BlockPorts):
        """Reference and measurement in, voltage out."""

        reference: float = reads("reference.voltage", "V")
        measured: float = reads("sensor.displacement", "um")
        voltage: float = output("V")
        error: float = tap("um")


ERROR = Stage("Error", "reference measured", "error", ("error",))
LAW = Stage("Law", "error before", "voltage before", ("law",))


def with_structure(*stages: Stage) -> type[Block]:
    """Return the law with stages."""
    return type("Staged", (Gain,), {"structure": stages})


@pytest.mark.parametrize("entry", OPENED, ids=lambda entry: f"{entry.family}-{entry.name}")
def test_each_has_stages_of_its_own_that_lead_from_inputs_to_outputs(entry: type[Block]) -> None:
    """Follow the stages from the inputs on until nothing is new: all outputs have been reached."""
    assert entry.structure
    check_structure(entry)
    titles = [stage.title for stage in entry.structure]
    assert len(set(titles)) == len(titles)
    reached = {port.name for port in entry.inputs} | FROM_INSIDE.get(entry.name, set())
    for _ in entry.structure:
        for stage in entry.structure:
            if reached & {*stage.takes.split()}:
                reached |= {*stage.gives.split()}
    outputs = {port.name for port in entry.outputs if not port.hidden}
    assert outputs <= reached
    assert {e.label for e in entry.equations} <= {label for stage in entry.structure for label in stage.equations}


def test_the_bank_goes_from_models_to_weights() -> None:
    """Filters give residuals, these likelihoods, these weights; the filters carry the equations of the base."""
    stages = {stage.title: stage for stage in card(blocks("diagnose")["imm"]).structure}
    assert stages["Kalman filters"].gives == ["residual", "nis", "covariance"]
    assert [e.label for e in stages["Kalman filters"].equations] == ["filter", "residual covariance"]
    assert {"nis", "covariance"} <= {*stages["Densities"].takes}
    assert "probability" in stages["Weights"].gives
    assert "filter" not in {e.label for e in blocks("diagnose")["imm"].equations}


def test_a_block_without_stages_is_one_with_all_its_ports() -> None:
    """Inputs, outputs and taps, under its title and with its equations."""
    (whole,) = card(Gain).structure
    assert (whole.title, whole.takes, whole.gives) == ("Gain", ["reference", "measured"], ["voltage", "error"])
    assert [equation.label for equation in whole.equations] == ["law", "error"]
    check_structure(with_structure(ERROR, LAW))


@pytest.mark.parametrize(
    ("stages", "words"),
    [
        ((Stage("Error", "target measured", "error", ("error",)), LAW), "target, which is no port and no state"),
        ((Stage("Error", "reference", "error", ("sum",)), LAW), "the equation sum, which is not there"),
        ((ERROR, LAW, Stage("Again", "error", "voltage")), "gives voltage, which comes from elsewhere"),
        ((ERROR, LAW, Stage("Sensor", "voltage", "measured")), "gives measured, which comes from elsewhere"),
        ((ERROR, Stage("Law", "error", "before", ("law",))), "no stage gives or carries voltage"),
        ((ERROR, Stage("Law", "error before", "voltage", ("law",))), "no stage gives or carries before"),
        ((ERROR, Stage("Law", "error before", "voltage before")), "no stage gives or carries law"),
    ],
)
def test_stages_that_name_what_is_not_there_are_refused(stages: tuple[Stage, ...], words: str) -> None:
    """The line says which module, which stage, which name."""
    with pytest.raises(TypeError, match=words):
        check_structure(with_structure(*stages))


OWN = '''"""A gain."""

from core.block import Block, BlockParams, Equation, Stage
from core.control.controller import ControllerPorts
from core.record import Record


class Gain(Block):
    """A gain."""

    title = "Gain"
    equations = (Equation("law", "u=r"),)
    structure = (Stage("Law", "reference", "GIVES", ("law",)),)

    class Params(BlockParams):
        """None."""

    class Ports(ControllerPorts):
        """The ports of every controller."""

    @staticmethod
    def step(p: Record, s: Record, x: Ports) -> None:
        """Amplify."""
        x.voltage = 2.0 * x.reference
'''


def test_a_unit_of_ones_own_tells_its_stages_or_is_drawn_as_one() -> None:
    """With stages they are checked like the stages of the library; without, it is one stage."""

    def stages(text: str) -> Any:
        return card(unit("gain", text).block).structure

    assert [stage.title for stage in stages(OWN.replace("GIVES", "voltage"))] == ["Law"]
    line = next(line for line in OWN.split("\n") if "Stage(" in line)
    (whole,) = stages(OWN.replace(line + "\n", "").replace(", Stage", ""))
    assert whole.gives == ["voltage"]
    with pytest.raises(UnitError, match="names force, which is no port and no state"):
        stages(OWN.replace("GIVES", "force"))
