"""The same bits behind the wall, in machine code and as plain Python, alone and abreast."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from core.board import program
from core.board.board import Board
from core.board.flops import budget
from core.compile import code
from core.compile.machine import WIDTH
from core.errors import InputError
from core.kernel import is_kernel
from core.own.kinds import NUMBER, signature
from core.own.offered import OFFERED, offered
from core.own.unit import unit
from core.wall import wall
from scenarios.campaign.batch import outcomes
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build, run
from scenarios.schema import Scenario
from scenarios.studies.joined_records import _play, _record
from tests.core.own.test_own_units import examples, source_of, with_unit
from tests.core.own.texts import FIT, PI, ROOT, odd


@pytest.fixture(autouse=True)
def _wall() -> Iterator[None]:
    """Take the wall down at the end; no unit is compiled to machine code while the wall is up."""
    yield
    wall.demand(False)


def behind(made: Callable[[], Any]) -> Any:
    """Return the result of a call behind the wall."""
    known = {*code._addresses}
    wall.demand()
    try:
        return made()
    finally:
        wall.demand(False)
        assert not [one for one, _ in {*code._addresses} - known if one.text], "a unit ran as machine code"


def of_the_gallery(name: str) -> str:
    return (ROOT / "docs" / "units" / f"{name}.py").read_text("utf-8")


GALLERY = {
    "neural_net": ("ch3-case1-aged-mass", {"controller.kind": "neural_net"}),
    "page": ("ch5-seven-step", {"diagnosers.mine.kind": "page"}),
}
STIFF = {"samples": 2000, "events": [{"at_sample": 300, "fault": "added_mass", "severity": 0.05}]}
JUDGE = {"diagnosers.mine.kind": "leaky_squares"}
HELPER = odd(
    "step",
    "x.seen = twice(e) + exp(sin(e))\ns.line[int(x.tick - 2.0)] = e\nx.three[1] = s.line[int(e)]",
    top="@kernel\ndef twice(a):\n    return 2.0 * a",
)
CASES: list[tuple[str, Callable[[], str], str, dict[str, Any]]] = [
    *((name, partial(of_the_gallery, name), *GALLERY[name]) for name in GALLERY),
    ("pi", lambda: PI, "ch3-mrac-mass-x10", {"controller.kind": "pi"}),
    ("leaky_squares", lambda: examples()[1], "ch5-seven-step", JUDGE),
    ("fit", lambda: FIT, "first-look", {**STIFF, "identifiers.mine.kind": "fit"}),
    ("sine", lambda: source_of("reference", "sine"), "first-look", {}),
    ("added_mass", lambda: source_of("faults", "added_mass"), "first-look", STIFF),
    ("ideal", lambda: source_of("sense", "ideal"), "first-look", {"sensors.ideal.noise_um": 0.05}),
    ("odd", lambda: HELPER, "first-look", {"controller.kind": "odd"}),
]
TICKS = 1500


def digests(board: Board) -> tuple[str, bytes]:
    """Return the digest of a board, and the bits of all its signals and states at the end."""
    for _ in range(TICKS // 500):
        board.advance(500)
    return board.digest(), board.wiring.w.tobytes() + board.wiring.s.tobytes()


@pytest.mark.parametrize(("name", "text", "base", "values"), CASES, ids=[case[0] for case in CASES])
def test_a_unit_gives_the_same_bits_behind_the_wall(
    name: str, text: Callable[[], str], base: str, values: dict[str, Any]
) -> None:
    scenario = with_unit(name, text(), values, base)
    inside = behind(lambda: digests(build(scenario)))
    assert inside == digests(build(scenario))
    family = unit(name, text()).family
    ports = {block.block for block in build(scenario).wiring.instances}
    assert any(block.text == text() for block in ports), family


@pytest.mark.parametrize("name", ["pi", "fit", "leaky_squares"])
def test_a_unit_is_the_same_behind_the_wall_and_as_plain_python(name: str) -> None:
    text, base, values = next(case[1:] for case in CASES if case[0] == name)
    boards = [build(with_unit(name, text(), values, base), compiled=False)]
    wall.demand()
    boards.append(build(with_unit(name, text(), values, base)))
    for board in boards:
        board.advance(300)
    assert boards[0].digest() == boards[1].digest()
    assert boards[0].wiring.s.tobytes() == boards[1].wiring.s.tobytes()


@pytest.mark.parametrize(
    ("name", "length"), [("pi", {"duration_ms": 6.0, "plant.drive_noise_v": 1.0}), ("leaky_squares", {"samples": 600})]
)
def test_boards_abreast_behind_the_wall_are_each_the_board_alone(name: str, length: dict[str, Any]) -> None:
    text, base, values = next(case[1:] for case in CASES if case[0] == name)
    scenario = with_unit(name, text(), {**values, **length}, base)
    seeds = range(1, 10)
    alone = [run(scenario, seed).digest for seed in seeds]
    many = behind(lambda: [one.digest for one in outcomes([(scenario, seed) for seed in seeds])])
    assert many == alone and len({*alone}) == len(alone)
    blocks = {one.block for one in build(scenario).wiring.instances if one.block in wall._crossings}
    assert WIDTH in {width for block in blocks for _, width in wall._crossings[block]}, "none ran abreast"


def test_a_copy_of_the_library_behind_the_wall_gives_the_digest_of_the_library() -> None:
    theirs = run(with_values(get("first-look"), {"controller.kind": "pid", "samples": 1000, "expect": []})).digest
    ours = with_unit("pid", source_of("control", "pid"), {"controller.kind": "pid", "samples": 1000}, "first-look")
    assert behind(lambda: run(ours).digest) == theirs


def test_copies_of_a_board_go_on_alike_behind_the_wall() -> None:
    def both() -> tuple[str, str]:
        board = build(with_unit("pi", PI, {"controller.kind": "pi"}))
        board.advance(200)
        twin = Board.restore(board.checkpoint())
        for one in (board, twin):
            one.advance(300)
        return board.digest(), twin.digest()

    one, other = behind(both)
    assert one == other


def test_more_threads_than_instances_share_a_unit() -> None:
    """Each thread has a board of its own; the wall lends them instances in turn."""
    scenario = with_unit("pi", PI, {"controller.kind": "pi"})
    alone = digests(build(scenario))
    wall.demand()
    boards = [build(scenario) for _ in range(wall.INSTANCES + 2)]
    found: list[Any] = []
    threads = [threading.Thread(target=lambda board=board: found.append(digests(board))) for board in boards]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [alone] * len(boards)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_forked_process_goes_on_behind_the_wall(tmp_path: Path) -> None:
    scenario = with_unit("pi", PI, {"controller.kind": "pi"})
    wall.demand()
    board = build(scenario)
    board.advance(100)
    child = os.fork()
    if child == 0:
        board.advance(400)
        other = build(scenario)
        other.advance(500)
        (tmp_path / "digests").write_text(f"{board.digest()} {other.digest()}")
        os._exit(0)
    assert os.waitpid(child, 0)[1] == 0
    board.advance(400)
    assert (tmp_path / "digests").read_text().split() == [board.digest()] * 2


def test_twins_stay_behind_the_wall() -> None:
    values = {"controller.kind": "pi", "twins.other.controller.kind": "open_loop"}
    document = with_values(Scenario.load(with_unit("pi", PI).document), values)
    inside = behind(lambda: digests(build(document)))
    assert inside == digests(build(document))
    assert np.isfinite(np.frombuffer(inside[1])).any()


def test_nothing_else_runs_a_unit_while_the_wall_stands() -> None:
    text, base, values = next(case[1:] for case in CASES if case[0] == "leaky_squares")
    scenario = with_unit("leaky_squares", text() + "\n# nothing else\n", values, base)
    wall.demand()
    board = build(scenario)
    board.advance(100)
    with pytest.raises(InputError, match="behind a wall") as raised:
        budget(board, 50e6)
    assert raised.value.field == "units.leaky_squares"
    with pytest.raises(RuntimeError, match="behind the wall alone"):
        program.address(board.spec.diagnosers["mine"].block)


def test_a_study_of_a_unit_is_the_same_behind_the_wall() -> None:
    """This one runs the step of a diagnoser by itself, on a record."""
    text = examples()[1]

    def played() -> bytes:
        board = build(with_unit("leaky_squares", text, JUDGE, "ch5-seven-step"))
        record = _record(board, 200, faulty=True)
        return _play(board, "mine", board.spec.diagnosers["mine"].params.hypotheses[0].name, record).tobytes()

    assert behind(played) == played()


def test_every_function_of_numbers_that_a_step_may_call_is_there_behind_the_wall() -> None:
    calls, imports = [], []
    for module, names in OFFERED.items():
        for name in names:
            function = offered(module, name) if module != "__future__" else None
            try:
                taken, result = signature(function)
            except (TypeError, AttributeError):
                continue
            if is_kernel(function) and result == NUMBER and all(kind == NUMBER for kind in taken):
                imports.append(f"from {module} import {name} as {name}_")
                calls.append(f"total += {name}_({', '.join(f'e + {0.3 + 0.1 * i}' for i in range(len(taken)))})")
    assert len(calls) >= 10
    steps = [
        "total = math.sqrt(abs(e)) + math.copysign(e, 1.0) + floor(e) + max(e, 0.1) + min(e, 0.2)",
        *calls,
        "x.seen = total",
    ]
    text = odd("step", "\n".join(steps), top="\n".join(imports))
    scenario = with_unit("odd", text, {}, "first-look")
    one = behind(lambda: digests(build(scenario)))
    assert one == digests(build(scenario))
