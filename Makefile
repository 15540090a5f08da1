# Every target works alone on a fresh checkout that has python3 (>= 3.11, with venv) and make.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed

.PHONY: demo test test-long check lint types floors bench clean clean-cache help

help: ## list the targets
	@grep -E '^[a-z-]+:.*##' Makefile | sed -E 's/:.*## /\t/' | expand -t 14

$(STAMP): pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "zebro-lab needs Python >= 3.11; found $$($(PYTHON) --version). Try: make PYTHON=python3.12"; exit 1; }
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check "pip>=25.1"
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable . --group dev
	touch $(STAMP)

demo: $(STAMP) ## calibrate a bundled, simulated rig sweep and draw its pictures
	$(BIN)/calibrate-slip datasets/rig-sim --out calibration

test: $(STAMP) ## the tests, under ten minutes on two cores
	$(BIN)/python -m pytest -n 2 --dist worksteal -m "not long"

test-long: $(STAMP) ## coverage and other statistical claims; minutes each, tables printed
	$(BIN)/python -m pytest -m long -s --timeout 5400 tests

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
	$(BIN)/python docs/bench.py
	$(BIN)/python docs/bench_walk.py

clean-cache: ## remove compiled loops that numba cached
	find model rig tracking zebro_lab -name '*.nb[ic]' -delete

clean: ## remove the environment and what the tools cached
	rm -rf $(VENV) .pytest_cache .ruff_cache .import_linter_cache .hypothesis calibration
