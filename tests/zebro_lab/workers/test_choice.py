# SPDX-License-Identifier: MIT
"""One process computes here, several beside, and a scheduler elsewhere."""

from contextlib import nullcontext

from model.mapping import Here
from zebro_lab.workers.choice import open_workers
from zebro_lab.workers.machine import Cores
from zebro_lab.workers.processes import Processes
from zebro_lab.workers.request import CoresRequest, WorkersRequest


def test_the_request_says_where(monkeypatch):
    monkeypatch.setattr("os.cpu_count", lambda: 5)
    for request, expected in (
        (WorkersRequest(), Processes(5)),
        (WorkersRequest(processes=2), Processes(2)),
        (CoresRequest(), Cores(5)),
        (CoresRequest(2), Cores(2)),
    ):
        with open_workers(request) as workers:
            assert workers == expected
    for request in (WorkersRequest(processes=1), CoresRequest(1)):
        with open_workers(request) as workers:
            assert isinstance(workers, Here)


def test_a_scheduler_is_opened_by_its_address(monkeypatch):
    monkeypatch.setattr("zebro_lab.workers.cluster.open_cluster", nullcontext)
    for request in (WorkersRequest, CoresRequest):
        with open_workers(request(scheduler="tcp://127.0.0.1:1")) as workers:
            assert workers == "tcp://127.0.0.1:1"
