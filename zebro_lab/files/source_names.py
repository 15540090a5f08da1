# SPDX-License-Identifier: MIT
"""Names of data sources: `real`, `sim:WHAT`, `replay:WHAT`, `import:FILE`, `mixed:A,B`."""

from collections.abc import Sequence
from pathlib import Path


def is_simulated(source: str) -> bool:
    """Return whether any of the data of a source are simulated, also of several that are joined.

    >>> is_simulated("sim:zebro"), is_simulated("mixed:real,sim:imu"), is_simulated("real")
    (True, True, False)
    """
    return "sim:" in source


def is_twin(source: str) -> bool:
    """Return whether a device's source is a simulated device, and no replay of one.

    >>> is_twin("sim:zebro"), is_twin("sim:replay:one"), is_twin("real")
    (True, False, False)
    """
    return source.startswith("sim:") and not source.startswith("sim:replay:")


def joined_source(sources: Sequence[str]) -> str:
    """Join the sources of a run's streams: KIND:A+B if all are of one kind, else mixed:A,B.

    Equal sources count once; a single one is returned as it is. None at all gives "mixed:".

    >>> joined_source(["sim:zebro", "sim:imu"]), joined_source(["real", "sim:imu"])
    ('sim:zebro+imu', 'mixed:real,sim:imu')
    """
    different = list(dict.fromkeys(sources))
    kinds = {source.partition(":")[0] for source in different}
    if len(kinds) == 1 and len(different) > 1:
        return f"{kinds.pop()}:{'+'.join(source.partition(':')[2] for source in different)}"
    return different[0] if len(different) == 1 else f"mixed:{','.join(different)}"


def stated_source(stated: str | None, file: Path) -> str:
    """Return the stated source, or `import:FILE` if none is stated.

    Args:
        stated: Source as stated in a file; None or "unknown" if none is stated.
        file: File that the data were read from.

    >>> stated_source("unknown", Path("x/legs.csv"))
    'import:legs.csv'
    """
    return f"import:{file.name}" if stated in (None, "unknown") else str(stated)
