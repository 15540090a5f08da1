# SPDX-License-Identifier: MIT
"""MCAP logs: read and write ROS 2 messages (CDR), also from truncated or damaged files."""
