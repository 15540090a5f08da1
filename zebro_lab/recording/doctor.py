# SPDX-License-Identifier: MIT
"""Diagnose this machine: versions, packages, serial ports, CAN interfaces, UDP buffer, disk."""

import os
import platform
import shutil
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from importlib.machinery import PathFinder
from importlib.metadata import PackageNotFoundError, distribution, packages_distributions, requires
from pathlib import Path
from typing import Final

from packaging.requirements import Requirement

from zebro_lab.recording.recorder import LEAST_FREE

LEAST_PYTHON: Final = (3, 11)
OURS: Final = ("zebro_lab", "rig", "tracking", "model")
FOREIGN: Final = {"serial": "pyserial", "can": "python-can", "cv2": "opencv-python-headless"}
"""Modules whose names several packages use, and the package that each must come from."""
OPTIONAL_PROGRAMS: Final = {
    "ffmpeg": "animations (`--animate`) as mp4; without ffmpeg they are written as gif",
    "heif-convert": "converting HEIC photographs to JPEG by hand, for `track`",
}
OPTIONAL_PACKAGES: Final = {
    "evo": "path errors computed by the program evo from track.tum",
    "mujoco": "regenerating datasets/walk-sim, and for `make bench`",
    "numpyro": "the comparison of samplers in `make bench`",
}
COMFORTABLE: Final = 2 << 30
"""Free space below which a warning is given: hours of recording [bytes]."""
UDP_BUFFER: Final = 4 << 20
"""Size of the socket buffer that `rig.links.udp` requests [bytes]."""
NET: Final = Path("/sys/class/net")
CAN_TYPE: Final = "280"
"""Hardware type of a CAN interface in Linux."""


class Grade(StrEnum):
    """Severity of a finding: OK, NOTE (matters to some), BROKEN (a needed part is missing)."""

    OK = "ok"
    NOTE = "note"
    BROKEN = "BROKEN"


@dataclass(frozen=True)
class Finding:
    """Result of one check.

    Attributes:
        state: Severity.
        what: Subject of the check, such as `python` or `CAN can0`.
        text: What was found; unless OK, also the remedy.
    """

    state: Grade
    what: str
    text: str


def examine(data: Path) -> Iterator[Finding]:
    """Run every check of this machine and yield the findings.

    Args:
        data: Folder for recordings; need not exist.

    Raises:
        PackageNotFoundError: zebro-lab is not installed.
    """
    yield check_python(sys.version_info[:3])
    yield from check_requirements(requires("zebro-lab") or ())
    yield from check_shadows(Path.cwd(), sys.path)
    yield from check_serial_ports()
    yield from check_can(NET)
    yield from check_udp(Path("/proc/sys/net/core/rmem_max"))
    yield check_disk(data)
    yield from check_optional()


def check_python(version: tuple[int, ...]) -> Finding:
    """Check a Python version against `LEAST_PYTHON`; BROKEN if older."""
    found = f"{'.'.join(map(str, version))} on {platform.system()} {platform.machine()}"
    if version[:2] < LEAST_PYTHON:
        wanted = ".".join(map(str, LEAST_PYTHON))
        return Finding(Grade.BROKEN, "python", f"{found}; zebro-lab needs Python {wanted} or later")
    return Finding(Grade.OK, "python", found)


def check_requirements(needed: Sequence[str]) -> Iterator[Finding]:
    """Check that every required package is installed in a compatible version.

    Yields BROKEN for each that is not, then one OK finding that lists the others.

    Args:
        needed: Requirements in the format of package metadata; those of extras are skipped.
    """
    fitting = []
    for requirement in map(Requirement, needed):
        if requirement.marker is not None and not requirement.marker.evaluate({"extra": ""}):
            continue
        found = _version(requirement.name)
        if found is None:
            yield Finding(Grade.BROKEN, requirement.name,
                          f"not installed; run `pip install '{requirement}'`")  # fmt: skip
        elif not requirement.specifier.contains(found, prereleases=True):
            yield Finding(Grade.BROKEN, requirement.name,
                          f"found version {found}, expected {requirement.specifier}; run "
                          f"`pip install '{requirement}'`")  # fmt: skip
        else:
            fitting.append(f"{requirement.name} {found}")
    yield Finding(Grade.OK, "packages", ", ".join(fitting))


def check_shadows(folder: Path, search: Sequence[str]) -> Iterator[Finding]:
    """Check that `OURS` and `FOREIGN` modules are not shadowed: OK or BROKEN for each.

    Also BROKEN if another package provides a `FOREIGN` one, NOTE for each shadow in `folder`.

    Args:
        folder: Working folder, which `python` puts first on the search path.
        search: Search path of modules.
    """
    home = Path(__file__).parents[2]
    for module in OURS:
        yield _from(module, home / module, search)
    providers = packages_distributions()
    for module, package in FOREIGN.items():
        if (installed := _version(package)) is not None:
            place = Path(str(distribution(package).locate_file(module)))
            yield _from(module, place, search, of=f"{package} {installed}")
        others = sorted(set(providers.get(module, ())) - {package})
        if others:
            yield Finding(
                Grade.BROKEN, f"module {module}",
                f"is provided by {', '.join(others)}, expected only from {package}; run `pip "
                f"uninstall {' '.join(others)}`, then `pip install --force-reinstall {package}`",
            )  # fmt: skip
    yield from _local_shadows(folder, home)


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


def check_optional() -> Iterator[Finding]:
    """Yield path or version of each optional program and package; NOTE with purpose if missing."""
    for program, purpose in OPTIONAL_PROGRAMS.items():
        found = shutil.which(program)
        yield Finding(Grade.OK if found else Grade.NOTE, program,
                      found or f"not found; only needed for {purpose}")  # fmt: skip
    for package, purpose in OPTIONAL_PACKAGES.items():
        version = _version(package)
        yield Finding(Grade.OK if version else Grade.NOTE, package,
                      version or f"not installed; only needed for {purpose}")  # fmt: skip


def _from(module: str, place: Path, search: Sequence[str], of: str = "zebro-lab") -> Finding:
    spec = PathFinder.find_spec(module, list(search))
    origin = None if spec is None or spec.origin is None else Path(spec.origin)
    if origin is None and module in OURS:  # an editable installation has its own import finder
        loaded = sys.modules.get(module) or __import__(module)
        origin = Path(str(loaded.__file__))
    what = f"module {module}"
    if origin is not None and origin.resolve().is_relative_to(place.resolve()):
        return Finding(Grade.OK, what, of)
    return Finding(
        Grade.BROKEN, what,
        f"Python imports {origin} instead of {place}; rename or remove {origin}, or install "
        "zebro-lab into a new virtual environment",
    )  # fmt: skip


def _local_shadows(folder: Path, home: Path) -> Iterator[Finding]:
    for module in (*OURS, *FOREIGN):
        for place in (folder / f"{module}.py", folder / module):
            ours = module in OURS and place.resolve().is_relative_to(home.resolve())
            shadows = place.is_file() or (place / "__init__.py").is_file()
            if shadows and not ours:
                yield Finding(
                    Grade.NOTE, f"module {module}",
                    f"`python` started in this folder would import {place} instead; rename it",
                )  # fmt: skip


def _version(package: str) -> str | None:
    try:
        return distribution(package).version
    except PackageNotFoundError:
        return None


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
