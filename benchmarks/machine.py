# SPDX-License-Identifier: MIT
"""The machine that a benchmark ran on."""

import os
import platform
from pathlib import Path

import numpy as np


def describe_machine() -> str:
    """Describe processor, memory, versions and load of this machine in a line."""
    described = {"cpu": platform.processor() or platform.machine(), "memory": "unknown"}
    if Path("/proc/cpuinfo").exists():
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        names = [line.split(":")[1].strip() for line in lines if line.startswith("model name")]
        described["cpu"] = names[0] if names else described["cpu"]
        memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
        described["memory"] = f"{memory / 2**30:.0f} GiB"
    return (
        f"{os.cpu_count()} cores, {described['cpu']}, {described['memory']} of memory, "
        f"{platform.system()}, Python {platform.python_version()}, numpy {np.__version__}; load "
        f"average before the run {os.getloadavg()[0]:.1f}"
    )
