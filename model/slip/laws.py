# SPDX-License-Identifier: MIT
"""The slip laws by name."""

from dataclasses import asdict, fields
from importlib import import_module
from types import MappingProxyType
from typing import Any, Final

from model.errors import DomainError
from model.similar_name import similar_name
from model.slip.law import SlipLaw
from model.slip.sided import SidedLaw
from model.slip_laws import SLIP_LAWS


def _imported(path: str) -> Any:
    """Import a class by its module and name."""
    module, _, name = path.rpartition(".")
    return getattr(import_module(module), name)


LAWS = MappingProxyType({name: _imported(path) for name, path in SLIP_LAWS.items()})
"""Class of every slip law, by the law's name."""
KINETIC: Final = "kinetic"
SIDES: Final = "sides"
TOGETHER: Final = "together"
APART: Final = "apart"


def slip_law(name: str, **options: Any) -> SlipLaw:
    """Create a slip law by name.

    A law is stored as its name and its options: `slip_law(law.name, **law_options(law))` restores
    it.

    Args:
        name: A key of `LAWS`.
        options: Fields of the law's class, such as `curvature` of the Magic Formula; their values
            are not checked. `sides="apart"` makes it a `SidedLaw`.

    Returns:
        The law.

    Raises:
        DomainError: No law has this name, or the law has no option of a given name.

    >>> [parameter.name for parameter in slip_law("brush").parameters]
    ['slip_stiffness', 'friction']
    """
    _require_known("slip law", name, tuple(LAWS))
    if options.get(KINETIC) is False:  # written by versions that had this option of the brush model
        del options[KINETIC]
    known = (*(field.name for field in fields(LAWS[name])), SIDES)
    for option in options:
        _require_known(f"option of the slip law '{name}'", option, known)
    own = {key: value for key, value in options.items() if key != SIDES}
    law: SlipLaw = LAWS[name](**own)
    sides = options.get(SIDES, TOGETHER)
    _require_known(f"value of the option '{SIDES}'", sides, (TOGETHER, APART))
    if sides == APART:
        law = SidedLaw(law)
    return law


def law_options(law: SlipLaw) -> dict[str, Any]:
    """Return the options with which `slip_law` restores a law.

    Args:
        law: A law of a class in `LAWS`, or a `SidedLaw` of one.
    """
    if isinstance(law, SidedLaw):
        return {**law_options(law.law), SIDES: APART}
    return asdict(law)  # pyright: ignore[reportArgumentType]


def _require_known(what: str, found: str, known: tuple[str, ...]) -> None:
    """Raise `DomainError` unless `found` is in `known`; its message suggests the nearest name."""
    if found in known:
        return
    nearest = similar_name(found, known)
    hint = f"; did you mean '{nearest}'?" if nearest else ""
    raise DomainError(f"'{found}' is no {what}; expected one of {', '.join(known)}{hint}")
