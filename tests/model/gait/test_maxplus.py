# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from model.errors import DomainError
from model.gait.maxplus import (
    EPSILON,
    coupling_time,
    cyclicity,
    eigenvalue,
    eigenvector,
    identity,
    oplus,
    otimes,
    plus,
    solve_implicit,
    star,
    zeros,
)

N = 4
WHOLE = st.integers(-50, 50).map(float)  # sums of whole numbers are exact, so that laws are too
NUMBER = st.one_of(st.just(EPSILON), WHOLE)
MATRIX = arrays(float, (N, N), elements=NUMBER)
FULL = arrays(float, (N, N), elements=WHOLE)
same = np.testing.assert_array_equal


@given(MATRIX, MATRIX, MATRIX)
def test_matrices_form_an_idempotent_semiring(A, B, C):
    same(otimes(otimes(A, B), C), otimes(A, otimes(B, C)))
    same(otimes(A, oplus(B, C)), oplus(otimes(A, B), otimes(A, C)))
    same(otimes(oplus(A, B), C), oplus(otimes(A, C), otimes(B, C)))
    same(otimes(A, identity(N)), A)
    same(otimes(identity(N), A), A)
    same(otimes(A, zeros(N, N)), zeros(N, N))
    same(oplus(A, zeros(N, N)), A)


def test_shapes_that_do_not_match_are_refused():
    with pytest.raises(DomainError, match=r"\(2, 2\) and \(3, 3\)"):
        otimes(zeros(2, 2), zeros(3, 3))


@given(MATRIX)
def test_star_is_the_sum_of_powers(A):
    A = A - 51.0  # no circuit of positive sum
    powers, total = identity(N), identity(N)
    for _ in range(N):
        powers = otimes(powers, A)
        total = oplus(total, powers)
    same(star(A), total)


@given(MATRIX, arrays(float, N, elements=WHOLE), arrays(float, N, elements=WHOLE))
def test_implicit_solution_solves_and_is_least(A, b, more):
    A = A - 51.0
    x = solve_implicit(A, b)
    same(oplus(otimes(A, x), b), x)
    above = solve_implicit(A, oplus(b, more))  # any solution of x >= A x + b, as b is exceeded
    assert np.all(x <= above)


def test_circuit_of_positive_sum_has_no_star():
    with pytest.raises(DomainError, match="has the sum 3"):
        plus(np.array([[EPSILON, 1.0], [2.0, EPSILON]]))


@given(FULL)
def test_eigenvector_satisfies_its_equation(A):
    v = eigenvector(A)
    np.testing.assert_allclose(otimes(A, v), v + eigenvalue(A), atol=1e-9)


@given(FULL)
def test_eigenvalue_is_the_growth_of_long_products(A):
    steps = 12 * 8  # a multiple of every circuit's length, after the transient
    x = np.zeros(N)
    history = [x]
    for _ in range(40 * steps):
        x = otimes(A, x)
        history.append(x)
    growth = (history[-1] - history[-1 - 12]) / 12
    np.testing.assert_allclose(growth, eigenvalue(A), atol=1e-9)


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9, 1e13])
def test_eigenvector_cyclicity_and_coupling_time_do_not_depend_on_the_unit_of_time(scale):
    A = np.array([[0.1, 0.7, EPSILON], [0.3, EPSILON, 0.9], [0.7, 0.3, 0.5]])
    v = eigenvector(scale * A)
    np.testing.assert_allclose(v / scale, eigenvector(A), atol=1e-9)
    assert cyclicity(scale * A) == cyclicity(A)
    assert coupling_time(scale * A) == coupling_time(A)


def test_matrix_without_circuits_has_no_eigenvalue():
    falls = np.array([[EPSILON, EPSILON], [1.0, EPSILON]])
    assert eigenvalue(falls) == EPSILON
    with pytest.raises(DomainError, match="no circuit"):
        eigenvector(falls)


def repeats(A):
    """Return coupling time and cyclicity by comparing every power with every one before it."""
    step, powers = A - eigenvalue(A), [A - eigenvalue(A)]
    while True:
        powers.append(otimes(step, powers[-1]))
        for k, power in enumerate(powers[:-1], start=1):
            if np.allclose(power, powers[-1], atol=1e-9):
                return k, len(powers) - k


@given(arrays(float, (N, N), elements=st.integers(-5, 5).map(float)))
def test_powers_repeat_after_the_coupling_time_with_the_cyclicity(A):
    assert (coupling_time(A), cyclicity(A)) == repeats(A)


@pytest.mark.parametrize(("lengths", "expected"), [((2, 3), 6), ((2, 2), 2), ((4,), 4), ((1,), 1)])
def test_circuits_that_are_not_connected_repeat_together(lengths, expected):
    A = zeros(sum(lengths), sum(lengths))
    first = 0
    for n in lengths:
        for i in range(n):
            A[first + i, first + (i + 1) % n] = 5.0
        first += n
    assert cyclicity(A) == expected
    assert coupling_time(A) == 1


def test_parts_of_different_rates_never_couple():
    A = np.array([[2.0, EPSILON], [EPSILON, 1.0]])
    with pytest.raises(DomainError, match="not periodic within 10,000 cycles"):
        coupling_time(A)
