# SPDX-License-Identifier: MIT
"""Check Python, the required packages with their versions, and where modules are imported from."""

import json
import platform
import shutil
import tomllib
from collections.abc import Iterator, Sequence
from importlib import util
from importlib.machinery import PathFinder
from importlib.metadata import (
    Distribution,
    PackageNotFoundError,
    distribution,
    distributions,
    packages_distributions,
    requires,
)
from pathlib import Path
from typing import Final
from urllib.parse import unquote, urlsplit

from packaging.requirements import Requirement

from zebro_lab.recording.doctor.finding import Finding, Grade

HOME: Final = Path(__file__).parents[3]
"""Folder of the packages in use: a checkout, or `site-packages`."""
NAME: Final = "zebro-lab"
LEAST_PYTHON: Final = (3, 11)
OURS: Final = ("zebro_lab", "rig", "tracking", "model")
FOREIGN: Final = {"serial": "pyserial", "can": "python-can", "cv2": "opencv-python-headless"}
"""Modules whose names several packages use, and the package that each must come from."""
OPTIONAL_PROGRAMS: Final = {
    "ffmpeg": "animations (`--animate`) as mp4; without ffmpeg they are written as gif",
    "heif-convert": "converting HEIC photographs to JPEG by hand, for `track`",
}
OPTIONAL_PACKAGES: Final = {
    "evo": "path errors computed by the program evo from track.tum",
    "mujoco": "regenerating datasets/walk-sim, and for `make bench`",
    "numpyro": "the comparison of samplers in `make bench`",
}


def check_python(version: tuple[int, ...]) -> Finding:
    """Check a Python version against `LEAST_PYTHON`; BROKEN if older."""
    found = f"{'.'.join(map(str, version))} on {platform.system()} {platform.machine()}"
    if version[:2] < LEAST_PYTHON:
        wanted = ".".join(map(str, LEAST_PYTHON))
        return Finding(Grade.BROKEN, "python", f"{found}; zebro-lab needs Python {wanted} or later")
    return Finding(Grade.OK, "python", found)


def check_requirements(needed: Sequence[str]) -> Iterator[Finding]:
    """Check that every required package is installed in a compatible version.

    Yields BROKEN for each that is not, then one OK finding that lists the others.

    Args:
        needed: Requirements in the format of package metadata; those of extras are skipped.
    """
    fitting = []
    for requirement in map(Requirement, needed):
        if requirement.marker is not None and not requirement.marker.evaluate({"extra": ""}):
            continue
        found = _version(requirement.name)
        if found is None:
            yield Finding(Grade.BROKEN, requirement.name,
                          f"not installed; run `pip install '{requirement}'`")  # fmt: skip
        elif not requirement.specifier.contains(found, prereleases=True):
            yield Finding(Grade.BROKEN, requirement.name,
                          f"found version {found}, expected {requirement.specifier}; run "
                          f"`pip install '{requirement}'`")  # fmt: skip
        else:
            fitting.append(f"{requirement.name} {found}")
    yield Finding(Grade.OK, "packages", ", ".join(fitting))


def needed_packages(home: Path = HOME) -> tuple[str, ...]:
    """Return the requirements of zebro-lab, those of extras with their marker.

    Of a checkout they are those of its `pyproject.toml`, which may be newer than its installation;
    else those of the installed package's metadata, empty where it is not installed.

    Args:
        home: Folder of zebro-lab's packages.
    """
    project = home / "pyproject.toml"
    text = project.read_text(encoding="utf-8") if project.is_file() else ""
    table = tomllib.loads(text).get("project", {})
    if table.get("name") != NAME:  # none, or one that another package left in site-packages
        return tuple(requires(NAME) or ()) if _version(NAME) else ()
    extras = table.get("optional-dependencies", {}).items()
    return (
        *table["dependencies"],
        *(f"{each}; extra == '{extra}'" for extra, those in extras for each in those),
    )


def check_installations(home: Path, search: Sequence[str]) -> Iterator[Finding]:
    """Check that zebro-lab is installed once: OK for the one in use, NOTE for each other.

    Args:
        home: Folder of the packages in use.
        search: Search path of modules.
    """
    what, used = f"package {NAME}", home.resolve()
    installed = {_home_of(found).resolve(): found.version for found in
                 distributions(name=NAME, path=list(search))}  # fmt: skip
    version = installed.pop(used, None)
    copies = {Path(place or ".").resolve() for place in search} - {used}
    others = {
        *installed,
        *(copy for copy in copies if (copy / "zebro_lab" / "__init__.py").is_file()),
    }
    if version is None:
        yield Finding(Grade.NOTE, what, f"{used} is used but not installed; run "
                      f"`pip install --editable {used}`, or install it anew")  # fmt: skip
    else:
        yield Finding(Grade.OK, what, f"version {version} from {used}")
    for other in sorted(others):
        yield Finding(
            Grade.NOTE, what,
            f"a second one is in {other}, and the one from {used} is used; run `pip uninstall "
            f"{NAME}` where it is not wanted, or remove its folder from PYTHONPATH",
        )  # fmt: skip


def check_shadows(folder: Path, search: Sequence[str]) -> Iterator[Finding]:
    """Check that `OURS` and `FOREIGN` modules are not shadowed: OK or BROKEN for each.

    Also BROKEN if another package provides a `FOREIGN` one, NOTE for each shadow in `folder`.

    Args:
        folder: Working folder, which `python` puts first on the search path.
        search: Search path of modules.
    """
    for module in OURS:
        yield _from(module, HOME / module, search, of=NAME)
    providers = packages_distributions()
    for module, package in FOREIGN.items():
        if (installed := _version(package)) is not None:
            place = Path(str(distribution(package).locate_file(module)))
            yield _from(module, place, search, of=f"{package} {installed}")
        others = sorted(set(providers.get(module, ())) - {package})
        if others:
            yield Finding(
                Grade.BROKEN, f"module {module}",
                f"is provided by {', '.join(others)}, expected only from {package}; run `pip "
                f"uninstall {' '.join(others)}`, then `pip install --force-reinstall {package}`",
            )  # fmt: skip
    yield from _local_shadows(folder, HOME)


def check_optional() -> Iterator[Finding]:
    """Yield path or version of each optional program and package.

    NOTE with purpose if one is missing, or with the version expected if that is another.
    """
    for program, purpose in OPTIONAL_PROGRAMS.items():
        found = shutil.which(program)
        yield Finding(Grade.OK if found else Grade.NOTE, program,
                      found or f"not found; only needed for {purpose}")  # fmt: skip
    wanted = {each.name: each for each in map(Requirement, needed_packages())}
    for package, purpose in OPTIONAL_PACKAGES.items():
        version, expected = _version(package), wanted.get(package, Requirement(package))
        if version is None:
            yield Finding(Grade.NOTE, package, f"not installed; only needed for {purpose}")
        elif not expected.specifier.contains(version, prereleases=True):
            yield Finding(Grade.NOTE, package, f"found version {version}, expected "
                          f"{expected.specifier}; only needed for {purpose}")  # fmt: skip
        else:
            yield Finding(Grade.OK, package, version)


def _from(module: str, place: Path, search: Sequence[str], *, of: str) -> Finding:
    """Compare the place that Python imports a module from with the one of its package `of`."""
    what, found = f"module {module}", _found(module, search)
    if found is None:
        return Finding(
            Grade.BROKEN, what,
            f"Python finds none, although {of} is installed, which has it; run `pip install "
            f"--force-reinstall {of.split()[0]}`",
        )  # fmt: skip
    if found.resolve().is_relative_to(place.resolve()):
        return Finding(Grade.OK, what, of)
    return Finding(
        Grade.BROKEN, what,
        f"Python imports {found} instead of {place}; rename or remove {found}, take its folder out "
        "of PYTHONPATH, or install zebro-lab into a new virtual environment",
    )  # fmt: skip


def _found(module: str, search: Sequence[str]) -> Path | None:
    """Return the file, or the folder without `__init__.py`, that a module is imported from."""
    spec = PathFinder.find_spec(module, list(search))
    if spec is None:
        spec = util.find_spec(module)  # an editable installation has its own import finder
    if spec is None:
        return None
    place = spec.origin or next(iter(spec.submodule_search_locations or ()), None)
    return None if place is None else Path(place)


def _home_of(found: Distribution) -> Path:
    """Return the folder of an installation's packages: of an editable one, its checkout."""
    origin = json.loads(found.read_text("direct_url.json") or "{}")
    if origin.get("dir_info", {}).get("editable"):
        return Path(unquote(urlsplit(origin["url"]).path))
    return Path(str(found.locate_file("")))


def _local_shadows(folder: Path, home: Path) -> Iterator[Finding]:
    for module in (*OURS, *FOREIGN):
        for place in (folder / f"{module}.py", folder / module):
            ours = module in OURS and place.resolve().is_relative_to(home.resolve())
            shadows = place.is_file() or (place / "__init__.py").is_file()
            if shadows and not ours:
                yield Finding(
                    Grade.NOTE, f"module {module}",
                    f"`python` started in this folder would import {place} instead; rename it",
                )  # fmt: skip


def _version(package: str) -> str | None:
    try:
        return distribution(package).version
    except PackageNotFoundError:
        return None
