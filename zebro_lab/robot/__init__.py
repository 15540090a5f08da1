# SPDX-License-Identifier: MIT
"""Read robot.toml, leg logs and IMU logs; parse markers and gaits of a command line."""
