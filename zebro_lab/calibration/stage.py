# SPDX-License-Identifier: MIT
"""Stage of `calibrate-slip`: read rig data, sample the posterior, write the calibration folder."""

import time
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import asdict
from pathlib import Path

from model.bayes.calibrate import FitStopped, SamplerSettings
from model.bayes.calibrate import calibrate as fit_slip_law
from model.bayes.calibration import Calibration
from model.bayes.drawing.sampler import Chains
from model.bayes.fit import scaled_load_cell
from model.bayes.preview import Preview
from model.tasks import Watcher
from zebro_lab.calibration.candidates import candidates
from zebro_lab.calibration.checkpoint import FILE as CHECKPOINT
from zebro_lab.calibration.checkpoint import load_checkpoint, save_checkpoint
from zebro_lab.calibration.folder import CALIBRATION, write_tables
from zebro_lab.calibration.lateral_force import LateralForce
from zebro_lab.calibration.pictures import draw_calibration
from zebro_lab.calibration.priors import KnownPriors, gather_priors, priors_content
from zebro_lab.calibration.request import COMPARE, CalibrationRequest
from zebro_lab.calibration.rig_data import RigData, read_rig_data
from zebro_lab.files.errors import ZebroLabError
from zebro_lab.files.provenance import file_hashes, fingerprint
from zebro_lab.files.result_folder import require_replaceable, result_folder
from zebro_lab.terminal.stopping import StoppedBySignal

CHECKPOINT_SECONDS = 5.0


class Stopped(ZebroLabError):
    """The fit was stopped on request.

    Attributes:
        checkpoint: Checkpoint file; None if sampling had not begun and nothing was written.
    """

    def __init__(self, checkpoint: Path | None) -> None:
        super().__init__(
            "stopped before sampling began; nothing was written"
            if checkpoint is None
            else f"stopped; {checkpoint} keeps the fit, and --resume goes on"
        )
        self.checkpoint = checkpoint


def read(request: CalibrationRequest, watcher: Watcher) -> RigData:
    """Read the rig data of a request, whose output folder can be written or replaced.

    Args:
        request: Options: data and output folder.
        watcher: Receives progress.

    Raises:
        ZebroLabError: Data, options or output folder are invalid.
    """
    require_replaceable(request.out, CALIBRATION, inputs=request.inputs)
    watcher.step("reading", None)
    return read_rig_data(
        request.data, columns=request.columns, slip_definition=request.slip_definition
    )


def calibrate(
    request: CalibrationRequest,
    watcher: Watcher,
    data: RigData | None = None,
    first: Callable[[Preview], object] = lambda _: None,
    *,
    executor: Executor | None = None,
) -> tuple[Calibration, RigData]:
    """Fit a slip law to rig data, and write the calibration folder.

    It has a checkpoint if sampling did not converge; else an earlier checkpoint is removed.

    Args:
        request: Options: data, settings and output folder.
        watcher: Receives progress and may request a stop.
        data: What `read` returned for the same request; None to read it here.
        first: Called with the first answer, before sampling.
        executor: Computes the fits that leave out runs or loads; None for this process.

    Returns:
        The finished fit and the rig data that were fitted.

    Raises:
        ZebroLabError: Data, options, checkpoint or output folder are invalid.
        ModelError: The law is unknown or the fit failed; a checkpoint may have been written.
        Stopped: The watcher requested a stop, or a signal stopped the fit after a checkpoint; one
            was written if sampling had begun.
        StoppedBySignal: A signal stopped the fit before a checkpoint.
    """
    data = read(request, watcher) if data is None else data
    stated, laws = gather_priors(request, data, candidates(request, data.samples))
    inputs = file_hashes((*data.files, *stated.files))
    mark = fingerprint(inputs, request.decisive())
    earlier = load_checkpoint(request.out, fingerprint=mark) if request.resume else None
    checkpoint = _Checkpoint(request.out, mark)
    try:
        calibration, chains = fit_slip_law(
            data.samples,
            laws,
            load_cell=scaled_load_cell(data.samples, data.load_cell),
            rig_errors=data.rig_errors,
            settings=_sampler(request, stated),
            source=data.source,
            watcher=watcher,
            clock=time.monotonic,
            earlier=earlier,
            keep=checkpoint.keep,
            stated=stated.priors,
            scored=request.law == COMPARE,
            first=first,
            executor=executor,
        )
        watcher.step("drawing", None)
        _write(request, calibration, inputs, stated, data.lateral)
    except FitStopped as stopped:
        raise Stopped(checkpoint.save(stopped.chains)) from stopped
    except StoppedBySignal as stopped:  # at once, in a step that hears no wish to stop
        if checkpoint.exists or request.resume:
            raise Stopped(request.out / CHECKPOINT) from stopped
        raise
    if calibration.convergence.converged or chains is None:
        (request.out / CHECKPOINT).unlink(missing_ok=True)
    else:
        checkpoint.save(chains)
    return calibration, data


class _Checkpoint:
    """Writes the checkpoint of a fit at intervals of `CHECKPOINT_SECONDS`.

    Attributes:
        exists: Whether a checkpoint of this fit has been written.
    """

    def __init__(self, folder: Path, mark: str) -> None:
        self._folder, self._mark, self._saved = folder, mark, time.monotonic()
        self.exists = False

    def keep(self, chains: Chains) -> None:
        """Write the chains if the last write, or the start, is over `CHECKPOINT_SECONDS` ago."""
        if time.monotonic() - self._saved > CHECKPOINT_SECONDS:
            self.save(chains)

    def save(self, chains: Chains | None) -> Path | None:
        """Write the chains and return the checkpoint file; None if there are no chains."""
        if chains is None:
            return None
        self._saved = time.monotonic()
        file = save_checkpoint(self._folder, chains, fingerprint=self._mark)
        self.exists = True
        return file


def stated_notes(request: CalibrationRequest, data: RigData) -> tuple[str, ...]:
    """Return notes on the priors that request and data state, one line each.

    Raises:
        ZebroLabError: A prior cannot be used, or an earlier calibration cannot be read.
    """
    return gather_priors(request, data, candidates(request, data.samples))[0].notes


def _sampler(request: CalibrationRequest, stated: KnownPriors) -> SamplerSettings:
    """Return the settings of the sampler; an earlier calibration may fix the block length."""
    return SamplerSettings(
        max_steps=request.max_steps,
        block_length=stated.block_length,
        threads=request.workers.cores,
        seed=request.seed,
        sampled=request.engine != "laplace",
    )


def _write(
    request: CalibrationRequest,
    calibration: Calibration,
    inputs: dict[str, str],
    stated: KnownPriors,
    lateral: LateralForce | None,
) -> None:
    """Write the calibration folder: tables, pictures and manifest."""
    priors, fit = priors_content(stated, calibration), calibration.fit
    known = {"load_cell": asdict(fit.load_cell), "rig_errors": asdict(fit.rig_errors)}
    settings = {**request.decisive(), **known, "priors": priors}
    content = {"source": calibration.source, "settings": settings, "inputs": inputs}
    with result_folder(request.out, CALIBRATION, content=content) as folder:
        write_tables(
            folder, calibration, inputs=inputs, priors=priors,
            lateral=None if lateral is None else lateral.content(),
        )  # fmt: skip
        draw_calibration(folder, calibration, request)
