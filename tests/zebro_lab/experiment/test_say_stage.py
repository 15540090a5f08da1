# SPDX-License-Identifier: MIT
"""A running experiment is commanded from elsewhere; an emergency stop reaches it by two ways."""

import json
import time

import pytest
from typer.testing import CliRunner

from rig.errors import LinkError, ProtocolError
from rig.experiment.control import Control
from rig.experiment.control_server import ControlServer
from rig.safety import StopCategory
from support.floods import flooded
from zebro_lab.experiment.journal import read_journal
from zebro_lab.experiment.latch import LATCH_FILE, EmergencyLatch
from zebro_lab.experiment.say_stage import CONTROL_FILE, command_run
from zebro_lab.main import app

SAID = [
    ("emergency", "requested by rig say"),
    ("emergency ", "requested by rig say"),
    (" EMERGENCY\tsmoke", "smoke"),
    ("emergency smoke\nand\u2028fire\r\n", "smoke and fire"),
    ("emergency caf\udce9", r"caf\udce9"),
    ("emergency " + "x" * 10_000, "x" * 256),
    ("emergency note TOKEN status", "note TOKEN status"),
]


@pytest.fixture(name="served")
def _served(tmp_path):
    """Return the mailbox of an experiment in `tmp_path` that has its latch and its socket."""
    control = Control()
    EmergencyLatch(tmp_path).prepare()
    with ControlServer(control) as server:
        address = {"port": server.port, "token": server.token}
        (tmp_path / CONTROL_FILE).write_text(json.dumps(address))
        yield control


@pytest.mark.parametrize(("command", "reason"), SAID)
def test_an_emergency_stop_with_any_text_goes_by_the_latch_and_the_socket(
    served, tmp_path, command, reason
):
    reply = command_run(tmp_path, command)
    assert f"emergency stop by {LATCH_FILE} and {CONTROL_FILE}" in reply
    assert EmergencyLatch(tmp_path).reason == reason
    assert served.stop.pending.category is StopCategory.EMERGENCY
    assert served.stop.pending.reason in {reason, "requested by socket"}


def test_words_that_look_like_options_are_part_of_the_reason(served, tmp_path):
    words = ["emergency", "--smoke", "-x", "", "--data", str(tmp_path)]
    done = CliRunner().invoke(app, ["rig", "say", *words])
    assert done.exit_code == 0, done.output
    assert EmergencyLatch(tmp_path).reason == "--smoke -x"


def test_a_mistyped_option_of_another_command_is_refused(served, tmp_path):
    done = CliRunner().invoke(app, ["rig", "say", "safe", "--dtaa", "x", "--data", str(tmp_path)])
    assert (done.exit_code, served.stop.pending) == (2, None)


def test_other_commands_are_not_latched(served, tmp_path):
    assert command_run(tmp_path, "note no emergency") == "done"
    command_run(tmp_path, "safe")
    with pytest.raises(ProtocolError, match="cannot execute"):
        command_run(tmp_path, "emergencies")
    assert EmergencyLatch(tmp_path).reason is None


def test_a_stop_that_has_one_way_left_says_which_failed(served, tmp_path):
    (tmp_path / LATCH_FILE).unlink()
    assert f"not by {LATCH_FILE}" in command_run(tmp_path, "emergency")
    assert served.stop.latched
    EmergencyLatch(tmp_path).prepare()
    (tmp_path / CONTROL_FILE).write_text('{"port": 1, "token": "t"}')
    assert f"not by {CONTROL_FILE}: no experiment answers" in command_run(tmp_path, "emergency")
    for file in tmp_path.iterdir():
        file.unlink()
    with pytest.raises(LinkError, match=r"no emergency stop.*no experiment is running here"):
        command_run(tmp_path, "emergency")


def stop_in_a_flood(lab, plan, data, *, before=lambda: None):
    """Run a plan that, at its second point, is flooded by clients, and then stopped."""
    control = Control()

    def flood_and_stop():
        port = json.loads((data / CONTROL_FILE).read_text())["port"]
        with flooded(port, idle=100, talking=20):
            time.sleep(0.1)
            before()
            assert f"emergency stop by {LATCH_FILE}" in command_run(data, "emergency smoke")
            end = time.monotonic() + 10
            while not control.stop.latched and time.monotonic() < end:
                time.sleep(0.01)

    return lab.run(plan, data, watcher=lab.StopAfter(2, flood_and_stop), control=control)


@pytest.mark.parametrize("socket_is_dead", [False, True])
def test_an_emergency_stop_passes_clients_without_a_token(lab, plan, tmp_path, socket_is_dead):
    data = tmp_path / "data"
    kill = (data / CONTROL_FILE).unlink if socket_is_dead else lambda: None
    outcome = stop_in_a_flood(lab, plan, data, before=kill)
    assert outcome.reason == "emergency stop: smoke"
    assert read_journal(data).latched == "emergency stop: smoke"
