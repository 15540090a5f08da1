# SPDX-License-Identifier: MIT
"""Finished studies of made-up replicates, and a calibration folder to study."""

import json
from dataclasses import asdict
from pathlib import Path

import numpy as np

from model.study.coverage import LEVELS, CoverageReplicate, CoverageResult, conclude_coverage
from model.study.ranks import RankReplicate, RankResult, conclude_ranks
from support.short_calibration import short_calibration
from zebro_lab.calibration.folder import write_tables


def ranks_of(names, n=120, *, narrow=()) -> RankResult:
    """Return a study whose ranks are uniform, but for some parameters at both ends; one failed."""
    rng = np.random.default_rng(1)
    replicates = [
        RankReplicate(
            i,
            dict.fromkeys(names, 1.0),
            {x: int(rng.choice([0, 99]) if x in narrow else rng.integers(100)) for x in names},
            0.3,
            900.0,
            True,
        )
        for i in range(n)
    ]
    failed = RankReplicate(n, dict.fromkeys(names, 1.0), failure="no curve")
    return conclude_ranks(list(names), [*replicates, failed])


def coverage_of(names, n=60, *, narrow=()) -> CoverageResult:
    """Return a study whose intervals hold as stated, but for some parameters."""
    rng = np.random.default_rng(2)
    return conclude_coverage(
        [
            CoverageReplicate(
                i,
                dict.fromkeys(names, 1.0),
                {
                    x: tuple(bool(rng.random() < (0.3 if x in narrow else p)) for p in LEVELS)
                    for x in names
                },
                dict.fromkeys(names, 0.05),
                dict.fromkeys(names, 0.01),
                0.3,
                900.0,
                True,
            )
            for i in range(n)
        ]
    )


def calibration_folder(folder: Path, **settings) -> Path:
    """Write a calibration of a short fit with what a study reads of it."""
    folder.mkdir()
    calibration = short_calibration()
    write_tables(folder, calibration, inputs={})
    known = {"load_cell": asdict(calibration.fit.load_cell),
             "rig_errors": asdict(calibration.fit.rig_errors)}  # fmt: skip
    content = {"schema": 1, "kind": "calibration", "settings": {**known, **settings}}
    (folder / "manifest.json").write_text(json.dumps(content))
    return folder
