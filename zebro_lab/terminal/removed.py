# SPDX-License-Identifier: MIT
"""What to use instead of commands and options that earlier versions had."""

from typing import Final

REMOVED: Final[dict[str, str]] = {
    "--arc-deg": "Write arc_deg into a robot.toml (zebro-lab init robot.toml --kind robot), and "
    "give it by --robot.",
    "--automaton": "The model thesis takes the rule of its listing for tripods, and contact "
    "detection for other gaits; --thesis text takes Table 3-1's rule.",
    "--contacts-least": "States shorter than 10 ms are joined to the next; path.csv has them.",
    "--start-sd": "Paths of draws.npz start at the origin; validate starts each from the first "
    "tracked pose, with its covariance.",
    "--switch-at": "Legs of the model thesis change speed at touchdown and lift-off angle, as its "
    "listing has it.",
    "--thesis-every": "thesis.csv has a row every 0.01 s; a longer --dt gives fewer.",
    "--toe": "A leg on its toe has its slip law's traction at infinite slip.",
    "annotate --order": "State the times of photographs in a table: track --times CSV.",
    "calibrate --anisotropy": "Lateral grip and stiffness have a prior of 1 ×/÷ 1.3 each; their "
    "posterior is in walks.toml.",
    "calibrate --block-length": "The length of blocks is chosen from the data.",
    "calibrate --curvature": "One curvature E and a peak that grows with load are compared on "
    "runs left out, and the better is fitted.",
    "calibrate --discrepancy": "No departure from the law is fitted: --law compare finds the law "
    "that predicts best, and mean residuals say where it does not hold.",
    "calibrate --ensembles": "Four independent ensembles are sampled; give --seed for others.",
    "calibrate --gain-sd": "State gain_sd in [load_cell] of columns.toml.",
    "calibrate --noise": "Noise is Gaussian: leave out rows with faults by [rows] keep in "
    "columns.toml, or runs by `zebro-lab exclude`.",
    "calibrate --robot": "Put robot.toml into the folder of each walk.",
    "calibrate --widen": "State wider priors of single parameters by --prior, or carry over the "
    "law alone by --carry law.",
    "calibrate --zero-stability": "State zero_stability in [load_cell] of columns.toml.",
    "camera calibrate --workers": "Photographs are searched in two processes; leave the option "
    "out.",
    "compare --seed": "The draws of a comparison are the same each time; leave the option out.",
    "export --to mcap": "A track opens in other tools by track/path.tum; path.csv of a prediction "
    "and the tables of --to csv open anywhere.",
    "import --rig": "calibrate-slip reads the table itself: put it in the folder with a "
    "columns.toml; zebro-lab init FILE writes one.",
    "predict --anisotropy": "A band takes lateral grip and stiffness as 1 ×/÷ 1.3; calibrate-slip "
    "--walks fits them to tracked walks.",
    "predict --thesis": "Leg angles are walked by the listing of the thesis's model; gaits by its "
    "text too, walk --thesis text.",
    "predict --threads": "Draws are walked on all cores of this machine; leave the option out.",
    "rig check --zero-sd": "The zero of the load cell counts with 0.1 N; leave the option out.",
    "rig run --adaptive": "Measure in rounds by rig run, calibrate-slip and rig suggest in turn, "
    "as the shell loop in docs/experiments.md does.",
    "rig run --budget": "State the time of each round by --time of rig suggest "
    "(docs/experiments.md).",
    "rig weigh --weight-sd": "The masses count as known to a thousandth; leave the option out.",
    "sim imu --flip": "Use --drop, which loses frames; "
    "other faults of a line are tested by the tests of rig.",
    "sim imu --garbage": "Use --drop, which loses frames; "
    "other faults of a line are tested by the tests of rig.",
    "sim imu --seed": "A simulated device draws the same random numbers each time; "
    "leave the option out.",
    "sim rig --can": "Open the printed port of the simulated adapter, as PROFILE@slcan:PORT.",
    "sim rig --seed": "A simulated device draws the same random numbers each time; "
    "leave the option out.",
    "sim zebro --can": "Open the printed port of the simulated adapter, as PROFILE@slcan:PORT.",
    "sim zebro --flip": "Use --drop, which loses frames; "
    "other faults of a line are tested by the tests of rig.",
    "sim zebro --garbage": "Use --drop, which loses frames; "
    "other faults of a line are tested by the tests of rig.",
    "sim zebro --jitter": "Record a robot for its jitter; a simulated one samples evenly.",
    "sim zebro --pause": "Give the pauses in the leg angles of --play.",
    "sim zebro --seed": "A simulated device draws the same random numbers each time; "
    "leave the option out.",
    "study": "The fit is tested on simulated experiments by `make test-long` of a checkout "
    "(docs/coverage.md); rig suggest says how narrow further points make an interval.",
    "track --marker": "State the robot's marker as dictionary, id and side in [marker] of "
    "robot.toml.",
    "track --merged": "One picture is read as exposures that were cut out and pasted; leave the "
    "option out, and of an average or of darkest values give the photographs themselves.",
    "track --workers": "Photographs are spread over two processes; leave the option out.",
    "walk --anisotropy": "A band takes lateral grip and stiffness as 1 ×/÷ 1.3; calibrate-slip "
    "--walks fits them to tracked walks.",
    "walk --threads": "Draws are walked on all cores of this machine; leave the option out.",
    "walk --write-robot": "Write a robot.toml by zebro-lab init robot.toml --kind robot.",
}
"""What to use instead, a sentence, by "COMMAND", "COMMAND --option", "COMMAND --option value", or
"--option" of any command.

A command in a group has the group's name before it ("rig run"); `calibrate-slip` is "calibrate".
"""


def replacement(command: str, name: str) -> str | None:
    """Return what to use instead of a command or option of an earlier version; else None.

    Args:
        command: Command that was typed, without the program's name, as `rig run`.
        name: Option, option with its value, or subcommand that it does not know.
    """
    return REMOVED.get(f"{command} {name}".strip(), REMOVED.get(name))
