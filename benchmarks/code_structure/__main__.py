# SPDX-License-Identifier: MIT
"""Print how the four packages are built: sizes, names that stand twice, tests that are missing.

python -m benchmarks.code_structure [CHECKOUT [CHECKOUT]] [--commands] [--places] [--deleted]

A checkout is a folder or a commit; this one without any. With two, both are columns of the table.
`--commands` runs the commands of each on the bundled data, by the environment of this Python.
"""

import argparse
import sys
from contextlib import ExitStack
from pathlib import Path

from benchmarks.code_structure.checkout import open_checkout
from benchmarks.code_structure.commands import module_measures, option_measures
from benchmarks.code_structure.deleted import deleted
from benchmarks.code_structure.measures import MEASURES, Checkout, Measured
from benchmarks.tables import print_table

HERE = Path(__file__).parents[2]


def main(arguments: list[str]) -> None:
    """Print the tables that are asked for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("checkouts", nargs="*", default=[str(HERE)], metavar="CHECKOUT")
    parser.add_argument("--places", action="store_true", help="list what is behind each figure")
    parser.add_argument("--deleted", action="store_true",
                        help="public functions and classes that the second lacks")  # fmt: skip
    parser.add_argument("--commands", action="store_true",
                        help="count options of commands and modules that run, too")  # fmt: skip
    asked = parser.parse_args(arguments)
    if len(asked.checkouts) > 2 or (asked.deleted and len(asked.checkouts) != 2):
        parser.error("one checkout or two; with --deleted two")
    with ExitStack() as stack:
        read = [Checkout.read(stack.enter_context(open_checkout(c))) for c in asked.checkouts]
        if asked.deleted:
            print("\n".join(deleted(*read)))
        else:
            found = [measure_all(each, commands=asked.commands) for each in read]
            print_measures(asked.checkouts, found, places=asked.places)


def measure_all(checkout: Checkout, *, commands: bool) -> dict[str, Measured]:
    """Take every measure of a checkout; those of its commands only if asked, for they take long."""
    found = {what: measure(checkout) for what, measure in MEASURES.items()}
    return found | option_measures(checkout) | module_measures(checkout) if commands else found


def print_measures(names: list[str], found: list[dict[str, Measured]], *, places: bool) -> None:
    """Print a row a measure and a column a checkout; then the places behind the figures."""
    print_table(
        ("measure", *names), *((what, *(each[what].figure for each in found)) for what in found[0])
    )
    for what in found[0] if places else ():
        for name, each in zip(names, found, strict=True):
            print("\n".join([f"{what}, {name}:", *(f"  {place}" for place in each[what].places)]))


if __name__ == "__main__":
    main(sys.argv[1:])
