# SPDX-License-Identifier: MIT
"""`zebro-lab camera kit | calibrate | clock`: preparations before photographs are taken."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, TypeAlias

import typer

from zebro_lab.terminal.command_classes import Application
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import Range, request_command
from zebro_lab.track.camera.request import CameraRequest

if TYPE_CHECKING:
    from zebro_lab.track.camera.stage import CameraResult

Paper: TypeAlias = Literal["a4", "letter"]

app = Application(
    no_args_is_help=True, help="Print the tracking kit, calibrate the camera, show its clock code."
)

CALIBRATE_EPILOG = """
Examples:

zebro-lab camera calibrate board-photos

zebro-lab camera calibrate board-photos --board checkerboard:9x6:25mm --out camera.toml
"""


KIT_EPILOG = """
Examples:

zebro-lab camera kit

zebro-lab camera kit --board checkerboard:9x6:25mm --paper letter
"""


@app.command(epilog=KIT_EPILOG)
@request_command()
def kit(
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder to write.")] = Path(
        "tracking-kit"
    ),
    paper: Annotated[Paper, typer.Option(help="Size of the paper.")] = "a4",
    board: Annotated[
        str,
        typer.Option(
            metavar="BOARD",
            help="Calibration board to print, as for camera calibrate: kit, or "
            "checkerboard:COLUMNSxROWS:SQUARE (inner corners).",
        ),
    ] = "kit",
    output: Output = TEXT,
) -> None:
    """Write a true-scale PDF of markers, board and ruler, and a floor.toml to edit."""
    from zebro_lab.track.camera.stage import write_kit

    files = list(write_kit(out, paper=paper, board=board))
    for file in files:
        output.say(f"wrote {file}")
    output.say("print kit.pdf at 100 % and measure the 100 mm bar of every page")
    output.document("camera kit", {"written": files})


@app.command(epilog=CALIBRATE_EPILOG)
@request_command()
def calibrate(request: CameraRequest, output: Output = TEXT) -> None:
    """Calibrate the lens from photographs of a board: camera.toml."""
    from tracking.errors import TrackStopped
    from zebro_lab.track.camera.stage import calibrate_camera

    with output.progress(TrackStopped) as watcher:
        result = calibrate_camera(request, watcher)
    for line in calibration_lines(result):
        output.say(line)
    fit = result.fit
    content = {"written": [result.file], "lens_model": fit.lens_model, "size_px": fit.camera.size}
    lens = {"matrix_px": fit.camera.matrix, "distortion": fit.camera.distortion}
    found = {"rms_px": fit.rms, "coverage": fit.coverage, "photographs": list(fit.view_names)}
    notes = {"left_out": result.left_out, "warnings": list(fit.warnings)}
    output.document("camera calibrate", {**content, **lens, **found, **notes})


def calibration_lines(result: "CameraResult") -> list[str]:
    """Format a calibration: left-out files, lens ± sd, misfit, coverage, warnings, written file."""
    fit = result.fit
    matrix, sd = fit.camera.matrix, fit.sd
    width, height = fit.camera.size
    numbers = (
        ("fx", matrix[0, 0], sd[0]), ("fy", matrix[1, 1], sd[1]),
        ("cx", matrix[0, 2], sd[2]), ("cy", matrix[1, 2], sd[3]),
    )  # fmt: skip
    names = ("k1", "k2", "p1", "p2", "k3")
    bent = [
        f"{name} {value:.4f} ± {spread:.4f}"
        for name, value, spread in zip(names, fit.camera.distortion, sd[4:], strict=True)
        if value != 0  # else it was left out
    ]
    return [
        *(f"left out: {name}: {reason}" for name, reason in result.left_out.items()),
        f"{len(fit.view_names)} photographs of {width}x{height} px, lens model '{fit.lens_model}'",
        ", ".join(f"{name} {value:.2f} ± {spread:.2f} px" for name, value, spread in numbers),
        f"distortion {', '.join(bent) or 'none fitted'}",
        f"corners are off by {fit.rms:.3f} px (rms) and cover {fit.coverage:.0%} of the picture:",
        *("  " + " ".join("#" if count else "." for count in row) for row in fit.seen),
        *(f"WARNING: {warning}" for warning in fit.warnings),
        f"wrote {result.file}",
    ]


@app.command()
@request_command()
def clock(
    duration: Annotated[
        float | None,
        typer.Option(metavar="SECONDS", help="Time to show it [s]; default: until Ctrl-C."),
        Range(least=0),
    ] = None,
) -> None:
    """Show the computer's time as a QR code to photograph; give the photograph to track --clock."""
    from zebro_lab.terminal.progress import progress_bar
    from zebro_lab.track.camera.clock_screen import show_clock

    with progress_bar() as watcher:
        show_clock(watcher.stop_requested, duration=duration)
