"""Small matrices in plain loops against scipy, and against their own equations."""

from __future__ import annotations

import ast
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import linalg

from core.device.oscillator import transition
from core.errors import InputError
from core.matrix import exponential, lyapunov, product, riccati, solved

CORE = Path(__file__).parents[2] / "core"


def drawn(seed: int, *shape: int) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=shape)


seeds, sizes = st.integers(0, 10_000), st.integers(1, 12)


@given(seeds, sizes, sizes, sizes)
def test_product(seed, a, b, c):
    first, second = drawn(seed, a, b), drawn(seed + 1, b, c)
    np.testing.assert_allclose(product(first, second), first @ second, rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(product(first, second, second.T), first @ second @ second.T, rtol=1e-11, atol=1e-12)


@given(seeds, st.integers(1, 42), st.integers(1, 4))
def test_solution_leaves_nothing(seed, n, columns):
    a, b = drawn(seed, n, n), drawn(seed + 1, n, columns)
    x = solved(a, b)
    assert np.max(np.abs(a @ x - b)) <= 1e-13 * n * np.max(np.abs(a)) * max(1.0, np.max(np.abs(x)))


def test_solution_takes_the_largest_pivot_and_refuses_singular_matrices():
    np.testing.assert_allclose(solved(np.array([[1e-20, 1.0], [1.0, 1.0]]), np.array([[1.0], [2.0]])), [[1.0], [1.0]])
    with pytest.raises(InputError, match="is singular"):
        solved(np.array([[1.0, 2.0], [0.0, 0.0]]), np.ones((2, 1)))


@given(seeds, sizes, st.floats(-4.0, 1.0))
def test_exponential(seed, n, power):
    a = drawn(seed, n, n) * 10.0**power
    reference = linalg.expm(a)
    np.testing.assert_allclose(exponential(a), reference, rtol=1e-9, atol=1e-11 * np.max(np.abs(reference)))


def test_exponential_of_a_turn_is_a_turn():
    turn = exponential(np.array([[0.0, -7.0], [7.0, 0.0]]))
    np.testing.assert_allclose(turn, [[np.cos(7.0), -np.sin(7.0)], [np.sin(7.0), np.cos(7.0)]], atol=1e-14)


@given(seeds, st.floats(-1.0, 2.0), st.floats(0.0, 4.0), st.floats(-3.0, 0.0), st.floats(-8.0, 0.0))
def test_riccati_solves_its_equation(seed, log_rate, log_quality, log_interval, log_noise):
    rate, h, r = 10.0**log_rate, 10.0**log_interval, 10.0**log_noise
    phi = np.reshape(transition(1.0, rate / 10.0**log_quality, rate * rate, h), (2, 2))
    push = np.random.default_rng(seed).normal(size=2) * (h * h, h)
    noise = np.outer(push, push) + 1e-18 * np.eye(2)
    p = riccati(phi, np.array([[1.0, 0.0]]), noise, np.array([[r]]))
    gain = phi @ p[:, :1] / (p[0, 0] + r)
    again = phi @ p @ phi.T - gain * (p[0, 0] + r) @ gain.T + noise
    # the terms of this sum are up to 1e4 times its result, and each of them is rounded
    terms = np.diag(np.abs(phi) @ np.abs(p) @ np.abs(phi.T) + noise)
    scale = np.sqrt(np.outer(terms, terms))
    assert np.max(np.abs(again - p) / scale) < 1e-12
    assert np.max(np.abs(np.linalg.eigvals(phi - gain @ np.array([[1.0, 0.0]])))) < 1.0


@given(seeds)
def test_riccati_of_four_states_as_scipy_has_it(seed):
    phi = 0.9 * drawn(seed, 4, 4) / 2.0
    root, seen = drawn(seed + 1, 4, 4), drawn(seed + 2, 2, 4)
    noise, measured = root @ root.T, np.diag([0.5, 2.0])
    reference = linalg.solve_discrete_are(phi.T, seen.T, noise, measured)
    np.testing.assert_allclose(riccati(phi, seen, noise, measured), reference, rtol=1e-7, atol=1e-8)


def test_riccati_refuses_what_grows_unseen():
    with pytest.raises(InputError, match="no solution"):
        riccati(np.diag([0.5, 1.5]), np.array([[1.0, 0.0]]), np.eye(2), np.eye(1))


@given(seeds, st.integers(1, 6))
def test_lyapunov(seed, n):
    phi = drawn(seed, n, n)
    phi *= 0.95 / max(0.95, np.max(np.abs(np.linalg.eigvals(phi))))
    root = drawn(seed + 1, n, n)
    p = lyapunov(phi, root @ root.T)
    np.testing.assert_allclose(phi @ p @ phi.T + root @ root.T, p, rtol=1e-9, atol=1e-9 * np.max(np.abs(p)))


SHOWN_ONLY = {
    *("board/explain.py", "board/history.py", "device/frequency.py", "device/identification.py", "device/response.py"),
    "device/two_axis.py",
    *("diagnose/aliases.py", "diagnose/bank.py", "plant/equilibrium.py", "plant/escape.py", "voltage.py"),
    "diagnose/chance.py",
}
"""Files whose library calls make figures, warnings and pictures, and nothing that a step reads."""
LIBRARY = {
    "exp",
    "expm1",
    "log",
    "log10",
    "log1p",
    "sin",
    "cos",
    "tan",
    "asin",
    "acos",
    "atan",
    "atan2",
    "sinh",
    "cosh",
}
LIBRARY |= {"tanh", "asinh", "acosh", "atanh", "pow", "hypot", "cbrt", "gamma", "erf"}


def machine_dependent(tree: ast.AST) -> set[str]:
    """Return the calls of a file into libraries that pick their code by the processor."""
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult):
            found.add("@")
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            name = f"{node.value.id}.{node.attr}"
            if (node.value.id in ("math", "cmath", "np") and node.attr in LIBRARY) or name == "np.linalg":
                found.add(name)
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("scipy"):
            found.add(str(node.module))
    return found


def test_what_a_step_reads_asks_no_library_of_the_machine():
    asked = {
        str(path.relative_to(CORE)): found
        for path in CORE.rglob("*.py")
        if "theory" not in path.parts and (found := machine_dependent(ast.parse(path.read_text())))
    }
    assert asked.keys() <= SHOWN_ONLY, {name: asked[name] for name in asked.keys() - SHOWN_ONLY}
