# SPDX-License-Identifier: MIT
"""Workers are processes of this machine or those of a scheduler, not both."""

import pytest

from zebro_lab.files.errors import SettingsError
from zebro_lab.workers.request import CoresRequest, WorkersRequest


def test_processes_beside_a_scheduler_are_wrong_usage():
    WorkersRequest(processes=3)
    WorkersRequest(scheduler="tcp://127.0.0.1:8786")
    with pytest.raises(SettingsError, match="--processes"):
        WorkersRequest(processes=3, scheduler="tcp://127.0.0.1:8786")


@pytest.mark.parametrize("request_type", [WorkersRequest, CoresRequest])
def test_a_wrong_address_is_wrong_usage(request_type):
    with pytest.raises(SettingsError, match="--scheduler: found 'here'"):
        request_type(scheduler="here")


def test_all_cores_are_used_unless_said(monkeypatch):
    monkeypatch.setattr("os.cpu_count", lambda: 5)
    assert CoresRequest().cores == 5
    assert CoresRequest(2, "tcp://127.0.0.1:8786").cores == 2
