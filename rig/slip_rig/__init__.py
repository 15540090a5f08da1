# SPDX-License-Identifier: MIT
"""The two-disc slip rig: a leg disc pressed on a ground disc, forces and both speeds recorded."""
