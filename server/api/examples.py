"""Two examples of each request body, by the operation that takes it: the OpenAPI document shows them."""

from __future__ import annotations

from importlib.resources import files
from typing import Any

UNIT = (files("scenarios.starters") / "blank.py").read_text("utf-8")
SHEET = """+++
schema = 1
title = "Displacement"
summary = "How far a shuttle moves."
minutes = 5

[bench]
scenario = "first-look"
+++

## Look

The displacement is to stay large for a millisecond.

```step
id = "look"
kind = "hold"
points = 1.0
for_ms = 1.0
conditions = [
  { label = "Displacement", signal = "plant.displacement", measure = "amplitude", between = [0.1, 20.0], unit = "um" },
]
```
"""
HYPOTHESES = [{"name": "healthy"}, {"name": "m+5", "mass": 1.05}, {"name": "k-5", "stiffness": 0.95}]
LAYOUT = {"panels": ["scope", "faults"]}

EXAMPLES: dict[str, tuple[Any, Any]] = {
    "evaluate": (
        {"device": {"id": "ch3"}},
        {"device": {"id": "lcr-350", "geometry": {"fingers": 60}}, "environment": {"pressure_pa": 100.0}},
    ),
    "bode": ({"device": {"id": "ch3"}}, {"device": {"id": "ch4"}, "start_hz": 100.0, "stop_hz": 1e5, "points": 200}),
    "spread": (
        {"device": {"id": "lcr-350"}},
        {"device": {"id": "lcr-350", "geometry": {"fingers": 60}}, "seed": 3, "draws": 1000},
    ),
    "get_aliases": (
        {},
        {"hypotheses": HYPOTHESES, "tones": [{"frequency_hz": 2000.0, "amplitude_v": 10.0}], "within_um": 0.01},
    ),
    "check_scenario": (
        {"scenario": 'id = "mine"\nsample_rate_khz = 100\nsamples = 1000\ndevice.id = "ch3"\n'},
        {"scenario": {"id": "mine", "title": "Mine", "sample_rate_khz": 50, "samples": 500, "device": {"id": "ch4"}}},
    ),
    "check_unit": ({"name": "gain", "source": UNIT}, {"name": "steep_gain", "source": UNIT.replace("-2.0", "-8.0")}),
    "keep_unit": ({"source": UNIT}, {"source": UNIT.replace("-2.0", "-8.0")}),
    "create_bench": (
        {"scenario": "first-look"},
        {"scenario": "ch5-seven-step", "set": {"sensor.noise_um": 0.06}, "seed": 7, "paused": True},
    ),
    "open_on_instrument": ({}, {"scenario": "ch5-seven-step", "set": {"device.mass_kg": 2.1e-9}, "noise_um": 0.03}),
    "name_bench": ({"name": "heavier plate"}, {"name": ""}),
    "command": ({"fault": "added_mass", "severity": 0.05}, {"kind": "step", "ticks": 100}),
    "fork_bench": ({}, {"tick": 2000, "before": True, "paused": True, "name": "before the fault"}),
    "vary_bench": (
        {"set": {"sensor.noise_um": 0.1}},
        {"set": {"diagnosers.kalman.hypotheses": HYPOTHESES}, "repeat": True},
    ),
    "identification": ({}, {"amplitude_v": 5.0, "points": 40, "start_hz": 1000.0, "stop_hz": 10_000.0}),
    "take_snapshot": ({"name": "healthy"}, {"name": "after the fault"}),
    "save_parameter_set": ({"name": "quiet sensor"}, {"name": "MRAC at 30.5"}),
    "rename_parameter_set": ({"name": "quiet sensor"}, {"name": "MRAC at 30.5"}),
    "start_recording": (
        {"name": "first fault"},
        {"name": "from the switch on", "ticks": 20_000, "when": "kalman.winner > 0", "past_ticks": 500},
    ),
    "replay_recording": ({}, {"speed": 0.5, "paused": True}),
    "compare_recordings": (
        {"other": "7d1c0c3a9f0e"},
        {"other": "7d1c0c3a9f0e", "absolute": 1e-6, "tolerances": {"plant.displacement": 1e-3}, "align": "start"},
    ),
    "calibrate_record": ({"first": 0, "end": 2000}, {"scenario": "ch5-seven-step", "first": 500, "end": 4500}),
    "diagnose_record": ({"end": 2000}, {"scenario": "ch5-seven-step", "first": 500, "end": 4500}),
    "save_measured_device": (
        {"name": "wafer 7", "record": "7d1c0c3a9f0e", "end": 2000},
        {"name": "wafer 8", "record": "7d1c0c3a9f0e", "scenario": "ch5-seven-step", "first": 500, "end": 4500},
    ),
    "start_run": (
        {"scenario": "ch5-seven-step", "seed": 7},
        {"scenario": "ch3-mrac-spring-x2", "set": {"controller.adaptation_gain": 30.5}, "seeds": "1:20"},
    ),
    "remove_runs": ({}, {"ids": ["7d1c0c3a9f0e"]}),
    "rename_run": ({"label": "twice the noise"}, {"label": ""}),
    "start_sweep": (
        {"sweep": {"id": "gains", "scenario": "ch3-mrac-spring-x2", "grid": {"controller.adaptation_gain": [10, 30]}}},
        {"sweep": 'id = "noise"\nscenario = "first-look"\nseeds = "1:8"\n[grid]\n"sensor.noise_um" = [0.02, 0.1]\n'},
    ),
    "remove_sweeps": ({}, {"ids": ["7d1c0c3a9f0e"]}),
    "rename_sweep": ({"label": "gains of MRAC"}, {"label": ""}),
    "find_threshold": (
        {
            "scenario": "ch3-mrac-spring-x2",
            "metric": "control.tail_rms_error_um",
            "path": "controller.adaptation_gain",
            "low": 1.0,
            "high": 100.0,
            "scale": "log",
        },
        {
            "bench": "7d1c0c3a9f0e",
            "metric": "diagnosis.kalman.correct_fraction",
            "path": "sensor.noise_um",
            "low": 0.01,
            "high": 0.5,
            "points": 9,
        },
    ),
    "run_gallery": ({}, {"only": "ch3-*"}),
    "judge_positive_real": (
        {"numerator": [1.0, 2.0], "denominator": [1.0, 3.0, 2.0]},
        {"numerator": [1.0], "denominator": [1.0, 0.5, 1.0]},
    ),
    "judge_positive_definite": ({"matrix": [[2.0, 1.0], [1.0, 2.0]]}, {"matrix": [[1.0, 2.0], [2.0, 1.0]]}),
    "draw_qr_code": ({"text": "https://lab.example/join?code=k7m4x9p2tq5h"}, {"text": "http://192.168.1.5:8000/join"}),
    "judge_persistency": (
        {"tones": [{"amplitude": 1.0, "frequency": 1.0}]},
        {"tones": [{"amplitude": 1.0, "frequency": 0.5}, {"amplitude": 1.0, "frequency": 2.0}], "filter_pole": 2.0},
    ),
    "map_aliases": (
        {"hypotheses": HYPOTHESES, "tones": [{"amplitude": 10.0, "frequency": 2000.0}]},
        {"device": {"id": "ch4"}, "hypotheses": HYPOTHESES, "tones": [{"amplitude": 5.0, "frequency": 900.0}]},
    ),
    "map_instability": ({"rule": "mit"}, {"rule": "dressler", "highest_gain": 20.0, "frequencies": 20, "gains": 20}),
    "make_link": ({"bench": "7d1c0c3a9f0e", "title": "After the fault"}, {"scenario": "first-look", "note": "Begin"}),
    "change_link": ({"title": "After the fault"}, {"note": "Look at the residuals"}),
    "put_cue": ({}, {"bench": "7d1c0c3a9f0e"}),
    "raise_hand": ({"raised": True}, {"raised": False}),
    "open_class": (
        {"name": "Monday"},
        {"name": "Tuesday", "bench": {"scenario": "ch5-seven-step", "paused": True}, "hours": 2.0, "minutes": 15.0},
    ),
    "make_code": ({}, {"minutes": 15.0}),
    "join_class": ({"code": "K7M4 X9P 2TQ", "name": "Ada"}, {"code": "k7m4x9p2tq", "name": "Grace"}),
    "command_all": (
        {"command": {"kind": "pause"}},
        {"command": {"fault": "added_mass", "severity": 0.05}, "members": ["7d1c0c3a9f0e"]},
    ),
    "begin_scenario": ({"scenario": "first-look"}, {"scenario": "ch5-seven-step", "seed": 7, "paused": True}),
    "show_bench": ({"bench": "7d1c0c3a9f0e"}, {"bench": "2f9b6e51c0aa"}),
    "give_layout": ({"name": "Faults", "layout": LAYOUT}, {"name": "Default", "layout": None}),
    "start_all": ({}, {"members": ["7d1c0c3a9f0e"]}),
    "change_driver": ({"do": "ask"}, {"do": "hand_over", "to": "7d1c0c3a9f0e"}),
    "hide_fault": ({"seed": 7}, {"seed": 7, "shows": True}),
    "answer": ({"said": "m+5", "confidence": 0.8}, {"said": "healthy", "confidence": 0.5}),
    "hide_for_class": ({"scenario": "first-look"}, {"scenario": "first-look", "shows": True}),
    "begin_game": ({"seed": 7}, {"seed": 7, "hand_in": {}}),
    "hand_in": ({"seed": 7, "hand_in": {}}, {"seed": 8, "hand_in": {"severity": 0.05}}),
    "reveal_game": ({"seed": 7}, {"seed": 8}),
    "open_vote": (
        {"text": "Which lane rises?", "answers": ["mass", "stiffness", "damping"]},
        {"text": "Is it healthy?", "answers": ["yes", "no"], "class_id": "7d1c0c3a9f0e", "right": "no"},
    ),
    "count_hands": ({"counts": [12, 3]}, {"counts": [0, 4, 9]}),
    "cast": ({"vote": "7d1c0c3a9f0e", "answer": 0}, {"vote": "7d1c0c3a9f0e", "answer": 1, "at_ms": 12.5}),
    "make_watcher": ({}, {"hours": 2.0}),
    "open_sheet": ({"text": SHEET}, {"text": SHEET.replace("0.1, 20.0", "0.5, 2.0")}),
    "answer_step": ({"answer": "1.24 um"}, {"answer": "m+5"}),
    "begin_for_all": ({"sheet": "first-look"}, {"sheet": "identification", "members": ["7d1c0c3a9f0e"]}),
}
