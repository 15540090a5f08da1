# SPDX-License-Identifier: MIT
"""Read and validate the inputs of tracking: camera, floor, robot, annotations, run."""

from dataclasses import dataclass, replace

from tracking import Scene
from zebro_lab.files.errors import SettingsError
from zebro_lab.robot.marker_numbers import require_apart
from zebro_lab.robot.robot_file import RobotFile, read_robot_file
from zebro_lab.runs.manifest import RunManifest, read_manifest
from zebro_lab.track.annotations import Annotations, read_annotations
from zebro_lab.track.camera_file import read_camera_file
from zebro_lab.track.clock import CountedTimes, counted_from, counted_later
from zebro_lab.track.floor_file import read_floor_file
from zebro_lab.track.photo_sequence import PhotoSequence, calibrated_for
from zebro_lab.track.request import TrackRequest
from zebro_lab.track.robot import body_prior, tracked_robot


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
        """Return the photographs' source: the option, else the files', the run's or "unknown"."""
        if self.request.source is not None:
            return self.request.source
        if sequence.source is not None or self.manifest is None:
            return sequence.source or "unknown"
        return self.manifest.source

    def require_complete(self) -> None:
        """Raise if an input that tracking needs is missing.

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
        """Count the photographs' times from the track's origin; none yet for a composite's.

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
    """Return a warning if the lens is taken as exact, as its file states no standard deviations."""
    if inputs.scene.camera.covariance.any():
        return ()
    return (
        f"the lens is taken as exact, as {inputs.request.camera} states no standard deviations; "
        "`zebro-lab camera calibrate` writes them",
    )
