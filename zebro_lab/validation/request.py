# SPDX-License-Identifier: MIT
"""Options of a validation."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from zebro_lab.files.names import is_ros_log
from zebro_lab.terminal.picture_options import FormatOption
from zebro_lab.terminal.request_command import Range
from zebro_lab.track.trajectory.request import TrajectoryRequest

_OF_RUNS = ("run.json", "prediction", "track")  # in a run folder


@dataclass(frozen=True)
class ValidateRequest:
    """Options of `zebro-lab validate`."""

    runs: Annotated[
        tuple[Path, ...],
        Argument(
            metavar="RUN|FILE",
            help="Run folders with prediction/ and track/; or two files with trajectories, the "
            "reference first: TUM, KITTI, EuRoC, a table or a ROS log.",
        ),
    ] = ()
    predicted: Annotated[
        tuple[Path, ...],
        Option(help="Walk folder, or a table with t [s], x, y [m] and yaw [rad]; repeatable."),
    ] = ()
    track: Annotated[
        tuple[Path, ...], Option(help="track.csv or its folder; one for each --predicted.")
    ] = ()
    out: Annotated[
        Path | None,
        Option(
            metavar="DIR",
            help="Folder to write; default: RUN/validation for one run, trajectories for two "
            "trajectories, else validation.",
        ),
    ] = None
    anchor: Annotated[
        bool,
        Option(
            "--anchor/--no-anchor",
            help="Start each path from the first tracked pose, or leave it where it was predicted.",
        ),
    ] = True
    time_offset: Annotated[
        float,
        Option(
            metavar="SECONDS",
            help="Time by which the clock of the track (of REFERENCE) is behind, added to its "
            "times [s].",
        ),
    ] = 0.0
    estimate_offset: Annotated[
        bool,
        Option(
            "--estimate-offset",
            help="Estimate from the motion how far the track's clock is behind; the walk must "
            "have starts, stops or turns.",
        ),
    ] = False
    seed: Annotated[int, Option(help="Seed of all random numbers."), Range(least=0)] = 1
    trajectory: TrajectoryRequest = field(default_factory=TrajectoryRequest)
    columns: Annotated[
        Path | None,
        Option(
            metavar="FILE",
            help="columns.toml of trajectories in tables, instead of those beside them.",
        ),
    ] = None
    topic: Annotated[
        tuple[str, ...],
        Option(
            metavar="NAME",
            help="Topic of a ROS log, where it has poses on several; given twice, of the first and "
            "of the second file.",
        ),
    ] = ()
    max_difference: Annotated[
        float,
        Option(
            metavar="SECONDS",
            help="Largest difference of the times of two matched poses [s].",
        ),
        Range(least=0),
    ] = 0.01
    distance: Annotated[
        tuple[float, ...],
        Option(
            metavar="METRES",
            help="Distance of a relative error of trajectories [m]; repeatable; default: three "
            "round ones up to a quarter of the reference.",
        ),
        Range(above=0),
    ] = ()
    correct_scale: Annotated[
        bool,
        Option(
            "--correct-scale",
            help="Multiply ESTIMATE by the scale that fits best, as of one camera, which sees no "
            "scale.",
        ),
    ] = False

    @property
    def is_pair(self) -> bool:
        """Whether trajectories are given: a file or ROS log is among `runs`, and no run folder.

        A run folder has one of `_OF_RUNS`. Of `data/*`, with plots beside runs, the runs are meant.
        """
        files = any(is_ros_log(path) or path.is_file() for path in self.runs)
        return files and not any((path / name).exists() for path in self.runs for name in _OF_RUNS)

    form: FormatOption = "png"

    @property
    def folder(self) -> Path:
        """`--out` if given; else `trajectories` for a pair, RUN/validation for a single run alone.

        For several runs, or pairs of `--predicted` and `--track`, it is `validation`.
        """
        if self.out is not None:
            return self.out
        if self.is_pair:
            return Path("trajectories")
        alone = len(self.runs) == 1 and not self.predicted
        return self.runs[0] / "validation" if alone else Path("validation")
