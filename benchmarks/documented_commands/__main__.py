# SPDX-License-Identifier: MIT
"""Run every documented command of a checkout, and compare what two checkouts make of them.

python -m benchmarks.documented_commands list CHECKOUT
python -m benchmarks.documented_commands run CHECKOUT OUT [--lines OUT1] [--programs BIN]
python -m benchmarks.documented_commands compare OUT1 OUT2

`run` makes OUT: a clean folder for each page, what each line printed, and its files. Lines are
those of CHECKOUT, or of an earlier run; the programs are CHECKOUT's own `.venv/bin`.
"""

import argparse
import sys
from pathlib import Path

from benchmarks.documented_commands.comparison import compare, print_comparison
from benchmarks.documented_commands.lines import find_lines
from benchmarks.documented_commands.running import read_outcomes, run_lines


def parse(arguments: list[str]) -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    tasks = parser.add_subparsers(dest="task", required=True)
    listing = tasks.add_parser("list", help="the lines, and what is done with each")
    running = tasks.add_parser("run", help="run the lines of a checkout")
    for each in (listing, running):
        each.add_argument("checkout", type=Path)
        each.add_argument("--only", default="", metavar="PAGE", help="pages whose name has this")
    running.add_argument("out", type=Path, help="a folder that is not there yet")
    running.add_argument("--lines", type=Path, metavar="OUT", help="lines of an earlier run")
    running.add_argument("--inputs", type=Path, help="checkout of datasets and examples")
    running.add_argument("--programs", type=Path, help="folder of zebro-lab, python …")
    running.add_argument("--limit", type=float, default=1200.0, help="longest run of a line [s]")
    comparing = tasks.add_parser("compare", help="compare two runs of the same lines")
    comparing.add_argument("first", type=Path)
    comparing.add_argument("second", type=Path)
    return parser.parse_args(arguments)


def main(arguments: list[str]) -> int:
    """Do what is asked; return 1 where a comparison found a difference."""
    asked = parse(arguments)
    if asked.task == "compare":
        compared = compare(asked.first, asked.second)
        print_comparison(compared)
        return int(any(each.faults for each in compared))
    of_run = asked.task == "run" and asked.lines
    found = [o.line for o in read_outcomes(asked.lines)] if of_run else find_lines(asked.checkout)
    lines = [line for line in found if asked.only in line.page]
    if asked.task == "list":
        for line in lines:
            what = f"left out: {line.note}" if not line.command else line.note
            print(f"{line.page}: {line.text}" + (f"\n    {what}" if what else ""))
        return 0
    out, checkout = asked.out.absolute(), asked.checkout.absolute()
    programs = (asked.programs or checkout / ".venv" / "bin").absolute()
    if not (programs / "zebro-lab").is_file():
        raise SystemExit(f"{programs} has no zebro-lab; name the environment by --programs")
    inputs = (asked.inputs or checkout).absolute()
    run_lines(lines, out, inputs=inputs, programs=programs, limit=asked.limit)
    places = {"PROGRAMS": programs, "INPUTS": inputs, "CHECKOUT": checkout}
    (out / "places.txt").write_text("".join(f"{k}\t{v}\n" for k, v in places.items()))
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
