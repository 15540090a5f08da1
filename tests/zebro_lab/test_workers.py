# SPDX-License-Identifier: MIT
"""Tasks go to this machine's cores or to a Dask cluster; what is wrong with one is told."""

import os
import signal
import socket
import sys
import threading
import time
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from model.tasks import compute_tasks
from zebro_lab import workers
from zebro_lab.files.errors import SettingsError
from zebro_lab.workers import ClusterError, WorkersRequest, open_executor

NOBODY = "tcp://127.0.0.1:1"


def refused(address, error, match):
    with pytest.raises(error, match=match), open_executor(WorkersRequest(scheduler=address)):
        pass


def test_all_cores_are_used_unless_said(monkeypatch):
    monkeypatch.setattr("os.cpu_count", lambda: 5)
    assert WorkersRequest().cores == 5
    assert WorkersRequest(2, NOBODY).cores == 2
    with open_executor(WorkersRequest(2)) as executor:
        assert list(compute_tasks(executor, abs, [-2, 3, -1])) == [2, 3, 1]


def test_tasks_that_have_not_begun_are_given_up():
    begun, go_on = [], threading.Event()

    def wait(task):
        begun.append(task)
        go_on.wait(5)

    with open_executor(WorkersRequest(1)) as executor:
        compute_tasks(executor, wait, range(9))
        threading.Timer(0.1, go_on.set).start()
    assert len(begun) < 9


@pytest.mark.parametrize(
    "text",
    ["", "127.0.0.1:8786", "http://a:1", "tcp://a", "tcp://a:0", "tcp://:8"],
)
def test_another_form_of_address_is_wrong_usage_with_an_example(text):
    with pytest.raises(SettingsError, match=r"^--scheduler: found '.*tcp://127\.0\.0\.1:8786"):
        WorkersRequest(scheduler=text)


@pytest.mark.parametrize("host", ["127.0.0.1", "192.168.1.7", "10.0.0.1", "[::1]", "[fe80::1]"])
def test_this_machine_and_private_networks_need_no_encryption(host, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    refused(f"tcp://{host}:8786", SettingsError, r"pip install 'zebro-lab\[cluster\]'")


@pytest.mark.parametrize("host", ["8.8.8.8", "[2001:4860:4860::8888]"])
def test_a_scheduler_outside_needs_tls(host, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    refused(f"tcp://{host}:8786", SettingsError, "use tls://")
    refused(f"tls://{host}:8786", SettingsError, r"pip install 'zebro-lab\[cluster\]'")


def test_an_unknown_host_is_named(monkeypatch):
    def unknown(*_, **__):
        raise socket.gaierror("name unknown")

    monkeypatch.setattr(socket, "getaddrinfo", unknown)
    refused("tcp://lab:8786", ClusterError, "tcp://lab:8786: no Dask scheduler answers")


def normal(folder: Path, seed: int) -> float:
    """Return a number that depends on the seed alone; end the first worker that gets the seed 2."""
    mark = folder / "died"
    if seed == 2 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return float(np.random.default_rng(seed).standard_normal())


@pytest.mark.long
@pytest.mark.filterwarnings("ignore")
class TestRealCluster:
    """Claims that need a scheduler and workers, of which each takes seconds to start."""

    @pytest.fixture
    def local(self):
        pytest.importorskip("distributed")
        from distributed import LocalCluster

        with LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as found:
            yield found.scheduler_address

    def test_nobody_answers_within_seconds(self, monkeypatch):
        pytest.importorskip("distributed")
        monkeypatch.setattr(workers, "ANSWERS_WITHIN", 1.0)
        began = time.monotonic()
        refused(NOBODY, ClusterError, "no Dask scheduler answers")
        assert time.monotonic() - began < 5

    def test_a_killed_workers_tasks_are_done_again_with_the_same_numbers(self, local, tmp_path):
        function = partial(normal, tmp_path)
        with open_executor(WorkersRequest(scheduler=local)) as executor:
            found = list(compute_tasks(executor, function, range(12)))
        assert (tmp_path / "died").exists()
        assert found == list(compute_tasks(None, function, range(12)))

    def test_workers_with_other_versions_are_refused(self, local, monkeypatch):
        monkeypatch.setattr("zebro_lab.files.provenance.version", lambda _: "0.1")
        refused(local, ClusterError, r"has zebro-lab .* and this machine 0\.1")
