# SPDX-License-Identifier: MIT
"""Inputs that do harm: valid ones with values swapped, parts cut, doubled, spliced, bytes changed.

Structure comes first: what is a text gets other values between its separators, what is an archive
gets other members, so that most inputs pass the first check of their reader and go wrong behind it.
All are functions of a random generator alone.
"""

import gzip
import io
import re
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import TypeVar

import numpy as np

T = TypeVar("T")

VALUES = (
    "", " ", "x" * 5000, "nan", "-inf", "1e999", "0x10", "12", "35 mm", "-3 parsec", "1,5", "'",
    "a\nb", "a\rb", "\u2028", "\u202eabc", "\x1b[2J", "\x00", "../../etc/passwd", "/dev/zero",
    "<script>x</script>", "{{ 7*7 }}", "{0}", "%s%n", "$\\frac{", "2026-13-45T99:99:99+00:00",
    "9999-12-31T23:59:59+00:00", "0001-01-01T00:00:00+14:00", "é" * 50, "1" * 5000, "true", "null",
    "slip > 1", "`a` == 1", "2**8**8", "__class__", "real", "sim:x", "m/s^9**9", '"text"', "[]",
    "[1, 2]", "{}", '{a = 1}', '{"a": 1}', "[[[[[[[1]]]]]]]", "0", "-1", "1", "2147483648",
    "18446744073709551616", "-0.0", "1e-308", "1e308", "=1/0", "&j;", "<!DOCTYPE x>",
)  # fmt: skip
SEPARATORS = re.compile(r"([\s,;:=|<>\[\]{}\"]+)")
WORDS = (0, 1, 2**7, 2**15, 2**31 - 1, 2**31, 2**32 - 1, 2**63 - 1, 2**64 - 1)


def pick(rng: np.random.Generator, choices: Sequence[T]) -> T:
    """Choose one."""
    return choices[int(rng.integers(len(choices)))]


def generate(valid: Sequence[bytes], count: int, rng: np.random.Generator) -> Iterator[bytes]:
    """Yield inputs: of ten one random, one valid, one cut, one spliced, the others changed."""
    longest = min(max(map(len, valid)), 400)
    for kind in (np.arange(count) % 10).tolist():
        data = pick(rng, valid)
        if kind == 0:
            yield rng.bytes(int(rng.integers(0, longest + 8)))
        elif kind == 1:
            yield data
        elif kind == 2:
            yield data[: int(rng.integers(0, len(data) + 1))]
        elif kind == 3:
            other = pick(rng, valid)
            cut, on = rng.integers(0, len(data) + 1), rng.integers(0, len(other) + 1)
            yield data[: int(cut)] + other[int(on) :]
        else:
            yield changed(data, rng)


def changed(data: bytes, rng: np.random.Generator) -> bytes:
    """Change an input: values of a text, members of an archive, bytes of anything else."""
    if rng.random() < 0.2:
        return changed_bytes(data, rng)
    if data.startswith(b"\x1f\x8b"):
        return gzip.compress(changed(gzip.decompress(data), rng), compresslevel=1)
    if data.startswith(b"PK"):
        return changed_archive(data, rng)
    with suppress(UnicodeDecodeError):
        return changed_text(data.decode(), rng).encode()
    return changed_bytes(data, rng)


def changed_text(text: str, rng: np.random.Generator) -> str:
    """Swap, take out, double or replace one to three values of a text, or double or cut a line."""
    for _ in range(int(rng.integers(1, 4))):
        kind = int(rng.integers(8))
        parts = text.splitlines(keepends=True) if kind < 2 else SEPARATORS.split(text)
        if not parts:
            return pick(rng, VALUES)
        at = int(rng.integers(len(parts)))
        if kind < 4:
            parts[at] = pick(rng, ("", parts[at] * 2, pick(rng, parts)))
        else:
            parts[at - at % 2] = pick(rng, VALUES)
        text = "".join(parts)
    return text


def changed_archive(data: bytes, rng: np.random.Generator) -> bytes:
    """Change a member of a zip archive, or take it out."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    name = pick(rng, list(members))
    members[name] = changed(members[name], rng)
    if rng.random() < 0.1:
        del members[name]
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for each, content in members.items():
            archive.writestr(each, content)
    return out.getvalue()


def changed_bytes(data: bytes, rng: np.random.Generator) -> bytes:
    """Change bytes of an input, or double a part of it, or put a number of many digits there."""
    out, kind = bytearray(data), int(rng.integers(4))
    at = int(rng.integers(len(out) + 1))
    if kind < 2 and out:
        for place in rng.integers(0, len(out), int(rng.integers(1, 5))).tolist():
            flipped = out[place] ^ 1 << int(rng.integers(8))
            out[place] = int(rng.integers(256)) if kind else flipped
    elif kind == 2:
        out[at:at] = out[at : at + int(rng.integers(64))] * int(rng.integers(1, 9))
    else:
        length = pick(rng, (1, 2, 4, 8))
        out[at : at + length] = (pick(rng, WORDS) % 2 ** (8 * length)).to_bytes(length, "little")
    return bytes(out)
