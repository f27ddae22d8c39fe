"""The length of the records of a step, and commands that would change it."""

from __future__ import annotations

import numpy as np
import pytest

from core import registry
from core.block import Block, BlockParams, parameter
from core.record import Record, Vector, tail
from tests.lab import RICH, do, make, play


def block_with(lengths: tuple[str, ...], *, live: bool) -> type[Block]:
    class Window(Block):
        title = "Window"

        class Params(BlockParams):
            samples: int = parameter(5, "samples of the window", live=live)

        class State(Record):
            window: Vector = tail()

    Window.lengths = lengths
    return Window


@pytest.mark.parametrize(
    ("lengths", "live", "words"),
    [((), False, "name the parameters"), (("samples",), True, "live=False"), (("sample",), False, "must be there")],
)
def test_a_state_whose_length_could_change_is_refused_when_the_block_is_loaded(lengths, live, words):
    with pytest.raises(TypeError, match=words):
        registry._check_lengths(block_with(lengths, live=live))


def test_a_length_that_stays_is_taken():
    registry._check_lengths(block_with(("samples",), live=False))


def test_a_grating_of_more_harmonics_goes_on_from_where_the_board_is():
    """A wide spot leaves one harmonic and a fine one all 64: the step reads more numbers."""
    values = {"sensor.kind": "quadrature", "sensors.dual_beam.spot_um": 3.9}
    board, other = make(values, base=RICH), make(values, base=RICH)
    play(board, 200)
    play(other, 200)
    before = len(board.wiring.parameters("dual_beam").amplitudes)
    do(board, {"set": {"sensors.dual_beam.spot_um": 0.1}})
    assert len(board.wiring.parameters("dual_beam").amplitudes) > before
    kept = {key: board.wiring.state_of(key).copy() for key in board.wiring.rows}
    assert all(np.array_equal(kept[key], other.wiring.state_of(key)) for key in kept)
    assert np.all(np.isfinite(play(board, 200)["sensor.displacement"]))
