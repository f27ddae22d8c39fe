"""A bench for a record: identifiers and diagnosers of a scenario, with the record in place of its plant."""

from __future__ import annotations

from typing import TYPE_CHECKING

from core.board.document import Document
from core.errors import InputError
from core.measured_record import PlayedRecord
from core.units import MG_PER_KG
from scenarios.schema import Scenario

if TYPE_CHECKING:  # scipy, which a server may do without
    from scenarios.records.calibration import Calibration

KEPT = (
    "reference",
    "model",
    "controller",
    "controllers",
    "slots",
    "identifiers",
    "diagnosers",
    "units",
    "seed",
)
"""Tables of the scenario that the bench takes over."""


def on_record(
    scenario: Scenario,
    record: PlayedRecord,
    noise_um: float | None = None,
    calibration: Calibration | None = None,
) -> Document:
    """Return the scenario that plays a record.

    Parameters
    ----------
    scenario : Scenario
        The bench whose identifiers and diagnosers look at the record.
    record : PlayedRecord
        The record; it is on the shelf once the scenario is loaded.
    noise_um : float, optional
        The noise that filters assume, um; the noise of the calibration or of the scenario's sensor without it.
    calibration : Calibration, optional
        The device behind the record; the device of the scenario without it.

    Raises
    ------
    InputError
        For a scenario with axes, or without a run.
    """
    if scenario.spec.axes:
        raise InputError(f"{scenario.id} has axes, a record has one displacement", "scenario", "choose another")
    if scenario.study is not None:
        raise InputError(f"{scenario.id} is a study, which has no bench", "scenario", "choose another")
    noise = scenario.spec.context().sensor_noise_um if noise_um is None else noise_um
    plant: Document = {"model": "record", "record": record.key}
    device = scenario.bench.get("device", {})
    if calibration is not None:
        noise = calibration.noise_um if noise_um is None else noise_um
        plant |= {"offset_um": calibration.offset_um.value, "delay_samples": max(calibration.delay_samples.value, 0.0)}
        device = {**device, **calibrated_device(scenario, calibration)}
    return {
        "id": f"record-{record.key[:12]}",
        "title": f"A record of {record.samples} samples on the bench of {scenario.id}",
        **{name: scenario.bench[name] for name in KEPT if name in scenario.bench},
        "sample_rate_khz": record.rate_khz,
        "device": device,
        "plant": plant,
        "sensor": {"kind": "recorded", "noise_um": noise},
    }


def calibrated_device(scenario: Scenario, calibration: Calibration) -> Document:
    """Return mass, damping and stiffness of the calibrated device, at the force of the scenario's device."""
    nominal = scenario.spec.nominal
    return {
        "mass_kg": nominal.mass * calibration.mass.value / MG_PER_KG,
        "damping_ns_m": nominal.damping * calibration.damping.value / 1e3,
        "stiffness_n_m": nominal.stiffness * calibration.stiffness.value,
    }
