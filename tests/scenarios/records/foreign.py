"""Devices that are simulated apart from ``core``: own equations, converter, offset, gain and delay.

Mass, damping, stiffness and force differ from nominal. Linear devices move by the matrix exponential, with the delay
within a sample; others by small steps.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

Numbers = NDArray[np.float64]
NAMES = ("healthy", "m+5", "m+10", "k+5", "k+10", "b+30")
FACTORS = ((1.0, 1.0, 1.0), (1.05, 1.0, 1.0), (1.1, 1.0, 1.0), (1.0, 1.05, 1.0), (1.0, 1.1, 1.0), (1.0, 1.0, 1.3))
DT = 0.02
HEALTHY, STEP = 2000, 1000
NOMINAL = {"m": 2.209e-4, "b": 7.09e-4, "k": 0.0538, "f": -6.375e-3}
OUTSIDE = ("second mode", "saturation", "higher order", "drifting delay", "nonlinear spring", "friction")


@dataclass
class Foreign:
    """A record of a foreign device, the true index of the hypothesis at each sample, and what was drawn."""

    drive: Numbers
    displacement: Numbers
    truth: NDArray[np.int64]
    drawn: dict[str, Any] = field(default_factory=dict)

    @property
    def ratios(self) -> dict[str, float]:
        """What a calibration should find."""
        d = self.drawn
        return {
            "mass": d["m"] / d["f"],
            "damping": d["b"] / d["f"],
            "stiffness": d["k"] / d["f"],
            "delay_samples": d["delay"],
            "offset_um": d["offset"],
        }


def draw(seed: int, outside: str = "", samples: int = 9000) -> Foreign:
    """Return a device drawn by a seed, healthy for the first 2000 samples, then with a fault for each 1000 samples."""
    rng = np.random.default_rng(seed)
    drawn: dict[str, Any] = {
        "m": 1 + rng.uniform(-0.1, 0.1),
        "b": 1 + rng.uniform(-0.3, 0.3),
        "k": 1 + rng.uniform(-0.1, 0.1),
        "f": 1 + rng.uniform(-0.1, 0.1),
        "offset": rng.uniform(-0.5, 0.5),
        "delay": rng.uniform(0, 3),
        "bits": int(rng.integers(10, 17)),
        "noise": 10 ** rng.uniform(-2.3, -1.2),
        "size": rng.uniform(0, 1),
    }
    t = np.arange(samples) * DT
    drive = excitation(rng, t)
    order = np.array([0, *rng.permutation([1, 2, 3, 4, 5]), 0])
    place = np.clip((np.arange(samples) - HEALTHY) // STEP + 1, 0, 6)
    truth = order[place]
    y = moved(drive, truth, drawn, outside)
    if outside == "higher order":
        y = lagged(y, 0.5 + 2.5 * drawn["size"])
    full = 1.3 * np.abs(y).max() + 0.5
    if outside == "saturation":
        clip = (0.5 + 0.35 * drawn["size"]) * np.abs(y[:HEALTHY]).max()
        y = np.clip(y, -clip, clip)
    step = 2 * full / 2 ** drawn["bits"]
    y = y + drawn["offset"] + rng.normal(0, drawn["noise"], samples)
    return Foreign(drive, np.round(y / step) * step, truth, drawn)


def excitation(rng: np.random.Generator, t: Numbers) -> Numbers:
    """Return three tones, a chirp that repeats, or random steps; each tells mass from stiffness."""
    f0 = np.sqrt(NOMINAL["k"] / NOMINAL["m"]) / (2 * np.pi)
    kind = rng.integers(3)
    if kind == 0:
        return np.asarray(4 * sum(np.sin(2 * np.pi * f0 * part * t + rng.uniform(0, 6)) for part in (0.5, 0.85, 1.15)))
    if kind == 1:
        within = t % 10.0
        return np.asarray(9 * np.sin(2 * np.pi * f0 * (0.4 * within + 0.06 * within * within)))
    return np.asarray(7 * np.repeat(rng.choice([-1.0, 1.0], len(t) // 5 + 1), 5)[: len(t)])


def moved(drive: Numbers, truth: NDArray[np.int64], drawn: dict[str, Any], outside: str) -> Numbers:
    """Return the motion of a device at the samples."""
    y, x, second = np.zeros(len(drive)), np.zeros(2), np.zeros(2)
    steps: dict[Any, Any] = {}
    beside = mode(drawn) if outside == "second mode" else None
    for i in range(len(drive)):
        y[i] = x[0] + second[0]
        factors = FACTORS[truth[i]]
        m, k, b = (NOMINAL[name] * drawn[name] * factor for name, factor in zip("mkb", factors, strict=True))
        f = NOMINAL["f"] * drawn["f"]
        delay = drawn["delay"] + (3.0 * i / len(drive) if outside == "drifting delay" else 0.0)
        whole, rest = int(delay), round(delay - int(delay), 4)
        old = drive[i - whole - 1] if i > whole else 0.0
        new = drive[i - whole] if i >= whole else 0.0
        if outside in ("friction", "nonlinear spring"):
            x = rubbed(x, (old, new, rest), (m, b, k, f), drawn["size"], outside)
            continue
        key = int(truth[i]), rest
        if key not in steps:
            a = np.array([[0, 1, 0], [-k / m, -b / m, f / m], [0, 0, 0]])
            steps[key] = expm(a * DT * rest), expm(a * DT * (1 - rest))
        for whole_step, u in zip(steps[key], (old, new), strict=True):
            x = whole_step[:2, :2] @ x + whole_step[:2, 2] * u
        if beside is not None:
            second = beside[:2, :2] @ second + beside[:2, 2] * new
    return y


def mode(drawn: dict[str, Any]) -> Numbers:
    """Return one sample of a second mode between 3 and 6 kHz."""
    stiffness = (2 * np.pi * (3 + 3 * drawn["size"])) ** 2
    push = (0.1 + 0.5 * drawn["size"]) * NOMINAL["f"] / NOMINAL["m"]
    a = np.array([[0, 1, 0], [-stiffness, -0.05 * np.sqrt(stiffness), push], [0, 0, 0]])
    return np.asarray(expm(a * DT))


def rubbed(x: Numbers, held: tuple[float, ...], device: tuple[float, ...], size: float, outside: str) -> Numbers:
    """Return one sample of a device with friction or a cubic spring, by 20 small steps."""
    (old, new, rest), (m, b, k, f) = held, device
    h = DT / 20
    for part in range(20):
        u = old if part < 20 * rest else new
        cubic = (0.1 + 0.3 * size) * NOMINAL["k"] / 4 if outside == "nonlinear spring" else 0.0
        v = x[1] + h * (f * u - k * x[0] - cubic * x[0] ** 3 - b * x[1]) / m
        if outside == "friction":
            loss = h * (0.1 + 0.3 * size) * 3 * abs(NOMINAL["f"]) / m
            v = 0.0 if abs(v) <= loss else v - np.sign(v) * loss
        x = np.array([x[0] + h * v, v])
    return x


def lagged(y: Numbers, khz: float) -> Numbers:
    """Return the record behind a filter of first order."""
    share, last, found = 1 - np.exp(-2 * np.pi * khz * DT), 0.0, np.empty(len(y))
    for i, value in enumerate(y):
        last += share * (value - last)
        found[i] = last
    return found
