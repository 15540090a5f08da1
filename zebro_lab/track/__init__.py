# SPDX-License-Identifier: MIT
"""Photographs to a path: camera and floor files, annotations, the track folder."""
