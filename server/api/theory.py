"""Theory: properties of a system that need no run."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np
from pydantic import BaseModel, Field

from core.diagnose.aliases import AliasMap, alias_map, hidden_um
from core.diagnose.hypothesis import Hypothesis
from core.errors import InputError
from core.theory.definite import definiteness
from core.theory.gain_adaptation import RULES, GainLoop, critical_gain, instability_map
from core.theory.persistency import excitation, gram_of_tones
from core.theory.positive_real import nyquist, polynomial, positive_real
from scenarios.design import designed
from server.api.bodies import Body
from server.api.deps import ComputingDep
from server.api.router import Router

router = Router(prefix="/theory", tags=["theory"])

POINTS = 400
DECADES = 3.0
MOST_CELLS = 10_000


class TransferFunctionSource(Body):
    """A transfer function; coefficients with the highest power first."""

    numerator: list[float] = Field(min_length=1, max_length=21)
    denominator: list[float] = Field(min_length=1, max_length=21)


class PositiveRealReport(BaseModel):
    """Whether a transfer function is positive real, why not, and its Nyquist curve."""

    strictly_positive_real: bool
    positive_real: bool
    hurwitz: bool
    minimum_phase: bool
    relative_degree: int
    least_real: float | None = Field(description="Smallest real part on the imaginary axis")
    at: float | None = Field(description="Frequency where it is; null: at infinity")
    reasons: list[str]
    frequency: list[float]
    real: list[float | None]
    imaginary: list[float | None]


class MatrixSource(Body):
    """A square matrix."""

    matrix: list[list[float]] = Field(min_length=1, max_length=50)


class DefinitenessReport(BaseModel):
    """Whether x'Ax is positive for every x."""

    positive_definite: bool
    semidefinite: bool
    symmetric: bool
    eigenvalues: list[float] = Field(description="Of the symmetric part, smallest first")
    minors: list[float] = Field(description="Leading principal minors of the symmetric part")


class Line(Body):
    """A tone, or a constant at frequency 0."""

    amplitude: float = Field(ge=-1e6, le=1e6)
    frequency: float = Field(ge=0, le=1e6)


class ExcitationSource(Body):
    """An input, and the second-order plant whose parameters it should separate, in one unit of time."""

    tones: list[Line] = Field(min_length=1, max_length=100)
    gain: float = Field(1.0, ge=-1e6, le=1e6)
    a1: float = Field(0.2, ge=1e-9, le=1e6)
    a2: float = Field(1.0, ge=1e-9, le=1e6)
    filter_pole: float = Field(1.0, gt=1e-3, le=1e3)


class ExcitationReport(BaseModel):
    """How well the input excites the regressor [u, -y', -y]/(s + pole)^2."""

    eigenvalues: list[float]
    smallest: float
    relative: float = Field(description="Smallest eigenvalue with every component scaled to a unit mean square")
    condition: float | None = Field(description="Null: infinite")
    exciting: bool


class MapSource(Body):
    """A rule, a plant kv/(b2 s^2 + b1 s + 1), and the axes of the map."""

    rule: Literal["mit", "parks", "lyapunov", "dressler", "price", "monopoli"] = "mit"
    b1: float = Field(0.2, gt=0, le=100)
    b2: float = Field(1.0, gt=0, le=100)
    gain: float = Field(1.0, gt=0, le=100)
    model_gain: float = Field(1.0, gt=0, le=100)
    amplitude: float = Field(1.0, gt=0, le=100)
    error_weight: float = Field(0.1, ge=0, le=100)
    proportional: float = Field(5.0, ge=0, le=100)
    filter_time: float = Field(6.0, gt=0.001, le=100)
    lowest_frequency: float = Field(0.2, gt=1e-3, le=100)
    highest_frequency: float = Field(2.0, gt=1e-3, le=100)
    highest_gain: float = Field(1.0, gt=0, le=1e3)
    frequencies: int = Field(60, ge=2, le=200)
    gains: int = Field(60, ge=2, le=200)


class InstabilityMap(BaseModel):
    """Growth rate of the worst solution for each frequency (rows) and adaptation gain (columns); below 0 it decays."""

    frequency: list[float]
    gain: list[float]
    growth: list[list[float]]
    critical_gain_constant: float | None = Field(description="Limit under a constant; null: none on the map")


class HypothesesSource(Body):
    """A device, its possible faults, and the tones that drive it."""

    device: dict[str, Any] = Field({}, description="Catalogue id, and values written over it")
    hypotheses: list[Hypothesis] = Field(min_length=2, max_length=16, description="Factors on the device")
    tones: list[Line] = Field(min_length=1, max_length=100, description="V and Hz")
    noise_um: float = Field(0.0, ge=0, le=100, description="Noise that could hide a difference")


@router.post("/positive-real")
async def judge_positive_real(body: TransferFunctionSource, computing: ComputingDep) -> PositiveRealReport:
    """Judge a transfer function, and return its Nyquist curve over the frequencies that matter."""
    return await computing.call(_positive_real, body)


def _positive_real(body: TransferFunctionSource) -> PositiveRealReport:
    verdict = positive_real(body.numerator, body.denominator)
    roots = np.concatenate([np.roots(polynomial(body.numerator, "")), np.roots(polynomial(body.denominator, ""))])
    sizes = [float(size) for size in np.abs(roots) if size > 0.0] or [1.0]
    low, high = math.log10(min(sizes)) - DECADES / 2, math.log10(max(sizes)) + DECADES / 2
    w = np.logspace(low, high, POINTS)
    with np.errstate(divide="ignore", invalid="ignore"):
        real, imaginary = nyquist(body.numerator, body.denominator, w)
    return PositiveRealReport(
        strictly_positive_real=verdict.strictly_positive_real,
        positive_real=verdict.positive_real,
        hurwitz=verdict.hurwitz,
        minimum_phase=verdict.minimum_phase,
        relative_degree=verdict.relative_degree,
        least_real=_finite(verdict.least_real),
        at=_finite(verdict.at),
        reasons=list(verdict.reasons),
        frequency=[float(value) for value in w],
        real=[_finite(float(value)) for value in real],
        imaginary=[_finite(float(value)) for value in imaginary],
    )


@router.post("/positive-definite")
async def judge_positive_definite(body: MatrixSource, computing: ComputingDep) -> DefinitenessReport:
    """Judge a matrix."""
    return await computing.call(_positive_definite, body)


def _positive_definite(body: MatrixSource) -> DefinitenessReport:
    verdict = definiteness(body.matrix)
    return DefinitenessReport(
        positive_definite=verdict.positive_definite,
        semidefinite=verdict.semidefinite,
        symmetric=verdict.symmetric,
        eigenvalues=list(verdict.eigenvalues),
        minors=list(verdict.minors),
    )


@router.post("/persistency")
async def judge_persistency(body: ExcitationSource, computing: ComputingDep) -> ExcitationReport:
    """Judge an input in its steady state."""
    return await computing.call(_persistency, body)


def _persistency(body: ExcitationSource) -> ExcitationReport:
    if len({tone.frequency for tone in body.tones}) < len(body.tones):
        raise InputError("two tones have the same frequency", "tones")
    lines = [(tone.amplitude, tone.frequency) for tone in body.tones]
    judged = excitation(gram_of_tones(lines, (body.gain, body.a1, body.a2), body.filter_pole))
    return ExcitationReport(
        eigenvalues=[float(value) for value in judged.eigenvalues],
        smallest=judged.smallest,
        relative=judged.relative,
        condition=_finite(judged.condition),
        exciting=judged.relative > 0.0,
    )


@router.post("/aliases")
async def map_aliases(body: HypothesesSource, computing: ComputingDep) -> AliasMap:
    """Map the responses of hypotheses to tones, and name those with the same response."""
    return await computing.call(_aliases, body)


def _aliases(body: HypothesesSource) -> AliasMap:
    if len({item.name for item in body.hypotheses}) < len(body.hypotheses):
        raise InputError("names must differ", "hypotheses")
    device = designed(body.device, {}).device.oscillator()
    if not (device.mass > 0.0 and device.stiffness > 0.0):
        raise InputError("needs a device with mass and spring", "device.id")
    lines = [(tone.frequency, tone.amplitude) for tone in body.tones]
    return alias_map(body.hypotheses, device, lines, hidden_um(body.noise_um))


@router.post("/instability-map")
async def map_instability(body: MapSource, computing: ComputingDep) -> InstabilityMap:
    """Map the region where a rule of appendix B is unstable under a sine."""
    if body.lowest_frequency >= body.highest_frequency:
        raise InputError("must be below highest_frequency", "lowest_frequency")
    if body.frequencies * body.gains > MOST_CELLS:
        raise InputError(f"frequencies times gains must be {MOST_CELLS} or less", "frequencies")
    return await computing.call(_map, body)


def _map(body: MapSource) -> InstabilityMap:
    names = ("b1", "b2", "gain", "model_gain", "amplitude", "error_weight", "proportional", "filter_time")
    loop = GainLoop(**{name: getattr(body, name) for name in names})
    frequency = np.linspace(body.lowest_frequency, body.highest_frequency, body.frequencies)
    gain = np.linspace(body.highest_gain / body.gains, body.highest_gain, body.gains)
    rule = RULES[body.rule]
    limit = critical_gain(loop, rule, 0.0, body.highest_gain)
    return InstabilityMap(
        frequency=frequency.tolist(),
        gain=gain.tolist(),
        growth=instability_map(loop, rule, gain, frequency).tolist(),
        critical_gain_constant=limit if limit < body.highest_gain else None,
    )


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
