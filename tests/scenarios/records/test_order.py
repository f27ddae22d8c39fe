"""The order of blocks by their numbers and by the clock of their source, against gaps that are known."""

from __future__ import annotations

import pytest

from core.errors import InputError
from scenarios.records.arrivals import Arrivals
from scenarios.records.line import BlockHead
from scenarios.records.order import BlockOrder

RATE_KHZ = 100.0
NS = 10_000
"""Time of a sample."""


def placed(order: BlockOrder, *blocks: tuple[int, int]) -> list[int | None]:
    """Place blocks of ten samples, each by its number and its first sample."""
    return [order.place(BlockHead(number, first * NS, 10)) for number, first in blocks]


def test_a_gap_is_as_long_as_the_clock_says_with_or_without_a_lost_block() -> None:
    order = BlockOrder(RATE_KHZ)
    assert placed(order, (5, 1000), (6, 1010), (7, 1025), (9, 1045), (10, 1055)) == [0, 0, 5, 10, 0]
    assert (order.blocks, order.lost_blocks, order.lost_samples, order.breaks) == (5, 1, 15, 0)


def test_a_clock_that_is_off_by_less_than_a_sample_adds_up_to_no_gap() -> None:
    order = BlockOrder(RATE_KHZ)
    off = 1.0003  # a block of 3333 samples is late by one sample
    lost = [order.place(BlockHead(k, round(3333 * k * NS * off), 3333)) for k in range(500)]
    assert set(lost) == {0}


def test_a_lost_block_without_time_for_it_is_one_lost_sample() -> None:
    assert placed(BlockOrder(RATE_KHZ), (0, 0), (2, 10)) == [0, 1]


def test_late_and_doubled_blocks_are_told_apart() -> None:
    order = BlockOrder(RATE_KHZ)
    assert placed(order, (0, 0), (4, 40), (2, 20), (2, 20), (4, 40), (0, 0), (1, 10)) == [0, 30, *[None] * 5]
    assert (order.lost_blocks, order.late_blocks, order.doubled_blocks) == (3, 2, 3)


@pytest.mark.parametrize(("first", "lost", "breaks"), [(1_000_010, 1_000_000, 0), (1_000_012, 1, 1)])
def test_more_than_ten_seconds_are_a_break(first: int, lost: int, breaks: int) -> None:
    order = BlockOrder(RATE_KHZ)
    assert placed(order, (0, 0), (1, first)) == [0, lost] and order.breaks == breaks


def test_shots_have_a_break_between_two_that_do_not_touch() -> None:
    order = BlockOrder(RATE_KHZ, shots=True)
    assert placed(order, (0, 0), (1, 10), (2, 25)) == [0, 0, 1] and order.breaks == 1


def test_only_the_same_session_continues() -> None:
    order = BlockOrder(RATE_KHZ)
    order.begin("a")
    placed(order, (0, 0), (1, 10))
    order.begin("a")
    assert placed(order, (1, 10), (2, 24)) == [None, 4]
    order.begin("b")
    assert placed(order, (0, 0), (1, 10)) == [1, 0]
    order.begin("")
    order.begin("")
    assert placed(order, (1, 10)) == [1]
    assert (order.breaks, order.doubled_blocks) == (2, 1)


def test_a_clock_that_runs_back_is_refused() -> None:
    order = BlockOrder(RATE_KHZ)
    placed(order, (0, 0))
    assert order.place(BlockHead(1, 9 * NS, 10)) == 0  # a sample is within the error of a clock
    with pytest.raises(InputError, match=r"block 2: begins 30 .s before the end of the block before it"):
        order.place(BlockHead(2, 16 * NS, 10))
    assert order.blocks == 2


def test_rate_lag_and_latency_are_those_of_the_blocks() -> None:
    arrivals = Arrivals()
    assert arrivals.latency_p95_ms is None and arrivals.rate_khz(0.0) == arrivals.lag_ms(0.0) == 0.0
    for k in range(100):
        arrivals.came(100 * (k + 1), 0.01 * k)
        if k < 99:
            arrivals.played(100 * (k + 1), 0.01 * k + (0.050 if k >= 90 else 0.002))
    assert arrivals.latency_p95_ms == pytest.approx(50.0)
    assert arrivals.lag_ms(1.0) == pytest.approx(10.0)
    assert arrivals.rate_khz(1.0) == pytest.approx(10.0) and arrivals.rate_khz(100.0) == 0.0
