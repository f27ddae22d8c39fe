"""Steps, random ones too: an admitted step stays in its slots, and computes the same as Python from its text."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
import pytest

from core.block import Block, Context, Oscillator
from core.board import program
from core.board.steps import _seen
from core.errors import InputError
from core.own.unit import Unit, unit
from core.wall import wall
from core.wall.crossing import Sizes
from tests.core.own.grammar import HELPERS, Writer
from tests.core.own.oracle import oracle
from tests.core.own.texts import odd

FEW = 5
"""Seeds of the short suite."""
GUARD = 64
CANARY = -7.25e77
GENERATED = ("_mix_", "_bump_", "_stir_", "_turn_")
ALLOWED = {"exp", "sin", "floor", "flush_tiny", "abs", "min", "max", "float", "int", "range"}


def admitted(seeds: Iterable[int]) -> Iterator[tuple[int, Unit | None]]:
    """Yield seeds and the units they make, None for a refused unit."""
    for seed in seeds:
        try:
            yield seed, unit("odd", Writer(seed).text())
        except InputError as error:
            assert "line " in error.field
            yield seed, None


class Slots:
    """The numbers of one step, between guards."""

    def __init__(self, block: type[Block]) -> None:
        device = Oscillator(1.0, 0.1, 4.0, -0.5)
        params = block.Params()
        context = Context(0.01, 1, 1, device, device)
        self.parts = [block.packed(params, context), block.initial(params, context), np.zeros(40)]
        self.places = np.arange(3, 3 + len(block.Ports.declared) * 4, 4)[: len(block.Ports.declared)]
        self.places = 2 + np.cumsum([0, *(3 if port.vector else 1 for port in block.Ports.declared[:-1])])
        whole = [np.concatenate([np.full(GUARD, CANARY), part, np.full(GUARD, CANARY)]) for part in self.parts]
        self.whole = whole
        self.p, self.s, self.w = (one[GUARD:-GUARD] for one in whole)
        self.io = self.places.astype(np.int64)
        self.block = block

    def stimulate(self, tick: int) -> None:
        """Set the inputs of the step."""
        self.w[0], self.w[1] = tick, 0.01 * tick
        inputs = len(self.block.inputs)
        self.w[self.io[:inputs]] = [np.sin(0.7 * tick + k) * 10.0**k for k in range(inputs)]

    def check_guards(self) -> None:
        for one in self.whole:
            assert (one[:GUARD] == CANARY).all() and (one[-GUARD:] == CANARY).all()


def walled(block: type[Block]) -> np.ndarray:
    """Return the table of the step behind the wall."""
    slots = Slots(block)
    ports = tuple(_seen(port, 3 if port.vector else 1) for port in block.Ports.declared)
    return _table(wall.address(block, Sizes(len(slots.p), len(slots.s), ports)))


def bits(numbers: np.ndarray) -> bytes:
    """Return the bits of numbers; of a NaN neither processors nor WebAssembly say which of its bits are set."""
    return np.where(np.isnan(numbers), np.nan, numbers).tobytes()


def run_all(block: type[Block]) -> None:
    one, other, inside = Slots(block), Slots(block), Slots(block)
    before, inputs = one.p.copy(), one.io[: len(block.inputs)]
    step = oracle(block)
    p, s, x = block.Packed(other.p), block.State(other.s), block.Ports(other.w, other.io)
    nothing = np.zeros((1, 0))
    table, wall_table = _table(program.address(block)), walled(block)
    trips = np.zeros(1)
    for tick in range(40):
        for slots in (one, other, inside):
            slots.stimulate(tick)
        seen = one.w[inputs].copy()
        _call(table, one, tick, nothing, trips)
        _call(wall_table, inside, tick, nothing, trips)
        with np.errstate(all="ignore"):
            step(p, s, x)
        np.testing.assert_array_equal(one.s, other.s)
        np.testing.assert_array_equal(one.w, other.w)
        assert (bits(one.s), bits(one.w)) == (bits(inside.s), bits(inside.w))
        np.testing.assert_array_equal(one.w[inputs], seen)
    for slots in (one, other, inside):
        slots.check_guards()
    np.testing.assert_array_equal(one.p, before)


def _table(address: int) -> np.ndarray:
    table = np.zeros((1, program.COLUMNS), np.int64)
    table[0, program.ADDRESS], table[0, program.EVERY] = address, 1
    return table


def _call(table: np.ndarray, slots: Slots, tick: int, nothing: np.ndarray, trips: np.ndarray) -> None:
    """Call the compiled step once, by the loop of the board."""
    from core.board import fold

    w = slots.w
    program.run(
        *(1, tick, 0.01, table, slots.p, slots.s, w, slots.io, nothing, nothing),
        *(fold.begin(0), len(w) - 1, np.zeros((0, 3))),
    )


def test_a_few_random_steps_stay_in_their_own_slots() -> None:
    stay_in_their_own_slots(range(FEW))


@pytest.mark.long
@pytest.mark.timeout(1500)
def test_random_steps_stay_in_their_own_slots(drawn_seed: int) -> None:
    stay_in_their_own_slots(range(drawn_seed, drawn_seed + 60))


def stay_in_their_own_slots(seeds: range) -> None:
    ran = 0
    for seed, one in admitted(seeds):
        if one is None:
            continue
        ran += 1
        names = set(one.block.step.__code__.co_names)
        fields = {field.name for kind in (one.block.Packed, one.block.State) for field in kind.layout.fields}
        ports = {port.name for port in one.block.Ports.declared} | {"tick", "time_ms"}
        own = {name for name in names if name.startswith("_")}
        assert {name for name in own if not name.startswith(GENERATED)} <= {"_item", "_put", "_floor", "_inf"}
        assert names <= ALLOWED | fields | ports | own, seed
        run_all(one.block)
    assert ran >= 0.3 * len(seeds), f"{ran} of {len(seeds)} were admitted"


@pytest.mark.parametrize(
    "text",
    [
        "s.line[int(bump(s))] += 1.0",
        "s.line[int(s.a)] = bump(s)",
        "s.line[int(s.a)] -= bump(s)",
        "s.line[2] += bump(s)\ns.a += bump(s)",
        "s.line[int(s.a)], s.line[int(bump(s))] = bump(s), s.a",
        "x.seen = s.a + bump(s) * s.a + (s.a if bump(s) > 2.0 else bump(s))",
        "bump_0 = 3.0\nx.seen = bump_0 + bump(s)",
        "turn_0 = 1.0\nbump_1 = 2.0\nx.seen = turn(s, x) + turn_0 + bump_1",
    ],
)
def test_values_indices_and_calls_are_worked_out_in_the_order_of_python(text: str) -> None:
    run_all(unit("odd", odd("step", text, top=HELPERS)).block)


def test_the_frame_runs_alike() -> None:
    run_all(unit("odd", odd("step", "s.line[int(e)] = x.tick\nx.seen = s.line[int(x.tick)] + floor(e)")).block)
