# SPDX-License-Identifier: MIT
"""Terms that a rig may have beside those of the fit: shifts of slip and force, drift, two curves.

Each is a force at every block, of unit size; `Linearised.test` says how much of it there is. The
fit estimates the error of the radii and rolling resistance within their priors; of these, what is
found here is what lies beyond.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.bayes.advice import Advice, CorrectData, TryDefinition, ZeroBeforeEach
from model.bayes.checks.linear import Linearised, Term
from model.slip.definition import slip_per_radius_error


@dataclass(frozen=True)
class Suspect:
    """A term that could be in the data, with what to say of it.

    Attributes:
        force: Function of a linearised fit to the force of a unit of the term, shape (n,) [N].
        say: Function of size and standard deviation to what was found, as text.
        advice: Function of that text and the size to what to do.
        matters: Size from which it would do harm; infinite where whatever does harm shows.
    """

    force: Callable[[Linearised], Array]
    say: Callable[[float, float], str]
    advice: Callable[[str, float], Advice]
    matters: float = math.inf


@dataclass(frozen=True)
class Found:
    """A suspect with its estimate.

    Attributes:
        name: Name of the suspect.
        term: Estimate of its size.
        gain: Twice the log density that the fit would gain by it, by the model's variances [-].
        text: What was found.
        advice: What to do.
        matters: Size from which it would do harm.
    """

    name: str
    term: Term
    gain: float
    text: str
    advice: Advice
    matters: float = math.inf


def run_times(fit: Linearised) -> Array:
    """Return the place of each block's run in the experiment, -1 to 1, (n,) [-]; 0 for one run."""
    blocks = fit.blocks
    return np.linspace(-1, 1, blocks.n_runs)[blocks.run] if blocks.n_runs > 1 else 0 * blocks.slip


def _within(fit: Linearised) -> Array:
    """Return the place of each block in its run, from about -1/2 to 1/2, shape (n,) [-]."""
    blocks = fit.blocks
    starts = blocks.run_starts()
    size = np.diff(starts)[blocks.run]
    return (np.arange(len(blocks)) - starts[blocks.run] - (size - 1) / 2) / np.maximum(size, 1)


def _log_load(fit: Linearised) -> Array:
    """Return the logarithm of each block's load over the median load, shape (n,) [-]."""
    load = np.maximum(fit.blocks.normal_force, 1e-9)
    return np.log(load / np.median(load))


def _definition_change(fit: Linearised) -> Array:
    """Return the change of force where slip is in another definition, to first order, (n,) [N]."""
    return fit.per_slip * fit.blocks.slip**2


def _radius_advice(found: str, size: float) -> Advice:
    """Advise to correct the ratio of the radii by its relative error `size`."""
    return CorrectData(
        found,
        f"measure the radii of both discs under load; if they confirm it, multiply radius_ground "
        f"by {1 - size:.4f} and fit again; a slip ratio that was measured gets its zero corrected",
    )


def _correct(what: str) -> Callable[[str, float], Advice]:
    """Return a `Suspect.advice`: do what the text `what` says, whatever the size of the term."""
    return lambda found, _: CorrectData(found, what)


_MEASURE_ZERO = _correct(
    "measure the traction at zero slip under each load, both ways round, subtract it from the "
    "traction forces, and fit again; zero the load cell with the discs apart"
)
_PART_SIDES = _correct(
    "weigh the load cell in both directions; if its gain is the same, fit driving and braking "
    "apart: the same command with --sides apart"
)
_FREE_LOAD = _correct(
    "give the same command with --load-sensitivity; for another law than the Magic Formula with "
    "--law compare"
)
_MEASURE_AGAIN = _correct(
    "clean both discs, let them warm up, and measure again with the loads in another order; "
    "fit the new runs alone"
)


def _zero_often(found: str, _: float) -> Advice:
    """Advise to zero the load cell before each run, whatever the size of the term."""
    return ZeroBeforeEach(found)


def _try_definition(found: str, _: float) -> Advice:
    """Advise to try another slip definition, whatever the size of the term."""
    return TryDefinition(found)


ZERO: Mapping[str, Suspect] = {
    "constant force": Suspect(
        lambda fit: np.ones(len(fit.blocks)),
        lambda a, s: f"a constant traction of {a:+.3g} ± {s:.2g} N (zero of the load cell)",
        _MEASURE_ZERO,
    ),
    "force in proportion to load": Suspect(
        lambda fit: fit.blocks.normal_force,
        lambda a, s: (
            f"a traction of {a:+.3g} ± {s:.2g} times the load at any slip (rolling resistance, or "
            "crosstalk of load into traction)"
        ),
        _MEASURE_ZERO,
    ),
    "shift of slip": Suspect(
        lambda fit: fit.per_slip * slip_per_radius_error(fit.blocks.slip, fit.blocks.definition),
        lambda a, s: (
            f"true slip is larger by {a:+.2g} ± {s:.1g} at zero slip (a ratio of radii wrong by "
            f"{abs(a):.2%}, or a wrong zero of slip)"
        ),
        _radius_advice,
    ),
}
"""What moves the zero crossing of force."""
SIDES: Mapping[str, Suspect] = {
    "driving and braking": Suspect(
        lambda fit: np.abs(fit.predicted.force),
        lambda a, s: (
            f"driving forces are {2 * a:+.2%} ± {2 * s:.2%} larger than braking forces (gain of "
            "the load cell by direction, or two curves)"
        ),
        _PART_SIDES,
        matters=0.03,  # 6 % between the sides
    ),
    "slip definition": Suspect(
        _definition_change,
        lambda a, s: (
            f"the curve is bent {a:+.2g} ± {s:.1g} times as another slip definition would bend it "
            "(wrong slip definition, or a wrong speed)"
        ),
        _try_definition,
    ),
}
"""What makes driving and braking unlike."""
LOAD: Mapping[str, Suspect] = {
    "friction over load": Suspect(
        lambda fit: fit.predicted.force * _log_load(fit),
        lambda a, s: (
            f"forces grow with load to the power of {1 + a:.3f} ± {s:.2g}, not of the law's"
        ),
        _FREE_LOAD,
    ),
    "stiffness over load": Suspect(
        lambda fit: fit.per_slip * fit.blocks.slip * _log_load(fit),
        lambda a, s: f"stiffness over load changes with load to the power of {a:+.3f} ± {s:.2g}",
        _FREE_LOAD,
    ),
}
"""What makes loads unlike."""
TIME: Mapping[str, Suspect] = {
    "drifting zero": Suspect(
        lambda fit: run_times(fit),
        lambda a, s: (
            f"the zero of traction drifts by {2 * a:+.3g} ± {2 * s:.2g} N from the first run to "
            "the last"
        ),
        _zero_often,
    ),
    "zero lost with time": Suspect(
        lambda fit: 1 + run_times(fit),
        lambda a, s: (
            f"the zero of traction drifts by {2 * a:+.3g} ± {2 * s:.2g} N since the first run"
        ),
        _zero_often,
    ),
    "changing friction": Suspect(
        lambda fit: fit.predicted.force * run_times(fit),
        lambda a, s: (
            f"forces change by {2 * a:+.2%} ± {2 * s:.2%} from the first run to the last (another "
            "material, warming, wear, or a drifting gain)"
        ),
        _MEASURE_AGAIN,
    ),
    "drift within runs": Suspect(
        _within,
        lambda a, s: f"forces drift by {a:+.3g} ± {s:.2g} N within each run",
        _zero_often,
    ),
}
"""What changes with time."""


def find(fit: Linearised, suspects: Mapping[str, Suspect]) -> list[Found]:
    """Estimate the size of each suspect beside the fit, the one of the largest `gain` first.

    Args:
        fit: The linearised fit.
        suspects: The suspects, by name.
    """
    found = []
    for name, suspect in suspects.items():
        force = suspect.force(fit)
        term = fit.test(force)
        left = fit.project(force[:, None])[:, 0]
        information = float(left @ left)
        gain = 0.0 if term.p == 1.0 else float(left @ fit.rest) ** 2 / information
        text = suspect.say(term.size, term.sd)
        advice = suspect.advice(text, term.size)
        found.append(Found(name, term, gain, text, advice, suspect.matters))
    return sorted(found, key=lambda each: -each.gain)
