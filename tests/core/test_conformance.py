"""What every block of every family must keep to; a new block is covered by being there."""

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
from core.board.wiring import wire
from core.device.catalogue import device
from core.errors import InputError
from tests.core.fence import run_behind_fences
from tests.core.own.texts import FIT
from tests.lab import AXES_RICH, AXES_STORY, RICH, STORY, do, document, inner_digest, make, play, run_digest

TICKS = 120
SECTION = {"reference": "reference", "plant": "plant", "sense": "sensor", "control": "controller"}
KIND = {"plant": "model"}
FORCED = {"slots": {"drive": "forced_drive"}, "controller": {"kind": "open_loop_rate"}}
RESONATOR = device({}).oscillator()
ALL = [entry for family in registry.FAMILIES for entry in registry.blocks(family).values()]


def name_of(entry: type[Block]) -> str:
    return f"{entry.family}/{entry.name}"


def rich(entry: type[Block]) -> dict[str, Any]:
    """Return the bench a block is tried on, with a plant of the sort it is for."""
    return AXES_RICH if entry.axes or entry.per_axis else RICH


def path_of(entry: type[Block]) -> str:
    """Return the table of the document in which a block's parameters stand."""
    if entry.family == "rate":
        return "rate"
    if entry.family == "readout":
        return "readouts.allan"
    if entry.family == "control" and entry.axes:
        return f"controllers.{entry.name}"
    if entry.family == "board" and entry.per_axis:
        return entry.name.removeprefix("axis_")
    if entry.family == "diagnose":
        return "diagnosers.kalman"
    if entry.family == "identify":
        return "identifiers.own"
    if entry.family == "board":
        return entry.name
    if entry.family == "sense":
        return f"sensors.{entry.name}"
    return SECTION[entry.family]


def chosen(entry: type[Block]) -> dict[str, Any]:
    """Return the values that put a block on the rich bench."""
    if entry.axes or entry.per_axis:
        return chosen_of_axes(entry)
    if entry.family == "sense" and all(port.name != "displacement" for port in entry.outputs):
        return {f"{path_of(entry)}.always": True}
    if entry.family in SECTION:
        table = {KIND.get(entry.family, "kind"): entry.name}
        if entry.family == "reference":
            table["amplitude_v"] = 8.0
        if entry.unsuited(RESONATOR, RESONATOR):
            plain = {"model": "transfer_function"}
            return {"device": {"id": "second-order-gain"}, "plant": plain, SECTION[entry.family]: table}
        return {SECTION[entry.family]: table}
    if entry.family == "identify":
        return {"identifiers.own.kind": entry.name}
    if entry.family == "diagnose":
        if "hypotheses" not in entry.Params.model_fields:
            return {"diagnosers": {"kalman": {"kind": entry.name}, "slow": {"kind": entry.name, "every": 2}}}
        return {"diagnosers.kalman.kind": entry.name, "diagnosers.slow.kind": entry.name}
    if entry.name == "estimate_score":  # it stands beside an identifier of one's own
        return {"units.fit.source": FIT, "identifiers.fit.kind": "fit"}
    return {}


def chosen_of_axes(entry: type[Block]) -> dict[str, Any]:
    """Return the values that put a block on the rich bench with axes."""
    if entry.family == "plant":
        return {"plant": {"model": entry.name}}
    if entry.name == "axis_drive":  # its forces may move between samples only with these
        return FORCED
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


def profiles(entry: type[Block]) -> list[dict[str, Any]]:
    return [
        {"kind": "step"},
        {"kind": "ramp", "duration_ms": 0.7},
        {"kind": "intermittent", "period_ms": 0.13, "duty": 0.4},
    ]


def cases() -> dict[str, dict[str, Any]]:
    found = {}
    for entry in ALL:
        for name, values in variants(entry).items():
            bench = document(values, rich(entry))
            # nothing but the reference drives between samples, and not every controller suits every bench
            is_analogue = bench.get("drive", {}).get("kind") == "analogue"
            able = () if is_analogue else parse(bench).controllers
            whole = AXES_STORY if rich(entry) is AXES_RICH else STORY
            story = [command for command in whole if "switch" not in command or command["switch"] in able]
            found[name] = {"document": bench, "commands": story, "faults": []}
        if entry.family == "faults":
            for profile in profiles(entry):
                severity = entry.suggested
                command = {"fault": entry.name, "severity": severity, "profile": profile}
                found[f"{name_of(entry)} {profile['kind']}"] = {
                    "document": document({}, rich(entry)),
                    "commands": [{**command, "at_sample": 37}],
                    "faults": [(entry.name, severity, profile)],
                }
    return found


CASES = cases()
OF_BLOCK = {name_of(entry): {} for entry in ALL}
for _name, _case in CASES.items():
    OF_BLOCK[_name.split()[0]][_name] = _case
every_block = pytest.mark.parametrize("entry", [pytest.param(entry, id=name_of(entry)) for entry in ALL])


def board_of(case: dict[str, Any], *, compiled: bool = True) -> Board:
    return make(base=case["document"], commands=case["commands"], compiled=compiled)


# -- the same bits, however it is run


@every_block
def test_compiled_steps_give_the_bits_of_plain_python(entry):
    for name, case in OF_BLOCK[name_of(entry)].items():
        fast, slow = board_of(case), board_of(case, compiled=False)
        assert run_digest(fast, TICKS) == run_digest(slow, TICKS), name
        assert inner_digest(fast) == inner_digest(slow), name
        assert fast.trip == slow.trip, name


@every_block
def test_deterministic_and_finite(entry):
    for name, case in OF_BLOCK[name_of(entry)].items():
        board = board_of(case)
        trace = play(board, 8 * TICKS)
        # a law with its safety switched off may run away, and fingers may touch, but then the board says so
        ends = ("not a finite", "touched", "shorted")
        assert board.trip is None or any(words in board.trip.reason for words in ends), name
        for signal, values in trace.items():
            assert board.trip is not None or np.all(np.isfinite(values)), f"{name}: {signal}"
        again = board_of(case)
        play(again, 8 * TICKS)
        assert again.digest() == board.digest() and inner_digest(again) == inner_digest(board), name


@every_block
def test_steps_touch_only_their_own_parameters_state_and_ports(entry):
    for case in OF_BLOCK[name_of(entry)].values():
        faults = {
            name: registry.block("faults", name).Params(severity=severity, profile=profile, start_tick=5)
            for name, severity, profile in case["faults"]
        }
        spec = parse(case["document"]).with_faults(faults)
        run_behind_fences(spec, wire(spec), entry, 42)


# -- snapshots


@settings(max_examples=12, phases=[Phase.generate])  # shrinking boards takes minutes
@given(
    name=st.sampled_from(sorted(CASES)),
    chunks=st.lists(st.integers(1, 90), min_size=1, max_size=12),
    again=st.lists(st.integers(1, 40), min_size=1, max_size=12),
)
def test_snapshot_is_exact_for_any_chunks(name, chunks, again):
    total = sum(chunks) + sum(again)
    straight = board_of(CASES[name])
    play(straight, total)

    board = board_of(CASES[name])
    for n in chunks:
        board.advance(n)
    kept = board.checkpoint()
    board.advance(17)  # what is done after the snapshot must not reach it
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


@pytest.mark.parametrize("entry", [pytest.param(entry, id=name_of(entry)) for entry in ALL])
def test_documented(entry):
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
    """The page explains a sample by the normal density unless the class says beside its likelihood what it has."""
    told = [entry for entry in ALL if hasattr(entry, "log_likelihood")]
    assert told
    for entry in told:
        owner = next(base for base in entry.__mro__ if "log_likelihood" in vars(base))
        assert "evidence" in vars(owner), name_of(entry)


def test_units_are_written_in_the_names_of_parameters_or_beside_them():
    suffixes = {"um": "_um", "V": "_v", "ms": "_ms", "Hz": "_hz", "K": "_k", "nN": "_nn", "deg": "_deg"}
    for entry in ALL:
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


@pytest.mark.parametrize(
    "entry", [pytest.param(entry, id=name_of(entry)) for entry in ALL if entry.family != "faults" and limits(entry)]
)
def test_a_parameter_at_its_limit_is_refused_or_runs(entry):
    for name, value in limits(entry):
        at_its_limit(entry, name, value)


def at_its_limit(entry: type[Block], name: str, value: float) -> None:
    label = f"{name_of(entry)}.{name}={value:g}"
    values = {**chosen(entry), f"{path_of(entry)}.{name}": value}
    try:
        board = make(values, base=rich(entry))
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
