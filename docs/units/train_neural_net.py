"""Train the weights of ``neural_net.py``: ``python docs/units/train_neural_net.py`` prints them.

Three tanh units learn a saturated switching law over a grid of errors and their rates, by least squares. The seed fixes
where the search begins, so the weights are the same each time.
"""

import numpy as np
from scipy.optimize import least_squares

SEED = 1
UNITS = 3
SPAN = np.linspace(-2.0, 2.0, 21)
"""Errors and rates of the grid."""


def teacher(error: np.ndarray, rate: np.ndarray) -> np.ndarray:
    """Return the law that is learnt: a switching curve of the double integrator with a boundary layer."""
    return np.clip(error + rate + 0.5 * rate * np.abs(rate), -1.0, 1.0)


def network(weights: np.ndarray, error: np.ndarray, rate: np.ndarray) -> np.ndarray:
    """Return the output of the network; the rows are the weights of the error, of the rate and of the units."""
    of_error, of_rate, out = weights.reshape(3, UNITS)
    hidden = np.tanh(np.multiply.outer(error, of_error) + np.multiply.outer(rate, of_rate))
    return hidden @ out


def train() -> tuple[np.ndarray, float]:
    """Return the weights, in rows, and the root mean square of the residual."""
    error, rate = (part.ravel() for part in np.meshgrid(SPAN, SPAN))
    wanted = teacher(error, rate)
    start = np.random.default_rng(SEED).normal(size=3 * UNITS)
    found = least_squares(lambda w: network(w, error, rate) - wanted, start, xtol=1e-14, ftol=1e-14, gtol=1e-14)
    return found.x.reshape(3, UNITS), float(np.sqrt(np.mean(found.fun**2)))


if __name__ == "__main__":
    weights, missed = train()
    for name, row in zip(("OF_ERROR", "OF_RATE", "OUT"), weights, strict=True):
        print(f"{name} = ({', '.join(f'{number:.6g}' for number in row)})")
    print(f"rms of what is missed: {missed:.3g}")
