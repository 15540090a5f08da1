# SPDX-License-Identifier: MIT
r"""What distortion terms that a lens was fitted without add to its uncertainty.

Photographs that are predicted as well without some terms seldom show that there are none, and what
is left out is made up for by others: the principal point moves by 3 px for a tangential distortion
of 5e-4. The covariance of the fitted lens is therefore averaged over models with more terms
(Bayesian model averaging, Hoeting et al. 1999), by what the most general one found. With its
estimate :math:`\hat\theta`, its covariance C, and :math:`\hat x` the terms in question, a model in
which these have a prior :math:`N(0, \Pi)`, zero for those that it leaves out, has the evidence
:math:`N(\hat x; 0, C_{xx} + \Pi)` and the estimate

.. math::
    \hat\theta - C_{\cdot x} (C_{xx} + \Pi)^{-1} \hat x .
"""

from collections.abc import Sequence
from itertools import product

import numpy as np

from model.arrays import Array

PRIOR_SD = {4: 0.2, 5: 0.2, 6: 1e-3, 7: 1e-3, 8: 0.2}
"""Standard deviations of k1, k2, p1, p2, k3 of lenses that see 40 to 90 degrees [-].

By their indices among fx, fy, cx, cy, k1, k2, p1, p2, k3. Longer lenses may have larger terms."""

_RADIAL = ((), (4,), (4, 5), (4, 5, 8))
_TANGENTIAL = ((), (6, 7))


def with_omitted_terms(
    lens: Array, covariance: Array, fitted: Sequence[int], general: Array,
    general_covariance: Array,
) -> tuple[Array, float]:  # fmt: skip
    """Average the covariance of a lens over models with more terms, equally likely before.

    Args:
        lens: fx, fy, cx, cy, k1, k2, p1, p2, k3 as fitted, zero for terms that were left out,
            shape (9,).
        covariance: Their covariance, zero for the same, shape (9, 9).
        fitted: Indices of the parameters that were fitted.
        general: Parameters of a fit of all terms, shape (9,).
        general_covariance: Their covariance, shape (9, 9).

    Returns:
        The covariance about `lens`, shape (9, 9), and the probability that none of the terms left
        out matters.
    """
    x = [term for term in PRIOR_SD if term not in fitted]
    if not x:
        return covariance, 1.0
    added = {frozenset(radial + tangential) - set(fitted)
             for radial, tangential in product(_RADIAL, _TANGENTIAL)}  # fmt: skip
    found, C_x = general[x], general_covariance[:, x]
    logs, estimates, covariances = [], [], []
    for terms in sorted(added, key=len):  # none first
        sd = np.array([PRIOR_SD[term] if term in terms else 0.0 for term in x])
        spread = C_x[x] + np.diag(sd**2)
        gain = np.linalg.solve(spread, C_x.T).T
        logs.append(-0.5 * float(
            found @ np.linalg.solve(spread, found) + np.linalg.slogdet(spread)[1]
        ))  # fmt: skip
        estimates.append(general - gain @ found)
        covariances.append(general_covariance - gain @ C_x.T)
    probable = np.exp(np.array(logs) - max(logs))
    probable /= probable.sum()
    estimates[0], covariances[0] = lens, covariance
    away = np.array(estimates) - lens
    mean = np.einsum("m,mij->ij", probable, covariances)
    return mean + np.einsum("m,mi,mj->ij", probable, away, away), float(probable[0])
