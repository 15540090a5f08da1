# SPDX-License-Identifier: MIT
"""Whatever stands in a table, archive or log of a user, a reader ends with one line, and soon."""

import gzip
import io
import os
import subprocess
import sys
import threading
import zipfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from mcap.writer import CompressionType, Writer

from model.slip.curve import SlipCurve
from model.slip.definition import SlipDefinition
from model.slip.laws import slip_law
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.calibration.slip_argument import NamedSlip
from zebro_lab.calibration.slip_draws import POSTERIOR, law_draws
from zebro_lab.files.errors import DataError, ZebroLabError
from zebro_lab.mcap.raw_log import COUNTS_NAME, read_raw_log
from zebro_lab.mcap.slip_rig_log import SCHEMA_NAME, TOPIC, read_log
from zebro_lab.tables.table_files import read_table_file
from zebro_lab.track.foreign import read_tum
from zebro_lab.walk.path_band import DRAWS, read_draws

MEGABYTE = 1 << 20


def one_line(reader: Callable[[Path], object], file: Path, *, grown: int = 300) -> str:
    """Read a file that cannot be read; return the line that says so, in `grown` MB of memory."""
    before = forget_peak()
    with pytest.raises(ZebroLabError) as raised:
        reader(file)
    assert "\n" not in str(raised.value)
    assert len(str(raised.value)) < 2000
    assert peak() - before < 1024 * grown
    return str(raised.value)


def peak() -> int:
    """Return the largest memory this process has had since `forget_peak` [kB]; Linux alone."""
    status = Path("/proc/self/status").read_text()
    return int(status.partition("VmHWM:")[2].split()[0])


def forget_peak() -> int:
    Path("/proc/self/clear_refs").write_text("5")
    return peak()


def numbers(name: str) -> Callable[[Path], object]:
    return lambda file: read_table_file(file).numbers(name)


def parquet(folder: Path, table: pa.Table, **options: object) -> Path:
    pq.write_table(table, folder / "x.parquet", **options)
    return folder / "x.parquet"


def archive(folder: Path, members: dict[str, bytes], *, method: int = zipfile.ZIP_DEFLATED) -> Path:
    with zipfile.ZipFile(folder / DRAWS, "w", method) as out:
        for name, data in members.items():
            out.writestr(f"{name}.npy", data)
    return folder


def npy(array: np.ndarray) -> bytes:
    out = io.BytesIO()
    np.save(out, array)
    return out.getvalue()


def npy_header(text: str) -> bytes:
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode()


GOOD_DRAWS = {"t": npy(np.arange(5.0)), "poses": npy(np.zeros((3, 5, 3), np.float32))}


def slip_of(folder: Path) -> tuple[NamedSlip, SlipCurve]:
    curve = SlipCurve(
        law=slip_law("brush"), values=np.array([5.0, 0.4]), covariance=np.eye(2) * 1e-3,
        definition=SlipDefinition.MATERIAL, load_range=(1.0, 2.0), slip_range=(0.0, 1.0),
    )  # fmt: skip
    return NamedSlip(curve, "real", "x", (folder / "slip.toml",)), curve


def draw_posterior(folder: Path) -> object:
    slip, curve = slip_of(folder)
    return law_draws(slip, curve, 10, rng=np.random.default_rng(1))


def log_of_chunk(file: Path, *, unpacked: int, schema: str, topic: str) -> Path:
    """Write a log whose one message unpacks to so many bytes of zeros."""
    with file.open("wb") as out:
        writer = Writer(out, chunk_size=unpacked * 2, compression=CompressionType.ZSTD)
        writer.start()
        number = writer.register_schema(schema, "ros2msg", b"uint8 x")
        channel = writer.register_channel(topic, "cdr", number)
        writer.add_message(channel, 0, bytes(unpacked), 0)
        writer.finish()
    return file


def test_a_gzip_bomb_of_cells_is_refused_within_memory(tmp_path):
    file = tmp_path / "bomb.csv.gz"
    row = b"1,2,3,4,5,6,7,8\n"
    with gzip.open(file, "wb", compresslevel=1) as out:
        out.write(b"a,b,c,d,e,f,g,h\n")
        block = row * (MEGABYTE // len(row))
        for _ in range(160):
            out.write(block)
    assert "million cells" in one_line(read_table_file, file, grown=500)


def test_a_header_of_very_many_columns_is_refused(tmp_path):
    file = tmp_path / "wide.csv"
    file.write_text(",".join(f"c{i}" for i in range(9000)) + "\n" + ",".join("1" * 9000) + "\n")
    assert "columns" in one_line(read_table_file, file)


@pytest.mark.parametrize("column", ["run", "slip_definition"])
@pytest.mark.parametrize("kind", ["struct", "list"])
def test_parquet_cells_of_other_kinds_are_named(kind, column, tmp_path):
    cells = {
        "struct": pa.array([{"x": 1}] * 30),
        "list": pa.array([[1, 2]] * 30),
    }[kind]
    columns = {
        "t": np.arange(30.0), "slip_ratio": np.linspace(0, 0.3, 30), "normal_force": np.full(30, 5),
        "traction_force": np.linspace(0, 2, 30), "slip_definition": ["material"] * 30,
    }  # fmt: skip
    file = parquet(tmp_path, pa.table({**columns, column: cells}))
    assert f"column '{column}'" in one_line(lambda path: read_rig_data([path]), file)


def test_a_parquet_bomb_of_equal_values_is_refused_within_memory(tmp_path):
    column = pa.DictionaryArray.from_arrays(
        pa.array(np.zeros(60_000_000, np.int8)), pa.array([1.5])
    )
    file = parquet(tmp_path, pa.table({"t": column.dictionary_decode()}), compression="zstd")
    assert file.stat().st_size < MEGABYTE
    del column
    assert "cells" in one_line(read_table_file, file)


def test_a_parquet_bomb_of_one_long_text_is_refused_within_memory(tmp_path):
    column = pa.DictionaryArray.from_arrays(
        pa.array(np.zeros(400, np.int32)), pa.array(["x" * MEGABYTE])
    )
    file = parquet(tmp_path, pa.table({"t": column}), store_schema=False, compression="zstd")
    assert file.stat().st_size < MEGABYTE
    one_line(numbers("t"), file, grown=200)


@pytest.mark.parametrize(
    "data",
    [b"PK\x03\x04 cut short", b""],
)
def test_draws_that_are_no_archive_are_refused(data, tmp_path):
    (tmp_path / DRAWS).write_bytes(data)
    one_line(read_draws, tmp_path)


def test_draws_with_a_damaged_member_are_refused(tmp_path):
    archive(tmp_path, {"t": npy(np.arange(5000.0)), "poses": npy(np.zeros((3, 5000, 3)))})
    data = bytearray((tmp_path / DRAWS).read_bytes())
    data[60:80] = b"\xff" * 20
    (tmp_path / DRAWS).write_bytes(data)
    one_line(read_draws, tmp_path)


@pytest.mark.parametrize(
    "header",
    [
        "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999,), }",
        "{'descr': '|O', 'fortran_order': False, 'shape': (5,), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (-5,), }",
        "{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (5,), }",
        "[" * 5000,
    ],
)
def test_draws_whose_header_claims_the_impossible_are_refused(header, tmp_path):
    said = one_line(read_draws, archive(tmp_path, {**GOOD_DRAWS, "t": npy_header(header)}))
    assert "member 't'" in said


def test_a_bomb_of_zeros_in_draws_is_refused_within_memory(tmp_path):
    zeros = npy(np.zeros((20, 600_000, 3)))
    file = archive(tmp_path, {"t": npy(np.zeros(600_000)), "poses": zeros})
    assert (file / DRAWS).stat().st_size < 2 * MEGABYTE
    del zeros
    assert "unpack" in one_line(read_draws, file, grown=100)


def posterior_with(folder: Path, fill: Callable[[h5py.Group], object]) -> Path:
    with h5py.File(folder / POSTERIOR, "w") as file:
        fill(file.create_group("posterior"))
    return folder


def test_a_posterior_that_claims_more_draws_than_it_holds_is_refused(tmp_path):
    folder = posterior_with(
        tmp_path,
        lambda group: group.create_dataset("friction", (1 << 27,), "f8", chunks=(1 << 20,)),
    )
    assert "draws" in one_line(draw_posterior, folder)


def test_a_posterior_does_not_read_other_files(tmp_path):
    secret = tmp_path / "secret.bin"
    secret.write_bytes(np.arange(10.0).tobytes())
    folder = posterior_with(
        tmp_path,
        lambda group: group.create_dataset(
            "friction", (10,), "f8", external=[(str(secret), 0, 80)]
        ),
    )
    one_line(draw_posterior, folder)


@pytest.mark.parametrize("what", ["text", "compound", "uneven"])
def test_posterior_values_that_are_no_draws_are_refused(what, tmp_path):
    def fill(group: h5py.Group) -> None:
        if what == "text":
            group.create_dataset("friction", data=np.array([b"a", b"b"]))
        elif what == "compound":
            group.create_dataset("friction", data=np.zeros(3, [("a", "f8")]))
        else:
            group.create_dataset("friction", data=np.zeros(3))
            group.create_dataset("slip_stiffness", data=np.zeros(4))

    one_line(draw_posterior, posterior_with(tmp_path, fill))


@pytest.mark.parametrize(
    ("reader", "schema", "topic"),
    [(read_raw_log, COUNTS_NAME, "/a/raw"), (read_log, SCHEMA_NAME, TOPIC)],
    ids=["raw", "rig"],
)
def test_a_bomb_of_zeros_in_a_log_is_cut_off_within_memory(reader, schema, topic, tmp_path):
    file = tmp_path / "log.mcap"
    log_of_chunk(file, unpacked=400 * MEGABYTE, schema=schema, topic=topic)
    assert file.stat().st_size < MEGABYTE
    before = forget_peak()
    with suppress(DataError):
        reader(file)
    assert peak() - before < 200 * 1024


@pytest.mark.parametrize("reader", [read_tum, read_raw_log, read_log, read_table_file])
def test_a_fifo_named_as_data_does_not_hang(reader, tmp_path):
    fifo = tmp_path / "x.csv"
    os.mkfifo(fifo)
    said: list[object] = []

    def read() -> None:
        try:
            said.append(reader(fifo))
        except ZebroLabError as error:
            said.append(error)

    thread = threading.Thread(target=read, daemon=True)
    thread.start()
    thread.join(2.0)
    if thread.is_alive():
        os.close(os.open(fifo, os.O_RDWR | os.O_NONBLOCK))
        pytest.fail("still waiting after 2 s")
    assert isinstance(said[0], ZebroLabError)


def test_wrong_statistics_of_a_parquet_column_are_an_error_and_no_end_of_the_process(tmp_path):
    """A histogram of levels that is too long ends pyarrow where a column is asked for."""
    code = (
        "import sys; from pathlib import Path; from zebro_lab.files.errors import DataError\n"
        "from zebro_lab.tables.table_files import read_table_file\n"
        "try: read_table_file(Path(sys.argv[1]))\n"
        "except DataError as error: print(error)"
    )
    file = Path(__file__).with_name("wrong_histogram.parquet")
    done = subprocess.run([sys.executable, "-c", code, str(file)], capture_output=True, text=True)
    assert (done.returncode, done.stdout.count("\n")) == (0, 1), done.stderr
    assert "is not a whole Parquet file" in done.stdout


def test_a_parameter_whose_name_is_no_text_is_one_line(tmp_path):
    (tmp_path / "slip.toml").write_text("")
    with h5py.File(tmp_path / POSTERIOR, "w") as data:
        data.create_group("posterior")[b"stiff\xff"] = np.arange(4.0)
    with pytest.raises(DataError, match=r"holds draws of stiff\\xff, but") as raised:
        draw_posterior(tmp_path)
    assert "\n" not in str(raised.value)
