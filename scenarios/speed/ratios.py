"""The table of speed figures: ratios to a peer measured in the same run are held against a target, times are not."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, cast

import numpy as np

from core.device.response import held_response
from core.device.two_axis import TwoAxis
from core.errors import InputError
from scenarios.library import get
from scenarios.run import build
from scenarios.speed import boards, campaign, environments, gyroscope, naive, peers
from scenarios.speed.anchor.table import Anchor
from scenarios.speed.figure import Costs, figure, per_sample, ratio, scaled
from scenarios.speed.machine import machine
from scenarios.speed.side_by_side import DIAGNOSERS, SAMPLES, whole_seven_steps, wired_seven_steps
from scenarios.speed.timing import ALIVE, advance_cost, block_costs, cpu_ns, interleaved, loop_cost
from scenarios.speed.units import native_and_walled

SAMPLE_NS = 10_000.0
"""Device time of a sample at 100 kHz."""
CAMPAIGN_RUNS = 4000
NOISE_V = 0.01
BANK = "6-model Kalman bank (MMAE)"

Figures = list[dict[str, Any]]


class Speed:
    """The measurement: the boards, the peers, and the table of their costs."""

    def __init__(self) -> None:
        self.bench = boards.seven_step_bench(boards.NOISY)
        self.loop = boards.begun(boards.ADAPTIVE)
        self.one, self.pair = gyroscope.running(gyroscope.ONE), gyroscope.running(gyroscope.PAIR)
        self.missing: list[str] = []

    def candidates(self) -> dict[str, Callable[[], float]]:
        """Return everything to be measured in turn, by name; each gives ns."""
        bench, loop = self.bench, self.loop
        device = bench.spec.context().device
        two_axis = cast(TwoAxis, self.one.spec.nominal)
        plane, nonlinear = boards.begun(boards.PLANAR), boards.begun(boards.NONLINEAR)
        sine = 10.0 * np.sin(2.0 * np.pi * 2.0 * 0.01 * np.arange(boards.SECOND))
        tones = sine + 5.0 * np.sin(2.0 * np.pi * 4.5 * 0.01 * np.arange(boards.SECOND))
        record = peers.regressors_of(tones, held_response(device, tones, 0.01))
        found: dict[str, Callable[[], float]] = {
            "everything": boards.live_cost(boards.seven_step_bench(boards.EVERYTHING)),
            "first_look": boards.live_cost(build(get("first-look"))),
            "plant_3_controllers_bank": lambda: loop_cost(bench, [*naive.KEYS]),
            "naive": naive.naive_sample(bench, NOISE_V),
            "controllers": lambda: loop_cost(bench, self.controllers),
            "nonlinear": lambda: loop_cost(nonlinear, ["plant"]),
            "nonlinear_solved": peers.solved_sample(nonlinear),
            "bank": lambda: loop_cost(bench, ["kalman"]),
            "seven_steps": wired_seven_steps(),
            "seven_steps_whole": whole_seven_steps(),
            "mrac_loop": lambda: loop_cost(loop, ["plant", "effects", "sensor", "reference", "model", "mrac", "drive"]),
            "planar": lambda: loop_cost(plane, [*ALIVE], 2_000),
            "gyroscope": lambda: advance_cost(self.one),
            "gyroscope_pair": lambda: advance_cost(self.pair),
            "gyroscope_blocks": lambda: loop_cost(self.one, ["plant", *self.readers]),
            "gyroscope_plant": lambda: loop_cost(self.one, ["plant"]),
            "gyroscope_solved": gyroscope.solved_sample(two_axis, self.one.dt_ms),
            "gyroscope_stepped": gyroscope.stepped_sample(two_axis, self.one.dt_ms),
            "plant_record": lambda: cpu_ns(lambda: held_response(device, sine, 0.01), boards.SECOND),
            "lsim": peers.lsim_sample(device, sine),
            "least_squares": peers.estimate_sample(*record),
        }
        for package, name, prepare in (
            ("filterpy", "filterpy_bank", partial(peers.filterpy_step, bench)),
            ("padasip", "padasip", partial(peers.padasip_sample, *record)),
            ("control", "interconnected_mrac", partial(peers.interconnected_sample, loop)),
            ("control", "forced_response", partial(peers.forced_response_sample, device, sine)),
            ("gymnasium", "environment", environments.one_cost),
            ("gymnasium", "pendulum", environments.pendulum_cost),
            ("gymnasium", "environments", partial(environments.abreast_cost, 1)),
            ("gymnasium", "environments_frame", partial(environments.abreast_cost, environments.SKIP)),
        ):
            try:
                found[name] = prepare()
            except ImportError:
                self.missing.append(f"{name} is not measured: {package} is not installed (make setup-test installs it)")
        try:
            found["unit"], found["unit_walled"] = native_and_walled()
        except InputError as error:
            self.missing.append(f"the wall around units is not measured: {error.message}")
        return found

    @property
    def controllers(self) -> list[str]:
        """The controllers of the bench."""
        return [one.key for one in self.bench.wiring.instances if one.block.family == "control"]

    @property
    def readers(self) -> list[str]:
        """Controllers and readouts of the gyroscope."""
        return [one.key for one in self.one.wiring.instances if one.block.family in ("control", "readout")]

    def table(self, costs: Costs) -> Figures:
        """Return the rows of the candidates measured in turn."""
        return [*self._boards(costs), *self._parts(costs), *self._gyroscopes(costs)]

    def _boards(self, costs: Costs) -> Figures:
        everything = (
            "tick of a live bench with everything: nonlinear plant of 4 substeps, 12 controllers, Kalman bank, IMM, "
            "6 + 6 self-tuning, consistency; trace, history, log, digest"
        )
        return [
            figure(everything, scaled(costs, "everything", 1e-3), "us"),
            figure(
                "live benches first-look at 100 kHz real time, per core",
                per_sample(costs, "first_look", SAMPLE_NS),
                "x",
            ),
            figure(f"plant, 3 controllers, {BANK}, per sample", scaled(costs, "plant_3_controllers_bank", 1e-3), "us"),
            figure(
                "the same over a plain numpy loop",
                ratio(costs, "naive", "plant_3_controllers_bank"),
                "x",
                least=400.0,
            ),
            figure(
                "nonlinear plant of 4 substeps over scipy's solve_ivp, sample by sample",
                ratio(costs, "nonlinear_solved", "nonlinear"),
                "x",
                least=400.0,
            ),
            figure(
                f"seven steps, {SAMPLES} samples, {len(DIAGNOSERS)} diagnosers, headless, wired before",
                scaled(costs, "seven_steps", 1e-6),
                "ms",
            ),
            figure("the same from scenario to figures", scaled(costs, "seven_steps_whole", 1e-6), "ms"),
            figure("all 12 controllers, per sample", scaled(costs, "controllers", 1e-3), "us"),
            figure(
                "planar plant with noise at 0.25 us, times real time at 100 kHz",
                per_sample(costs, "planar", SAMPLE_NS),
                "x",
            ),
        ]

    def _parts(self, costs: Costs) -> Figures:
        rows = [
            figure(f"{BANK}, per step", scaled(costs, "bank", 1e-3), "us"),
            figure("recursive least squares, 4 parameters, per update", scaled(costs, "least_squares", 1e-3), "us"),
            figure(
                "linear plant, 1 s at 100 kHz, over signal.lsim",
                ratio(costs, "lsim", "plant_record"),
                "x",
                least=1000.0,
            ),
        ]
        for name, peer, own, least in (
            ("linear plant, 1 s at 100 kHz, over control.forced_response", "forced_response", "plant_record", 1000.0),
            (f"{BANK} over filterpy's MMAEFilterBank", "filterpy_bank", "bank", 800.0),
            ("recursive least squares over padasip's FilterRLS", "padasip", "least_squares", 150.0),
            ("MRAC loop of 21 states over python-control", "interconnected_mrac", "mrac_loop", 700.0),
        ):
            if peer in costs:
                rows.append(figure(name, ratio(costs, peer, own), "x", least=least))
        if "environments" in costs:
            rows += _environments(costs)
        if "unit_walled" in costs:
            rows += [
                figure("PID as a user unit, per sample", scaled(costs, "unit", 1.0), "ns"),
                figure("the same behind the wall", scaled(costs, "unit_walled", 1.0), "ns"),
                figure("behind the wall over machine code", ratio(costs, "unit_walled", "unit"), "x"),
            ]
        return rows

    def _gyroscopes(self, costs: Costs) -> Figures:
        return [
            figure(
                f"gyroscope, {len(self.readers) - 1} controllers and an Allan deviation, per sample",
                scaled(costs, "gyroscope_blocks", 1e-3),
                "us",
            ),
            figure("gyroscopes at 100 kHz real time, per core", per_sample(costs, "gyroscope", SAMPLE_NS), "x"),
            figure(
                "pair of gyroscopes with noise, times real time at 100 kHz",
                per_sample(costs, "gyroscope_pair", SAMPLE_NS),
                "x",
            ),
            figure(
                "gyroscope plant over scipy's solve_ivp, sample by sample",
                ratio(costs, "gyroscope_solved", "gyroscope_plant"),
                "x",
                least=500.0,
            ),
            figure(
                "gyroscope plant over a numpy loop with its transition matrix",
                ratio(costs, "gyroscope_stepped", "gyroscope_plant"),
                "x",
                least=2.0,
            ),
        ]


def _environments(costs: Costs) -> Figures:
    """Return the rows of the environments of Gymnasium."""
    name = f"step of {environments.COUNT} environments abreast, each"
    frame = f"the same, each of {environments.SKIP} samples"
    return [
        figure(name, scaled(costs, "environments", 1e-3), "us"),
        figure(f"{name}, over one environment", ratio(costs, "environment", "environments"), "x", least=20.0),
        figure(f"{name}, over Gymnasium's pendulum", ratio(costs, "pendulum", "environments"), "x"),
        figure(frame, scaled(costs, "environments_frame", 1e-3), "us"),
        figure(f"{frame}, over Gymnasium's pendulum", ratio(costs, "pendulum", "environments_frame"), "x"),
    ]


def campaigns() -> Figures:
    """Measure campaigns: by the command on two processes, two over one, and over a loop of single runs."""
    seeds, seeds_s = campaign.command_rates(campaign.SEEDS)
    spread, _ = campaign.command_rates(campaign.SPREAD)
    singles = campaign.single_runs()
    return [
        figure("seven steps over seeds by combbench sweep, 2 processes", seeds, "/s"),
        figure("the same over a Latin hypercube of devices", spread, "/s"),
        figure(f"{campaign.MANY} of the runs over seeds, from start to report", seeds_s, "s"),
        figure("two processes over twice one", campaign.shares(CAMPAIGN_RUNS), "x", least=0.9),
        figure("runs over seeds, over a Python loop of single runs", _over(seeds, singles), "x", least=5.0),
    ]


def _over(rates: list[float], others: list[float]) -> list[float]:
    return [a / b for a, b in zip(rates, others, strict=True)]


def speed(quick: bool = False) -> dict[str, Any]:
    """Measure everything, or the ratios to C alone, and return it with the goals, JSON-ready."""
    host, anchor = machine(), Anchor()
    found: dict[str, Any] = {"anchor": [row.document() for row in anchor.rows()], "figures": [], "blocks_ns": {}}
    missing = [anchor.missing] if anchor.missing else []
    if not quick:
        measured = Speed()
        costs = interleaved(measured.candidates())
        found["figures"] = measured.table(costs)
        missing += measured.missing
        if host["processors"] > 1:
            found["figures"] += campaigns()
        else:
            missing.append("campaigns are not measured: this machine has one processor")
        found["blocks_ns"] = _blocks_ns(measured)
    return {"machine": host | {"compiler": anchor.compiler}, **found, "missing": missing}


def _blocks_ns(measured: Speed) -> dict[str, float]:
    gain, beside = boards.begun(boards.GAIN), boards.with_all_diagnosers()
    return (
        block_costs(boards.with_all_identifiers())
        | block_costs(gain, "gain_adaptation")
        | block_costs(beside, *DIAGNOSERS)
        | block_costs(measured.one, *measured.readers, alive=gyroscope.ALIVE)
    )
