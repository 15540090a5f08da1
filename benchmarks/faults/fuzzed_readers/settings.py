# SPDX-License-Identifier: MIT
"""Readers of TOML, with the documents that their inputs are made from."""

import tomllib
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.faults.fuzzed_readers.bombs import toml_bombs
from benchmarks.faults.fuzzed_readers.reader import Reader, Take, toml_check
from benchmarks.faults.hostile_inputs import (
    as_toml,
    documents,
)
from model.bayes.walks.prior import WRONG, WalkPrior
from rig.imu.profile import load_imu_profile
from rig.profile import shipped_file
from rig.slip_rig.profile import load_rig_profile
from rig.zebro.profile import load_leg_profile
from zebro_lab.calibration.slip_argument import parse_slip
from zebro_lab.calibration.walks_folder import SCHEMA, describe_legs, read_stored_walks
from zebro_lab.experiment.plan_file import read_plan
from zebro_lab.files.provenance import file_hash
from zebro_lab.robot.robot_file import RobotFile, read_robot_file, render_robot_file
from zebro_lab.tables.columns_file import read_columns
from zebro_lab.track.annotations import read_annotations
from zebro_lab.track.camera_file import read_camera_file
from zebro_lab.track.floor_file import read_floor_file

ROOT = Path(__file__).parents[3]


def of_settings() -> Mapping[str, Reader]:
    """Return readers of TOML."""
    text = {path.stem: path.read_bytes() for path in (ROOT / "datasets/walk-sim").glob("*.toml")}
    robot = tomllib.loads(render_robot_file(RobotFile())) | {
        "marker": {"position": [0, 0, 0.04], "id": 3, "height": "10 cm", "side": 0.03}
    }
    columns = {
        "source": "real", "constants": {"radius_leg": "35 mm"}, "runs": {"by": ["a"]},
        "columns": {"t": {"name": "T", "unit": "ms"}, "slip_ratio": {"definition": "material"}},
        "rows": {"keep": ["slip > 0.1"]}, "load_cell": {"gain_sd": 0.01},
    }  # fmt: skip
    annotations = {
        "template": {"photo": "a.jpg", "corners_px": [[1, 2], [3, 4], [5, 6], [7, 8]],
                     "length": 0.2, "width": 0.1, "height": 0.1},
        "clicks": {"a.jpg": {"A": [1.0, 2.0]}},
        "correction": [{"photo": "a.jpg", "leave_out": True}],
    }  # fmt: skip
    camera, floor = (tomllib.loads(text[name].decode()) for name in ("camera", "floor"))
    plan = tomllib.loads((ROOT / "examples/plan-thesis.toml").read_text())
    named: dict[str, tuple[Take, tuple[dict[str, Any], ...]]] = {
        "robot.toml": (read_robot_file, (robot, tomllib.loads(text["robot"].decode()))),
        "columns.toml": (read_columns, (columns,)),
        "camera.toml": (read_camera_file, (camera,)),
        "floor.toml": (read_floor_file, (floor,)),
        "annotations.toml": (read_annotations, (annotations,)),
        "plan.toml": (read_plan, (plan,)),
        "slip.toml": (lambda file: parse_slip(str(file)), (slip_document(),)),
        "profile of legs": (
            lambda file: load_leg_profile(str(file)), profiles("zebro-100-serial", "zebro-100-can")
        ),
        "profile of an IMU": (
            lambda file: load_imu_profile(str(file)), profiles("imu-quaternion-serial")
        ),
        "profile of a rig": (
            lambda file: load_rig_profile(str(file)),
            profiles("rig-odrive-netft", "rig-board-serial"),
        ),
    }  # fmt: skip
    return {
        name: Reader("x.toml", read, documents(as_toml, *bases), toml_check, special=toml_bombs)
        for name, (read, bases) in named.items()
    } | {
        "walks.toml": Reader(
            "walks/walks.toml", lambda file: read_stored_walks(file.parent.parent / "slip.toml"),
            documents(as_toml, walks_document()), toml_check, prepare=write_beside_walks,
            special=toml_bombs,
        )
    }  # fmt: skip


def profiles(*names: str) -> tuple[dict[str, Any], ...]:
    """Return shipped profiles."""
    return tuple(tomllib.loads(shipped_file(f"{name}.toml").read_text("utf-8")) for name in names)


def slip_document() -> dict[str, Any]:
    """Return what a slip.toml holds."""
    means = {"slip_stiffness": {"mean": 5.0}, "friction": {"mean": 0.4}}
    return {
        "schema": 1, "source": "real", "slip_definition": "material", "law": {"name": "brush"},
        "tested": {"normal_force": [1.0, 2.0], "slip_ratio": [0.0, 1.0]}, "parameters": means,
        "covariance": {"matrix": [[0.01, 0.0], [0.0, 0.01]]},
        "verdict": {"headline": "fine", "trustworthy": True},
    }  # fmt: skip


def walks_document() -> dict[str, Any]:
    """Return what a walks.toml holds, for the slip.toml of `write_beside_walks`."""
    import hashlib

    return {
        "schema": SCHEMA, "slip": hashlib.sha256(as_toml(slip_document())).hexdigest(),
        "likeliest_case": 0, "prior": asdict(WalkPrior()), "legs": describe_legs(RobotFile()),
        "walk": [{"name": "a", "misfit": 0.9, "leg_log": "0" * 64}],
    }  # fmt: skip


def write_beside_walks(folder: Path) -> None:
    """Write a slip.toml and the draws of walks that belong to it."""
    (folder / "slip.toml").write_bytes(as_toml(slip_document()))
    (folder / "walks/manifest.json").write_text("{}")
    n = 10
    np.savez(
        folder / "walks/draws.npz", values=np.zeros((n, WRONG + 1)), case=np.zeros(n, int),
        weight=np.full(n, 1 / n), best=np.zeros(WRONG + 1),
    )  # fmt: skip
    assert file_hash(folder / "slip.toml") == walks_document()["slip"]
