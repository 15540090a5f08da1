# SPDX-License-Identifier: MIT
"""Run every documented command of a checkout, and compare what two checkouts make of them.

python -m benchmarks.documented_commands run CHECKOUT OUT [--lines OUT1] [--programs BIN]
python -m benchmarks.documented_commands compare OUT1 OUT2

`run` makes OUT: a clean folder for each page, what each line printed, and its files. Lines are
those of CHECKOUT, or of an earlier run; the programs are CHECKOUT's own `.venv/bin`.
"""

import argparse
import sys
from pathlib import Path

from benchmarks.documented_commands.comparison import print_comparison
from benchmarks.documented_commands.lines import find_lines
from benchmarks.documented_commands.running import read_outcomes, run_lines


def main(arguments: list[str]) -> int:
    """Do what is asked; return 1 where a comparison found a difference."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    tasks = parser.add_subparsers(dest="task", required=True)
    running = tasks.add_parser("run", help="run the lines of a checkout")
    running.add_argument("checkout", type=Path)
    running.add_argument("--only", default="", metavar="PAGE", help="pages whose name has this")
    running.add_argument("out", type=Path, help="a folder that is not there yet")
    running.add_argument("--lines", type=Path, metavar="OUT", help="lines of an earlier run")
    running.add_argument("--programs", type=Path, help="folder of zebro-lab, python …")
    running.add_argument("--limit", type=float, default=1200.0, help="longest run of a line [s]")
    comparing = tasks.add_parser("compare", help="compare two runs of the same lines")
    comparing.add_argument("first", type=Path)
    comparing.add_argument("second", type=Path)
    asked = parser.parse_args(arguments)
    if asked.task == "compare":
        return int(print_comparison(asked.first, asked.second))
    lines = find_lines(asked.checkout)
    if asked.lines:
        lines = [outcome.line for outcome in read_outcomes(asked.lines)]
    lines = [line for line in lines if asked.only in line.page]
    checkout = asked.checkout.absolute()
    programs = (asked.programs or checkout / ".venv" / "bin").absolute()
    if not (programs / "zebro-lab").is_file():
        raise SystemExit(f"{programs} has no zebro-lab; name the environment by --programs")
    run_lines(lines, asked.out.absolute(), inputs=checkout, programs=programs, limit=asked.limit)
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
