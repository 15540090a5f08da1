# SPDX-License-Identifier: MIT
"""`zebro-lab import`: convert files from other software to run folders."""

from datetime import datetime
from pathlib import Path
from typing import Annotated

import typer

from zebro_lab.terminal.messages import say

EPILOG = """
Examples:

zebro-lab import --legs legs.csv --robot robot.toml --data data

zebro-lab import --legs bag.mcap --track path.tum --imu imu.csv --robot robot.toml --label circle
--start 2026-03-04T05:06:07+00:00 --data data

zebro-lab import --rig sweep.csv --material "POM on steel" --data data

Names and units through a columns.toml beside the files, or --columns FILE: with sections
[legs.columns], [imu.columns], [track.columns], [rig.columns] where there are several files.
docs/formats.md says more.
"""

Legs = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Leg angles: CSV, Parquet, or a ROS 2 log in MCAP."),
]
Track = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="The robot's path: CSV, Parquet or TUM (.tum, .txt)."),
]
Imu = Annotated[
    Path | None, typer.Option(metavar="FILE", help="Orientation of the body: CSV or Parquet.")
]
Rig = Annotated[
    Path | None, typer.Option(metavar="FILE", help="Table of a slip rig: CSV or Parquet.")
]
Robot = Annotated[Path | None, typer.Option(metavar="FILE", help="robot.toml, kept with the run.")]
Columns = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="columns.toml in place of those beside the files."),
]
Data = Annotated[Path, typer.Option(metavar="DIR", help="Folder of run folders.")]
Label = Annotated[str | None, typer.Option(help="Name of the run; without it the file's.")]
Start = Annotated[
    str | None,
    typer.Option(metavar="TIME", help="When the files' time was 0: 2026-03-04T05:06:07+00:00."),
]
Material = Annotated[str, typer.Option(help="Leg and ground material.")]
Operator = Annotated[str, typer.Option(help="Who recorded the files.")]


def import_files(
    data: Data,
    legs: Legs = None,
    track: Track = None,
    imu: Imu = None,
    rig: Rig = None,
    robot: Robot = None,
    columns: Columns = None,
    label: Label = None,
    start: Start = None,
    material: Material = "unknown",
    operator: Operator = "unknown",
) -> None:
    """Convert files from other software to run folders: DIR/RUN/{run.json, log.mcap, track/}."""
    from rich.console import Console

    from zebro_lab.exchange.import_stage import ImportRequest, import_run
    from zebro_lab.runs.manifest import read_manifest
    from zebro_lab.terminal.progress import progress_bar

    request = ImportRequest(
        data=data,
        legs=legs,
        track=track,
        imu=imu,
        rig=rig,
        robot=robot,
        columns=columns,
        label=label,
        start=_moment(start),
        material=material,
        operator=operator,
    )
    with progress_bar(Console(stderr=True)) as watcher:
        imported = import_run(request, watcher)
    for note in imported.notes:
        say(note)
    for folder in imported.folders:
        manifest = read_manifest(folder)
        simulated = "SIMULATED " if manifest.source.startswith("sim:") else ""
        counts = ", ".join(f"{count} {topic}" for topic, count in manifest.streams.items())
        say(f"{simulated}{manifest.source}: {counts}: {folder}")


def _moment(text: str | None) -> datetime | None:
    try:
        return None if text is None else datetime.fromisoformat(text)
    except ValueError as error:
        message = f"found '{text}'; expected a time such as 2026-03-04T05:06:07+00:00"
        raise typer.BadParameter(message, param_hint="--start") from error
