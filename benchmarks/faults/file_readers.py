# SPDX-License-Identifier: MIT
"""Every reader of a file that a user brings, with valid files for it."""

import gzip
import hashlib
import io
import json
import tempfile
import tomllib
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import cv2
import h5py
import numpy as np
import pandas as pd
import PIL.Image
import tomlkit
from openpyxl import Workbook

from benchmarks.faults.device_parsers import Parser, Take
from model.errors import ModelError
from model.slip.curve import SlipCurve
from model.slip.definition import SlipDefinition
from model.slip.laws import slip_law
from model.walk_fit.prior import WRONG, WalkPrior
from rig.device import Sample
from rig.errors import RigError
from rig.imu.profile import load_imu_profile
from rig.profile import shipped_file
from rig.slip_rig.profile import load_rig_profile
from rig.zebro.profile import load_leg_profile
from tracking.errors import TrackingError
from tracking.images import exif_time, read_pixels, times_from_table, video_frames
from zebro_lab.calibration.checkpoint import load_checkpoint
from zebro_lab.calibration.folder import POSTERIOR
from zebro_lab.calibration.posterior_file import law_draws
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.calibration.slip_argument import NamedSlip, parse_slip
from zebro_lab.calibration.walks_folder import SCHEMA, describe_legs, read_stored_walks
from zebro_lab.experiment.journal import JOURNAL_FILE, read_journal
from zebro_lab.experiment.plan_stage import read_plan
from zebro_lab.files.errors import ZebroLabError
from zebro_lab.mcap.log_writer import LogWriter
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.report.page import render_report
from zebro_lab.report.sources import find_sources
from zebro_lab.robot.leg_log import ANGLES
from zebro_lab.robot.robot_file import RobotFile, read_robot_file, render_robot_file
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.runs.manifest import read_manifest
from zebro_lab.runs.profile_streams import legs_stream
from zebro_lab.runs.stage import list_runs
from zebro_lab.tables.columns_file import read_columns
from zebro_lab.tables.table_files import read_table_file
from zebro_lab.track.annotations import read_annotations
from zebro_lab.track.camera_file import read_camera_file
from zebro_lab.track.file import read_track
from zebro_lab.track.floor_file import read_floor_file
from zebro_lab.track.folder import read_track_manifest
from zebro_lab.track.trajectory.file import read_trajectory
from zebro_lab.track.trajectory.request import TrajectoryRequest
from zebro_lab.walk.folder import DRAWS, read_draws

ROOT = Path(__file__).parents[2]
MADE = datetime(2026, 1, 1, tzinfo=UTC)
DOCUMENTED = (ZebroLabError, RigError, TrackingError, ModelError)
DEEP_TOML, DEEP_JSON = b"a = " + b"[" * 200_000, b"[" * 300_000
LARGE_TOML = b"x = 1 # " + b"x" * (5 << 20)
Document = dict[str, Any]

RUN = {
    "schema_version": 1, "kind": "walk", "label": "x", "material": "x", "operator": "x",
    "source": "real", "start": "2026-01-01T00:00:00+00:00", "exit_status": "completed",
    "software": {"version": "1"}, "constants": {"radius_leg": 0.035}, "streams": {"/a/raw": 3},
    "stop": "2026-01-01T00:00:01+00:00", "log_sha256": "0" * 64, "robot": "x", "profiles": {},
    "sources": {"legs": "real"}, "counters": {"legs": {"lost": 1}}, "clocks": {"legs": {"a": 1.0}},
    "truth": {}, "inputs": {"a": "b"}, "excluded": {"why": "x"},
}  # fmt: skip
MANIFEST = {
    "schema": 1, "kind": "track", "source": "real", "settings": {}, "inputs": {"a": "b"},
    "outputs": {"a.png": "0"}, "software": {}, "notes": ["x"],
}  # fmt: skip
SLIP = {
    "schema": 1, "source": "real", "slip_definition": "material", "law": {"name": "brush"},
    "tested": {"normal_force": [1.0, 2.0], "slip_ratio": [0.0, 1.0], "runs": 3, "samples": 4},
    "parameters": {"slip_stiffness": {"mean": 5.0}, "friction": {"mean": 0.4}},
    "covariance": {"matrix": [[0.01, 0.0], [0.0, 0.01]]},
    "verdict": {"headline": "fine", "trustworthy": True, "next_steps": ["x"]},
}  # fmt: skip


def of(
    read: Callable[[Path], object],
    file: str,
    valid: Sequence[bytes],
    *,
    special: Sequence[bytes] = (),
    beside: Mapping[str, bytes] | None = None,
) -> Parser:
    """Return a parser whose inputs are written to a file of the working folder and read.

    Args:
        read: Reads the file.
        file: Its place, which decides its format.
        valid: Valid files.
        special: Files that are read first.
        beside: Other files that the reader finds, by their places.
    """

    def make() -> Take:
        for name, data in {**(beside or {}), file: b""}.items():
            Path(name).parent.mkdir(parents=True, exist_ok=True)
            Path(name).write_bytes(data)

        def take(data: bytes) -> bool:
            Path(file).write_bytes(data)
            read(Path(file).absolute())
            return True

        return take

    return Parser(make, list(valid), DOCUMENTED, special=tuple(special))


def as_toml(document: Document) -> bytes:
    """Spell a document as TOML."""
    return tomlkit.dumps(document).encode()


def as_json(document: Document) -> bytes:
    """Spell a document as JSON."""
    return json.dumps(document).encode()


def as_npz(**arrays: Any) -> bytes:
    """Spell arrays as an archive of NumPy."""
    out = io.BytesIO()
    np.savez(out, **arrays)
    return out.getvalue()


def as_csv(columns: Mapping[str, Any], separator: str = ",") -> bytes:
    """Spell columns as a table."""
    return pd.DataFrame(columns).to_csv(index=False, sep=separator).encode()


def of_settings() -> dict[str, Parser]:
    """Return readers of TOML."""
    walk = {path.stem: path.read_bytes() for path in (ROOT / "datasets/walk-sim").glob("*.toml")}
    marker = {"position": [0, 0, 0.04], "id": 3, "height": "10 cm", "side": 0.03}
    robot = as_toml(tomllib.loads(render_robot_file(RobotFile())) | {"marker": marker})
    columns = {
        "source": "real", "constants": {"radius_leg": "35 mm"}, "runs": {"by": ["a"]},
        "columns": {"t": {"name": "T", "unit": "ms"}, "slip_ratio": {"definition": "material"}},
        "rows": {"keep": ["slip > 0.1"]}, "load_cell": {"gain_sd": 0.01},
    }  # fmt: skip
    annotations = {
        "template": {"photo": "a.jpg", "corners_px": [[1, 2], [3, 4], [5, 6], [7, 8]],
                     "length": 0.2, "width": 0.1, "height": 0.1},
        "clicks": {"a.jpg": {"A": [1.0, 2.0]}},
        "correction": [{"kind": "delete", "photo": "a.jpg"}],
    }  # fmt: skip
    named: dict[str, tuple[Callable[[Path], object], list[bytes]]] = {
        "robot.toml": (read_robot_file, [robot, walk["robot"]]),
        "columns.toml": (read_columns, [as_toml(columns)]),
        "camera.toml": (read_camera_file, [walk["camera"]]),
        "floor.toml": (read_floor_file, [walk["floor"]]),
        "annotations.toml": (read_annotations, [as_toml(annotations)]),
        "plan.toml": (read_plan, [(ROOT / "examples/plan-thesis.toml").read_bytes()]),
        "slip.toml": (lambda file: parse_slip(str(file)), [as_toml(SLIP)]),
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
        name: of(read, "x.toml", valid, special=(DEEP_TOML, LARGE_TOML))
        for name, (read, valid) in named.items()
    }


def profiles(*names: str) -> list[bytes]:
    """Return shipped profiles."""
    return [shipped_file(f"{name}.toml").read_bytes() for name in names]


def of_results() -> dict[str, Parser]:
    """Return readers of what commands write."""
    events = [{"kind": "plan", "fingerprint": "a", "text": "x"},
              {"kind": "point", "number": 3, "accepted": True, "folder": "a"},
              {"kind": "end", "text": "emergency stop: x"}]  # fmt: skip
    journal = b"\n".join(map(as_json, events))
    chains = as_npz(
        fingerprint=np.array("x"), z=np.zeros((2, 4, 3)), log_density=np.zeros((2, 4)),
        accepted=np.zeros(2), thin=np.array(1), random_keys=np.zeros((1, 624), np.uint32),
        random_positions=np.zeros(1, int),
    )  # fmt: skip
    band = as_npz(t=np.arange(5.0), poses=np.zeros((3, 5, 3), np.float32))
    slip, n = as_toml(SLIP), 10
    shown = {"friction": {"symbol": "x", "unit": "-", "median": 1.0}}
    walks = as_toml({
        "schema": SCHEMA, "slip": hashlib.sha256(slip).hexdigest(), "likeliest_case": 0,
        "prior": asdict(WalkPrior()), "legs": describe_legs(RobotFile()),
        "walk": [{"name": "a", "misfit": 0.9, "leg_log": "0" * 64}],
    })  # fmt: skip
    draws = as_npz(values=np.zeros((n, WRONG + 1)), case=np.zeros(n, int), weight=np.full(n, 1 / n),
                   best=np.zeros(WRONG + 1))  # fmt: skip
    walks_beside = {"slip.toml": slip, "walks/manifest.json": b"{}", "walks/walks.toml": walks,
                    "walks/draws.npz": draws}  # fmt: skip

    def stored_walks(file: Path) -> object:
        return read_stored_walks(file.parents[1] / "slip.toml")

    return {
        "run.json": of(listed, "run/run.json", [as_json(RUN)], special=[DEEP_JSON]),
        "track's manifest": of(lambda file: read_track_manifest(file.parent), "manifest.json",
                               [as_json(MANIFEST)], special=[DEEP_JSON]),
        "journal": of(lambda file: read_journal(file.parent), JOURNAL_FILE, [journal]),
        "walks.toml": of(stored_walks, "walks/walks.toml", [walks], beside=walks_beside),
        "draws.npz of walks": of(stored_walks, "walks/draws.npz", [draws], beside=walks_beside),
        "draws.npz": of(lambda file: read_draws(file.parent), DRAWS, [band]),
        "checkpoint.npz": of(lambda file: load_checkpoint(file.parent, fingerprint="x"),
                             "checkpoint.npz", [chains]),
        "posterior.nc": of(posterior_draws, POSTERIOR, [posterior(x) for x in ODD_DATASETS]),
        "log.mcap": of(read_raw_log, "log.mcap", [recorded()]),
        **of_reports(as_toml(SLIP | {"parameters": shown})),
    }  # fmt: skip


def listed(file: Path) -> object:
    """List the runs of a folder, damaged ones too, and read the manifest of one."""
    return list_runs(file.parents[1]), read_manifest(file.parent)


def of_reports(slip: bytes) -> dict[str, Parser]:
    """Return readers of what a report shows."""
    row = {"ate_m": 0.01, "coverage90_x": 0.9, "nees": 1.0}
    validation = as_json(MANIFEST | {"kind": "validation", "runs": {"a": {"prediction": row}}})
    summary = b"parameter,prior,r_hat\nfriction,x,1.0\n"
    beside = {"run/run.json": as_json(RUN), "run/validation/manifest.json": validation,
              "calibration/manifest.json": as_json(MANIFEST | {"kind": "calibration"}),
              "calibration/slip.toml": slip, "calibration/summary.csv": summary}  # fmt: skip

    def render(_: Path) -> object:
        sources = find_sources(Path("run"), calibration=Path("calibration"))
        return render_report(sources, title="x", made=MADE)

    return {
        f"report: {Path(name).name}": of(render, name, [beside[name]], beside=beside)
        for name in (
            "run/validation/manifest.json", "calibration/slip.toml", "calibration/summary.csv"
        )
    }  # fmt: skip


ODD_DATASETS: tuple[Document, ...] = (
    {"data": np.zeros((2, 9))}, {"data": np.zeros(3)}, {"data": np.array([b"a"])}, {"data": 3.0},
    {"data": np.zeros(3, [("a", "f8")])}, {"data": h5py.Empty("f8")},
    {"shape": (1 << 40,), "dtype": "f8", "chunks": (1 << 10,)},
    {"shape": (9,), "dtype": "f8", "external": [("/etc/passwd", 0, 72)]},
)  # fmt: skip


def posterior(friction: Document) -> bytes:
    """Write the draws of a calibration, of which one parameter is as given."""
    out = io.BytesIO()
    with h5py.File(out, "w") as file:
        group = file.create_group("posterior")
        group.create_dataset("friction", **friction)
        group.create_dataset("slip_stiffness", data=np.zeros((2, 9)))
    return out.getvalue()


def posterior_draws(file: Path) -> object:
    """Read the draws of a calibration."""
    curve = SlipCurve(
        law=slip_law("brush"), values=np.array([5.0, 0.4]), covariance=np.eye(2) * 1e-3,
        definition=SlipDefinition.MATERIAL, load_range=(1.0, 2.0), slip_range=(0.0, 1.0),
    )  # fmt: skip
    slip = NamedSlip(curve, "real", "x", (file.parent / "slip.toml",))
    return law_draws(slip, curve, 10, rng=np.random.default_rng(1))


def recorded() -> bytes:
    """Record a log of legs."""
    out, streams = io.BytesIO(), {"legs": legs_stream(load_leg_profile("zebro-100-serial"))}
    writer = LogWriter(out, streams=streams, attachments={"profiles/legs.toml": "x = 1"},
                       start=0.0, start_ns=10**18)  # fmt: skip
    writer.event(0.0, "began")
    writer.write("legs", [Sample(0.01 * n, 0.01 * n, n, tuple(range(n, n + 6))) for n in range(60)])
    writer.finish()
    return out.getvalue()


def of_tables() -> dict[str, Parser]:
    """Return readers of tables and trajectories."""
    t = np.round(np.arange(25) * 0.01, 3)
    columns = {"t": t, "slip_ratio": t, "normal_force": 5.0 + t, "traction_force": t,
               "slip_definition": ["material"] * 25, "run": ["a"] * 25}  # fmt: skip
    rig = [as_csv(columns, separator) for separator in (",", ";", "\t")]
    angles = {"t": t, **{name: (t * 3).round(4) for name in ANGLES}}
    legs, track = as_csv(angles), as_csv({"t_s": t, "x_m": t * 2, "y_m": t * 0, "yaw_rad": t})
    tum, kitti = (
        "".join(row.format(0.1 * k) for k in range(12)).encode()
        for row in ("{0:.4f} {0:.3f} 0 0 0 0 0 1\n", "1 0 0 {0:.3f} 0 1 0 0 0 0 1 0\n")
    )
    euroc = b"#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y []"
    poses = (b"%d,%d,0,0,1,0,0,0\n" % (10**18 + 10**7 * k, k) for k in range(9))
    euroc += b",q_RS_z []\n" + b"".join(poses)
    out = io.BytesIO()
    pd.DataFrame(columns).to_parquet(out)
    zipped = [gzip.compress(each) for each in rig]
    many = gzip.compress(b"a,b,c\n") + gzip.compress(b"1,2,3\n" * (1 << 20)) * 100
    return {
        "CSV, every column": of(every_column, "x.csv", rig),
        "CSV of a rig": of(lambda file: read_rig_data([file]), "x.csv", rig),
        "CSV of legs": of(read_leg_log, "x.csv", [legs]),
        "CSV of a track": of(read_track, "x.csv", [track]),
        "CSV.gz": of(every_column, "x.csv.gz", zipped, special=[many]),
        "Parquet": of(every_column, "x.parquet", [out.getvalue()]),
        "workbook of legs": of(read_leg_log, "x.xlsx", [workbook(angles)]),
        "trajectory": of(trajectory, "x.txt", [tum, kitti]),
        "trajectory: EuRoC": of(trajectory, "x.csv", [euroc]),
        "times of photographs": of(lambda file: times_from_table(file, [Path("a.jpg")]), "x.csv",
                                   [b"photo,t_s\na.jpg,0\nb.jpg,1\n"]),
    }  # fmt: skip


def every_column(file: Path) -> None:
    """Read every column of a table as numbers, where they are."""
    table = read_table_file(file)
    for name in table.columns:
        with suppress(ZebroLabError):
            table.numbers(name)


def trajectory(file: Path) -> object:
    """Read a trajectory of another program."""
    return read_trajectory(file, TrajectoryRequest())


def workbook(columns: Mapping[str, Any]) -> bytes:
    """Write columns as a workbook."""
    book = Workbook()
    sheet = book.active
    assert sheet is not None
    sheet.append(list(columns))
    for row in zip(*columns.values(), strict=True):
        sheet.append([float(value) for value in row])
    out = io.BytesIO()
    book.save(out)
    return out.getvalue()


def of_pictures() -> dict[str, Parser]:
    """Return readers of photographs and videos."""

    def seen(file: Path) -> None:
        exif_time(file)
        read_pixels(file)

    return {
        "photographs": of(seen, "a.jpg", pictures()),
        "videos": of(lambda file: sum(1 for _ in video_frames(file)), "a.mp4", videos()),
    }


def pictures() -> list[bytes]:
    """Draw small pictures of several formats."""
    rng, made = np.random.default_rng(4), []
    for kind in ("JPEG", "PNG", "TIFF", "BMP", "WEBP", "GIF", "EPS"):
        for mode in ("RGB", "L", "CMYK", "RGBA", "I;16"):
            picture = PIL.Image.fromarray(rng.integers(0, 255, (40, 50, 3), dtype=np.uint8))
            exif = PIL.Image.Exif()
            exif[0x0132], exif[0x0112] = "2026:01:01 12:00:00", int(rng.integers(0, 10))
            out = io.BytesIO()
            with suppress(OSError, ValueError, KeyError):
                picture.convert(mode).save(out, kind, exif=exif)
                made.append(out.getvalue())
    return made


def videos() -> list[bytes]:
    """Draw videos of four small frames."""
    made = []
    with tempfile.TemporaryDirectory() as folder:
        for name, code in (("a.avi", "MJPG"), ("a.mp4", "mp4v")):
            file = Path(folder) / name
            writer = cv2.VideoWriter(str(file), cv2.VideoWriter.fourcc(*code), 10.0, (64, 48))
            for k in range(4):
                writer.write(np.full((48, 64, 3), 20 * k, np.uint8))
            writer.release()
            made.append(file.read_bytes())
    return made


def readers() -> dict[str, Parser]:
    """Return every reader by name."""
    return of_settings() | of_results() | of_tables() | of_pictures()
