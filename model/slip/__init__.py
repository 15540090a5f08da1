# SPDX-License-Identifier: MIT
"""Slip laws, slip-ratio definitions and the curve that carries both."""

from model.slip.definition import SlipDefinition, convert_slip, require_definition, slip_ratio
from model.slip.law import Parameter, SlipLaw
from model.slip.magic_formula import MagicFormula, magic_formula

__all__ = [
    "MagicFormula",
    "Parameter",
    "SlipDefinition",
    "SlipLaw",
    "convert_slip",
    "magic_formula",
    "require_definition",
    "slip_ratio",
]
