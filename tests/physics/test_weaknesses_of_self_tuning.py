"""The stated weaknesses of self-tuning banks under a slow sine, on seeds no figure was taken from."""

from __future__ import annotations

from typing import Any

import pytest

from core import registry
from tests.physics.seeds import HELD_OUT, seven_steps

KINDS = ("self_tuning", "arx_bank", "reference_banks", "anchored", "free_banks")
SAID: dict[tuple[float, float], dict[str, int]] = {
    (0.01, 2000.0): {"self_tuning": 99, "arx_bank": 99, "reference_banks": 99, "anchored": 98, "free_banks": 11},
    (0.01, 1000.0): {"self_tuning": 91, "arx_bank": 89, "reference_banks": 98, "anchored": 72, "free_banks": 11},
    (0.01, 500.0): {"self_tuning": 67, "arx_bank": 74, "reference_banks": 74, "anchored": 70, "free_banks": 11},
    (0.01, 200.0): {"self_tuning": 41, "arx_bank": 33, "reference_banks": 61, "anchored": 22, "free_banks": 11},
    (0.05, 2000.0): {"self_tuning": 96, "arx_bank": 97, "reference_banks": 99, "anchored": 57},
    (0.05, 1000.0): {"self_tuning": 39, "arx_bank": 29, "reference_banks": 72, "anchored": 18, "imm": 92},
}
"""By noise (um) and tone (Hz): percent of the samples that are right."""


@pytest.mark.long
@pytest.mark.timeout(300)
@pytest.mark.parametrize("case", SAID)
def test_the_figures_a_self_tuning_bank_gives_are_those_it_has(case):
    noise, hz = case
    banks: dict[str, Any] = {kind: {"kind": kind} for kind in SAID[case]}
    own = {"sensor__noise_um": noise, "sample_rate_khz": 20, "reference__frequency_hz": hz}
    found = seven_steps(range(HELD_OUT, HELD_OUT + 10), banks, **own)
    for kind, percent in SAID[case].items():
        assert 100 * found[kind].correct == pytest.approx(percent, abs=4), kind
    if case == (0.05, 1000.0):
        assert found["self_tuning"].right[[0, 6]].mean() == pytest.approx(0.25, abs=0.08)


@pytest.mark.parametrize("kind", KINDS)
def test_every_one_of_them_says_so_where_it_is_chosen(kind):
    """In the card that the catalogue, the command line and the page show."""
    said = " ".join(registry.card(registry.block("diagnose", kind)).weaknesses)
    for case, shares in SAID.items():
        if kind in shares and case != (0.01, 2000.0):
            assert f"{shares[kind]} %" in said, case
