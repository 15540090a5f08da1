# SPDX-License-Identifier: MIT
"""Advice of a verdict that can be followed to the letter: lines of a plan, commands, options."""

import re
from functools import singledispatch
from typing import TYPE_CHECKING, Final

from model.bayes.advice import (
    Advice,
    CorrectData,
    ExcludeRuns,
    MeasureAlso,
    MeasureSlips,
    SampleAgain,
    SampleLonger,
    SamplePosterior,
    TryDefinition,
    TryLaws,
    ZeroBeforeEach,
)

if TYPE_CHECKING:  # it takes seconds to import
    from model.bayes.calibration import Calibration

SECONDS: Final = 2.0
"""Time of each further slip ratio [s]."""
ZERO_SECONDS: Final = 10.0
"""Time of a zero: noise that remembers 0.05 s leaves a tenth of itself in it [s]."""
SHORT: Final = 0.5
"""Time of a run in which forces hardly drift [s]."""
SHORT_ZERO: Final = 2.0
"""Time of the zero before each of these runs [s]."""
PASSES: Final = 4
"""Number of these short runs at each slip ratio."""


def advice_texts(calibration: "Calibration") -> list[str]:
    """Format what the verdict of a calibration advises to do next, for its kind of data.

    Who brings a table of means has no plan that could be run again.
    """
    table = len(calibration.posterior.blocks) == calibration.posterior.blocks.n_runs
    texts = (
        of_table(step) if table else advice_text(step) for step in calibration.verdict.next_steps()
    )
    return list(dict.fromkeys(texts))


@singledispatch
def of_table(advice: Advice) -> str:
    """Format advice for who brings a table of means; as `advice_text` where that needs no plan."""
    return advice_text(advice)


@of_table.register
def _slips_in_table(advice: MeasureSlips) -> str:
    """Advise which rows to add: slip ratios at loads."""
    slips = ", ".join(dict.fromkeys(f"{slip:.2g}" for slip in advice.slips))
    loads = ", ".join(f"{load:.3g}" for load in advice.loads)
    return (
        f"{advice.reason}: add rows of trials at slip ratios (material definition) of {slips}, at "
        f"loads of {loads} N, and fit again"
    )


@of_table.register
def _more_in_table(advice: MeasureAlso) -> str:
    """Advise which rows to add: other loads, or the same trials again."""
    if advice.loads:
        loads = " and ".join(f"{load:.3g}" for load in advice.loads)
        return f"{advice.reason}: add rows of trials at {loads} N, and fit again"
    return f"{advice.reason}: repeat some trials, add each as a row of its own, and fit again"


@of_table.register
def _zero_in_table(advice: ZeroBeforeEach) -> str:
    """Advise to subtract the zero of each trial."""
    return (
        f"{advice.reason}: measure the zero of the load cell before each trial, subtract it from "
        "its mean, and fit again"
    )


@singledispatch
def advice_text(advice: Advice) -> str:
    """Format advice as text, of several lines where it holds lines of a plan or commands.

    Of a kind of advice without a function below, the text is its reason alone.
    """
    return advice.reason


@advice_text.register
def _sample_longer(advice: SampleLonger) -> str:
    """Advise to resume sampling up to a number of moves."""
    return f"{advice.reason}: give the same command with --resume --max-steps {advice.moves}"


@advice_text.register
def _sample_posterior(advice: SamplePosterior) -> str:
    """Advise to sample the posterior instead of its Laplace approximation."""
    return f"{advice.reason}: give the same command without --engine laplace"


@advice_text.register
def _measure_slips(advice: MeasureSlips) -> str:
    """Advise to measure further slip ratios, `SECONDS` each, at the loads of the plan.

    Slip ratios that are equal to two digits are measured once.
    """
    numbers = list(dict.fromkeys(f"{slip:.2g}" for slip in advice.slips))
    lines = {
        "points": {
            "loads": f"[{', '.join(f'{load:.3g}' for load in advice.loads)}]",
            "slips": f"[{', '.join(numbers)}]",
            "length": '"duration"',
            "duration": f"{SECONDS:.1f}",
        },
        "controls": {"tare_every": f"{len(numbers)}", "tare_duration": f"{ZERO_SECONDS:.1f}"},
    }
    return _plan(
        f"{advice.reason}: measure {len(numbers)} more slip ratios (material definition), "
        f"{SECONDS:g} s each, at {len(advice.loads)} load(s), the load cell zeroed for "
        f"{ZERO_SECONDS:g} s before each load",
        lines,
        "then fit both (calibrate-slip DATA FURTHER)",
    )


@advice_text.register
def _measure_also(advice: MeasureAlso) -> str:
    """Advise to run the plan again: with other loads, slip ratios or repeats, or longer runs.

    Empty loads and slip ratios, no repeats and `times` of 1 leave the plan as it is.
    """
    points: dict[str, str] = {}
    if advice.loads:
        points["loads"] = f"[{', '.join(f'{load:.3g}' for load in advice.loads)}]"
    if advice.slips:
        numbers = dict.fromkeys(f"{slip:.2g}" for slip in advice.slips)
        points["slips"] = f"[{', '.join(numbers)}]"
    if advice.repeats:
        points["repeats"] = f"{advice.repeats}"
    longer = f", with runs {advice.times:g} times as long" if advice.times != 1 else ""
    fit = "then fit both (calibrate-slip DATA FURTHER)"
    if not points:
        return f"{advice.reason}: run the plan again into another folder{longer}, {fit}"
    what = f"{advice.reason}: run the plan again, changed{longer}"
    return _plan(what, {"points": points}, fit)


@advice_text.register
def _sample_again(advice: SampleAgain) -> str:
    """Advise to sample with another seed, since ensembles differ."""
    return (
        f"{advice.reason}: give the same command with --seed 2 and an --out of its "
        "own; if the differences stay, see corner.png for a second mode or a long tail, and use "
        "the wider interval"
    )


@advice_text.register
def _zero_before_each(advice: ZeroBeforeEach) -> str:
    """Advise to measure in short runs, each after a zero, since forces drift."""
    lines = {
        "points": {"length": '"duration"', "duration": f"{SHORT:.1f}", "repeats": f"{PASSES}"},
        "controls": {"tare_every": "1", "tare_duration": f"{SHORT_ZERO:.1f}"},
    }
    return _plan(
        f"{advice.reason}: measure again in runs of {SHORT:g} s, the load cell zeroed for "
        f"{SHORT_ZERO:g} s before each",
        lines,
        "then fit it alone (calibrate-slip FURTHER); if it says the same, forces drift too fast: "
        "let the load cell warm up, or mend it",
    )


@advice_text.register
def _try_laws(advice: TryLaws) -> str:
    """Advise to compare slip laws and, if the advice says so, to fit signs of slip apart."""
    apart = ", then with that law and --sides auto"
    return (
        f"{advice.reason}: give the same command with --law compare{apart * advice.both_signs}, "
        "each with an --out of its own, and use the result that is trustworthy; if none is, check "
        "the slip definition (--slip-definition) and see residuals.png"
    )


@advice_text.register
def _correct_data(advice: CorrectData) -> str:
    """Advise to correct the data as the advice says."""
    return f"{advice.reason}: {advice.step}"


@advice_text.register
def _try_definition(advice: TryDefinition) -> str:
    """Advise to check the slip definition, since slip may be divided by the other speed."""
    return (
        f"{advice.reason}: find out by which speed the slip ratio was divided; if by that of "
        "travel, replace it by slip/(1 + slip), which is divided by the leg's, and fit again; else "
        "check the speeds that slip is made of"
    )


@advice_text.register
def _exclude_runs(advice: ExcludeRuns) -> str:
    """Advise to leave out runs that do not fit the others: rows of a table, or run folders."""
    found = [re.fullmatch(r"(.+) row (\d+)", name) for name in advice.runs]
    tables: dict[str, list[str]] = {}
    for row in filter(None, found):
        tables.setdefault(row[1], []).append(row[2])
    lines = [
        f"[runs] leave_out = [{', '.join(rows)}]  # of {name}" for name, rows in tables.items()
    ]
    lines += [
        f"zebro-lab exclude DATA/{name} --why REASON"
        for name, row in zip(advice.runs, found, strict=True) if row is None
    ]  # fmt: skip
    return (
        f"{advice.reason}: where the lab notes tell why (another material, a lost zero), leave "
        f"these out{' in columns.toml' if tables else ', each with its reason'}, and give the "
        "same command again:\n" + "\n".join(lines)
    )


def _plan(what: str, tables: dict[str, dict[str, str]], fit: str) -> str:
    """Format lines of a plan, and the commands that run and fit it, as text of several lines.

    Args:
        what: What to do, and why.
        tables: Values in TOML, by table and key of the plan.
        fit: What to do with the data.
    """
    heads = (f"[{table}]\n" + "\n".join(f"{key} = {value}" for key, value in keys.items())
             for table, keys in tables.items())  # fmt: skip
    return (
        f"{what}. In a copy of the plan, set these:\n"
        + "\n".join(heads)
        + "\nRun the copy into another folder, with the other options as before "
        f"(zebro-lab rig run COPY --rig RIG --data FURTHER), {fit}"
    )
