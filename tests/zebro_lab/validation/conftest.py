# SPDX-License-Identifier: MIT
"""A predicted and tracked walk, and its validation, which tests share."""

import pytest

from support.validated_walks import predicted, write_walk_data
from support.watchers import Nobody
from zebro_lab.validation.request import ValidateRequest
from zebro_lab.validation.stage import validate


@pytest.fixture(scope="session")
def walk(tmp_path_factory):
    """Return a folder with legs.csv, track/track.csv and prediction/."""
    folder = tmp_path_factory.mktemp("walk")
    legs, track = write_walk_data(folder)
    (folder / "columns.toml").write_text('source = "sim:legs"\n[legs]\n')
    (folder / "track").mkdir()
    track.rename(folder / "track" / "track.csv")
    predicted(folder, legs)
    return folder


@pytest.fixture(scope="session")
def validated(walk):
    request = ValidateRequest((walk,), out=walk / "validation")
    return validate(request, Nobody())
