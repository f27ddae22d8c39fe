"""Units for gyroscopes: the same bits as the library's in both slots, a read-out, and refused units."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.errors import InputError
from core.own.unit import unit
from scenarios.library import get
from scenarios.report.figure import figure
from scenarios.run import build, run
from scenarios.schema import Scenario
from scenarios.speed import units
from tests.core.own.price import PRICE_NS, priced
from tests.core.own.test_own_units import source_of, with_unit

MEAN = '''from core.block import Block, BlockParams, parameter
from core.ports import BlockPorts, output, reads
from core.record import Record


class Mean(Block):
    """The mean of the rate so far."""

    title = "Mean rate"
    axes = ("x", "y")

    class Params(BlockParams):
        """When it begins."""

        skip_ms: float = parameter(0.0, "start that is left out", "ms", ge=0, le=1e6)

    class Packed(Record):
        """When it begins."""

        skip_ms: float

    class State(Record):
        """Sum and samples."""

        sum: float
        samples: float

    class Ports(BlockPorts):
        """The rate, and its mean."""

        rate: float = reads("@active.rate", "deg/s", "rate as the controller that drives estimates it")
        mean: float = output("deg/s", "its mean")

    @staticmethod
    def step(p, s, x):
        """Add up."""
        if x.time_ms < p.skip_ms:
            return
        s.sum += x.rate
        s.samples += 1.0
        x.mean = s.sum / s.samples
'''
SHORT: dict[str, Any] = {"samples": 3000}
DRIVE, SENSE = source_of("control", "forced_drive"), source_of("control", "open_loop_rate")


@pytest.mark.parametrize(
    ("name", "base", "values"),
    [
        ("open_loop_rate", "gyro-first-look", {"controller.kind": "open_loop_rate"}),
        ("forced_drive", "gyro-first-look", {"slots.drive": "forced_drive"}),
    ],
)
def test_a_controller_of_the_library_as_a_unit_gives_its_own_digest(
    name: str, base: str, values: dict[str, Any]
) -> None:
    """The copy takes the place of the original: the text is compiled, and is on the bench, as a unit."""
    document = {key: value for key, value in get(base).document.items() if key not in ("duration_ms", "expect")}
    table: dict[str, Any] = {**document, **SHORT, "events": []}
    slots = {"controller": {"kind": values["controller.kind"]}} if "controller.kind" in values else {}
    drives = {"slots": {"drive": values["slots.drive"]}} if "slots.drive" in values else {}
    theirs = Scenario.load({**table, **slots, **drives})
    ours = Scenario.load({**theirs.document, "units": {name: {"source": source_of("control", name)}}})
    assert ours.spec.controllers[name].block.text and name in ours.spec.driving.values()
    assert run(ours).digest == run(theirs).digest


def test_a_read_out_concludes_from_the_rate_and_from_nothing_else() -> None:
    values = {"readouts.mean": {"kind": "mean", "skip_ms": 5.0}, "duration_ms": 30.0, "events": []}
    scenario = with_unit("mean", MEAN, values, "gyro-first-look")
    result = run(scenario)
    rate, mean = result.signal("open_loop_rate.rate"), result.signal("mean.mean")
    begun = scenario.spec.dt_ms * np.arange(len(rate)) >= 5.0
    assert (mean[~begun] == 0.0).all()
    np.testing.assert_allclose(mean[begun], np.cumsum(rate[begun]) / np.arange(1, begun.sum() + 1), rtol=1e-9)


def test_a_read_out_stands_beside_the_allan_deviation() -> None:
    document = get("gyro-allan").document
    readouts = {**document["readouts"], "mean": {"kind": "mean"}}
    table = {**document, "duration_ms": 4000.0, "readouts": readouts, "units": {"mean": {"source": MEAN}}}
    result = run(Scenario.load(table))
    assert [line.name for line in figure(result).series] == ["allan"]


def test_units_of_gyroscopes_stand_on_no_other_bench() -> None:
    board = build(with_unit("open_loop_rate_2", SENSE, {}, "first-look"))
    assert "open_loop_rate_2" not in board.spec.controllers
    for values in ({"controller.kind": "own"}, {"readouts.own.kind": "own"}):
        source = SENSE if "controller.kind" in values else MEAN
        with pytest.raises(InputError, match="needs x, y"):
            with_unit("own", source, values, "first-look")


@pytest.mark.parametrize("name", ["drive", "sense", "mean"])
def test_its_cost_is_measured_on_a_gyroscope(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(units, "block_costs", priced)
    assert units.cost_ns(unit("own", {"drive": DRIVE, "sense": SENSE, "mean": MEAN}[name]).block) == PRICE_NS


SENSE_READS = SENSE.replace("import output, tap", "import output, reads, tap")
READ = '        x_measured: float = reads("{}", "um", "seen")\n'
WRONG = {
    "truth of the plant": (
        SENSE_READS.replace('"""Ports of the read-out."""', READ.format("plant.y")),
        "reads plant.y",
    ),
    "truth of the rate": (MEAN.replace("@active.rate", "rate.rate"), "is none of these"),
    "truth beside the rate": (
        MEAN.replace("mean: float", 'true: float = reads("rate.rate", "deg/s", "true")\n        mean: float'),
        "reads rate.rate",
    ),
    "a partner that may be missing": (
        SENSE_READS.replace('"""Ports of the read-out."""', READ.format("sensor.partner_x.displacement")),
        "reads sensor.partner_x.displacement",
    ),
    "a fault": (
        SENSE_READS.replace('"""Ports of the read-out."""', READ.format("effects.quadrature")),
        "reads effects.",
    ),
    "what one displacement has": (
        SENSE_READS.replace('"""Ports of the read-out."""', READ.format("reference.voltage")),
        "reads reference.voltage",
    ),
    "another slot": (SENSE.replace('slot = "sense"', 'slot = "drive"'), "slot must be 'sense'"),
    "no slot": (SENSE.replace('    slot = "sense"\n', ""), "slot must be 'sense'"),
    "other axes": (SENSE.replace('axes = ("x", "y")', 'axes = ("x",)'), "axes must be"),
    "no axes": (MEAN.replace('    axes = ("x", "y")\n', ""), "axes must be"),
    "a slot of a read-out": (MEAN.replace("axes =", 'slot = "sense"\n    axes ='), "slot is no attribute"),
    "what only pack may call": (
        SENSE.replace('"""Read y."""', "x.rate = share_kept(1.0, 2.0)"),
        "share_kept is for pack, and no function of steps",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_refused(name: str) -> None:
    source, line = WRONG[name]
    assert source not in (SENSE, SENSE_READS, MEAN), "the text is changed"
    with pytest.raises(InputError, match="line ") as raised:
        unit("own", source)
    assert line in str(raised.value)
