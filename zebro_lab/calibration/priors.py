# SPDX-License-Identifier: MIT
"""Priors of options, `columns.toml` and an earlier calibration, as the fit takes them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from model.arrays import Array
from model.bayes.calibration import Calibration
from model.bayes.likelihood import NUISANCE
from model.bayes.prior_conflict import PriorShift
from model.bayes.priors import Prior
from model.bayes.stated_priors import EarlierPosterior, StatedPriors
from model.slip.curve import SlipCurve
from model.slip.law import Parameter, SlipLaw
from model.slip.laws import TOGETHER
from model.slip.magic_formula import MagicFormula
from model.slip.sided import SidedLaw
from zebro_lab.calibration.draws import read_draws_of
from zebro_lab.calibration.folder import POSTERIOR, read_slip_file
from zebro_lab.calibration.prior_argument import named_priors, parse_prior
from zebro_lab.calibration.request import CalibrationRequest
from zebro_lab.calibration.rig_data import RigData
from zebro_lab.files.documents import read_toml_document
from zebro_lab.files.errors import DataError, NotFound, SettingsError
from zebro_lab.files.provenance import file_hash
from zebro_lab.files.source_names import is_simulated

_OPTION: Final = "--prior"


NOISE: Final = (
    "slip_error_scale", "slip_scatter", "noise_floor", "noise_correlation",
)  # fmt: skip
"""Parameters of the errors of block means, which hold for one block length."""


@dataclass(frozen=True)
class EarlierCalibration:
    """An earlier calibration with the draws of its posterior.

    Attributes:
        title: Name of its folder.
        curve: Its slip curve, with law and slip definition.
        draws: Draws of each parameter of law and measurement by name, shape (n,).
        block_length: Samples in a block mean; None if the file does not say.
        source: Source of its data.
        files: Files that were read.
        notes: Warnings about it, one line each.
        data: SHA-256 of the files that it was fitted to.
    """

    title: str
    curve: SlipCurve
    draws: Mapping[str, Array]
    block_length: int | None
    source: str
    files: tuple[Path, ...]
    notes: tuple[str, ...]
    data: frozenset[str] = frozenset()


@dataclass(frozen=True)
class KnownPriors:
    """What is known beforehand, with the texts and files that said so.

    Attributes:
        priors: The priors.
        texts: Text of each single prior by the parameter's name.
        earlier: Earlier calibration; None without one.
        block_length: Samples in a block mean; None for that which the data suggest.
        notes: Notes, one line each.
    """

    priors: StatedPriors
    texts: Mapping[str, str] = field(default_factory=dict)
    earlier: EarlierCalibration | None = None
    block_length: int | None = None
    notes: tuple[str, ...] = ()

    @property
    def files(self) -> tuple[Path, ...]:
        """Files of the earlier calibration that were read."""
        return () if self.earlier is None else self.earlier.files


def gather_priors(
    request: CalibrationRequest, data: RigData, laws: Mapping[str, SlipLaw]
) -> tuple[KnownPriors, Mapping[str, SlipLaw]]:
    """Read the priors that a request and its data state, and which laws they leave.

    Args:
        request: Options: single priors and an earlier calibration.
        data: Rig data, with the priors of their `columns.toml`.
        laws: Laws to choose from, by name.

    Returns:
        The priors, and the laws: that of the earlier calibration alone if there is one.

    Raises:
        ZebroLabError: A prior cannot be used, or the earlier calibration cannot be read, or is of
            another law or slip definition.
    """
    earlier = None if request.prior_from is None else read_earlier(request.prior_from)
    if earlier is not None:
        _require_new_data(earlier, data)
        laws = _laws_of(earlier, request, data)
    parameters = [p for law in laws.values() for p in (*law.parameters, *NUISANCE)]
    found = _singles(request, data, parameters)
    single = StatedPriors({name: prior for name, (prior, _) in found.items()})
    texts = {name: text for name, (_, text) in found.items()}
    if earlier is None:
        return KnownPriors(single, texts), laws
    carried = _carried(earlier, request)
    posterior = EarlierPosterior(
        {name: draws for name, draws in earlier.draws.items() if name in carried},
        earlier.title,
    )
    priors = StatedPriors(single.single, posterior)
    said = (
        f"prior: the posterior of {posterior.origin}, whose law '{earlier.curve.law.name}' is "
        f"fitted, with the correlations of {', '.join(carried)}"
    )
    notes = (*earlier.notes, said)
    return KnownPriors(priors, texts, earlier, earlier.block_length, notes), laws


def _singles(
    request: CalibrationRequest, data: RigData, parameters: list[Parameter]
) -> dict[str, tuple[Prior, str]]:
    """Return prior and text by parameter's name: of the options, else of `columns.toml`."""
    file = data.priors_file
    stated = [parse_prior(text, key="[priors]", file=file) for text in data.priors]
    of_file = named_priors(stated, parameters, key="[priors]", file=file)
    options = [parse_prior(text, key=_OPTION) for text in request.prior]
    return {**of_file, **named_priors(options, parameters, key=_OPTION)}


def _require_new_data(earlier: EarlierCalibration, data: RigData) -> None:
    """Raise `SettingsError` for data that the earlier calibration was fitted to as well.

    They are known by the SHA-256 of each file but column maps and other .toml files.
    """
    tables = [file for file in data.files if file.suffix != ".toml"]
    twice = [file.name for file in tables if file_hash(file) in earlier.data]
    if twice:
        raise SettingsError(
            f"{', '.join(twice[:3])}{' and others' if len(twice) > 3 else ''}: already in the data "
            f"of {earlier.title}, and would count twice; fit new data alone",
            key="--prior-from",
        )


def _laws_of(
    earlier: EarlierCalibration, request: CalibrationRequest, data: RigData
) -> dict[str, SlipLaw]:
    """Return the law of an earlier calibration, the only one that its posterior is a prior of.

    The default, `--law magic-formula`, stands for any law, unless load sensitivity is asked for.

    Raises:
        SettingsError: The request names another law; asks for load sensitivity by the default while
            the earlier law is no Magic Formula; or asks for sides apart while they were fitted
            together. Or the data have another slip definition.
    """
    law, definition = earlier.curve.law, earlier.curve.definition
    apart = isinstance(law, SidedLaw)
    asked_default = request.law == MagicFormula.name
    fits = request.law == law.name
    if request.sides != TOGETHER and not apart:
        raise SettingsError(
            f"{earlier.title} was fitted with driving and braking together; leave out --sides",
            key="--prior-from",
        )
    if not (fits or (asked_default and not request.load_sensitivity)):
        raise SettingsError(
            f"{earlier.title} was fitted with the law '{law.name}'; leave out --law and "
            "--load-sensitivity, which are those of the prior",
            key="--prior-from",
        )
    if definition is not data.samples.definition:
        raise SettingsError(
            f"{earlier.title} was fitted to '{definition}' slip and these data have "
            f"'{data.samples.definition}'; add --slip-definition {definition}",
            key="--prior-from",
        )
    return {law.name: law}


def _carried(earlier: EarlierCalibration, request: CalibrationRequest) -> tuple[str, ...]:
    """Return the parameters whose posterior is carried over.

    With `--carry law` those of the law alone, for another load cell; else also the measurement's,
    and the noise of block means if their length is known, which is then the same.
    """
    law = {p.name for p in earlier.curve.law.parameters}
    same_blocks = earlier.block_length is not None
    return tuple(
        name
        for name in earlier.draws
        if name in law or (request.carry == "all" and (same_blocks or name not in NOISE))
    )


def priors_content(stated: KnownPriors, calibration: Calibration) -> dict[str, Any]:
    """Return what was stated beforehand and how the data agree, for `slip.toml` and the manifest.

    Args:
        stated: The priors.
        calibration: The finished fit.

    Returns:
        Keys `stated` (texts by parameter) and `from` (earlier calibration and what it carried),
        those that apply, and `agreement`, one entry each; empty if nothing was stated.
    """
    if not calibration.prior_shifts:
        return {}
    content: dict[str, Any] = {}
    if stated.texts:
        content["stated"] = dict(stated.texts)
    posterior = stated.priors.earlier
    if posterior is not None:
        content["from"] = {
            "calibration": posterior.origin,
            "parameters": list(posterior.draws),
        }
    content["agreement"] = [_agreement(shift) for shift in calibration.prior_shifts]
    return content


def _agreement(shift: PriorShift) -> dict[str, Any]:
    """Return the shift of one prior by the data; its p-value only if the data can test it."""
    content: dict[str, Any] = {
        "parameters": list(shift.names),
        "shift_in_prior_sd": [float(x) for x in shift.shift],
        "chi_squared": shift.statistic,
        "degrees_of_freedom": shift.freedom,
    }
    if shift.conflict is not None:
        content |= {"p": shift.p, "conflict": shift.conflict}
    return content


def read_earlier(path: Path) -> EarlierCalibration:
    """Read an earlier calibration.

    Args:
        path: A calibration folder, or its `slip.toml`.

    Raises:
        NotFound: There is no `posterior.nc` beside the `slip.toml`.
        DataError: The `slip.toml` is missing or damaged, or `posterior.nc` is damaged or lacks
            draws of a parameter of the law.
    """
    found = read_slip_file(path)
    posterior = found.file.with_name(POSTERIOR)
    if not posterior.is_file():
        raise NotFound(
            f"{posterior}: no such file; the posterior of a calibration is in its draws: name a "
            "folder that calibrate-slip wrote"
        )
    names = [p.name for p in (*found.curve.law.parameters, *NUISANCE)]
    draws, _ = read_draws_of(posterior, "posterior", names, advice="calibrate again")
    missing = [p.name for p in found.curve.law.parameters if p.name not in draws]
    if missing:
        raise DataError(f"has no draws of {', '.join(missing)}; calibrate again", file=posterior)
    content = read_toml_document(found.file)
    length = content.get("tested", {}).get("block_length")
    title = found.file.absolute().parent.name
    notes = []
    if found.doubt is not None:
        notes.append(f"WARNING: the prior is a calibration that is {found.doubt}")
    if is_simulated(found.source):
        notes.append(f"the prior is a calibration of SIMULATED data, source '{found.source}'")
    return EarlierCalibration(
        title=title,
        curve=found.curve,
        draws=draws,
        block_length=length if isinstance(length, int) else None,
        source=found.source,
        files=(found.file, posterior),
        notes=tuple(notes),
        data=frozenset(map(str, content.get("data", {}).values())),
    )
