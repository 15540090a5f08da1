# SPDX-License-Identifier: MIT
"""Parse the option `--slip`: a calibration, Coulomb friction, or the thesis's curve."""

from dataclasses import dataclass
from pathlib import Path

from model.slip.definition import SlipDefinition
from model.slip.thesis_curve import thesis_curve
from model.walk.slip import Slip
from model.walk.traction import VelocityCoulomb
from zebro_lab.calibration.coulomb_argument import coulomb_numbers
from zebro_lab.calibration.folder import POSTERIOR, SLIP_TOML, read_slip_file
from zebro_lab.calibration.walks_folder import StoredWalks, read_stored_walks
from zebro_lab.files.errors import NotFound
from zebro_lab.files.folder_manifest import changed_output, lost_output
from zebro_lab.files.replacement import recover

THESIS = "thesis"
EXPECTED_SLIP = f"a {SLIP_TOML}, the folder that holds it, coulomb:MU[:V] or thesis"


@dataclass(frozen=True)
class NamedSlip(Slip):
    """A slip law as named on a command line.

    Attributes:
        text: The value of `--slip`, as given.
        files: Files that were read, the `slip.toml` first, then those of `walks/`; empty for a law
            without a file. `posterior.nc`, read later for draws, is not among them.
        notes: Notes, one line each: a changed file, an untrustworthy fit, a slip definition to
            convert.
        walks: Posterior of legs and floor after tracked walks; None if no walks were fitted, or
            they were not read.
        doubts: A warning with the verdict's headline if the fit cannot be trusted, which `notes`
            has too; else empty.
    """

    text: str
    files: tuple[Path, ...] = ()
    notes: tuple[str, ...] = ()
    walks: StoredWalks | None = None
    doubts: tuple[str, ...] = ()

    @property
    def title(self) -> str:
        """Name of the calibration folder without its parents; else the value of `--slip`."""
        if not self.files:
            return self.text
        return self.files[0].absolute().parent.name or self.text


def parse_slip(text: str, *, with_walks: bool = True) -> NamedSlip:
    """Parse the value of `--slip`, and read the slip law if it is in a file.

    Args:
        text: A `slip.toml`, its folder, `coulomb:MU[:V]` with the velocity V over which friction
            sets in, 0.001 by default [m/s], or `thesis`.
        with_walks: Whether to read the posterior of `walks/` too.

    Raises:
        NotFound: `text` is no file, folder or law, or `draws.npz` of `walks/` is missing.
        SettingsError: Numbers of `coulomb` are missing, too many, not positive, not
            finite, or the friction is above 2.
        DataError: The calibration, or its `walks/` if wanted, cannot be read.

    >>> parse_slip("coulomb:0.38").law
    VelocityCoulomb(friction=0.38, speed_scale=0.001)
    """
    if text == THESIS:
        return NamedSlip(thesis_curve(), THESIS, text)
    numbers = coulomb_numbers(text)
    if numbers is not None:
        return NamedSlip(VelocityCoulomb(*numbers), "assumed", text)
    path = recover(Path(text))
    if not path.exists():
        raise NotFound(
            f"--slip: '{text}' is not a file or folder; expected {EXPECTED_SLIP}; "
            "calibrate-slip DATA writes such a folder, unless it was stopped"
        )
    return _calibrated(text, path, with_walks=with_walks)


def _calibrated(text: str, path: Path, *, with_walks: bool) -> NamedSlip:
    """Read a calibration as the slip law of `--slip`, with the notes listed at `NamedSlip`.

    Among them are warnings of a `slip.toml` that was changed and of a `posterior.nc` that is lost.
    """
    read = read_slip_file(path)
    notes = [f"WARNING: {each}" for each in changed_output(read.file)]
    notes += [
        f"WARNING: {each}: draws are those of the Gaussian in {SLIP_TOML}"
        for each in lost_output(read.file.with_name(POSTERIOR))
    ]
    if read.curve.definition is not SlipDefinition.MATERIAL:
        notes.append(f"slip: fitted to '{read.curve.definition}' slip, converted when evaluated")
    walks = read_stored_walks(read.file) if with_walks else None
    files = (read.file, *(walks.files if walks is not None else ()))
    doubts = ()
    if read.caveat is not None:
        notes.append(f"slip: {read.caveat}")
    if read.doubt is not None:
        doubts = (f"WARNING: the calibration is {read.doubt}",)
    return NamedSlip(read.curve, read.source, text, files, (*notes, *doubts), walks, doubts)
