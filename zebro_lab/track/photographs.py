# SPDX-License-Identifier: MIT
"""Find the photographs behind a track by their hashes, and rectify them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.body.plane import Plane
from tracking.camera import Camera, CameraPose
from tracking.errors import TrackingError
from tracking.floor import FloorMap, locate_camera
from tracking.images import read_pixels
from tracking.photos.scene import Photo
from tracking.photos.search import Wanted, look_at
from zebro_lab.files.errors import DataError, NotFound, SettingsError
from zebro_lab.files.provenance import file_hash
from zebro_lab.files.source_names import is_simulated
from zebro_lab.tables.table_files import read_table_file
from zebro_lab.track.annotations import ANNOTATIONS_FILE, Annotations, read_annotations
from zebro_lab.track.camera_file import read_camera_file
from zebro_lab.track.floor_file import FLOOR_FILE, read_floor_file
from zebro_lab.track.folder import TRACK_CSV, read_track_manifest
from zebro_lab.track.photo_sequence import upright_size
from zebro_lab.track.request import VIDEOS


@dataclass(frozen=True)
class PlacedPhoto:
    """Photograph with the lens and the camera's pose.

    Attributes:
        pixels: Pixels in BGR, shape (height, width, 3).
        camera: The lens, scaled to the photograph's size.
        pose: Pose of the camera over the floor.
    """

    pixels: NDArray[np.uint8]
    camera: Camera
    pose: CameraPose

    def from_above(
        self, low: Array, high: Array, *, pixels_per_metre: float, height: float = 0.0
    ) -> NDArray[np.uint8]:
        """Rectify a level rectangle of the scene: compute the view from straight above.

        Args:
            low: Lowest x and y in the floor frame, shape (2,) [m].
            high: Highest x and y in the floor frame, shape (2,) [m].
            pixels_per_metre: Scale of the result [px/m].
            height: Height of the rectangle above the floor [m].

        Returns:
            BGR picture, x to the right and y up; black outside the photograph, meaningless behind
            the camera. What is not at that height is displaced.
        """
        raster = Plane.over(
            self.camera, self.pose, height=height, low=low, high=high, cell=1 / pixels_per_metre
        )
        return np.clip(np.round(raster.read(self.pixels)), 0, 255).astype(np.uint8)


@dataclass(frozen=True)
class TrackedPhotos:
    """Photographs of a track, with camera, floor and annotations.

    Attributes:
        t: Time of each pose in the track's time base, shape (n,) [s].
        names: Name of the photograph or exposure of each pose, n names.
        files: File of each photograph, by name.
        camera: The lens, at the size it was calibrated with.
        floor: The floor as refined with the photographs.
        annotations: A person's annotations of the photographs.
        simulated: Whether the photographs are simulated.
    """

    t: Array
    names: tuple[str, ...]
    files: Mapping[str, Path]
    camera: Camera
    floor: FloorMap
    annotations: Annotations = field(default_factory=Annotations)
    simulated: bool = False

    def view(self, name: str) -> PlacedPhoto:
        """Read a photograph and compute the camera's pose from its floor marks and clicks.

        Raises:
            TrackingError: The photograph is unreadable or does not show enough marks of the floor,
                or the map does not fit them.
        """
        file = self.files[name]
        size = upright_size(file) or self.camera.size
        camera = self.camera.scaled(size)
        look = look_at(Photo(name, file), Wanted(size, self.floor, None))
        if look.seen is None:
            raise TrackingError(f"{name}: {look.problem}")
        view = look.seen.floor.with_clicked(self.annotations.clicks.get(name, {}))
        pose = locate_camera(camera, self.floor, view)
        return PlacedPhoto(read_pixels(file, size=size), camera, pose)


def photos_of_track(track: Path) -> TrackedPhotos:
    """Find the photographs that a track folder, named itself or by its track.csv, was made from.

    Raises:
        NotFound: The folder is not a track folder, or a photograph or `camera.toml` has moved.
        DataError: The track is of a video, whose frames are not kept, `track.csv` does not name
            photographs, or a photograph or `camera.toml` has changed.
        SettingsError: `floor.toml` or `annotations.toml` of the folder is invalid.
    """
    folder = track if track.is_dir() else track.parent
    manifest = read_track_manifest(folder)
    t, names = _poses_of(folder / TRACK_CSV)
    inputs = {Path(path): str(digest) for path, digest in manifest["inputs"].items()}
    annotated = folder / ANNOTATIONS_FILE
    return TrackedPhotos(
        t=t,
        names=names,
        files={name: _file_of(name, inputs) for name in names},
        camera=_camera(inputs, folder),
        floor=read_floor_file(folder / FLOOR_FILE),
        annotations=read_annotations(annotated) if annotated.is_file() else Annotations(),
        simulated=is_simulated(str(manifest["source"])),
    )


def _poses_of(file: Path) -> tuple[Array, tuple[str, ...]]:
    """Read time [s] and name of the photograph of each pose of a track, n each.

    Raises:
        DataError: The table has no column `photo`, as that of an imported track.
    """
    table = read_table_file(file)
    if "photo" not in table.columns:
        raise DataError("has no column photo; a track that was imported has none", file=file)
    return table.numbers("t_s"), tuple(str(name) for name in table.columns["photo"])


def _file_of(name: str, inputs: Mapping[Path, str]) -> Path:
    """Return the unchanged file of a photograph; `NAME#3` is an exposure of the file NAME.

    Raises:
        NotFound: The file is not among the inputs, or no longer exists.
        DataError: The file is a video, or its SHA-256 has changed.
    """
    plain = name.rpartition("#")[0] or name
    file = next((path for path in inputs if path.name == plain), None)
    if file is None or not file.is_file():
        raise NotFound(f"{file or plain}: the photograph is not where it was when it was tracked")
    if file.suffix.lower() in VIDEOS:
        raise DataError("is a video, whose frames are not kept", file=file)
    if file_hash(file) != inputs[file]:
        raise DataError("is another photograph than the one that was tracked", file=file)
    return file


def _camera(inputs: Mapping[Path, str], folder: Path) -> Camera:
    """Read the track's lens from its inputs: the first TOML file that is a `camera.toml`.

    Raises:
        DataError: This file has changed since the track was made.
        NotFound: No such file is where it was.
    """
    for path, digest in inputs.items():
        if path.suffix == ".toml" and path.is_file():
            try:
                camera = read_camera_file(path)
            except SettingsError:  # the floor's or the robot's
                continue
            if file_hash(path) != digest:
                raise DataError("has changed: it is not the camera file of this track", file=path)
            return camera
    raise NotFound(f"{folder}: the camera.toml of this track is not where it was, or damaged")
