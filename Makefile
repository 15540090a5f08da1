# Every target works alone on a fresh checkout that has python3 (>= 3.11, with venv) and make.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
# Compiled modules are kept: tests start some hundred commands, and each would compile them again.
unexport PYTHONDONTWRITEBYTECODE
# The lowest versions that pyproject.toml allows, in an environment of their own.
LOWEST_PYTHON ?= python3.11
LOWEST := .venv-lowest
LOWEST_STAMP := $(LOWEST)/.installed

.PHONY: demo test test-reference test-lowest test-long check lint types floors bench clean clean-cache help

help: ## list the targets
	@grep -E '^[a-z-]+:.*##' Makefile | sed -E 's/:.*## /\t/' | expand -t 14

$(STAMP): pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "zebro-lab needs Python >= 3.11; found $$($(PYTHON) --version). Try: make PYTHON=python3.12"; exit 1; }
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check "pip>=25.1"
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable . --group dev
	touch $(STAMP)

DEMO := demo
WALK := datasets/walk-sim
DEMO_START := 2020-06-01T12:00:00+00:00
DEMO_RUN := $(DEMO)/data/20200601T120000Z_walk_left-turn

demo: $(STAMP) ## the whole loop on bundled, simulated data: rig and photographs in, report out
	@echo "=== 1 of 6: calibrate the slip of legs from a simulated rig sweep"
	$(BIN)/calibrate-slip datasets/rig-sim --out $(DEMO)/calibration
	@echo "=== 2 of 6: make a run of a simulated walk's leg log and IMU"
	rm -rf $(DEMO)/data
	$(BIN)/zebro-lab import --legs $(WALK)/legs.csv --imu $(WALK)/imu.csv \
	  --robot $(WALK)/robot.toml --label left-turn --start $(DEMO_START) --data $(DEMO)/data
	@echo "=== 3 of 6: track the robot in the walk's simulated photographs"
	$(BIN)/zebro-lab track $(WALK)/photos --camera $(WALK)/camera.toml --floor $(WALK)/floor.toml \
	  --robot $(WALK)/robot.toml --start $(DEMO_START) --run $(DEMO_RUN)
	@echo "=== 4 of 6: predict the walk from its leg angles and the calibrated slip"
	$(BIN)/zebro-lab predict $(DEMO_RUN) --slip $(DEMO)/calibration --robot $(WALK)/robot.toml \
	  --draws 500 --figures --out $(DEMO_RUN)/prediction
	@echo "=== 5 of 6: judge the prediction against the track"
	$(BIN)/zebro-lab validate $(DEMO_RUN)
	@echo "=== 6 of 6: put everything on one page"
	$(BIN)/zebro-lab report $(DEMO_RUN) --calibration $(DEMO)/calibration --out $(DEMO)/report.html \
	  --title "Demonstration: a left turn"
	@echo "open $(DEMO)/report.html in a browser"

# Three processes for two cores: a tenth of the tests wait for simulated devices.
test: $(STAMP) ## the tests, some five minutes on two cores
	$(BIN)/python -m pytest -n 3 --dist worksteal -m "not long"

test-reference: $(STAMP) ## the tests that need reference data (ZEBRO_LAB_SHARED)
	$(BIN)/python -m pytest -n 2 --dist worksteal -m "reference and not long"

$(LOWEST_STAMP): pyproject.toml
	rm -rf $(LOWEST)
	$(LOWEST_PYTHON) -m venv $(LOWEST)
	$(LOWEST)/bin/python -m pip install --quiet --disable-pip-version-check "uv>=0.5"
	$(LOWEST)/bin/uv pip install --quiet --python $(LOWEST)/bin/python --compile-bytecode \
	  --resolution lowest-direct --editable . --group dev
	touch $(LOWEST_STAMP)

test-lowest: $(LOWEST_STAMP) ## the tests with the lowest versions allowed, on Python 3.11
	$(LOWEST)/bin/python -m pytest -n 2 --dist worksteal -m "not long"

# Long tests that watch a clock run alone.
TIMED := tests/long/test_recording.py tests/long/test_experiment_faults.py tests/benchmarks/faults \
  tests/long/test_besieged_run.py tests/zebro_lab/test_stops.py

test-long: $(STAMP) ## coverage and other statistical claims, under an hour on two cores; tables at the end
	$(BIN)/python -m pytest -m long -s --timeout 3600 $(TIMED)
	$(BIN)/python -m pytest -n 2 --dist loadfile -m long -rP --timeout 3600 tests $(TIMED:%=--ignore=%)

check: lint types floors test ## lint, types, import floors, then the tests

lint: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(STAMP)
	$(BIN)/basedpyright

floors: $(STAMP)
	$(BIN)/lint-imports

bench: $(STAMP) ## speed, side by side with a peer in the same run
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --group bench
	$(BIN)/python -m benchmarks.speed.calibration
	$(BIN)/python -m benchmarks.speed.walking
	$(BIN)/python -m benchmarks.speed.tracking

clean-cache: ## remove compiled loops that numba cached
	find model rig tracking zebro_lab -name '*.nb[ic]' -delete

clean: ## remove the environment and what the tools cached
	rm -rf $(VENV) $(LOWEST) .pytest_cache .ruff_cache .import_linter_cache .hypothesis $(DEMO)
