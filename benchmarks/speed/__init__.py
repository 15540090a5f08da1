# SPDX-License-Identifier: MIT
"""Time, latency and rates, beside a peer in the same run where there is one."""
