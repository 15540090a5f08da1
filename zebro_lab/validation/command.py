# SPDX-License-Identifier: MIT
"""`zebro-lab validate`: errors of predicted paths against tracked ones."""

import typer

from model.counted import counted
from zebro_lab.files.documents import read_json_document
from zebro_lab.files.names import is_ros_log
from zebro_lab.files.source_names import is_simulated
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command
from zebro_lab.validation.request import ValidateRequest

EPILOG = """
Examples:

zebro-lab validate data/20260101T120000Z_walk_tiles

zebro-lab validate --predicted prediction --track track/track.csv --out validation

zebro-lab validate --predicted a/prediction --track a/track --predicted b/prediction --track b/track

zebro-lab validate data/RUN --estimate-offset

zebro-lab validate groundtruth.txt slam.txt --max-difference 0.02

zebro-lab validate KITTI_00_gt.txt KITTI_00_ORB.txt --plane xz --times times.txt

zebro-lab validate walk.bag walk.bag --topic /ground_truth --topic /odom

Folders are runs, files are trajectories (TUM, KITTI, EuRoC, tables, ROS logs), of which the
reference comes first. Their errors are those of the program evo, in the plane and in space.

Unaligned errors come first: alignment hides a wrong start and a wrong heading. Every path starts
from the first tracked pose, which is not scored.
"""


_ONLY_PAIRS = ("layout", "plane", "forward", "times", "columns", "topic", "max_difference",
               "distance", "correct_scale")  # fmt: skip
_ONLY_RUNS = ("predicted", "track", "anchor", "estimate_offset")


@request_command()
def validate(request: ValidateRequest, output: Output = TEXT) -> None:
    """Compute the errors of predicted paths against tracked ones, with baselines."""
    from zebro_lab.validation import screen, stage, trajectory_stage

    (_require_pair if request.is_pair else _require_runs)(request)
    run = trajectory_stage.validate_pair if request.is_pair else stage.validate
    with output.progress() as watcher:
        validated = run(request, watcher)
    screen.print_validated(output.console(), validated, request.folder)
    manifest = read_json_document(request.folder / "manifest.json")
    content = {"folder": request.folder, "simulated": is_simulated(validated.source)}
    output.document("validate", {**content, "validation": manifest})


def _require_runs(request: ValidateRequest) -> None:
    """Check that options are those of runs, and that there are as many predictions as tracks.

    Raises:
        BadParameter: An option is one of trajectories, the numbers differ, nothing is named, or a
            clock offset is both given and to be estimated.
    """
    _require_no_options(request, _ONLY_PAIRS, "belongs to two trajectories; give their files")
    n_predicted, n_tracks = len(request.predicted), len(request.track)
    if n_predicted != n_tracks or not (request.runs or n_predicted):
        raise typer.BadParameter(
            f"{n_predicted} --predicted and {n_tracks} --track; give the same number of both, one "
            "or more, or run folders"
        )
    if request.estimate_offset and request.time_offset:
        raise typer.BadParameter("give --time-offset, or let --estimate-offset find it; not both")


def _require_pair(request: ValidateRequest) -> None:
    """Check that there are two files, and that options are those of trajectories.

    Raises:
        BadParameter: There are not two files, a folder other than a ROS log is among them, an
            option is one of runs, or a topic is given without a ROS log.
    """
    logs = [path for path in request.runs if is_ros_log(path)]
    folders = [path for path in request.runs if path.is_dir() and path not in logs]
    if folders or len(request.runs) != 2:
        found = f", of which {folders[0]} is a folder" if folders else ""
        raise typer.BadParameter(
            f"{counted(len(request.runs), 'path')}{found}; give run folders, or two files "
            "of trajectories: REFERENCE ESTIMATE"
        )
    if request.topic and not logs:
        raise typer.BadParameter("belongs to ROS logs; no file is one", param_hint="--topic")
    _require_no_options(request, _ONLY_RUNS, "belongs to predicted walks, not to trajectories")


def _require_no_options(request: ValidateRequest, names: tuple[str, ...], problem: str) -> None:
    """Raise `BadParameter` for the first of these options that differs from its default."""
    default = ValidateRequest()
    for name in names:
        given, usual = (
            getattr(each.trajectory if hasattr(each.trajectory, name) else each, name)
            for each in (request, default)
        )
        if given != usual:
            raise typer.BadParameter(problem, param_hint=f"--{name.replace('_', '-')}")
