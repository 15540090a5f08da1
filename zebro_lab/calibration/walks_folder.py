# SPDX-License-Identifier: MIT
"""Read and write `walks/` of a calibration folder: posterior of legs and floor after tracked walks.

Only this module depends on the format of these files.
"""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import tomlkit

from model.counted import counted
from model.predict import ModelSpread
from model.walk_fit.posterior import FEW, WalkPosterior
from model.walk_fit.prior import ACROSS, UNITS, WRONG, WalkPrior, WrongLeg, all_cases
from zebro_lab.files.arrays import read_arrays
from zebro_lab.files.documents import read_toml_document
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import parsing
from zebro_lab.files.picture_format import in_every_format
from zebro_lab.files.provenance import file_hash, file_hashes
from zebro_lab.files.replacement import recover
from zebro_lab.files.result_folder import MANIFEST, ResultKind, result_folder
from zebro_lab.files.source_names import is_simulated
from zebro_lab.robot.robot_file import RobotFile

Metrics: TypeAlias = Mapping[str, float]
"""Metrics of one model's path, by the names of columns in `left_out.csv`."""

SCHEMA = 3
ISOTROPIC = 2  # fitted with traction alike in all directions
# Schema 1 defined the post-peak drop with another reference point.
FOLDER = "walks"
WALKS_TOML, DRAWS, LEFT_OUT = "walks.toml", "draws.npz", "left_out.csv"
_ANEW = "fit the walks again with calibrate-slip --walks"
WALKS = ResultKind(
    "walks", "calibrate-slip --walks", (WALKS_TOML, DRAWS, LEFT_OUT, *in_every_format("*")), SCHEMA
)


@dataclass(frozen=True)
class StoredWalks:
    """Posterior of legs and floor after tracked walks, as read from a folder `walks/`.

    Attributes:
        posterior: Posterior of leg offsets and floor, with its draws and their weights.
        legs: Parameters of the robot whose legs were fitted, as `describe_legs` returns them.
        logs: SHA-256 of the leg log of each walk, in the order of `posterior.walks`.
        folder: The folder `walks/` that it was read from.
        source: Sources of slip law and walks, joined by commas; "unknown" if not stated.
    """

    posterior: WalkPosterior
    legs: Mapping[str, Any]
    logs: tuple[str, ...]
    folder: Path
    source: str = "unknown"

    @property
    def doubts(self) -> tuple[str, ...]:
        """A warning if the fit of the walks is not reliable; else empty."""
        if self.posterior.reliable:
            return ()
        draws = counted(round(self.posterior.effective), "effective draw")
        return (
            f"WARNING: the fit of walks in {self.folder} is not reliable: {draws}, expected {FEW} "
            "or more; check the tracks' covariances and robot.toml, fit the walks again with "
            f"calibrate-slip --walks, or delete {self.folder}",
        )

    @property
    def files(self) -> tuple[Path, ...]:
        """The two files that were read: `walks.toml` and `draws.npz`."""
        return self.folder / WALKS_TOML, self.folder / DRAWS


@dataclass(frozen=True)
class WalksToWrite:
    """A finished fit of legs and floor to tracked walks, to be written into `walks/`.

    Attributes:
        posterior: Posterior of leg offsets and floor.
        left_out: Metrics of each walk as predicted by a fit of the other walks, by walk and then by
            model; empty for one walk.
        robot: Parameters of the robot that walked.
        logs: Leg log of each walk, in the order of `posterior.walks`.
        inputs: Every file read, the `slip.toml` first.
        settings: Settings of the fit, JSON-serialisable.
        source: Sources of slip law and walks, joined by commas.
        notes: Notes, one line each.
    """

    posterior: WalkPosterior
    left_out: Mapping[str, Mapping[str, Metrics]]
    robot: RobotFile
    logs: tuple[Path, ...]
    inputs: tuple[Path, ...]
    settings: Mapping[str, object]
    source: str
    notes: tuple[str, ...]


def describe_legs(described: RobotFile) -> dict[str, Any]:
    """Return the parameters by which robots are compared, JSON-serialisable, SI.

    They are hips, leg offsets, leg radius and arc, mass, principal inertia and leg signs.
    """
    robot = described.robot
    return {
        "hips": robot.hips.tolist(),
        "leg_offset": robot.leg_offset.tolist(),
        "leg_radius": float(robot.leg_radius),
        "leg_arc": float(robot.leg_arc),
        "mass": float(robot.mass),
        "inertia": robot.principal_inertia.tolist(),
        "leg_sign": list(described.leg_sign),
    }


def write_walks(calibration: Path, fitted: WalksToWrite, *, draw: Callable[[Path], object]) -> Path:
    """Write `walks/` into a calibration folder, atomically: posterior, draws, metrics, pictures.

    Args:
        calibration: The calibration folder.
        fitted: The finished fit of the walks.
        draw: Draws the pictures into the folder that it is given.

    Returns:
        The folder written, `walks/` of the calibration folder.

    Raises:
        AlreadyExists, NotWritten: As in `result_folder`.
    """
    folder = calibration / FOLDER
    inputs = file_hashes(dict.fromkeys(fitted.inputs))
    content = {
        "source": fitted.source,
        "settings": fitted.settings,
        "left_out": fitted.left_out,
        "notes": list(fitted.notes),
        "inputs": inputs,
    }
    with result_folder(folder, WALKS, content=content) as draft:
        (draft / WALKS_TOML).write_text(_walks_toml(fitted, inputs), encoding="utf-8")
        posterior = fitted.posterior
        np.savez_compressed(
            draft / DRAWS,
            values=posterior.values, case=posterior.case, weight=posterior.weight,
            best=posterior.best,
        )  # fmt: skip
        _write_left_out(draft / LEFT_OUT, fitted.left_out)
        draw(draft)
    return folder


def read_stored_walks(slip_toml: Path) -> StoredWalks | None:
    """Read the posterior of legs and floor from `walks/` beside a slip.toml.

    None is returned if no walks were fitted: `walks/` lacks `walks.toml` or its manifest.

    Args:
        slip_toml: The `slip.toml` of the calibration.

    Raises:
        NotFound: `draws.npz` is missing.
        DataError: A file is damaged, of another schema, or `slip.toml` has changed since the fit.
    """
    folder = recover(slip_toml.parent / FOLDER)
    file = folder / WALKS_TOML
    if not (folder / MANIFEST).is_file() or not file.is_file():
        return None
    remedy = f"delete {folder}, then {_ANEW} if they are to be used"
    content = read_toml_document(file, remedy=remedy, fault=DataError)
    with parsing(file, "cannot be read", advice=remedy):
        if content["schema"] not in (SCHEMA, ISOTROPIC):
            raise DataError(
                f"has schema {content['schema']}, this version reads {SCHEMA}; {_ANEW}, or update "
                "zebro-lab where it is the older",
                file=file,
            )
        _require_same_slip(content, slip_toml, file)
        names = ("values", "case", "weight", "best")
        arrays = read_arrays(folder / DRAWS, names, advice=remedy)
        return StoredWalks(
            _posterior(content, arrays),
            content["legs"],
            tuple(each["leg_log"] for each in content["walk"]),
            folder,
            str(content.get("source", "unknown")),
        )


def _require_same_slip(content: Mapping[str, Any], slip_toml: Path, file: Path) -> None:
    """Raise `DataError` if the hash of `slip.toml` is not that of the fit of walks."""
    if content["slip"] != file_hash(slip_toml):
        raise DataError(
            f"was fitted with another slip law than the {slip_toml.name} beside it; fit the walks "
            f"again with calibrate-slip --walks, or delete {file.parent}",
            file=file,
        )


def _posterior(content: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> WalkPosterior:
    """Return the posterior from `walks.toml` and `draws.npz`; raise `ValueError` if shapes differ.

    Files of schema `ISOTROPIC` lack the parameters of lateral traction, which become 0.
    """
    prior = dict(content["prior"])
    names = tuple(each["name"] for each in content["walk"])
    values, case, weight, best = (arrays[key] for key in ("values", "case", "weight", "best"))
    if content["schema"] == ISOTROPIC:
        values, best = (_with_lateral(each) for each in (values, best))
        prior["lateral_sd"] = 0.0
    n = len(weight)
    cases = all_cases(len(names))
    if values.shape != (n, WRONG + 1) or case.shape != (n,) or best.shape != (WRONG + 1,):
        raise ValueError(f"values, case or best is not of {n} draws of {WRONG + 1} parameters")
    return WalkPosterior(
        prior=WalkPrior(**{**prior, "spread": ModelSpread(**prior["spread"])}),
        walks=names,
        cases=cases,
        values=values,
        case=case,
        weight=weight / weight.sum(),
        best=best,
        best_case=cases[int(content["likeliest_case"])],
        misfit=tuple(float(each["misfit"]) for each in content["walk"]),
    )


def _with_lateral(values: np.ndarray) -> np.ndarray:
    """Insert columns of zeros, lateral traction as longitudinal, into parameters without them."""
    return np.insert(values, [ACROSS[0]] * len(ACROSS), 0.0, axis=-1)


def _walks_toml(fitted: WalksToWrite, inputs: Mapping[str, str]) -> str:
    """Format the content of `walks.toml`; the first of `inputs` is the hash of `slip.toml`."""
    posterior = fitted.posterior
    parameters = posterior.contractions()
    document = tomlkit.document()
    document.add(tomlkit.comment("Legs and floor fitted to tracked walks. SI units and radians."))
    if is_simulated(fitted.source):
        document.add(tomlkit.comment("SIMULATED walks: nothing here was measured."))
    document.update({
        "schema": SCHEMA,
        "source": fitted.source,
        "slip": next(iter(inputs.values())),
        "effective_draws": posterior.effective,
        "reliable": posterior.reliable,
        "likeliest_case": posterior.cases.index(posterior.best_case),
        "not_informed": [each.name for each in parameters if not each.informed],
        "prior": asdict(posterior.prior),
        "legs": describe_legs(fitted.robot),
        "walk": [
            {"name": name, "misfit": misfit, "leg_log": file_hash(log)}
            for name, misfit, log in zip(
                posterior.walks, posterior.misfit, fitted.logs, strict=True
            )
        ],
        "parameter": [
            {
                "name": each.name, "unit": unit, "prior_sd": each.prior_sd, "mean": each.mean,
                "sd": each.sd, "informed": each.contraction,
            }
            for each, unit in zip(parameters, UNITS, strict=True)
        ],
        "case": [_case(found, posterior) for found in posterior.found()],
    })  # fmt: skip
    return tomlkit.dumps(document)


def _case(found: Any, posterior: WalkPosterior) -> dict[str, Any]:
    """Return the entry of a case in `walks.toml`.

    A leg that is mounted wrongly has its number and offset, and the walk if it is so in one alone.
    """
    row = {"name": found.name, "probability": found.probability}
    if isinstance(found.case, WrongLeg):
        row |= {
            "leg": found.case.leg + 1,
            "offset": found.offset,
            "offset_sd": found.sd,
            "offset_deg": float(np.degrees(found.offset)),
            "offset_sd_deg": float(np.degrees(found.sd)),
        }
        if found.case.walk is not None:
            row["walk"] = posterior.walks[found.case.walk]
    return row


def _write_left_out(file: Path, left_out: Mapping[str, Mapping[str, Metrics]]) -> None:
    """Write `left_out.csv`, one row per walk and model."""
    import pandas as pd

    rows = [
        {"walk": walk, "model": model, **metrics}
        for walk, models in left_out.items()
        for model, metrics in models.items()
    ]
    pd.DataFrame(rows, columns=None if rows else ["walk", "model"]).to_csv(
        file, index=False, float_format="%.8g", lineterminator="\n"
    )
