# SPDX-License-Identifier: MIT
"""Blocks, law and priors of a calibration, with which further runs are weighed."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from model.bayes.fit import not_identified
from model.bayes.likelihood import NUISANCE
from model.bayes.posterior import LoadCell, SlipPosterior, default_priors
from model.bayes.priors import Prior
from model.slip.definition import SlipDefinition
from model.slip.law import SlipLaw
from model.slip.rig_errors import USUAL, RigErrors
from zebro_lab.calibration.folder import POSTERIOR, SlipFile, read_slip_file
from zebro_lab.calibration.posterior_file import read_slip_blocks
from zebro_lab.calibration.prior_argument import named_priors, parse_prior
from zebro_lab.files.documents import read_toml_document
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.files.folder_manifest import MANIFEST, read_json_object


@dataclass(frozen=True)
class Calibrated:
    """A calibration as it was fitted, but for what `notes` name.

    Attributes:
        slip: Its `slip.toml`.
        posterior: Blocks, law and priors; coordinates are independent a priori.
        files: Files that were read.
        notes: Notes, one line each.
    """

    slip: SlipFile
    posterior: SlipPosterior
    files: tuple[Path, ...]
    notes: tuple[str, ...]


def read_calibrated(path: Path) -> Calibrated:
    """Read the blocks, law and priors of a calibration of the rig.

    Raises:
        SettingsError: It is of other slip than the rig's.
        DataError: It is missing or damaged, or of a version that kept too little.
    """
    slip = read_slip_file(path)
    folder, law = slip.file.parent, slip.curve.law
    if slip.curve.definition is not SlipDefinition.MATERIAL:
        raise SettingsError(
            f"{path} is of '{slip.curve.definition}' slip; plans are in 'material' slip: calibrate "
            "with --slip-definition material",
            key="--calibration",
        )
    blocks = read_slip_blocks(slip.file, SlipDefinition.MATERIAL)
    settings = read_json_object(folder / MANIFEST, of="calibration").get("settings", {})
    load_cell = _known(LoadCell, settings, "load_cell", folder)
    rig_errors = _known(RigErrors, settings, "rig_errors", folder, USUAL)
    stated, notes = _stated_in(settings, law, folder)
    priors = {**default_priors(law, blocks, load_cell, rig_errors), **stated}
    posterior = SlipPosterior(blocks, law, priors, not_identified(blocks))
    if "noise" in read_toml_document(slip.file):
        notes += ("its Student-t noise is left out: further runs are weighed with Gaussian noise",)
    return Calibrated(slip, posterior, (slip.file, folder / POSTERIOR, folder / MANIFEST), notes)


def _stated_in(
    settings: Mapping[str, Any], law: SlipLaw, folder: Path
) -> tuple[dict[str, Prior], tuple[str, ...]]:
    """Return the priors stated to a calibration with `--prior`, by name; and notes.

    The prior of `--prior-from`, the posterior of another calibration, is left out, with a note.
    """
    told = settings.get("priors") or {}
    file = folder / MANIFEST
    texts = [str(text) for text in told.get("stated", {}).values()]
    parsed = [parse_prior(text, key="settings.priors", file=file) for text in texts]
    named = named_priors(parsed, (*law.parameters, *NUISANCE), key="settings.priors", file=file)
    notes = ()
    if "from" in told:
        notes = ("the prior of --prior-from is left out: the default priors are taken there",)
    return {name: prior for name, (prior, _) in named.items()}, notes


def _known(
    of: type[Any], settings: Mapping[str, Any], key: str, folder: Path, default: Any = None
) -> Any:
    """Return prior knowledge that a manifest holds, as an instance of the dataclass `of`.

    `default` is returned if the manifest has no such key.

    Raises:
        DataError: The key is missing and there is no default, or its value is invalid.
    """
    found = settings.get(key, default)
    if found is None:
        raise DataError(f"has no settings.{key}; calibrate again", file=folder / MANIFEST)
    if found is default:
        return default
    try:
        return of(**{name: float(value) for name, value in found.items()})
    except (AttributeError, TypeError, ValueError) as error:
        raise DataError(
            f"settings.{key} cannot be read ({error}); calibrate again", file=folder / MANIFEST
        ) from error
