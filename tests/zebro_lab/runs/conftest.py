# SPDX-License-Identifier: MIT
"""A recorded run that tests of runs share."""

import pytest

from support.watchers import Onlooker
from zebro_lab.recording.request import RecordRequest
from zebro_lab.recording.stage import record


@pytest.fixture(scope="session")
def recorded(tmp_path_factory):
    """Return a run of all devices, two seconds long."""
    data = tmp_path_factory.mktemp("runs")
    request = RecordRequest("all", data, zebro="sim", imus=("sim",), rig="sim", duration=2.0)
    return record(request, Onlooker()).folder
