"""The units of ``docs/units``: each against an oracle of its own, and with its claims on a library scenario."""

from __future__ import annotations

import runpy
from typing import Any

import numpy as np
import pytest

from core.block import FloatArray, Oscillator
from core.own.unit import unit
from scenarios.run import RunResult, run
from scenarios.schema import Scenario
from tests.core.own.test_own_units import with_unit
from tests.core.own.texts import ROOT
from tests.physics.loop import sampled

UNITS = ROOT / "docs" / "units"
AGED = "ch3-case1-aged-mass"


def source(name: str) -> str:
    return (UNITS / f"{name}.py").read_text("utf-8")


def bench(name: str, base: str, values: dict[str, Any] | None = None) -> Scenario:
    return with_unit(name, source(name), values or {}, base)


def packed(name: str, scenario: Scenario) -> Any:
    block = unit(name, source(name)).block
    return block.Packed(block.packed(block.Params(), scenario.spec.context(1)))


def true_device(result: RunResult) -> Oscillator:
    """Return the device as the faults have left it."""
    nominal = result.board.spec.nominal
    mass, stiffness, damping = (result.signal(f"effects.{name}_scale")[-1] for name in ("mass", "stiffness", "damping"))
    return Oscillator(nominal.mass * mass, nominal.damping * damping, nominal.stiffness * stiffness, nominal.force)


def phasors(device: tuple[FloatArray, FloatArray], z: complex) -> Any:
    """Return displacement and velocity of a sampled device under a voltage of one at a frequency."""
    over, push = device
    return np.linalg.solve(z * np.eye(2) - over, push)[:, 0]


def turn(scenario: Scenario) -> complex:
    """Return how the reference turns in a sample."""
    return complex(np.exp(2j * np.pi * scenario.document["reference"]["frequency_hz"] * 1e-3 * scenario.spec.dt_ms))


def tail_error(result: RunResult) -> float:
    return float(result.summary()["metrics"]["control.tail_rms_error_um"])


def test_the_page_lists_every_unit_and_the_command_line_accepts_it() -> None:
    text = (ROOT / "docs" / "own-units.md").read_text("utf-8")
    programs = {"train_neural_net"}
    names = {path.stem for path in UNITS.glob("*.py")} - programs
    assert names == {"page", "neural_net"}
    for name in names:
        assert f"[`{name}.py`](units/{name}.py)" in text
        assert unit(name, source(name)).family == ("diagnose" if name == "page" else "control")


# ---------------------------------------------------------------- Page's test


def test_page_adds_up_the_ratios_and_alarms_in_time() -> None:
    result = run(bench("page", "ch5-seven-step", {"diagnosers.mine.kind": "page"}), taps=True)
    spec = result.board.spec
    applied, measured = result.signal("drive.voltage"), result.signal("sensor.displacement")
    factors = [{}, {"m": 1.05}, {"m": 1.10}, {"k": 1.05}, {"k": 1.10}, {"b": 1.30}]
    names = ["healthy", "m+5", "m+10", "k+5", "k+10", "b+30"]
    models = []
    for factor in factors:
        nominal = spec.nominal
        mass, damping = nominal.mass * factor.get("m", 1.0), nominal.damping * factor.get("b", 1.0)
        over, push = sampled(
            Oscillator(mass, damping, nominal.stiffness * factor.get("k", 1.0), nominal.force), spec.dt_ms
        )
        state, seen = np.zeros(2), [0.0]
        for volt in applied[:-1]:
            state = over @ state + push[:, 0] * volt
            seen.append(state[0])
        models.append(seen)
    said = np.array(models)
    squares = ((measured - said) / 0.05) ** 2
    sums, wanted = np.zeros(6), []
    for tick in range(len(measured)):
        sums = np.maximum(0.0, sums + 0.5 * (squares[0, tick] - squares[:, tick]))
        sums = np.maximum(0.0, sums - max(0.0, sums.max() - 20.0))
        wanted.append(sums)
    got = np.column_stack([result.signal(f"mine.sum.{name}") for name in names])
    np.testing.assert_allclose(got, np.array(wanted), atol=1e-5)

    # the sum is at least the sum of the ratios since the fault; its mean and variance follow from the motion without
    # noise
    motion, fault = result.signal("plant.displacement"), slice(2001, 2200)
    mean = np.cumsum(((motion - said[0]) ** 2 - (motion - said[1]) ** 2)[fault]) / (2.0 * 0.05**2)
    variance = np.cumsum((said[1] - said[0])[fault] ** 2) / 0.05**2
    latest = int(np.argmax(mean - 4.0 * np.sqrt(variance) > 10.0))
    alarm = result.signal("mine.alarm")
    np.testing.assert_array_equal(alarm > 0.0, got.max(axis=1) > 10.0)
    assert not alarm[:2001].any(), "e^h samples to a false alarm are ten times the healthy stretch"
    assert 0 < int(np.argmax(alarm[fault] > 0.0)) <= latest < 60
    assert result.summary()["metrics"]["diagnosis.mine.correct_fraction"] > 0.95


# ---------------------------------------------------------------- a network


def test_neural_net_has_the_weights_of_its_training() -> None:
    training = runpy.run_path(str(UNITS / "train_neural_net.py"))
    weights, missed = training["train"]()
    own = runpy.run_path(str(UNITS / "neural_net.py"))
    np.testing.assert_allclose([own["OF_ERROR"], own["OF_RATE"], own["OUT"]], weights, rtol=1e-3)
    assert missed < 0.07


def test_neural_net_computes_its_forward_pass_and_leaves_the_error_of_the_same_loop_in_numpy() -> None:
    scenario = bench("neural_net", AGED, {"controller.kind": "neural_net"})
    result = run(scenario, taps=True)
    own = runpy.run_path(str(UNITS / "neural_net.py"))
    nominal, dt = scenario.spec.nominal, scenario.spec.dt_ms
    (a, b), (am, bm) = sampled(true_device(result), dt), sampled(nominal, dt)
    reference, before = result.signal("reference.voltage"), 0.0
    x, m, errors, corrections = np.zeros(2), np.zeros(2), [], []
    for tick, volt in enumerate(reference):
        e = m[0] - x[0]
        rate = (e - before) / (nominal.natural_frequency * dt) if tick else 0.0
        before = e
        net = np.tanh(np.array(own["OF_ERROR"]) * e + np.array(own["OF_RATE"]) * rate) @ np.array(own["OUT"])
        corrections.append(10.0 * np.sign(nominal.force) * net)
        errors.append(e)
        x = a @ x + b[:, 0] * (volt + corrections[-1])
        m = am @ m + bm[:, 0] * volt
    np.testing.assert_allclose(result.signal("neural_net.correction"), corrections, atol=1e-3)
    tail = np.array(errors)[-len(errors) // 4 :]
    assert tail_error(result) == pytest.approx(np.sqrt(np.mean(tail**2)), rel=1e-3)
    assert tail_error(result) < 0.4 * tail_error(run(bench("neural_net", AGED, {"controller.kind": "open_loop"})))
