"""The meaning of a campaign file: points, seeds, keys, and one clear line for each error."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.board.document import with_values
from core.errors import InputError
from scenarios.campaign.check import check
from scenarios.campaign.sweep import LatinHypercube, Sweep
from scenarios.key import content_hash, run_key
from scenarios.library import get

SEVEN = {"schema": 1, "scenario": "ch5-seven-step", "set": {"samples": 500}}
NOISE = "sensor.noise_um"


def noise_of(document: dict[str, Any]) -> float:
    return float(with_values(document, {})["sensors"]["ideal"]["noise_um"])


def test_a_grid_is_every_combination_and_every_point_has_every_seed() -> None:
    sweep = Sweep({**SEVEN, "grid": {NOISE: [0.1, 0.2], "controller.kind": ["pid", "mrac", "open_loop"]}})
    assert len(sweep.points) == 6 and len(sweep) == 6
    found = {(noise_of(p.document), p.document["controller"]["kind"]) for p in sweep.points}
    assert found == {(noise, kind) for noise in (0.1, 0.2) for kind in ("pid", "mrac", "open_loop")}
    many = Sweep({**SEVEN, "grid": {NOISE: [0.1, 0.2]}, "seeds": "5:7"})
    assert Sweep({**SEVEN, "seeds": {"first": 5, "count": 3}}).seeds == many.seeds == range(5, 8)
    assert [(noise_of(point.document), seed) for _, point, seed in many.runs()] == [
        (noise, seed) for noise in (0.1, 0.2) for seed in (5, 6, 7)
    ]
    assert len({key for key, _, _ in many.runs()}) == len(many) == 6


def test_a_latin_hypercube_has_one_point_in_every_stratum_of_every_value() -> None:
    ranges = {"a": {"min": 2.0, "max": 4.0}, "b": {"min": 0.01, "max": 100.0, "scale": "log"}}
    values = LatinHypercube.model_validate({"points": 40, "seed": 3, "ranges": ranges}).values()
    linear = (values["a"] - 2.0) / 2.0
    decades = (np.log10(values["b"]) + 2.0) / 4.0
    for share in (linear, decades):
        assert sorted(np.floor(share * 40).astype(int)) == list(range(40))
    assert abs(np.corrcoef(linear, decades)[0, 1]) < 0.5  # the orders are drawn apart


def test_the_hypercube_and_the_process_are_drawn_alike_every_time() -> None:
    document = {
        "schema": 1,
        "scenario": {"schema": 1, "samples": 100, "device": {"id": "lcr-350"}},
        "latin_hypercube": {"points": 3, "ranges": {"sensor.noise_um": {"min": 0.0, "max": 1.0}}},
        "process_spread": {"devices": 4, "seed": 9},
    }
    one, two = Sweep(document), Sweep(document)
    assert [p.document for p in one.points] == [p.document for p in two.points]
    assert len(one.points) == 12
    widths = {p.document["device"]["geometry"]["beam_bias_um"] for p in one.points}
    assert len(widths) == 4 and all(abs(width - np.mean(list(widths))) < 0.4 for width in widths)


def test_variants_are_controllers_or_diagnosers_by_name() -> None:
    bank = get("ch5-seven-step").document["diagnosers"]["kalman"]
    variants = [
        {"name": "floor", "set": {"diagnosers": {"kalman": bank}}},
        {"name": "no floor", "set": {"diagnosers.kalman.probability_floor": 0.0}},
        {"name": "pid", "set": {"controller.kind": "pid"}},
    ]
    sweep = Sweep({**SEVEN, "variants": variants})
    assert [point.labels for point in sweep.points] == [{"variant": v["name"]} for v in variants]
    floors = [point.document["diagnosers"]["kalman"]["probability_floor"] for point in sweep.points]
    assert floors == [1e-3, 0.0, 1e-3]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"schema": 2}, ["schema"]),
        ({"scenario": "ch9"}, ["scenario", "ch9"]),
        ({"grid": {"sensor.noise": [1.0]}}, ["sensor", "noise"]),
        ({"grid": {NOISE: []}}, [NOISE, "at least one"]),
        ({"grid": {NOISE: [-1.0]}}, ["noise_um"]),
        ({"seeds": {"count": 0}}, ["seeds.count"]),
        ({"seeds": "7:5"}, ["seeds", "A:B"]),
        ({"seeds": [1, 3]}, ["seeds", "table"]),
        ({"seeds": {"count": 1_000_000}, "grid": {NOISE: [0.1, 0.2]}}, ["2 points", "1000000"]),
        ({"latin_hypercube": {"points": 3, "ranges": {}}}, ["ranges"]),
        ({"latin_hypercube": {"points": 3, "ranges": {NOISE: {"min": 1, "max": 0}}}}, ["min < max"]),
        ({"latin_hypercube": {"points": 3, "ranges": {NOISE: {"min": 0, "max": 1, "scale": "log"}}}}, ["min > 0"]),
        ({"process_spread": {"devices": 3}}, ["device.id", "no drawing"]),
        ({"gird": {}}, ["gird"]),
        ({"grid": {"seed": [1, 2]}}, ["grid.seed", "[seeds]"]),
        ({"set": {"seed": 3}}, ["set.seed", "[seeds]"]),
        ({"variants": [{"name": "a", "set": {"seed": 3}}]}, ["variants.0.set.seed", "[seeds]"]),
        ({"latin_hypercube": {"points": 3, "ranges": {"seed": {"min": 1, "max": 9}}}}, ["ranges.seed", "[seeds]"]),
        ({"variants": [{"name": "a", "set": {}}, {"name": "a", "set": {NOISE: 0.1}}]}, ["variants.1", "'a'"]),
        ({"grid": {NOISE: [0.1, 0.2, 0.1]}}, [f"grid.{NOISE}.2", "0.1"]),
        ({"grid": {NOISE: [1, 1.0]}}, [f"grid.{NOISE}.1", "1.0"]),
        ({"variants": [{"name": "a", "set": {NOISE: 0.3}}], "grid": {NOISE: [0.1]}}, [NOISE, "variants", "grid"]),
        ({"seeds": {"first": 2**53, "count": 2}}, ["seeds", str(2**53 + 1), str(2**53)]),
        ({"seeds": {"count": True}}, ["seeds.count", "number"]),
    ],
)
def test_what_is_wrong_is_said_in_one_line(change: dict[str, Any], words: list[str]) -> None:
    with pytest.raises(InputError) as caught:
        check(Sweep({**SEVEN, **change}))
    assert all(word in str(caught.value) for word in words), str(caught.value)


def test_the_last_seed_may_be_the_largest() -> None:
    assert Sweep({**SEVEN, "seeds": {"first": 2**53 - 1, "count": 2}}).seeds[-1] == 2**53


def test_the_key_is_that_of_scenario_and_seed_alone() -> None:
    document = get("ch5-seven-step").document
    same = dict(reversed([*document.items(), ("seed", 99)]))
    content = content_hash(document)
    assert content_hash(same) == content
    assert content_hash({**document, "samples": 8999}) != content
    assert run_key(content, 1) == run_key(content, 1) != run_key(content, 2)
    assert len({run_key(content, 1), run_key(content, 1, 2), run_key(content, 12)}) == 3
