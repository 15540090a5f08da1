# SPDX-License-Identifier: MIT
"""`zebro-lab import`: convert files from other software to run folders."""

from zebro_lab.exchange.import_request import ImportRequest
from zebro_lab.files.source_names import is_simulated
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command

EPILOG = """
Examples:

zebro-lab import --legs legs.csv --robot robot.toml --data data

zebro-lab import --legs legs.csv --track path.tum --imu imu.csv --robot robot.toml --label circle
--start 2026-03-04T05:06:07+00:00 --data data

zebro-lab import --legs bag --track bag --imu bag --topic /odom --robot robot.toml --data data

zebro-lab import --track KITTI_00.txt --times times.txt --plane xz --data data

Other names and units of columns are mapped by a columns.toml in the folder of the files, or by
--columns FILE. For several files it has the sections [legs.columns], [imu.columns]
and [track.columns]; see docs/formats.md.
"""


@request_command()
def import_files(request: ImportRequest, output: Output = TEXT) -> None:
    """Convert files from other software to a run folder in DIR: run.json, log.mcap, track/."""
    from zebro_lab.exchange.import_stage import import_run

    with output.progress() as watcher:
        imported = import_run(request, watcher)
    output.say(*imported.notes)
    manifest, simulated = imported.manifest, is_simulated(imported.manifest.source)
    counts = ", ".join(f"{count} {topic}" for topic, count in manifest.streams.items())
    held = f"samples: {counts}" if counts else "a track alone"
    said = f"source {manifest.source}, {held}; wrote {imported.folder}"
    output.say(f"SIMULATED {said}" if simulated else said)
    run = {
        "folder": imported.folder, "source": manifest.source, "samples": dict(manifest.streams),
    }  # fmt: skip
    content = {"simulated": simulated, "runs": [run], "notes": list(imported.notes)}
    output.document("import", content)
