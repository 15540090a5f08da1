# SPDX-License-Identifier: MIT
"""Measures how fast a guard answers: `python -m benchmarks.speed.guard_reaction`.

The twin runs in real time in threads of the same process, which makes the figures worse than those
of a rig outside it.
"""

from pathlib import Path

import numpy as np

from rig.clock import SYSTEM_CLOCK
from rig.errors import LimitExceeded
from rig.experiment.acquire import GuardedAcquisition
from rig.experiment.control import Control
from support.memory_sink import MemorySink
from zebro_lab.experiment.plan_file import read_plan
from zebro_lab.experiment.rig_at_hand import rig_at_hand

TRIPS = 200
PLAN = read_plan(Path(__file__).parents[2] / "examples" / "plan-thesis.toml")


def main() -> None:
    """Trip the force limit again and again and print the times."""
    for address in ("rig-odrive-netft@sim", "rig-board-serial@sim"):
        reactions, overall = [], []
        with rig_at_hand(address) as rig, rig.bench:
            assert rig.twin is not None
            for _ in range(TRIPS):
                rig.twin.load = 5.0
                acquire = GuardedAcquisition(
                    rig.bench, limits=PLAN.limits, control=Control(), sink=MemorySink(),
                    clock=SYSTEM_CLOCK,
                )  # fmt: skip
                acquire.arm()
                acquire.start_ramp(1.0, 0.5)
                acquire.until(lambda _: False, 0.1)
                began = SYSTEM_CLOCK.now()
                rig.twin.load = 60.0
                try:
                    acquire.until(lambda _: False, 1.0)
                except LimitExceeded:
                    overall.append(SYSTEM_CLOCK.now() - began)
                    reactions.append(acquire.reaction)
        for name, times in (("arrival to command", reactions), ("force to command", overall)):
            median, late = np.percentile(np.array(times) * 1e3, [50, 99])
            print(f"| {address} | {name} | {len(times)} | {median:.2f} | {late:.2f} |")


if __name__ == "__main__":
    main()
