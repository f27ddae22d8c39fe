"""Algebra of the small matrices of packing, in plain loops: the same bits on every machine.

The machine's linear algebra picks its code, and with it the order of its sums, by the processor and by the number of
its cores; the numbers of a step must not depend on either.
"""

from __future__ import annotations

import numpy as np

from core.block import FloatArray
from core.errors import InputError
from core.kernel import kernel

TAYLOR = 18
r"""Terms of the exponential of a matrix no larger than 1/2: the next is below :math:`2^{-19}/19!=1.6\cdot10^{-23}`."""
MOST_DOUBLINGS = 64
NEGLIGIBLE = 1e-17


def product(*factors: FloatArray) -> FloatArray:
    """Return the product of matrices, from left to right."""
    whole = _whole(factors[0])
    for factor in factors[1:]:
        whole = _product(whole, _whole(factor))
    return whole


def solved(matrix: FloatArray, right: FloatArray) -> FloatArray:
    r"""Return x of :math:`Ax=b`, by elimination with the largest pivots of the columns.

    Parameters
    ----------
    matrix : ndarray, shape (n, n)
    right : ndarray, shape (n, m) or (n,)

    Raises
    ------
    InputError
        When the matrix is singular.
    """
    x = np.array(right, np.float64).reshape(len(right), -1)
    if not _eliminate(np.array(matrix, np.float64), x):
        raise InputError("is singular", "matrix")
    return x.reshape(right.shape)


def exponential(matrix: FloatArray) -> FloatArray:
    """Return the exponential of a matrix: halved until it is small, summed, and squared as often."""
    return _exponential(_whole(matrix))


def riccati(phi: FloatArray, seen: FloatArray, noise: FloatArray, measured: FloatArray) -> FloatArray:
    r"""Return the covariance before a measurement, in the limit.

    .. math:: P=\Phi P\Phi^T-\Phi PH^T(HPH^T+R)^{-1}HP\Phi^T+Q

    by doubling: each pass looks back over twice as many measurements (Anderson 1978; Chu, Fan, Lin, Wang 2004),

    .. math:: W=(I+GP)^{-1},\quad A\leftarrow AWA,\quad G\leftarrow G+AWGA^T,\quad P\leftarrow P+A^TPWA

    from :math:`A=\Phi^T,\ G=H^TR^{-1}H,\ P=Q`.

    Parameters
    ----------
    phi, noise : ndarray, shape (n, n)
        Transition between two measurements, and the covariance Q that noise adds.
    seen : ndarray, shape (m, n)
        H.
    measured : ndarray, shape (m, m)
        Covariance R of the measurement.

    Raises
    ------
    InputError
        When there is no limit.
    """
    p = np.array(noise, np.float64)
    if not _riccati(_whole(phi.T), product(seen.T, solved(measured, seen)), p):
        raise InputError("the Riccati equation has no solution", "noise")
    return 0.5 * (p + p.T)


def lyapunov(phi: FloatArray, noise: FloatArray) -> FloatArray:
    r"""Return the covariance :math:`P=\Phi P\Phi^T+Q` of a stable filter in the limit, by doubling."""
    p = np.array(noise, np.float64)
    _lyapunov(_whole(phi), p)
    return p


def _whole(matrix: FloatArray) -> FloatArray:
    return np.ascontiguousarray(matrix, dtype=np.float64)


@kernel
def _product(a: FloatArray, b: FloatArray) -> FloatArray:
    rows, inner, columns = a.shape[0], a.shape[1], b.shape[1]
    out = np.zeros((rows, columns))
    for i in range(rows):
        for k in range(inner):
            for j in range(columns):
                out[i, j] += a[i, k] * b[k, j]
    return out


@kernel
def _eliminate(a: FloatArray, x: FloatArray) -> bool:
    """Solve in place; return whether the matrix was regular."""
    n, m = x.shape
    for k in range(n):
        pivot = k
        for i in range(k + 1, n):
            if abs(a[i, k]) > abs(a[pivot, k]):
                pivot = i
        if not abs(a[pivot, k]) > 0.0:
            return False
        for j in range(n):
            a[k, j], a[pivot, j] = a[pivot, j], a[k, j]
        for j in range(m):
            x[k, j], x[pivot, j] = x[pivot, j], x[k, j]
        for i in range(k + 1, n):
            share = a[i, k] / a[k, k]
            for j in range(k, n):
                a[i, j] -= share * a[k, j]
            for j in range(m):
                x[i, j] -= share * x[k, j]
    for k in range(n - 1, -1, -1):
        for j in range(m):
            total = x[k, j]
            for i in range(k + 1, n):
                total -= a[k, i] * x[i, j]
            x[k, j] = total / a[k, k]
    return True


@kernel
def _exponential(a: FloatArray) -> FloatArray:
    n = a.shape[0]
    size = 0.0
    for i in range(n):
        row = 0.0
        for j in range(n):
            row += abs(a[i, j])
        size = max(size, row)
    halvings = 0
    scale = 1.0
    while size * scale > 0.5 and halvings < 1100:
        scale *= 0.5
        halvings += 1
    small = a * scale
    out = np.eye(n)
    for k in range(TAYLOR, 0, -1):
        out = _product(small, out) / k
        for i in range(n):
            out[i, i] += 1.0
    for _ in range(halvings):
        out = _product(out, out)
    return out


@kernel
def _settled(p: FloatArray, more: FloatArray) -> bool:
    """Add to a sum; return whether the addition was negligible."""
    largest = added = 0.0
    for i in range(p.shape[0]):
        for j in range(p.shape[1]):
            p[i, j] += more[i, j]
            largest = max(largest, abs(p[i, j]))
            added = max(added, abs(more[i, j]))
    return largest < np.inf and added <= NEGLIGIBLE * largest


@kernel
def _transposed(a: FloatArray) -> FloatArray:
    out = np.empty((a.shape[1], a.shape[0]))
    for i in range(a.shape[0]):
        for j in range(a.shape[1]):
            out[j, i] = a[i, j]
    return out


@kernel
def _riccati(a: FloatArray, g: FloatArray, p: FloatArray) -> bool:
    """Double in place until the change is negligible; return whether there was an end."""
    n = a.shape[0]
    for _ in range(MOST_DOUBLINGS):
        matrix = _product(g, p)
        right = np.empty((n, 2 * n))
        right[:, :n] = a
        right[:, n:] = _product(g, _transposed(a))
        for i in range(n):
            matrix[i, i] += 1.0
        if not _eliminate(matrix, right):
            return False
        wa, wga = right[:, :n].copy(), right[:, n:].copy()
        more = _product(_product(_transposed(a), p), wa)
        g = g + _product(a, wga)
        a = _product(a, wa)
        if _settled(p, more):
            return True
    return False


@kernel
def _lyapunov(a: FloatArray, p: FloatArray) -> None:
    for _ in range(MOST_DOUBLINGS):
        done = _settled(p, _product(_product(a, p), _transposed(a)))
        a = _product(a, a)
        if done:
            return
