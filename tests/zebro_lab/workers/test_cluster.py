# SPDX-License-Identifier: MIT
"""A Dask cluster gives the same numbers, also where a worker is lost; what is wrong is one line."""

import socket
import sys
import time

import pytest

from model.mapping import Here
from support.mapped_tasks import die_once, normal
from zebro_lab.files.errors import SettingsError
from zebro_lab.files.provenance import software
from zebro_lab.workers import cluster
from zebro_lab.workers.cluster import ClusterError, compute, differing, open_cluster

NOBODY = "tcp://127.0.0.1:1"


def test_a_difference_of_versions_is_named():
    assert differing({"w": {"numpy": "2.1"}}, {"numpy": "2.1"}) == ""
    assert differing({"w": {}}, {"numpy": "2.1"}).startswith("w has numpy missing")


def test_a_worker_that_came_later_with_other_versions_refuses_its_task():
    assert compute(normal, 1.0, 2, software()) == normal(1.0, 2)
    with pytest.raises(ClusterError, match="a worker has numpy"):
        compute(normal, 1.0, 2, {**software(), "numpy": "0.1"})


def test_without_dask_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with (
        pytest.raises(SettingsError, match=r"pip install 'zebro-lab\[cluster\]'"),
        open_cluster(NOBODY),
    ):
        pass


def test_a_scheduler_outside_is_refused_before_anything_is_sent(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(SettingsError, match="use tls"), open_cluster("tcp://8.8.8.8:8786"):
        pass


@pytest.mark.long
class TestRealCluster:
    """Claims that need a scheduler and workers, of which each takes seconds to start."""

    @pytest.fixture(autouse=True)
    def _needs_dask(self):
        pytest.importorskip("distributed")

    @pytest.fixture
    def local(self):
        from distributed import LocalCluster

        with LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as found:
            yield found

    @pytest.mark.filterwarnings("ignore")
    def test_nobody_answers_within_seconds(self, monkeypatch):
        monkeypatch.setattr(cluster, "ANSWERS_WITHIN", 1.0)
        began = time.monotonic()
        with pytest.raises(ClusterError, match="no Dask scheduler answers"), open_cluster(NOBODY):
            pass
        assert time.monotonic() - began < 5

    @pytest.mark.filterwarnings("ignore")
    def test_another_program_at_the_port_is_no_scheduler(self, monkeypatch):
        monkeypatch.setattr(cluster, "ANSWERS_WITHIN", 1.0)
        with socket.create_server(("127.0.0.1", 0)) as server:
            address = f"tcp://127.0.0.1:{server.getsockname()[1]}"
            with pytest.raises(ClusterError, match="no Dask scheduler"), open_cluster(address):
                pass

    @pytest.mark.filterwarnings("ignore")
    def test_a_killed_workers_tasks_are_done_again_with_the_same_numbers(self, local, tmp_path):
        with open_cluster(local.scheduler_address) as workers:
            found = list(workers.map(die_once, str(tmp_path), range(12)))
        assert (tmp_path / "died").exists()
        assert found == list(Here().map(normal, 1.0, range(12)))

    @pytest.mark.filterwarnings("ignore")
    def test_workers_with_other_versions_are_refused(self, local, monkeypatch):
        monkeypatch.setattr("zebro_lab.files.provenance.version", lambda _: "0.1")
        with (
            pytest.raises(ClusterError, match=r"has zebro-lab .* and this machine 0\.1"),
            open_cluster(local.scheduler_address),
        ):
            pass
