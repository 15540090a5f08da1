# SPDX-License-Identifier: MIT
"""Results of the rig's commands in numbers, for their JSON documents."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zebro_lab.files.source_names import is_simulated

if TYPE_CHECKING:
    from rig.experiment.run import Outcome
    from rig.experiment.weigh import GainCheck, Weighing
    from zebro_lab.experiment.check_stage import CheckedRun
    from zebro_lab.experiment.journal import Journal


def experiment_in_numbers(outcome: "Outcome", journal: "Journal", data: Path) -> dict[str, Any]:
    """Return how an experiment ended, and each run folder that was closed in it.

    Args:
        outcome: Outcome of the command's run.
        journal: Journal of the experiment, with the runs of earlier commands.
        data: Folder of the experiment.
    """
    return {
        "folder": data,
        "simulated": is_simulated(outcome.source),
        "source": outcome.source,
        "reason": outcome.reason,
        "finished": outcome.finished,
        "refused": outcome.refused,
        "attempts": outcome.attempts,
        "runs": [_run_in_numbers(entry) for entry in journal.points],
    }


def _run_in_numbers(entry: Mapping[str, Any]) -> dict[str, Any]:
    """Return a journal's entry of a run; its numbers are None where the run was cut short."""
    accepted = entry.get("accepted") is True
    return {
        "name": entry.get("folder"),
        "point": entry.get("number"),
        "attempt": entry.get("attempt"),
        "accepted": accepted,
        "why": None if accepted else entry.get("text"),
        "slip_ratio": entry.get("slip"),
        "friction": entry.get("friction"),
        "normal_force_N": entry.get("normal"),
    }


def weighing_in_numbers(
    weighing: "Weighing", check: "GainCheck", written: Path | None
) -> dict[str, Any]:
    """Return the readings of a load cell under known weights, and the line through them."""
    columns = zip(weighing.forces, weighing.readings, weighing.errors, strict=True)
    return {
        "simulated": is_simulated(weighing.source),
        "written": [] if written is None else [written],
        "weights": [
            {"force_N": force, "reading_N": reading, "standard_error_N": error}
            for force, reading, error in columns
        ],
        "slope": check.slope,
        "slope_sd": check.slope_sd,
        "zero_N": check.zero,
        "zero_sd_N": check.zero_sd,
        "largest_residual_N": check.misfit,
        "gain_sd": check.gain_sd,
        "bias_sd_N": check.bias_sd,
    }


def checked_in_numbers(run: "CheckedRun") -> dict[str, Any]:
    """Return the comparison of one run with a calibration."""
    return {
        "name": run.name,
        "slip_ratio": run.slip,
        "normal_force_N": run.load,
        "traction_N": run.traction,
        "expected_N": run.expected,
        "sd_N": run.sd,
        "verdict": run.verdict or "ok",
    }
