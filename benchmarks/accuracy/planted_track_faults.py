# SPDX-License-Identifier: MIT
"""Whether `track` names a stated value that is wrong, and the right one.

    python -m benchmarks.accuracy.planted_track_faults 20

SIMULATED walks of `benchmarks.accuracy.drawn_walks`, each with one stated value wrong, in full and
by half; and sound ones. Printed is how often the value is named, alone or among those that cannot
be told apart; how often another one is blamed without it; and of the sound walks how many draw any
remark.
"""

import argparse
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from benchmarks.accuracy.drawn_walks.world import PLAIN, WIDE, DrawnWalk, Spreads, draw_walk
from benchmarks.accuracy.tracked_walks import DISTANCES, track_drawn_whole
from benchmarks.tables import print_table
from tracking.errors import FloorError

SOUND = "sound"
Change = Callable[[DrawnWalk, float], DrawnWalk]


def side(walk: DrawnWalk, by: float) -> DrawnWalk:
    """State the robot's marker larger than it is, by 2 %."""
    told = walk.told.robot * [1 + 0.02 * by, 1, 1, 1]
    return replace(walk, told=replace(walk.told, robot=told))


def turned(walk: DrawnWalk, by: float) -> DrawnWalk:
    """State the robot's marker turned by 180 degrees."""
    told = walk.told.robot + np.array([0, 0, 0, np.pi * by])
    return replace(walk, told=replace(walk.told, robot=told))


def height(walk: DrawnWalk, by: float) -> DrawnWalk:
    """State the body 30 mm higher than it is."""
    return replace(walk, told=replace(walk.told, height=walk.told.height + 0.03 * by))


def mark(walk: DrawnWalk, by: float) -> DrawnWalk:
    """State one mark of the floor 8 mm off."""
    marks = dict(walk.told.marks)
    marks[11] = marks[11] + 8e-3 * by * np.array([0.6, 0.8, 0, 0])
    return replace(walk, told=replace(walk.told, marks=marks))


def lens(walk: DrawnWalk, by: float) -> DrawnWalk:
    """State the focal length longer than it is, by 2 %."""
    told = walk.told.lens.copy()
    told[:2] *= 1 + 0.02 * by
    return replace(walk, told=replace(walk.told, lens=told))


def mirrored(walk: DrawnWalk, by: float) -> DrawnWalk:
    """State the map of the floor with y to the right of x."""
    assert by == 1
    marks = {number: mark * [1, -1, -1, 1] for number, mark in walk.told.marks.items()}
    return replace(walk, told=replace(walk.told, marks=marks))


class Fault(NamedTuple):
    """How a value is stated wrong, what names it, and by which parts of it."""

    change: Change
    words: str
    parts: tuple[float, ...] = (1.0, 0.5)


FAULTS = {
    "side +2 %": Fault(side, "side of the robot's marker"),
    "height +30 mm": Fault(height, "height of the body"),
    "mark 8 mm": Fault(mark, "place of mark 11"),
    "lens +2 %": Fault(lens, "focal length"),
    "marker backwards": Fault(turned, "its print is turned"),
    "map mirrored": Fault(mirrored, "the map of the floor is mirrored", (1.0,)),
}
ACCUSED = ("side of the robot", "height of the body", "level of the robot", "place of mark",
           "side of the floor", "focal length", "print is turned")  # fmt: skip


def notes_of(job: tuple[str, float, int]) -> tuple[str, float, str]:
    """Draw a walk, make one stated value wrong, track it; return what is said."""
    fault, by, seed = job
    walk = draw_walk(
        np.random.default_rng(5000 + seed), lens=(PLAIN, WIDE)[seed % 2],
        distance=DISTANCES[seed % 5], spreads=Spreads(),
    )  # fmt: skip
    if fault != SOUND:
        walk = FAULTS[fault].change(walk, by)
    try:
        notes = track_drawn_whole(walk).notes
    except FloorError as error:
        return fault, by, str(error)
    said = [note for note in notes if any(each in note for each in ACCUSED)]
    return fault, by, " | ".join(said)


def main() -> None:
    """Print the table, and with --list what is said of each walk."""
    parser = argparse.ArgumentParser(description=str(__doc__).split("\n")[0])
    parser.add_argument("tries", type=int, nargs="?", default=20)
    parser.add_argument("--first", type=int, default=0, help="number of the first walk")
    parser.add_argument("--list", action="store_true")
    asked = parser.parse_args()
    planted = [(fault, by) for fault, about in FAULTS.items() for by in about.parts]
    first, tries = asked.first, asked.tries
    jobs = [(*each, seed) for each in planted for seed in range(first, first + tries)]
    jobs += [(SOUND, 0.0, seed) for seed in range(first, first + 2 * tries)]
    with ProcessPoolExecutor() as pool:
        found = list(pool.map(notes_of, jobs, chunksize=4))
    if asked.list:
        for each in found:
            print(*each)
    named: Counter[tuple[str, float]] = Counter()
    others: Counter[tuple[str, float]] = Counter()
    for fault, by, said in found:
        right = fault != SOUND and FAULTS[fault].words in said
        named[fault, by] += right
        others[fault, by] += bool(said) and not right
    rows = [
        (fault, f"{by:g}", f"{named[fault, by]} of {asked.tries}", f"{others[fault, by]}")
        for fault, by in planted
    ]
    rows.append((SOUND, "", "", f"{others[SOUND, 0.0]} of {2 * asked.tries}"))
    print_table(("stated wrong", "of it", "named", "others alone"), *rows)


if __name__ == "__main__":
    main()
