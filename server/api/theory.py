"""Theory: properties of a system that need no run."""

from __future__ import annotations

import math
from dataclasses import fields
from typing import Literal

import numpy as np
from pydantic import BaseModel, Field

from core.diagnose.aliases import AliasMap, alias_map, hidden_um
from core.diagnose.hypothesis import Hypothesis
from core.errors import InputError
from core.theory.definite import DefinitenessReport, definiteness
from core.theory.gain_adaptation import RULES, GainLoop, critical_gain, instability_map
from core.theory.nyquist import PositiveRealReport, positive_real_report
from core.theory.persistency import excitation, gram_of_tones
from scenarios.design import designed
from server.api.bodies import AnswerBody, Body, DeviceDocument
from server.api.deps import ServiceDep
from server.api.router import Router

router = Router(prefix="/theory", tags=["theory"])

MOST_CELLS = 10_000


class TransferFunctionSource(Body):
    """A transfer function; coefficients with the highest power first."""

    numerator: list[float] = Field(min_length=1, max_length=21)
    denominator: list[float] = Field(min_length=1, max_length=21)


class MatrixSource(Body):
    """A square matrix."""

    matrix: list[list[float]] = Field(min_length=1, max_length=50)


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


class ExcitationReport(AnswerBody):
    """How well the input excites the regressor [u, -y', -y]/(s + pole)^2."""

    eigenvalues: list[float]
    smallest: float
    relative: float = Field(description="Smallest eigenvalue with every component scaled to a unit mean square")
    condition: float | None = Field(description="Largest over smallest eigenvalue; null: infinite")
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
    critical_gain_constant: float | None = Field(description="Limit of the gain under a constant; null: beyond the map")


class HypothesesSource(Body):
    """A device, its possible faults, and the tones that drive it."""

    device: DeviceDocument = Field({}, description="Id of the catalogue, and values that replace its values")
    hypotheses: list[Hypothesis] = Field(min_length=2, max_length=16, description="Factors on the device")
    tones: list[Line] = Field(min_length=1, max_length=100, description="Amplitudes in V, frequencies in Hz")
    noise_um: float = Field(0.0, ge=0, le=100, description="Noise that can hide a difference")


@router.post("/positive-real")
async def judge_positive_real(body: TransferFunctionSource, service: ServiceDep) -> PositiveRealReport:
    """Judge a transfer function, and return its Nyquist curve over the frequencies that matter."""
    return await service.computing.call(positive_real_report, body.numerator, body.denominator)


@router.post("/positive-definite")
async def judge_positive_definite(body: MatrixSource, service: ServiceDep) -> DefinitenessReport:
    """Judge a matrix."""
    return await service.computing.call(definiteness, body.matrix)


@router.post("/persistency")
async def judge_persistency(body: ExcitationSource, service: ServiceDep) -> ExcitationReport:
    """Judge an input in its steady state."""
    return await service.computing.call(_persistency, body)


def _persistency(body: ExcitationSource) -> ExcitationReport:
    if len({tone.frequency for tone in body.tones}) < len(body.tones):
        raise InputError("two tones have the same frequency", "tones")
    lines = [(tone.amplitude, tone.frequency) for tone in body.tones]
    judged = excitation(gram_of_tones(lines, (body.gain, body.a1, body.a2), body.filter_pole))
    condition = judged.condition if math.isfinite(judged.condition) else None
    eigenvalues, exciting = judged.eigenvalues.tolist(), judged.relative > 0.0
    return ExcitationReport.of(judged, eigenvalues=eigenvalues, condition=condition, exciting=exciting)


@router.post("/aliases")
async def map_aliases(body: HypothesesSource, service: ServiceDep) -> AliasMap:
    """Map the responses of hypotheses to tones, and name those with the same response."""
    return await service.computing.call(_aliases, body)


def _aliases(body: HypothesesSource) -> AliasMap:
    if len({item.name for item in body.hypotheses}) < len(body.hypotheses):
        raise InputError("names must differ", "hypotheses")
    device = designed(body.device, {}).device.oscillator()
    if not (device.mass > 0.0 and device.stiffness > 0.0):
        raise InputError("needs a device with mass and spring", "device.id")
    lines = [(tone.frequency, tone.amplitude) for tone in body.tones]
    return alias_map(body.hypotheses, device, lines, hidden_um(body.noise_um))


@router.post("/instability-map")
async def map_instability(body: MapSource, service: ServiceDep) -> InstabilityMap:
    """Map the region where a rule of appendix B is unstable under a sine."""
    if body.lowest_frequency >= body.highest_frequency:
        raise InputError("must be below highest_frequency", "lowest_frequency")
    if body.frequencies * body.gains > MOST_CELLS:
        raise InputError(f"frequencies times gains must be {MOST_CELLS} or less", "frequencies")
    return await service.computing.call(_map, body)


def _map(body: MapSource) -> InstabilityMap:
    loop = GainLoop(**{field.name: getattr(body, field.name) for field in fields(GainLoop)})
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
