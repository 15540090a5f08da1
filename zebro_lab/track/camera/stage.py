# SPDX-License-Identifier: MIT
"""Calibrate a camera from photographs of a board into `camera.toml`; write the kit to print."""

import os
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from io import BytesIO
from itertools import product
from pathlib import Path

from tracking.camera import (
    Board,
    CameraCalibration,
    CharucoBoard,
    Checkerboard,
    SeenBoard,
    calibrate,
    find_board,
)
from tracking.errors import CalibrationError, PhotoError, TrackingError
from tracking.images import find_photos, read_pixels
from tracking.markers import dictionary_named
from tracking.photos.workers import PROCESSES, WORTH_WORKERS, Progress, run_batches
from zebro_lab.files.atomic import atomic_folder, atomic_write_bytes, atomic_write_text
from zebro_lab.files.errors import AlreadyExists, SettingsError
from zebro_lab.files.provenance import file_hash
from zebro_lab.files.single_file import SingleFile, require_overwritable
from zebro_lab.files.units import option_to_si
from zebro_lab.track.camera.kit import BOARD, kit_pages, starter_floor
from zebro_lab.track.camera.pictures import save_pages
from zebro_lab.track.camera.request import CameraRequest
from zebro_lab.track.camera_file import HEADING, render_camera_file
from zebro_lab.track.floor_file import FLOOR_FILE, render_floor_file
from zebro_lab.track.photo_sequence import upright_size

KIT_FILE = "kit.pdf"
FEWEST_VIEWS = 3  # with fewer photographs of the board, another size of board is looked for
_TRIED = 6  # photographs in which another board is looked for
LENS = SingleFile("camera calibrate", {HEADING.encode(): b""})


_BOARD_EXPECTED = (
    "expected kit, checkerboard:COLUMNSxROWS:SQUARE (inner corners) such as "
    "checkerboard:9x6:25mm, or charuco:COLUMNSxROWS:SQUARE:MARKER:DICTIONARY (squares) such as "
    "charuco:7x5:35mm:26mm:5x5_50"
)


@dataclass(frozen=True)
class CameraResult:
    """Written camera calibration.

    Attributes:
        file: The written `camera.toml`.
        fit: Lens with standard deviations, misfit and coverage.
        left_out: Reason by name of each photograph that was not used.
    """

    file: Path
    fit: CameraCalibration
    left_out: dict[str, str]


def parse_board(text: str) -> Board:
    """Parse `--board`: `kit`, `checkerboard:COLUMNSxROWS:SQUARE`, or a ChArUco board.

    A ChArUco board is `charuco:COLUMNSxROWS:SQUARE:MARKER:DICTIONARY`.

    Raises:
        SettingsError: The form, a number, a length (above 0, below 1 m), its unit or the dictionary
            is invalid, or markers are not smaller than squares.

    >>> parse_board("checkerboard:9x6:25mm")
    Checkerboard(columns=9, rows=6, square=0.025)
    """
    kind, *parts = text.split(":")
    if kind == "kit" and not parts:
        return BOARD
    if kind == "checkerboard" and len(parts) == 2:
        columns, rows = _board_grid(text, parts[0])
        return Checkerboard(columns, rows, _board_length(text, parts[1]))
    if kind == "charuco" and len(parts) == 4:
        columns, rows = _board_grid(text, parts[0])
        square, marker = _board_length(text, parts[1]), _board_length(text, parts[2])
        if marker >= square:
            raise _board_error(text, f"markers of {parts[2]} do not fit into squares of {parts[1]}")
        try:
            dictionary_named(parts[3])
        except TrackingError as error:
            raise SettingsError(str(error), key="--board") from error
        return CharucoBoard(columns, rows, square, marker, parts[3])
    raise _board_error(text, "is not a board")


def _board_grid(text: str, part: str) -> tuple[int, int]:
    """Parse COLUMNSxROWS, two or more each; raise `SettingsError` for anything else.

    `text` is the whole text of the board, for the error.
    """
    columns, _, rows = part.partition("x")
    if not (columns.isdigit() and rows.isdigit() and int(columns) > 1 and int(rows) > 1):
        raise _board_error(text, f"'{part}' is not COLUMNSxROWS, 2 or more each")
    return int(columns), int(rows)


def _board_length(text: str, part: str) -> float:
    """Parse a length above 0 and below 1 m; raise `SettingsError` for anything else.

    `text` is the whole text of the board, for the error.
    """
    length = option_to_si(part, "m", key="--board")
    if not 0 < length < 1:
        raise _board_error(text, f"'{part}' is not above 0 and below 1 m; give a unit, as in 25mm")
    return length


def _board_error(text: str, problem: str) -> SettingsError:
    """Return the error for a board: its text, what is wrong, and the forms that are accepted."""
    return SettingsError(f"'{text}': {problem}; {_BOARD_EXPECTED}", key="--board")


def calibrate_camera(request: CameraRequest, progress: Progress) -> CameraResult:
    """Calibrate the lens from photographs of a board and write `camera.toml`.

    Args:
        request: Options of `zebro-lab camera calibrate`.
        progress: Progress display, which may also request a stop.

    Raises:
        ZebroLabError: An option is invalid, or `out` is a file that this command did not write.
        TrackingError: There is no photograph, none can be read or shows the board, or they do not
            determine the lens.
        TrackStopped: A stop was requested.
    """
    target = require_overwritable(request.out, LENS, inputs=(request.photos,))
    board = parse_board(request.board)
    paths = find_photos(request.photos)
    sizes = Counter(size for path in paths if (size := upright_size(path)) is not None)
    if not sizes:
        raise CalibrationError(f"{request.photos}: none of {len(paths)} photographs can be read")
    size = sizes.most_common(1)[0][0]
    workers = PROCESSES if len(paths) * size[0] * size[1] > WORTH_WORKERS else 1
    jobs = [(path, board, size) for path in paths]
    looks = run_batches(_look, jobs, workers=workers, progress=progress, what="boards")
    views = [view for view in looks if isinstance(view, SeenBoard)]
    left_out = {
        path.name: look for path, look in zip(paths, looks, strict=True) if isinstance(look, str)
    }
    if len(views) < FEWEST_VIEWS and (other := _other_count(board, paths, len(views))):
        raise CalibrationError(other)
    if not views:
        raise CalibrationError(_why_none(request, left_out))
    progress.step("lens", None)
    fit = calibrate(views, size, lens_model=request.lens)
    used = {path.name: file_hash(path) for path in paths if path.name not in left_out}
    atomic_write_text(target, render_camera_file(fit, photos=used))
    return CameraResult(request.out, fit, left_out)


def _look(job: tuple[Path, Board, tuple[int, int]]) -> SeenBoard | str:
    """Find the board in a photograph of the given size (width, height) [px].

    Returns:
        The detected board, or the reason why the photograph is left out.
    """
    path, board, size = job
    try:
        view = find_board(read_pixels(path, size=size), board, name=path.name)
    except PhotoError as error:
        return error.reason
    return "the board is not detected" if view is None else view


def _why_none(request: CameraRequest, left_out: dict[str, str]) -> str:
    """Return the error message for a board that no photograph shows, with a first reason."""
    name, reason = next(iter(left_out.items()))
    return (
        f"the board '{request.board}' is seen in none of {len(left_out)} photographs ({name}: "
        f"{reason}); describe the board that was photographed with --board"
    )


def _other_count(board: Board, paths: Sequence[Path], found: int) -> str | None:
    """Return an error message if the photographs show a checkerboard of slightly another size.

    Its columns, its rows or both differ by one. There is a message only if it is seen in more of
    the first `_TRIED` photographs than `board` was in all of them; else None is returned.

    Args:
        board: The board that was looked for.
        paths: The photographs, of which the first few are looked at.
        found: Number of photographs in which `board` was detected.
    """
    if not isinstance(board, Checkerboard):
        return None
    seen: Counter[Checkerboard] = Counter()
    for path in paths[:_TRIED]:
        try:
            pixels = read_pixels(path)
        except PhotoError:
            continue
        for more in product((1, 0, -1), repeat=2):
            other = replace(board, columns=board.columns + more[0], rows=board.rows + more[1])
            if any(more) and min(other.columns, other.rows) > 2:
                seen[other] += find_board(pixels, other, quick=True) is not None
    likeliest, count = seen.most_common(1)[0] if seen else (board, 0)
    if count <= found:
        return None
    inner = f"{likeliest.columns}x{likeliest.rows}"
    return (
        f"{count} of the first {min(len(paths), _TRIED)} photographs show {inner} inner corners, "
        f"not {board.columns}x{board.rows} (inner corners are squares less one along either side): "
        f"give --board checkerboard:{inner}:{1e3 * board.square:g}mm"
    )


def write_kit(out: Path, *, paper: str = "a4", board: str = "kit") -> tuple[Path, ...]:
    """Write the printable kit as `kit.pdf` and a starter `floor.toml`.

    Args:
        out: Folder to write into; created when missing.
        paper: Size of the paper, "a4" or "letter".
        board: Calibration board of the last page, as for `camera calibrate --board`.

    Returns:
        The files `kit.pdf` and `floor.toml`.

    Raises:
        AlreadyExists: `out` is a file, has any `floor.toml`, or a `kit.pdf` with other content.
        SettingsError: The paper is unknown, or the board is invalid or does not fit on it.
    """
    pages = kit_pages(paper, parse_board(board))
    if (out / FLOOR_FILE).exists():
        raise AlreadyExists(
            f"{out / FLOOR_FILE} exists and may hold measured positions; choose another --out"
        )
    drawn = BytesIO()
    save_pages(pages, drawn)
    floor = render_floor_file(starter_floor(), heading=_HEADING)
    if not out.is_dir():
        with atomic_folder(out) as draft:
            (draft / KIT_FILE).write_bytes(drawn.getvalue())
            (draft / FLOOR_FILE).write_text(floor, encoding="utf-8")
    else:
        _require_same(out / KIT_FILE, drawn.getvalue())
        atomic_write_bytes(out / KIT_FILE, drawn.getvalue())
        atomic_write_text(out / FLOOR_FILE, floor)
    return out / KIT_FILE, out / FLOOR_FILE


def _require_same(file: Path, content: bytes) -> None:
    """Raise `AlreadyExists` if the file exists with other content than that to be written."""
    if os.path.lexists(file) and (not file.is_file() or file.read_bytes() != content):
        raise AlreadyExists(f"{file} exists with other content; choose another folder with --out")


_HEADING = """\
The floor's markers. Replace x, y and yaw_deg by what was measured; delete markers not used.
Markers as `zebro-lab camera kit` prints them; the positions are a suggestion, not measured."""
