# SPDX-License-Identifier: MIT
"""The command line `zebro-lab COMMAND`: collects all commands."""

from typing import Annotated

import typer

from zebro_lab.exchange.export_command import export
from zebro_lab.exchange.import_command import EPILOG as IMPORT_EPILOG
from zebro_lab.exchange.import_command import import_files
from zebro_lab.exchange.init_command import init
from zebro_lab.experiment.command import app as rig
from zebro_lab.recording.check_command import app as zebro
from zebro_lab.recording.command import EPILOG as RECORD_EPILOG
from zebro_lab.recording.command import record
from zebro_lab.recording.doctor_command import EPILOG as DOCTOR_EPILOG
from zebro_lab.recording.doctor_command import doctor
from zebro_lab.recording.simulate_command import app as sim
from zebro_lab.report.command import EPILOG as REPORT_EPILOG
from zebro_lab.report.command import report
from zebro_lab.runs.command import exclude, runs
from zebro_lab.runs.plot_command import EPILOG as PLOT_EPILOG
from zebro_lab.runs.plot_command import plot
from zebro_lab.terminal.ending import run
from zebro_lab.track.annotate_command import EPILOG as ANNOTATE_EPILOG
from zebro_lab.track.annotate_command import annotate
from zebro_lab.track.camera.command import app as camera
from zebro_lab.track.command import EPILOG as TRACK_EPILOG
from zebro_lab.track.command import track
from zebro_lab.validation.command import EPILOG as VALIDATE_EPILOG
from zebro_lab.validation.command import validate
from zebro_lab.validation.compare.command import EPILOG as COMPARE_EPILOG
from zebro_lab.validation.compare.command import compare
from zebro_lab.walk.command import EPILOG as WALK_EPILOG
from zebro_lab.walk.command import walk
from zebro_lab.walk.predict_command import EPILOG as PREDICT_EPILOG
from zebro_lab.walk.predict_command import predict
from zebro_lab.walk_fit.command import EPILOG, calibrate

app = typer.Typer(
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    no_args_is_help=True,
)
app.command(epilog=EPILOG)(calibrate)
app.command()(init)
app.command(epilog=WALK_EPILOG)(walk)
app.command(epilog=PREDICT_EPILOG)(predict)
app.command(epilog=VALIDATE_EPILOG)(validate)
app.command(epilog=COMPARE_EPILOG)(compare)
app.command(epilog=REPORT_EPILOG)(report)
app.command(epilog=RECORD_EPILOG)(record)
app.command("import", epilog=IMPORT_EPILOG)(import_files)
app.command()(runs)
app.command(epilog=PLOT_EPILOG)(plot)
app.command()(exclude)
app.command()(export)
app.command(epilog=TRACK_EPILOG)(track)
app.command(epilog=ANNOTATE_EPILOG)(annotate)
app.command(epilog=DOCTOR_EPILOG)(doctor)
app.add_typer(camera, name="camera")
app.add_typer(rig, name="rig")
app.add_typer(sim, name="sim")
app.add_typer(zebro, name="zebro")

slip_app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)
slip_app.command(epilog=EPILOG)(calibrate)


def _print_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        typer.echo(f"zebro-lab {version('zebro-lab')}")
        raise typer.Exit


@app.callback()
def zebro_lab(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Print the version."
        ),
    ] = False,
) -> None:
    """Measure how a six-legged robot's feet slip and predict where it will walk."""


def main() -> None:
    """Run `zebro-lab`."""
    run(app)


def calibrate_slip() -> None:
    """Run `calibrate-slip`."""
    run(slip_app)
