# SPDX-License-Identifier: MIT
"""Render a report with the Jinja templates of `zebro_lab/report/pages`, with escaping."""

import base64
import hashlib
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from datetime import datetime
from functools import cache, partial
from importlib.metadata import version
from importlib.resources import files
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined, Template
from markupsafe import Markup

from model.bayes.estimate import informed
from model.metrics.scores import coverage_range
from zebro_lab.files.errors import shown
from zebro_lab.files.opening import parsing
from zebro_lab.files.provenance import software_commit
from zebro_lab.files.source_names import is_simulated
from zebro_lab.files.units import shown_unit, unit_symbol
from zebro_lab.report.belonging import belonging
from zebro_lab.report.pictures import Picture, embed
from zebro_lab.report.sources import ReportedRun, ReportPart, Sources
from zebro_lab.runs.manifest import MANIFEST_FILE

ABSENT = Markup("–")


def look_up(document: Mapping[str, Any], keys: tuple[str | int, ...]) -> Any:
    """Return the value at a key path of a nested document; None if a key is missing.

    It is missing too below a value that is neither mapping nor list.

    Args:
        document: Nested mappings and lists.
        keys: Keys and list indices, outermost first.

    >>> look_up({"a": [{"b": 2}]}, ("a", 0, "b"))
    2
    """
    found: Any = document
    for key in keys:
        try:
            found = found[key]
        except (KeyError, IndexError, TypeError):
            return None
    return found


def number(
    document: Mapping[str, Any],
    *keys: str | int,
    file: str,
    scale: float = 1.0,
    digits: int = 3,
    rule: Callable[[float], float] | None = None,
) -> str:
    """Format a number with its origin: `<data value="0.0123" data-file=… data-key=…>12.3</data>`.

    Args:
        document: Content of the file.
        keys: Key path of the number in the document.
        file: Name of the file, for `data-file`.
        scale: Factor from the file's unit to the shown unit.
        digits: Number of significant digits shown; integers are not rounded.
        rule: What is shown of the number, before it is scaled; None for the number itself.

    Returns:
        The HTML element; a dash if the value is missing, not a number, or not finite.
    """
    value = look_up(document, keys)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        return ABSENT
    # A JSON pointer (RFC 6901), in which "~" and "/" within a key are escaped.
    path = "/".join(str(key).replace("~", "~0").replace("/", "~1") for key in keys)
    shown = value if rule is None else rule(value)
    shown = shown if scale == 1 else scale * shown  # a count stays an integer
    return Markup('<data value="{}" data-file="{}" data-key="/{}">{}</data>').format(
        repr(value), file, path, spelled(shown, digits)
    )


def spelled(value: float, digits: int = 3) -> str:
    """Format a number with a given number of significant digits; integers are not rounded.

    Args:
        value: Number to format.
        digits: Number of significant digits.

    >>> spelled(0.02084), spelled(1721.4, 4), spelled(62000), spelled(1e-7)
    ('0.0208', '1721', '62000', '1e-07')
    """
    if isinstance(value, int):
        return str(value)
    return f"{float(f'{value:.{digits}g}'):.15g}"


PAGES = "pages"
TEMPLATE, STYLE = "report.html.jinja", "report.css"


LEVELS = (50, 90, 95)  # per cent
STATES = ("x", "y", "yaw")


@dataclass(frozen=True)
class OutOfRange:
    """A share of tracked values inside a band that is out of its binomial range.

    Attributes:
        level: Probability of the band [%].
        state: "x", "y" or "yaw".
        key: Key of the share in the metrics of a prediction.
        low: Lowest share of the central 95 % range for independent poses [%].
        high: Highest share of that range [%].
    """

    level: int
    state: str
    key: str
    low: float
    high: float


def out_of_range(row: Mapping[str, object]) -> Iterator[OutOfRange]:
    """Yield each coverage of a prediction that is outside of `model.metrics.coverage_range`.

    Args:
        row: Metrics of the prediction as in a validation's manifest, with `poses`; those that are
            missing or no number are passed over.
    """
    poses = _finite(row.get("poses"))
    if poses is None or poses < 1:
        return
    for level in LEVELS:
        low, high = coverage_range(level / 100, int(poses))
        for state in STATES:
            key = f"coverage{level}_{state}"
            share = _finite(row.get(key))
            if share is not None and not low - 1e-9 <= share <= high + 1e-9:
                yield OutOfRange(level, state, key, 100 * low, 100 * high)


def _finite(value: object) -> float | None:
    """Return a finite number as float; None for anything else, a bool included."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        return None
    return float(value)


@dataclass(frozen=True)
class Column:
    """A column of the table of errors: heading, metric in the manifest, factor to shown unit."""

    title: str
    key: str
    scale: float = 1.0


ERROR_COLUMNS = (
    Column("error, rms [mm]", "ate_m", 1e3),
    Column("of path [%]", "ate_of_length", 1e2),
    Column("x [mm]", "x_rms_m", 1e3),
    Column("y [mm]", "y_rms_m", 1e3),
    Column("along [mm]", "along_rms_m", 1e3),
    Column("across [mm]", "cross_rms_m", 1e3),
    Column("yaw [deg]", "yaw_rms_deg"),
    Column("end [mm]", "final_m", 1e3),
    Column("aligned [mm]", "ate_aligned_m", 1e3),
    Column("radius [m]", "radius_m"),
    Column("tracked [m]", "radius_tracked_m"),
    Column("yaw rate [deg/s]", "yaw_rate_deg_s"),
    Column("CRPS x [mm]", "crps_x_m", 1e3),
    Column("CRPS y [mm]", "crps_y_m", 1e3),
    Column("energy score [mm]", "energy_m", 1e3),
)


def render_report(sources: Sources, *, title: str, made: datetime) -> str:
    """Render the report as HTML, with control characters escaped.

    Args:
        sources: Results to show.
        title: Title of the report.
        made: Date and time shown in the report.

    Returns:
        Self-contained HTML, with pictures and style embedded.

    Raises:
        DataError: A manifest or slip.toml lacks a value that is shown, or a picture is neither PNG
            nor SVG, or too large.
    """
    style = (files("zebro_lab.report") / PAGES / STYLE).read_text(encoding="utf-8")
    template = _template()
    with parsing(
        sources.data, "cannot be reported on: a manifest or slip.toml lacks what is shown",
        advice="run calibrate, track, predict and validate again, as far as they were run",
    ):  # fmt: skip
        page = template.render(
            sources=sources,
            title=title,
            made=made.isoformat(timespec="seconds"),
            version=version("zebro-lab"),
            commit=software_commit(),
            belonging=belonging(sources),
            simulated=sources.simulated,
            css=Markup(style),  # noqa: S704 - our own file
            policy=_policy(style),
            judged=list(_judged(sources)),
            coverage_out_of_range=_coverage_out_of_range,
            error_columns=ERROR_COLUMNS,
            number=_number,
            whole=partial(_number, rule=round),
            informed=partial(_number, scale=100.0, rule=informed),
            unit_symbol=unit_symbol,
            shown_unit=shown_unit,
            breakable=_breakable,
            count=_count,
            pictures=_pictures,
        )
    # Jinja escapes markup; control characters in text from files are escaped here, for all of them.
    return "\n".join(map(shown, page.split("\n")))


@cache
def _template() -> Template:
    """Load the page's template; it escapes values and raises for names that are missing."""
    pages = Environment(
        loader=PackageLoader("zebro_lab.report", PAGES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return pages.get_template(TEMPLATE)


def _policy(style: str) -> str:
    """Return the content security policy: only this style (by hash) and `data:` pictures."""
    digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode("ascii")
    return (
        f"default-src 'none'; img-src data:; style-src 'sha256-{digest}'; base-uri 'none'; "
        "form-action 'none'"
    )


def _number(part: ReportPart, file: str, *keys: str | int, **spelling: Any) -> str:
    """Format a number of a result as `number` does, for the templates; a dash if it is missing.

    Args:
        part: The result, which is not missing.
        file: Name of one of its documents, such as `manifest.json`.
        keys: Key path of the number in that document.
        spelling: Arguments `scale`, `digits` and `rule` of `number`.

    Raises:
        KeyError: The part has no such document; `render_report` converts it into a `DataError`.
    """
    return number(part.documents[file], *keys, file=f"{part.folder}/{file}", **spelling)


def _breakable(path: object) -> Markup:
    """Return a path that may be broken behind its slashes, and nowhere else."""
    return Markup("/<wbr>").join(str(path).split("/"))


def _count(run: ReportedRun, *keys: str) -> str:
    """Format a number of samples in a run's manifest, by its key path; a dash if it has none."""
    return number(run.recorded, *keys, file=f"{run.folder}/{MANIFEST_FILE}")


def _pictures(part: ReportPart) -> list[Picture]:
    """Embed the pictures of a part, marked as simulated if its source is."""
    simulated = is_simulated(part.source)
    return [embed(file, stage=part.name, simulated=simulated) for file in part.pictures]


def _coverage_out_of_range(part: ReportPart, name: str) -> list[OutOfRange]:
    """Return the coverages of the prediction of walk `name` that `out_of_range` yields, maybe none.

    Raises:
        KeyError: The manifest has no such walk; `render_report` converts it into a `DataError`.
    """
    return list(out_of_range(part.manifest["runs"][name]["prediction"]))


def _judged(sources: Sources) -> Iterator[tuple[str, ReportPart, str]]:
    """Yield every validated walk: name of the run, validation, and name of the walk in that.

    A run's own validation comes before one of several runs together.
    """
    own = [(run, run.parts["validation"]) for run in sources.runs if "validation" in run.parts]
    for run, part in own:
        for name in part.manifest.get("runs", ()):
            yield run.name, part, name
    alone = {run.name for run, part in own if not part.missing}
    together = sources.together
    if together is not None:
        for name in together.manifest.get("runs", ()):
            if name not in alone:
                yield name, together, name
