# SPDX-License-Identifier: MIT
"""`calibrate-slip --walks`: fit legs and floor to tracked walks."""

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
    """Fit leg offsets and floor parameters to tracked walks, and print the results.

    Args:
        walks: Run folders with leg logs and tracks.
        out: Folder of the finished calibration; the fit is written into it.
        robot: A `robot.toml` in place of those in the run folders; None to use those.
        seed: Seed of all random numbers.
        threads: Number of threads.
        estimate_offset: Whether to estimate the clock offset of each track from the motion.
    """
    from rich.console import Console

    from zebro_lab.terminal.progress import progress_bar
    from zebro_lab.terminal.tables import wide_console
    from zebro_lab.walk_fit.screen import print_walks
    from zebro_lab.walk_fit.stage import WalksRequest, calibrate_walks

    request = WalksRequest(
        tuple(walks), out, robot, seed=seed, threads=threads, estimate_offset=estimate_offset
    )
    with progress_bar(Console(stderr=True)) as watcher:
        done = calibrate_walks(request, watcher)
    print_walks(wide_console(), done)
