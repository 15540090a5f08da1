# SPDX-License-Identifier: MIT
"""Turn brightness into a photograph: exposure, blur, noise and compression."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from support.synthetic.robot import RobotLook, RobotState
from support.synthetic.robot_picture import paint_robot
from support.synthetic.scene import DrawnScene, Picture, render_background

Pixels = NDArray[np.uint8]

_FULL = 255.0


@dataclass(frozen=True)
class Conditions:
    """Conditions under which a photograph is taken; the defaults are favourable.

    Attributes:
        exposure: Share of full scale at which white paper in full light ends up [-].
        exposure_time: During which the robot moves [s].
        defocus_sd_px: Standard deviation of the blur over the whole picture [px].
        read_noise_counts: Noise without light, standard deviation of 255 [counts].
        shot_noise_counts: Noise at full scale; proportional to the root of the light [counts].
        jpeg_quality: Of the compression; None leaves it out.
    """

    exposure: float = 0.9
    exposure_time: float = 0.0
    defocus_sd_px: float = 0.0
    read_noise_counts: float = 1.0
    shot_noise_counts: float = 2.0
    jpeg_quality: int | None = 95


IDEAL = Conditions(read_noise_counts=0.0, shot_noise_counts=0.0, jpeg_quality=None)
HARSH = Conditions(
    exposure=0.3, defocus_sd_px=2.2, read_noise_counts=2.0, shot_noise_counts=4.0, jpeg_quality=75
)


@dataclass(frozen=True)
class SyntheticPhoto:
    """A synthetic photograph with its truth.

    Attributes:
        pixels: Blue, green and red, shape (height, width, 3).
        state: The robot's true state; None when it shows none.
        cover: Share of each pixel that the robot covers, before any blur, shape (height, width).
        jpeg: The compressed file that decodes to `pixels`; None when it was not compressed.
    """

    pixels: Pixels
    state: RobotState | None
    cover: Picture
    jpeg: bytes | None = None


def take_photo(
    scene: DrawnScene,
    state: RobotState | None,
    *,
    look: RobotLook | None = None,
    conditions: Conditions = IDEAL,
    rng: np.random.Generator,
    background: Picture | None = None,
) -> SyntheticPhoto:
    """Photograph a scene, with a robot in it or none.

    Args:
        scene: The scene.
        state: Where the robot is; None for no robot.
        look: How it looks; the default carries a marker.
        conditions: How the photograph is taken.
        rng: Random numbers for the noise.
        background: Result of `render_background(scene)`, to draw it only once.

    Returns:
        The photograph and its truth. The same arguments and seed give the same pixels.
    """
    picture = render_background(scene) if background is None else background
    cover = np.zeros(picture.shape[:2], np.float32)
    if state is not None:
        picture, cover = paint_robot(
            picture, state, look=look or RobotLook(), camera=scene.camera, light=scene.light,
            exposure_time=conditions.exposure_time,
        )  # fmt: skip
    pixels, jpeg = develop(picture, conditions, rng=rng)
    return SyntheticPhoto(pixels, state, cover, jpeg)


def develop(
    picture: Picture, conditions: Conditions, *, rng: np.random.Generator
) -> tuple[Pixels, bytes | None]:
    """Convert brightness to pixels with the camera's and compression's errors.

    Args:
        picture: Brightness in blue, green and red, shape (height, width, 3) [-].
        conditions: How the photograph is taken.
        rng: Random numbers for the noise.

    Returns:
        Pixels, and the JPEG they were decoded from when there is one.
    """
    light = _blurred(picture, conditions.defocus_sd_px)
    counts = _noisy(light * (conditions.exposure * _FULL), conditions, rng)
    pixels = np.clip(np.rint(counts), 0, _FULL).astype(np.uint8)
    if conditions.jpeg_quality is None:
        return pixels, None
    _, encoded = cv2.imencode(".jpg", pixels, [cv2.IMWRITE_JPEG_QUALITY, conditions.jpeg_quality])
    return np.asarray(cv2.imdecode(encoded, cv2.IMREAD_COLOR), np.uint8), encoded.tobytes()


def _blurred(picture: Picture, sd_px: float) -> Picture:
    if sd_px == 0:
        return picture
    blurred = cv2.GaussianBlur(picture, (0, 0), sd_px, borderType=cv2.BORDER_REPLICATE)
    return np.asarray(blurred, np.float32)


def _noisy(counts: Picture, conditions: Conditions, rng: np.random.Generator) -> Picture:
    read, shot = conditions.read_noise_counts, conditions.shot_noise_counts
    if read == 0 and shot == 0:
        return counts
    spread = np.sqrt(read**2 + shot**2 * np.clip(counts, 0, None) / _FULL)
    return counts + spread * rng.standard_normal(counts.shape, dtype=np.float32)
