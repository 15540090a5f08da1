# SPDX-License-Identifier: MIT
"""Write a person's annotations of photographs to `annotations.toml`, and draw a grid of pixels.

No window is opened. Annotations are arguments or a file; their pixels are read off a picture with a
grid, which any viewer shows on any machine.
"""

from collections.abc import Mapping, Sequence
from io import BytesIO
from math import isfinite, radians
from pathlib import Path

from model.similar_name import similar_name
from tracking.body import TopPlate
from tracking.corrections import Correction, Delete, Flip, Move
from tracking.images import find_photos, read_pixels
from tracking.photos.scene import Click, MarkedTop
from zebro_lab.files.atomic import atomic_write_bytes, atomic_write_text
from zebro_lab.files.errors import AlreadyExists, NotFound, SettingsError
from zebro_lab.files.single_file import picture, require_overwritable
from zebro_lab.files.units import option_to_si
from zebro_lab.robot.marker_print import LARGEST_PRINT
from zebro_lab.robot.robot_file import RobotFile, read_robot_file
from zebro_lab.track.annotate_request import AnnotateRequest
from zebro_lab.track.annotations import (
    Annotations,
    read_annotations,
    render_annotations,
)

GRID = picture("annotate --grid")
_EXPOSURE = "#"


def annotate(request: AnnotateRequest) -> Annotations:
    """Add annotations to those of `request.out` and write all, atomically.

    Args:
        request: New annotations. Corrections of one request are applied in the sequence moves,
            flips, deletions, after all earlier corrections; those of its file `added` last.

    Returns:
        All annotations, old and new.

    Raises:
        ZebroLabError: A photograph or a file is missing or invalid, or `added` is to be written.
        TrackingError: There is no photograph, or a size of the robot's top is impossible.
    """
    if request.added is not None and request.out.exists() and request.out.samefile(request.added):
        raise AlreadyExists(f"{request.out} is the file given as --from; choose another with --out")
    new = Annotations(_templates(request), _clicks(request), _corrections(request))
    names = photo_names(request.photos)
    if request.added is not None:
        new = new.merged(read_annotations(request.added))
    _require_photos(new, names)
    before = read_annotations(request.out) if request.out.exists() else Annotations()
    merged = before.merged(new)
    atomic_write_text(request.out, render_annotations(merged))
    return merged


def photo_names(origin: Path) -> tuple[str, ...]:
    """List the file names of the photographs in a folder; a video or picture is the only name.

    Raises:
        NotFound: `origin` does not exist.
        TrackingError: The folder holds no photograph.
    """
    if origin.is_dir():
        return tuple(path.name for path in find_photos(origin))
    if not origin.is_file():
        raise NotFound(f"{origin}: no such folder, video or picture")
    return (origin.name,)


def draw_grid(origin: Path, photo: str, file: Path, *, around: str | None = None,
              reach: int = 100) -> None:  # fmt: skip
    """Draw a photograph with a grid of pixel coordinates and write it as PNG.

    Args:
        origin: Folder of photographs, or a picture.
        photo: File name of the photograph.
        file: The PNG to write; an earlier grid is replaced.
        around: Pixel "U,V" to enlarge around; None draws the whole photograph.
        reach: Half the width of the enlarged part [px].

    Raises:
        ZebroLabError: The photograph does not exist, `around` is not a pixel, or `file` is not a
            grid to replace, lies among the photographs or in no folder.
        PhotoError: The photograph cannot be read.
    """
    from zebro_lab.plots import save
    from zebro_lab.plots.track import pixel_grid

    middle = None if around is None else _pair(around, "--around")
    _require_photo(photo, photo_names(origin))
    path = origin / photo if origin.is_dir() else origin
    target = require_overwritable(file, GRID, inputs=(path,))
    if origin.is_dir() and target.parent.samefile(origin):
        raise AlreadyExists(
            f"{file} would lie among the photographs and be tracked as one of them; choose another "
            "file with --grid"
        )
    drawn = BytesIO()
    figure = pixel_grid(read_pixels(path), title=photo, around=middle, reach=reach)
    save(figure, drawn, command=GRID.command)
    atomic_write_bytes(target, drawn.getvalue())


def _templates(request: AnnotateRequest) -> tuple[MarkedTop, ...]:
    """Return the template that --corners marks in --photo; empty if no corners are given.

    Raises:
        SettingsError: There are not four corners, the photograph is not named, or a pixel or size
            is invalid.
    """
    if request.corners is None:
        return ()
    corners = tuple(_pair(text, "--corners") for text in request.corners.split())
    if len(corners) != 4:
        raise SettingsError(
            f"{len(corners)} corners; expected four, 'u,v u,v u,v u,v': front left, front right, "
            "rear right, rear left",
            key="--corners",
        )
    if request.photo is None:
        raise SettingsError("missing: name the photograph of --corners", key="--photo")
    return (MarkedTop(request.photo, corners, _plate(request)),)


def _plate(request: AnnotateRequest) -> TopPlate:
    """Parse the size of the robot's top from --plate, LENGTHxWIDTH@HEIGHT above the body's centre.

    Without --plate it is the body's length and width at half the body's height, of robot.toml.

    Raises:
        SettingsError: The text has another form, or a side is not above 0.
    """
    margin = option_to_si(request.margin, "m", key="--margin", usual=LARGEST_PRINT)
    if request.plate is None:
        described = RobotFile() if request.robot is None else read_robot_file(request.robot)
        length, width, height = described.robot.body_size
        return TopPlate(length, width, height / 2, margin=margin, front_margin=margin)
    sides, _, height = request.plate.partition("@")
    length, _, width = sides.partition("x")
    parts = (length, width, height)
    sizes = [option_to_si(t, "m", key="--plate", usual=LARGEST_PRINT) for t in parts if t]
    if len(sizes) != len(parts) or min(sizes[:2]) <= 0:
        raise SettingsError(
            f"'{request.plate}' is not LENGTHxWIDTH@HEIGHT with sides above 0, such as "
            "194mmx251mm@35mm",
            key="--plate",
        )
    return TopPlate(*sizes, margin=margin, front_margin=margin)


def _clicks(request: AnnotateRequest) -> Mapping[str, Mapping[str, Click]]:
    """Parse --click PHOTO:NAME=U,V into pixels by photograph and name of the floor's point.

    A later click on the same point replaces an earlier one. `SettingsError` for another form.
    """
    clicks: dict[str, dict[str, Click]] = {}
    for text in request.clicks:
        place, _, pixel = text.rpartition("=")
        photo, _, name = place.rpartition(":")
        if not (photo and name):
            raise SettingsError(f"'{text}' is not PHOTO:NAME=U,V", key="--click")
        clicks.setdefault(photo, {})[name] = _pair(pixel, "--click")
    return clicks


def _corrections(request: AnnotateRequest) -> tuple[Correction, ...]:
    """Return the new corrections: moves, then flips, then deletions, each in the order given."""
    moves = [_move(text) for text in request.moves]
    flips = [Flip(photo) for photo in request.flips]
    deletes = [Delete(photo) for photo in request.deletes]
    return (*moves, *flips, *deletes)


def _move(text: str) -> Move:
    """Parse --move PHOTO:X,Y,YAW [m, m, deg] into a correction, whose yaw is in radians.

    Raises:
        SettingsError: The text has another form.
    """
    photo, _, place = text.rpartition(":")
    numbers = _numbers(place, "--move")
    if not photo or len(numbers) != 3:
        raise SettingsError(f"'{text}' is not PHOTO:X,Y,YAW in m, m, degrees", key="--move")
    return Move(photo, numbers[0], numbers[1], radians(numbers[2]))


def _pair(text: str, key: str) -> Click:
    """Parse a pixel "U,V"; `key` is the option that a `SettingsError` names."""
    numbers = _numbers(text, key)
    if len(numbers) != 2:
        raise SettingsError(f"'{text}' is not a pixel U,V, as in 812,440", key=key)
    return numbers[0], numbers[1]


def _numbers(text: str, key: str) -> list[float]:
    """Parse finite numbers separated by commas; `key` is the option named in a `SettingsError`."""
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError as error:
        raise SettingsError(f"'{text}' is not a list of numbers with commas", key=key) from error
    if not all(map(isfinite, numbers)):
        raise SettingsError(f"'{text}' has a number that is not finite", key=key)
    return numbers


def _require_photos(annotations: Annotations, names: Sequence[str]) -> None:
    """Raise `SettingsError` if an annotation is of a photograph that is not among `names`."""
    corrected = [each.photo for each in annotations.corrections]
    tops = [top.photo for top in annotations.templates]
    for photo in (*tops, *annotations.clicks, *corrected):
        _require_photo(photo, names)


def _require_photo(photo: str, names: Sequence[str]) -> None:
    """Raise `SettingsError` if `photo` is not among `names`.

    `NAME#NUMBER`, an exposure or frame of NAME, is accepted if NAME is among them.
    """
    # Exposures and frames are known only after tracking: walk.jpg#3 is one of walk.jpg.
    if photo in names or photo.rpartition(_EXPOSURE)[0] in names:
        return
    near = similar_name(photo, names)
    hint = f"did you mean '{near}'?" if near else f"there are {names[0]} to {names[-1]}"
    raise SettingsError(f"there is no photograph '{photo}'; {hint}")
