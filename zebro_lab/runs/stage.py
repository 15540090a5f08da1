# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab runs`: summarise all run folders below a folder."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path

from zebro_lab.files.errors import ZebroLabError
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.runs.exclusion import NO_REASON, past_reasons
from zebro_lab.runs.folder import LOG_FILE, RECOVERED, find_runs, run_state
from zebro_lab.runs.manifest import RunManifest, read_manifest


@dataclass(frozen=True)
class ListedRun:
    """One run in the list of runs.

    Attributes:
        name: Name of the run folder.
        state: State of the run, its exclusions with reasons, or why it cannot be read.
        duration: Time from start to stop [s], in state `recovered` to the last sample; None where
            there is neither.
        samples: Number of samples of each topic; empty when unknown.
        source: Where the data come from; None if the run cannot be read.
    """

    name: str
    state: str
    duration: float | None = None
    samples: Mapping[str, int] = field(default_factory=dict)
    source: str | None = None


def list_runs(data: Path) -> list[ListedRun]:
    """List all runs in and below a folder, by path; an unreadable run is listed with its error.

    Samples are numbers from the manifest; of a run in state `recovered` they are counted in the
    log, whose last sample is the end.

    Raises:
        NotFound: The folder does not exist.
    """
    return [_listed(folder) for folder in find_runs(data)]


def _listed(folder: Path) -> ListedRun:
    """Return the entry of a run; of a run that cannot be read its name and the error."""
    try:
        manifest = read_manifest(folder)
        state = run_state(folder, manifest)
        streams, lasted = manifest.streams, _lasted(manifest)
        if state == RECOVERED:
            log = read_raw_log(folder / LOG_FILE)
            streams, lasted = {topic: len(each) for topic, each in log.streams.items()}, log.end
    except (ZebroLabError, OSError) as error:
        return ListedRun(folder.name, f"unreadable: {error}")
    state = _with_exclusions(state, manifest)
    return ListedRun(folder.name, state, lasted, streams, manifest.source)


def _with_exclusions(state: str, manifest: RunManifest) -> str:
    """Replace the state of an excluded run by its reasons; append past ones to other states."""
    before = "; ".join(past_reasons(manifest))
    if manifest.excluded is None:
        return f"{state} (was excluded: {before})" if before else state
    why = manifest.excluded.get("why", NO_REASON)
    return f"excluded ({why}; before: {before})" if before else f"excluded ({why})"


def _lasted(manifest: RunManifest) -> float | None:
    """Return the time from start to stop by the manifest [s]; None without a stop."""
    if manifest.stop is None:
        return None
    return (datetime.fromisoformat(manifest.stop) - manifest.began).total_seconds()
