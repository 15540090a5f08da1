# SPDX-License-Identifier: MIT
"""Parse a prior that a person states, such as `friction = 0.40 ± 0.05`."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from model.bayes.priors import LogNormal, Normal, Prior, Truncated, Uniform
from model.similar_name import nearest
from model.slip.law import Parameter
from zebro_lab.files.errors import SettingsError, UnitError
from zebro_lab.files.units import factor_to_si

EXPECTED_PRIOR: Final = (
    '"NAME = MEAN ± SD" (or +/-), "NAME ~ lognormal(MEDIAN, SPREAD)" or "NAME ~ uniform(LOW, HIGH)"'
)
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_GAUSSIAN = re.compile(
    rf"\s*([\w/]+)\s*=\s*({_NUMBER})\s*(?:±|\+/-|\+-)\s*({_NUMBER})\s*(\S.*?)?\s*"
)
_FAMILY = re.compile(
    rf"\s*([\w/]+)\s*~\s*(\w+)\s*\(\s*({_NUMBER})\s*,\s*({_NUMBER})\s*\)\s*(\S.*?)?\s*"
)
_FAMILIES = ("normal", "lognormal", "uniform")
_FAR = 6.0  # standard deviations from a bound, beyond which a Gaussian need not be cut off


@dataclass(frozen=True)
class StatedPrior:
    """A prior as stated, before its parameter is known to belong to a law.

    Attributes:
        name: Name of the parameter, or its symbol.
        family: "normal", "lognormal" or "uniform".
        first: Mean, median or lower end, in `unit`.
        second: Standard deviation; spread of the logarithm [-]; or upper end.
        unit: Unit of the numbers; empty for SI.
        text: The whole as stated.
    """

    name: str
    family: str
    first: float
    second: float
    unit: str
    text: str

    def prior(self, parameter: Parameter, key: str, file: Path | None = None) -> Prior:
        """Return the prior of a parameter, in SI.

        A lognormal prior is that of the distance from the parameter's lower bound. A Gaussian is
        cut off at the bounds if one of them is within `_FAR` standard deviations of its mean.

        Args:
            parameter: The parameter.
            key: Option or key that it was stated by, for messages.
            file: File that it was stated in, for messages.

        Raises:
            SettingsError: The unit does not fit; the mean, median or an end lies outside the
                parameter's bounds; or the prior is lognormal and the lower bound is negative or the
                median.
        """
        try:
            factor = factor_to_si(self.unit, parameter.unit) if self.unit else 1.0
        except UnitError as error:
            raise SettingsError(f"'{self.text}': {error}", file=file, key=key) from error
        first, second = factor * self.first, factor * self.second
        low, high = parameter.lower, parameter.upper
        ends = (first, second) if self.family == "uniform" else (first,)
        inside = all(low <= end <= high for end in ends)
        if not inside or (self.family == "lognormal" and not 0 <= low < first):
            raise SettingsError(
                f"'{self.text}' lies outside the bounds of {parameter.name}, {low:g} to {high:g} "
                f"{parameter.unit}",
                file=file,
                key=key,
            )
        if self.family == "uniform":
            return Uniform(first, second)
        if self.family == "lognormal":
            return LogNormal(first - low, self.second, low)
        if min(first - low, high - first) > _FAR * second:
            return Normal(first, second)
        return Truncated(first, second, low, high)


def parse_prior(text: str, *, key: str, file: Path | None = None) -> StatedPrior:
    """Parse the text of a prior.

    Args:
        text: `NAME = MEAN ± SD`, or `NAME ~ FAMILY(A, B)`; a unit may follow.
        key: Option or key that it was read from, for the message.
        file: File that it was read from, for the message.

    Raises:
        SettingsError: The text has another form, the family is unknown, a spread is not positive,
            or the ends of a uniform prior are not in order.

    >>> parse_prior("friction = 0.40 +/- 0.05", key="--prior").second
    0.05
    """
    if found := _GAUSSIAN.fullmatch(text):
        name, first, second, unit = found.groups()
        family = "normal"
    elif found := _FAMILY.fullmatch(text):
        name, family, first, second, unit = found.groups()
    else:
        raise SettingsError(f"'{text}' is no prior; expected {EXPECTED_PRIOR}", file=file, key=key)
    if family not in _FAMILIES:
        raise SettingsError(
            f"'{text}': unknown family '{family}'; {nearest(family, _FAMILIES)}", file=file, key=key
        )
    a, b = float(first), float(second)
    if not (math.isfinite(a) and math.isfinite(b) and (a < b if family == "uniform" else b > 0)):
        needed = "LOW below HIGH" if family == "uniform" else "a standard deviation above 0"
        raise SettingsError(f"'{text}': expected {needed}", file=file, key=key)
    return StatedPrior(name, family, a, b, unit or "", text.strip())


def named_priors(
    stated: Sequence[StatedPrior],
    parameters: Sequence[Parameter],
    *,
    key: str,
    file: Path | None = None,
) -> Mapping[str, tuple[Prior, str]]:
    """Return the prior of each parameter that was stated, with its text, by the parameter's name.

    Args:
        stated: Priors as stated, by name or symbol.
        parameters: Parameters of the laws that may be fitted, and of the measurement.
        key: Option or section that they were stated by, for messages.
        file: File that they were stated in, for messages.

    Raises:
        SettingsError: No parameter has this name or symbol, one is stated twice, its unit does not
            fit, or it lies outside the parameter's bounds.
    """
    known = {p.name: p for p in parameters}
    symbols = {p.symbol: p for p in parameters}
    found: dict[str, tuple[Prior, str]] = {}
    for each in stated:
        parameter = known.get(each.name) or symbols.get(each.name)
        if parameter is None:
            advice = nearest(each.name, list(known))
            raise SettingsError(
                f"'{each.text}': unknown parameter '{each.name}'; {advice}",
                file=file,
                key=key,
            )
        if parameter.name in found:
            raise SettingsError(
                f"{parameter.name} is stated twice, '{found[parameter.name][1]}' and '{each.text}'",
                file=file,
                key=key,
            )
        found[parameter.name] = each.prior(parameter, key, file), each.text
    return found
