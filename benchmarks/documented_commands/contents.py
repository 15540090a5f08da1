# SPDX-License-Identifier: MIT
"""What is in a file, read by its kind, so that equal numbers in other bytes are equal."""

import csv
import gzip
import io
import json
import re
import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import PIL.Image
import pyarrow as pa
import pyarrow.parquet as pq
from mcap.reader import make_reader

from benchmarks.documented_commands.normal import Normaliser
from rig.sample_columns import SampleColumns
from zebro_lab.mcap.raw_log import RAW_SCHEMAS, decode_raw

Content = Mapping[str, object]
_STAMPED = re.compile(
    rb"(\s*(#[^\n]*)?\n)*\s*(std_msgs/(msg/)?Header|builtin_interfaces/(msg/)?Time)\b"
)
_STAMP = slice(4, 12)
"""Where the date is in a message in CDR that begins with one; logs count from their start."""
OF_THE_RUN = {
    "software", "versions", "version", "host", "hostname", "user", "operator", "seconds",
    "elapsed", "elapsed_s", "duration_seconds", "commit", "git", "created", "created_at", "made",
    "python", "platform", "inference_library_version", "creation_library_version",
    "arviz_version", "numba", "fingerprint",
}  # fmt: skip
"""Keys whose values tell of the run or of the machine."""


def read_content(file: Path, normal: Normaliser) -> Content:
    """Read a file as named parts that can be compared; bytes where its kind is not known.

    A file that is not what its name says has a part `unreadable`, and its bytes.
    """
    kind = "".join(file.suffixes[-2:]) if file.suffix == ".gz" else file.suffix
    reader = READERS.get(kind.lower(), _bytes)
    try:
        return reader(file.read_bytes(), normal)
    except Exception as error:  # whatever a parser answers with is a finding
        return {"unreadable": type(error).__name__, "bytes": file.read_bytes()}


def flattened(value: object, normal: Normaliser, at: str = "") -> dict[str, object]:
    """Return the leaves of a document by their path; what tells of the run is left out."""
    if isinstance(value, dict):
        parts = {f"{at}.{normal.text(str(key))}": each for key, each in value.items()
                 if key not in OF_THE_RUN}  # fmt: skip
    elif isinstance(value, list):
        parts = {f"{at}[{n}]": each for n, each in enumerate(value)} | {f"{at}.length": len(value)}
    else:
        return {at: normal.text(value) if isinstance(value, str) else value}
    return {
        k: leaf for key, each in parts.items() for k, leaf in flattened(each, normal, key).items()
    }


def _bytes(data: bytes, _: Normaliser) -> Content:
    return {"bytes": data}


def _text(data: bytes, normal: Normaliser) -> Content:
    lines = normal.text(data.decode("utf-8", errors="replace")).splitlines()
    return {f"line {n}": line for n, line in enumerate(lines, start=1)} | {"lines": len(lines)}


def _json(data: bytes, normal: Normaliser) -> Content:
    return flattened(json.loads(data), normal)


def _json_lines(data: bytes, normal: Normaliser) -> Content:
    return flattened([json.loads(line) for line in data.splitlines() if line.strip()], normal)


def _toml(data: bytes, normal: Normaliser) -> Content:
    return flattened(tomllib.loads(data.decode()), normal)


def _csv(data: bytes, normal: Normaliser) -> Content:
    rows = list(csv.reader(io.StringIO(data.decode("utf-8-sig"))))
    width = max(map(len, rows), default=0)
    columns = {
        f"column {rows[0][n] if n < len(rows[0]) else n}": tuple(
            _cell(row[n], normal) if n < len(row) else None for row in rows
        )
        for n in range(width)
    }
    return columns | {"rows": len(rows)}


def _cell(text: str, normal: Normaliser) -> str:
    """Return a cell; a number as it stands, to the last digit."""
    try:
        float(text)
    except ValueError:
        return normal.text(text)
    return text


def _csv_gz(data: bytes, normal: Normaliser) -> Content:
    return _csv(gzip.decompress(data), normal)


def _npz(data: bytes, normal: Normaliser) -> Content:
    with np.load(io.BytesIO(data), allow_pickle=False) as archive:
        arrays = {name: _array(archive[name], normal) for name in archive.files}
    return {name: value for name, value in arrays.items() if name not in OF_THE_RUN}


def _array(array: np.ndarray, normal: Normaliser) -> object:
    if array.dtype.kind in "USO":
        return tuple(
            normal.text(each.decode() if isinstance(each, bytes) else str(each))
            for each in array.ravel().tolist()
        )
    return array.dtype.str, array.shape, array.tobytes()


def _parquet(data: bytes, normal: Normaliser) -> Content:
    table = pq.read_table(pa.BufferReader(data))
    columns: dict[str, object] = {
        f"column {name}": (str(column.type), tuple(column.to_pylist()))
        for name, column in zip(table.column_names, table.columns, strict=True)
    }
    about = {key.decode(): normal.text(value.decode()) for key, value in
             (table.schema.metadata or {}).items() if key != b"pandas"}  # fmt: skip
    return columns | {f"metadata {key}": each for key, each in about.items()}


def _hdf5(data: bytes, normal: Normaliser) -> Content:
    found: dict[str, object] = {}

    def visit(name: str, node: Any) -> None:
        if isinstance(node, h5py.Dataset):
            found[name] = _array(np.asarray(node[()]), normal)
        for key, value in node.attrs.items():
            if key not in OF_THE_RUN and not key.startswith(("_Netcdf4", "REFERENCE", "DIMENSION")):
                found[f"{name}@{key}"] = _array(np.asarray(value), normal)

    with h5py.File(io.BytesIO(data), "r") as file:
        visit("", file)
        file.visititems(visit)
    return found


def _mcap(data: bytes, normal: Normaliser) -> Content:
    found: dict[str, object] = {}
    reader = make_reader(io.BytesIO(data))
    start: int | None = None
    raw: dict[str, list[SampleColumns]] = {}
    for schema, channel, message in reader.iter_messages(log_time_order=False):
        if schema is not None and schema.name in RAW_SCHEMAS:
            # How many samples are in a message depends on when they were read.
            samples = decode_raw(message.data, dtype=RAW_SCHEMAS[schema.name][0])
            raw.setdefault(channel.topic, []).append(samples)
            continue
        payloads = found.setdefault(f"messages {channel.topic}", [])
        assert isinstance(payloads, list)
        start = message.log_time if start is None else start
        data = message.data
        if schema is not None and _STAMPED.match(schema.data):
            data = data[: _STAMP.start] + data[_STAMP.stop :]
        payloads.append((message.log_time - start, message.sequence, data))
    for topic, parts in raw.items():
        samples = SampleColumns.joined(parts)
        columns = {**vars(samples), "host_time": samples.host_time - samples.host_time[0]}
        for name, column in columns.items():
            found[f"samples {topic}: {name}"] = (column.shape, column.tobytes())
    for attachment in reader.iter_attachments():
        text = attachment.data.decode(errors="replace")
        found[f"attachment {attachment.name}"] = normal.text(text)
    return found


def _picture(data: bytes, _: Normaliser) -> Content:
    with PIL.Image.open(io.BytesIO(data)) as picture:
        frames = []
        for number in range(getattr(picture, "n_frames", 1)):
            picture.seek(number)
            frames.append(np.asarray(picture.convert("RGBA")))
    return {f"pixels {n}": (each.shape, each.tobytes()) for n, each in enumerate(frames)}


READERS: dict[str, Callable[[bytes, Normaliser], Content]] = {
    ".json": _json, ".jsonl": _json_lines, ".toml": _toml, ".csv": _csv, ".csv.gz": _csv_gz,
    ".npz": _npz, ".parquet": _parquet, ".nc": _hdf5, ".h5": _hdf5, ".mcap": _mcap,
    ".png": _picture, ".jpg": _picture, ".gif": _picture,
    ".txt": _text, ".md": _text, ".html": _text, ".svg": _text, ".tum": _text,
}  # fmt: skip
