# SPDX-License-Identifier: MIT
"""Generated inputs for every parser of what devices send; prints the table of drivers.md.

python -m benchmarks.faults.parsers_fuzz [INPUTS [PART OF A PARSER'S NAME]]

Of every five inputs one is random, one valid, and the others are valid ones with bytes changed, cut
short, or spliced from two. A million take a few minutes a parser, an hour in all.
"""

import logging
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from benchmarks.faults.device_parsers import Parser, parsers


@dataclass
class Result:
    """Counts of what a parser did with its inputs."""

    inputs: int = 0
    accepted: int = 0
    refused: int = 0
    others: Counter[str] = field(default_factory=Counter)


def generate(valid: Sequence[bytes], count: int, rng: np.random.Generator) -> Iterator[bytes]:
    """Yield inputs: random, valid, with bytes changed, cut short, spliced."""
    longest = max(map(len, valid))
    for kind in (np.arange(count) % 5).tolist():
        data = valid[int(rng.integers(len(valid)))]
        if kind == 0:
            yield rng.bytes(int(rng.integers(0, min(longest, 400) + 8)))
        elif kind == 1:
            yield data
        elif kind == 2:
            changed = bytearray(data)
            for at in rng.integers(0, max(len(data), 1), rng.integers(1, 4)).tolist():
                if changed:
                    changed[at] = int(rng.integers(256))
            yield bytes(changed)
        elif kind == 3:
            yield data[: int(rng.integers(0, len(data) + 1))]
        else:
            other = valid[int(rng.integers(len(valid)))]
            cut, on = rng.integers(0, len(data) + 1), rng.integers(0, len(other) + 1)
            yield data[: int(cut)] + other[int(on) :]


def fuzz(parser: Parser, count: int, rng: np.random.Generator) -> Result:
    """Feed generated inputs to one parser."""
    result, take = Result(), parser.make()
    for number, data in enumerate(generate(parser.valid, count, rng)):
        if parser.has_memory and number % 20 == 0:
            take = parser.make()
        result.inputs += 1
        try:
            accepted = take(data)
        except parser.refusals:
            result.refused += 1
            take = parser.make()
        except Exception as error:  # counted: that is what this is for
            result.others[f"{type(error).__name__}: {error}"[:100]] += 1
            take = parser.make()
        else:
            result.accepted += accepted
            result.refused += not accepted
    return result


def main(count: int, only: str) -> bool:
    """Print a line a parser; tell whether any raised what is not documented."""
    logging.disable(logging.CRITICAL)
    print("| parser | inputs | accepted | refused | other exceptions |\n|---|---|---|---|---|")
    wrong = Counter[str]()
    for name, parser in parsers().items():
        if only not in name:
            continue
        result = fuzz(parser, count, np.random.default_rng(7))
        others = sum(result.others.values())
        print(f"| {name} | {result.inputs} | {result.accepted} | {result.refused} | {others} |",
              flush=True)  # fmt: skip
        wrong += result.others
    for what, times in wrong.most_common():
        print(f"{times} x {what}")
    return bool(wrong)


if __name__ == "__main__":
    given = [*sys.argv[1:], "", ""][:2]
    raise SystemExit(main(int(given[0] or 1_000_000), given[1]))
