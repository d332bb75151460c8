# Two commands on a fresh machine: `make demo` and `make test`.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
# One thread of BLAS a process: on shared machines more is slower.
export OMP_NUM_THREADS := 1
export OPENBLAS_NUM_THREADS := 1

.PHONY: demo test check lint unit bench docs clean

demo: $(STAMP)
	$(BIN)/mmweaver generate --demo --out demo --overwrite

test: check

check: lint unit  ## exactly what CI runs

lint: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports
	$(BIN)/pyright --pythonpath $(BIN)/python

unit: $(STAMP)
	$(BIN)/pytest -n auto -q

bench: $(STAMP)
	$(BIN)/python benchmarks/physics.py
	$(BIN)/python benchmarks/inr_decode.py
	$(BIN)/python benchmarks/scatterer_decode.py
	$(BIN)/python benchmarks/weaver.py
	$(BIN)/python benchmarks/devices.py
	$(BIN)/python benchmarks/dataset.py

docs: $(STAMP)  ## the site, into build/docs/site
	$(BIN)/pip install --quiet --editable '.[docs]'
	$(BIN)/python tools/build_docs.py

$(STAMP): pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --editable '.[dev]'
	touch $@

clean:
	rm -rf $(VENV) demo out build dist
