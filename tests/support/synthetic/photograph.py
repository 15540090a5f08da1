# SPDX-License-Identifier: MIT
"""Turn brightness into a photograph: exposure, blur, glare, shade, noise and compression."""

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
class Glare:
    """Glare of a lamp: a round patch of added light.

    Attributes:
        centre_px: Across and down [px].
        radius_px: Standard deviation of its Gaussian shape [px].
        strength: What it adds in its middle, 1 for white paper in full light [-].
    """

    centre_px: tuple[float, float]
    radius_px: float
    strength: float = 0.8


@dataclass(frozen=True)
class Shade:
    """A soft-edged shadow over half of the picture, as of a table beside the floor.

    Attributes:
        point_px: A point on its edge, across and down [px].
        angle: From the x axis of the picture to where it gets dark, turning to y [rad].
        softness_px: Length of the transition [px].
        left_over: Share of the light that is left inside [-].
    """

    point_px: tuple[float, float]
    angle: float = 0.0
    softness_px: float = 20.0
    left_over: float = 0.4


@dataclass(frozen=True)
class Conditions:
    """Conditions under which a photograph is taken; the defaults are favourable.

    Attributes:
        exposure: Share of full scale at which white paper in full light ends up [-].
        exposure_time: During which the robot moves [s].
        defocus_sd_px: Standard deviation of the blur over the whole picture [px].
        shake_px: How far the picture moves during the exposure, across and down [px].
        read_noise_counts: Noise without light, standard deviation of 255 [counts].
        shot_noise_counts: Noise at full scale; proportional to the root of the light [counts].
        jpeg_quality: Of the compression; None leaves it out.
        glare: Mirrored lamps.
        shade: Shadows of what is beside the picture.
    """

    exposure: float = 0.9
    exposure_time: float = 0.0
    defocus_sd_px: float = 0.0
    shake_px: tuple[float, float] = (0.0, 0.0)
    read_noise_counts: float = 1.0
    shot_noise_counts: float = 2.0
    jpeg_quality: int | None = 95
    glare: tuple[Glare, ...] = ()
    shade: tuple[Shade, ...] = ()


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
    light = _shaded(picture, conditions.shade)
    light = _blurred(light, conditions)
    light = _with_glare(light, conditions.glare)
    counts = _noisy(light * (conditions.exposure * _FULL), conditions, rng)
    pixels = np.clip(np.rint(counts), 0, _FULL).astype(np.uint8)
    if conditions.jpeg_quality is None:
        return pixels, None
    _, encoded = cv2.imencode(".jpg", pixels, [cv2.IMWRITE_JPEG_QUALITY, conditions.jpeg_quality])
    return np.asarray(cv2.imdecode(encoded, cv2.IMREAD_COLOR), np.uint8), encoded.tobytes()


def _shaded(picture: Picture, shades: tuple[Shade, ...]) -> Picture:
    v, u = np.ogrid[: picture.shape[0], : picture.shape[1]]
    for shade in shades:
        depth = np.cos(shade.angle) * (u - shade.point_px[0])
        depth = depth + np.sin(shade.angle) * (v - shade.point_px[1])
        dark = np.clip(depth / shade.softness_px + 0.5, 0, 1)
        picture = picture * (1 - (1 - shade.left_over) * dark).astype(np.float32)[..., None]
    return picture


def _blurred(picture: Picture, conditions: Conditions) -> Picture:
    blurred = picture
    if conditions.defocus_sd_px > 0:
        blurred = cv2.GaussianBlur(
            blurred, (0, 0), conditions.defocus_sd_px, borderType=cv2.BORDER_REPLICATE
        )
    if any(conditions.shake_px):
        kernel = _shake_kernel(conditions.shake_px)
        blurred = cv2.filter2D(blurred, -1, kernel, borderType=cv2.BORDER_REPLICATE)
    return np.asarray(blurred, np.float32)


def _shake_kernel(shake_px: tuple[float, float]) -> Picture:
    """Spread unit weight evenly along a line through the kernel's middle."""
    reach = int(np.ceil(np.max(np.abs(shake_px)) / 2)) + 1
    kernel = np.zeros((2 * reach + 1, 2 * reach + 1), np.float32)
    steps = np.linspace(-0.5, 0.5, 16 * len(kernel) + 1)
    for u, v in steps[:, None] * np.array(shake_px) + reach:
        left, top = int(np.floor(u)), int(np.floor(v))
        across, down = u - left, v - top  # shared among the four nearest, so its mean is exact
        kernel[top, left] += (1 - across) * (1 - down)
        kernel[top, left + 1] += across * (1 - down)
        kernel[top + 1, left] += (1 - across) * down
        kernel[top + 1, left + 1] += across * down
    return kernel / kernel.sum()


def _with_glare(picture: Picture, patches: tuple[Glare, ...]) -> Picture:
    v, u = np.ogrid[: picture.shape[0], : picture.shape[1]]
    for glare in patches:
        squared = (u - glare.centre_px[0]) ** 2 + (v - glare.centre_px[1]) ** 2
        added = glare.strength * np.exp(-squared / (2 * glare.radius_px**2))
        picture = picture + added.astype(np.float32)[..., None]
    return picture


def _noisy(counts: Picture, conditions: Conditions, rng: np.random.Generator) -> Picture:
    read, shot = conditions.read_noise_counts, conditions.shot_noise_counts
    if read == 0 and shot == 0:
        return counts
    spread = np.sqrt(read**2 + shot**2 * np.clip(counts, 0, None) / _FULL)
    return counts + spread * rng.standard_normal(counts.shape, dtype=np.float32)
