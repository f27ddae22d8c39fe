"""One device of a process, as the fields of a bench."""

from __future__ import annotations

from core.device.device import Device
from core.device.spread import Tolerances, draw, evaluate
from core.errors import InputError


def device_of(device: Device, seed: int) -> dict[str, float]:
    """Return the values of one device from the process of a resonator, by their paths in a scenario.

    Parameters from its drawing vary like one device of a wafer; given values vary by the same factors.

    Raises
    ------
    InputError
        For a device that is no resonator.
    """
    if device.usual_plant != "linear":
        raise InputError("is no resonator, and has no process to be drawn from", "device")
    found, nominal = draw(device.drawing, Tolerances(), 1, seed).found, evaluate(device.drawing)
    given = {**device.resolved, "force": 2.0 * abs(device.bias_v) * device.capacitance_gradient}
    values = {name: float(value * found[name][0] / nominal[name]) for name, value in given.items()}
    if force := values.pop("force"):  # none without a bias
        values["force_n_per_v"] = force
    return {f"device.{name}": value for name, value in values.items()}
