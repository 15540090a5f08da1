# SPDX-License-Identifier: MIT
"""Both commands tell the version of the package and its commit."""

from importlib.metadata import version

import pytest
from typer.testing import CliRunner

from zebro_lab.files.provenance import software_commit
from zebro_lab.main import app, slip_app


@pytest.mark.parametrize("program", [app, slip_app])
def test_version_is_that_of_package_and_commit(program):
    ended = CliRunner().invoke(program, ["--version"])
    assert ended.output == f"zebro-lab {version('zebro-lab')}, commit {software_commit()}\n"
