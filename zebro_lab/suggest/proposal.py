# SPDX-License-Identifier: MIT
"""Propose the points of a plan that leave the least uncertainty of targets in a given time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.bayes.posterior import SlipPosterior
from model.design.choose import SKELETON, Design, choose_slips, planned, spaced
from model.design.information import (
    Conditions,
    conditions_of,
    measured_information,
    planned_blocks,
    run_roots,
    usable_draws,
)
from model.design.targets import Target
from model.errors import InsufficientData
from rig.experiment.plan import Plan, PointGrid
from rig.experiment.steps import estimate, spell_out

DRAWS: Final = 12
"""Draws of the posterior, around each of which a design is judged."""
CANDIDATES: Final = 40
"""Candidate slips, beside those of the plan and of the skeleton."""
LONGEST: Final = 4.0
"""Longest proposed point, unless the window of settling is longer [s]."""
DURATIONS: Final = 5
"""Durations that are tried, beside that of the plan."""
MOST_SLIPS: Final = 300
"""Most points at one load."""


@dataclass(frozen=True)
class Knowledge:
    """What is known before further runs, and how they are measured.

    Attributes:
        posterior: The calibration's blocks, law, priors; coordinates are independent a priori.
        draws: Draws of its coordinates around which designs are judged, shape (m, d).
        now: Information of the priors and of the calibration's blocks, shape (m, d, d).
        before: Information to which further runs add theirs: `now`, or that of the priors alone.
        conditions: Sizes and moments of blocks, medians of the calibration's, for further runs.
        rate: Samples a second [Hz].
    """

    posterior: SlipPosterior
    draws: Array
    now: Array
    before: Array
    conditions: Conditions
    rate: float


@dataclass(frozen=True)
class Proposal:
    """Proposed points.

    Attributes:
        plan: The plan with these points.
        slips: Slip ratios, increasing, shape (n,) [-].
        counts: Number of points at each slip, the same at every load, shape (n,).
        seconds: Estimated duration of the plan [s].
        design: What is left of the uncertainty.
    """

    plan: Plan
    slips: Array
    counts: NDArray[np.intp]
    seconds: float
    design: Design


def knowledge_of(
    posterior: SlipPosterior, z: Array, *, rate: float, alone: bool = False
) -> Knowledge:
    """Compute the information of a calibration's priors and blocks, around usable draws.

    Args:
        posterior: Blocks, law and priors; coordinates are independent a priori.
        z: Draws of its coordinates in random order, more than `DRAWS`, shape (w, d).
        rate: Samples a second of further runs [Hz].
        alone: Whether further runs are fitted without the calibration's blocks.

    Raises:
        InsufficientData: No draw can be used.
    """
    draws = usable_draws(posterior, z, DRAWS)
    # Coordinates are standard normal a priori, so that the information is the unit matrix.
    prior = np.broadcast_to(np.eye(draws.shape[1]), (len(draws), draws.shape[1], draws.shape[1]))
    now = prior + measured_information(posterior, draws)
    before = prior.copy() if alone else now
    return Knowledge(posterior, draws, now, before, conditions_of(posterior.blocks), rate)


def seconds_of(plan: Plan) -> float:
    """Estimate the duration of a plan from its first step on [s]."""
    return estimate(plan, spell_out(plan)).seconds


def as_planned(plan: Plan, knowledge: Knowledge, targets: Sequence[Target]) -> Design:
    """Compute the uncertainty that a plan leaves if its points stay as they are."""
    slips = np.array(_once(plan.points) * plan.points.repeats)
    roots = _roots(slips, plan.points.loads, (plan.points.duration,), knowledge)[:, 0]
    return planned(knowledge.before, roots, np.ones(len(slips), dtype=np.intp), targets)


def _once(points: PointGrid) -> tuple[float, ...]:
    """Return the slips of one pass in order; of "up-down" rising, then falling again."""
    if points.order != "up-down":
        return points.slips
    up = tuple(sorted(points.slips))
    return (*up, *up[-2::-1])


def propose(
    plan: Plan,
    knowledge: Knowledge,
    targets: Sequence[Target],
    *,
    seconds: float,
    progress: Callable[[float], None] = lambda _: None,
) -> Proposal:
    """Propose the points that leave the least uncertainty of the targets.

    Of durations from the window of settling to `LONGEST`, and of all loads of the plan or the
    smallest and largest, as many slips are chosen as the time allows, `SKELETON` of them fixed.

    Args:
        plan: The plan whose loads, range of slips, settling and controls are kept.
        knowledge: What is known before.
        targets: The targets, at least one.
        seconds: Time that the plan may take [s].
        progress: Called with the share that is done.

    Raises:
        InsufficientData: The time is too short for the skeleton; the message says what it takes.
    """
    slips, kept = candidates(plan.points.slips)
    tried = durations(plan, knowledge)
    best: Proposal | None = None
    choices = load_choices(plan.points.loads)
    for number, loads in enumerate(choices):
        roots = _roots(slips, loads, tried, knowledge)
        for t, duration in enumerate(tried):
            progress((number + t / len(tried)) / len(choices))
            points = replace(
                plan.points, loads=loads, duration=duration, repeats=1,
                order="monotone" if plan.points.order == "up-down" else plan.points.order,
            )  # fmt: skip
            empty = replace(plan, points=points)
            count = most_slips(empty, seconds, least=len(kept))
            if count is None:
                continue
            design = choose_slips(knowledge.before, roots[:, t], targets, count=count, kept=kept)
            if best is None or design.objective < best.design.objective:
                used = design.counts > 0
                full = replace(
                    empty, points=replace(points, slips=in_passes(slips[used], design.counts[used]))
                )
                best = Proposal(full, slips[used], design.counts[used], seconds_of(full), design)
    if best is None:
        least = shortest(plan, tried, len(kept))
        raise InsufficientData(
            f"{seconds:.0f} s are too short for {len(kept)} slips, which are always measured, at "
            f"{len(choices[-1])} loads with their settling; expected {least:.0f} s or more: give "
            "more time, or a plan of fewer loads"
        )
    return best


def candidates(slips: Sequence[float]) -> tuple[Array, NDArray[np.intp]]:
    """Return candidate slips of a plan's range, and the indices of those that are always measured.

    Candidates are about `CANDIDATES` slips that are spaced more closely near zero, the plan's own,
    of which at most about `MOST_SLIPS` are taken, and about `SKELETON` that are always measured.

    Args:
        slips: The plan's slips.
    """
    low, high = min(slips), max(slips)
    fixed = np.unique(np.round(spaced(low, high, SKELETON), 4))
    more = np.round(spaced(low, high, CANDIDATES), 4)
    own = np.array(sorted(set(slips)))
    own = own[:: 1 + len(own) // MOST_SLIPS]
    every = np.unique(np.concatenate([fixed, more, own]).clip(low, high))
    return every, np.unique(np.searchsorted(every, fixed.clip(low, high)))


def durations(plan: Plan, knowledge: Knowledge) -> tuple[float, ...]:
    """Return the durations of a point that are tried, increasing [s].

    They are `DURATIONS`, rounded to two digits, in even ratios from the shortest that holds a block
    and the window of settling to `LONGEST`; and that of the plan, unless it is shorter.
    """
    shortest_run = max(plan.settle.window, knowledge.conditions.length / knowledge.rate)
    even = np.geomspace(shortest_run, max(LONGEST, shortest_run), DURATIONS)
    rounded = [float(f"{each:.2g}") for each in even]
    own = [plan.points.duration] if plan.points.duration >= shortest_run else []
    return tuple(sorted({*(each for each in rounded if each > 0), *own}))


def load_choices(loads: Sequence[float]) -> tuple[tuple[float, ...], ...]:
    """Return all loads, and the smallest and largest where there are more."""
    every = tuple(dict.fromkeys(loads))
    ends = tuple(each for each in every if each in (min(every), max(every)))
    return (every,) if len(ends) == len(every) else (every, ends)


def most_slips(plan: Plan, seconds: float, *, least: int) -> int | None:
    """Return how many points a load can have in a time, at most `MOST_SLIPS`; None below `least`.

    Args:
        plan: The plan, whose slips do not count.
        seconds: The time [s].
        least: Fewest points.
    """

    def takes(count: int) -> float:
        """Return the duration of the plan with `count` points at each load [s]."""
        return seconds_of(replace(plan, points=replace(plan.points, slips=(0.0,) * count)))

    if takes(least) > seconds:
        return None
    low, high = least, MOST_SLIPS + 1
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if takes(middle) <= seconds else (low, middle)
    return low


def shortest(plan: Plan, tried: Sequence[float], count: int) -> float:
    """Return the time of the shortest plan with a number of slips [s].

    It has the smallest and largest load alone, the shortest duration tried, and one pass.
    """
    loads = load_choices(plan.points.loads)[-1]
    points = replace(
        plan.points, loads=loads, duration=min(tried), repeats=1, slips=(0.0,) * count,
        order="monotone",
    )  # fmt: skip
    return seconds_of(replace(plan, points=points))


def in_passes(slips: Array, counts: NDArray[np.intp]) -> tuple[float, ...]:
    """Return slips as often as they are counted, in passes, so that repeats are apart in time.

    >>> in_passes(np.array([0.0, 0.1]), np.array([2, 1]))
    (0.0, 0.1, 0.0)
    """
    return tuple(
        float(slip)
        for number in range(int(counts.max()))
        for slip, count in zip(slips, counts, strict=True)
        if count > number
    )


def _roots(
    slips: Array, loads: Sequence[float], tried: Sequence[float], knowledge: Knowledge
) -> Array:
    """Compute roots of the information of single points, shape (m, durations, slips, loads, d).

    The sum of their outer products is the information of all points around each of m draws.

    Args:
        slips: Slip ratios [-].
        loads: Loads [N].
        tried: Durations of a point [s].
        knowledge: Draws, law and conditions of measurement.
    """
    slip, load = (each.ravel() for each in np.meshgrid(slips, np.array(loads), indexing="ij"))
    conditions = knowledge.conditions
    blocks = planned_blocks(slip, load, conditions, knowledge.posterior.blocks)
    samples = np.array(tried) * knowledge.rate
    roots = run_roots(
        knowledge.posterior, blocks, knowledge.draws,
        n_blocks=samples / conditions.length, shared=conditions.samples / samples,
    )  # fmt: skip
    return roots.reshape(*roots.shape[:2], len(slips), len(loads), -1)
