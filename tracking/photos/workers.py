# SPDX-License-Identifier: MIT
"""The same work for batches of photographs, on several cores, with progress and a way to stop."""

import multiprocessing
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from typing import Protocol, TypeVar

import cv2
import numpy as np

from tracking.errors import TrackStopped

WORTH_WORKERS = 60e6
"""Pixels to look at for which starting other processes, a second each, pays."""

LONGEST_BATCH = 12

Item = TypeVar("Item")
Job = TypeVar("Job")
Result = TypeVar("Result")


class Progress(Protocol):
    """Where progress is reported, and who may ask to stop."""

    def step(self, what: str, fraction: float | None) -> None:
        """Report what is going on, and how far it is (None: unknown)."""
        ...

    def stop_requested(self) -> bool:
        """Tell whether somebody asked to stop."""
        ...


class NoProgress:
    """Progress that is not shown."""

    def step(self, what: str, fraction: float | None) -> None:
        """Show nothing."""

    def stop_requested(self) -> bool:
        """Return False: nobody asks to stop."""
        return False


def batches_of(items: Sequence[Item], workers: int) -> list[Sequence[Item]]:
    """Cut a sequence into stretches that follow each other, about two for each worker."""
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
    """Do the same to every batch, on several cores where there are enough of them.

    Args:
        work: What to do; a function of a module, as other processes must find it.
        jobs: What to do it to.
        workers: Processes to use.
        progress: Where progress is reported.
        what: What is being done, in a word or two.

    Returns:
        Results in the order of the jobs.

    Raises:
        TrackStopped: Somebody asked to stop.
    """
    progress.step(what, 0.0)
    if min(workers, len(jobs)) < 2:
        results = []
        for number, job in enumerate(jobs, 1):
            results.append(work(job))
            report_step(progress, what, number / len(jobs))
        return results
    # Not forked: OpenCV's threads do not survive it.
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
    cv2.setNumThreads(1)


def report_step(progress: Progress, what: str, fraction: float | None) -> None:
    """Report how far it is, and stop where that is asked for.

    Raises:
        TrackStopped: Somebody asked to stop.
    """
    progress.step(what, fraction)
    if progress.stop_requested():
        raise TrackStopped("stopped; nothing was written")
