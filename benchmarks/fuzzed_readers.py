# SPDX-License-Identifier: MIT
"""Every reader of a file that a user brings, with what makes inputs for it and its first check."""

import csv
import gzip
import io
import json
import tomllib
import zipfile
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import cv2
import h5py
import numpy as np
import PIL.Image
import pyarrow as pa
import pyarrow.parquet as pq

from benchmarks.hostile_inputs import (
    Make,
    archives,
    as_json,
    as_toml,
    documents,
    odd_value,
    pick,
    pool,
    tables,
)
from model.bayes.walk_prior import WRONG, WalkPrior
from model.slip.curve import SlipCurve
from model.slip.definition import SlipDefinition
from model.slip.laws import slip_law
from rig.device import Sample
from rig.imu.profile import load_imu_profile
from rig.profile import shipped_file
from rig.slip_rig.profile import load_rig_profile
from rig.zebro.profile import load_leg_profile
from tracking.images import exif_time, read_pixels, times_from_table, video_frames
from zebro_lab.calibration.checkpoint import load_checkpoint
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.calibration.slip_argument import Slip, parse_slip
from zebro_lab.calibration.slip_draws import POSTERIOR, law_draws
from zebro_lab.calibration.walks_folder import SCHEMA, describe_legs, read_walks_beside
from zebro_lab.exchange.import_columns import ForeignColumns
from zebro_lab.experiment.journal import JOURNAL_FILE, read_journal
from zebro_lab.experiment.plan_file import read_plan
from zebro_lab.files.errors import ZebroLabError
from zebro_lab.files.provenance import file_hash
from zebro_lab.mcap.cdr import CdrWriter
from zebro_lab.mcap.log_writer import LogWriter
from zebro_lab.mcap.message_log import MessageLog
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.mcap.ros_log import read_messages
from zebro_lab.mcap.ros_messages import Schema
from zebro_lab.mcap.slip_rig_log import SCHEMA_NAME, SCHEMA_TEXT, TOPIC, read_log
from zebro_lab.mcap.stream_views import LegsView
from zebro_lab.report.page import render_report
from zebro_lab.report.sources import find_sources
from zebro_lab.robot.imu_log import imu_of_table
from zebro_lab.robot.leg_log import ANGLES
from zebro_lab.robot.robot_file import RobotFile, read_robot_file, render_robot_file
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.runs.manifest import read_manifest
from zebro_lab.runs.stage import list_runs
from zebro_lab.tables.columns import read_columns
from zebro_lab.tables.table_files import read_table_file
from zebro_lab.track.annotations import read_annotations
from zebro_lab.track.camera_file import read_camera_file
from zebro_lab.track.file import read_track
from zebro_lab.track.floor_file import read_floor_file
from zebro_lab.track.folder import read_track_manifest
from zebro_lab.track.foreign import read_tum, track_of_foreign_table
from zebro_lab.track.photo_sequence import upright_size
from zebro_lab.walk.folder import read_walk_manifest
from zebro_lab.walk.path_band import DRAWS, read_draws

Take = Callable[[Path], object]
Check = Callable[[bytes], object]
HUNDRED_THOUSAND, TEN_THOUSAND = 100_000, 10_000
ROOT = Path(__file__).parents[1]


@dataclass(frozen=True)
class Reader:
    """A reader and its inputs.

    Attributes:
        file: Name of the file that is written for each input.
        read: Reads that file.
        make: Makes an input.
        check: Raises where an input fails the first check: it is no TOML, no zip archive …
        inputs: How many are read in a whole trial.
        prepare: Writes what lies beside the file, once.
        special: Makes inputs that are read first: bombs.
    """

    file: str
    read: Take
    make: Make
    check: Check
    inputs: int = HUNDRED_THOUSAND
    prepare: Callable[[Path], object] | None = None
    special: Callable[[], tuple[bytes, ...]] = tuple


def toml_check(data: bytes) -> object:
    """Parse TOML."""
    return tomllib.loads(data.decode("utf-8-sig"))


def json_check(data: bytes) -> object:
    """Parse JSON."""
    return json.loads(data)


def csv_check(data: bytes) -> None:
    """Take a text for a table: a header and a row of as many cells."""
    text = data.decode("utf-8-sig")
    rows = list(csv.reader(io.StringIO(text), delimiter=next(c for c in ",;\t|" if c in text)))
    if len(rows) < 2 or len(rows[0]) != len(rows[1]):
        raise ValueError("no table")


def zip_check(data: bytes) -> None:
    """Open an archive and read its members."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        if not archive.namelist() or archive.testzip():
            raise ValueError("damaged")


def hdf_check(data: bytes) -> None:
    """Open an HDF5 file."""
    h5py.File(io.BytesIO(data), "r").close()


def mcap_check(data: bytes) -> None:
    """Read the magic and the first record of a log."""
    from mcap.stream_reader import StreamReader

    next(StreamReader(io.BytesIO(data)).records)


def picture_check(data: bytes) -> None:
    """Identify a picture."""
    PIL.Image.open(io.BytesIO(data)).close()


def text_check(data: bytes) -> object:
    """Decode a text."""
    return data.decode("utf-8-sig")


DEEP_TOML = b"a = " + b"[" * 200_000
_BOMBS_TOML = (
    DEEP_TOML,
    b"a = " + b"[" * 5000 + b"]" * 5000,
    b".".join([b"a"] * 200_000) + b" = 1\n",
    (b"[" + b".".join([b"a"] * 30) + b"]\n") + b"b=1\n" * 1,
    b"".join(b"[a%d]\n" % k for k in range(90_000)),
    b"a = " + b"9" * 400_000,
    b'a = "' + b"\\n" * 500_000 + b'"',
    b"x" * (5 << 20),
    b"[[a]]\n" * 170_000,
    b"\xff\xfe" + b"a\0" * 1000,
    b"a = [" + b"{}," * 340_000 + b"]",
    b"a" * 600_000 + b" = 1\n" + b"." * 400_000,
)
_BOMBS_JSON = (
    b"[" * 300_000,
    b'{"a":' * 100_000 + b"1" + b"}" * 100_000,
    b'{"kind": ' + b"9" * 3_000_000 + b"}",
    b"[" + b"[]," * 2_700_000 + b"[]]",
    b'{"a": "' + b"x" * (20 << 20) + b'"}',
    b'{"schema_version": 1e400, "kind": "\\ud800"}',
)


def toml_bombs() -> tuple[bytes, ...]:
    """Return TOML that is deep, long or slow to parse."""
    return _BOMBS_TOML


def json_bombs() -> tuple[bytes, ...]:
    """Return JSON that is deep, long or large in memory."""
    return _BOMBS_JSON


def csv_bombs() -> tuple[bytes, ...]:
    """Return tables that unpack to much more than they are."""
    head = gzip.compress(b"a,b,c,d,e,f,g,h\n")  # members of an archive follow each other
    many = head + gzip.compress(b"1,2,3,4,5,6,7,8\n" * 65536) * 300
    line = head + gzip.compress(b"1," * (1 << 20)) * 300
    text = gzip.compress(b"a,b\n" + b"".join(b"%x,z\n" % k for k in range(500_000))) * 12
    quote = gzip.compress(b'a,b\n"') + gzip.compress(b"x\n" * (1 << 20)) * 150
    return many, line, text, quote


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
    plan = tomllib.loads((ROOT / "examples/plan-source.toml").read_text())
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
            "walks/walks.toml", lambda file: read_walks_beside(file.parent.parent / "slip.toml"),
            documents(as_toml, walks_document()), toml_check, prepare=_beside_walks,
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
    """Return what a walks.toml holds, for the slip.toml of `_beside_walks`."""
    import hashlib

    return {
        "schema": SCHEMA, "slip": hashlib.sha256(as_toml(slip_document())).hexdigest(),
        "likeliest_case": 0, "prior": asdict(WalkPrior()), "legs": describe_legs(RobotFile()),
        "walk": [{"name": "a", "misfit": 0.9, "leg_log": "0" * 64}],
    }  # fmt: skip


def _beside_walks(folder: Path) -> None:
    (folder / "slip.toml").write_bytes(as_toml(slip_document()))
    (folder / "walks/manifest.json").write_text("{}")
    n = 10
    np.savez(
        folder / "walks/draws.npz", values=np.zeros((n, WRONG + 1)), case=np.zeros(n, int),
        weight=np.full(n, 1 / n), best=np.zeros(WRONG + 1),
    )  # fmt: skip
    assert file_hash(folder / "slip.toml") == walks_document()["slip"]


RUN = {
    "schema_version": 1, "kind": "walk", "label": "x", "material": "x", "operator": "x",
    "source": "real", "start": "2026-01-01T00:00:00+00:00", "exit_status": "completed",
    "software": {"version": "1"}, "constants": {"radius_leg": 0.035}, "streams": {"/a/raw": 3},
    "stop": "2026-01-01T00:00:01+00:00", "log_sha256": "0" * 64, "robot": "x", "profiles": {},
    "sources": {"legs": "real"}, "counters": {"legs": {"lost": 1}}, "clocks": {"legs": {"a": 1.0}},
    "truth": {}, "inputs": {"a": "b"}, "excluded": {"why": "x"},
}  # fmt: skip


def _listed(file: Path) -> object:
    read_manifest(file.parent)
    return list_runs(file.parent)


def of_manifests() -> Mapping[str, Reader]:
    """Return readers of JSON."""
    manifest = {
        "schema": 1, "kind": "track", "source": "real", "settings": {}, "inputs": {"a": "b"},
        "outputs": {"a.png": "0"}, "software": {}, "notes": ["x"],
    }  # fmt: skip
    walk = manifest | {"kind": "predict"}
    events = [{"kind": "plan", "fingerprint": "a", "text": "x"},
              {"kind": "point", "number": 3, "accepted": True, "folder": "a"},
              {"kind": "end", "text": "emergency stop: x"}]  # fmt: skip

    def journal(rng: np.random.Generator) -> bytes:
        one = documents(as_json, *events)
        return b"\n".join([as_json(events[0]), *(one(rng) for _ in range(int(rng.integers(4))))])

    return {
        "run.json": Reader("run.json", _listed, documents(as_json, RUN), json_check,
                           special=json_bombs),
        "track's manifest": Reader("manifest.json", lambda f: read_track_manifest(f.parent),
                                   documents(as_json, manifest), json_check, special=json_bombs),
        "walk's manifest": Reader("manifest.json", lambda f: read_walk_manifest(f.parent),
                                  documents(as_json, walk), json_check, special=json_bombs),
        "journal": Reader(JOURNAL_FILE, lambda f: read_journal(f.parent), journal, text_check),
    }  # fmt: skip


def of_reports() -> Mapping[str, Reader]:
    """Return readers of what a report shows."""
    row = {"ate_m": 0.01, "coverage90_x": 0.9, "nees": 1.0}
    validation = {
        "schema": 1, "kind": "validation", "source": "sim:x", "settings": {}, "inputs": {"a": "b"},
        "outputs": {"a.png": "0"}, "software": {"numpy": "2"}, "notes": ["x"],
        "runs": {"a": {"prediction": row, "stand still": row}}, "imu": {"a": {"roll_bias_deg": 1}},
    }  # fmt: skip

    def render(folder: Path) -> object:
        sources = find_sources(folder / "run", calibration=folder / "calibration")
        return render_report(sources, title="x", made=datetime(2026, 1, 1, tzinfo=UTC))

    def prepare(folder: Path) -> None:
        for name, content in (
            ("run/run.json", RUN),
            ("run/validation/manifest.json", validation),
            ("calibration/manifest.json", validation | {"kind": "calibration"}),
        ):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_bytes(as_json(content))
        (folder / "calibration/slip.toml").write_bytes(as_toml(reported))
        (folder / "calibration/summary.csv").write_text("parameter,prior\nfriction,x\n")

    reported = slip_document() | {
        "verdict": {"headline": "x", "next_steps": ["y"]},
        "parameters": {"friction": {"symbol": "x", "unit": "-", "median": 1.0}},
        "tested": {"normal_force": [1, 2], "slip_ratio": [0, 1], "runs": 3, "samples": 4},
    }
    summary = {"parameter": ["friction", "a"], "prior": ["x", "y"], "r_hat": [1.0, 2.0]}
    return {
        "report: validation": Reader("run/validation/manifest.json",
                                     lambda f: render(f.parents[2]),
                                     documents(as_json, validation), json_check, prepare=prepare),
        "report: slip.toml": Reader("calibration/slip.toml", lambda f: render(f.parents[1]),
                                    documents(as_toml, reported), toml_check, prepare=prepare),
        "report: summary.csv": Reader("calibration/summary.csv", lambda f: render(f.parents[1]),
                                      tables(summary), csv_check, prepare=prepare),
    }  # fmt: skip


def _numbers(file: Path) -> None:
    table = read_table_file(file)
    for name in table.columns:
        with suppress(ZebroLabError):
            table.numbers(name)


def _foreign_track(file: Path) -> object:
    columns = ForeignColumns().series("track")
    return track_of_foreign_table(read_tum(file), columns, zero=0.0)


def of_tables() -> Mapping[str, Reader]:
    """Return readers of tables."""
    t = np.round(np.arange(25) * 0.01, 3)
    rig = {"t": t, "slip_ratio": np.linspace(0, 0.3, 25).round(3), "normal_force": [5.0] * 25,
           "traction_force": np.linspace(0, 2, 25).round(3), "slip_definition": ["material"] * 25,
           "run": ["a"] * 25}  # fmt: skip
    legs = {"t": t, **{name: (t * 3).round(4) for name in ANGLES}}
    track = {"t_s": t, "x_m": t * 2, "y_m": t * 0, "yaw_rad": t}
    imu = {"t": t, "roll": t, "pitch": t, "yaw": t, "rate_x": t}
    imu_map = ForeignColumns().series("imu")
    readers: dict[str, Reader] = {
        "CSV, every column": Reader("x.csv", _numbers, tables(rig), csv_check),
        "CSV of a rig": Reader("x.csv", lambda f: read_rig_data([f]), tables(rig), csv_check),
        "CSV of legs": Reader("x.csv", read_leg_log, tables(legs), csv_check),
        "CSV of a track": Reader("x.csv", read_track, tables(track), csv_check),
        "CSV of an IMU": Reader("x.csv", lambda f: imu_of_table(read_table_file(f), imu_map),
                                tables(imu), csv_check),
        "CSV.gz": Reader("x.csv.gz", _numbers, tables(rig, packed=True),
                         lambda d: csv_check(gzip.decompress(d)), special=csv_bombs),
        "Parquet": Reader("x.parquet", _numbers, parquets(), _parquet_check),
        "TUM": Reader("x.tum", _foreign_track, _tum, text_check),
        "times of photographs": Reader("x.csv", lambda f: times_from_table(f, [Path("a.jpg")]),
                                       tables({"photo": ["a.jpg", "b.jpg"], "t_s": [0, 1]}),
                                       csv_check),
    }  # fmt: skip
    return readers


def _tum(rng: np.random.Generator) -> bytes:
    lines = [f"{k} 0 0 0 0 0 0 1".split() for k in range(6)]
    for _ in range(int(rng.integers(0, 3))):
        line = pick(rng, lines)
        line[int(rng.integers(len(line)))] = str(odd_value(rng, 3))
    return "\n".join(map(" ".join, lines)).encode(errors="replace")


def _parquet_check(data: bytes) -> object:
    return pq.read_metadata(io.BytesIO(data))


def parquets() -> Make:
    """Make Parquet files of columns of any type."""
    rng = np.random.default_rng(5)
    kinds: list[Callable[[], Any]] = [
        lambda: pa.array(rng.normal(size=20)),
        lambda: pa.array(rng.integers(0, 9, 20)),
        lambda: pa.array([pick(rng, ("a", None, "1,5", "\x1b")) for _ in range(20)]),
        lambda: pa.array([{"x": 1, "y": [1]}] * 20),
        lambda: pa.array([[1, 2], None] * 10),
        lambda: pa.array([b"\xff"] * 20),
        lambda: pa.array([datetime(2026, 1, 1, tzinfo=UTC)] * 20),
        lambda: pa.array([None] * 20),
        lambda: pa.array([True, None] * 10),
        lambda: pa.array(["a", "b"] * 10).dictionary_encode(),
        lambda: pa.array([1, 2] * 10, pa.decimal128(30, 3)),
        lambda: pa.array([1, 2] * 10, pa.duration("ns")),
        lambda: pa.array([1, 2] * 10, pa.date32()),
        lambda: pa.array(rng.normal(size=20).astype(np.float16)),
        lambda: pa.array([[("k", 1)]] * 20, pa.map_(pa.string(), pa.int64())),
    ]
    made = []
    for _ in range(400):
        names = [pick(rng, ("t", "run", "slip_ratio", "a\nb", "", "normal_force", "t")) + str(k)
                 for k in range(int(rng.integers(1, 6)))]  # fmt: skip
        table = pa.table([pick(rng, kinds)() for _ in names], names)
        table = table.replace_schema_metadata({"source": pick(rng, (b"real", b"\xff", b"a\nb"))})
        out = io.BytesIO()
        pq.write_table(table, out, compression=pick(rng, ("none", "snappy", "zstd", "gzip")))
        made.append(out.getvalue())
    return pool(made, 0.6)


def of_archives() -> Mapping[str, Reader]:
    """Return readers of arrays."""
    band = {"t": np.arange(5.0), "poses": np.zeros((3, 5, 3), np.float32)}
    chains = {
        "fingerprint": np.array("x"), "z": np.zeros((2, 4, 3)), "log_density": np.zeros((2, 4)),
        "accepted": np.zeros(2), "thin": np.array(1), "random_keys": np.zeros((1, 624), np.uint32),
        "random_positions": np.zeros(1, int),
    }  # fmt: skip
    walks = {"values": np.zeros((10, WRONG + 1)), "case": np.zeros(10, int),
             "weight": np.full(10, 0.1), "best": np.zeros(WRONG + 1)}  # fmt: skip

    def beside(folder: Path) -> None:
        _beside_walks(folder)
        (folder / "walks/walks.toml").write_bytes(as_toml(walks_document()))

    return {
        "draws.npz": Reader(DRAWS, lambda f: read_draws(f.parent), archives(band), zip_check,
                            special=lambda: (_zeros(), b"", b"PK\x03\x04")),
        "checkpoint.npz": Reader("checkpoint.npz",
                                 lambda f: load_checkpoint(f.parent, fingerprint="x"),
                                 archives(chains), zip_check, special=lambda: (_zeros(),)),
        "draws.npz of walks": Reader("walks/draws.npz",
                                     lambda f: read_walks_beside(f.parents[1] / "slip.toml"),
                                     archives(walks), zip_check, prepare=beside),
        "posterior.nc": Reader(POSTERIOR, _posterior, pool(_posteriors(), 0.8), hdf_check),
    }  # fmt: skip


def _zeros() -> bytes:
    out = io.BytesIO()
    np.savez_compressed(out, t=np.zeros(600_000), poses=np.zeros((20, 600_000, 3)))
    return out.getvalue()


def _posterior(file: Path) -> object:
    curve = SlipCurve(
        law=slip_law("brush"), values=np.array([5.0, 0.4]), covariance=np.eye(2) * 1e-3,
        definition=SlipDefinition.MATERIAL, load_range=(1.0, 2.0), slip_range=(0.0, 1.0),
    )  # fmt: skip
    slip = Slip("x", curve, "real", (file.parent / "slip.toml",))
    return law_draws(slip, curve, 10, rng=np.random.default_rng(1))


def _posteriors() -> list[bytes]:
    rng = np.random.default_rng(3)
    values: list[Callable[[], Any]] = [
        lambda: {"data": np.zeros((2, 9))}, lambda: {"data": np.zeros(int(rng.integers(0, 9)))},
        lambda: {"data": np.array([b"a"])}, lambda: {"data": np.zeros(3, [("a", "f8")])},
        lambda: {"shape": (1 << 40,), "dtype": "f8", "chunks": (1 << 10,)},
        lambda: {"data": 3.0}, lambda: {"data": h5py.Empty("f8")},
        lambda: {"shape": (9,), "dtype": "f8", "external": [("/etc/passwd", 0, 72)]},
        lambda: {"data": np.zeros((2, 9)), "compression": "gzip"},
    ]  # fmt: skip
    made = []
    for _ in range(200):
        out = io.BytesIO()
        with h5py.File(out, "w") as file:
            group = file.create_group(pick(rng, ("posterior",) * 9 + ("other",)))
            group.create_dataset("friction", **pick(rng, values)())
            group.create_dataset("slip_stiffness", **pick(rng, values[:2])())
            if rng.random() < 0.1:
                file["x"] = h5py.ExternalLink("/etc/passwd", "/")
        made.append(out.getvalue())
    return made


def of_logs() -> Mapping[str, Reader]:
    """Return readers of MCAP."""
    recorded, rig = _recorded(), io.BytesIO()
    t = np.arange(200) / 100
    earlier, message = MessageLog(rig), CdrWriter()
    earlier.register(TOPIC, Schema(SCHEMA_NAME, SCHEMA_TEXT))
    for _ in range(5):
        message.array(t)
    earlier.add(TOPIC, 10**18, message.message())
    earlier.finish()
    log = "rcl_interfaces/msg/Log"
    raw, samples = _logs([recorded]), _logs([rig.getvalue()])
    return {
        "log.mcap, raw": Reader("log.mcap", read_raw_log, raw, mcap_check),
        "log.mcap, rig": Reader("log.mcap", read_log, samples, mcap_check),
        "log.mcap, ROS 2": Reader("log.mcap", lambda f: read_messages(f, schema=log), raw,
                                  mcap_check),
    }  # fmt: skip


def _recorded() -> bytes:
    profile, out = load_leg_profile("zebro-100-serial"), io.BytesIO()
    writer = LogWriter(
        out, views={"legs": LegsView("legs", profile=profile)},
        attachments={"profiles/legs.toml": "x = 1"}, start=0.0, start_ns=10**18,
    )  # fmt: skip
    writer.event(0.0, "began")
    samples = [Sample(0.01 * n, 0.01 * n, n, tuple(range(n, n + 6))) for n in range(60)]
    for first in range(0, 60, 20):
        writer.write("legs", samples[first : first + 20])
        writer.flush()
    writer.finish()
    return out.getvalue()


def _logs(made: list[bytes]) -> Make:
    """Make logs whose records, inside chunks too, were changed, with sums that are right."""
    from mcap.records import Chunk
    from mcap.stream_reader import StreamReader, get_chunk_data_stream

    magic = b"\x89MCAP0\r\n"
    parsed = [list(StreamReader(io.BytesIO(data), emit_chunks=True).records) for data in made]
    inner = [
        get_chunk_data_stream(record)[0]._stream.getvalue()  # pyright: ignore[reportAttributeAccessIssue]
        for records in parsed for record in records if isinstance(record, Chunk)
    ]  # fmt: skip
    whole = pool(made)

    def make(rng: np.random.Generator) -> bytes:
        if rng.random() < 0.4:
            return whole(rng)
        parts = [magic]
        for data in inner:
            body = pool([data], 0.7)(rng)
            size = pick(rng, (len(body),) * 8 + (0, 1 << 40))
            chunk = bytes(16) + size.to_bytes(8, "little") + bytes(4) + (0).to_bytes(4, "little")
            chunk += len(body).to_bytes(8, "little") + body
            parts.append(b"\x06" + len(chunk).to_bytes(8, "little") + chunk)
        return b"".join(parts)

    return make


def of_pictures() -> Mapping[str, Reader]:
    """Return readers of photographs and videos."""

    def seen(file: Path) -> None:
        upright_size(file)
        exif_time(file)
        read_pixels(file)

    make = pool(_pictures(), 0.85)
    return {
        "photographs": Reader("a.jpg", seen, make, picture_check, TEN_THOUSAND),
        "videos": Reader("a.mp4", lambda f: sum(1 for _ in video_frames(f)),
                         pool(_videos(), 0.85), lambda d: d[4:8] == b"ftyp" or d.index(b"RIFF"),
                         TEN_THOUSAND),
    }  # fmt: skip


def _pictures() -> list[bytes]:
    rng = np.random.default_rng(4)
    made = []
    for kind in ("JPEG", "PNG", "TIFF", "BMP", "WEBP", "GIF", "PPM", "EPS"):
        for mode in ("RGB", "L", "P", "CMYK", "RGBA", "I;16"):
            picture = PIL.Image.fromarray(rng.integers(0, 255, (40, 50, 3), dtype=np.uint8))
            exif = PIL.Image.Exif()
            exif[0x0132], exif[0x0112] = "2026:01:01 12:00:00", int(rng.integers(0, 10))
            exif.get_ifd(0x8769)[0x9003] = "2026:01:01 12:00:00"
            out = io.BytesIO()
            with suppress(OSError, ValueError, KeyError):
                picture.convert(mode).save(out, kind, exif=exif)
                made.append(out.getvalue())
    return made


def _videos() -> list[bytes]:
    import tempfile

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


def readers() -> Mapping[str, Reader]:
    """Return all, those first that take the least time."""
    return {
        **of_settings(), **of_manifests(), **of_archives(), **of_logs(), **of_tables(),
        **of_reports(), **of_pictures(),
    }  # fmt: skip
