# SPDX-License-Identifier: MIT
"""Check packages, serial ports, CAN interfaces and disk of this machine."""

import os
import platform
import shutil
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, distributions, requires, version
from importlib.util import find_spec
from pathlib import Path
from typing import Final, Literal

from packaging.requirements import Requirement
from serial.tools import list_ports

from zebro_lab.recording.recorder import LEAST_FREE

SHADOWED: Final = {"serial": "pyserial", "can": "python-can", "cv2": "opencv-python-headless"}
"""Modules whose names other packages use too, and the package that each must come from."""


@dataclass(frozen=True)
class Finding:
    """Result of one check.

    Attributes:
        state: `ok`, `note` (matters to some), or `BROKEN` (a needed part is missing).
        what: Subject of the check, such as `disk` or `CAN can0`.
        text: What was found; unless `ok`, also the remedy.
    """

    state: Literal["ok", "note", "BROKEN"]
    what: str
    text: str


def examine(data: Path) -> Iterator[Finding]:
    """Run every check of this machine and yield the findings.

    If zebro-lab is not installed, its requirements are not known, and not checked.

    Args:
        data: Folder for recordings; need not exist.
    """
    place = Path(__file__).parents[2]
    try:
        used, needed = version("zebro-lab"), requires("zebro-lab") or ()
    except PackageNotFoundError:
        text = f"in {place} is not installed; run `pip install -e {place}`"
        yield Finding("BROKEN", "zebro-lab", text)
    else:
        text = f"{used} from {place}, Python {platform.python_version()}"
        yield Finding("ok", "zebro-lab", text)
        yield from check_requirements(needed)
    yield from check_shadows()
    yield from check_serial_ports()
    yield from check_can(Path("/sys/class/net"))
    yield check_disk(data)


def check_requirements(needed: Sequence[str]) -> Iterator[Finding]:
    """Yield BROKEN for each required package that is missing or too old or new, then one `ok`.

    The latter lists the packages that fit, also if others are broken.

    Args:
        needed: Requirements in the format of package metadata; those of extras are skipped.
    """
    fitting = []
    for each in map(Requirement, needed):
        if each.marker is not None and not each.marker.evaluate({"extra": ""}):
            continue
        found = next((found.version for found in distributions(name=each.name)), "none")
        if found != "none" and each.specifier.contains(found, prereleases=True):
            fitting.append(f"{each.name} {found}")
        else:
            text = f"found version {found}, expected {each.specifier}; run `pip install '{each}'`"
            yield Finding("BROKEN", each.name, text)
    yield Finding("ok", "packages", ", ".join(fitting))


def check_shadows() -> Iterator[Finding]:
    """Yield BROKEN for each `SHADOWED` module whose name finds something else, or nothing.

    The right ones are packages, found by their `__init__.py`.
    """
    for module, package in SHADOWED.items():
        spec = find_spec(module)
        found = spec and (spec.origin or list(spec.submodule_search_locations or ()))
        if not str(found).endswith("__init__.py"):
            mend = f"rename that, or run `pip install --force-reinstall {package}`"
            text = f"is not {package}'s but {found}; {mend}"
            yield Finding("BROKEN", f"module {module}", text)


def check_serial_ports(*, may: Callable[[str, int], bool] = os.access) -> Iterator[Finding]:
    """Yield a finding for each serial port; a note where it may not be opened or none is found.

    Args:
        may: Returns whether a file can be accessed in a mode, as `os.access`.
    """
    ports = sorted(list_ports.comports())
    if not ports:
        text = "none found; connect the device, or simulate one with `zebro-lab sim zebro`"
        yield Finding("note", "serial ports", text)
    for port in ports:
        what = f"serial port {port.device}"
        if platform.system() == "Windows" or may(port.device, os.R_OK | os.W_OK):
            yield Finding("ok", what, f"{port.description}; you may read and write it")
        else:
            text = "may not be opened by you; run `sudo usermod -aG dialout $USER`, log in again"
            yield Finding("note", what, text)


def check_can(net: Path) -> Iterator[Finding]:
    """Yield a finding for each CAN interface of Linux; a note where it is down or none is found.

    Args:
        net: Folder of the system's network interfaces, `/sys/class/net`.
    """
    types = sorted(net.glob("*/type"))
    found = [
        file.parent for file in types if file.read_text(encoding="utf-8").strip() == "280"
    ]  # ARPHRD_CAN
    if not found:
        text = "no CAN interface found; a serial adapter (PROFILE@slcan:/dev/tty…) needs none"
        yield Finding("note", "CAN", text)
    for place in found:
        what = f"CAN {place.name}"
        if int((place / "flags").read_text(encoding="utf-8"), 16) & 1:
            yield Finding("ok", what, f"is up; its address is PROFILE@socketcan:{place.name}")
        else:
            command = f"sudo ip link set {place.name} up type can bitrate 1000000"
            yield Finding("note", what, f"is down; run `{command}`")


def check_disk(data: Path) -> Finding:
    """Check write permission and free disk space for recordings.

    BROKEN without permission or below the space that a recording needs to start.

    Args:
        data: Folder for recordings; where it does not exist, its nearest parent is checked.
    """
    place = data.absolute()
    while not place.is_dir():
        place = place.parent
    free = shutil.disk_usage(place).free
    if not os.access(place, os.W_OK):
        return Finding("BROKEN", "disk", f"{place} is not writable; choose another --data")
    text = f"{free / 1e9:.1f} GB free at {place}; a load cell at 7 kHz takes 0.3 GB an hour"
    return Finding("ok" if free >= LEAST_FREE else "BROKEN", "disk", text)
