"""Makes the example records of ``scenarios/records/examples`` again, to the bit: ``python scripts/make_records.py``.

The devices move by the classical Runge-Kutta rule, by 20 steps for each sample, and share no code with the bench.
Displacements in um, times in ms, masses in mg, forces in uN.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[1] / "scenarios" / "records" / "examples"
RATE_KHZ, STEPS = 50, 20
SAMPLES, HEALTHY = 4000, 2000
TONES_KHZ = ((1.24, 0.3), (2.11, 1.7), (2.86, 4.1))
"""Frequency and phase of the tones of the voltage."""


@dataclass(frozen=True)
class BenchDevice:
    """A device with its read-out; a mass, damper and spring has neither ``mode_force`` nor ``friction``."""

    mass: float = 2.209e-4 * 1.031
    damping: float = 7.09e-4 * 1.12
    stiffness: float = 0.0538 * 0.983
    force: float = -6.375e-3 * 1.047
    mode_force: float = 0.0
    friction: float = 0.0
    offset: float = 0.21
    drift: float = 0.0
    delay_steps: int = 12
    noise: float = 0.025
    step: float = 0.004
    clip: float = 1e9


@dataclass(frozen=True)
class Faulty:
    """A label, the sample from which it is true, and the change of the device."""

    first: int
    label: str
    change: Callable[[BenchDevice], BenchDevice]


def heavier(device: BenchDevice) -> BenchDevice:
    """Return the device with 5 % more mass."""
    return replace(device, mass=1.05 * device.mass)


def stiffer(device: BenchDevice) -> BenchDevice:
    """Return the device with a spring that is 10 % stiffer."""
    return replace(device, stiffness=1.10 * device.stiffness)


FAULTS = (Faulty(HEALTHY, "m+5", heavier), Faulty(3000, "k+10", stiffer))
RECORDS: dict[str, tuple[BenchDevice, tuple[Faulty, ...], float]] = {
    "labelled-faults": (BenchDevice(), FAULTS, 0.0),
    "lost-samples": (BenchDevice(), FAULTS, 0.08),
    "second-mode": (BenchDevice(mode_force=0.35), (), 0.0),
    "stiction": (BenchDevice(friction=4.5e-3), (), 0.0),
    "drift": (BenchDevice(drift=0.012), (), 0.0),
    "clipped": (BenchDevice(clip=2.2), (), 0.0),
}
"""Device, faults, and the share of displacements that the converter lost."""


def volts(sample: int) -> float:
    """Return the voltage that acts from a sample on, as the file has it."""
    t = sample / RATE_KHZ
    return round(4.0 * sum(math.sin(2.0 * math.pi * khz * t + phase) for khz, phase in TONES_KHZ), 4)


def slope(device: BenchDevice, state: tuple[float, ...], volt: float) -> tuple[float, ...]:
    """Return the rates of displacement, velocity, and both of the second mode (4.3 kHz, damping ratio 0.02)."""
    x, v, x2, v2 = state
    rubbing = 1.0 + 0.3 * math.exp(-((v / 4.0) ** 2))  # more at rest than in motion (Stribeck)
    rub = device.friction * rubbing * math.tanh(v / 0.5)
    push = device.force * volt
    slow = 2.0 * math.pi * 4.3
    return (
        v,
        (push - device.damping * v - device.stiffness * x - rub) / device.mass,
        v2,
        device.mode_force * push / device.mass - 0.04 * slow * v2 - slow * slow * x2,
    )


def stepped(device: BenchDevice, state: tuple[float, ...], volt: float) -> tuple[float, ...]:
    """Return the state after a step."""
    h = 1.0 / RATE_KHZ / STEPS

    def moved(rates: tuple[float, ...], part: float) -> tuple[float, ...]:
        return tuple(s + part * h * r for s, r in zip(state, rates, strict=True))

    k1 = slope(device, state, volt)
    k2 = slope(device, moved(k1, 0.5), volt)
    k3 = slope(device, moved(k2, 0.5), volt)
    k4 = slope(device, moved(k3, 1.0), volt)
    mean = tuple((a + 2.0 * b + 2.0 * c + d) / 6.0 for a, b, c, d in zip(k1, k2, k3, k4, strict=True))
    return moved(mean, 1.0)


def lines(name: str) -> list[str]:
    """Return the lines of a record."""
    whole, faults, lost = RECORDS[name]
    chance = random.Random(name)
    state: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0)
    found = ["time_ms,drive (V),displacement (um),label"]
    for sample in range(SAMPLES):
        fault = next((one for one in reversed(faults) if sample >= one.first), None)
        device = fault.change(whole) if fault else whole
        seen = state[0] + state[2] + device.offset + device.drift * sample / RATE_KHZ + chance.gauss(0.0, device.noise)
        seen = round(min(max(seen, -device.clip), device.clip) / device.step) * device.step
        is_lost = chance.random() < lost or (lost and 2400 <= sample < 2440)
        label, measured = fault.label if fault else "healthy", "" if is_lost else f"{seen:.3f}"
        found.append(f"{sample / RATE_KHZ:.2f},{volts(sample):.4f},{measured},{label}")
        for step in range(STEPS):
            acting = sample if step >= device.delay_steps else sample - 1
            state = stepped(device, state, volts(acting) if acting >= 0 else 0.0)
    return found


def main() -> None:
    """Write every record."""
    for name in RECORDS:
        (FOLDER / f"{name}.csv").write_text("\n".join(lines(name)) + "\n", "utf-8")
        print(name)


if __name__ == "__main__":
    main()
