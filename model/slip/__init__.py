# SPDX-License-Identifier: MIT
"""Slip laws, slip-ratio definitions and the slip curve, a law with fitted values."""

from model.slip.brush import Brush
from model.slip.coulomb import CoulombStribeck
from model.slip.definition import SlipDefinition, convert_slip, require_definition, slip_ratio
from model.slip.law import Parameter, SlipLaw
from model.slip.laws import LAWS, law_options, slip_law
from model.slip.magic_formula import MagicFormula, magic_formula
from model.slip.read_off import ReadOff, read_off
from model.slip.sided import SidedLaw

__all__ = [
    "LAWS",
    "Brush",
    "CoulombStribeck",
    "MagicFormula",
    "Parameter",
    "ReadOff",
    "SidedLaw",
    "SlipDefinition",
    "SlipLaw",
    "convert_slip",
    "law_options",
    "magic_formula",
    "read_off",
    "require_definition",
    "slip_law",
    "slip_ratio",
]
