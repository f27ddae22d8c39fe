"""Points for an answer: Brier's rule, proper, and the same for a sure guess as for none."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from server.classroom.brier import points

SHARE = st.floats(0.0, 1.0)
COUNT = st.integers(2, 16)


@given(SHARE, SHARE, COUNT)
def test_on_average_nothing_earns_more_than_honesty(belief: float, said: float, answers: int) -> None:
    def expected(confidence: float) -> float:
        return belief * points(True, confidence, answers) + (1.0 - belief) * points(False, confidence, answers)

    # the loss of saying another number is a square: 100 n^2 / (n-1)^2 (said - belief)^2 by expanding the sum
    loss = 100.0 * (answers / (answers - 1)) ** 2 * (said - belief) ** 2
    assert expected(belief) - expected(said) == pytest.approx(loss, abs=1e-9)


@given(COUNT)
def test_its_marks(answers: int) -> None:
    assert points(True, 1.0, answers) == 100.0
    assert points(True, 1.0 / answers, answers) == pytest.approx(0.0, abs=1e-9)
    assert points(False, 1.0 / answers, answers) == pytest.approx(0.0, abs=1e-9)
    assert points(False, 1.0, answers) == pytest.approx(100.0 * (1.0 - 2.0 * answers / (answers - 1)))
