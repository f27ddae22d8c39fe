"""Every number that a block or a device declares changes something of a run: none is dead."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from core import registry
from core.board.board import Board
from core.board.document import with_values
from core.board.parse import changed, parse
from core.device.catalogue import device
from core.device.device import Device
from core.device.gyroscope import GyroscopeTable
from core.faults.fault import FaultParams
from core.loop.environment import Environment
from tests.lab import RICH, do, play
from tests.scenarios.test_scenarios import TABLES_OF_A_DEVICE, other_value, own_tables, tables

TICKS = 200
PLAIN: dict[str, Any] = {
    **{key: RICH[key] for key in ("sample_rate_khz", "seed", "device", "plant", "reference", "controller")},
    "sensor": {"kind": "ideal", "noise_um": 0.02},
}
AXES: dict[str, Any] = {
    **{"sample_rate_khz": 100, "seed": 3, "device": {"id": "gyro-a"}, "plant": {"model": "gyroscope_pair"}},
    "rate": {"kind": "constant", "deg_per_s": 50.0},
    "slots": {"drive": "drive_tracking"},
    "controller": {"kind": "force_to_rebalance"},
    "sensor": {"kind": "pick_off", "noise_pm_rthz": 0.05},
}
FIRST_ORDER: dict[str, Any] = {"device": {"id": "second-order-gain"}, "plant": {"model": "transfer_function"}}

HARD = {"guard.travel_um": 1000.0, "guard.stop_on_contact": False, "reference.amplitude_v": 30.0, "own.stop_um": 1.0}
TOUCHING = {**HARD, "device": {"id": "lcr-350", "bias_v": 29.0}, "own.misalignment_mrad": 0.5, "own.stop_um": 20.0}
ANALOGUE = {"drive.kind": "analogue"}


def models(first: float, second: float) -> dict[str, Any]:
    """Return two hypotheses about the mass."""
    return {"own.hypotheses": [{"name": "healthy", "mass": first}, {"name": "other", "mass": second}]}


TONES = {"kind": "multi_sine", "tones": [{"frequency_hz": 1000.0}, {"frequency_hz": 3100.0}], "amplitude_v": 10.0}
SOON = {"own.excitation_window_ms": 0.2, "own.least_excitation": 0.0, "sensor.noise_um": 0.0, "reference": TONES}


def banks(first: float, second: float, other: float = 1.2) -> dict[str, Any]:
    """Return two banks whose hypotheses are about the mass, and a supervisor that acts soon."""
    pairs = {"kalman": (first, second), "other": (1.0, other)}
    return {"own.hold_ms": 0.02, "own.dead_ms": 0.02} | {
        f"diagnosers.{name}": {
            "kind": "mmae",
            "hypotheses": [{"name": f"m{round(1000 * mass)}", "mass": mass} for mass in pair],
        }
        for name, pair in pairs.items()
    }


BANKS = {name: value for name, value in banks(1.0, 1.5).items() if not name.startswith("own.")}
LOUD = {"reference.amplitude_v": 40.0}
COMB = {"fingers": 200, "thickness_um": 60.0, "gap_um": 3.0}
COMBS = {"plant": {"model": "gyroscope"}, "device": {"id": "gyro-a", "electrodes": {"drive": COMB, "sense": COMB}}}
MATCHING = {"own.pilot_hz": 2000.0, "own.settle_ms": 0.0, "own.measure_ms": 1.5, "own.start_v": 35.0}
WHERE: dict[str, dict[str, Any]] = {
    "axis_drive.by": COMBS,
    "axis_drive.converter_limit_v": {**COMBS, "own.by": "volts", "own.converter_limit_v": 1e-4, "to": 2e-4},
    **{f"mode_matching.{name}": MATCHING for name in ("pilot_nm", "start_v", "gain", "split_hz")},
    "mode_matching.pilot_hz": {**MATCHING, "to": 2500.0},
    "mode_matching.settle_ms": {**MATCHING, "to": 0.1},
    "mode_matching.measure_ms": {**MATCHING, "to": 2.0},
    "mode_matching.most_share": {"own.start_v": 55.0, "to": 0.5},
    "prbs.chip_rate_hz": {"to": 20_000.0},
    "square.frequency_hz": {"to": 2000.0},
    "square.duty": {"own.frequency_hz": 2000.0},
    "nonlinear.slip_velocity_um_ms": {"own.friction_nn": 10.0},
    "nonlinear.stop_um": HARD,
    "nonlinear.stop_stiffness_n_m": HARD,
    "nonlinear.stop_damping_ns_m": HARD,
    "slaved_lateral.stop_um": HARD,
    "slaved_lateral.stop_stiffness_n_m": HARD,
    "slaved_lateral.stop_damping_ns_m": HARD,
    "planar.stop_um": HARD,
    "planar.stop_stiffness_n_m": HARD,
    "planar.stop_damping_ns_m": HARD,
    "planar.contact_clearance_um": TOUCHING,
    "planar.contact_stiffness_n_m": TOUCHING,
    "planar.contact_damping_ns_m": TOUCHING,
    "planar.short_on_contact": TOUCHING,
    "planar.near_step_us": {**TOUCHING, "to": 0.05},
    "capacitive.comb_start_um": {"plant": {"model": "planar", "misalignment_mrad": 1.0}},
    "single_beam.memory_ms": {"own.memory_ms": 0.01, "to": 1.0},
    "ideal.range_um": {"own.quantum_um": 0.1, "own.range_um": 1.0},
    "drive.limit_v": LOUD,
    "drive.dither_rate_hz": {"own.dither_v": 1.0, "to": 50_000.0},
    "guard.travel_um": {"own.travel_um": 1.0, "to": 2.0},
    "guard.rail_ms": {**LOUD, "own.rail_ms": 0.02, "to": 1.0},
    "guard.stop_on_contact": {
        "plant": {"model": "planar", "misalignment_mrad": 0.5},
        "device": {"id": "lcr-350", "bias_v": 29.0},
    },
    "model.damping_ratio": {"own.kind": "damped"},
    "axis_guard.travel_um": {"own.travel_um": 0.1, "to": 0.2},
    "axis_guard.rail_ms": {"drive.limit_un": 1e-3, "own.rail_ms": 0.02, "to": 1.0},
    "axis_drive.limit_un": {"own.limit_un": 1e-3},
    "adaptive_forgetting.covariance_limit": {"own.covariance_limit": 1e3, "to": 2e3},
    "adaptive_forgetting.step_size": {"own.reading": "step"},
    "gradient.range_ratio": {"own.range_ratio": 1.01},
    "least_squares.range_ratio": {"own.range_ratio": 1.01},
    "least_squares.covariance_limit": {"own.initial_covariance": 1.0, "own.covariance_limit": 3.0},
    "recursive_least_squares.covariance_limit": {"own.initial_covariance": 1.0, "own.covariance_limit": 4.0},
    "recursive_least_squares.reset_below": {"to": 1e10},
    **{
        f"{name}.{parameter}": {**SOON, "to": value}
        for name in ("adaptive_forgetting", "excitation", "gradient", "least_squares", "recursive_least_squares")
        for parameter, value in (("excitation_window_ms", 0.3), ("least_excitation", 1.0))
    },
    "excitation.filter_pole": SOON,
    "excitation.between": SOON,
    "indirect_mrac.trace_limit": {"own.covariance": 1.0, "own.trace_limit": 3.0, "own.forgetting_rate": 1e4},
    "gain_adaptation.proportional": {"own.rule": "monopoli"},
    "gain_adaptation.filter_time": {"own.rule": "monopoli"},
    "mrac.auxiliary": {"drive.limit_v": 1.0},
    "mrac_velocity.filters": {"to": False},
    "indirect_mrac.gain_floor": {"own.gain_floor": 1.0, "to": 0.9},
    "stvsc.gain_floor": {"own.gain_floor": 1.0, "to": 0.9},
    "mrac_velocity.gain_bound": {"own.gain_bound": 1e-3},
    **{
        f"{name}.voltage": {**ANALOGUE, "to": "start"}
        for name in "consistency cusum imm lock_in lock_in_glr mmae moving_bank reseed two_output".split()
    },
    "anchored.probability_floor": {"reference.amplitude_v": 30.0, "sensor.noise_um": 0.0, "to": 0.05},
    "free_banks.trace_limit": {"own.trace_limit": 1e3},
    "reference_banks.trace_limit": {"own.trace_limit": 1e3},
    "self_tuning.trace_limit": {"own.trace_limit": 1e3},
    "self_tuning.initial_forgetting": {"own.adaptation": "stepped"},
    "self_tuning.forgetting_step": {"own.adaptation": "stepped"},
    "self_tuning.gate": {"own.adaptation": "direct", "own.gate": 1.0},
    "self_tuning.least_forgetting": {"own.adaptation": "direct", "own.gate": 1.0},
    "self_tuning.innovation_window": {"own.adaptation": "direct", "own.gate": 1.0},
    "consistency.isolated_after": {**models(1.5, 1.0), "own.window": 10, "own.isolated_after": 1},
    "ekf.isolated_after": {**models(1.5, 1.0), "own.isolated_after": 1},
    "ekf.unknown_after": {**models(1.5, 1.3), "own.unknown_after": 1},
    "ekf.least_drive_v": {"to": 100.0},
    "consistency.unknown_after": {**models(1.5, 1.3), "own.window": 10, "own.unknown_after": 1},
    "lock_in_glr.least_drive_v": {**models(1.5, 1.3), "own.threshold": 1e-6, "own.window": 10, "to": 100.0},
    "moving_bank.reach": {"plant": {"model": "nonlinear", "cubic_n_m3": 1e11}, "own.reach": 2, "to": 3},
    "self_sliding.surface_slope": {"own.form": "velocity"},
    "self_sliding.velocity": {"own.form": "velocity"},
    "reseed.sure": {"own.interval": 10, "own.sure": 0.5, "to": 1.0},
    "reseed.hopeless": {"own.interval": 10, "own.sure": 0.5, "own.hopeless": 0.0, "to": 0.5},
    **{
        f"{name}.{parameter}": {**banks(1.0, 1.5), **values}
        for name in ("switching", "scheduling", "shutdown", "retuning")
        for parameter, values in (
            ("diagnoser", {}),
            ("hold_ms", {"own.hold_ms": 0.2}),
            ("dead_ms", {"own.dead_ms": 0.2}),
            ("threshold", {"to": 0.999}),
            ("release", {**banks(1.0, 1.001), "own.threshold": 0.501, "own.hold_ms": 0.0, "to": 0.0}),
            ("on_unknown", {**banks(1.5, 1.3), "to": "safe"}),
        )
    },
    "shutdown.on_unknown": {**banks(1.5, 1.3), "own.threshold": 1.0, "to": "safe"},
    "switching.nominal": banks(1.0, 1.5),
    "retuning.controller": banks(1.3, 1.5),
    "retuning.least_change": {**banks(1.3, 1.5), "to": 1.0},
    "multiple_model.diagnoser": BANKS,
    "multiple_model.combine": BANKS,
    "regions.degraded_above": {"to": 1e-6},
    "regions.unacceptable_above": {"to": 1e-6},
    "regions.danger_above": {"to": 1e-6},
}
"""Conditions for a parameter to act, where it does not on a plain bench; ``own`` means its own table."""
FAULTS: dict[str, dict[str, Any]] = {"debris.comb": {"conductive": True}}
"""Other parameters of a fault with which one of them acts."""


def bench(block: Any, base: dict[str, Any]) -> dict[str, Any]:
    """Return a plain bench that has a block."""
    if block.axes or block.per_axis:
        return {**AXES, **base}
    resonator = device({}).oscillator()
    return {**PLAIN, **(FIRST_ORDER if block.unsuited(resonator, resonator) else {}), **base}


def trace(spec: Any, command: dict[str, Any] | None = None) -> dict[str, bytes]:
    """Return the bits of every signal of a run, with a command at its start."""
    board = Board(spec)
    if command is not None:
        do(board, command)
    return {name: column.tobytes() for name, column in play(board, TICKS).items()} | {"end": repr(board.trip).encode()}


def dead(table: str, block: Any, base: dict[str, Any]) -> Iterator[str]:
    """Yield the parameters of a block that change no bit of any signal."""
    plain = bench(block, base)
    traces: dict[str, tuple[Any, dict[str, bytes]]] = {}
    is_parked = table.partition(".")[0] in ("sensors", "controllers")
    for card in registry.card(block).parameters:
        if card.type in ("list", "table") or (card.name == "always") is not is_parked:
            continue
        path = f"{table}.{card.name}"
        conditions = WHERE.get(f"{block.name}.{card.name}", {})
        values = {name.replace("own.", f"{table}.", 1): value for name, value in conditions.items() if name != "to"}
        if str(values) not in traces:
            spec = parse(with_values(plain, values))
            traces[str(values)] = spec, trace(spec)
        spec, before = traces[str(values)]
        if trace(changed(spec, {path: conditions.get("to", other_value(card))})) == before:
            yield f"{block.name}.{card.name}"


@pytest.mark.parametrize(
    "family", [*"reference plant sense control diagnose supervise identify rate readout".split(), "own"]
)
def test_every_parameter_of_a_block_changes_a_signal(family: str) -> None:
    found = [*(own_tables() if family == "own" else tables(family))]
    assert found and [name for one in found for name in dead(*one)] == []


def test_every_parameter_of_the_environment_changes_a_signal() -> None:
    assert [*dead("environment", Environment, {"plant": {"model": "nonlinear"}})] == []


@pytest.mark.parametrize("axes", [False, True])
def test_every_parameter_of_a_fault_changes_a_signal(axes: bool) -> None:
    wrong = []
    for name, block in registry.blocks("faults").items():
        if block.fits(("x", "y") if axes else ()):
            spec = parse(AXES if axes else {**PLAIN, "device": {"id": "lcr-350"}})
            for card in registry.card(block).parameters:
                if card.name in FaultParams.model_fields:
                    continue
                command = {"fault": name, "severity": block.suggested or 0.5, "at_sample": 20}
                usual = FAULTS.get(f"{name}.{card.name}", {})
                one, other = (
                    {**command, "parameters": own} for own in (usual, {**usual, card.name: other_value(card)})
                )
                wrong += [f"{name}.{card.name}"] if trace(spec, one) == trace(spec, other) else []
    assert wrong == []


def test_every_number_of_a_device_changes_a_signal() -> None:
    wrong = []
    for model, table, plain in (
        (Device, "device", {**PLAIN, "plant": {"model": "planar", "misalignment_mrad": 0.5}}),
        (GyroscopeTable, "device.gyroscope", AXES),
    ):
        spec = parse(plain)
        for name in model.model_fields:
            old = getattr(spec.device if table == "device" else spec.device.gyroscope, name)
            if name in ("id", "title", "source", *TABLES_OF_A_DEVICE) or isinstance(old, str):
                continue
            others: dict[str, Any] = {"fingers": 25, "fringing": "free"}
            value = others.get(name, 1.01 * old if old else 0.01)
            found = parse(with_values(plain, {f"{table}.{name}": value}))
            wrong += [f"{table}.{name}"] if trace(found) == trace(spec) else []
    assert wrong == []
