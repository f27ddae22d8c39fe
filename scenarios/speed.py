"""Speed figures, each as a ratio to a peer measured in the same run."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping
from functools import partial
from statistics import median
from typing import Any

import numpy as np
from scipy import signal

from core import estimation, registry
from core.block import FloatArray, Oscillator, kernel
from core.board import program
from core.board.board import CHUNK, Board
from core.device.oscillator import transition
from core.device.response import held_response
from scenarios.campaign_speed import scaling
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build
from scenarios.side_by_side import DIAGNOSERS, SAMPLES, seven_steps, side_by_side

REPEATS = 7
CAMPAIGN_RUNS = 400
SECOND = 100_000
"""Samples of 1 s at 100 kHz."""
SAMPLE_NS = 10_000.0
"""Device time of a sample at 100 kHz."""


def cpu_ns(work: Callable[[], Any], units: int) -> float:
    """Return the CPU time of one unit of work, ns."""
    begin = time.thread_time_ns()
    work()
    return (time.thread_time_ns() - begin) / units


def interleaved(candidates: Mapping[str, Callable[[], float]], repeats: int = REPEATS) -> dict[str, float]:
    """Measure candidates in turn and return the median of each, so that drift meets all alike."""
    found: dict[str, list[float]] = {name: [] for name in candidates}
    for measure in candidates.values():
        measure()
    for _ in range(repeats):
        for name, measure in candidates.items():
            found[name].append(measure())
    return {name: median(values) for name, values in found.items()}


def _board(values: dict[str, Any] | None = None) -> Board:
    scenario = with_values(get("ch5-seven-step"), {"events": [], **(values or {})})
    board = build(scenario)
    board.advance(CHUNK)
    return board


def advance_cost(board: Board, ticks: int = 100 * CHUNK) -> float:
    """Return the cost of a tick as a bench pays it: blocks, trace rows, log, digest, ns."""

    def work() -> None:
        for _ in range(ticks // CHUNK):
            board.advance(CHUNK)

    return cpu_ns(work, ticks)


def loop_cost(board: Board, keys: list[str], ticks: int = 100_000) -> float:
    """Return the cost of a tick of some blocks alone, without trace or digest, ns."""
    wiring = board.wiring
    rows = [wiring.row(key) for key in keys]
    table = np.ascontiguousarray(wiring.table[rows])
    table[:, program.ADDRESS] = [program.compiled(wiring.instances[row].block.step).address for row in rows]
    nothing = np.zeros((ticks, 0))
    arrays = (table, wiring.p, wiring.s, wiring.w, wiring.io)
    trip, watches = wiring.index["guard.trip"], np.zeros((0, 3))

    def work() -> None:
        program.run(ticks, 1, board.dt_ms, *arrays, nothing, nothing, trip, watches)

    return cpu_ns(work, ticks)


ALIVE = ("plant", "effects", "sensor", "reference", "model", "open_loop", "drive")
"""Blocks that keep every signal moving: with frozen inputs a block is not doing its usual work."""


def block_costs(board: Board, *only: str) -> dict[str, float]:
    """Return the cost of some blocks or all, ns per tick, the dispatch included: a tick with it run once more."""
    candidates = {"": partial(loop_cost, board, [*ALIVE], 50_000)}
    for instance in board.wiring.instances:
        if not only or instance.key in only:
            candidates[instance.key] = partial(loop_cost, board, [*ALIVE, instance.key], 50_000)
    ns = interleaved(candidates)
    return {key: round(value - ns[""], 1) for key, value in ns.items() if key}


def filterpy_step(board: Board, steps: int = 300) -> Callable[[], float]:
    """Return the measurement of filterpy's bank on the same six models, ns per step."""
    from filterpy.kalman import KalmanFilter, MMAEFilterBank

    filters = []
    section = board.spec.diagnosers["kalman"]
    context = board.spec.context()
    for hypothesis in section.params.hypotheses:  # type: ignore[attr-defined]
        device = hypothesis.oscillator(context.device)
        phi = np.array(transition(device.mass, device.damping, device.stiffness, context.dt_ms)).reshape(2, 2)
        gamma = np.array([[(1.0 - phi[0, 0]) * device.static_gain], [-phi[1, 0] * device.static_gain]])
        kalman = KalmanFilter(dim_x=2, dim_z=1, dim_u=1)
        kalman.F, kalman.B, kalman.H = phi, gamma, np.array([[1.0, 0.0]])
        kalman.Q, kalman.R = gamma @ gamma.T * 0.09, np.array([[0.0025]])
        filters.append(kalman)
    bank = MMAEFilterBank(filters, [1.0 / len(filters)] * len(filters), dim_x=2, H=filters[0].H)

    def measure() -> float:
        def work() -> None:
            for i in range(steps):
                bank.predict(u=np.array([[np.sin(0.25 * i)]]))
                bank.update(np.array([[0.01 * i]]))

        return cpu_ns(work, steps)

    return measure


def interconnected_sample(board: Board, samples: int = 20) -> Callable[[], float]:
    """Return the measurement of python-control's simulation of the same adaptive loop, ns per sample of 10 us."""
    from scenarios.interconnected import adaptive_loop, simulate

    loop = adaptive_loop(board.spec.context())
    return lambda: cpu_ns(lambda: simulate(loop, board.dt_ms * samples), samples)


def lsim_sample(device: Oscillator, voltage: FloatArray) -> Callable[[], float]:
    """Return the measurement of ``scipy.signal.lsim`` on the same record, ns per sample."""
    system = (
        [device.force / device.mass],
        [1.0, device.damping / device.mass, device.stiffness / device.mass],
    )
    t = np.arange(len(voltage)) * 0.01
    return lambda: cpu_ns(lambda: signal.lsim(system, voltage, t), len(voltage))


@kernel
def estimate_record(
    s: FloatArray, regressors: FloatArray, measured: FloatArray, forgetting: float, limit: float
) -> None:
    """Run recursive least squares with four parameters over a record.

    Parameters
    ----------
    s : ndarray
        Estimate, lower triangle of the covariance, and eight scratch numbers.
    regressors, measured : ndarray, shape (m, 4) and (m,)
        The record.
    forgetting, limit : float
        Forgetting factor and largest trace.
    """
    n, at = 4, 14  # known when it is compiled, so that the loops are unrolled
    for i in range(regressors.shape[0]):
        error = measured[i]
        for j in range(n):
            s[at + j] = regressors[i, j]
            error -= s[j] * regressors[i, j]
        estimation.least_squares(s, 0, n, at, at + n, n, error, forgetting, forgetting, limit)


def estimate_start(covariance: float) -> FloatArray:
    """Return the state of ``estimate_record`` before the first sample."""
    return np.array([0.0] * 4 + estimation.diagonal(4, covariance) + [0.0] * 8)


def regressors_of(u: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the regressors [u, u, -y, -y] of a record and what they should give."""
    return np.column_stack([u[1:-1], u[:-2], -y[1:-1], -y[:-2]]), y[2:]


def estimate_sample(regressors: FloatArray, measured: FloatArray) -> Callable[[], float]:
    """Return the measurement of recursive least squares with four parameters, ns per update."""
    start = estimate_start(1e8)

    def measure() -> float:
        s = start.copy()
        return cpu_ns(lambda: estimate_record(s, regressors, measured, 0.98, 1e10), len(measured))

    return measure


def padasip_sample(regressors: FloatArray, measured: FloatArray, updates: int = 2000) -> Callable[[], float]:
    """Return the measurement of padasip's filter on the same record, ns per update."""
    import padasip

    def measure() -> float:
        peer = padasip.filters.FilterRLS(n=4, mu=0.98, eps=1e-8, w="zeros")

        def work() -> None:
            for i in range(updates):
                peer.adapt(measured[i], regressors[i])

        return cpu_ns(work, updates)

    return measure


ADAPTIVE = {
    "device": {"id": "ch3"},
    "plant": {"model": "linear", "thermal_noise": False},
    "reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 159.15494309189535},
    "controller": {"kind": "mrac"},
    "sensor": {"kind": "ideal"},
    "sample_rate_khz": 100,
}
"""Direct MRAC at 1 krad/s."""

GAIN = {
    "device": {"id": "second-order-gain"},
    "reference": {"kind": "sine", "amplitude_v": 1.0, "frequency_hz": 0.05},
    "controller": {"kind": "gain_adaptation"},
    "sensor": {"kind": "ideal"},
    "sample_rate_khz": 1,
}
"""The plant of appendix B, which has a controller of its own."""

PLANAR = {
    "device": {"id": "lcr-350"},
    "plant": {"model": "planar", "step_us": 0.25},
    "reference": {"kind": "sine", "amplitude_v": 3.0, "frequency_hz": 2000.0},
    "controller": {"kind": "open_loop"},
    "sensor": {"kind": "ideal"},
    "sample_rate_khz": 100,
}
"""Driven at 2 kHz, with all its noise."""


def speed() -> dict[str, Any]:
    """Measure everything and return it with the targets, JSON-ready."""
    identifiers = {f"identifiers.{name}.kind": name for name in registry.blocks("identify")}
    bench = _board({"plant.drive_noise_v": 0.01})
    estimating = _board({"plant.drive_noise_v": 0.01, **identifiers})
    gain = Board(GAIN)
    gain.advance(CHUNK)
    beside = build(side_by_side())
    beside.advance(CHUNK)
    plane = Board(PLANAR)
    plane.advance(CHUNK)
    device = bench.spec.context().device
    sine = 10.0 * np.sin(2.0 * np.pi * 2.0 * 0.01 * np.arange(SECOND))
    controllers = [i.key for i in bench.wiring.instances if i.block.family == "control"]
    hot = ["plant", "open_loop", "pid", "mrac", "kalman"]
    loop = Board(ADAPTIVE)
    loop.advance(CHUNK)
    candidates = {
        "bench_tick": lambda: advance_cost(bench),
        "plant_3_controllers_bank": lambda: loop_cost(bench, hot),
        "controllers": lambda: loop_cost(bench, controllers),
        "bank": lambda: loop_cost(bench, ["kalman"]),
        "seven_steps": seven_steps(cpu_ns),
        "mrac_loop": lambda: loop_cost(loop, ["plant", "effects", "sensor", "reference", "model", "mrac", "drive"]),
        "planar": lambda: loop_cost(plane, [*ALIVE], 2_000),
        "plant_record": lambda: cpu_ns(lambda: held_response(device, sine, 0.01), SECOND),
        "lsim": lsim_sample(device, sine),
    }
    tones = sine + 5.0 * np.sin(2.0 * np.pi * 4.5 * 0.01 * np.arange(SECOND))
    record = regressors_of(tones, held_response(device, tones, 0.01))
    candidates["least_squares"] = estimate_sample(*record)
    missing = []
    for peer, name, prepare in (
        ("filterpy", "filterpy_bank", partial(filterpy_step, bench)),
        ("padasip", "padasip", partial(padasip_sample, *record)),
        ("control", "interconnected_mrac", partial(interconnected_sample, loop)),
    ):
        try:
            candidates[name] = prepare()
        except ImportError:
            missing.append(f"{peer} is not installed (make setup-test installs it)")
    ns = interleaved(candidates)
    figures = [
        _figure("cost of a tick of a bench (blocks, trace, log, digest)", ns["bench_tick"] / 1e3, "us"),
        _figure("real-time benches at 100 kHz per core", SAMPLE_NS / ns["bench_tick"], "x"),
        _figure(
            "plant + 3 controllers + 6-model bank, per sample",
            ns["plant_3_controllers_bank"] / 1e3,
            "us",
            most=0.6,
        ),
        _figure(f"all {len(controllers)} controllers, per sample", ns["controllers"] / 1e3, "us", most=0.6),
        _figure("6-model bank, per step", ns["bank"] / 1e3, "us", most=0.15),
        _figure(
            f"seven steps, {SAMPLES} samples, {len(DIAGNOSERS)} diagnosers", ns["seven_steps"] / 1e6, "ms", most=10.0
        ),
        _figure(
            "planar plant with noise at 0.25 us, of real time at 100 kHz", SAMPLE_NS / ns["planar"], "x", least=1.0
        ),
        _figure(
            "linear plant, 1 s at 100 kHz as a record, over signal.lsim",
            ns["lsim"] / ns["plant_record"],
            "x",
            least=1000.0,
        ),
    ]
    figures.append(
        _figure("recursive least squares, 4 parameters, per update", ns["least_squares"] / 1e3, "us", most=0.03)
    )
    if "padasip" in ns:
        ratio = ns["padasip"] / ns["least_squares"]
        figures.append(_figure("recursive least squares over padasip's FilterRLS", ratio, "x", least=150.0))
    if "filterpy_bank" in ns:
        figures.append(
            _figure(
                "6-model bank over filterpy's MMAEFilterBank",
                ns["filterpy_bank"] / ns["bank"],
                "x",
                least=800.0,
            )
        )
    if "interconnected_mrac" in ns:
        figures.append(
            _figure(
                "MRAC loop of 21 states over python-control's interconnected simulation",
                ns["interconnected_mrac"] / ns["mrac_loop"],
                "x",
                least=700.0,
            )
        )
    if (os.cpu_count() or 1) > 1:
        share, most = scaling(CAMPAIGN_RUNS)
        figures.append(_figure("campaign of seven-step runs: two processes over twice one", share, "x", least=0.9))
        figures.append(_figure("campaign of seven-step runs, two processes", most, "/s"))
    return {
        "figures": figures,
        "ns": {name: round(value, 1) for name, value in ns.items()},
        "blocks_ns": block_costs(estimating) | block_costs(gain, "gain_adaptation") | block_costs(beside, *DIAGNOSERS),
        "missing": "; ".join(missing),
        "ok": all(figure["ok"] for figure in figures),
    }


def _figure(
    name: str, value: float, unit: str, *, least: float | None = None, most: float | None = None
) -> dict[str, Any]:
    ok = (least is None or value >= least) and (most is None or value <= most)
    target = f">= {least:g}" if least is not None else f"<= {most:g}" if most is not None else ""
    return {"name": name, "value": value, "unit": unit, "target": target, "ok": ok}
