# SPDX-License-Identifier: MIT
"""Inputs that do harm: documents whose values swap types, tables, and bytes that were changed.

Structure comes first: most inputs pass the first check of their reader (they are TOML, JSON, CSV,
a zip archive …) and go wrong behind it. All are functions of a random generator alone.
"""

import copy
import gzip
import io
import json
import math
import zipfile
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

Make = Callable[[np.random.Generator], bytes]

TEXTS = (
    "", " ", "x" * 5000, "nan", "-inf", "1e999", "0x10", "12", "35 mm", "-3 parsec", "m" * 40,
    "a\nb", "a\rb", "\u2028", "\u202eabc", "\x1b[2J", "\x00", "../../etc/passwd", "/dev/zero",
    "<script>x</script>", "{{ 7*7 }}", "{0}", "%s%n", "$\\frac{", "2026-13-45T99:99:99+00:00",
    "9999-12-31T23:59:59+00:00", "0001-01-01T00:00:00+14:00", "\ud7ff\ue000", "é" * 50, "1" * 5000,
    "true", "null", "slip > 1", "`", "`a` == 1", "2**8**8", "__class__", "real", "sim:x",
    "m/s^9**9",
)  # fmt: skip
NUMBERS: tuple[Any, ...] = (
    0, -1, 1, 2, 7, 10**6, 2**31, 2**63 - 1, -(2**63), 2**64, 10**400, -0.0, 1e-308, 1e308,
    math.nan, math.inf, -math.inf, 0.1, True, False,
)  # fmt: skip


def pick(rng: np.random.Generator, choices: Sequence[Any]) -> Any:
    """Choose one."""
    return choices[int(rng.integers(len(choices)))]


def odd_value(rng: np.random.Generator, depth: int = 0) -> Any:
    """Make a value of any type, mostly one that nobody expects."""
    kind = int(rng.integers(10))
    if kind < 4:
        return pick(rng, TEXTS)
    if kind < 7 or depth > 2:
        return pick(rng, NUMBERS)
    if kind == 7:
        return [odd_value(rng, depth + 1) for _ in range(int(rng.integers(8)))]
    if kind == 8:
        return {
            str(pick(rng, TEXTS)): odd_value(rng, depth + 1) for _ in range(int(rng.integers(4)))
        }
    deep: Any = 1
    for _ in range(int(pick(rng, (3, 20, 60)))):
        deep = [deep] if rng.random() < 0.5 else {"a": deep}
    return deep


def changed_document(base: dict[str, Any], rng: np.random.Generator) -> dict[str, Any]:
    """Return a document with one to three of its values swapped, taken out, doubled or renamed."""
    document = copy.deepcopy(base)
    for _ in range(int(rng.integers(1, 4))):
        places = list(_places(document))
        if not places:
            break
        holder, key = pick(rng, places)
        kind = int(rng.integers(6))
        if kind < 3:
            holder[key] = odd_value(rng)
        elif kind == 3:
            del holder[key]
        elif isinstance(holder, dict):
            new = str(pick(rng, TEXTS)) if kind == 4 else f"{key}{rng.integers(9)}"
            holder[new] = holder.pop(key) if kind == 4 else copy.deepcopy(holder[key])
        else:
            holder.extend(copy.deepcopy(holder) * int(rng.integers(1, 4)))
    return document


def _places(node: Any) -> Any:
    items = node.items() if isinstance(node, dict) else enumerate(node)
    for key, value in list(items):
        yield node, key
        if isinstance(value, dict | list):
            yield from _places(value)


def as_toml(document: dict[str, Any]) -> bytes:
    """Spell a document as TOML, one line a key."""
    text = "".join(f"{_toml(str(key))} = {_toml(value)}\n" for key, value in document.items())
    return text.encode(errors="surrogatepass")


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        inside = ", ".join(f"{_toml(str(key))} = {_toml(each)}" for key, each in value.items())
        return f"{{{inside}}}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_toml, value))}]"
    if isinstance(value, float):
        return repr(value)
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def as_json(document: dict[str, Any]) -> bytes:
    """Spell a document as JSON."""
    return json.dumps(document).encode()


def changed_bytes(data: bytes, rng: np.random.Generator) -> bytes:
    """Change, cut, double or move bytes of an input."""
    changed = bytearray(data)
    kind = int(rng.integers(6))
    at = int(rng.integers(len(changed) + 1))
    if kind < 3:
        for place in rng.integers(0, max(len(changed), 1), int(rng.integers(1, 5))).tolist():
            if changed:
                changed[place] = int(rng.integers(256)) if kind else changed[place] ^ 1 << int(
                    rng.integers(8))  # fmt: skip
    elif kind == 3:
        del changed[at:]
    elif kind == 4:
        changed[at:at] = changed[at : at + int(rng.integers(64))] * int(rng.integers(1, 9))
    else:
        length = int(pick(rng, (1, 2, 4, 8)))
        word = int(
            pick(rng, (0, 1, 2**7, 2**15, 2**31 - 1, 2**31, 2**32 - 1, 2**63 - 1, 2**64 - 1))
        )
        changed[at : at + length] = (word % 2 ** (8 * length)).to_bytes(length, "little")
    return bytes(changed)


def documents(spell: Callable[[dict[str, Any]], bytes], *bases: dict[str, Any]) -> Make:
    """Make documents: three of four with swapped values, else with changed bytes."""

    def make(rng: np.random.Generator) -> bytes:
        base = pick(rng, bases)
        if rng.random() < 0.75:
            return spell(changed_document(base, rng))
        return changed_bytes(spell(base), rng)

    return make


def pool(made: Sequence[bytes], share: float = 0.9) -> Make:
    """Make inputs of a pool of valid ones, of which a share gets bytes changed."""

    def make(rng: np.random.Generator) -> bytes:
        data = pick(rng, made)
        return changed_bytes(data, rng) if rng.random() < share else data

    return make


def tables(columns: Mapping[str, Any], *, packed: bool = False) -> Make:
    """Make CSV files with odd cells, rows, headers, separators and quotes; perhaps gzipped."""
    names, rows = list(columns), list(zip(*columns.values(), strict=True))

    def make(rng: np.random.Generator) -> bytes:
        header, cells = list(names), [list(map(str, row)) for row in rows]
        for _ in range(int(rng.integers(0, 4))):
            _spoil(header, cells, rng)
        separator = pick(rng, (",", ",", ",", ";", "\t", "|"))
        end = pick(rng, ("\n", "\n", "\r\n", "\r"))
        lines = [separator.join(line) for line in (header, *cells)]
        data = end.join(lines).encode(errors="replace")
        if rng.random() < 0.15:
            data = changed_bytes(data, rng)
        if not packed:
            return data
        zipped = gzip.compress(data, compresslevel=1)
        return changed_bytes(zipped, rng) if rng.random() < 0.2 else zipped

    return make


def _spoil(header: list[str], rows: list[list[str]], rng: np.random.Generator) -> None:
    kind = int(rng.integers(8))
    text = str(odd_value(rng, 3))
    if kind == 0:
        header[int(rng.integers(len(header)))] = pick(rng, (text, pick(rng, header), ""))
    elif kind == 1:
        pick(rng, rows).append(text)
    elif kind == 2 and len(rows) > 1:
        del rows[int(rng.integers(len(rows))) :]
        rows.append([text])
    elif kind == 3:
        row = pick(rng, rows)
        row[int(rng.integers(len(row)))] = pick(rng, ('"', f'"{text}', f'"{text}"', "'", "1,5"))
    elif kind == 4:
        rows[:] = rows * int(rng.integers(1, 4))
    elif kind == 5:
        header.append(text)
    else:
        row = pick(rng, rows)
        row[int(rng.integers(len(row)))] = text


def archives(members: dict[str, np.ndarray]) -> Make:
    """Make .npz archives with odd headers, shapes and types."""
    good = {name: _npy(array) for name, array in members.items()}

    def make(rng: np.random.Generator) -> bytes:
        parts = dict(good)
        name = pick(rng, list(parts))
        kind = int(rng.integers(5))
        if kind == 0:
            parts[name] = _npy_header(rng)
        elif kind == 1:
            parts[name] = changed_bytes(parts[name], rng)
        elif kind == 2:
            parts[name] = _npy(_odd_array(rng))
        elif kind == 3:
            del parts[name]
        out = io.BytesIO()
        method = pick(rng, (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED))
        with zipfile.ZipFile(out, "w", method, compresslevel=1) as archive:
            for each, data in parts.items():
                archive.writestr(f"{each}.npy", data)
        data = out.getvalue()
        return changed_bytes(data, rng) if kind == 4 or rng.random() < 0.2 else data

    return make


def _npy(array: np.ndarray) -> bytes:
    out = io.BytesIO()
    np.save(out, array)
    return out.getvalue()


def _odd_array(rng: np.random.Generator) -> np.ndarray:
    shape = tuple(int(n) for n in rng.integers(0, 6, int(rng.integers(0, 4))))
    dtype = pick(rng, ("<f8", ">f4", "<i8", "|b1", "<U3", "<c16", "<M8[s]", "|S4", "|u1", "<f2"))
    return np.zeros(shape, dtype)


def _npy_header(rng: np.random.Generator) -> bytes:
    descr = pick(rng, ("'<f8'", "'|O'", "[('a','<f8')]", "'<U99999999'", "'zz'", "3", "'<f8'"))
    shape = pick(
        rng, ("(5,)", "(99999999999,)", "(-1,)", "5", "(5.0,)", "((5,),)", "(2**9,)", "()")
    )
    text = (
        f"{{'descr': {descr}, 'fortran_order': {pick(rng, (True, False, 3))}, 'shape': {shape}}}\n"
    )
    version = pick(rng, (b"\x01\x00", b"\x02\x00", b"\x03\x00", b"\x09\x00"))
    size = 2 if version == b"\x01\x00" else 4
    return b"\x93NUMPY" + version + len(text).to_bytes(size, "little") + text.encode() + bytes(40)
