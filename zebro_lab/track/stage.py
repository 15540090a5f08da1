# SPDX-License-Identifier: MIT
"""Photographs in, track folder out."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from datetime import datetime
from pathlib import Path

from tracking.composite import Merged
from tracking.images import open_picture, read_pixels
from zebro_lab.files.errors import SettingsError
from zebro_lab.files.provenance import file_hashes
from zebro_lab.files.result_folder import require_replaceable
from zebro_lab.robot.marker_numbers import require_apart
from zebro_lab.robot.marker_print import MarkerPrint
from zebro_lab.robot.robot_file import RobotFile, read_robot_file
from zebro_lab.runs.manifest import RunManifest, read_manifest
from zebro_lab.track.annotations import (
    ANNOTATIONS_FILE,
    Annotations,
    read_annotations,
    render_annotations,
)
from zebro_lab.track.camera_file import read_camera_file
from zebro_lab.track.clock import LATER, counted_from, untied
from zebro_lab.track.floor_file import FLOOR_FILE, read_floor_file, render_floor_file
from zebro_lab.track.folder import KIND, TRACKED, track_folder
from zebro_lab.track.photo_search import Photo, Watcher
from zebro_lab.track.photo_sequence import (
    VIDEOS,
    PhotoSequence,
    TimeRequest,
    by_name,
    calibrated_for,
    exposure_times,
    open_photos,
)
from zebro_lab.track.pictures import draw_track
from zebro_lab.track.robot import WALKING_HEIGHT_SD, body_prior, tracked_robot
from zebro_lab.track.tracker import Scene, Tracked, track_marker
from zebro_lab.track.tracker_body import track_body, track_composite

_HOW_MERGED = """\
needed: a picture does not tell how its exposures were merged. Look at the robots:
pasted: all are solid; where two overlap, one hides the other (cut out and laid on each other).
darkest: dark parts are solid, bright ones vanish; where two overlap, the darker of both shows.
mean: all are faint, and the floor shows through them (the average of all photographs)."""


class HowMergedUnknown(SettingsError):
    """Nobody said how the exposures of a composite picture were merged."""


@dataclass(frozen=True)
class TrackRequest:
    """What is asked of a track.

    Attributes:
        photos: Folder of photographs, video, or one composite picture.
        camera: The `camera.toml`.
        floor: The `floor.toml`.
        robot: The `robot.toml`; the source's robot when None.
        out: Folder to write; None for the run's own `track/`.
        run: Run folder the photographs belong to.
        times: How the photographs get their times.
        start: Moment from which time is counted; None for the run's start or the first photograph.
        marker: What is printed on the robot: dictionary, number and side; None for what the robot's
            file says.
        without_marker: Track the robot by its own picture, annotated in one photograph.
        merged: How the exposures of a composite picture were merged; None of other photographs.
        annotations: What a person said about the photographs.
        body_height: Height of the body's origin while the robot stands; None to take the marker's
            [m].
        height_sd: Standard deviation of that height over a walk [m].
        gap: Interval longer than which the path is interrupted; None for 3.5 usual ones [s].
        source: Where the photographs are from; None to take the files' word or the run's.
        workers: Processes to use.
    """

    photos: Path
    camera: Path
    floor: Path
    robot: Path | None = None
    out: Path | None = None
    run: Path | None = None
    times: TimeRequest = field(default_factory=TimeRequest)
    start: datetime | None = None
    marker: str | None = None
    without_marker: bool = False
    merged: Merged | None = None
    annotations: Path | None = None
    body_height: float | None = None
    height_sd: float = WALKING_HEIGHT_SD
    gap: float | None = None
    source: str | None = None
    workers: int = 1

    def __post_init__(self) -> None:
        is_picture = self.photos.is_file() and self.photos.suffix.lower() not in VIDEOS
        if self.merged is not None and self.photos.exists() and not is_picture:
            raise SettingsError("only with one composite picture", key="--merged")

    @property
    def folder(self) -> Path:
        """The track folder to write.

        Raises:
            SettingsError: Neither a run nor a folder is named.
        """
        if self.out is not None:
            return self.out
        if self.run is None:
            raise SettingsError("needed: --run RUN, to write RUN/track, or --out FOLDER")
        return self.run / KIND

    @property
    def named(self) -> tuple[Path, ...]:
        """Files that were named, beside the photographs."""
        files = (self.camera, self.floor, self.robot, self.annotations,
                 self.times.table, self.times.clock)  # fmt: skip
        return tuple(file for file in files if file is not None)

    @property
    def inputs(self) -> tuple[Path, ...]:
        """What is read, as it was named."""
        return (self.photos, *self.named, *((self.run,) if self.run is not None else ()))


@dataclass(frozen=True)
class TrackResult:
    """A track that was written.

    Attributes:
        folder: The track folder.
        tracked: What was found.
        photos: How many photographs or exposures there were.
        source: "real", "sim:what" or "unknown".
        times: Where times are from, and from when they are counted.
        is_composite: Whether they are exposures of one picture.
    """

    folder: Path
    tracked: Tracked
    photos: int
    source: str
    times: str
    is_composite: bool = False


def track(request: TrackRequest, watcher: Watcher) -> TrackResult:
    """Track a walk and write the track folder.

    Raises:
        ZebroLabError: A file or an option says what cannot be followed.
        TrackingError: The photographs do not give a track.
        TrackStopped: Somebody asked to stop.
    """
    folder = request.folder
    require_replaceable(folder, TRACKED, inputs=request.inputs)
    manifest = None if request.run is None else read_manifest(request.run)
    described = described_robot(request)
    with open_photos(request.photos, request.times, watcher=watcher) as sequence:
        scene = scene_of(request, described, sequence)
        source = source_of(request, manifest, sequence)
        tracked, said = _tracked(request, described, scene, sequence, manifest, watcher)
        tracked = replace(tracked, lost={**sequence.left_out, **tracked.lost})
        count = _count(tracked, sequence)
        result = TrackResult(folder, tracked, count, source, said, sequence.is_composite)
        watcher.step("pictures", None)
        _write(request, result, scene, sequence)
    return result


def described_robot(request: TrackRequest) -> RobotFile:
    """Read the robot that was named, or take the source's."""
    return RobotFile() if request.robot is None else read_robot_file(request.robot)


def scene_of(request: TrackRequest, described: RobotFile, sequence: PhotoSequence) -> Scene:
    """Read what is known before looking.

    Raises:
        ZebroLabError: A file says what cannot be followed.
    """
    camera = calibrated_for(read_camera_file(request.camera).camera, sequence)
    floor = read_floor_file(request.floor)
    said = Annotations() if request.annotations is None else read_annotations(request.annotations)
    prior = body_prior(described, height=request.body_height, height_sd=request.height_sd)
    robot = None
    if not request.without_marker:
        robot = tracked_robot(described, request.marker, prior=prior)
        require_apart(robot, floor)
    return Scene(camera, floor, prior, robot, said, request.workers)


def source_of(request: TrackRequest, manifest: RunManifest | None, sequence: PhotoSequence) -> str:
    """Say where the photographs are from: as told, as the files say, or as the run has it."""
    if request.source is not None:
        return request.source
    if sequence.source is not None or manifest is None:
        return sequence.source or "unknown"
    return manifest.source


def _tracked(
    request: TrackRequest, described: RobotFile, scene: Scene, sequence: PhotoSequence,
    manifest: RunManifest | None, watcher: Watcher,
) -> tuple[Tracked, str]:  # fmt: skip
    photos = [Photo(name, path) for name, path in zip(sequence.names, sequence.paths, strict=True)]
    if sequence.times is None:
        length, width = described.robot.body_size[:2]
        merged = require_merged(request, sequence)
        tracked = track_composite(
            scene, photos[0], times_of=lambda names: exposure_times(names, request.times),
            merged=merged, body_size=(length, width), watcher=watcher, gap=request.gap,
        )  # fmt: skip
        notes = ()
        if manifest is not None and request.times.table is None:
            notes = (untied(f"give seconds since the run's start as --times, or {LATER}"),)
        return _noted(tracked, notes), "times of exposures as given"
    counted = counted_from(
        sequence.times, start=request.start, manifest=manifest, asked=request.times
    )
    pairs = zip(counted.times.t.tolist(), counted.times.sd.tolist(), strict=True)
    times = dict(zip(sequence.names, pairs, strict=True))
    if scene.robot is None:
        tracked = track_body(scene, photos, times=times, watcher=watcher, gap=request.gap)
    else:
        tracked = track_marker(
            scene, scene.robot, photos, times=times, watcher=watcher, gap=request.gap
        )
    return _noted(tracked, counted.notes), counted.said


def require_merged(request: TrackRequest, sequence: PhotoSequence) -> Merged:
    """Return how exposures were merged.

    Raises:
        HowMergedUnknown: Nobody said.
    """
    if request.merged is not None:
        return request.merged
    with open_picture(sequence.paths[0]):
        pass  # what is no picture is told of as such
    raise HowMergedUnknown(_HOW_MERGED, key="--merged")


def _noted(tracked: Tracked, notes: tuple[str, ...]) -> Tracked:
    return replace(tracked, notes=(*notes, *tracked.notes))


def _count(tracked: Tracked, sequence: PhotoSequence) -> int:
    if sequence.is_composite:
        return len(tracked.track.observations)
    return len(sequence.names) + len(sequence.left_out)


def _write(
    request: TrackRequest, result: TrackResult, scene: Scene, sequence: PhotoSequence
) -> None:
    seen = result.tracked.floor
    videos = [sequence.origin] if sequence.origin.is_file() else list(sequence.paths)
    with track_folder(
        result.folder,
        result.tracked.track,
        source=result.source,
        settings=_settings(request, scene),
        inputs=file_hashes([*request.named, *videos]),
        report=_report(result),
    ) as draft:
        heading = f"The floor of {request.floor.name}, refined with the photographs."
        (draft / FLOOR_FILE).write_text(render_floor_file(seen.fit.floor, heading=heading))
        if request.annotations is not None:
            (draft / ANNOTATIONS_FILE).write_text(render_annotations(scene.said))
        _draw(draft, result, scene, sequence)


def _draw(draft: Path, result: TrackResult, scene: Scene, sequence: PhotoSequence) -> None:
    track, seen = result.tracked.track, result.tracked.floor
    # The last photograph shows the floor under the path's beginning, where no robot stands now.
    last = track.observations[-1].photo.rpartition("#")[0] if sequence.is_composite else None
    shown = last or track.observations[-1].photo
    detections = {each.photo: each for each in seen.detections}
    draw_track(
        draft, track, read_pixels(by_name(sequence)[shown]), camera=scene.camera,
        view=seen.fit.pose_of(shown), floor=seen.fit.floor, detection=detections.get(shown),
        title=sequence.origin.name,
        simulated=result.source.startswith("sim:"),
    )  # fmt: skip


def _report(result: TrackResult) -> Mapping[str, object]:
    fit = result.tracked.floor.fit
    return {
        "times": result.times,
        "photos": result.photos,
        "tracked": len(result.tracked.track.observations),
        "left_out": dict(result.tracked.lost),
        "notes": list(result.tracked.notes),
        "floor_misfit_px": fit.misfit_px,
        "camera_stands": len(fit.stands),
    }


def _settings(request: TrackRequest, scene: Scene) -> Mapping[str, object]:
    marker = None if scene.robot is None else scene.robot.marker
    return {
        "photos": request.photos.name,
        "marker": marker and MarkerPrint(marker.dictionary, marker.marker_id, marker.side).text,
        "interval": request.times.interval,
        "every": request.times.every,
        "start": None if request.start is None else request.start.isoformat(),
        "body_height": request.body_height,
        "height_sd": request.height_sd,
        "gap": request.gap,
        **({"merged": request.merged.value} if request.merged is not None else {}),
    }
