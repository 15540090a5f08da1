# SPDX-License-Identifier: MIT
"""Readers of tables."""

import gzip
import io
from collections.abc import Callable, Mapping
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from benchmarks.faults.fuzzed_readers.bombs import csv_bombs
from benchmarks.faults.fuzzed_readers.reader import Reader, csv_check, text_check
from benchmarks.faults.hostile_inputs import (
    Make,
    odd_value,
    pick,
    pool,
    tables,
)
from tracking.images import times_from_table
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.exchange.import_columns import ForeignColumns
from zebro_lab.files.errors import ZebroLabError
from zebro_lab.robot.imu_log import imu_of_table
from zebro_lab.robot.leg_log import ANGLES
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.tables.table_files import read_table_file
from zebro_lab.track.file import read_track
from zebro_lab.track.foreign import read_foreign_track
from zebro_lab.track.trajectory.request import TrajectoryRequest


def every_column(file: Path) -> None:
    """Read every column of a table as numbers, where they are."""
    table = read_table_file(file)
    for name in table.columns:
        with suppress(ZebroLabError):
            table.numbers(name)


def _foreign_track(file: Path) -> object:
    columns = ForeignColumns().series("track")
    return read_foreign_track(file, columns, TrajectoryRequest())


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
        "CSV, every column": Reader("x.csv", every_column, tables(rig), csv_check),
        "CSV of a rig": Reader("x.csv", lambda f: read_rig_data([f]), tables(rig), csv_check),
        "CSV of legs": Reader("x.csv", read_leg_log, tables(legs), csv_check),
        "CSV of a track": Reader("x.csv", read_track, tables(track), csv_check),
        "CSV of an IMU": Reader("x.csv", lambda f: imu_of_table(read_table_file(f), imu_map),
                                tables(imu), csv_check),
        "CSV.gz": Reader("x.csv.gz", every_column, tables(rig, packed=True),
                         lambda d: csv_check(gzip.decompress(d)), special=csv_bombs),
        "Parquet": Reader("x.parquet", every_column, parquets(), _parquet_check),
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
