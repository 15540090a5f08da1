# SPDX-License-Identifier: MIT
"""MCAP logs: ROS 2 messages (CDR), reading as far as a log is whole, writing."""
