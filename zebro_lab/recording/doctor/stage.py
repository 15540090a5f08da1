# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab doctor`: run every check of this machine."""

import sys
from collections.abc import Iterator
from pathlib import Path

from zebro_lab.recording.doctor import machine, packages
from zebro_lab.recording.doctor.finding import Finding


def examine(data: Path) -> Iterator[Finding]:
    """Run every check of this machine and yield the findings.

    Args:
        data: Folder for recordings; need not exist.
    """
    yield packages.check_python(sys.version_info[:3])
    yield from packages.check_installations(packages.HOME, sys.path)
    yield from packages.check_requirements(packages.needed_packages())
    yield from packages.check_shadows(Path.cwd(), sys.path)
    yield from machine.check_serial_ports()
    yield from machine.check_can(machine.NET)
    yield from machine.check_udp(Path("/proc/sys/net/core/rmem_max"))
    yield machine.check_disk(data)
    yield from packages.check_optional()
