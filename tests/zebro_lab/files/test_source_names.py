# SPDX-License-Identifier: MIT
"""The name of a run's source tells what is simulated and what is not."""

from pathlib import Path

import pytest

from zebro_lab.files.source_names import joined_source, stated_source


@pytest.mark.parametrize(
    ("sources", "joined"),
    [
        (["real"], "real"),
        (["real", "real"], "real"),
        (["sim:zebro"], "sim:zebro"),
        (["sim:zebro", "sim:imu", "sim:zebro"], "sim:zebro+imu"),
        (["replay:a", "replay:b"], "replay:a+b"),
        (["real", "sim:imu"], "mixed:real,sim:imu"),
        (["sim:imu", "replay:a"], "mixed:sim:imu,replay:a"),
    ],
)
def test_sources_of_one_kind_are_joined_in_that_kind_others_are_mixed(sources, joined):
    assert joined_source(sources) == joined


@pytest.mark.parametrize(
    ("stated", "source"),
    [("real", "real"), ("sim:x", "sim:x"), (None, "import:a.csv"), ("unknown", "import:a.csv")],
)
def test_a_file_that_does_not_state_its_source_is_its_source(stated, source):
    assert stated_source(stated, Path("folder/a.csv")) == source
