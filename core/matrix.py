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
        found = np.empty((whole.shape[0], factor.shape[1]))
        _product(whole, _whole(factor), found)
        whole = found
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
    found = np.eye(len(matrix))
    _exponential(_whole(matrix).copy(), found, np.empty_like(found))
    return found


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
    n = len(p)
    room, right = np.empty((4, n, n)), np.empty((n, 2 * n))
    if not _riccati(np.array(phi.T, np.float64, order="C"), product(seen.T, solved(measured, seen)), p, room, right):
        raise InputError("the Riccati equation has no solution", "noise")
    return 0.5 * (p + p.T)


def lyapunov(phi: FloatArray, noise: FloatArray) -> FloatArray:
    r"""Return the covariance :math:`P=\Phi P\Phi^T+Q` of a stable filter in the limit, by doubling."""
    p = np.array(noise, np.float64)
    _lyapunov(np.array(phi, np.float64), p, np.empty((3, *p.shape)))
    return p


def _whole(matrix: FloatArray) -> FloatArray:
    return np.ascontiguousarray(matrix, dtype=np.float64)


@kernel
def _product(a: FloatArray, b: FloatArray, out: FloatArray) -> None:
    rows, inner, columns = a.shape[0], a.shape[1], b.shape[1]
    out[:, :] = 0.0
    for i in range(rows):
        for k in range(inner):
            for j in range(columns):
                out[i, j] += a[i, k] * b[k, j]


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
def _exponential(a: FloatArray, out: FloatArray, next_: FloatArray) -> None:
    """Write the exponential of a matrix, which is made small, over the one of 0."""
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
    for i in range(n):
        for j in range(n):
            a[i, j] *= scale
    for k in range(TAYLOR, 0, -1):
        _product(a, out, next_)
        for i in range(n):
            for j in range(n):
                out[i, j] = next_[i, j] / k
            out[i, i] += 1.0
    for _ in range(halvings):
        _product(out, out, next_)
        out[:, :] = next_


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
def _transpose(a: FloatArray, out: FloatArray) -> None:
    for i in range(a.shape[0]):
        for j in range(a.shape[1]):
            out[j, i] = a[i, j]


@kernel
def _riccati(a: FloatArray, g: FloatArray, p: FloatArray, room: FloatArray, right: FloatArray) -> bool:
    """Double in place until the change is negligible; return whether there was an end."""
    n = a.shape[0]
    matrix, turned, part, more = room[0], room[1], room[2], room[3]
    wa, wga = right[:, :n], right[:, n:]
    for _ in range(MOST_DOUBLINGS):
        _product(g, p, matrix)
        _transpose(a, turned)
        wa[:, :] = a
        _product(g, turned, wga)
        for i in range(n):
            matrix[i, i] += 1.0
        if not _eliminate(matrix, right):
            return False
        _product(turned, p, part)
        _product(part, wa, more)
        _product(a, wga, part)
        for i in range(n):
            for j in range(n):
                g[i, j] += part[i, j]
        _product(a, wa, part)
        a[:, :] = part
        if _settled(p, more):
            return True
    return False


@kernel
def _lyapunov(a: FloatArray, p: FloatArray, room: FloatArray) -> None:
    part, turned, more = room[0], room[1], room[2]
    for _ in range(MOST_DOUBLINGS):
        _product(a, p, part)
        _transpose(a, turned)
        _product(part, turned, more)
        _product(a, a, part)
        a[:, :] = part
        if _settled(p, more):
            return
