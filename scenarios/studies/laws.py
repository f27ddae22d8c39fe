"""Controllers compared: each law with each fault at each noise, by error and effort."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from pydantic import Field

from core.block import BlockParams, parameter
from core.board.commands import parse_command
from core.board.document import Document
from core.board.parse import parse
from core.board.spec import Spec
from core.loop.guard import Guard
from scenarios.studies.study import Study, StudyPicture

if TYPE_CHECKING:
    from core.board.board import Board


class Law(BlockParams):
    """A controller of the comparison."""

    name: str = Field(pattern=r"^[a-z][a-z0-9_]*$", description="its name in figures")
    controller: Document = Field(description="the controller, as a scenario has it")


class FaultyDevice(BlockParams):
    """A device of the comparison: the faults it has from the start."""

    name: str = Field(pattern=r"^[a-z][a-z0-9_]*$", description="its name in figures")
    faults: dict[str, float] = Field({}, description="severity of each fault")


class Laws(Study):
    """Runs the bench under every law, with every fault from the start, at every noise of its sensor.

    ``laws.<law>.<fault>.<noise in nm>.error_um`` is the rms of shuttle minus model in the last half of the run,
    ``.effort`` the rms of the voltage there over the rms of the reference. ``laws.<law>.worst.<noise in nm>.error_um``
    is the largest error over the faults, ``.trips`` the runs of a law that the guard ended; their error is the travel
    of the guard.
    """

    title = "Controllers compared"

    class Params(BlockParams):
        """The table."""

        laws: list[Law] = Field([], max_length=50, description="the controllers")
        faults: list[FaultyDevice] = Field([], max_length=50, description="the devices")
        noise_um: list[float] = parameter([0.0], "noise of the sensor", "um")
        samples: int = parameter(4000, "length of a run", ge=10, le=1_000_000)

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return the table."""
        found: dict[str, float] = {}
        for law in params.laws:
            trips = 0
            for noise in params.noise_um:
                worst, of_noise, spec = 0.0, label(1e3 * noise), spec_of(board, law.controller, noise)
                for change in params.faults:
                    error, effort = run(board, spec, change.faults, params.samples)
                    if not math.isfinite(effort):
                        trips += 1
                    else:
                        found[f"laws.{law.name}.{change.name}.{of_noise}.effort"] = effort
                    found[f"laws.{law.name}.{change.name}.{of_noise}.error_um"] = error
                    worst = max(worst, error)
                found[f"laws.{law.name}.worst.{of_noise}.error_um"] = worst
            found[f"laws.{law.name}.trips"] = float(trips)
        return found

    @classmethod
    def picture(cls, board: Board, params: Any) -> StudyPicture:
        """Return the largest error of each law over the noise."""
        found, noises = cls.figures(board, params), [1e3 * noise for noise in params.noise_um]
        curves = [
            (law.name, noises, [found[f"laws.{law.name}.worst.{label(one)}.error_um"] for one in noises])
            for law in params.laws
        ]
        return StudyPicture(("noise of the sensor", "nm"), ("largest error", "um"), curves)


def label(noise_nm: float) -> str:
    """Return a noise as the names of figures have it."""
    return f"{noise_nm:g}".replace(".", "_")


def spec_of(board: Board, controller: Document, noise_um: float) -> Spec:
    """Return the bench under a law, at a noise; boards of the same spec share their wiring."""
    sensor = {**board.base.get("sensor", {}), "noise_um": noise_um}
    return parse({**board.base, "controller": controller, "sensor": sensor})


def run(board: Board, spec: Spec, faults: dict[str, float], samples: int) -> tuple[float, float]:
    """Return error and effort of a law on a device; where the guard trips, its travel and no number."""
    fresh = type(board)(spec)
    for name, severity in faults.items():
        fresh.apply(parse_command({"fault": name, "severity": severity}), "study")
    at = [fresh.signals.index(name) for name in ("plant.displacement", "model.displacement")]
    volts = [fresh.signals.index(name) for name in ("drive.voltage", "reference.voltage")]
    squares = np.zeros(3)
    while fresh.tick < samples and (rows := fresh.advance(samples - fresh.tick)).count:
        first = fresh.tick - rows.count
        part = rows.outputs[max(0, samples // 2 - first) :]
        off = part[:, at[0]] - part[:, at[1]]
        for i, values in enumerate((off, part[:, volts[0]], part[:, volts[1]])):
            squares[i] += math.fsum((values * values).tolist())
    if fresh.trip is not None:
        return cast(Guard.Params, fresh.spec.guard.params).travel_um, math.nan
    return math.sqrt(squares[0] / (samples - samples // 2)), math.sqrt(squares[1] / squares[2])
