"""Devices that are simulated apart from ``core``: own equations, converter, offset, gain and delay.

Mass, damping, stiffness and force differ from nominal. Linear devices move by the matrix exponential, with the delay
within a sample; others by small steps. Units are mg, um, ms, uN and V.
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
OUTSIDE = ("second mode", "saturation", "higher order", "drifting delay", "nonlinear spring", "friction", "stiction")
EXCITATIONS = ("three tones", "chirp", "steps")
OTHERS = (*EXCITATIONS, "two tones", "slow chirp")
NOISE = -2.3, -1.2
"""Decades of the noise of a sample, um."""
SLOW_MS = 40.0
"""Length of a slow chirp of the device of chapter 3."""


@dataclass(frozen=True)
class NominalDevice:
    """The device that foreign ones are near, as its bench knows it, and the interval of its samples."""

    m: float = 2.209e-4
    b: float = 7.09e-4
    k: float = 0.0538
    f: float = -6.375e-3
    dt: float = DT

    @property
    def khz(self) -> float:
        """Natural frequency."""
        return float(np.sqrt(self.k / self.m) / (2 * np.pi))

    @property
    def motion(self) -> float:
        """Displacement under a volt at rest, over that of the device of chapter 3."""
        return abs(self.f / self.k) / abs(CHAPTER_3.f / CHAPTER_3.k)


CHAPTER_3 = NominalDevice()


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


def other_nominal(seed: int) -> NominalDevice:
    """Return a nominal device drawn by a seed: 0.3 to 12 kHz, quality 2 to 20, 12 to 50 samples for each period."""
    rng = np.random.default_rng([seed, 1])
    khz, quality = 0.3 * 40 ** rng.uniform(), 2 * 10 ** rng.uniform()
    stiffness = CHAPTER_3.k * 10 ** rng.uniform(-1, 1)
    mass = stiffness / (2 * np.pi * khz) ** 2
    force = CHAPTER_3.f / CHAPTER_3.k * stiffness * 2 ** rng.uniform(-1, 1)
    return NominalDevice(mass, np.sqrt(mass * stiffness) / quality, stiffness, force, 1 / (khz * rng.uniform(12, 50)))


def draw(
    seed: int,
    outside: str = "",
    samples: int = 9000,
    nominal: NominalDevice = CHAPTER_3,
    excitations: tuple[str, ...] = EXCITATIONS,
) -> Foreign:
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
        "noise": nominal.motion * 10 ** rng.uniform(*NOISE),
        "size": rng.uniform(0, 1),
    }
    drive, drawn["excitation"] = excitation(rng, np.arange(samples), nominal, excitations)
    order = np.array([0, *rng.permutation([1, 2, 3, 4, 5]), 0])
    place = np.clip((np.arange(samples) - HEALTHY) // STEP + 1, 0, 6)
    truth = order[place]
    y = moved(drive, truth, drawn, outside, nominal)
    if outside == "higher order":
        y = lagged(y, (0.2 + drawn["size"]) * nominal.khz * nominal.dt)
    full = 1.3 * np.abs(y).max() + 0.5
    if outside == "saturation":
        clip = (0.5 + 0.35 * drawn["size"]) * np.abs(y[:HEALTHY]).max()
        y = np.clip(y, -clip, clip)
    step = 2 * full / 2 ** drawn["bits"]
    y = y + drawn["offset"] + rng.normal(0, drawn["noise"], samples)
    return Foreign(drive, np.round(y / step) * step, truth, drawn)


def excitation(
    rng: np.random.Generator, at: NDArray[np.int64], nominal: NominalDevice, among: tuple[str, ...]
) -> tuple[Numbers, str]:
    """Return the voltage at some samples, and its kind; each kind tells mass from stiffness."""
    t = at * nominal.dt * nominal.khz  # in periods of the device
    kind = among[rng.integers(len(among))]
    if kind in ("three tones", "two tones"):
        parts = (0.5, 0.85, 1.15) if kind == "three tones" else (0.7, 1.2)
        return 4 * np.sum([np.sin(2 * np.pi * part * t + rng.uniform(0, 6)) for part in parts], axis=0), kind
    if kind in ("chirp", "slow chirp"):
        length = (10.0 if kind == "chirp" else SLOW_MS) * CHAPTER_3.khz
        within = t % length
        return 9 * np.sin(2 * np.pi * (0.4 * within + 0.6 * within * within / length)), kind
    held = max(round(0.25 / (nominal.dt * nominal.khz)), 1)
    return 7 * np.repeat(rng.choice([-1.0, 1.0], len(t) // held + 1), held)[: len(t)], kind


def moved(
    drive: Numbers, truth: NDArray[np.int64], drawn: dict[str, Any], outside: str, nominal: NominalDevice
) -> Numbers:
    """Return the motion of a device at the samples."""
    y, x, second = np.zeros(len(drive)), np.zeros(2), np.zeros(2)
    steps: dict[Any, Any] = {}
    beside = mode(drawn, nominal) if outside == "second mode" else None
    for i in range(len(drive)):
        y[i] = x[0] + second[0]
        factors = FACTORS[truth[i]]
        m, k, b = (getattr(nominal, name) * drawn[name] * share for name, share in zip("mkb", factors, strict=True))
        f = nominal.f * drawn["f"]
        delay = drawn["delay"] + (3.0 * i / len(drive) if outside == "drifting delay" else 0.0)
        whole, rest = int(delay), round(delay - int(delay), 4)
        old = drive[i - whole - 1] if i > whole else 0.0
        new = drive[i - whole] if i >= whole else 0.0
        if outside in ("friction", "stiction", "nonlinear spring"):
            x = rubbed(x, (old, new, rest), (m, b, k, f), drawn["size"], outside, nominal)
            continue
        key = int(truth[i]), rest
        if key not in steps:
            a = np.array([[0, 1, 0], [-k / m, -b / m, f / m], [0, 0, 0]])
            steps[key] = expm(a * nominal.dt * rest), expm(a * nominal.dt * (1 - rest))
        for whole_step, u in zip(steps[key], (old, new), strict=True):
            x = whole_step[:2, :2] @ x + whole_step[:2, 2] * u
        if beside is not None:
            second = beside[:2, :2] @ second + beside[:2, 2] * new
    return y


def mode(drawn: dict[str, Any], nominal: NominalDevice) -> Numbers:
    """Return one sample of a second mode between 1.2 and 2.4 natural frequencies."""
    stiffness = (2 * np.pi * nominal.khz * 1.2 * (1 + drawn["size"])) ** 2
    push = (0.1 + 0.5 * drawn["size"]) * nominal.f / nominal.m
    a = np.array([[0, 1, 0], [-stiffness, -0.05 * np.sqrt(stiffness), push], [0, 0, 0]])
    return np.asarray(expm(a * nominal.dt))


def rubbed(
    x: Numbers,
    held: tuple[float, ...],
    device: tuple[float, ...],
    size: float,
    outside: str,
    nominal: NominalDevice,
) -> Numbers:
    """Return one sample of a device with friction, with more friction at rest, or with a cubic spring, by 20 steps."""
    (old, new, rest), (m, b, k, f) = held, device
    h = nominal.dt / 20
    for part in range(20):
        u = old if part < 20 * rest else new
        cubic = (0.1 + 0.3 * size) * nominal.k / (2 * nominal.motion) ** 2 if outside == "nonlinear spring" else 0.0
        v = x[1] + h * (f * u - k * x[0] - cubic * x[0] ** 3 - b * x[1]) / m
        if outside != "nonlinear spring":
            loss = h * (0.1 + 0.3 * size) * 3 * abs(nominal.f) / m
            least = 1.5 * loss if outside == "stiction" and x[1] == 0.0 else loss
            v = 0.0 if abs(v) <= least else v - np.sign(v) * loss
        x = np.array([x[0] + h * v, v])
    return x


def lagged(y: Numbers, cycles: float) -> Numbers:
    """Return the record behind a filter of first order, whose corner frequency has so many cycles in a sample."""
    share, last, found = 1 - np.exp(-2 * np.pi * cycles), 0.0, np.empty(len(y))
    for i, value in enumerate(y):
        last += share * (value - last)
        found[i] = last
    return found
