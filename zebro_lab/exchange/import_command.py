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

zebro-lab import --rig sweep.csv --material "POM on steel" --data data

Other names and units of columns are mapped by a columns.toml in the folder of the files, or by
--columns FILE. For several files it has the sections [legs.columns], [imu.columns],
[track.columns] and [rig.columns]; see docs/formats.md.
"""


@request_command()
def import_files(request: ImportRequest, output: Output = TEXT) -> None:
    """Convert files from other software to run folders in DIR: run.json, log.mcap, track/."""
    from zebro_lab.exchange.import_stage import import_run

    with output.progress() as watcher:
        imported = import_run(request, watcher)
    output.say(*imported.notes)
    for folder, manifest in imported.manifests.items():
        simulated = "SIMULATED " if is_simulated(manifest.source) else ""
        counts = ", ".join(f"{count} {topic}" for topic, count in manifest.streams.items())
        held = f"samples: {counts}" if counts else "a track alone"
        output.say(f"{simulated}source {manifest.source}, {held}; wrote {folder}")
    runs = [
        {"folder": folder, "source": manifest.source, "samples": dict(manifest.streams)}
        for folder, manifest in imported.manifests.items()
    ]
    simulated = any(is_simulated(manifest.source) for manifest in imported.manifests.values())
    content = {"simulated": simulated, "runs": runs, "notes": list(imported.notes)}
    output.document("import", content)
