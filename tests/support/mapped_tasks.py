# SPDX-License-Identifier: MIT
"""Functions of tasks that workers of other processes can import."""

import os
import signal
import time
from pathlib import Path

import numpy as np


def normal(scale, seed):
    """Return a number that depends on scale and seed alone."""
    return float(scale * np.random.default_rng(seed).standard_normal())


def fail(_, task):
    """Raise for a task."""
    raise ValueError(f"task {task}")


def die(_, task):
    """End the process."""
    os.kill(os.getpid(), signal.SIGKILL)
    return task


def slow(_, task):
    """Take a minute."""
    time.sleep(60)
    return task


def die_once(folder, task):
    """End the worker at the first call for the task 2, and return task and process else."""
    mark = Path(folder) / "died"
    if task == 2 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return normal(1.0, task)
