"""Draws for each student of a class: the device, the noise, a hidden fault."""

from __future__ import annotations

from core.device.device import Device
from core.device.spread import Tolerances, evaluate
from core.device.spread import draw as draw_devices
from core.errors import InputError
from server.security.keyed import keyed_hash


def draw(secret: str, *what: str) -> int:
    """Return a number that only the server can know beforehand: the same for the same words, unlike any other.

    Parameters
    ----------
    secret : str
        Of the class; it stays on the server. People alone have none, and all of them draw the same.
    *what : str
        What it is for: a student, an exercise, a purpose. A different word gives an unrelated number.

    Returns
    -------
    int
        0 to 2**31 - 1, a seed.

    """
    return int.from_bytes(keyed_hash(secret.encode(), *what)[:4], "big") >> 1


def device_of(device: Device, seed: int) -> dict[str, float]:
    """Return the values of one device from the process of a resonator, by their paths in a scenario.

    What its drawing gives varies as that of one device of a wafer does; values that are given vary by the same factors.

    Raises
    ------
    InputError
        For a device that is no resonator.
    """
    if device.usual_plant != "linear":
        raise InputError("is no resonator, and has no process to be drawn from", "device")
    found, nominal = draw_devices(device.drawing, Tolerances(), 1, seed).found, evaluate(device.drawing)
    given = {**device.resolved, "force": 2.0 * abs(device.bias_v) * device.capacitance_gradient}
    values = {name: float(value * found[name][0] / nominal[name]) for name, value in given.items()}
    if force := values.pop("force"):  # none without a bias
        values["force_n_per_v"] = force
    return {f"device.{name}": value for name, value in values.items()}
