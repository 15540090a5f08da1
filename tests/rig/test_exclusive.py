# SPDX-License-Identifier: MIT
"""A device has one owner among all programs of a machine, until that program is over."""

import signal
import subprocess
import sys

import can
import pytest

from rig.errors import InUse, LinkError
from rig.exclusive import Exclusive, device_lock
from rig.links.can import CanLink
from rig.links.serial import SerialLink
from rig.links.serve import PortServer
from rig.links.udp import UdpLink

HOLD = """
import sys, can
from rig.links.can import CanLink
from rig.links.serial import SerialLink
from rig.links.udp import UdpLink
can.Bus = lambda **_: can.interface.Bus(interface="virtual", channel="held")
link = {link}
link.open()
print("open", flush=True)
sys.stdin.read()
link.close()
"""


class Silent:
    """A twin that says nothing; satisfies `ByteTwin`."""

    source = "sim:nothing"

    def poll(self, now, received):
        return b""


@pytest.fixture(name="bus", autouse=True)
def _bus(monkeypatch):
    """Let every CAN channel be a virtual one."""
    monkeypatch.setattr(
        can, "Bus", lambda **_: can.interface.Bus(interface="virtual", channel="here")
    )


def hold(link):
    """Start a program that keeps a link open."""
    process = subprocess.Popen(
        [sys.executable, "-c", HOLD.format(link=link)], stdin=subprocess.PIPE,
        stdout=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert process.stdout.readline() == "open\n"
    return process


def require_one_owner(expression, link):
    process = hold(expression)
    try:
        with pytest.raises(LinkError, match=rf"in use by process {process.pid} \(.*python"):
            link.open()
    finally:
        link.close()
        process.send_signal(signal.SIGKILL)
        process.communicate()
    link.open()  # the system let go of it when its owner died
    link.close()


@pytest.mark.parametrize("channel", ["socketcan:can7", "slcan:/dev/ttyACM7"])
def test_a_bus_in_use_is_refused_with_its_owner(channel):
    require_one_owner(f"CanLink({channel!r})", CanLink(channel))


def test_a_load_cell_in_use_is_refused_with_its_owner():
    require_one_owner("UdpLink('127.0.0.1', 49999)", UdpLink("127.0.0.1", 49999))


def test_a_serial_port_in_use_is_refused_with_its_owner_under_another_name(tmp_path):
    with PortServer(Silent()) as server:
        other = tmp_path / "other-name"
        other.symlink_to(server.port)
        link = SerialLink(str(other), baudrate=115_200)
        require_one_owner(f"SerialLink({server.port!r}, baudrate=115_200)", link)


def test_twins_whose_terminals_had_one_number_are_two_devices(tmp_path):
    """A link that waits for its twin does not block the next twin with the same number."""
    names = [tmp_path / name for name in ("gone", "next", "other-name-of-gone")]
    for name, target in zip(names, ("/dev/pts/7", "/dev/pts/7", names[0]), strict=True):
        name.symlink_to(target)
    gone, following, same = (device_lock(str(name)) for name in names)
    code = (
        f"import sys; from rig.exclusive import device_lock; device_lock({str(names[0])!r}).take()"
    )
    waiting = subprocess.Popen(
        [sys.executable, "-c", f"{code}; print('taken', flush=True); sys.stdin.read()"],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert waiting.stdout.readline() == "taken\n"
    try:
        with following:
            pass
        for lock in (gone, same):
            with pytest.raises(InUse):
                lock.take()
    finally:
        waiting.communicate("")


def test_arguments_of_a_foreign_encoding_do_not_keep_a_device_from_its_user(tmp_path, monkeypatch):
    monkeypatch.setattr("sys.argv", ["zebro-lab", "record", "--label", "caf\udce9"])
    with device_lock(str(tmp_path / "tty\udcff")):
        pass
    with (
        Exclusive(tmp_path / "lock", what="it"),
        pytest.raises(InUse, match=r"record --label .*caf.udce9"),
    ):
        Exclusive(tmp_path / "lock", what="it").take()
