# SPDX-License-Identifier: MIT
"""Process pool for batches of photographs, with progress and cancellation."""

import multiprocessing
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from typing import Protocol, TypeVar

import cv2
import numpy as np

from tracking.errors import TrackStopped

WORTH_WORKERS = 60e6
"""Least number of pixels of all photographs for which worker processes are used: each takes a
second to start [px]."""

PROCESSES = 2
"""Usual number of worker processes: each holds some photographs in memory."""

LONGEST_BATCH = 12
"""Largest number of photographs in a batch, after each of which progress is reported."""

Item = TypeVar("Item")
Job = TypeVar("Job")
Result = TypeVar("Result")


class Progress(Protocol):
    """Protocol of a receiver of progress reports that can request a stop."""

    def step(self, what: str, fraction: float | None) -> None:
        """Report the current step and its progress.

        Args:
            what: Name of the step, a word or two.
            fraction: Share of the step that is done, 0 to 1; None if unknown.
        """
        ...

    def stop_requested(self) -> bool:
        """Return whether a stop was requested."""
        ...


class NoProgress:
    """Implementation of `Progress` that ignores reports and never requests a stop."""

    def step(self, what: str, fraction: float | None) -> None:
        """Ignore the report.

        Args:
            what: Name of the step.
            fraction: Share that is done, 0 to 1; None if unknown.
        """

    def stop_requested(self) -> bool:
        """Return False: no stop is ever requested."""
        return False


def batches_of(items: Sequence[Item], workers: int) -> list[Sequence[Item]]:
    """Split a sequence into contiguous batches, about two for each worker.

    Args:
        items: The sequence.
        workers: Number of worker processes.

    Returns:
        Batches of equal length (the last may be shorter), at most `LONGEST_BATCH`, in order.
    """
    length = int(np.clip(np.ceil(len(items) / (2 * workers)), 1, LONGEST_BATCH))
    return [items[start : start + length] for start in range(0, len(items), length)]


def run_batches(
    work: Callable[[Job], Result],
    jobs: Sequence[Job],
    *,
    workers: int,
    progress: Progress,
    what: str,
) -> list[Result]:  # fmt: skip
    """Map a function over jobs in a process pool, or in this process with one worker.

    Args:
        work: Function of one job; on module level, since it is pickled.
        jobs: Arguments, one for each call of `work`.
        workers: Largest number of processes.
        progress: Receiver of progress after each job, and of requests to stop.
        what: Name of the step in progress reports, a word or two.

    Returns:
        Results in the order of the jobs.

    Raises:
        TrackStopped: A stop was requested. Exceptions of `work` are raised unchanged.
    """
    progress.step(what, 0.0)
    if min(workers, len(jobs)) < 2:
        results = []
        for number, job in enumerate(jobs, 1):
            results.append(work(job))
            report_step(progress, what, number / len(jobs))
        return results
    # Not forked: OpenCV's threads do not survive a fork.
    context = multiprocessing.get_context("spawn")
    pool = ProcessPoolExecutor(min(workers, len(jobs)), context, _one_thread)
    try:
        futures = [pool.submit(work, job) for job in jobs]
        for number, _ in enumerate(as_completed(futures), 1):
            report_step(progress, what, number / len(jobs))
        return [future.result() for future in futures]
    finally:
        pool.shutdown(cancel_futures=True)


def _one_thread() -> None:
    """Keep OpenCV of a worker process to one thread: the processes share the processors."""
    cv2.setNumThreads(1)


def report_step(progress: Progress, what: str, fraction: float | None) -> None:
    """Report progress, and raise if a stop was requested.

    Args:
        progress: Receiver of the report.
        what: Name of the step, a word or two.
        fraction: Share that is done, 0 to 1; None if unknown.

    Raises:
        TrackStopped: A stop was requested.
    """
    progress.step(what, fraction)
    if progress.stop_requested():
        raise TrackStopped("stopped; nothing was written")
