"""Speed figures, each as a ratio to a peer measured in the same run."""

from __future__ import annotations

import os
from functools import partial
from typing import Any, cast

import numpy as np

from core import registry
from core.board.board import CHUNK, Board
from core.device.response import held_response
from core.device.two_axis import TwoAxis
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build
from scenarios.speed import gyroscope
from scenarios.speed.campaign import scaling
from scenarios.speed.peers import (
    estimate_sample,
    filterpy_step,
    interconnected_sample,
    lsim_sample,
    padasip_sample,
    regressors_of,
)
from scenarios.speed.side_by_side import DIAGNOSERS, SAMPLES, seven_steps, side_by_side
from scenarios.speed.timing import ALIVE, advance_cost, block_costs, cpu_ns, interleaved, loop_cost

CAMPAIGN_RUNS = 400
SECOND = 100_000
"""Samples of 1 s at 100 kHz."""
SAMPLE_NS = 10_000.0
"""Device time of a sample at 100 kHz."""


def _board(values: dict[str, Any] | None = None) -> Board:
    scenario = with_values(get("ch5-seven-step"), {"events": [], **(values or {})})
    board = build(scenario)
    board.advance(CHUNK)
    return board


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
    turning, pair = gyroscope.running(gyroscope.ONE), gyroscope.running(gyroscope.PAIR)
    two_axis = cast(TwoAxis, turning.spec.nominal)
    readers = [i.key for i in turning.wiring.instances if i.block.family in ("control", "readout")]
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
        "seven_steps": seven_steps(),
        "mrac_loop": lambda: loop_cost(loop, ["plant", "effects", "sensor", "reference", "model", "mrac", "drive"]),
        "planar": lambda: loop_cost(plane, [*ALIVE], 2_000),
        "gyroscope": lambda: advance_cost(turning),
        "gyroscope_pair": lambda: advance_cost(pair),
        "gyroscope_blocks": lambda: loop_cost(turning, ["plant", *readers]),
        "gyroscope_plant": lambda: loop_cost(turning, ["plant"]),
        "gyroscope_solved": gyroscope.solved_sample(two_axis, turning.dt_ms),
        "gyroscope_stepped": gyroscope.stepped_sample(two_axis, turning.dt_ms),
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
    figures += [
        _figure(
            f"gyroscope, {len(readers) - 1} controllers and an Allan deviation, per sample",
            ns["gyroscope_blocks"] / 1e3,
            "us",
            most=1.5,
        ),
        _figure("real-time gyroscopes at 100 kHz per core", SAMPLE_NS / ns["gyroscope"], "x", least=10.0),
        _figure(
            "pair of gyroscopes with noise, of real time at 100 kHz", SAMPLE_NS / ns["gyroscope_pair"], "x", least=1.0
        ),
        _figure(
            "gyroscope plant over scipy's solve_ivp, sample by sample",
            ns["gyroscope_solved"] / ns["gyroscope_plant"],
            "x",
            least=500.0,
        ),
        _figure(
            "gyroscope plant over a numpy loop with its transition matrix",
            ns["gyroscope_stepped"] / ns["gyroscope_plant"],
            "x",
            least=2.0,
        ),
    ]
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
        "blocks_ns": block_costs(estimating)
        | block_costs(gain, "gain_adaptation")
        | block_costs(beside, *DIAGNOSERS)
        | block_costs(turning, *readers, alive=gyroscope.ALIVE),
        "missing": "; ".join(missing),
        "ok": all(figure["ok"] for figure in figures),
    }


def _figure(
    name: str, value: float, unit: str, *, least: float | None = None, most: float | None = None
) -> dict[str, Any]:
    ok = (least is None or value >= least) and (most is None or value <= most)
    target = f">= {least:g}" if least is not None else f"<= {most:g}" if most is not None else ""
    return {"name": name, "value": value, "unit": unit, "target": target, "ok": ok}
