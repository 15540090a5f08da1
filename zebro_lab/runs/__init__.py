# SPDX-License-Identifier: MIT
"""Run folders and what reads them back: lists, exclusion, recorded signals, plots."""
