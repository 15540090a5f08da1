# SPDX-License-Identifier: MIT
"""`zebro-lab COMMAND`: every command of the lab."""

from typing import Annotated

import typer

from zebro_lab.cli.annotate import EPILOG as ANNOTATE_EPILOG
from zebro_lab.cli.annotate import annotate
from zebro_lab.cli.calibrate import EPILOG, calibrate
from zebro_lab.cli.camera import app as camera
from zebro_lab.cli.compare import EPILOG as COMPARE_EPILOG
from zebro_lab.cli.compare import compare
from zebro_lab.cli.doctor import EPILOG as DOCTOR_EPILOG
from zebro_lab.cli.doctor import doctor
from zebro_lab.cli.errors import run
from zebro_lab.cli.import_files import EPILOG as IMPORT_EPILOG
from zebro_lab.cli.import_files import import_files
from zebro_lab.cli.init import init
from zebro_lab.cli.plot import EPILOG as PLOT_EPILOG
from zebro_lab.cli.plot import plot
from zebro_lab.cli.predict import EPILOG as PREDICT_EPILOG
from zebro_lab.cli.predict import predict
from zebro_lab.cli.record import EPILOG as RECORD_EPILOG
from zebro_lab.cli.record import record
from zebro_lab.cli.report import EPILOG as REPORT_EPILOG
from zebro_lab.cli.report import report
from zebro_lab.cli.rig import app as rig
from zebro_lab.cli.runs import exclude, export, runs
from zebro_lab.cli.sim import app as sim
from zebro_lab.cli.track import EPILOG as TRACK_EPILOG
from zebro_lab.cli.track import track
from zebro_lab.cli.validate import EPILOG as VALIDATE_EPILOG
from zebro_lab.cli.validate import validate
from zebro_lab.cli.walk import EPILOG as WALK_EPILOG
from zebro_lab.cli.walk import walk
from zebro_lab.cli.zebro import app as zebro

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
