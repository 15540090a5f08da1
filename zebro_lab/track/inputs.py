# SPDX-License-Identifier: MIT
"""Read and validate the inputs of tracking: camera, floor, robot with its prior, notes, run."""

from dataclasses import dataclass, replace

import numpy as np

from tracking import Scene
from tracking.detect import MarkedRobot, RobotMarker
from tracking.errors import TrackingError
from tracking.pose import BodyPrior
from zebro_lab.files.errors import SettingsError
from zebro_lab.robot.marker_numbers import require_apart, require_in_dictionary
from zebro_lab.robot.robot_file import RobotFile, read_robot_file
from zebro_lab.runs.manifest import RunManifest, read_manifest
from zebro_lab.track.annotations import Annotations, read_annotations
from zebro_lab.track.camera_file import read_camera_file
from zebro_lab.track.clock import CountedTimes, counted_from, counted_later
from zebro_lab.track.floor_file import read_floor_file
from zebro_lab.track.photo_sequence import PhotoSequence, calibrated_for
from zebro_lab.track.request import TrackRequest

WALKING_TILT_SD = 0.02
"""Standard deviation of roll and of pitch, both of their means and about these [rad]."""

STEEPEST = 0.05
"""Roll or pitch beyond which a marker on the robot is not level [rad]."""


def tracked_robot(described: RobotFile, *, prior: BodyPrior) -> MarkedRobot:
    """Return the robot with its marker from `robot.toml`.

    In `robot.toml` the marker's x axis is the print's upward direction: a print whose top points
    ahead has yaw 0. The yaw of the result is that of the print's rightward direction, pi/2 less.

    Args:
        described: Content of `robot.toml`.
        prior: Prior on height and tilt of the body.

    Raises:
        SettingsError: The marker's place is missing or not level, or the marker is invalid: of
            another form, not in its dictionary, or of an impossible size.
    """
    place = described.marker
    if place is None:
        raise SettingsError(
            "missing; state the marker's place on the robot (docs/formats.md), or track it "
            "--without-marker",
            file=_file(described), key="marker",
        )  # fmt: skip
    roll, pitch, yaw = place.roll_pitch_yaw
    if max(abs(roll), abs(pitch)) > STEEPEST:
        raise SettingsError(
            f"roll {np.degrees(roll):.2f} and pitch {np.degrees(pitch):.2f} degrees; a marker on "
            f"the robot must lie within {np.degrees(STEEPEST):.2f} degrees of level in both",
            file=described.file, key="marker.roll_pitch_yaw_deg",
        )  # fmt: skip
    printed = place.printed
    try:
        require_in_dictionary(printed.dictionary, [printed.number])
        on_robot = RobotMarker(
            printed.number, printed.side, printed.dictionary, place.position, yaw=yaw - np.pi / 2,
            side_sd=place.side_sd, position_sd=place.position_sd, yaw_sd=place.yaw_sd,
        )  # fmt: skip
    except TrackingError as error:
        raise SettingsError(str(error), file=_file(described), key="marker") from error
    return MarkedRobot(on_robot, prior)


def body_prior(
    described: RobotFile, *, height: float | None, mean_height_sd: float, height_sd: float
) -> BodyPrior:
    """Return the prior on the body's height, from a given height or from the marker's.

    Args:
        described: Content of `robot.toml`.
        height: Mean height of the body's origin over a walk [m]; None to compute the standing
            robot's from the measured height of its marker.
        mean_height_sd: Standard deviation of that mean [m].
        height_sd: Standard deviation of the height about its mean [m].

    Raises:
        SettingsError: The height is not known, or a standard deviation is not positive.
    """
    for sd, key in ((height_sd, "--height-sd"), (mean_height_sd, "--mean-height-sd")):
        if not sd > 0:
            raise SettingsError(f"is {sd:g} m; expected more than 0", key=key)
    if height is None:
        height = _standing_height(described)
    return BodyPrior(
        height, height_sd, mean_height_sd=mean_height_sd, tilt_sd=WALKING_TILT_SD,
        mean_tilt_sd=WALKING_TILT_SD,
    )  # fmt: skip


def _standing_height(described: RobotFile) -> float:
    """Compute the height of the standing body's origin: the marker's minus its place above it [m].

    Raises:
        SettingsError: The marker's height above the floor is not in `robot.toml`.
    """
    place = described.marker
    if place is None or place.height is None:
        raise SettingsError(
            "missing; measure how high the marker is above the floor while the robot stands, or "
            "give --body-height",
            file=_file(described), key="marker.height",
        )  # fmt: skip
    return place.height - place.position[2]


def _file(described: RobotFile) -> str:
    """Return the path of the `robot.toml` for an error; without one, that no robot is named."""
    return str(described.file or "the thesis's robot (choose another with --robot)")


@dataclass(frozen=True)
class TrackInputs:
    """Inputs of tracking, read from files.

    Attributes:
        request: Options of `zebro-lab track`.
        scene: Camera, floor, robot and annotations; the lens at the size it was calibrated with.
        annotations: A person's annotations of the photographs; empty without a file.
        manifest: Manifest of the photographed run; None without a run.
    """

    request: TrackRequest
    scene: Scene
    annotations: Annotations
    manifest: RunManifest | None

    def scene_of(self, sequence: PhotoSequence) -> Scene:
        """Return the scene with the lens scaled to the size of most of the photographs.

        Raises:
            DataError: The photographs' aspect ratio differs from the calibration's.
        """
        camera = calibrated_for(self.scene.camera, sequence)
        return replace(self.scene, camera=camera, is_composite=sequence.is_composite)

    def source_of(self, sequence: PhotoSequence) -> str:
        """Return the photographs' source: "real", "sim:WHAT" for simulated ones, or "unknown".

        It is the value of `--source` if given; else "sim:photographs" if a file's EXIF data say
        that it is simulated; else the source in the run's manifest; without a run "unknown".
        """
        if self.request.source is not None:
            return self.request.source
        if sequence.source is not None or self.manifest is None:
            return sequence.source or "unknown"
        return self.manifest.source

    def require_complete(self) -> None:
        """Check that the robot can be found in photographs, by its marker or its annotated top.

        Raises:
            SettingsError: The robot carries no marker and its top is not annotated.
        """
        if self.scene.robot is None and not self.scene.tops:
            raise SettingsError(
                "needed: without a marker the robot is found by its look; annotate its top in one "
                "photograph with `zebro-lab annotate PHOTOS --photo NAME --corners ...`",
                key="--annotations",
            )

    def counted_times(self, sequence: PhotoSequence) -> CountedTimes:
        """Count the photographs' times from the track's origin.

        The exposures of a composite picture have no times until they are found.

        Raises:
            SettingsError, TimesError: As in `counted_from`.
        """
        times, request = sequence.times, self.request.times
        if times is None:
            return counted_later(manifest=self.manifest, request=request)
        return counted_from(
            times, start=self.request.start, manifest=self.manifest, request=request
        )


def read_inputs(request: TrackRequest) -> TrackInputs:
    """Read and validate the files that the options of `zebro-lab track` name.

    Args:
        request: Options of `zebro-lab track`.

    Raises:
        ZebroLabError: A file is missing or invalid, the body's height is not known, or the robot
            has no marker although it is to be tracked by one.
        TrackingError: The robot's marker is also one of the floor's.
    """
    manifest = None if request.run is None else read_manifest(request.run)
    described = RobotFile() if request.robot is None else read_robot_file(request.robot)
    camera, floor = read_camera_file(request.camera), read_floor_file(request.floor)
    annotations = Annotations()
    if request.annotations is not None:
        annotations = read_annotations(request.annotations)
    prior = body_prior(
        described, height=request.stated_height, mean_height_sd=request.stated_mean_height_sd,
        height_sd=request.bounce_sd,
    )  # fmt: skip
    robot = None
    if not request.without_marker:
        robot = tracked_robot(described, prior=prior)
        require_apart(robot, floor)
    length, width = described.robot.body_size[:2]
    scene = Scene(
        camera, floor, prior, robot, tops=annotations.templates, clicks=annotations.clicks,
        corrections=annotations.corrections,
        body_size=(length, width),
    )  # fmt: skip
    return TrackInputs(request, scene, annotations, manifest)


def lens_note(inputs: TrackInputs) -> tuple[str, ...]:
    """Return a warning if the lens is taken as exact: its file states no standard deviations.

    Else an empty tuple.
    """
    if inputs.scene.camera.covariance.any():
        return ()
    return (
        f"the lens is taken as exact, as {inputs.request.camera} states no standard deviations; "
        "`zebro-lab camera calibrate` writes them",
    )
