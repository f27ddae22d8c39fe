"""Rules for every block of every family; a new block is covered automatically."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from core import registry
from core.block import Block
from core.board.board import Board
from core.board.parse import parse
from core.device.catalogue import device
from core.errors import InputError
from tests.core.fence import FencedBoard
from tests.core.own.texts import FIT, ROOT
from tests.lab import AXES_RICH, AXES_STORY, RICH, STORY, do, document, inner_digest, make, play, run_digest

TICKS = 120
SECTION = {"reference": "reference", "plant": "plant", "sense": "sensor", "control": "controller"}
KIND = {"plant": "model"}
STAGES = {"sampler": {"antialias_khz": 30.0, "jitter_us": 0.3}, "amplifier": {"delay_samples": 1, "delay_fraction": 0.4,
          "amplifier_khz": 40.0}}  # fmt: skip
"""Values that put a stage of the board on a bench."""
FORCED = {"slots": {"drive": "forced_drive"}, "controller": {"kind": "open_loop_rate"}}
TUNED = {
    "device": {"id": "gyro-c", "electrodes": {"tuning": {}}},
    "plant": {"model": "tuned_gyroscope"},
    "slots": {"drive": "drive_loop"},
}
COMB = {"fingers": 200, "thickness_um": 60.0, "gap_um": 3.0}
COMBS = {
    "device": {"id": "gyro-a", "electrodes": {"drive": COMB, "sense": COMB}},
    "plant": {"model": "gyroscope"},
    "drive.quantum_un": 0.0,
}
"""Values that put electrodes on the bench with axes, which is then of one device."""
ENDS = ("not a finite", "touched", "shorted", "the supervisor")
PROFILES = (
    {"kind": "step"},
    {"kind": "ramp", "duration_ms": 0.7},
    {"kind": "intermittent", "period_ms": 0.13, "duty": 0.4},
)


def name_of(entry: type[Block]) -> str:
    return f"{entry.family}/{entry.name}"


def rich(entry: type[Block]) -> dict[str, Any]:
    """Return the bench a block is tried on, with a plant of the sort it is for."""
    return AXES_RICH if entry.axes or entry.per_axis else RICH


def path_of(entry: type[Block]) -> str:
    """Return the table of the document with a block's parameters."""
    if entry.family == "rate":
        return "rate"
    if entry.family == "readout":
        return "readouts.allan"
    if entry.family == "control" and entry.axes:
        return f"controllers.{entry.name}"
    if entry.family == "board" and entry.name.removeprefix("axis_") in STAGES:
        return "board"
    if entry.family == "board" and entry.per_axis:
        return entry.name.removeprefix("axis_")
    if entry.family == "diagnose" or entry.name == "weighted_filters":
        return "diagnosers.kalman"
    if entry.family == "identify":
        return "identifiers.own"
    if entry.family == "supervise":
        return "supervisor"
    if entry.family == "board":
        return entry.name
    if entry.family == "sense":
        return f"sensors.{entry.name}"
    return SECTION[entry.family]


def chosen(entry: type[Block]) -> dict[str, Any]:
    """Return the values that put a block on the rich bench."""
    if entry.family == "board" and (stage := STAGES.get(entry.name.removeprefix("axis_"))):
        return {"board": {**stage, **({"slew_v_per_us": 0.1} if entry.name == "amplifier" else {})}}
    if entry.axes or entry.per_axis:
        return chosen_of_axes(entry)
    if entry.family == "sense" and all(port.name != "displacement" for port in entry.outputs):
        return {f"{path_of(entry)}.always": True}
    if entry.family in SECTION:
        table = {KIND.get(entry.family, "kind"): entry.name}
        if entry.family == "reference":
            table["amplitude_v"] = 8.0
        if entry.unsuited(resonator := device({}).oscillator(), resonator):
            plain = {"model": "transfer_function"}
            return {"device": {"id": "second-order-gain"}, "plant": plain, SECTION[entry.family]: table}
        return {SECTION[entry.family]: table}
    if entry.family == "identify":
        return {"identifiers.own.kind": entry.name}
    if entry.family == "supervise":  # so soon that it acts within the run
        return {"supervisor": {"kind": entry.name, "hold_ms": 0.05, "dead_ms": 0.1}}
    if entry.family == "diagnose":
        if "hypotheses" not in entry.Params.model_fields:
            return {"diagnosers": {"kalman": {"kind": entry.name}, "slow": {"kind": entry.name, "every": 2}}}
        return {"diagnosers.kalman.kind": entry.name, "diagnosers.slow.kind": entry.name}
    if entry.name == "estimate_score":  # it belongs to a user's identifier
        return {"units.fit.source": FIT, "identifiers.fit.kind": "fit"}
    if entry.name == "difference_states":
        return {"diagnosers.kalman.kind": "self_tuning", "diagnosers.slow.kind": "anchored"}
    if entry.name == "weighted_filters":
        return {"diagnosers": {"kalman": {"kind": "moving_bank"}, "slow": {"kind": "moving_bank", "every": 2}}}
    if entry.name == "weighted_parameters":  # it belongs to a diagnoser whose models have no states
        source = (ROOT / "docs/units/page.py").read_text("utf-8")
        return {"units.page.source": source, "diagnosers.page.kind": "page"}
    return {}


def chosen_of_axes(entry: type[Block]) -> dict[str, Any]:
    """Return the values that put a block on the rich bench with axes."""
    if entry.name == "tuned_gyroscope":
        return TUNED
    if entry.family == "plant":
        return {"plant": {"model": entry.name}}
    if entry.name == "axis_drive":  # its forces may move between samples only with these
        return {**FORCED, **COMBS}
    if entry.slot == "tuning":
        return {**TUNED, "slots": {"drive": "drive_loop", "tuning": entry.name}}
    if entry.family == "control":
        return {"controller.kind": entry.name} if entry.slot == "sense" else {f"slots.{entry.slot}": entry.name}
    if entry.family in ("rate", "readout", "diagnose"):
        return {f"{path_of(entry)}.kind": entry.name}
    return {}


def variants(entry: type[Block]) -> dict[str, dict[str, Any]]:
    """Return benches with the block as it comes, with each of its choices, with each of its switches turned."""
    found = {name_of(entry): chosen(entry)}
    for parameter in registry.card(entry).parameters:
        path = f"{path_of(entry)}.{parameter.name}" if entry.family != "faults" else ""
        for choice in parameter.choices if path else []:
            found[f"{name_of(entry)} {parameter.name}={choice}"] = {**chosen(entry), path: choice}
        if parameter.type == "boolean" and path:
            found[f"{name_of(entry)} {parameter.name}={not parameter.default}"] = {
                **chosen(entry),
                path: not parameter.default,
            }
    if entry.family == "plant" and not entry.axes:
        found[f"{name_of(entry)} analogue"] = {**chosen(entry), "drive": {"kind": "analogue"}}
    if entry.family == "plant" and entry.axes:
        found[f"{name_of(entry)} analogue"] = {**chosen(entry), **FORCED, "drive": {"kind": "analogue"}}
    return found


def cases(name: str) -> dict[str, dict[str, Any]]:
    """Return the benches of a block, by name."""
    entry, found = block_of(name), {}
    for label, values in variants(entry).items():
        bench = document(values, rich(entry))
        # nothing but the reference drives between samples, and not every controller suits every bench
        is_analogue = bench.get("drive", {}).get("kind") == "analogue"
        able = () if is_analogue else parse(bench).controllers
        whole = AXES_STORY if rich(entry) is AXES_RICH else STORY
        story = [command for command in whole if "switch" not in command or command["switch"] in able]
        found[label] = {"bench": bench, "commands": story}
    for profile in PROFILES if entry.family == "faults" else ():
        command = {"fault": entry.name, "severity": entry.suggested, "profile": profile, "at_sample": 36}
        found[f"{name} {profile['kind']}"] = {"bench": document({}, rich(entry)), "commands": [command]}
    return found


def block_of(name: str) -> type[Block]:
    family, _, own = name.partition("/")
    return registry.blocks(family)[own]


NAMES = [f"{family}/{name}" for family in registry.FAMILIES for name in registry.blocks(family)]
every_block = pytest.mark.parametrize("name", NAMES)


def played(board: Board, case: dict[str, Any]) -> Board:
    """Return a board with the commands of a case waiting."""
    for command in case["commands"]:
        do(board, command)
    return board


# -- the same bits, however it is run


@every_block
def test_a_step_touches_only_its_own_numbers_and_gives_the_bits_of_its_compiled_form(name):
    ran = False
    for label, case in cases(name).items():
        spec = parse(case["bench"])
        fast, fenced = played(Board(spec), case), played(FencedBoard(spec, block_of(name)), case)
        ticks = TICKS if label == name or case["commands"][0].get("fault") == block_of(name).name else TICKS // 2
        assert run_digest(fast, ticks) == run_digest(fenced, ticks), label
        assert inner_digest(fast) == inner_digest(fenced), label
        assert fast.trip == fenced.trip, label
        assert not any(fenced.unwritten.values()), f"{label}: {fenced.unwritten}"
        ran = ran or bool(fenced.unwritten)
        trace = play(fast, 8 * TICKS - ticks)
        # a law with its safety switched off may run away, and fingers may touch, but then the board says so
        assert fast.trip is None or any(words in fast.trip.reason for words in ENDS), label
        assert fast.trip is not None or not [one for one, values in trace.items() if not np.isfinite(values).all()], (
            label
        )
        if label == name:
            again = played(Board(spec), case)
            assert run_digest(again, 8 * TICKS) == fast.digest() and inner_digest(again) == inner_digest(fast)
    assert ran, "it is on no bench"


@pytest.mark.parametrize(("base", "story"), [(RICH, STORY), (AXES_RICH, AXES_STORY)], ids=["x", "x and y"])
def test_a_whole_bench_in_plain_python_gives_the_bits_of_compiled_steps(base, story):
    fast, slow = make({}, story, base=base), make({}, story, base=base, compiled=False)
    assert run_digest(fast, TICKS) == run_digest(slow, TICKS)
    assert inner_digest(fast) == inner_digest(slow)
    assert fast.trip == slow.trip


# -- snapshots


@settings(max_examples=12, phases=[Phase.generate])  # shrinking boards takes minutes
@given(
    name=st.sampled_from(NAMES),
    which=st.integers(0, 99),
    chunks=st.lists(st.integers(1, 90), min_size=1, max_size=12),
    again=st.lists(st.integers(1, 40), min_size=1, max_size=12),
)
def test_snapshot_is_exact_for_any_chunks(name, which, chunks, again):
    total, found = sum(chunks) + sum(again), [*cases(name).values()]
    case = found[which % len(found)]
    straight, board = (played(Board(parse(case["bench"])), case) for _ in range(2))
    play(straight, total)
    for n in chunks:
        board.advance(n)
    kept = board.checkpoint()
    board.advance(17)  # changes after the snapshot must not reach it
    board.wiring.s += 1.0
    forks = [Board.restore(kept), Board.restore(kept)]
    for fork in forks:
        assert fork.tick == kept.tick
        for n in again:
            fork.advance(n)
        assert fork.digest() == straight.digest()
        assert inner_digest(fork) == inner_digest(straight)
        assert said(fork) == said(straight)


def said(board: Board) -> list[Any]:
    return sorted((entry.tick, entry.actor, entry.kind, entry.text, str(entry.command)) for entry in board.log)


def test_forks_do_not_disturb_each_other():
    board = make({}, STORY[:3], base=RICH)
    board.advance(100)
    kept = board.checkpoint()
    left, right = Board.restore(kept), Board.restore(kept)
    do(left, {"switch": "pid"})
    play(left, 200)
    play(right, 200)
    play(board, 200)
    assert right.digest() == board.digest() != left.digest()
    assert len(right.log) == len(board.log) < len(left.log)


# -- documentation


@every_block
def test_documented(name):
    entry = block_of(name)
    card = registry.card(entry)
    assert card.title and len(card.summary) > 15 and card.summary.rstrip().endswith((".", "`"))
    for kind, ports in (("input", card.inputs), ("output", card.outputs), ("tap", card.taps)):
        for port in ports:
            assert port.unit, f"{kind} {port.name} has no unit"
            assert port.meaning, f"{kind} {port.name} has no meaning"
    for parameter in card.parameters:
        assert parameter.meaning, f"{parameter.name} has no meaning"
        if parameter.minimum is not None and isinstance(parameter.default, int | float):
            assert parameter.default >= parameter.minimum
        if parameter.maximum is not None and isinstance(parameter.default, int | float):
            assert parameter.default <= parameter.maximum
    for equation in card.equations:
        assert equation.label and equation.latex
        assert bool(equation.printed) == bool(equation.why), "an erratum says what was printed and why it is wrong"
    assert entry.equations or not registry.card(entry).parameters or entry.family == "board"
    assert json.loads(card.model_dump_json())["name"] == entry.name


def test_a_likelihood_of_its_own_says_what_it_is():
    """The page explains a sample by the normal density unless the class describes its own likelihood."""
    told = [entry for entry in map(block_of, NAMES) if hasattr(entry, "log_likelihood")]
    assert told
    for entry in told:
        owner = next(base for base in entry.__mro__ if "log_likelihood" in vars(base))
        assert "evidence" in vars(owner), name_of(entry)


def test_units_are_written_in_the_names_of_parameters_or_beside_them():
    suffixes = {"um": "_um", "V": "_v", "ms": "_ms", "Hz": "_hz", "K": "_k", "nN": "_nn", "deg": "_deg"}
    for entry in map(block_of, NAMES):
        for parameter in registry.card(entry).parameters:
            suffix = suffixes.get(parameter.unit)
            # a severity is called that whatever it counts
            right = suffix is None or parameter.name.endswith(suffix) or parameter.name == "severity"
            assert right, f"{name_of(entry)}.{parameter.name}"


# -- limits


def limits(entry: type[Block]) -> list[tuple[str, float]]:
    bounds = [(parameter, bound) for parameter in registry.card(entry).parameters for bound in bounds_of(parameter)]
    return [(parameter.name, int(bound) if parameter.type == "integer" else bound) for parameter, bound in bounds]


def bounds_of(parameter: registry.ParameterCard) -> list[float]:
    return [bound for bound in (parameter.minimum, parameter.maximum) if bound is not None]


@pytest.mark.parametrize("name", [name for name in NAMES if not name.startswith("faults/")])
def test_a_parameter_at_its_limit_is_refused_or_runs(name):
    entry = block_of(name)
    for parameter, value in limits(entry):
        at_its_limit(entry, parameter, value)


def at_its_limit(entry: type[Block], name: str, value: float) -> None:
    label = f"{name_of(entry)}.{name}={value:g}"
    values = {**chosen(entry), f"{path_of(entry)}.{name}": value}
    bench = rich(entry) if entry.family in ("diagnose", "supervise") else {**rich(entry), "diagnosers": {}}
    try:
        board = make(values, base=bench)
    except InputError as error:
        path = f"{path_of(entry)}.{name}".replace("controller", "controllers.")
        assert error.field == path or name in error.field, label
        return
    trace = play(board, 300)
    # a shadow may go where it wants; the voltage that drives and the shuttle stay finite, or the board stops
    if board.trip is None:
        alone = ("plant.displacement", "plant.velocity", "drive.voltage", f"{board.spec.active}.voltage")
        axes = [name for name in trace if name.startswith(("plant.", "drive."))]
        for signal in axes if board.spec.axes else alone:
            assert np.all(np.isfinite(trace[signal])), f"{label}: {signal}"
    bank = np.array([trace[s] for s in trace if s.startswith("kalman.probability.")])
    if entry.family == "diagnose" and len(bank):
        assert len(bank) == len(getattr(board.spec.diagnosers["kalman"].params, "hypotheses", bank)), label
        np.testing.assert_allclose(bank.sum(axis=0), 1.0, atol=1e-9, err_msg=label)
