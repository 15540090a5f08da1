# SPDX-License-Identifier: MIT
import math

import pytest

from model.errors import DomainError
from model.lateral_spread import ANISOTROPY, log_spread


def test_a_factor_of_one_is_no_spread():
    assert log_spread(1.0) == 0.0
    assert math.exp(log_spread(ANISOTROPY)) == pytest.approx(ANISOTROPY)


@pytest.mark.parametrize("factor", [0.9, -1.0, math.inf, math.nan])
def test_a_factor_below_one_or_infinite_is_an_error(factor):
    with pytest.raises(DomainError, match="anisotropy"):
        log_spread(factor)
