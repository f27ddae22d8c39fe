"""The device of a scenario as an FMU of FMI 3, for other simulators."""

from __future__ import annotations

import json
import os
import tempfile
from pathlib import Path
from typing import cast

from pythonfmu3 import FmuBuilder

from core.device.oscillator import held
from core.errors import InputError
from core.plant.linear import Linear
from core.plant.shuttle import ShuttleParams
from core.units import MS_PER_S
from scenarios.outside import fmu_slave
from scenarios.schema import Scenario


def export(scenario: Scenario, path: Path) -> None:
    """Write the device of a scenario as a co-simulation FMU: its linear plant, without noise and faults.

    Parameters
    ----------
    scenario : Scenario
        One with the linear plant; its sample interval is the step of the FMU.
    path : Path
        The file; it is replaced once it is whole.

    Raises
    ------
    InputError
        For another plant.
    """
    plant = scenario.spec.plant
    if plant.block is not Linear:
        raise InputError(f"{plant.block.name} cannot be exported; the FMU is the linear plant", "plant.model")
    spec, start = scenario.spec, cast(ShuttleParams, plant.params)
    device, (stiffness_scale, damping_scale) = spec.nominal, spec.surroundings
    phi11, phi12, phi21, phi22, reach, push = held(
        device.mass, device.damping * damping_scale, device.stiffness * stiffness_scale, spec.dt_ms
    )
    given = {
        "description": f"Lateral comb resonator {spec.device.id}, held voltage, of the scenario {scenario.id}",
        "interval_s": spec.dt_ms / MS_PER_S,
        "transition": [[phi11, phi12 / MS_PER_S], [phi21 * MS_PER_S, phi22]],
        "push": [reach * device.force, push * device.force * MS_PER_S],
        "start": [start.initial_displacement_um, start.initial_velocity_um_ms * MS_PER_S],
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        numbers = Path(folder) / "device.json"
        numbers.write_text(json.dumps(given), "utf-8")
        options = {"canHandleVariableCommunicationStepSize": False}
        made = FmuBuilder.build_FMU(fmu_slave.__file__, dest=folder, project_files=[numbers], **options)
        os.replace(made, path)
