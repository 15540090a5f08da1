# SPDX-License-Identifier: MIT
"""Readers of photographs and videos."""

import io
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

import cv2
import numpy as np
import PIL.Image

from benchmarks.faults.fuzzed_readers.reader import TEN_THOUSAND, Reader, picture_check
from benchmarks.faults.hostile_inputs import (
    pool,
)
from tracking.images import exif_time, read_pixels, video_frames
from zebro_lab.track.photo_sequence import upright_size


def of_pictures() -> Mapping[str, Reader]:
    """Return readers of photographs and videos."""

    def seen(file: Path) -> None:
        upright_size(file)
        exif_time(file)
        read_pixels(file)

    make = pool(_pictures(), 0.85)
    return {
        "photographs": Reader("a.jpg", seen, make, picture_check, TEN_THOUSAND),
        "videos": Reader("a.mp4", lambda f: sum(1 for _ in video_frames(f)),
                         pool(_videos(), 0.85), lambda d: d[4:8] == b"ftyp" or d.index(b"RIFF"),
                         TEN_THOUSAND),
    }  # fmt: skip


def _pictures() -> list[bytes]:
    rng = np.random.default_rng(4)
    made = []
    for kind in ("JPEG", "PNG", "TIFF", "BMP", "WEBP", "GIF", "PPM", "EPS"):
        for mode in ("RGB", "L", "P", "CMYK", "RGBA", "I;16"):
            picture = PIL.Image.fromarray(rng.integers(0, 255, (40, 50, 3), dtype=np.uint8))
            exif = PIL.Image.Exif()
            exif[0x0132], exif[0x0112] = "2026:01:01 12:00:00", int(rng.integers(0, 10))
            exif.get_ifd(0x8769)[0x9003] = "2026:01:01 12:00:00"
            out = io.BytesIO()
            with suppress(OSError, ValueError, KeyError):
                picture.convert(mode).save(out, kind, exif=exif)
                made.append(out.getvalue())
    return made


def _videos() -> list[bytes]:
    import tempfile

    made = []
    with tempfile.TemporaryDirectory() as folder:
        for name, code in (("a.avi", "MJPG"), ("a.mp4", "mp4v")):
            file = Path(folder) / name
            writer = cv2.VideoWriter(str(file), cv2.VideoWriter.fourcc(*code), 10.0, (64, 48))
            for k in range(4):
                writer.write(np.full((48, 64, 3), 20 * k, np.uint8))
            writer.release()
            made.append(file.read_bytes())
    return made
