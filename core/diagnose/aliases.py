r"""Aliases: which hypotheses, and which other changes, have the same response at a tone.

.. math:: D=kf_k-mf_m\omega^2+j\beta f_\beta\omega,\qquad Y=\frac{f_gF}{D}V

One tone in steady state determines D only, two numbers, so mass and stiffness can replace one another: :math:`\Delta
k/k=-(\omega/\omega_0)^2\,\Delta m/m`. A second tone separates them.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

import numpy as np
from pydantic import BaseModel, Field

from core.block import Oscillator
from core.diagnose.excitation import LEAST_INFORMATION
from core.diagnose.hypothesis import Hypothesis

FACTORS = ("mass", "stiffness", "damping", "gain")
SAME = 1e-3
"""Largest error of an equivalent change, as a share of the response."""
SWEEP_POINTS = 160
SWEEP_SPAN = 4.0
"""The sweep reaches from a centre over this number to the centre times this number."""


class Response(BaseModel):
    """The motion of a hypothesis at the tones, and the changes of one parameter that have the same."""

    name: str
    amplitudes_um: list[float]
    phases_deg: list[float]
    equivalents: dict[str, float]


class Pair(BaseModel):
    """Distance between two hypotheses, as rms over the tones; coincident when noise could hide it."""

    first: str
    second: str
    distance_um: float
    coincident: bool


class AliasMap(BaseModel):
    """Responses of all hypotheses, distances between them, and the equivalence of mass and stiffness."""

    tones_hz: list[float]
    stiffness_per_mass: float
    responses: list[Response]
    pairs: list[Pair]


class NamedPair(BaseModel):
    """Two hypotheses."""

    first: str
    second: str


class AliasSweep(BaseModel):
    """For a single tone of the first amplitude, the closest pair over frequency."""

    frequency_hz: list[float]
    distance_um: list[float]
    pair: list[int] = Field(description="Position of the pair in pairs_named, for each frequency")
    pairs_named: list[NamedPair]


class AliasReport(BaseModel):
    """The separate hypotheses and the coinciding hypotheses, now and at other drive frequencies."""

    map: AliasMap
    sensor_noise_um: float
    f0_hz: float
    sweep: AliasSweep


def alias_map(
    hypotheses: Sequence[Hypothesis],
    nominal: Oscillator,
    tones: Sequence[tuple[float, float]],
    within_um: float = 0.0,
) -> AliasMap:
    """Return the response of every hypothesis at the tones, and the pairs that coincide.

    Parameters
    ----------
    hypotheses : sequence of Hypothesis
        The models.
    nominal : Oscillator
        The device they are factors on.
    tones : sequence of (float, float)
        Frequency in Hz and amplitude in V of every tone of the drive.
    within_um : float
        Distance below which two hypotheses count as coincident, besides rounding.
    """
    phasors = [[_phasor(item, nominal, f) * volts for f, volts in tones] for item in hypotheses]
    responses = [
        Response(
            name=item.name,
            amplitudes_um=[abs(value) for value in found],
            phases_deg=[math.degrees(cmath.phase(value)) for value in found],
            equivalents=_equivalents(item, nominal, [f for f, _ in tones]),
        )
        for item, found in zip(hypotheses, phasors, strict=True)
    ]
    pairs = []
    for i, first in enumerate(hypotheses):
        for j in range(i + 1, len(hypotheses)):
            squares = [abs(a - b) ** 2 for a, b in zip(phasors[i], phasors[j], strict=True)]
            distance = math.sqrt(sum(squares) / max(len(squares), 1))
            size = max((abs(value) for value in phasors[i]), default=0.0)
            same = distance <= max(within_um, SAME * size)
            pairs.append(Pair(first=first.name, second=hypotheses[j].name, distance_um=distance, coincident=same))
    omega = 2.0 * math.pi * tones[0][0] / 1e3 if tones else 0.0
    return AliasMap(
        tones_hz=[f for f, _ in tones],
        stiffness_per_mass=-nominal.mass * omega * omega / nominal.stiffness,
        responses=responses,
        pairs=sorted(pairs, key=lambda pair: pair.distance_um),
    )


def alias_report(
    hypotheses: Sequence[Hypothesis],
    nominal: Oscillator,
    tones: Sequence[tuple[float, float]],
    within_um: float,
    sensor_noise_um: float,
) -> AliasReport:
    """Return the map at the tones of a drive, and the closest pair under single tones around the resonance.

    Parameters
    ----------
    hypotheses, nominal, tones, within_um
        As `alias_map` takes them; at least one tone.
    sensor_noise_um : float
        Noise of the sensor, which the report repeats.
    """
    f0 = 1e3 * nominal.natural_frequency / (2.0 * math.pi)
    frequency, volts = tones[0]
    # An axis of octaves has no place for a constant, so the map is then drawn around the resonance.
    centre = math.sqrt(f0 * (frequency or f0))
    grid = np.geomspace(centre / SWEEP_SPAN, centre * SWEEP_SPAN, SWEEP_POINTS).tolist()
    closest = [alias_map(hypotheses, nominal, [(hz, volts)]).pairs[0] for hz in grid]
    named = sorted({(pair.first, pair.second) for pair in closest})
    return AliasReport(
        map=alias_map(hypotheses, nominal, tones, within_um),
        sensor_noise_um=sensor_noise_um,
        f0_hz=f0,
        sweep=AliasSweep(
            frequency_hz=grid,
            distance_um=[pair.distance_um for pair in closest],
            pair=[named.index((pair.first, pair.second)) for pair in closest],
            pairs_named=[NamedPair(first=first, second=second) for first, second in named],
        ),
    )


def equivalents(
    hypotheses: Sequence[Hypothesis], name: str, nominal: Oscillator, tones: Sequence[tuple[float, float]]
) -> dict[str, float]:
    """Return the factors on single parameters of the device that each give a hypothesis's response at every tone."""
    item = next(item for item in hypotheses if item.name == name)
    return _equivalents(item, nominal, [f for f, _ in tones])


def hidden_um(noise_um: float) -> float:
    r"""Return the distance below which two responses to a tone are hardly distinguishable.

    A sample is worth :math:`|\Delta Y|^2/4\sigma^2` nats; less than ``LEAST_INFORMATION`` does not repay the odds of a
    probability floor within thousands of samples.
    """
    return 2.0 * noise_um * math.sqrt(LEAST_INFORMATION)


def _stiffness(item: Hypothesis, nominal: Oscillator, hz: float) -> complex:
    """Return the dynamic stiffness per gain, the only number that one tone determines."""
    omega = 2.0 * math.pi * hz / 1e3
    device = item.oscillator(nominal)
    return complex(device.stiffness - device.mass * omega**2, device.damping * omega) / item.gain


def _phasor(item: Hypothesis, nominal: Oscillator, hz: float) -> complex:
    return nominal.force / _stiffness(item, nominal, hz)


def _equivalents(item: Hypothesis, nominal: Oscillator, tones: Sequence[float]) -> dict[str, float]:
    """Return the factors on single parameters of the nominal device that each give the same response at every tone."""
    equivalents: dict[str, float] = {}
    for name in FACTORS:
        factors = [_single(name, _stiffness(item, nominal, f), nominal, f) for f in tones]
        if not factors or any(factor is None for factor in factors):
            continue
        values = [factor for factor in factors if factor is not None]
        changed = abs(values[0] - 1.0) > SAME * SAME
        unchanged = values[0] == getattr(item, name) or abs(values[0] - getattr(item, name)) < SAME * SAME
        if max(values) - min(values) <= SAME * abs(values[0]) and changed and not unchanged:
            equivalents[name] = values[0]
    return equivalents


def _single(name: str, wanted: complex, nominal: Oscillator, hz: float) -> float | None:
    """Return the factor on one parameter that gives a dynamic stiffness, or None if no positive factor does."""
    omega = 2.0 * math.pi * hz / 1e3
    now = complex(nominal.stiffness - nominal.mass * omega**2, nominal.damping * omega)
    if name == "gain":
        factor = (now / wanted).real
    elif name == "damping":
        factor = wanted.imag / now.imag if now.imag else 0.0
    elif name == "mass":
        inertia = nominal.mass * omega**2  # 0 also where the square of a tiny frequency underflows
        factor = (nominal.stiffness - wanted.real) / inertia if inertia else 0.0
    else:
        factor = (wanted.real + nominal.mass * omega**2) / nominal.stiffness
    if not factor > 0.0:
        return None
    reached = {
        "gain": now / factor,
        "damping": complex(now.real, nominal.damping * factor * omega),
        "mass": complex(nominal.stiffness - nominal.mass * factor * omega**2, now.imag),
        "stiffness": complex(nominal.stiffness * factor - nominal.mass * omega**2, now.imag),
    }[name]
    return float(factor) if abs(reached - wanted) <= SAME * abs(wanted) else None
