# SPDX-License-Identifier: MIT
"""`zebro-lab annotate`: mark the robot, click on points of the floor, correct poses."""

from pathlib import Path
from typing import Annotated

import typer

from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import Range, request_command
from zebro_lab.track.annotate_request import AnnotateRequest

EPILOG = """
annotate opens no window. Read the pixels off a picture that --grid writes, in any image viewer:

zebro-lab annotate photos --photo p01.jpg --grid grid.png

zebro-lab annotate photos --photo p01.jpg --grid corner.png --around 812,440 --reach 40

Examples:

zebro-lab annotate photos --photo p01.jpg --corners "812,440 871,447 860,512 799,503"
--plate 194mmx251mm@35mm

zebro-lab annotate photos --click p01.jpg:door=104,933 --click p01.jpg:drain=1460,251

zebro-lab annotate photos --move p07.jpg:0.83,0.12,15 --flip p09.jpg --delete p11.jpg

zebro-lab annotate photos --from clicked-elsewhere.toml
"""

Grid = Annotated[
    Path | None,
    typer.Option(metavar="PNG", help="Only draw --photo with a grid of pixels."),
]
Around = Annotated[str | None, typer.Option(metavar="U,V", help="Enlarge --grid at this pixel.")]
Reach = Annotated[
    int, typer.Option(help="Half the width of the enlarged part [px]."), Range(least=5)
]


@request_command()
def annotate(
    request: AnnotateRequest,
    grid: Grid = None,
    around: Around = None,
    reach: Reach = 100,
    output: Output = TEXT,
) -> None:
    """Annotate photographs for the tracker: annotations.toml, used by track --annotations."""
    from zebro_lab.track import annotate_stage

    if grid is not None:
        if request.photo is None:
            raise typer.BadParameter("missing: name the photograph to draw", param_hint="'--photo'")
        annotate_stage.draw_grid(request.photos, request.photo, grid, around=around, reach=reach)
        output.say(f"wrote {grid}")
        output.document("annotate", {"written": [grid]})
        return
    if around is not None:
        raise typer.BadParameter("applies only with --grid", param_hint="'--around'")
    if request.is_empty:
        raise typer.BadParameter(
            "no annotation is given; use --corners, --click, --move, --flip, --delete, "
            "--from or --grid",
            param_hint="'annotate'",
        )
    written, out = annotate_stage.annotate(request), request.out
    photos = ", ".join(top.photo for top in written.templates)
    template = f"robot's top in {photos}, " if photos else ""
    clicks = sum(len(points) for points in written.clicks.values())
    output.say(f"{template}{clicks} points of the floor, {len(written.corrections)} corrections")
    output.say(f"wrote {out}; give it to track as --annotations {out}")
    counts = {"clicks": clicks, "corrections": len(written.corrections)}
    output.document("annotate", {"written": [out], **counts})
