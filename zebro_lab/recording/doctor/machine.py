# SPDX-License-Identifier: MIT
"""Check serial ports, CAN interfaces, UDP buffer and disk of this machine."""

import os
import shutil
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Final

from zebro_lab.recording.doctor.finding import Finding, Grade
from zebro_lab.recording.recorder import LEAST_FREE

COMFORTABLE: Final = 2 << 30
"""Free space below which a warning is given: hours of recording [bytes]."""
UDP_BUFFER: Final = 4 << 20
"""Size of the socket buffer that `rig.links.udp` requests [bytes]."""
NET: Final = Path("/sys/class/net")
CAN_TYPE: Final = "280"
"""Hardware type of a CAN interface in Linux."""


def check_serial_ports() -> Iterator[Finding]:
    """Yield a finding for each serial port, NOTE where it may not be opened or none is found."""
    from serial.tools import list_ports

    ports = sorted(list_ports.comports())
    if not ports:
        yield Finding(Grade.NOTE, "serial ports", "none found; connect the device, or simulate "
                      "one with `zebro-lab sim zebro`")  # fmt: skip
    for port in ports:
        yield check_port(Path(port.device), port.description)


def check_port(
    device: Path, description: str, *, may: Callable[[Path, int], bool] = os.access
) -> Finding:
    """Check the permission to read and write one serial port; NOTE without it, else OK.

    On Windows the result is always OK.

    Args:
        device: Path of the port.
        description: Description of the port by the operating system.
        may: Returns whether a file can be accessed in a mode, as `os.access`.
    """
    what = f"serial port {device}"
    if sys.platform == "win32" or may(device, os.R_OK | os.W_OK):
        return Finding(Grade.OK, what, f"{description}; you may read and write it")
    group = _group(device)
    return Finding(
        Grade.NOTE, what,
        f"{description}; you may not read and write it. Join the group {group}, which may: run "
        f"`sudo usermod -aG {group} $USER`, then log in again",
    )  # fmt: skip


def check_can(net: Path) -> Iterator[Finding]:
    """Yield a finding for each CAN interface of Linux, NOTE where it is down or none is found.

    Args:
        net: Folder of the system's network interfaces, `/sys/class/net`.
    """
    found = [place for place in sorted(net.glob("*")) if _read(place / "type") == CAN_TYPE]
    if not found:
        yield Finding(
            Grade.NOTE, "CAN", "no CAN interface found; a serial adapter (PROFILE@slcan:/dev/tty…) "
            "or a simulated device (`zebro-lab sim rig rig-odrive-netft`) needs none",
        )  # fmt: skip
    for place in found:
        up = int(_read(place / "flags") or "0", 16) & 1
        name = place.name
        text = f"is up; its address is PROFILE@socketcan:{name}" if up else (
            f"is down; run `sudo ip link set {name} up type can bitrate 1000000`")  # fmt: skip
        yield Finding(Grade.OK if up else Grade.NOTE, f"CAN {name}", text)


def check_udp(limit: Path) -> Iterator[Finding]:
    """Check that the largest UDP receive buffer of the system is at least `UDP_BUFFER`, else NOTE.

    Args:
        limit: File in which Linux gives the size [bytes]; nothing is yielded if it is unreadable.
    """
    text = _read(limit)
    if text is None:
        return
    granted = int(text)
    if granted >= UDP_BUFFER:
        yield Finding(Grade.OK, "UDP buffer", f"the system allows {granted >> 10} KiB")
        return
    yield Finding(
        Grade.NOTE, "UDP buffer",
        f"the system allows {granted >> 10} KiB; a busy computer may lose samples of a load cell "
        f"at 7 kHz. Run `sudo sysctl net.core.rmem_max={UDP_BUFFER}`",
    )  # fmt: skip


def check_disk(data: Path) -> Finding:
    """Check write permission and free disk space for recordings.

    BROKEN without permission or below `LEAST_FREE`, NOTE below `COMFORTABLE`, else OK.

    Args:
        data: Folder for recordings; where it does not exist, its nearest parent is checked.
    """
    place = next(
        folder for folder in (data.absolute(), *data.absolute().parents) if folder.is_dir()
    )
    free = shutil.disk_usage(place).free
    text = f"{free / 1e9:.1f} GB free at {place}"
    if not os.access(place, os.W_OK):
        return Finding(Grade.BROKEN, "disk", f"{place} is not writable; choose another --data")
    if free < LEAST_FREE:
        return Finding(Grade.BROKEN, "disk", f"{text}; recording needs {LEAST_FREE / 1e6:.0f} MB")
    if free < COMFORTABLE:
        return Finding(Grade.NOTE, "disk", f"{text}; a load cell at 7 kHz takes 0.3 GB an hour")
    return Finding(Grade.OK, "disk", text)


def _group(device: Path) -> str:
    try:
        return device.group()
    except (OSError, KeyError, NotImplementedError):
        return "dialout"


def _read(file: Path) -> str | None:
    try:
        return file.read_text(encoding="ascii").strip()
    except (OSError, UnicodeDecodeError):
        return None
