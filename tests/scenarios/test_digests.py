"""No bit of any run changes unless it is meant to: `digests` says what to do when one is."""

from __future__ import annotations

import json

import pytest

from core.board.instances import faults_of
from core.compile.machine import levels
from scenarios.library import library
from tests.library_pass import BENCHES, result, results
from tests.scenarios import digests, ways


def test_every_run_gives_the_bits_it_gave() -> None:
    before, found = digests.kept(), results()
    assert set(found) == set(before["library"])
    changed = [name for name, digest in before["library"].items() if found[name]["digest"] != digest]
    changed += [
        f"bench {number}: {old['scenario']}"
        for number, (old, new) in enumerate(zip(before["benches"], result(BENCHES)["digests"], strict=True))
        if old["digest"] != new
    ]
    assert changed == []


@pytest.mark.long
@pytest.mark.timeout(600)
def test_runs_do_not_depend_on_the_libraries_of_the_machine() -> None:
    kept, now = digests.kept(), json.loads(digests.apart("--runs", machine=digests.OLDER))
    assert len(now["library"]) > 50
    assert {name for name, digest in now["library"].items() if kept["library"][name] != digest} == set()
    assert [one["digest"] for one in now["benches"]] == [one["digest"] for one in kept["benches"]]


has_levels = pytest.mark.skipif(
    not {"x86-64-v2", "x86-64-v3"} <= {level.processor for level in levels()}, reason="this processor cannot run them"
)


@pytest.mark.long
@has_levels
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("level", ["x86-64-v2", "x86-64-v3"])
def test_no_bit_of_the_library_depends_on_the_level_of_the_code(level: str) -> None:
    kept, chosen = digests.kept()["library"], [scenario for scenario in library() if scenario.study is None]
    found = ways.results([scenario.document for scenario in chosen], ways.ALONE, level)
    assert len(found) > 50
    assert [one.id for one, now in zip(chosen, found, strict=True) if kept[one.id] != now["digest"]] == []


@pytest.mark.long
@has_levels
@pytest.mark.timeout(3600)
@pytest.mark.parametrize(
    ("level", "way"),
    [(level, way) for level in ("x86-64-v2", "x86-64-v3", "native") for way in ("1", "8", "16")],
)
def test_no_bit_of_a_bench_depends_on_the_level_nor_on_boards_beside_it(level: str, way: str) -> None:
    kept = digests.kept()["benches"]
    found = ways.results([one["scenario"] for one in kept], way, level)
    unlike = [n for n, (old, new) in enumerate(zip(kept, found, strict=True)) if new and old["digest"] != new["digest"]]
    assert unlike == [] and sum(map(bool, found)) >= (len(kept) if way == "1" else 20)


def test_the_benches_are_worth_it() -> None:
    """Every controller, plant of a comb, fault and most diagnosers are on one of them; some have twins, some trip."""
    benches = [one["scenario"] for one in digests.kept()["benches"]]
    assert len(benches) == digests.BENCHES
    assert len({one["digest"] for one in digests.kept()["benches"]}) == digests.BENCHES
    assert {one["plant"]["model"] for one in benches} == {"linear", "nonlinear", "slaved_lateral", "planar"}
    faults = {event["fault"] for one in benches for event in one["events"] if "fault" in event}
    assert faults == set(faults_of(()))
    drives = {one["controller"]["kind"] for one in benches}
    drives |= {event["switch"] for one in benches for event in one["events"] if "switch" in event}
    assert drives >= {"pid", "mrac", "mrac_velocity", "indirect_mrac", "stvsc", "vsc", "vsmrc", "self_sliding"}
    assert len({kind for one in benches for kind in one.get("diagnosers", {})}) >= 12
    assert any("twins" in one for one in benches)
    assert {one["plant"].get("drive", "held") for one in benches} == {"held", "analogue"}
