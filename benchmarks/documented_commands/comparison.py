# SPDX-License-Identifier: MIT
"""What differs between what two checkouts made of the same lines."""

import re
from dataclasses import dataclass
from difflib import unified_diff
from pathlib import Path

from benchmarks.documented_commands.contents import Content, read_content
from benchmarks.documented_commands.normal import Normaliser
from benchmarks.documented_commands.running import Outcome, kept, read_outcomes

NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
MOST_SHOWN = 6


@dataclass(frozen=True)
class Compared:
    """A line compared.

    Attributes:
        outcome: What the first checkout made of it.
        faults: What must not differ and does: exit code, names of files, what is in them, numbers
            that are printed.
        prose: Printed lines that differ in words alone.
    """

    outcome: Outcome
    faults: tuple[str, ...]
    prose: tuple[str, ...]


@dataclass(frozen=True)
class Side:
    """One of the two: where it was run, and what came of it."""

    out: Path
    outcomes: list[Outcome]
    normal: Normaliser

    @staticmethod
    def read(out: Path) -> "Side":
        """Read what a run wrote."""
        return Side(out, read_outcomes(out), Normaliser(read_places(out)))


def read_places(out: Path) -> dict[str, Path]:
    """Return the folders whose paths are not compared, with what stands for them."""
    texts = dict(line.split("\t") for line in (out / "places.txt").read_text().splitlines())
    works = {f"WORK/{path.name}": path for path in (out / "work").iterdir() if path.is_dir()}
    return works | {name: Path(text) for name, text in texts.items()}


def compare(first: Path, second: Path) -> list[Compared]:
    """Compare two runs line by line.

    Raises:
        SystemExit: They are runs of other lines.
    """
    one, other = Side.read(first), Side.read(second)
    if [each.line for each in one.outcomes] != [each.line for each in other.outcomes]:
        raise SystemExit("these are runs of other lines; take the first one's by --lines")
    return [compare_line(one, other, number) for number in range(len(one.outcomes))]


def compare_line(one: Side, other: Side, number: int) -> Compared:
    """Compare one line's outcomes, by its number."""
    a, b = one.outcomes[number], other.outcomes[number]
    faults = []
    if (a.code, a.over_limit) != (b.code, b.over_limit):
        faults.append(f"exit code {_ending(a)}, then {_ending(b)}")
    names = [{side.normal.name(name): name for name in side.outcomes[number].files}
             for side in (one, other)]  # fmt: skip
    faults += [f"missing: {name}" for name in sorted(names[0].keys() - names[1].keys())]
    faults += [f"added: {name}" for name in sorted(names[1].keys() - names[0].keys())]
    removed = [{side.normal.name(name) for name in side.outcomes[number].removed}
               for side in (one, other)]  # fmt: skip
    if removed[0] != removed[1]:
        faults.append(f"removed by one alone: {', '.join(sorted(removed[0] ^ removed[1]))}")
    if a.line.real_time:
        return Compared(a, tuple(faults), ())
    for name in sorted(names[0].keys() & names[1].keys()):
        parts = [read_content(kept(side.out, number) / each[name], side.normal)
                 for side, each in zip((one, other), names, strict=True)]  # fmt: skip
        faults += [f"{name}: {what}" for what in differences(*parts)]
    prose = []
    for kind in ("stdout", "stderr"):
        said = [side.normal.text(getattr(side.outcomes[number], kind)) for side in (one, other)]
        changed = "; ".join(changed_lines(*said)[:MOST_SHOWN])
        if NUMBER.findall(said[0]) != NUMBER.findall(said[1]):
            faults.append(f"numbers on {kind}: {changed}")
        elif changed:
            prose.append(f"words on {kind}: {changed}")
    return Compared(a, tuple(faults), tuple(prose))


def changed_lines(before: str, after: str) -> list[str]:
    """Return the lines of a text that went, with a minus before them, and those that came."""
    lines = unified_diff(before.splitlines(), after.splitlines(), n=0, lineterm="")
    return [line for line in lines if not line.startswith(("---", "+++", "@@"))]


def _ending(outcome: Outcome) -> str:
    return "none, over the limit" if outcome.over_limit else str(outcome.code)


def differences(one: Content, other: Content) -> list[str]:
    """List the parts of two contents that differ, the first few."""
    found = [f"lacks {key}" for key in one.keys() - other.keys()]
    found += [f"has {key} too" for key in other.keys() - one.keys()]
    found = sorted(found)
    for key in one.keys() & other.keys():
        if not _equal(one[key], other[key]):
            found.append(f"{key}: {_short(one[key], other[key])}")
    more = len(found) - MOST_SHOWN
    return found[:MOST_SHOWN] + ([f"and {more} more parts"] if more > 0 else [])


def _equal(a: object, b: object) -> bool:
    return type(a) is type(b) and (a == b or repr(a) == repr(b))  # NaN is NaN


def _short(a: object, b: object) -> str:
    """Say where two values part."""
    if isinstance(a, list | tuple) and isinstance(b, list | tuple):
        if len(a) != len(b):
            return f"{len(a)} entries, then {len(b)}"
        apart = [n for n, (x, y) in enumerate(zip(a, b, strict=True)) if not _equal(x, y)]
        return f"{len(apart)} of {len(a)} entries, first at {apart[0]}: " + _short(
            a[apart[0]], b[apart[0]]
        )
    if isinstance(a, bytes) and isinstance(b, bytes):
        if len(a) != len(b):
            return f"{len(a)} bytes, then {len(b)}"
        return f"{sum(x != y for x, y in zip(a, b, strict=True))} of {len(a)} bytes"
    return f"{str(a)[:80]!r}, then {str(b)[:80]!r}"


def print_comparison(compared: list[Compared]) -> None:
    """Print a row a line, then what differs."""
    print("| page | line | result |\n|---|---|---|")
    for each in compared:
        print(f"| {each.outcome.line.page} | `{_cell(each.outcome.line.text)}` | {_result(each)} |")
    for each in compared:
        for what in (*each.faults, *each.prose):
            print(f"\n{each.outcome.line.page}: {each.outcome.line.text}\n  {what}")
    ran = [each for each in compared if each.outcome.line.command]
    equal = sum(not each.faults for each in ran)
    print(f"\n{equal} of {len(ran)} lines equal, {len(compared) - len(ran)} left out")


def _cell(text: str) -> str:
    return text.replace("|", "\\|")[:100]


def _result(each: Compared) -> str:
    line = each.outcome.line
    if not line.command:
        return f"left out: {line.note}"
    said = ["DIFFERS" if each.faults else "equal"]
    said += ["other words"] if each.prose else []
    said += ["numbers not compared: real time"] if line.real_time else []
    said += ["preparation"] if line.prepares else []
    return ", ".join([*said, *([line.note] if line.note else [])])
