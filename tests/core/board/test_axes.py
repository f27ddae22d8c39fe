"""A plant with axes, written here: the board wires its drives, measurements, guards and slots without an edit."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, ClassVar

import numpy as np
import pytest

from core import registry
from core.block import Block, BlockParams, Context, parameter
from core.board.board import Board
from core.board.commands import parse_command
from core.board.document import with_values
from core.board.ensemble import make
from core.errors import InputError
from core.ports import BlockPorts, output, reads
from core.record import Record

SPRING, MASS, DAMPING = 2.0, 0.01, 0.05


class Chain(Block):
    """Three masses, each on a spring of its own to the ground."""

    title = "Three masses"
    axes = ("a", "b", "c")
    slots: ClassVar[dict[str, str]] = {"inner": "push_ab", "outer": "push_bc"}
    usual_sensor = "pick_off"

    class Params(BlockParams):
        """Nothing to choose."""

    class Packed(Record):
        """Sample interval."""

        dt_ms: float

    class Ports(BlockPorts):
        """Forces in, motion out."""

        force_a: float = reads("drive.a.force", "uN", "force")
        force_b: float = reads("drive.b.force", "uN", "force")
        force_c: float = reads("drive.c.force", "uN", "force")
        stiffness_scale: float = reads("effects.stiffness_scale", "1", "stiffness over nominal")
        a: float = output("um", "displacement")
        b: float = output("um", "displacement")
        c: float = output("um", "displacement")
        a_velocity: float = output("um/ms", "velocity")
        b_velocity: float = output("um/ms", "velocity")
        c_velocity: float = output("um/ms", "velocity")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the sample interval."""
        p = cls.Packed.blank()
        p.dt_ms = context.dt_ms
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Take a semi-implicit Euler step."""
        k = SPRING * x.stiffness_scale
        x.a_velocity += p.dt_ms / MASS * (x.force_a - k * x.a - DAMPING * x.a_velocity)
        x.b_velocity += p.dt_ms / MASS * (x.force_b - k * x.b - DAMPING * x.b_velocity)
        x.c_velocity += p.dt_ms / MASS * (x.force_c - k * x.c - DAMPING * x.c_velocity)
        x.a += p.dt_ms * x.a_velocity
        x.b += p.dt_ms * x.b_velocity
        x.c += p.dt_ms * x.c_velocity


class Push(BlockParams):
    """A constant force."""

    force_un: float = parameter(1.0, "force", "uN")


class PushAB(Block):
    """Pushes the first two masses."""

    title = "Push a and b"
    axes = ("a", "b")
    slot = "inner"
    Params = Push

    class Packed(Record):
        """The force."""

        force_un: float

    class Ports(BlockPorts):
        """Forces."""

        engaged: float = reads("@engaged", "1", "1 while it drives")
        a: float = output("uN", "force on a")
        b: float = output("uN", "force on b")

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Push both."""
        x.a = p.force_un
        x.b = p.force_un


class PushBC(Block):
    """Pushes the last two masses, against the measurement."""

    title = "Push b and c"
    axes = ("b", "c")
    slot = "outer"
    Params = Push

    class Packed(Record):
        """The force."""

        force_un: float

    class Ports(BlockPorts):
        """Forces."""

        measured: float = reads("sensor.b.displacement", "um", "measured displacement")
        b: float = output("uN", "force on b")
        c: float = output("uN", "force on c")

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Push both, b less the further it has gone."""
        x.b = -p.force_un - 2.0 * x.measured
        x.c = 3.0 * p.force_un


class PushC(PushBC):
    """Pushes the last mass alone."""

    title = "Push c"
    axes = ("c",)

    class Ports(BlockPorts):
        """Force."""

        c: float = output("uN", "force on c")

    @staticmethod
    def step(p: PushBC.Packed, s: Record, x: Ports) -> None:
        """Push."""
        x.c = p.force_un


@pytest.fixture(autouse=True)
def known(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Put them into the registry for one test."""
    for block, family, name in (
        (Chain, "plant", "chain"),
        (PushAB, "control", "push_ab"),
        (PushBC, "control", "push_bc"),
        (PushC, "control", "push_c"),
    ):
        monkeypatch.setattr(block, "name", name)
        monkeypatch.setattr(block, "family", family)
        monkeypatch.setitem(registry.blocks(family), name, block)
    yield


BENCH: dict[str, Any] = {"sample_rate_khz": 100, "plant": {"model": "chain"}}


def run(board: Board, ticks: int = 3000) -> Board:
    for _ in range(ticks // 500):
        board.advance(500)
    return board


def at(board: Board, *names: str) -> list[float]:
    return [board.value(name) for name in names]


def test_each_axis_is_driven_by_the_last_slot_that_has_a_command_for_it() -> None:
    board = run(Board(BENCH))
    # a: 1 uN from the first slot; b: -1 - 2 b from the last, in equilibrium k b = -1 - 2 b; c: 3 uN
    rest = [1.0 / SPRING, -1.0 / (SPRING + 2.0), 3.0 / SPRING]
    assert at(board, "plant.a", "plant.b", "plant.c") == pytest.approx(rest, rel=1e-3)
    assert at(board, "sensor.a.displacement", "sensor.c.displacement") == at(board, "plant.a", "plant.c")
    assert board.spec.active == "push_bc"


def test_a_switch_finds_the_slot_by_the_controller_and_gives_the_axis_back() -> None:
    board = run(Board(BENCH))
    entry = board.apply(parse_command({"switch": "push_c"}))
    assert (entry.old, entry.new) == ("push_bc", "push_c")
    run(board)
    # b is free of the last slot now, so the first drives it
    assert at(board, "plant.a", "plant.b", "plant.c") == pytest.approx([0.5, 0.5, 0.5], rel=1e-3)
    board.apply(parse_command({"set": {"controllers.push_ab.force_un": 4.0}}))
    run(board)
    assert at(board, "plant.a", "plant.b", "plant.c") == pytest.approx([2.0, 2.0, 0.5], rel=1e-3)


def test_the_same_bits_compiled_uncompiled_and_from_a_copy() -> None:
    noisy = {**BENCH, "sensor": {"kind": "pick_off", "noise_pm_rthz": 50.0, "velocity_noise_nm_s_rthz": 10.0}}
    boards = [Board(noisy), Board(noisy, compiled=False)]
    for board in boards:
        board.advance(300)
        board.apply(parse_command({"fault": "stiffness", "severity": 0.2}))
        board.advance(200)
    copy = Board.restore(boards[0].checkpoint())
    for board in (*boards, copy):
        board.advance(400)
    assert boards[0].digest() == boards[1].digest() == copy.digest()
    # the noise of two axes is not the same, and has the density it was given
    rows = Board(noisy).advance(500)
    signals = Board(noisy).signals
    errors = [
        rows.outputs[:, signals.index(f"sensor.{axis}.displacement")] - rows.outputs[:, signals.index(f"plant.{axis}")]
        for axis in "abc"
    ]
    expected = 50e-6 * np.sqrt(50_000.0)
    assert [float(np.std(error)) for error in errors] == pytest.approx([expected] * 3, rel=0.12)
    assert abs(float(np.corrcoef(errors[0], errors[1])[0, 1])) < 0.15


def test_the_guard_names_the_axis() -> None:
    board = run(Board({**BENCH, "guard": {"travel_um": 1.2}}))
    assert board.trip is not None
    assert (board.trip.signal, board.trip.reason) == ("plant.c", "the shuttle went beyond its travel")
    assert at(board, "drive.a.force", "drive.b.force", "drive.c.force") == [0.0, 0.0, 0.0]
    board.apply(parse_command({"reset_trip": True}))
    assert board.trip is None


def test_a_limit_of_the_drive_holds_for_each_axis() -> None:
    board = Board({**BENCH, "drive": {"limit_un": 2.0, "quantum_un": 0.5}})
    board.advance(10)
    assert at(board, "drive.a.force", "drive.c.force") == [1.0, 2.0]
    assert at(board, "drive.a.saturated", "drive.c.saturated") == [0.0, 1.0]


@pytest.mark.parametrize(
    ("change", "field", "words"),
    [
        ({"controller": {"kind": "pid"}}, "controller.kind", "is for one displacement; chain moves along a, b, c"),
        ({"slots": {"inner": "push_c"}}, "slots.inner", "push_c stands in slot outer"),
        ({"slots": {"middle": "push_ab"}}, "slots.middle", "unknown slot"),
        ({"slots": {"outer": "push_c"}}, "slots.outer", "outer is the last slot"),
        ({"sensor": {"kind": "ideal"}}, "sensor.kind", "is for one displacement"),
        ({"reference": {"kind": "sine", "amplitude_v": 1.0}}, "reference", "chain has no reference"),
        ({"diagnosers": {"bank": {"kind": "cusum"}}}, "diagnosers.bank.kind", "is for one displacement"),
        ({"drive": {"limit_v": 1.0}}, "drive.limit_v", "limit_v"),
        ({"drive": {"kind": "analogue"}}, "drive.kind", "what push_ab asks for is held over a sample"),
    ],
)
def test_what_does_not_fit_is_refused_by_name(change: dict[str, Any], field: str, words: str) -> None:
    with pytest.raises(InputError) as caught:
        Board({**BENCH, **change})
    assert caught.value.field == field
    assert words in f"{caught.value} {caught.value.hint}"


def test_one_displacement_has_nothing_of_it() -> None:
    with pytest.raises(InputError, match="needs a, b; linear has one displacement"):
        Board({"controller": {"kind": "push_ab"}})
    with pytest.raises(InputError, match="unknown slot"):
        Board({"slots": {"inner": "push_ab"}})
    board = Board({})
    assert not {"push_ab", "push_bc", "push_c", "pick_off"} & {*board.spec.controllers, *board.spec.sensors}
    with pytest.raises(InputError, match="is for one displacement"):
        Board(BENCH).apply(parse_command({"fault": "debris", "severity": 0.1}))


def test_a_twin_keeps_the_controller_of_a_slot_that_was_chosen_for_it() -> None:
    board = make({**BENCH, "twins": {"other": {"controller": {"kind": "push_c"}}}})
    names = set(board.signals.names)
    assert {"other:plant.b", "other:drive.c.force", "other:sensor.a.displacement", "other:push_c.c"} <= names
    board.apply(parse_command({"switch": "push_c", "at_sample": 10}))
    board.apply(parse_command({"switch": "push_bc", "at_sample": 20}))
    rows = board.advance(100)
    forces = {
        name: rows.outputs[:, board.signals.index(f"{name}drive.c.force")].tolist()[9:22:10] for name in ("", "other:")
    }
    assert forces == {"": [3.0, 1.0], "other:": [1.0, 1.0]}


def test_a_generator_without_a_kind_is_the_usual_one() -> None:
    board = Board(with_values({"device": {"id": "gyro-c"}}, {"rate.deg_per_s": 40.0}))
    board.advance(1)
    assert board.spec.document["rate"] == {"kind": "constant", "deg_per_s": 40.0}
    assert board.value("rate.rate") == 40.0
