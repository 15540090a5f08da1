# SPDX-License-Identifier: MIT
"""Typer applications of `zebro-lab COMMAND`, with all commands, and of `calibrate-slip`."""

from zebro_lab.calibration.read_off import command as read_off
from zebro_lab.exchange import export_command, import_command, init_command
from zebro_lab.experiment import command as rig
from zebro_lab.reach import command as reach
from zebro_lab.recording import check_command, doctor_command, simulate_command
from zebro_lab.recording import command as record
from zebro_lab.report import command as report
from zebro_lab.runs import command as runs
from zebro_lab.runs import plot_command
from zebro_lab.suggest import command as suggest
from zebro_lab.terminal.command_classes import Application, Version
from zebro_lab.terminal.ending import run
from zebro_lab.track import annotate_command
from zebro_lab.track import command as track
from zebro_lab.track.camera import command as camera
from zebro_lab.validation import command as validate
from zebro_lab.validation.compare import command as compare
from zebro_lab.walk import command as walk
from zebro_lab.walk_fit import command as calibrate

app = Application(no_args_is_help=True)
app.command(epilog=calibrate.EPILOG)(calibrate.calibrate)
app.command("read-off", epilog=read_off.EPILOG)(read_off.read_off)
app.command()(init_command.init)
app.command(epilog=walk.EPILOG)(walk.walk)
app.command(epilog=reach.EPILOG)(reach.reach)
app.command(epilog=walk.PREDICT_EPILOG)(walk.predict)
app.command(epilog=validate.EPILOG)(validate.validate)
app.command(epilog=compare.EPILOG)(compare.compare)
app.command(epilog=report.EPILOG)(report.report)
app.command(epilog=record.EPILOG)(record.record)
app.command("import", epilog=import_command.EPILOG)(import_command.import_files)
app.command()(runs.runs)
app.command(epilog=plot_command.EPILOG)(plot_command.plot)
app.command()(runs.exclude)
app.command()(export_command.export)
app.command(epilog=track.EPILOG)(track.track)
app.command(epilog=annotate_command.EPILOG)(annotate_command.annotate)
app.command()(doctor_command.doctor)
app.add_typer(camera.app, name="camera")
rig.app.command(epilog=suggest.EPILOG)(suggest.suggest)
app.add_typer(rig.app, name="rig")
app.add_typer(simulate_command.app, name="sim")
app.add_typer(check_command.app, name="zebro")

slip_app = Application()
slip_app.command(epilog=calibrate.EPILOG)(calibrate.calibrate)


@app.callback()
def zebro_lab(version: Version = False) -> None:
    """Measure how a six-legged robot's feet slip and predict where it will walk."""


def main() -> None:
    """Run the command line `zebro-lab` on the arguments of the process, and exit."""
    run(app)


def calibrate_slip() -> None:
    """Run the command line `calibrate-slip` on the arguments of the process, and exit."""
    run(slip_app)
