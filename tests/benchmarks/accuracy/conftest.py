# SPDX-License-Identifier: MIT
"""Collect tests of the rigid-body engine only where MuJoCo (group bench) is installed."""

from importlib.util import find_spec

ENGINE = ["rigid_engine", "test_engine_ground.py", "test_engine_programs.py"]

collect_ignore = ENGINE if find_spec("mujoco") is None else []
