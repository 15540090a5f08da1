# SPDX-License-Identifier: MIT
"""`calibrate-slip --walks`: fit legs and floor to tracked walks beside a calibration."""

from pathlib import Path


def fit_walks(
    walks: list[Path],
    out: Path,
    robot: Path | None,
    *,
    seed: int,
    threads: int,
    estimate_offset: bool,
) -> None:
    """Fit walks beside a finished calibration and print what they said."""
    from rich.console import Console

    from zebro_lab.calibration.command import wide_console
    from zebro_lab.terminal.progress import progress_bar
    from zebro_lab.walk_fit.screen import print_walks
    from zebro_lab.walk_fit.stage import WalksRequest, calibrate_walks

    request = WalksRequest(
        tuple(walks), out, robot, seed=seed, threads=threads, estimate_offset=estimate_offset
    )
    with progress_bar(Console(stderr=True)) as watcher:
        done = calibrate_walks(request, watcher)
    print_walks(wide_console(), done)
