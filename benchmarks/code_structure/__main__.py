# SPDX-License-Identifier: MIT
"""Print how the four packages are built: sizes, names that stand twice, tests that are missing.

python -m benchmarks.code_structure [CHECKOUT [CHECKOUT]] [--places] [--deleted] [--returns]

A checkout is a folder or a commit; this one without any. With two, both are columns of the table.
"""

import argparse
import sys
from contextlib import ExitStack
from pathlib import Path

from benchmarks.code_structure.checkout import open_checkout
from benchmarks.code_structure.deleted import deleted
from benchmarks.code_structure.measures import MEASURES, Checkout
from benchmarks.code_structure.returns import print_returns
from benchmarks.tables import print_table

HERE = Path(__file__).parents[2]


def main(arguments: list[str]) -> None:
    """Print the tables that are asked for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("checkouts", nargs="*", default=[str(HERE)], metavar="CHECKOUT")
    parser.add_argument("--places", action="store_true", help="list what is behind each figure")
    parser.add_argument("--deleted", action="store_true",
                        help="public functions and classes that the second lacks")  # fmt: skip
    parser.add_argument("--returns", action="store_true",
                        help="rooms that the five stages call, in order")  # fmt: skip
    asked = parser.parse_args(arguments)
    if len(asked.checkouts) > 2 or (asked.deleted and len(asked.checkouts) != 2):
        parser.error("one checkout or two; with --deleted two")
    with ExitStack() as stack:
        read = [Checkout.read(stack.enter_context(open_checkout(c))) for c in asked.checkouts]
        if asked.deleted:
            print("\n".join(deleted(*read)))
        elif asked.returns:
            for name, checkout in zip(asked.checkouts, read, strict=True):
                print(f"\n{name}:\n")
                print_returns(checkout, rooms_as_in=read[-1])
        else:
            print_measures(asked.checkouts, read, places=asked.places)


def print_measures(names: list[str], checkouts: list[Checkout], *, places: bool) -> None:
    """Print a row a measure and a column a checkout; then the places behind the figures."""
    found = {
        what: [measure(checkout) for checkout in checkouts] for what, measure in MEASURES.items()
    }
    rows = ((what, *(each.figure for each in all_of)) for what, all_of in found.items())
    print_table(("measure", *names), *rows)
    for what, all_of in found.items() if places else ():
        for name, each in zip(names, all_of, strict=True):
            print("\n".join([f"{what}, {name}:", *(f"  {place}" for place in each.places)]))


if __name__ == "__main__":
    main(sys.argv[1:])
