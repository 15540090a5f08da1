# SPDX-License-Identifier: MIT
"""SIMULATED slip rigs of other laboratories: eight sound designs, and faults of their records.

    python -m benchmarks.accuracy.stranger_rigs OUT --design a --seed 3 [--fault NAME --size 2]

writes a folder as a laboratory would keep it (CSV, `columns.toml`) and `truth.json`: the law that
was drawn, every error of the rig, and, of a fault, the causes that would be right to name. It is a
trial of `calibrate-slip`, and takes nothing from the model that is on trial but its file format.

Slip ratio (v_leg - v_ground)/v_leg, positive driving with positive traction; K: slope of traction
over load at zero slip; mu: its peak. Arrays have shape (runs, samples).
"""

import argparse
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.accuracy.stranger_faults import FAULTS, Array, Session

Tables = dict[str, dict[str, Array]]  # columns by header, by name of the file
RADII = 0.035, 0.120  # of leg disc and ground disc [m]
SPEED = 0.2  # of the leg disc's rim [m/s]


def magic_formula(slip: Array, K: float, mu: float, C: float, E: float) -> Array:
    """Compute traction over load, mu sin(C atan(Bk - E(Bk - atan Bk))) with B = K/(C mu)."""
    x = K / (C * mu) * slip
    return mu * np.sin(C * np.arctan(x - E * (x - np.arctan(x))))


def brush(slip: Array, K: float, mu: float) -> Array:
    """Compute traction over load of a brush under parabolic pressure, mu (3z - 3z² + z³)."""
    z = np.minimum(K * np.abs(slip) / (3 * mu), 1.0)
    return mu * np.sign(slip) * (3 * z - 3 * z**2 + z**3)


LAWS = {"magic_formula": magic_formula, "brush": brush}


def draw_law(rng: np.random.Generator, name: str) -> dict[str, float]:
    """Draw K and mu [-], of the Magic Formula also the shape C and curvature E."""
    law = {"K": 15 * np.exp(rng.normal(0, 0.5)), "mu": 0.5 * np.exp(rng.normal(0, 0.3))}
    shape = {"C": rng.uniform(1.1, 1.8), "E": min(rng.normal(0, 0.3), 0.6)}
    return law if name == "brush" else law | shape


def correlated(rng: np.random.Generator, shape: tuple[int, int], length: float) -> Array:
    """Draw noise of standard deviation 1 in rows, correlated by exp(-lag/length) along them."""
    keep = np.exp(-1 / length)
    noise = rng.normal(size=shape)
    for n in range(1, shape[1]):
        noise[:, n] = keep * noise[:, n - 1] + np.sqrt(1 - keep**2) * noise[:, n]
    return noise


@dataclass(frozen=True)
class Design:
    """A way to measure. Called with a seed it returns tables, `columns.toml` and the truth.

    `slips` has the set-point (runs, 1) or the sweep (runs, samples) of each run, `loads` [N] the
    load of each. `files` tells whether runs are files, runs in one table, or rows of means.
    Noises are standard deviations: `load_wander` and those of the normal force over the load,
    `speed_noise` of both encoders (without it a column has the slip) over the speed.
    """

    slips: Array
    loads: Array
    law: str = "magic_formula"
    samples: int = 200
    rate: float = 100.0
    files: str = "one"
    resistance: float = 0.0
    load_wander: float = 0.004
    slip_wander: float = 0.0004
    load_noise: float = 0.003
    load_noise_length: float = 3.0
    speed_noise: float | None = None
    percent: bool = False

    @property
    def has(self) -> set[str]:
        """What faults may need."""
        up, down = (np.diff(self.slips) > 0).any(), (np.diff(self.slips) < 0).any()
        had = {"": True, "samples": self.files != "means", "sweeps": up or down}
        had |= {"turns": up and down, "loads": len(set(self.loads)) > 1}
        had |= {"signs": self.slips.min() < 0 < self.slips.max()}
        return {name for name, it in had.items() if it}

    def __call__(
        self, seed: int, fault: str = "", size: int = 1, *, errors: float = 1.0
    ) -> tuple[Tables, str, dict[str, Any]]:
        """Simulate a session; `size` is 1 to 5, `errors` multiplies all that the rig errs by."""
        rng, of_fault = np.random.default_rng(seed), np.random.default_rng([seed, 1])
        values = draw_law(rng, self.law)
        truth: dict[str, Any] = {"law": self.law, **values, "slip_definition": "material"}
        session = self._run(rng, values)
        planted = FAULTS[fault] if fault else None
        value = planted.sizes[size - 1] if planted else 0.0
        if planted:
            if planted.needs not in self.has:
                raise ValueError(f"{fault} needs {planted.needs}; found {sorted(self.has)[1:]}")
            truth |= {"fault": fault, "size": size, "value": value, "right_causes": planted.right}
        if planted and planted.before:
            planted.act(session, value, of_fault)
        truth["errors"] = self._record(session, rng, errors)
        scatter = session.fx.std(axis=1, ddof=1)[:, None]
        if self.files == "means":
            for name in ("t", "k", "fz", "fx"):
                setattr(session, name, getattr(session, name).mean(axis=1, keepdims=True))
        if planted and not planted.before:
            planted.act(session, value, of_fault)
        return self._tables(session, rng, errors, scatter), self._columns(), truth

    def _run(self, rng: np.random.Generator, values: dict[str, float]) -> Session:
        """Let the slip and the load wander about what was set; compute the traction."""

        def law(slip: Array) -> Array:
            return LAWS[self.law](slip, **values)

        shape = len(self.loads), self.samples
        path = np.broadcast_to(self.slips, shape)
        slip = path + self.slip_wander * correlated(rng, shape, self.samples / 10)
        wander = self.load_wander * correlated(rng, shape, self.samples / 4)
        load = self.loads[:, None] * (1 + wander)
        traction, t = load * law(slip), np.broadcast_to(np.arange(self.samples) / self.rate, shape)
        largest = float(np.abs(traction).max())
        return Session(law, values["K"], values["mu"], t, path, slip, load, traction, largest)

    def _record(self, session: Session, rng: np.random.Generator, errors: float) -> dict[str, Any]:
        """Write down slip and forces with gains, zeros, resistance, radii and noise; return them.

        fz = (1 + g_n) F_n + z_n + noise; fx = (1 + g_t) (F - c F_n) + z_run + noise;
        1 - k = (1 - slip) (1 + r), with r the relative error of the ratio of the radii.
        """
        runs, samples = session.slip.shape
        scale = errors * self.loads.mean() / 10  # zeros are told at 10 N
        gain_n, gain_t, ratio, rolling = errors * rng.normal(0, [0.01, 0.01, 0.003, 0.01])
        zero_n, zero_t = rng.normal(0, 0.05 * scale), rng.normal(0, 0.1 * scale, (runs, 1))
        noise, length = errors * rng.uniform(0.003, 0.01) * session.largest, rng.uniform(2, 10)
        rolling += self.resistance
        session.k = 1 - (1 - session.slip) * (1 + ratio)
        of_load = correlated(rng, (runs, samples), self.load_noise_length)
        session.fz = (1 + gain_n) * session.load + zero_n
        session.fz += errors * self.load_noise * self.loads[:, None] * of_load
        session.fx = (1 + gain_t) * (session.traction - rolling * session.load) + zero_t
        session.fx += noise * correlated(rng, (runs, samples), length)
        named = {"gain_normal": gain_n, "gain_traction": gain_t, "radius_ratio": ratio}
        named |= {"rolling_resistance": rolling, "noise_N": noise, "noise_samples": length}
        return {**named, "zero_normal_N": zero_n, "zero_traction_N": zero_t[:, 0].tolist()}

    def _tables(
        self, session: Session, rng: np.random.Generator, errors: float, scatter: Array
    ) -> Tables:
        """Put the record into the laboratory's tables."""
        columns = {"time [s]": session.t, "Fz [N]": session.fz, "Fx [N]": session.fx}
        if self.speed_noise is None:
            columns |= {"SL [%]": 100 * session.k} if self.percent else {"slip": session.k}
        else:
            noise = 1 + errors * self.speed_noise * rng.normal(size=(2, *session.k.shape))
            leg, ground = SPEED * noise / np.reshape(RADII, (2, 1, 1)) * 30 / np.pi
            columns |= {"n leg [rpm]": leg, "n ground [rpm]": ground * (1 - session.k)}
        of_run = {"test": np.arange(1.0, len(self.loads) + 1)[:, None], **session.extra}
        columns |= {head: np.broadcast_to(row, session.k.shape) for head, row in of_run.items()}
        if self.files == "means":
            del columns["time [s]"]
            columns["sd of Fx [N]"] = scatter
        if self.files == "each":
            return {
                f"run_{n + 1:03}.csv": {head: rows[n] for head, rows in columns.items()}
                for n in range(len(self.loads))
            }
        return {"rig.csv": {head: rows.ravel() for head, rows in columns.items()}}

    def _columns(self) -> str:
        """Write `columns.toml`, with the standard deviations of this rig's errors."""
        scale, means = self.loads.mean() / 10, self.files == "means"
        lines = ['source = "sim:stranger"', "[columns]", *["t = 'time [s]'"] * (not means)]
        lines += ["normal_force = 'Fz [N]'", "traction_force = 'Fx [N]'"]
        if self.speed_noise is None:
            lines += ["" if means else "run = 'test'", "[columns.slip_ratio]"]
            lines += [f"name = '{'SL [%]' if self.percent else 'slip'}'", 'definition = "material"']
        else:
            lines += ["omega_leg = 'n leg [rpm]'", "omega_ground = 'n ground [rpm]'"]
            lines += [
                "run = 'test'",
                "[constants]",
                f"radius_leg = {RADII[0]}",
                f"radius_ground = {RADII[1]}",
            ]
        lines += ["[runs]", "each_row = true"] if means else []
        lines += ["[load_cell]", "gain_sd = 0.01", f'bias_sd = "{0.05 * scale:.4g} N"']
        lines += [f'zero_stability = "{0.1 * scale:.4g} N"', "[rig_errors]"]
        lines += ["radius_ratio = 0.003", f"rolling_resistance = {max(self.resistance, 0.01)}"]
        return "\n".join(line for line in lines if line) + "\n"


def set_points(slips: Array, loads: list[float]) -> tuple[Array, Array]:
    """Return slips, shape (runs, 1), and loads of runs with every slip at each load in turn."""
    return np.tile(slips, len(loads))[:, None], np.repeat(loads, len(slips))


def sweeps(rows: list[Array], loads: list[float], runs: int) -> tuple[Array, Array]:
    """Return slips and loads of runs with each sweep at each load in turn, and so on."""
    number = np.arange(runs)
    load = np.array(loads)[number // len(rows) % len(loads)]
    return np.array(rows)[number % len(rows)], load


def both(low: float, high: float, count: int) -> Array:
    """Return `count` slips of each sign, in rising order, that grow by one factor."""
    slips = np.geomspace(low, high, count)
    return np.concatenate([-slips[::-1], slips])


UP, WIDE = np.linspace(-0.25, 0.25, 200), np.linspace(-0.3, 0.3, 400)
BACK = 0.2 * np.abs(np.linspace(-1, 1, 41))
DESIGNS = {
    # One set-point a run, in order; the load wanders.
    "a": Design(*set_points(both(0.01, 0.3, 7), [5.0, 10.0, 15.0]), files="each", speed_noise=0.0,
                load_wander=0.01, slip_wander=0.0008, load_noise_length=6.0),
    # Sweeps of 30 s.
    "b": Design(*sweeps([WIDE], [8.0, 16.0], 12), samples=400, rate=400 / 30),
    # Sweeps from 20 % to 0 and back, of one sign each.
    "c": Design(*sweeps([BACK, -BACK], [10.0, 20.0], 22), samples=41, rate=50.0, percent=True),
    # Means of trials with their scatter.
    "d": Design(*set_points(both(0.01, 0.28, 6), [10.0, 25.0]), "brush", files="means"),
    # Few means of one sign, on a tyre that rolls heavily.
    "e": Design(*set_points(np.geomspace(0.015, 0.25, 5), [20.0, 40.0, 60.0]), samples=400,
                rate=200.0, files="means", resistance=0.08),
    # Sweeps of 2 s, up and down in turn, with noisy encoders.
    "f": Design(*sweeps([UP, -UP], [10.0, 15.0], 20), speed_noise=0.01),
    # Set-points at one load, with a noisy load cell.
    "g": Design(*set_points(both(0.006, 0.26, 15), [10.0]), "brush", rate=500.0,
                speed_noise=0.0, load_noise=0.02, load_noise_length=0.01),
    # A large rig.
    "h": Design(*set_points(both(0.015, 0.2, 3), [800.0, 1600.0, 2400.0, 3200.0, 4000.0]),
                samples=100, rate=50.0, percent=True),
}  # fmt: skip


def main(arguments: list[str] | None = None) -> None:
    """Write the folder of a session and its truth."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("out", type=Path, help="new folder")
    parser.add_argument("--design", choices=DESIGNS, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--fault", choices=FAULTS, default="")
    parser.add_argument("--size", type=int, choices=range(1, 6), default=3)
    given = parser.parse_args(arguments)
    try:
        tables, text, truth = DESIGNS[given.design](given.seed, given.fault, given.size)
        given.out.mkdir(parents=True)
    except (ValueError, FileExistsError) as error:
        parser.error(str(error))
    for name, columns in tables.items():
        rows = np.column_stack(list(columns.values()))
        np.savetxt(given.out / name, rows, "%.8g", ",", header=",".join(columns), comments="")
    (given.out / "columns.toml").write_text(text, encoding="utf-8")
    truth = {"design": given.design, "seed": given.seed, **truth}
    (given.out / "truth.json").write_text(json.dumps(truth, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
