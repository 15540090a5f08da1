# SPDX-License-Identifier: MIT
"""A device has one owner among all programs of a machine, until that program is over."""

import os
import signal
import subprocess
import sys

import can
import pytest

from rig import exclusive
from rig.errors import InUse, LinkError
from rig.exclusive import device_lock, folder_lock
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


def start(code, *arguments, before=(), **options):
    """Start a program that says that it is open, and then waits for the end of its input."""
    process = subprocess.Popen(
        [*before, sys.executable, "-c", code, *arguments], stdin=subprocess.PIPE,
        stdout=subprocess.PIPE, text=True, **options,
    )  # fmt: skip
    assert process.stdout.readline() == "open\n"
    return process


def hold(link):
    """Start a program that keeps a link open."""
    return start(HOLD.format(link=link))


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


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost"])
def test_a_load_cell_in_use_is_refused_with_its_owner_by_any_name(host):
    require_one_owner("UdpLink('127.0.0.1', 49999)", UdpLink(host, 49999))


@pytest.mark.parametrize("name", ["socket://localhost:4000", "udp:localhost:4000"])
def test_the_names_of_a_host_are_one_device_and_an_unknown_host_is_one_too(name):
    with device_lock(name.replace("localhost", "127.0.0.1")):
        assert device_lock(name)._name == name.replace("localhost", "127.0.0.1")
    nowhere = name.replace("localhost", "no.such.host.invalid")
    assert device_lock(nowhere)._name == nowhere


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


DEVICE = "udp:192.0.2.1:49152"
HOLD_DEVICE = f"""
import os, sys
from rig.exclusive import device_lock
if sys.argv[1:]:
    os.setuid(int(sys.argv[1]))
device_lock({DEVICE!r}).take()
print("open", flush=True)
sys.stdin.read()
"""
ROOT = pytest.mark.skipif(
    getattr(os, "geteuid", int)() != 0, reason="only root becomes another user, or mounts"
)
OWN = "/var/tmp" if sys.executable.startswith("/tmp/") else "/tmp"  # noqa: S108
LINUX = pytest.mark.skipif(sys.platform != "linux", reason="needs abstract Unix sockets")


def another_tmpdir(tmp_path):
    return start(HOLD_DEVICE, env=os.environ | {"TMPDIR": str(tmp_path)})


def another_user(tmp_path):
    return start(HOLD_DEVICE, "65534")


def another_mount_namespace(tmp_path):
    mount = f'mount -t tmpfs none {OWN} && exec "$@"'
    command = ["unshare", "--mount", "sh", "-c", mount, "sh"]
    if subprocess.run([*command, "true"], capture_output=True, check=False).returncode:
        pytest.skip("mount namespaces are not permitted here")
    return start(HOLD_DEVICE, before=command)


@LINUX
@pytest.mark.parametrize(
    "elsewhere",
    [
        another_tmpdir,
        pytest.param(another_user, marks=ROOT),
        pytest.param(another_mount_namespace, marks=ROOT),
    ],
)
def test_a_device_has_one_owner_among_programs_that_share_no_file(tmp_path, elsewhere):
    process = elsewhere(tmp_path)
    try:
        with pytest.raises(InUse, match=rf"in use by process {process.pid} \(.*python"):
            device_lock(DEVICE).take()
    finally:
        process.communicate("")
    with device_lock(DEVICE):
        pass


def test_a_lock_is_shared_in_its_process_until_the_last_release():
    first, second = device_lock(DEVICE), device_lock(DEVICE)
    first.take()
    second.take()
    first.release()
    first.release()
    with pytest.raises(InUse):
        take_elsewhere()
    second.release()
    take_elsewhere()


def take_elsewhere():
    """Take the lock in another program, and raise what that program says."""
    code = f"from rig.exclusive import device_lock; device_lock({DEVICE!r}).take()"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    if done.returncode:
        raise InUse(done.stderr)


HOLD_FOLDER = """
import sys
from pathlib import Path
from rig.exclusive import folder_lock
folder_lock(Path(sys.argv[1]), what="it").take()
print("open", flush=True)
sys.stdin.read()
"""


def test_a_folder_has_one_owner_whatever_is_done_to_the_files_in_it(tmp_path):
    process = start(HOLD_FOLDER, str(tmp_path), "caf\udce9")
    try:
        for file in tmp_path.iterdir():
            file.unlink()
        other = tmp_path.with_name("other-name")
        other.symlink_to(tmp_path)
        with pytest.raises(InUse, match="it is in use by"):
            folder_lock(other, what="it").take()
    finally:
        process.communicate("")
    with folder_lock(tmp_path, what="it"):
        pass
    assert not list(tmp_path.iterdir())


@LINUX
def test_a_command_of_a_foreign_encoding_is_told_with_its_process(tmp_path):
    process = start(HOLD_FOLDER, str(tmp_path), "caf\udce9\n", "x" * 1000)
    try:
        with pytest.raises(InUse, match=rf"by process {process.pid} \(.*caf..'.*\); end") as said:
            folder_lock(tmp_path, what="it").take()
        assert len(str(said.value)) < 600
    finally:
        process.communicate("")


def test_where_there_are_no_abstract_sockets_a_file_is_the_lock_and_stays_as_it_is(
    tmp_path, monkeypatch
):
    monkeypatch.setattr(exclusive, "_NAMED", False)
    monkeypatch.setattr(exclusive, "_LOCK_FILES", tmp_path)
    process = start(ELSEWHERE, str(tmp_path))
    (file,) = tmp_path.iterdir()
    file.write_text("precious")
    try:
        with pytest.raises(InUse, match="in use by another program"):
            device_lock(DEVICE).take()
    finally:
        process.communicate("")
    with device_lock(DEVICE):
        assert file.read_text() == "precious"
    file.rename(tmp_path / "victim")
    file.symlink_to(tmp_path / "victim")
    with pytest.raises(OSError, match=file.name):
        device_lock(DEVICE).take()


ELSEWHERE = f"""
import sys
from pathlib import Path
from rig import exclusive
exclusive._NAMED = False
exclusive._LOCK_FILES = Path(sys.argv[1])
exclusive.device_lock({DEVICE!r}).take()
print("open", flush=True)
sys.stdin.read()
"""
