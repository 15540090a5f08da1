# SPDX-License-Identifier: MIT
"""A second `rig run` on one rig is refused in words, wherever it comes from."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from rig.errors import RigError
from rig.links.serve import PortServer
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.profile import load_rig_profile
from rig.slip_rig.simulated import RigDynamics, SimulatedRig
from rig.slip_rig.simulated_board import SimulatedBoard
from rig.slip_rig.sweep import SweepPlan
from support.commands import started
from support.experiment_plans import short_plan
from zebro_lab.experiment.say_stage import command_run
from zebro_lab.files.errors import NotFound

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(sys.platform != "linux", reason="needs abstract Unix sockets"),
]
ROOT = pytest.mark.skipif(
    getattr(os, "geteuid", int)() != 0, reason="only root becomes another user, or mounts"
)
OWN = "/var/tmp" if sys.executable.startswith("/tmp/") else "/tmp"  # noqa: S108
TIMES = 20

AGAIN = """
import os, sys
from zebro_lab.main import main
user, times, place, *arguments = sys.argv[1:]

def run(number):
    sys.argv = ["zebro-lab", "rig", "run", *arguments, "--data", f"{place}/{number}"]
    try:
        main()
    except SystemExit as left:
        print(f"code {left.code}", file=sys.stderr, flush=True)

run("first")  # has everything imported, which another user may not read
for number in range(int(times)):
    child = os.fork()
    if child == 0:
        os.setuid(int(user))
        run(number)
        os._exit(0)
    os.waitpid(child, 0)
"""


@pytest.fixture(name="place")
def _place(monkeypatch):
    """Return a folder for everybody that is not in `OWN`, where the twin's port is, too."""
    shared = "/tmp" if OWN == "/var/tmp" else "/var/tmp"  # noqa: S108
    with tempfile.TemporaryDirectory(dir=shared, prefix="zebro-lab-owners-") as place:
        monkeypatch.setattr(tempfile, "tempdir", place)
        os.chmod(place, 0o777)  # noqa: PTH101, S103
        yield Path(place)


@contextmanager
def owned_rig(place):
    """Yield the arguments of a `rig run` that has its rig, and waits for the operator."""
    profile, rng = load_rig_profile("rig-board-serial").board, np.random.default_rng(0)
    rig = SimulatedRig(plan=SweepPlan(), imperfections=TYPICAL_RIG, dynamics=RigDynamics(), rng=rng)
    rig.load = 5.0  # never unloaded: the operator is asked for ever
    with PortServer(SimulatedBoard(rig, profile=profile, rng=rng)) as server:
        Path(server.port).parent.chmod(0o755)
        arguments = [str(short_plan(place)), "--rig", f"rig-board-serial@{server.port}"]
        with started("rig", "run", *arguments, "--data", place / "owner") as owner:
            wait_for_prompt(owner, place / "owner")
            yield owner, arguments
            assert owner.poll() is None
            assert "then confirm" in command_run(place / "owner", "status")


def wait_for_prompt(process, data, longest=60.0):
    """Wait until an experiment asks its operator for something."""
    end = time.monotonic() + longest
    while time.monotonic() < end:
        assert process.poll() is None
        try:
            if "then confirm" in command_run(data, "status"):
                return
        except (NotFound, RigError):
            pass
        time.sleep(0.1)
    pytest.fail("the experiment does not ask for anything")


def in_another_tmpdir(place):
    (place / "own").mkdir()
    return [], {"TMPDIR": str(place / "own")}, "0"


def as_another_user(place):
    return [], {}, "65534"


def in_a_mount_namespace(place):
    own = f'mount -t tmpfs none {OWN} && exec "$@"'
    command = ["unshare", "--mount", "sh", "-c", own, "sh"]
    if subprocess.run([*command, "true"], capture_output=True).returncode:
        pytest.skip("mount namespaces are not permitted here")
    return command, {}, "0"


def after_lock_files_are_deleted(place):
    for folder in (Path("/tmp"), place):  # noqa: S108
        for lock in folder.glob("zebro-lab-lock*"):
            shutil.rmtree(lock) if lock.is_dir() else lock.unlink()
    for file in (place / "owner").glob(".*"):
        file.unlink()
    return [], {}, "0"


@pytest.mark.parametrize(
    "elsewhere",
    [
        in_another_tmpdir,
        pytest.param(as_another_user, marks=ROOT),
        pytest.param(in_a_mount_namespace, marks=ROOT),
        after_lock_files_are_deleted,
    ],
)
def test_a_second_run_is_refused_with_the_owner_of_the_rig(place, elsewhere):
    with owned_rig(place) as (owner, arguments):
        before, environment, user = elsewhere(place)
        code = [sys.executable, "-c", AGAIN, user, str(TIMES), str(place / "again"), *arguments]
        (place / "again").mkdir()
        (place / "again").chmod(0o777)
        done = subprocess.run(
            [*before, *code], env=os.environ | environment, capture_output=True, text=True,
            timeout=300,
        )  # fmt: skip
        refused = rf"port is in use by process {owner.pid} \(.*rig run .*\)[^\n]*\ncode 1\n"
        assert len(re.findall(refused, done.stderr)) == TIMES + 1, done.stderr


def test_a_second_run_into_the_folder_is_refused_with_the_owner_of_the_experiment(place):
    with owned_rig(place) as (owner, _):
        after_lock_files_are_deleted(place)
        for _ in range(TIMES // 5):
            again = ["--rig", "sim", "--data", str(place / "owner"), "--resume"]
            with started("rig", "run", str(place / "plan.toml"), *again) as process:
                _, said = process.communicate(timeout=60)
            assert process.returncode == 1
            assert re.search(rf"is in use by process {owner.pid} \(.*rig run", said), said
