# SPDX-License-Identifier: MIT
"""Track a robot in photographs: camera and floor files, annotations, and the track folder."""
