# SPDX-License-Identifier: MIT
"""Terms that a rig's data may hold beside those of the fit, each a force at every block.

`Linearised.test` says how much of a term there is. The fit estimates the error of the radii and
rolling resistance within their priors; of these, what is found here lies beyond.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from model.arrays import Array
from model.bayes.advice import Advice, CorrectData, TryDefinition, ZeroBeforeEach
from model.bayes.averaging.load_levels import load_levels
from model.bayes.checks.causes import Cause, Finding, Question
from model.bayes.checks.linear import Linearised, Term
from model.slip.definition import slip_per_radius_error

FEWEST_RUNS: Final = 6
"""Least number of runs that tell whether something changes from run to run."""
SWEPT: Final = 0.05
"""Range of slip within the median run, over the largest slip, from which runs are sweeps [-]."""
ORDER: Final = re.compile(r"\b(test|trial|run|no|nr|number|index|time|date|order|t)\b", re.I)
"""Names of columns that tell the order of measurement."""


@dataclass(frozen=True)
class Suspect:
    """A term that could be in the data, with what to say of it.

    Attributes:
        question: The question that it would answer with no.
        causes: What it stands for, the likelier first.
        forces: Forces of a unit of each of its m parts, shape (n, m) [N].
        say: Function of sizes (m,) and standard deviations (m,) to what was found, as text.
        advice: Function of that text and the sizes to what to do.
    """

    question: Question
    causes: tuple[Cause, ...]
    forces: Array
    say: Callable[[Array, Array], str]
    advice: Callable[[str, Array], Advice]
    tried: int = 1
    """Number of terms of which it is the best."""


def find(fit: Linearised, suspects: Iterator[Suspect]) -> tuple[list[Finding], Linearised]:
    """Estimate each suspect beside the fit; return what is found, and the fit without the best.

    Probabilities are multiplied by the number of suspects that belong to the same question. The
    real finding that explains most is taken out of the fit returned: what it explains of a misfit
    of the curve is not the law's.

    Args:
        fit: The linearised fit.
        suspects: The suspects.
    """
    every = [each for each in suspects if np.isfinite(each.forces).all() and each.forces.any()]
    found = [
        _finding(fit, each, sum(other.question is each.question for other in every))
        for each in every
    ]
    gain = [each.gain if each.real else 0.0 for each in found]
    if not any(gain):
        return found, fit
    return found, fit.without(every[int(np.argmax(gain))].forces)


def _finding(fit: Linearised, suspect: Suspect, tried: int) -> Finding:
    """Estimate a suspect, one of `tried` that belong to its question."""
    term: Term = fit.test(suspect.forces)
    text = suspect.say(term.size, term.sd)
    p = min(1.0, tried * suspect.tried * term.p)
    effect = fit.effect(suspect.forces @ term.size)
    advice = suspect.advice(text, term.size)
    return Finding(suspect.question, suspect.causes, text, term.gain, p, effect, advice)


def suspects(fit: Linearised, columns: Mapping[str, Array], *, timed: bool) -> Iterator[Suspect]:
    """Yield the terms that could be in the data, as far as these have what shows them.

    Args:
        fit: The linearised fit.
        columns: Mean of each unused column over each block by name, shape (n,) each.
        timed: Whether the order of the runs is that of measurement.
    """
    yield from _of_zero(fit)
    if len(load_levels(fit.blocks)) > 1:
        yield from _of_load(fit)
    if fit.blocks.slip.min() < 0 < fit.blocks.slip.max():
        yield from _of_sides(fit)
    yield from _of_sweeps(fit)
    if fit.blocks.n_runs < FEWEST_RUNS:
        return
    order = np.linspace(-1, 1, fit.blocks.n_runs)[fit.blocks.run] if timed else None
    for name, values in columns.items():
        if order is None and ORDER.search(name):
            order = _standardised(fit, values)
        else:
            yield from _of_column(fit, name, values)
    if order is not None:
        yield from _of_order(fit, order, timed=timed)


def _correct(what: str) -> Callable[[str, Array], Advice]:
    """Return a `Suspect.advice`: do what the text `what` says, whatever the sizes."""
    return lambda found, _: CorrectData(found, what)


_MEASURE_ZERO = _correct(
    "measure the traction at zero slip under each load, both ways round, subtract it from the "
    "traction forces, and fit again; zero the load cell with the discs apart"
)
_PART_SIDES = _correct(
    "weigh the load cell in both directions; if its gain is the same, fit driving and braking "
    "apart: the same command with --sides apart"
)
_CHECK_LOADS = _correct(
    "check that the normal force is the contact's own and of the same instant; if it is, give the "
    "same command with --load-sensitivity"
)
_ONE_CLOCK = _correct(
    "give all channels one clock and one filter, or hold each slip for longer than the delay, and "
    "measure again"
)
_MEASURE_AGAIN = _correct(
    "clean both discs, let them warm up, measure again with the set-points in another order, and "
    "fit the new runs alone"
)


def _zero_often(found: str, _: Array) -> Advice:
    """Advise to zero the load cell before each run, whatever the sizes."""
    return ZeroBeforeEach(found)


def _of_zero(fit: Linearised) -> Iterator[Suspect]:
    """Yield what moves the zero crossing of force, and a slip of another definition."""
    blocks, one = fit.blocks, np.ones((len(fit.blocks), 1))
    yield Suspect(
        Question.SLIP, (Cause.FORCE_ZERO,), one,
        lambda a, s: f"a constant traction of {a[0]:+.3g} ± {s[0]:.2g} N", _MEASURE_ZERO,
    )  # fmt: skip
    yield Suspect(
        Question.SLIP, (Cause.FORCE_ZERO,), blocks.normal_force[:, None],
        lambda a, s: f"a traction of {a[0]:+.3g} ± {s[0]:.2g} times the load at any slip",
        _MEASURE_ZERO,
    )  # fmt: skip
    lever = slip_per_radius_error(blocks.slip, blocks.definition)
    yield Suspect(
        Question.SLIP, (Cause.SLIP_ZERO,), (fit.per_slip * lever)[:, None],
        lambda a, s: (
            f"true slip is larger by {a[0]:+.2g} ± {s[0]:.1g} at zero slip (a ratio of radii wrong "
            f"by {abs(a[0]):.2%})"
        ),
        lambda found, a: CorrectData(
            found, "measure the radii of both discs under load; if they confirm it, multiply "
            f"radius_ground by {1 - a[0]:.4f} and fit again; correct the zero of a slip ratio that "
            "was measured",
        ),
    )  # fmt: skip
    yield Suspect(
        Question.SLIP, (Cause.DEFINITION,), (fit.per_slip * blocks.slip**2)[:, None],
        lambda a, s: f"slip bends the curve {a[0]:+.2g} ± {s[0]:.1g} times as another definition",
        lambda found, _: TryDefinition(found),
    )  # fmt: skip


def _of_load(fit: Linearised) -> Iterator[Suspect]:
    """Yield what makes loads unlike, and a load that belongs to another run."""
    blocks = fit.blocks
    load = np.maximum(blocks.normal_force, 1e-9)
    logarithm = np.log(load / np.median(load))
    force, steep = fit.predicted.force, fit.per_slip * blocks.slip
    yield Suspect(
        Question.POINTS, (Cause.LOAD, Cause.LAW),
        np.column_stack([force, steep]) * logarithm[:, None],
        lambda a, s: (
            f"forces grow with load to the power of {1 + a[0]:.2f} ± {s[0]:.1g}, the slope over "
            f"load to that of {a[1]:+.2f} ± {s[1]:.1g}"
        ),
        _CHECK_LOADS,
    )  # fmt: skip
    of_run = np.log(np.maximum(blocks.run_mean(load), 1e-9))
    late = (np.append(of_run[1:], of_run[-1]) - of_run)[blocks.run]
    yield Suspect(
        Question.POINTS, (Cause.LOAD, Cause.TIMING), (force * late)[:, None],
        lambda a, s: f"{a[0]:.0%} ± {s[0]:.0%} of a run's load belong to the run before",
        _CHECK_LOADS,
    )  # fmt: skip


def _of_sides(fit: Linearised) -> Iterator[Suspect]:
    """Yield what makes driving and braking unlike: a gain, or traction in the normal force.

    The two have nearly the same shape, and are one suspect by whichever explains more.
    """
    force = fit.predicted.force
    gain, cross = np.abs(force)[:, None], (fit.predicted.load_slope * force)[:, None]
    tests = [fit.test(each).gain for each in (gain, cross)]
    if tests[0] >= tests[1]:
        yield Suspect(
            Question.UNITS, (Cause.ONE_DIRECTION, Cause.CROSSTALK), gain,
            lambda a, s: f"driving forces are {2 * a[0]:+.1%} ± {2 * s[0]:.1%} larger than braking",
            _PART_SIDES, tried=2,
        )  # fmt: skip
    else:
        yield Suspect(
            Question.UNITS, (Cause.CROSSTALK, Cause.ONE_DIRECTION), cross,
            lambda a, s: f"the normal force holds {-a[0]:+.1%} ± {s[0]:.1%} of the traction",
            _correct("load one channel of the cell alone and read the other; state crosstalk_sd in "
                     "[load_cell] of columns.toml, or correct the normal force"), tried=2,
        )  # fmt: skip


def _of_sweeps(fit: Linearised) -> Iterator[Suspect]:
    """Yield lags of traction behind slip, where slip is swept within runs."""
    blocks, starts = fit.blocks, fit.blocks.run_starts()
    span = np.array([np.ptp(blocks.slip[a:b]) for a, b in pairwise(starts)])
    if (
        np.median(span) < SWEPT * np.abs(blocks.slip).max()
        or np.median(np.diff(starts)) < FEWEST_RUNS
    ):
        return
    rate = np.zeros(len(blocks))
    for a, b in pairwise(starts):
        if b - a > 2:  # the ends would have the noise of their own slip in it
            rate[a + 1 : b - 1] = 0.5 * (blocks.slip[a + 2 : b] - blocks.slip[a : b - 2])
    yield Suspect(
        Question.RAW, (Cause.TIMING,), (-fit.per_slip * rate)[:, None],
        lambda a, s: f"traction is late by {a[0]:+.2g} ± {s[0]:.1g} blocks behind slip",
        _ONE_CLOCK,
    )  # fmt: skip
    ways = np.sign(rate[np.abs(rate) > 0.3 * np.abs(rate).max()])
    if len(np.unique(ways)) > 1:
        way = np.tanh(3 * rate / max(float(np.median(np.abs(rate))), 1e-300))
        yield Suspect(
            Question.RAW, (Cause.HYSTERESIS, Cause.TIMING), (-fit.per_slip * way)[:, None],
            lambda a, s: f"rising and falling slip are {2 * a[0]:+.2g} ± {2 * s[0]:.1g} apart",
            _ONE_CLOCK,
        )  # fmt: skip


def _standardised(fit: Linearised, values: Array) -> Array:
    """Return a column's mean in each run less its mean, over its spread, at each block, (n,)."""
    of_run = fit.blocks.run_mean(values)
    spread = float(np.std(of_run))
    return ((of_run - of_run.mean()) / max(spread, 1e-300))[fit.blocks.run]


def _of_column(fit: Linearised, name: str, values: Array) -> Iterator[Suspect]:
    """Yield that friction and stiffness follow an unused column that differs between runs."""
    z = _standardised(fit, values)
    parts = np.column_stack([fit.predicted.force * z, fit.per_slip * fit.blocks.slip * z])
    yield Suspect(
        Question.REPEAT,
        (Cause.COLUMN,),
        parts,
        lambda a, s: (
            f"forces change by {a[0]:+.1%} ± {s[0]:.1%} for a standard deviation of the unused "
            f"column '{name}'"
        ),
        _correct(f"fit runs of one value of '{name}' at a time: [rows] keep in columns.toml"),
    )


def _of_order(fit: Linearised, order: Array, *, timed: bool) -> Iterator[Suspect]:
    """Yield what changes in the order of the runs, at `order`, -1 to 1 or standardised, (n,).

    A step is looked for between all runs, which is why its probability is that of the best of them.
    """
    force = fit.predicted.force
    width = float(np.ptp(order))
    yield Suspect(
        Question.REPEAT, (Cause.FORCE_ZERO,), order[:, None],
        lambda a, s: (
            f"the zero of traction drifts by {width * a[0]:+.3g} ± {width * s[0]:.2g} N from the "
            "first run to the last"
        ),
        _zero_often,
    )  # fmt: skip
    yield Suspect(
        Question.REPEAT, (Cause.OVER_TIME,), (force * order)[:, None],
        lambda a, s: (
            f"forces change by {width * a[0]:+.1%} ± {width * s[0]:.1%} from the first run to the "
            "last (wear, warming, another surface)"
        ),
        _MEASURE_AGAIN,
    )  # fmt: skip
    yield _step(fit, order)
    if timed and np.median(np.bincount(fit.blocks.run)) >= FEWEST_RUNS:
        starts = fit.blocks.run_starts()
        size = np.diff(starts)[fit.blocks.run]
        within = (np.arange(len(order)) - starts[fit.blocks.run] - (size - 1) / 2) / size
        yield Suspect(
            Question.REPEAT, (Cause.FORCE_ZERO,), within[:, None],
            lambda a, s: f"forces drift by {a[0]:+.3g} ± {s[0]:.2g} N within each run",
            _zero_often,
        )  # fmt: skip


def _step(fit: Linearised, order: Array) -> Suspect:
    """Return the step of all forces, between two runs, that explains most."""
    places = np.unique(order)
    steps = fit.predicted.force[:, None] * (order[:, None] > 0.5 * (places[1:-2] + places[2:-1]))
    left = fit.project(steps)
    gain = (left.T @ fit.rest) ** 2 / np.maximum(np.sum(left**2, axis=0), 1e-300)
    best = int(np.argmax(gain))
    return Suspect(
        Question.REPEAT, (Cause.FORCE_SCALE, Cause.OVER_TIME), steps[:, [best]],
        lambda a, s: (
            f"forces change by {a[0]:+.1%} ± {s[0]:.1%} at once, after {best + 2} of "
            f"{len(places)} runs"
        ),
        _correct("look in the lab notes for what changed there (range, unit, amplifier, surface), "
                 "correct it, or fit both parts apart"),
        tried=len(gain),
    )  # fmt: skip
