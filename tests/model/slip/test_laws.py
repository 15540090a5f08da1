# SPDX-License-Identifier: MIT
from dataclasses import asdict

import pytest

from model.errors import DomainError
from model.slip.laws import LAWS, slip_law


@pytest.mark.parametrize("name", LAWS)
def test_a_law_comes_back_from_its_name_and_fields(name):
    law = slip_law(name)
    assert slip_law(law.name, **asdict(law)) == law
    assert isinstance(law, LAWS[name])


@pytest.mark.parametrize(
    ("name", "options", "nearest"),
    [
        ("brus", {}, "did you mean 'brush'"),
        ("coulomb-stribeck", {"stribek": True}, "did you mean 'stribeck'"),
    ],
)
def test_an_unknown_name_names_the_nearest(name, options, nearest):
    with pytest.raises(DomainError, match=nearest):
        slip_law(name, **options)
