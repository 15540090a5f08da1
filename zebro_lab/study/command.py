# SPDX-License-Identifier: MIT
"""`zebro-lab study sbc|coverage`: test the slip fit on simulated data of one's own layout."""

from typing import TYPE_CHECKING

import typer

from zebro_lab.study.request import CoverageRequest, SbcRequest
from zebro_lab.terminal.command_classes import Application
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command

if TYPE_CHECKING:
    from zebro_lab.study.stage import Studied

FAILED = 3

app = Application(
    help="Test the slip fit on simulated experiments: those of a plan, or like your own data.",
    no_args_is_help=True,
)

_WORKERS = """
Replicates are the same on this machine's cores and on a Dask cluster. --scheduler needs the extra
"cluster" here and on the workers; whoever reaches a scheduler can run any program on its workers:
docs/cluster.md.
"""
SBC_EPILOG = f"""
Examples:

zebro-lab study sbc --plan plan.toml

zebro-lab study sbc --calibration calibration --replicates 500

zebro-lab study sbc --wrong independent-noise --replicates 100

zebro-lab study sbc --scheduler tcp://127.0.0.1:8786

Parameters of law, load cell, rig and noise are drawn from the priors, blocks of data are simulated
and fitted, and each true value is ranked among the posterior's draws: the ranks of a correct fit
are uniform.
{_WORKERS}
Exit codes: 0 passed or not testable, 1 error, 2 usage, 3 a test failed, 130 stopped.
"""
COVERAGE_EPILOG = f"""
Examples:

zebro-lab study coverage --plan plan.toml

zebro-lab study coverage --calibration calibration --replicates 100

zebro-lab study coverage --plan plan.toml --truth calibration

Experiments of one true law, on rigs whose errors are drawn from the priors, are simulated and
fitted: of 90 % intervals nine in ten have to hold the truth.
{_WORKERS}
Exit codes: 0 passed or not testable, 1 error, 2 usage, 3 intervals do not hold, 130 stopped.
"""


@app.command(epilog=SBC_EPILOG)
@request_command()
def sbc(request: SbcRequest, output: Output = TEXT) -> None:
    """Simulation-based calibration: are ranks of true values uniform, for every parameter?"""
    from zebro_lab.study.stage import study_sbc

    with output.progress() as watcher:
        studied = study_sbc(request, watcher)
    _end(studied, "study sbc", request, output)


@app.command(epilog=COVERAGE_EPILOG)
@request_command()
def coverage(request: CoverageRequest, output: Output = TEXT) -> None:
    """Coverage: how many 50 and 90 % intervals hold a truth that is known?"""
    from zebro_lab.study.stage import study_coverage

    with output.progress() as watcher:
        studied = study_coverage(request, watcher)
    _end(studied, "study coverage", request, output)


def _end(
    studied: "Studied", name: str, request: SbcRequest | CoverageRequest, output: Output
) -> None:
    """Print a study and its document; exit with `FAILED` if a test failed."""
    from zebro_lab.study.screen import lines, print_study

    print_study(output.console(), studied, request.out)
    code = FAILED if studied.result.failed else 0
    content = {
        "folder": request.out,
        "simulated": True,
        "title": studied.title,
        "notes": lines(studied),
        **studied.content,
    }
    output.document(name, content, exit_code=code)
    if code:
        raise typer.Exit(code)
