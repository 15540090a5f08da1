# SPDX-License-Identifier: MIT
"""The doctor finds nothing broken on a machine that runs the tests."""

from zebro_lab.recording.doctor.finding import Grade
from zebro_lab.recording.doctor.stage import examine


def test_this_machine_has_all_that_is_needed(tmp_path):
    found = list(examine(tmp_path))
    assert Grade.BROKEN not in {each.state for each in found}
    assert {"python", "packages", "disk"} <= {each.what for each in found}
