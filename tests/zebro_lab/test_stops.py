# SPDX-License-Identifier: MIT
"""SIGTERM at random instants of a command: one line, a code, and no half result."""

import random
import time

import pytest

from support.commands import started

STOPPED = 130
BEFORE_OR_AFTER = -15
"""Python had not begun, or had finished, the command's own work."""
COMMANDS = {
    "walk": ("--slip", "coulomb:0.4", "--duration", 4, "--figures"),
    "camera": ("kit",),
    "doctor": (),
}


def stop_after(delay, name, folder):
    """Stop a command after a delay [s], and check how it ended."""
    out = () if name == "doctor" else ("--out", folder / "out")
    with started(name, *COMMANDS[name], *out, cwd=folder) as process:
        time.sleep(delay)
        process.terminate()
        _, err = process.communicate(timeout=60)
    assert process.returncode in (0, STOPPED, BEFORE_OR_AFTER), err
    stopped = "stopped by SIGTERM; nothing was left half-written\n"
    assert err in ("", stopped)
    assert (err == stopped) == (process.returncode == STOPPED)
    left = {path.name for path in folder.iterdir()}
    assert left <= {"out"}
    assert not left or process.returncode != STOPPED or any((folder / "out").iterdir())
    return process.returncode


@pytest.mark.parametrize("delay", [0.15, 0.6, 1.1])
def test_a_walk_is_stopped_at_any_moment(delay, tmp_path):
    stop_after(delay, "walk", tmp_path)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("name", COMMANDS)
def test_commands_are_stopped_at_random_instants(name, seed, tmp_path):
    stop_after(random.Random(f"{name} {seed}").uniform(0.05, 2.5), name, tmp_path)  # noqa: S311
