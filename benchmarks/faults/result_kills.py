# SPDX-License-Identifier: MIT
"""Kill processes that replace a result, at random instants, and count what is left on disk.

    python -m benchmarks.faults.result_kills --kills 100 --seed 1

Each child process replaces a result beside which somebody keeps a file, again and again; it is
killed with SIGKILL after a random time. What a reader then finds must be one whole result, of
before or after, and the file. The table says in which state the kill left the folder.
"""

import argparse
import json
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from zebro_lab.files.provenance import file_hash
from zebro_lab.files.replacement import previous_of, recover
from zebro_lab.files.result_folder import MANIFEST, ResultKind, result_folder

KIND = ResultKind("kill-trial", "result_kills", ("numbers.bin", "more.bin"))
NOTES = "notes.txt"
SIZE = 200_000
LONGEST = 0.25
"""Longest time that a writer lives after its first replacement [s]."""


def write(out: Path, number: int) -> None:
    """Write a result whose files all say its number."""
    with result_folder(out, KIND, content={"number": number}) as draft:
        for name in KIND.names:
            (draft / name).write_bytes(number.to_bytes(4, "big") * (SIZE // 4))


def write_for_ever(out: Path) -> None:
    """Replace a result until the process is killed, after a first line on standard output."""
    number = int(json.loads((out / MANIFEST).read_text())["number"])
    sys.stdout.write("writing\n")
    sys.stdout.flush()
    while True:
        number += 1
        write(out, number)


def state_of(out: Path) -> str:
    """Name what a kill left."""
    if not out.exists():
        return "previous alone"
    return "both" if previous_of(out).exists() else "result alone"


def is_whole(out: Path) -> bool:
    """Tell whether a folder holds one result, all of it, and the file of somebody else."""
    manifest = json.loads((out / MANIFEST).read_text())
    hashes = {name: file_hash(out / name) for name in KIND.names}
    number = int(manifest["number"]).to_bytes(4, "big")
    return (
        manifest["outputs"] == hashes
        and all((out / name).read_bytes()[:4] == number for name in KIND.names)
        and (out / NOTES).read_text() == "mine"
        and {path.name for path in out.iterdir()} == {*KIND.names, MANIFEST, NOTES}
    )


def kill_once(out: Path, after: float) -> str:
    """Start a writer, kill it, and return the state it left."""
    child = subprocess.Popen(
        [sys.executable, "-m", "benchmarks.faults.result_kills", "--write", str(out)],
        stdout=subprocess.PIPE,
    )
    with child:
        if child.stdout is not None:
            child.stdout.readline()
        time.sleep(after)
        child.send_signal(signal.SIGKILL)
    return state_of(out)


def trial(kills: int, seed: int) -> Counter[str]:
    """Kill so many writers of one result; count states, and results that were not whole."""
    rng, found = random.Random(seed), Counter[str]()  # noqa: S311 - no secrets here
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "result"
        write(out, 0)
        (out / NOTES).write_text("mine")
        for _ in range(kills):
            found[kill_once(out, rng.uniform(0, LONGEST))] += 1
            recover(out)
            found["not whole"] += not is_whole(out)
        write(out, 0)
        found["left beside"] += len(list(Path(folder).iterdir())) - 1
    return found


def main() -> None:
    """Run the trial and print its table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--write", type=Path, help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.write is not None:
        write_for_ever(asked.write)
    found = trial(asked.kills, asked.seed)
    lines = [f"{asked.kills} kills, seed {asked.seed}", "| left by the kill | times |", "|---|---|"]
    lines += [f"| {name} | {found[name]} |" for name in
              ("result alone", "both", "previous alone", "not whole", "left beside")]  # fmt: skip
    sys.stdout.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
