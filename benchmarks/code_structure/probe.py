# SPDX-License-Identifier: MIT
"""Run inside a checkout: count the options of its commands, or the modules that a command runs.

It imports nothing of this package, so that it can run with any checkout on its import path:

python -P probe.py options
python -P probe.py modules COMMAND [ARGUMENT ...]
"""

import importlib
import json
import pkgutil
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from types import FrameType
from typing import Any

PACKAGES = ("zebro_lab", "rig", "tracking", "model")
NOT_COUNTED = {"--help", "--json", "--quiet", "--version", "--install-completion",
               "--show-completion"}  # fmt: skip


def commands(command: Any, name: str = "") -> Iterator[tuple[str, list[str]]]:
    """Yield each command of a click tree with its options, without those that all have."""
    inner = getattr(command, "commands", None)
    if inner is not None:
        for each, child in inner.items():
            yield from commands(child, f"{name} {each}".strip())
        return
    yield (
        name,
        [
            max(param.opts, key=len)
            for param in command.params
            if param.param_type_name == "option" and not NOT_COUNTED.intersection(param.opts)
        ],
    )


def options() -> dict[str, list[str]]:
    """Return the options of every command of `zebro-lab`; `calibrate-slip` is `calibrate`."""
    from typer.main import get_command

    app = importlib.import_module("zebro_lab.main").app
    return dict(commands(get_command(app)))


def modules(arguments: list[str]) -> list[str]:
    """Run a command; return the names of the own modules of which any function ran.

    All modules are imported before, so that a module's own statements do not count. Functions
    that numba compiled are not seen, nor are those that run in other processes.
    """
    for package in PACKAGES:
        root = importlib.import_module(package)
        for found in pkgutil.walk_packages(root.__path__, f"{package}."):
            importlib.import_module(found.name)
    here, ran = str(Path.cwd()), set[str]()

    def profile(frame: FrameType, event: str, _: object) -> None:
        if event == "call" and frame.f_code.co_name != "<module>":
            ran.add(frame.f_code.co_filename)

    main = importlib.import_module("zebro_lab.main").main
    sys.argv = ["zebro-lab", *arguments]
    threading.setprofile(profile)
    sys.setprofile(profile)
    try:
        main()
    except SystemExit as ended:
        if ended.code not in (None, 0):
            raise
    finally:
        sys.setprofile(None)
        threading.setprofile(None)
    own = [Path(file).relative_to(here) for file in ran if file.startswith(here)]
    return sorted(str(path) for path in own if path.parts[0] in PACKAGES)


if __name__ == "__main__":
    asked, *rest = sys.argv[1:]
    result: object = options() if asked == "options" else modules(rest)
    print(json.dumps(result))
