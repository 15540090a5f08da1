# SPDX-License-Identifier: MIT
"""A table of a plan: what a profile's table gives, and series, names and flags."""

from typing import Final

import numpy as np

from rig.profile import Table

LONGEST: Final = 10_000


class PlanTable(Table):
    """One table of a plan, out of which each key is taken exactly once; arguments as `Table`."""

    def table(self, key: str) -> "PlanTable":
        """Take a table; an absent one is empty."""
        inner = super().table(key)
        return PlanTable(inner._entries, file=inner.file, path=inner._path)

    def flag(self, key: str, default: bool) -> bool:  # noqa: FBT001, RUF100 - a value, no switch
        """Take true or false."""
        value = self._take(key, default)
        if not isinstance(value, bool):
            raise self.fault(f"found {value!r}; expected true or false", key)
        return value

    def series(self, key: str) -> tuple[float, ...]:
        """Take a list of numbers, or an even one as a table of `first`, `last` and `count`."""
        value = self._take(key, None)
        if isinstance(value, dict):
            return self._even(PlanTable(value, file=self.file, path=f"{self._path}.{key}"))
        if not isinstance(value, list) or not 1 <= len(value) <= LONGEST:
            raise self.fault(
                f"found {value!r}; expected numbers, or {{ first = 0.0, last = 1.0, count = 62 }}",
                key,
            )
        return tuple(self._finite(item, key) for item in value)

    def names(self, key: str, known: tuple[str, ...]) -> tuple[str, ...]:
        """Take a list of known names, each once; an absent one is empty."""
        value = self._take(key, [])
        if not isinstance(value, list) or not all(item in known for item in value):
            raise self.fault(f"found {value!r}; expected a list of {', '.join(known)}", key)
        return tuple(dict.fromkeys(value))

    @staticmethod
    def _even(table: "PlanTable") -> tuple[float, ...]:
        count = table.whole("count", least=2, most=LONGEST)
        values = np.linspace(table.number("first"), table.number("last"), count)
        table.finish()
        return tuple(values.tolist())
