"""Benches drawn from a seed, with many events, and the inputs of an oracle from their runs."""

from __future__ import annotations

from typing import Any

import numpy as np

from scenarios.run import RunResult, run
from scenarios.schema import Scenario

DEVICES = ("ch3", "ch4", "lcr-350")
DIAGNOSERS = ("mmae", "imm", "arx_bank", "lock_in")
CONTROLLERS = ("open_loop", "pid", "mrac")
FAULTS = {"added_mass": 0.05, "stiffness": 0.1, "damping": 0.3, "sensor_bias": 0.05, "sensor_noise": 0.05}
SAMPLES = 3000


def random_bench(seed: int) -> Scenario:
    """Return a bench of two diagnosers with seven things done to it."""
    rng = np.random.default_rng(seed)

    def one(choices: Any) -> Any:
        return choices[int(rng.integers(len(choices)))]

    first, second = rng.choice(DIAGNOSERS, 2, replace=False).tolist()
    there: set[str] = set()
    drives, events = "open_loop", []
    for tick in sorted(rng.choice(np.arange(200, SAMPLES - 300), 7, replace=False).tolist()):
        choice = float(rng.random())
        if there and (choice < 0.3 or len(there) == len(FAULTS)):
            name = one(sorted(there))
            there.discard(name)
            events.append({"at_sample": tick, "heal": [name]})
        elif choice < 0.55:
            drives = one([name for name in CONTROLLERS if name != drives])
            events.append({"at_sample": tick, "switch": drives})
        else:
            name = one([name for name in FAULTS if name not in there])
            there.add(name)
            kind = one(("step", "step", "ramp", "intermittent"))
            events.append({"at_sample": tick, "fault": name, "severity": FAULTS[name], "profile": {"kind": kind}})
    return Scenario.load(
        {
            "schema": 1,
            "id": f"random-{seed}",
            "sample_rate_khz": 50,
            "samples": SAMPLES,
            "seed": seed,
            "device": {"id": one(DEVICES)},
            "plant": {"model": "linear", "drive_noise_v": 0.01},
            "reference": {"kind": "sine", "amplitude_v": float(rng.uniform(2, 10)), "frequency_hz": 2000.0},
            "controller": {"kind": "open_loop"},
            "guard": {"travel_um": float(rng.uniform(3, 40))},
            "sensor": {"kind": "ideal", "noise_um": float(rng.uniform(0.01, 0.1))},
            "diagnosers": {
                first: {"kind": first, "every": int(rng.integers(1, 4))},
                f"second_{second}": {"kind": second},
            },
            "events": events,
        }
    )


def told(seed: int) -> RunResult:
    """Run a bench of a seed with every signal, and let the narrator speak."""
    return run(random_bench(seed), taps=True, everything=True, narrate=True)
