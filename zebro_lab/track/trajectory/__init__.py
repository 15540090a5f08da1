# SPDX-License-Identifier: MIT
"""Trajectories of other programs: TUM, KITTI, EuRoC and tables, in space and in a plane."""
