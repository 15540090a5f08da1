# SPDX-License-Identifier: MIT
r"""Max-plus algebra: numbers with :math:`\oplus` for the maximum and :math:`\otimes` for the sum.

.. math::
    a \oplus b = \max(a, b), \qquad a \otimes b = a + b, \qquad \varepsilon = -\infty, \quad e = 0

epsilon is the zero (neutral for the maximum, absorbing for the sum), e the one. Matrices are
arrays of floats, times are in seconds.
"""

from collections import deque
from math import gcd, lcm

import numpy as np
from numpy.typing import ArrayLike

from model.arrays import Array
from model.errors import DomainError

EPSILON = -np.inf
ONE = 0.0
_ROUNDING = 1e-9  # of the longest time: circuits whose means differ by less are equal
_LONGEST = 10_000  # powers in which a matrix is given time to couple


def oplus(a: ArrayLike, b: ArrayLike) -> Array:
    r"""Compute a ⊕ b entry by entry, Eq. (2-7).

    .. math::
        [A \oplus B]_{ij} = \max(a_{ij}, b_{ij})

    The thesis prints + instead of the comma.

    Args:
        a: First array.
        b: Second array, of a shape that broadcasts against the first.

    >>> oplus([1.0, EPSILON], [0.0, 2.0]).tolist()
    [1.0, 2.0]
    """
    return np.maximum(np.asarray(a, dtype=float), np.asarray(b, dtype=float))


def otimes(a: ArrayLike, b: ArrayLike) -> Array:
    r"""Compute a ⊗ b, Eq. (2-8): the sum with a number, of arrays :math:`max_k (a_{ik} + b_{kj})`.

    Args:
        a: A number, or a matrix of shape (n, m).
        b: A number, a matrix of shape (m, p) or a vector of shape (m,).

    Raises:
        DomainError: The shapes do not match, or `a` is a vector.

    >>> otimes([[0.0, 2.0], [EPSILON, 1.0]], [3.0, 0.0]).tolist()
    [3.0, 1.0]
    """
    left, right = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
    if left.ndim == 0 or right.ndim == 0:
        return left + right
    if left.ndim != 2 or left.shape[1] != right.shape[0]:
        raise DomainError(
            f"cannot multiply shapes {left.shape} and {right.shape}; want (n, m), (m, p) or (m,)"
        )
    if right.ndim == 1:
        return (left + right).max(axis=1)
    return (left[:, :, None] + right).max(axis=1)


def identity(n: int) -> Array:
    """Return the identity E_n, Eq. (2-9), shape (n, n): e on the diagonal, epsilon elsewhere."""
    return diagonal(np.full(n, ONE))


def diagonal(entries: ArrayLike) -> Array:
    """Return a matrix, shape (n, n), of n entries on the diagonal and epsilon elsewhere."""
    values = np.asarray(entries, dtype=float)
    return np.where(np.eye(len(values), dtype=bool), values, EPSILON)


def zeros(rows: int, columns: int) -> Array:
    """Return the max-plus zero matrix, Eq. (2-10): epsilon everywhere.

    Args:
        rows: Number of rows.
        columns: Number of columns.
    """
    return np.full((rows, columns), EPSILON)


def _rounding(A: Array) -> float:
    """Return the difference up to which sums of a matrix's entries count as equal [s]."""
    return _ROUNDING * float(np.abs(A[np.isfinite(A)]).max(initial=0.0))


def plus(A: Array, *, rounding: float | None = None) -> Array:
    r"""Compute the weights of the heaviest paths of at least one step in a matrix's graph.

    .. math::
        A^+ = A \oplus A^{\otimes 2} \oplus A^{\otimes 3} \oplus \ldots

    Entry (i, j) is the greatest sum along any path from j to i. A+ exists if no circuit has a
    positive sum; then n powers suffice, and the Floyd-Warshall algorithm computes them.

    Args:
        A: Square matrix, shape (n, n).
        rounding: Sum of a circuit that counts as zero; 1e-9 of the largest entry when None [s].

    Raises:
        DomainError: A circuit has a positive sum.
    """
    rounding = _rounding(A) if rounding is None else rounding
    paths = np.array(A, dtype=float)
    for via in range(len(paths)):
        paths = np.maximum(paths, paths[:, via, None] + paths[None, via, :])
        heaviest = np.diagonal(paths).max()
        if heaviest > rounding:
            raise DomainError(
                f"a circuit of the max-plus matrix has the sum {heaviest:g}; expected at most 0: "
                "an event would wait for itself within one cycle; check the order of leg groups"
            )
    return paths


def star(A: Array) -> Array:
    r"""Compute the Kleene star :math:`A^* = E \oplus A \oplus A^{\otimes 2} \oplus \ldots`, (n, n).

    Args:
        A: Square matrix, shape (n, n).

    Raises:
        DomainError: A circuit has a positive sum.
    """
    return oplus(identity(len(A)), plus(A))


def solve_implicit(A: Array, b: Array) -> Array:
    r"""Solve :math:`x = A \otimes x \oplus b` for its least solution, :math:`A^* \otimes b`.

    Args:
        A: Square matrix, shape (n, n).
        b: A vector of shape (n,) or a matrix of shape (n, p).

    Raises:
        DomainError: A circuit has a positive sum, so that no event could ever happen, or the shapes
            do not match.

    >>> waits = np.array([[EPSILON, EPSILON], [2.0, EPSILON]])
    >>> solve_implicit(waits, np.array([1.0, 0.0])).tolist()
    [1.0, 3.0]
    """
    return otimes(star(A), b)


def eigenvalue(A: Array) -> float:
    r"""Compute a matrix's eigenvalue, the largest circuit mean, by Karp's formula.

    .. math::
        \lambda = \max_i \min_{k < n} \frac{[a_n - a_k]_i}{n - k}, a_k = A^{\otimes k} \otimes 0

    Args:
        A: Square matrix, shape (n, n).

    Returns:
        The eigenvalue, the cycle time of A [s]; epsilon for a matrix without circuits.

    >>> eigenvalue(np.array([[EPSILON, 3.0], [1.0, EPSILON]]))
    2.0
    """
    n = len(A)
    heaviest: list[Array] = [np.zeros(n)]  # walks of k steps that end in i, from anywhere
    for _ in range(n):
        heaviest.append(otimes(A, heaviest[-1]))
    ends = np.isfinite(heaviest[n])
    if not ends.any():
        return EPSILON
    walks = np.array(heaviest)[:, ends]
    means = (walks[n] - walks[:n]) / (n - np.arange(n))[:, None]
    return float(means.min(axis=0).max())


def eigenvector(A: Array) -> Array:
    r"""Compute the eigenvector of the steady state that x(k) = A ⊗ x(k - 1) has from x = 0.

    .. math::
        A \otimes v = \lambda \otimes v, \qquad
        v = \bigoplus_{c} [A_\lambda^*]_{\cdot c} \otimes \bigoplus_j [A_\lambda^*]_{cj}

    with A_lambda = A - lambda, over its critical nodes c, those on a circuit of mean lambda. If
    x(k) - k lambda converges, it does to v. Where the critical circuits are not connected the
    eigenvector is not unique; this one follows from events which all begin at zero.

    Args:
        A: Square matrix, shape (n, n).

    Returns:
        Eigenvector, shape (n,).

    Raises:
        DomainError: The matrix has no circuits, hence no eigenvalue.
    """
    mean = eigenvalue(A)
    if mean == EPSILON:
        raise DomainError("the max-plus matrix has no circuit, so events do not repeat")
    rounding = _rounding(A)
    paths = plus(A - mean, rounding=rounding)
    critical = np.diagonal(paths) >= -rounding
    paths = oplus(identity(len(A)), paths)
    return (paths[:, critical] + paths[critical].max(axis=1)).max(axis=1)


def cyclicity(A: Array) -> int:
    r"""Compute after how many powers those of a matrix repeat, its cyclicity c.

    It is the least common multiple, over the strongly connected parts of the critical graph (the
    circuits whose mean is the eigenvalue), of the greatest common divisor of their circuits'
    lengths.

    Args:
        A: Square matrix, shape (n, n).

    Raises:
        DomainError: The matrix has no circuits, hence no eigenvalue.

    >>> cyclicity(np.array([[EPSILON, 3.0], [1.0, EPSILON]]))
    2
    """
    from scipy.sparse.csgraph import connected_components, shortest_path  # late: slow to import

    mean = eigenvalue(A)
    if mean == EPSILON:
        raise DomainError("the max-plus matrix has no circuit, so events do not repeat")
    rounding = _rounding(A)
    back = plus(A - mean, rounding=rounding).T
    critical = (A - mean) + back >= -rounding  # from column to row, and back
    graph = np.ascontiguousarray(critical.T, dtype=float)
    _, part = connected_components(graph, connection="strong")
    steps = shortest_path(graph, unweighted=True)
    lengths = [1]
    for start in np.unique(part[critical.any(axis=1)], return_index=True)[0]:
        inside = part == start
        depth = steps[np.flatnonzero(inside)[0]]
        ends, begins = np.nonzero(critical & inside[:, None] & inside[None, :])
        lengths.append(gcd(*(depth[begins] + 1 - depth[ends]).astype(int).tolist()))
    return lcm(*lengths)


def coupling_time(A: Array) -> int:
    r"""Compute the coupling time: after how many cycles events are periodic, from any start.

    It is the least k_0 >= 1 for which, with the eigenvalue lambda and the cyclicity c,

    .. math::
        A^{\otimes (k + c)} = \lambda^{\otimes c} \otimes A^{\otimes k}, \qquad k \ge k_0 .

    Args:
        A: Square matrix, shape (n, n).

    Raises:
        DomainError: The matrix has no circuits, or does not couple within 10,000 powers, as where
            parts that do not wait for each other have different cycle times.

    >>> coupling_time(np.array([[EPSILON, 3.0], [1.0, EPSILON]]))
    1
    """
    step, cycle, rounding = A - eigenvalue(A), cyclicity(A), _rounding(A)
    powers = deque([step], maxlen=cycle + 1)  # A^k - k lambda, the last c + 1
    for k in range(1, _LONGEST + cycle):
        if len(powers) > cycle and _same(powers[0], powers[-1], rounding):
            return k - cycle
        powers.append(otimes(step, powers[-1]))
    raise DomainError(
        f"events of the max-plus matrix are not periodic within {_LONGEST:,} cycles: legs that do "
        "not wait for each other step at different rates, or at almost the same"
    )


def _same(a: Array, b: Array, rounding: float) -> bool:
    """Return whether two matrices are equal but for rounding [s], epsilon in the same places."""
    finite = np.isfinite(a)
    if not np.array_equal(finite, np.isfinite(b)):
        return False
    return bool(np.all(np.abs(a[finite] - b[finite]) <= rounding))
