# SPDX-License-Identifier: MIT
"""A request parses its targets at once, and names all that it reads."""

from pathlib import Path

import pytest
from typer import BadParameter

from zebro_lab.suggest.request import SuggestRequest


def test_a_walk_is_an_input():
    request = SuggestRequest(Path("p.toml"), Path("c"), ("friction", "walk:run"))
    assert request.inputs == (Path("p.toml"), Path("c"), Path("run"))


def test_a_target_of_no_form_is_refused():
    with pytest.raises(BadParameter, match="'force@' is no target"):
        SuggestRequest(Path("p.toml"), Path("c"), ("force@",))
