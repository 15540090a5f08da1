# SPDX-License-Identifier: MIT
"""Build hook: a wheel or sdist built from a git checkout holds the commit it was built from."""

import runpy
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

ROOM = "zebro_lab/files"


class CommitHook(BuildHookInterface):
    """Add the file that `zebro_lab.files.provenance` reads; nothing is written to the checkout."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Add the file to a build, except to an editable one, which asks git itself.

        Args:
            version: "standard" or "editable".
            build_data: What hatchling builds from; changed in place.
        """
        known = runpy.run_path(str(Path(self.root, ROOM, "provenance.py")))
        already = Path(self.root, ROOM, known["BUILT_FROM"]).exists()  # an unpacked sdist
        commit = known["commit_of"](Path(self.root))
        if version == "editable" or already or commit.startswith(known["UNKNOWN"]):
            return
        self._made = tempfile.TemporaryDirectory()
        file = Path(self._made.name, known["BUILT_FROM"])
        file.write_text(f"{commit}\n", encoding="utf-8")
        build_data["force_include"][str(file)] = f"{ROOM}/{file.name}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Remove the temporary file, when the build has taken it."""
        if hasattr(self, "_made"):
            self._made.cleanup()
