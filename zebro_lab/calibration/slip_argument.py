# SPDX-License-Identifier: MIT
"""What `--slip` means: a calibration, Coulomb friction, or the source's own curve."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from model.slip.curve import SlipCurve
from model.slip.definition import SlipDefinition
from model.walk.traction import ToeLaw, TractionTable, VelocityCoulomb, curve_table
from zebro_lab.calibration.folder import SLIP_TOML, read_slip_file
from zebro_lab.calibration.walks_folder import StoredWalks, read_walks_beside
from zebro_lab.files.errors import NotFound, SettingsError
from zebro_lab.files.replacement import settle

if TYPE_CHECKING:
    from model.walk.path import WalkPath
    from model.walk.thesis import Traction

THESIS = "thesis"
COULOMB = "coulomb"
EXPECTED_SLIP = f"a {SLIP_TOML}, the folder that holds it, coulomb:MU[:V] or thesis"
_SOURCE_LOADS = (2.13, 12.75)  # Fig. 4-14 [N]


@dataclass(frozen=True)
class Slip:
    """How legs slip, as a command line names it.

    Attributes:
        text: What was named.
        law: A calibrated curve, or Coulomb friction by slip velocity.
        source: Where the law comes from: "real", "sim:...", "assumed", "thesis", "unknown".
        files: Files that were read.
        notes: For a person, one line each.
        walks: What tracked walks said of legs and floor; None where none informed it.
    """

    text: str
    law: SlipCurve | VelocityCoulomb
    source: str
    files: tuple[Path, ...] = ()
    notes: tuple[str, ...] = ()
    walks: StoredWalks | None = None

    @property
    def title(self) -> str:
        """Its name where there is little room: a calibration's folder without those above it."""
        if not self.files:
            return self.text
        return self.files[0].absolute().parent.name or self.text

    def traction_table(self, *, weight: float, toe: ToeLaw = "saturated") -> TractionTable:
        """Tabulate the law for a robot of a weight [N]; slip of any definition is converted."""
        if isinstance(self.law, VelocityCoulomb):
            return self.law.table(weight=weight, toe=toe)
        return curve_table(self.law, weight=weight, toe=toe)

    def thesis_traction(self, *, weight: float) -> "Traction":
        """Prepare the law for the source's model, for a robot of a weight [N].

        Raises:
            SettingsError: The curve is one of another definition than the rig's.
        """
        from model.walk.thesis import law_traction, table_traction

        if isinstance(self.law, VelocityCoulomb):
            return table_traction(self.law.table(weight=weight))
        if self.law.definition is not SlipDefinition.MATERIAL:
            raise SettingsError(
                f"was fitted to '{self.law.definition}' slip, but the source's model takes "
                f"'{SlipDefinition.MATERIAL}' slip; calibrate again with --slip-definition "
                f"{SlipDefinition.MATERIAL}, or use --model dynamics, which converts",
                file=self.text,
            )
        return law_traction(self.law.law, self.law.values, weight=weight)

    @property
    def tested_loads(self) -> tuple[float, float] | None:
        """Smallest and largest load tested; None for an assumed law [N]."""
        return None if isinstance(self.law, VelocityCoulomb) else self.law.load_range

    def loads_below_tested(self, path: "WalkPath") -> float | None:
        """Return the share of leg contacts whose load lies below what was tested [-].

        None where no load was ever tested: an assumed law has no range.
        """
        if self.tested_loads is None:
            return None
        loads = path.normal_force[path.contact]
        return float(np.mean(loads < self.tested_loads[0])) if len(loads) else 0.0


def parse_slip(text: str, *, with_walks: bool = True) -> Slip:
    """Read the value of `--slip`.

    Args:
        text: A `slip.toml`, its folder, `coulomb:MU[:V]` with the velocity V [m/s] over which
            friction sets in, or `thesis`.
        with_walks: Read what walks said beside it, too.

    Raises:
        NotFound: It names no file, folder or law.
        SettingsError: A number is none, or not positive.
        DataError: The calibration cannot be read.

    >>> parse_slip("coulomb:0.38").law
    VelocityCoulomb(friction=0.38, speed_scale=0.001)
    """
    if text == THESIS:
        return Slip(text, source_curve(), source=THESIS)
    name, *numbers = text.split(":")
    if name == COULOMB:
        return Slip(text, _coulomb(text, numbers), source="assumed")
    path = settle(Path(text))
    if not path.exists():
        raise NotFound(f"--slip: '{text}' is no file or folder; expected {EXPECTED_SLIP}")
    return _calibrated(text, path, with_walks=with_walks)


def source_curve() -> SlipCurve:
    """Return the source's slip curve, Eq. (4-45) and Listings A.20 and A.21, as given: sd zero."""
    from rig.slip_rig.sweep import SOURCE_LAW, SOURCE_VALUES

    k = len(SOURCE_VALUES)
    return SlipCurve(
        law=SOURCE_LAW,
        values=np.array(SOURCE_VALUES),
        covariance=np.zeros((k, k)),
        definition=SlipDefinition.MATERIAL,
        load_range=_SOURCE_LOADS,
        slip_range=(0.0, 1.0),
    )


def _coulomb(text: str, numbers: list[str]) -> VelocityCoulomb:
    expected = "coulomb:MU[:V], such as coulomb:0.38 or coulomb:0.38:0.001 (V in m/s)"
    try:
        values = [float(number) for number in numbers]
    except ValueError as error:
        raise SettingsError(
            f"'{text}' holds no numbers; expected {expected}", key="--slip"
        ) from error
    if not 1 <= len(values) <= 2 or not all(0 < value < np.inf for value in values):
        raise SettingsError(
            f"'{text}' is no friction; expected {expected}, both above zero", key="--slip"
        )
    return VelocityCoulomb(*values)


def _calibrated(text: str, path: Path, *, with_walks: bool) -> Slip:
    said = read_slip_file(path)
    curve, file, notes = said.curve, said.file, []
    if said.doubt is not None:
        notes.append(f"slip: the calibration is not trustworthy: {said.doubt}")
    if curve.definition is not SlipDefinition.MATERIAL:
        notes.append(f"slip: fitted to '{curve.definition}' slip, converted where it is evaluated")
    walks = read_walks_beside(file) if with_walks else None
    files = (file, *(walks.files if walks is not None else ()))
    return Slip(text, curve, said.source, files, tuple(notes), walks)
