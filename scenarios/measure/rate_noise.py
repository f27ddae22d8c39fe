"""Figures of the noise of an estimated rate, from its Allan deviation."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from core.readout.allan import Allan
from core.theory.rate_noise import fit
from core.units import DEG_RT_H_PER_DEG_RT_S


def rate_noise_metrics(taus_s: Sequence[float], state: Allan.State) -> dict[str, float]:
    """Return N, B and K as far as the record shows them, and N as a density.

    Parameters
    ----------
    taus_s : sequence of float, shape (octaves,)
        Averaging times of the read-out, s.
    state : Allan.State
        State of the Allan figures.
    """
    averages = np.array(state.averages)
    noise = fit(taus_s, np.sqrt(0.5 * state.squares / np.maximum(averages, 1.0)), averages)
    figures = {
        "rate.arw_deg_per_rt_h": noise.angle_random_walk.value,
        "rate.bias_instability_deg_per_h": noise.bias_instability.value,
        "rate.random_walk_deg_per_h_rt_h": noise.rate_random_walk.value,
    }
    white = noise.angle_random_walk.value
    if white is not None:  # the density of white noise is one-sided, N two-sided
        figures["rate.noise_deg_per_h_rthz"] = math.sqrt(2.0) * DEG_RT_H_PER_DEG_RT_S * white
    return {name: value for name, value in figures.items() if value is not None}
