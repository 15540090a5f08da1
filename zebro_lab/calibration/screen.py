# SPDX-License-Identifier: MIT
"""Terminal output of `calibrate-slip`: data, parameters, curve at each load, verdict."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from model.bayes.calibration import Calibration
from model.bayes.checks.check import Outcome
from model.bayes.drawing.convergence import MAX_PARETO_K
from model.bayes.estimate import BRAKING, Estimate, informed
from model.bayes.law_scores import LawScores
from model.bayes.preview import Preview
from model.bayes.prior_conflict import PriorShift
from model.bayes.run_out import DiscRunOut, RunOut
from model.bayes.verdict import MEANINGS, State
from model.counted import counted
from zebro_lab.calibration.advice import advice_texts
from zebro_lab.calibration.law_table import sentence, signed
from zebro_lab.calibration.rig_data import RigData
from zebro_lab.files.source_names import is_simulated
from zebro_lab.files.units import unit_symbol
from zebro_lab.terminal.tables import plain, plain_table


def print_data(console: Console, data: RigData) -> None:
    """Print what was read: source, numbers of samples and runs, and notes.

    Args:
        console: Console to print to.
        data: The rig data.
    """
    simulated = is_simulated(data.source)
    lines = [
        f"{'SIMULATED data' if simulated else 'data'}, source '{data.source}': "
        f"{counted(len(data.samples), 'sample')} in "
        f"{counted(len(data.samples.run_names), 'run')}",
        *data.notes,
        f"slip definition: {data.samples.definition}",
    ]
    for line in lines:
        console.print(plain(line))


def print_preview(console: Console, found: Preview) -> None:
    """Print the parameters of the first answer, which no check has seen, before sampling.

    If the answer is not reliable, a line says that there is none.

    Args:
        console: Console to print to.
        found: The first answer.
    """
    if not found.reliable:
        console.print(
            plain(
                "first answer: none, the posterior is far from its Laplace approximation (Pareto k "
                f"{found.pareto_k:.2f}, below {MAX_PARETO_K:g} needed); sampling decides"
            )
        )
        return
    console.print(
        plain(
            f"first answer for '{found.law}', not checked yet, by "
            f"{found.effective_size:.0f} effective draws of the Laplace approximation (Pareto k "
            f"{found.pareto_k:.2f}); sampling goes on to confirm it:"
        )
    )
    for e in found.estimates:
        unit = _unit(e)
        console.print(
            plain(
                f"  {e.parameter.name} {e.parameter.symbol} = {e.median:.4g}"
                f"{'' if unit == '-' else f' {unit}'}, 90 % interval {_interval(e)}"
            )
        )


def print_calibration(console: Console, calibration: Calibration, out: Path) -> None:
    """Print parameters, curve at each load, quality and verdict of a fit, and files written.

    Args:
        console: Console to print to.
        calibration: The finished fit.
        out: The calibration folder, whose whole content is listed.
    """
    _print_blocks(console, calibration)
    console.print(_parameter_table(calibration))
    _print_priors(console, calibration)
    for table in _curve_tables(calibration):
        console.print(table)
    _print_quality(console, calibration)
    _print_verdict(console, calibration)
    console.print(Text(f"\nwritten to {out}:"))
    for path in sorted(out.iterdir()):
        console.print(plain(f"  {path}"))


def _print_blocks(console: Console, calibration: Calibration) -> None:
    """Print how samples are averaged, the run-out of discs, and the comparison of laws."""
    blocks, choice = calibration.posterior.blocks, calibration.fit.block_choice
    correlation = choice.correlation
    lines = [
        f"Samples are averaged in {len(blocks)} blocks of about {choice.length} ({choice.reason})"
        + (f"; the noise is correlated over {correlation:.0f} samples." if correlation else "."),
    ]
    lines += _noise_lines(calibration)
    lines += run_out_lines(calibration.run_out)
    lines += _comparison_lines(calibration)
    for line in lines:
        console.print(plain(line))
    if isinstance(calibration.comparison, LawScores):
        console.print(_law_table(calibration.comparison))


def _noise_lines(calibration: Calibration) -> list[str]:
    """Say which share of the fast part of slip is true change of slip (wander), if any."""
    wander = calibration.fit.block_choice.wander
    if wander is None or wander.used == 0:
        return []
    return [
        f"fast part of slip: traction follows {wander.share:.0%} ± {wander.sd:.0%} of it, "
        "which is taken for wander of the slip; the rest for noise of the speeds"
    ]


def run_out_lines(found: RunOut | None) -> list[str]:
    """Say how far discs whose angles are recorded run out of true, and whether slip is corrected.

    Args:
        found: Their run-out; None where no angle is recorded.
    """
    if found is None:
        return []

    def told(disc: DiscRunOut) -> str:
        by = zip(disc.amplitudes, disc.amplitude_sd, ("once", "twice"), strict=True)
        of = ", ".join(f"{1e3 * a:.3f} ± {1e3 * sd:.3f} mm {often} a turn" for a, sd, often in by)
        return f"{disc.disc} disc {of}"

    gain = f"{found.gain:+.1f} ± {found.standard_error:.1f} in log probability"
    done = (
        f"slip is corrected for it, which predicts left-out runs better ({gain})"
        if found.used
        else f"slip is not corrected, which would not predict left-out runs clearly better ({gain})"
    )
    return [f"run-out: {'; '.join(told(disc) for disc in found.discs)}; {done}"]


def _comparison_lines(calibration: Calibration) -> list[str]:
    """Say which law was chosen and how much others differ in predicting left-out runs."""
    comparison = calibration.comparison
    if comparison is None:
        return []
    if isinstance(comparison, LawScores):
        return [f"law: {sentence(comparison)}"]
    chosen = comparison.names[comparison.chosen]
    others = [
        f"'{name}' predicts left-out runs {'worse' if difference < 0 else 'better, not clearly,'} "
        f"by {abs(difference):.0f} ± {error:.0f} in log probability"
        for i, (name, difference, error) in enumerate(
            zip(comparison.names, comparison.difference, comparison.standard_error, strict=True)
        )
        if i != comparison.chosen
    ]
    return [f"law: {chosen} ({'; '.join(others)})"]


def _law_table(scores: LawScores) -> Table:
    """Return the scores of all laws, the fitted one and the clearly worse marked."""
    title = (
        "log predictive density of what was left out, less that of the fitted law (with standard "
        "error)"
    )
    numbers = ("para-\nmeters", "left-out\nruns", "left-out\nloads", "fits\nanew")
    table = plain_table(title, ("law", ""), numbers, no_wrap=True)
    for index, score in enumerate(scores.laws):
        mark = "fitted" if index == scores.chosen else "clearly worse"
        mark = "" if index in scores.told_together and index != scores.chosen else mark
        loads = scores.loads(index, scores.chosen)
        anew = int(score.runs.refitted.sum())
        anew += 0 if score.loads is None else int(score.loads.refitted.sum())
        own = index == scores.chosen
        table.add_row(
            score.name,
            mark,
            f"{len(score.law.parameters)}",
            "0" if own else signed(scores.runs(index, scores.chosen)),
            "not testable" if loads is None else "0" if own else signed(loads),
            f"{anew}",
        )
    return table


def _parameter_table(calibration: Calibration) -> Table:
    """Return a table of the parameters' posterior, with diagnostics of the free ones."""
    title = f"parameters of '{calibration.posterior.law.name}' and of the measurement"
    if is_simulated(calibration.source):
        title += " (simulated)"
    numbers = ("median", "90 % interval", "unit", "informed", "R-hat", "ESS")
    table = plain_table(title, ("parameter", "symbol"), numbers, no_wrap=True)
    free = {p.name: i for i, p in enumerate(calibration.posterior.free)}
    for e in calibration.parameters:
        i = free.get(e.parameter.name)
        if i is None:
            table.add_row(e.parameter.name, e.parameter.symbol, f"{e.median:.4g}", "fixed")
            continue
        table.add_row(
            e.parameter.name,
            e.parameter.symbol,
            f"{e.median:.4g}",
            _interval(e),
            _unit(e),
            f"{informed(calibration.contraction[e.parameter.name]):.0%}",
            f"{calibration.convergence.r_hat[i]:.3f}",
            f"{calibration.convergence.ess_bulk[i]:.0f}",
        )
    return table


def _print_priors(console: Console, calibration: Calibration) -> None:
    """Print priors that were stated beside the posterior, and whether prior and data agree."""
    if not calibration.prior_shifts:
        return
    numbers = ("posterior", "unit", "shift [prior sd]")
    table = plain_table("priors that were stated", ("parameter", "prior"), numbers, fold=True)
    found = {e.parameter.name: e for e in calibration.parameters}
    for shift in calibration.prior_shifts:
        for name, moved in zip(shift.names, shift.shift, strict=True):
            e, prior = found[name], calibration.posterior.priors[name]
            posterior = f"{e.mean:.4g} ± {e.sd:.2g}"
            table.add_row(name, plain(prior.describe()), posterior, _unit(e), f"{moved:+.2f}")
    console.print(table)
    for shift in calibration.prior_shifts:
        console.print(plain(prior_words(shift)))


def prior_words(shift: PriorShift) -> str:
    """Say in a sentence whether a stated prior and the data agree.

    Args:
        shift: Comparison of the prior with the data.
    """
    single = len(shift.names) == 1
    what = f"prior of {shift.names[0]}" if single else "prior of the earlier calibration"
    if shift.conflict is None:
        return f"{what}: not testable, the data say almost nothing of it"
    tested = f"chi² {shift.statistic:.1f}, {counted(shift.freedom, 'degree')} of freedom"
    if not shift.conflict:
        return f"{what}: agrees with the data (p = {shift.p:.2g}; {tested})"
    farthest = shift.names[int(np.argmax(np.abs(shift.shift)))]
    largest = float(np.max(np.abs(shift.shift)))
    return (
        f"CONFLICT, {what}: the data move {farthest} by {largest:.1f} standard deviations of its "
        f"prior; so far they would in {shift.p:.1g} of experiments if the prior held ({tested}): "
        "check the prior and its unit, or the data; the posterior is a compromise between both"
    )


def _unit(e: Estimate) -> str:
    """Return the short form of an estimate's unit."""
    return unit_symbol(e.parameter.unit)


def _interval(e: Estimate) -> str:
    """Format the 90 % interval of an estimate."""
    return f"{e.low:.4g} … {e.high:.4g}"


def _curve_tables(calibration: Calibration) -> list[Table]:
    """Return the features of the curve at each load; where sides are apart a table for each."""
    title = (
        "slip curve at the median measured load of each load tested: median, and 90 % interval on "
        "the second line"
    )
    sides = [[e for e in row if e.parameter not in BRAKING] for row in calibration.curves]
    braking = [[e for e in row if e.parameter in BRAKING] for row in calibration.curves]
    if not braking[0]:
        return [_curve_table(title, calibration.levels, sides)]
    return [
        _curve_table(f"driving: {title}", calibration.levels, sides),
        _curve_table("braking: the same", calibration.levels, braking),
    ]


def _curve_table(title: str, levels: np.ndarray, curves: Sequence[Sequence[Estimate]]) -> Table:
    """Return a table of the curve's features, one row per load; `levels` are the loads [N]."""
    headings = (f"{e.parameter.symbol} [{_unit(e)}]" for e in curves[0])
    table = plain_table(title, (), ("Fn [N]", *headings))
    for load, row in zip(levels, curves, strict=True):
        table.add_row(f"{load:.4g}", *(f"{e.median:.4g}\n{e.low:.3g}…{e.high:.3g}" for e in row))
    return table


def _print_quality(console: Console, calibration: Calibration) -> None:
    """Print R² and RMSE of the fit, R² of cross-validation, and the time it took."""
    residuals = calibration.residuals
    lines = [
        f"Plain fit: {calibration.fit.plain.describe()}",
        f"Fit of the block means: R² {residuals.r_squared:.4f}, RMSE {residuals.rmse:.3g} N, RMSE "
        f"of F/Fn {residuals.rmse_over_load:.3g}",
    ]
    if calibration.fit.cross_validation is not None and calibration.r_squared is not None:
        lines.append(
            f"Cross-validation: R² {calibration.r_squared:.4f} of samples "
            f"({calibration.fit.cross_validation.scheme})"
        )
    what = "Weighting" if calibration.agreement is None else "Sampling"
    lines.append(f"{what} took {calibration.seconds:.0f} s.")
    for line in lines:
        console.print(plain(line))


_ANSWERS = {Outcome.PASSED: "Yes:", Outcome.FAILED: "NO:", Outcome.NOT_TESTABLE: "Cannot be told:"}
_STYLES = {State.TRUSTWORTHY: "bold green", State.AS_TESTED: "bold yellow"}


def _print_verdict(console: Console, calibration: Calibration) -> None:
    """Print verdict, the eight questions with their answers, and what to do next."""
    verdict = calibration.verdict
    style = _STYLES.get(verdict.state, "bold red")
    console.print(Text("\nverdict: " + verdict.headline(), style=style))
    console.print(plain(f"  That is: {MEANINGS[verdict.state]}."))
    for note in verdict.notes:
        console.print(plain(f"  note: {note}"))
    for number, check in enumerate(verdict.checks, 1):
        answer = f"  {number} {check.name} {_ANSWERS[check.outcome]} {check.evidence}"
        console.print(plain(answer), style="bold" if check.failed else None)
    if verdict.weak:
        console.print(
            plain(
                f"  Data hardly tell {', '.join(verdict.weak)} apart from the priors; what they "
                "tell are F_max and BCD above, the largest force and the slope."
            )
        )
    for text in advice_texts(calibration):
        first, *others = text.split("\n")
        for line in (f"next: {first}", *(f"  {other}" for other in others)):
            console.print(plain(f"  {line}"), soft_wrap=True)
