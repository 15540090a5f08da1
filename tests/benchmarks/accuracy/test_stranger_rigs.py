# SPDX-License-Identifier: MIT
import json

import numpy as np
import pytest
from scipy.optimize import least_squares

from benchmarks.accuracy.stranger_faults import CAUSES, FAULTS, exponential
from benchmarks.accuracy.stranger_rigs import (
    DESIGNS,
    LAWS,
    RADII,
    brush,
    correlated,
    draw_law,
    magic_formula,
    main,
)
from zebro_lab.tables.columns_file import read_columns
from zebro_lab.tables.rig_table import RigTable, normal_force
from zebro_lab.tables.run_separation import separate_runs
from zebro_lab.tables.slip_source import slip
from zebro_lab.tables.table_files import read_table_file

CURVES = [
    lambda k: magic_formula(k, 15.0, 0.5, 1.5, -0.3),
    lambda k: brush(k, 15.0, 0.5),
    lambda k: exponential(k, 15.0, 0.5),
]


def record(tables):
    """Return slip, normal and traction force, and further columns, of all rows."""
    columns = {
        head: np.concatenate([table[head] for table in tables.values()])
        for head in next(iter(tables.values()))
    }
    fz, fx = columns.pop("Fz [N]"), columns.pop("Fx [N]")
    if "slip" in columns:
        return columns.pop("slip"), fz, fx, columns
    if "SL [%]" in columns:
        return columns.pop("SL [%]") / 100, fz, fx, columns
    leg, ground = columns.pop("n leg [rpm]"), columns.pop("n ground [rpm]")
    return 1 - ground * RADII[1] / (leg * RADII[0]), fz, fx, columns


@pytest.mark.parametrize("curve", CURVES)
def test_curves_have_the_slope_and_peak_they_are_given_and_are_odd(curve):
    slips = np.linspace(0, 5, 5001)
    assert curve(np.array([1e-7]))[0] / 1e-7 == pytest.approx(15, rel=1e-4)
    assert curve(slips).max() == pytest.approx(0.5, rel=1e-4)
    np.testing.assert_allclose(curve(-slips), -curve(slips))


def test_laws_are_drawn_as_stated():
    rng = np.random.default_rng(0)
    draws = [draw_law(rng, "magic_formula") for _ in range(2000)]
    K, mu, C, E = (np.array([law[name] for law in draws]) for name in ("K", "mu", "C", "E"))
    assert np.log([np.median(K), np.median(mu)]) == pytest.approx(np.log([15, 0.5]), abs=0.05)
    assert [np.log(K).std(), np.log(mu).std()] == pytest.approx([0.5, 0.3], rel=0.06)
    assert 1.1 <= C.min() < C.max() <= 1.8
    assert E.min() < -0.5 < E.max() == 0.6
    assert draw_law(rng, "brush").keys() == {"K", "mu"}
    assert sum(design.law == "brush" for design in DESIGNS.values()) == 2


def test_noise_is_correlated_over_the_length_stated():
    noise = correlated(np.random.default_rng(0), (400, 300), 6.0)
    assert noise.std() == pytest.approx(1, rel=0.02)
    lagged = np.mean(noise[:, 6:] * noise[:, :-6])
    assert lagged == pytest.approx(np.exp(-1), abs=0.03)


@pytest.mark.parametrize("name", DESIGNS)
def test_least_squares_recovers_the_law_of_a_record_without_errors(name):
    design = DESIGNS[name]
    tables, _, truth = design(7, errors=0.0)
    k, fz, fx, _ = record(tables)
    fx = fx + design.resistance * fz
    names = ["K", "mu", "C", "E"][: 2 if design.law == "brush" else 4]

    def misfit(values):
        return LAWS[design.law](k, *values) - fx / fz

    fit = least_squares(
        misfit, [10.0, 0.4, 1.4, 0.0][: len(names)], x_scale=[10.0, 0.5, 1, 1][: len(names)]
    )
    means = design.files == "means"  # a mean over the wander is not quite on the curve
    assert fit.x == pytest.approx([truth[name] for name in names], rel=0.05 if means else 1e-4)


@pytest.mark.parametrize("name", DESIGNS)
def test_a_record_differs_from_the_truth_by_the_errors_stated(name):
    design = DESIGNS[name]
    (sound, _, truth), (free, _, _) = design(5), design(5, errors=0.0)
    (k, fz, fx, _), (slips, loads, drag, _) = record(sound), record(free)
    errors = truth["errors"]
    run = np.repeat(np.arange(len(design.loads)), k.size // len(design.loads))
    traction = drag + design.resistance * loads
    expected = (1 + errors["gain_traction"]) * (traction - errors["rolling_resistance"] * loads)
    expected += np.array(errors["zero_traction_N"])[run]
    for left, sd in (
        (fx - expected, errors["noise_N"]),
        (
            fz - (1 + errors["gain_normal"]) * loads - errors["zero_normal_N"],
            design.load_noise * loads.max(),
        ),
        ((1 - k) / (1 - slips) - 1 - errors["radius_ratio"], 1.5 * (design.speed_noise or 1e-6)),
    ):
        assert abs(left.mean()) < sd / 2
        assert left.std() < 1.3 * sd


def test_errors_of_the_rig_spread_as_stated():
    errors = [DESIGNS["c"](seed)[2]["errors"] for seed in range(400)]

    def sd(name):
        return np.std([error[name] for error in errors])

    assert [sd("gain_normal"), sd("gain_traction")] == pytest.approx([0.01, 0.01], rel=0.12)
    assert [sd("radius_ratio"), sd("rolling_resistance")] == pytest.approx([0.003, 0.01], rel=0.12)
    # Zeros are told at 10 N; the mean load of this design is 15 N.
    assert [sd("zero_normal_N"), sd("zero_traction_N")] == pytest.approx([0.075, 0.15], rel=0.12)


def test_every_design_has_the_runs_loads_and_signs_stated():
    runs = {name: len(design.loads) for name, design in DESIGNS.items()}
    loads = {name: len(set(design.loads)) for name, design in DESIGNS.items()}
    assert runs == {"a": 42, "b": 12, "c": 22, "d": 24, "e": 15, "f": 20, "g": 30, "h": 30}
    assert [loads[name] for name in "abdgh"] == [3, 2, 2, 1, 5]
    assert [name for name, design in DESIGNS.items() if "signs" not in design.has] == ["e"]


@pytest.mark.parametrize("name", DESIGNS)
def test_the_folder_is_read_as_what_it_says(name, tmp_path):
    main([str(tmp_path / "rig"), "--design", name, "--seed", "2"])
    tables, _, truth = DESIGNS[name](2)
    k, fz, *_ = record(tables)
    columns = read_columns(tmp_path / "rig" / "columns.toml")
    read = []
    for file in sorted((tmp_path / "rig").glob("*.csv"))[:3]:
        raw = read_table_file(file)
        table = RigTable(raw, columns, np.arange(len(raw)))
        read.append((slip(table).ratio, normal_force(table), separate_runs(table, "rig").index))
    ratio, force = (np.concatenate(column) for column in list(zip(*read, strict=True))[:2])
    np.testing.assert_allclose(ratio, k[: ratio.size], atol=1e-6)
    np.testing.assert_allclose(force, fz[: force.size], rtol=1e-6)
    assert read[0][2].max() + 1 == (
        1 if DESIGNS[name].files == "each" else len(DESIGNS[name].loads)
    )
    assert columns.source == "sim:stranger"
    told = json.loads((tmp_path / "rig" / "truth.json").read_text(encoding="utf-8"))
    assert told.items() >= {"design": name, "seed": 2, "K": truth["K"], "mu": truth["mu"]}.items()


def test_causes_and_sizes_of_faults_are_of_the_closed_list():
    assert len(CAUSES) >= 10
    assert len(FAULTS) >= 20
    assert {cause for fault in FAULTS.values() for cause in fault.right} == set(CAUSES)
    assert all(len(fault.sizes) == 5 for fault in FAULTS.values())


def shown_by(fault):
    """Return the designs with what a fault needs."""
    return [design for design in DESIGNS.values() if FAULTS[fault].needs in design.has]


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_changes_what_it_says_the_more_the_larger_it_is(fault):
    for design in shown_by(fault):
        sound = record(design(4)[0])
        changes = []
        for size in range(1, 6):
            tables, _, truth = design(4, fault, size)
            spoilt = record(tables)
            for name, left, right in zip(("k", "fz", "fx"), sound, spoilt, strict=False):
                if name == FAULTS[fault].changes:
                    changes.append(np.sqrt(np.mean((left - right) ** 2)))
                else:
                    np.testing.assert_allclose(left, right)
            assert truth["right_causes"] == FAULTS[fault].right
        assert changes[4] > changes[0] > 0
        assert changes == sorted(changes)


def test_a_design_refuses_a_fault_that_it_cannot_show():
    for fault, design in (
        ("delay", "a"),
        ("gain_one_way", "e"),
        ("load_late", "g"),
        ("frozen", "d"),
    ):
        with pytest.raises(ValueError, match=fault):
            DESIGNS[design](1, fault, 3)


def test_the_runner_writes_a_fault_and_refuses_what_it_cannot_show(tmp_path):
    out = ["--design", "e", "--seed", "1", "--fault"]
    main([str(tmp_path / "worn"), *out, "wear", "--size", "4"])
    told = json.loads((tmp_path / "worn" / "truth.json").read_text(encoding="utf-8"))
    assert (told["fault"], told["size"], told["value"]) == ("wear", 4, FAULTS["wear"].sizes[3])
    for folder, fault in (("late", "delay"), ("worn", "wear")):
        with pytest.raises(SystemExit):
            main([str(tmp_path / folder), *out, fault])
    assert not (tmp_path / "late").exists()


def test_temperature_has_a_column_that_follows_friction():
    tables, text, _ = DESIGNS["h"](3, "temperature", 5, errors=0.0)
    k, fz, fx, columns = record(tables)
    degrees = columns["temperature [degC]"]
    assert "temperature" not in text
    at_one_slip = np.abs(k - 0.2) < 0.01
    assert np.corrcoef(degrees[at_one_slip], (fx / fz)[at_one_slip])[0, 1] < -0.95
