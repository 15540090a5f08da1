# SPDX-License-Identifier: MIT
"""`zebro-lab annotate`: mark the robot, click on points of the floor, correct poses."""

from pathlib import Path
from typing import Annotated

import typer

from zebro_lab.terminal.messages import say

EPILOG = """
It opens no window. Pixels are read in a picture that --grid writes, with any viewer:

zebro-lab annotate photos --photo p01.jpg --grid grid.png

zebro-lab annotate photos --photo p01.jpg --grid corner.png --around 812,440 --reach 40

Examples:

zebro-lab annotate photos --photo p01.jpg --corners "812,440 871,447 860,512 799,503"
--plate 194mmx251mm@35mm

zebro-lab annotate photos --click p01.jpg:door=104,933 --click p01.jpg:drain=1460,251

zebro-lab annotate photos --move p07.jpg:0.83,0.12,15 --flip p09.jpg --delete p11.jpg

zebro-lab annotate photos --from clicked-elsewhere.toml
"""

_CORNERS = "U,V U,V U,V U,V"
Photo = Annotated[str | None, typer.Option(metavar="NAME", help="Photograph, for the others.")]
Corners = Annotated[
    str | None,
    typer.Option(
        metavar=_CORNERS,
        help="Robot's top: front left, front right, rear right, rear left [px].",
    ),
]
Plate = Annotated[
    str | None,
    typer.Option(metavar="LENGTHxWIDTH@HEIGHT", help="The top; the robot's body without it."),
]
Margin = Annotated[
    str, typer.Option(metavar="LENGTH", help="How much around it belongs to its picture.")
]
RobotToml = Annotated[
    Path | None, typer.Option("--robot", help="robot.toml; the thesis's robot without it.")
]
Clicks = Annotated[
    list[str] | None,
    typer.Option("--click", metavar="PHOTO:NAME=U,V", help="A point of floor.toml [px]."),
]
Moves = Annotated[
    list[str] | None,
    typer.Option("--move", metavar="PHOTO:X,Y,YAW", help="Where the robot is [m, m, deg]."),
]
Flips = Annotated[
    list[str] | None, typer.Option("--flip", metavar="PHOTO", help="Head and tail are exchanged.")
]
Deletes = Annotated[
    list[str] | None, typer.Option("--delete", metavar="PHOTO", help="That is not the robot.")
]
OrderOf = Annotated[
    str | None, typer.Option("--order", metavar="PHOTO,PHOTO,…", help="Taken in this order.")
]
Said = Annotated[
    Path | None, typer.Option("--from", metavar="TOML", help="Add what this file says.")
]
Grid = Annotated[
    Path | None, typer.Option(metavar="PNG", help="Draw --photo with a grid of pixels, and stop.")
]
Around = Annotated[str | None, typer.Option(metavar="U,V", help="Enlarge the grid there.")]
Reach = Annotated[int, typer.Option(min=5, help="How far from there [px].")]


def annotate(
    photos: Annotated[Path, typer.Argument(help="What track is given.")],
    out: Annotated[Path, typer.Option(help="File to write or to add to.")] = Path(
        "annotations.toml"
    ),
    photo: Photo = None,
    corners: Corners = None,
    plate: Plate = None,
    margin: Margin = "20mm",
    robot: RobotToml = None,
    click: Clicks = None,
    move: Moves = None,
    flip: Flips = None,
    delete: Deletes = None,
    order: OrderOf = None,
    said: Said = None,
    grid: Grid = None,
    around: Around = None,
    reach: Reach = 100,
) -> None:
    """Annotate photographs for the tracker: annotations.toml, used by track --annotations."""
    if grid is not None and photo is None:
        raise typer.BadParameter("needed: which photograph to draw", param_hint="'--photo'")
    if grid is None and not any((corners, click, move, flip, delete, order, said)):
        raise typer.BadParameter(
            "nothing is said; give --corners, --click, --move, --flip, --delete, --order, --from "
            "or --grid",
            param_hint="'annotate'",
        )
    from zebro_lab.files.units import quantity_to_si
    from zebro_lab.track.annotate_stage import AnnotateRequest, draw_grid
    from zebro_lab.track.annotate_stage import annotate as run

    if grid is not None and photo is not None:
        draw_grid(photos, photo, grid, around=around, reach=reach)
        say(f"wrote {grid}")
        return
    request = AnnotateRequest(
        photos, out, photo, corners, plate, quantity_to_si(margin, "m"), robot,
        click or (), move or (), flip or (), delete or (),
        order.split(",") if order else (), said,
    )  # fmt: skip
    written = run(request)
    template = "" if written.template is None else f"robot marked in {written.template.photo}, "
    clicks = sum(len(points) for points in written.clicks.values())
    say(f"{template}{clicks} points of the floor, {len(written.corrections)} corrections")
    say(f"wrote {out}; give it to track as --annotations {out}")
