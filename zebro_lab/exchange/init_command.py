# SPDX-License-Identifier: MIT
"""`zebro-lab init FILE`: write a `columns.toml` template from a table's header."""

from pathlib import Path
from typing import Annotated

import typer

from zebro_lab.terminal.messages import say


def init(
    file: Annotated[Path, typer.Argument(help="CSV or Parquet file whose header is read.")],
    force: Annotated[
        bool, typer.Option("--force", help="Replace an existing columns.toml.")
    ] = False,
) -> None:
    """Write a commented columns.toml to the folder of FILE, guessed from its header."""
    from zebro_lab.exchange.init_stage import write_columns_template
    from zebro_lab.tables.columns import CANONICAL, read_columns

    target = write_columns_template(file, force=force)
    columns = read_columns(target)
    say(f"wrote {target}")
    for name, mapped in columns.columns.items():
        sign = ", sign reversed" if mapped.factor < 0 else ""
        unit = f" in {mapped.unit}" if CANONICAL[name].unit not in (None, "dimensionless") else ""
        say(f"  {name:<15} from '{mapped.name}'{unit}{sign}")
    for advice in _to_check(set(columns.columns)):
        say(f"please check: {advice}")


def _to_check(found: set[str]) -> list[str]:
    """Return advice on what a header does not show; `found` holds the mapped canonical columns."""
    advice = ["the names, units and signs above; comments in columns.toml explain them"]
    missing = [name for name in ("normal_force", "traction_force") if name not in found]
    speeds = {"omega_leg", "omega_ground"} <= found
    if not speeds and "slip_ratio" not in found:
        missing.append("slip_ratio (or omega_leg and omega_ground)")
    if missing:
        advice.append(f"no column was found for {', '.join(missing)}: add [columns.NAME] for each")
    if "slip_ratio" in found:
        advice.append("[columns.slip_ratio] needs definition: material, travel or larger")
    if speeds and not {"radius_leg", "radius_ground"} <= found:
        advice.append("[constants] needs radius_leg and radius_ground, except those in a column")
    advice.append("[runs] must state what separates runs, if neither a column 'run' nor files do")
    return advice
