# SPDX-License-Identifier: MIT
"""What differs between what two checkouts made of the same lines: codes, files and numbers."""

import gzip
import re
from collections.abc import Iterator
from contextlib import suppress
from difflib import unified_diff
from pathlib import Path

from benchmarks.documented_commands.running import Outcome, kept, read_outcomes

NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
MOST_SHOWN = 6
STAMP = r"\b\d{8}T\d{6}(\.\d+)?Z"
OF_THE_RUN = tuple((re.compile(pattern), instead) for pattern, instead in (
    (STAMP, "TIME"),
    (r"\b\d{4}-\d\d-\d\d([T ]\d\d:\d\d(:\d\d)?(\.\d+)?( ?(Z|UTC|[+-]\d\d:?\d\d))?)?", "TIME"),
    (r"data:[\w/+.-]+;base64,[A-Za-z0-9+/=]+", "EMBEDDED"),
    (r"(127\.0\.0\.1|localhost):\d+", "HOST:PORT"),
    (r"\b[0-9a-f]{64}\b|\b[0-9a-f]{40}\b", "HASH"),
    (r"(?<![.\w])(?=\d*[a-f])(?=[a-f]*\d)[0-9a-f]{7,12}\b(?![-+.]\d)", "COMMIT"),
    (r"\b\d+\.\d+\.\d+([.+-]?(dev|rc|post|a|b|g)\w*)*(\+\w+(\.\w+)*)?\b", "VERSION"),
    (r'("?\b(seconds|elapsed|fingerprint|numba|python|platform)"?\s*[=:]).*', r"\1 OF THE RUN"),
    (r"\b(in|took) \d+(\.\d+)? ?(s|ms|min|h)\b", r"\1 DURATION"),
    (r"\b\d+:\d\d(:\d\d)?\b", "CLOCK"),
    (r"(?<![\w.])(/[\w.+-]+)+/", "PLACE/"),
))  # fmt: skip
"""Patterns of what changes with every run, and what stands for it."""


def without_the_run(text: str) -> str:
    """Return a text without places, dates, versions, durations and hashes."""
    for pattern, instead in OF_THE_RUN:
        text = pattern.sub(instead, text)
    return text


def contents(file: Path) -> str:
    """Read the text of a file, packed or not; of pictures, arrays and logs that they are there."""
    data = file.read_bytes()
    with suppress(UnicodeDecodeError):
        return without_the_run((gzip.decompress(data) if file.suffix == ".gz" else data).decode())
    return ""


def compare(first: Path, second: Path) -> Iterator[tuple[Outcome, list[str]]]:
    """Yield each line's outcome in the first run, and what differs in the second.

    Raises:
        SystemExit: They are runs of other lines.
    """
    runs = [read_outcomes(out) for out in (first, second)]
    if [each.line for each in runs[0]] != [each.line for each in runs[1]]:
        raise SystemExit("these are runs of other lines; take the first one's by --lines")
    for number, outcomes in enumerate(zip(*runs, strict=True)):
        folders = [kept(out, number) for out in (first, second)]
        yield outcomes[0], list(differences(outcomes, folders))


def differences(outcomes: tuple[Outcome, ...], folders: list[Path]) -> Iterator[str]:
    """Say what differs between two outcomes of a line."""
    one, other = outcomes
    if one.code != other.code:
        yield f"exit code {one.code}, then {other.code}"
    names = [{re.sub(STAMP, "TIME", name): name for name in each.files} for each in outcomes]
    for name in sorted(names[0].keys() ^ names[1].keys()):
        yield f"{'missing' if name in names[0] else 'added'}: {name}"
    if one.line.real_time:
        return
    for name in sorted(names[0].keys() & names[1].keys()):
        a, b = (contents(folder / each[name]) for folder, each in zip(folders, names, strict=True))
        if a != b:
            yield f"{name}: {_apart(a, b)}"
    for kind in ("stdout", "stderr"):
        a, b = (without_the_run(getattr(each, kind)) for each in outcomes)
        if NUMBER.findall(a) != NUMBER.findall(b):
            yield f"numbers on {kind}: {_apart(a, b)}"


def _apart(a: str, b: str) -> str:
    """Show the first lines that two texts do not share."""
    lines = unified_diff(a.splitlines(), b.splitlines(), n=0, lineterm="")
    shown = [line[:100] for line in lines if not line.startswith(("---", "+++", "@@"))]
    return "; ".join(shown[:MOST_SHOWN])


def print_comparison(first: Path, second: Path) -> bool:
    """Print what differs, line by line; tell whether anything does."""
    ran = [each for each in compare(first, second) if each[0].line.command]
    for outcome, found in ran:
        for what in found:
            print(f"{outcome.line.page}: {outcome.line.text}\n  {what}\n")
    print(f"{sum(not found for _, found in ran)} of {len(ran)} lines equal")
    return any(found for _, found in ran)
