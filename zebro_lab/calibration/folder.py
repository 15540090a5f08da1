# SPDX-License-Identifier: MIT
"""Read and write `slip.toml` of a calibration folder; write `summary.csv` and `posterior.nc`.

Only this module depends on the format of the first two; the draws are read in `posterior_file`.
"""

import csv
import io
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import tomlkit

from model.slip.curve import SlipCurve
from model.slip.definition import SlipDefinition
from model.slip.laws import law_options, slip_law
from zebro_lab.calibration.advice import advice_texts
from zebro_lab.calibration.draws import posterior_tree
from zebro_lab.calibration.law_table import LAWS_CSV, laws_content, laws_csv
from zebro_lab.files.documents import read_toml_document
from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.files.names import shortest_distinct
from zebro_lab.files.opening import parsing
from zebro_lab.files.picture_format import in_every_format
from zebro_lab.files.replacement import recover
from zebro_lab.files.result_folder import ResultKind
from zebro_lab.files.source_names import is_simulated

if TYPE_CHECKING:  # the fit's own parts take seconds to import, and a law is read in most commands
    from model.bayes.calibration import Calibration

SCHEMA = 1
SLIP_TOML = "slip.toml"
AS_TESTED = "not fully tested"
"""`State.AS_TESTED` of `model.bayes.verdict`, which takes long to import."""
POSTERIOR = "posterior.nc"
PICTURES = ("curves", "surface", "corner", "traces", "residuals", "laws")
CALIBRATION = ResultKind(
    "calibration",
    "calibrate-slip",
    (SLIP_TOML, "summary.csv", LAWS_CSV, POSTERIOR, *in_every_format(*PICTURES)),
    schema=SCHEMA,
    inside={"walks": "walks"},
)
"""Kind of a calibration folder; `walks/` inside was fitted with its law and is removed with it."""

_LEAST = 1e-12
"""Least mean of a parameter that is above 0, in its unit."""
_ADVICE = "name a slip.toml or the folder that calibrate-slip wrote"
SUMMARY_COLUMNS = (
    "parameter", "symbol", "unit", "mean", "sd", "q05", "median", "q95", "prior", "contraction",
    "r_hat", "ess_bulk", "ess_tail", "autocorrelation_time", "mcse_over_sd",
)  # fmt: skip


@dataclass(frozen=True)
class SlipFile:
    """Content of a `slip.toml`.

    Attributes:
        curve: Slip law with posterior means and covariance, and ranges of the tested loads and slip
            ratios.
        file: The `slip.toml` itself, also if its folder was named.
        source: Where the data come from; "unknown" if the file does not state it.
        doubt: Headline of the verdict if the fit cannot be trusted; None if it can, as far as it
            was tested, or if the file does not say.
        caveat: Headline of the verdict if the fit can be trusted as far as it was tested only;
            else None.
        levels: Median measured load at each load that was set, rising [N]; empty if the file does
            not say.
    """

    curve: SlipCurve
    file: Path
    source: str
    doubt: str | None
    caveat: str | None = None
    levels: tuple[float, ...] = ()


def write_tables(
    folder: Path,
    calibration: "Calibration",
    *,
    inputs: Mapping[str, str],
    priors: Mapping[str, Any] | None = None,
    lateral: Mapping[str, object] | None = None,
) -> None:
    """Write `slip.toml`, `summary.csv` and `posterior.nc` of a fit, and `laws.csv` of a comparison.

    Args:
        folder: Existing folder to write into; files of these names are overwritten.
        calibration: The finished fit.
        inputs: SHA-256 of each file that was read, by path.
        priors: What was stated beforehand, for the table `priors`; None or empty for nothing.
        lateral: Content of the table `lateral_force`; None or empty for none.
    """
    from model.bayes.law_scores import LawScores

    (folder / SLIP_TOML).write_text(
        _slip_toml(calibration, inputs, priors or {}, lateral or {}), encoding="utf-8"
    )
    (folder / "summary.csv").write_text(summary_csv(calibration), encoding="utf-8")
    if isinstance(calibration.comparison, LawScores):
        (folder / LAWS_CSV).write_text(laws_csv(calibration.comparison), encoding="utf-8")
    content = io.BytesIO()  # HDF5 itself crashes where the disk is full
    posterior_tree(calibration).to_netcdf(content, engine="h5netcdf")
    (folder / POSTERIOR).write_bytes(content.getvalue())


def read_slip(path: Path) -> SlipCurve:
    """Read the slip curve of a calibration.

    Args:
        path: A `slip.toml`, or the folder that holds it.

    Raises:
        DataError: The file is missing, damaged, of another schema, or has an unknown law or
            invalid values.
    """
    return read_slip_file(path).curve


def read_slip_file(path: Path) -> SlipFile:
    """Read curve, source and verdict of a `slip.toml`; arguments and errors as in `read_slip`."""
    recover(path)
    file = path / SLIP_TOML if path.is_dir() else path
    try:
        content = read_toml_document(file, remedy=_ADVICE, fault=DataError)
    except NotFound as error:
        raise DataError(f"is no slip calibration (no such file); {_ADVICE}", file=file) from error
    with parsing(file, "cannot be read as a slip calibration", advice=_ADVICE):
        if content["schema"] != SCHEMA:
            raise DataError(
                f"has schema {content['schema']}, this version reads {SCHEMA}; update zebro-lab",
                file=file,
            )
        levels = tuple(float(each["normal_force"]) for each in content.get("curve", ()))
        return SlipFile(_curve(content), file, _text(content, "source", "unknown"),
                        *_reservations(content.get("verdict", {})), levels)  # fmt: skip


def _reservations(verdict: Mapping[str, Any]) -> tuple[str | None, str | None]:
    """Return doubt and caveat of `SlipFile`: the headline as one of them, else None.

    A fit that is not trustworthy has a caveat in the state `AS_TESTED`, and a doubt in any other
    state or without one, as in files of earlier versions. A verdict that does not say counts as
    trustworthy.
    """
    headline = _text(verdict, "headline", "not trustworthy")
    if verdict.get("trustworthy", True):
        return None, None
    if verdict.get("state") == AS_TESTED:
        return None, headline
    return headline, None


def _text(content: Mapping[str, Any], key: str, default: str) -> str:
    """Return a text in a TOML table, or the default if it is missing; else raise `TypeError`."""
    found = content.get(key, default)
    if not isinstance(found, str):
        raise TypeError(f"'{key}' is {found!r}; expected a text")
    return found


def _curve(content: Mapping[str, Any]) -> SlipCurve:
    """Return the slip curve that the content of a `slip.toml` describes."""
    options = {k: v for k, v in content["law"].items() if k != "name"}
    law = slip_law(content["law"]["name"], **options)
    k, tested = len(law.parameters), content["tested"]
    means = [content["parameters"][p.name]["mean"] for p in law.parameters]
    values = _numbers("parameters", means, (k,))
    for p, value in zip(law.parameters, values, strict=True):
        if not (p.lower or _LEAST) <= value <= p.upper:
            expected = f"from {p.lower:g}{' (excluded)' * (not p.lower)} to {p.upper:g}"
            raise ValueError(f"{p.name} has the mean {value:g}; expected a number {expected}")
    load_low, load_high = _numbers("tested.normal_force", tested["normal_force"], (2,))
    slip_low, slip_high = _numbers("tested.slip_ratio", tested["slip_ratio"], (2,))
    return SlipCurve(
        law=law,
        values=values,
        covariance=_numbers("covariance.matrix", content["covariance"]["matrix"], (k, k)),
        definition=SlipDefinition(content["slip_definition"]),
        load_range=(float(load_low), float(load_high)),
        slip_range=(float(slip_low), float(slip_high)),
    )


def _numbers(key: str, found: object, shape: tuple[int, ...]) -> np.ndarray:
    """Convert a list to an array; raise `ValueError` with the key if its shape is another."""
    numbers = np.array(found, dtype=float)
    if numbers.shape != shape:
        raise ValueError(f"{key} has numbers of shape {numbers.shape}; expected {shape}")
    return numbers


def _slip_toml(
    calibration: "Calibration",
    inputs: Mapping[str, str],
    priors: Mapping[str, Any],
    lateral: Mapping[str, object],
) -> str:
    """Format the content of `slip.toml`."""
    from model.bayes.law_scores import LawScores

    scores, document = calibration.comparison, tomlkit.document()
    document.add(tomlkit.comment("Slip curve fitted by calibrate-slip. SI units."))
    if is_simulated(calibration.source):
        document.add(tomlkit.comment("SIMULATED data: nothing here was measured."))
    document.update({
        "schema": SCHEMA,
        "source": calibration.source,
        "slip_definition": str(calibration.posterior.blocks.definition),
        "verdict": _verdict_content(calibration),
        **_law_content(calibration),
        "tested": _tested_content(calibration),
        **({"comparison": laws_content(scores)} if isinstance(scores, LawScores) else {}),
        **({"lateral_force": dict(lateral)} if lateral else {}),
        **_run_out_content(calibration),
        **({"priors": dict(priors)} if priors else {}),
        "data": dict(zip(shortest_distinct([*map(Path, inputs)]), inputs.values(), strict=True)),
    })  # fmt: skip
    return tomlkit.dumps(document)


def _verdict_content(calibration: "Calibration") -> dict[str, Any]:
    """Return the table `verdict`: headline, state, checks with evidence, and advice."""
    verdict = calibration.verdict
    return {
        "headline": verdict.headline(),
        "converged": verdict.converged,
        "trustworthy": verdict.trustworthy,
        "state": str(verdict.state),
        "likely_wrong": list(verdict.causes),
        "untested": list(verdict.untested),
        "notes": list(verdict.notes),
        "weakly_identified": list(verdict.weak),
        "next_steps": advice_texts(calibration),
        "checks": [
            {"name": check.name, "outcome": check.outcome.name.lower(), "evidence": check.evidence}
            for check in verdict.checks
        ],
    }


def _law_content(calibration: "Calibration") -> dict[str, Any]:
    """Return the tables `law`, `parameters`, `covariance` and `curve` of `slip.toml`.

    `parameters` has the posterior of all parameters, those of the measurement too; `covariance`
    that of the law's parameters alone. Each entry of `curve` has the posterior medians of the
    curve's features (peak, slope, …) at one load.
    """
    law, k = calibration.posterior.law, len(calibration.posterior.law.parameters)
    return {
        "law": {"name": law.name, **law_options(law)},
        "parameters": {
            e.parameter.name: {
                "symbol": e.parameter.symbol, "unit": e.parameter.unit, "mean": e.mean,
                "sd": e.sd, "q05": e.low, "median": e.median, "q95": e.high,
            }
            for e in calibration.parameters
        },
        "covariance": {
            "order": [p.name for p in law.parameters],
            "matrix": np.atleast_2d(np.cov(calibration.draws.flat[:, :k].T)).tolist(),
        },
        "curve": [
            {"normal_force": float(load), **{e.parameter.name: e.median for e in row}}
            for load, row in zip(calibration.levels, calibration.curves, strict=True)
        ],
    }  # fmt: skip


def _run_out_content(calibration: "Calibration") -> dict[str, Any]:
    """Return the table `run_out` of discs whose angles are recorded; empty if none is.

    It holds mean and standard deviation of the cosine and sine coefficients of each radius, once
    and twice a turn [m], whether slip is corrected, and what that gains in log density.
    """
    found = calibration.run_out
    if found is None:
        return {}
    names = ("cos", "sin", "cos_2", "sin_2")
    return {
        "run_out": {
            "corrected": bool(found.used),
            "log_density_of_left_out_runs": [round(found.gain, 3), round(found.standard_error, 3)],
            **{
                disc.disc: {
                    name: {"mean": float(mean), "sd": float(sd)}
                    for name, mean, sd in zip(names, disc.coefficients, disc.sd, strict=True)
                }
                for disc in found.discs
            },
        }
    }


def _tested_content(calibration: "Calibration") -> dict[str, Any]:
    """Return the table `tested`: ranges of block means, length of blocks, samples and runs."""
    blocks = calibration.posterior.blocks
    return {
        "normal_force": [float(blocks.normal_force.min()), float(blocks.normal_force.max())],
        "slip_ratio": [float(blocks.slip.min()), float(blocks.slip.max())],
        "samples": int(blocks.count.sum()),
        "runs": blocks.n_runs,
        "block_length": calibration.fit.block_choice.length,
    }


def summary_csv(calibration: "Calibration") -> str:
    """Format the parameters as CSV: a header `SUMMARY_COLUMNS`, then one line per parameter.

    A fixed parameter has the prior "fixed" and empty diagnostics.
    """
    convergence = calibration.convergence
    free = {p.name: i for i, p in enumerate(calibration.posterior.free)}
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(SUMMARY_COLUMNS)
    for e in calibration.parameters:
        name, i = e.parameter.name, free.get(e.parameter.name)
        numbers = [e.mean, e.sd, e.low, e.median, e.high]
        diagnostics = ["fixed"] + [""] * 6 if i is None else [
            calibration.posterior.priors[name].describe(), f"{calibration.contraction[name]:.4f}",
            f"{convergence.r_hat[i]:.4f}", f"{convergence.ess_bulk[i]:.0f}",
            f"{convergence.ess_tail[i]:.0f}", f"{convergence.autocorrelation_time[i]:.1f}",
            f"{convergence.mcse[i]:.4f}",
        ]  # fmt: skip
        values = [f"{x:.8g}" for x in numbers]
        table.writerow([name, e.parameter.symbol, e.parameter.unit, *values, *diagnostics])
    return text.getvalue()
