# Two commands do all: `make demo` and `make test`; each sets up what it needs in .venv.
PYTHON ?= python3
DRIVE ?=
BIN := .venv/bin
PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt

.PHONY: demo serve test lint format install peers clean help

help:  ## Show this list
	@grep -hE '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 12

demo: .venv/demo.stamp  ## Two robots recognise each other's places; DRIVE=path for a recorded drive
	$(BIN)/placecell demo $(if $(DRIVE),--drive "$(DRIVE)")

serve: .venv/demo.stamp  ## Keep a service running on http://127.0.0.1:8000
	$(BIN)/placecell serve

test: install  ## All tests, with coverage
	$(BIN)/python -m pytest --hypothesis-profile=ci --cov --cov-report=term

lint: install  ## Check style and types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

format: install  ## Put the code into its form
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

install: .venv/development.stamp  ## What the tests need, torch included

# The demo installs no torch; what builds the two packages is installed first and pinned too.
.venv/demo.stamp: pyproject.toml client/pyproject.toml constraints.txt
	$(PYTHON) -m venv .venv
	$(PIP) hatchling editables
	$(PIP) --no-build-isolation --editable ./client --editable '.[service,town,plots]'
	touch $@

.venv/development.stamp: .venv/demo.stamp
	$(PIP) --no-build-isolation --editable ./client --editable '.[development]'
	touch $@

# What we are compared with pins NumPy and more otherwise than we do.
peers: .venv-peers/stamp  ## The systems to compare with, for 'placecell bench peers'

.venv-peers/stamp: bench/peers/requirements.txt
	$(PYTHON) -m venv .venv-peers
	.venv-peers/bin/python -m pip install --quiet --disable-pip-version-check --requirement $<
	touch $@

clean:  ## Remove the environment and what the tools left
	rm -rf .venv .venv-peers .mypy_cache .pytest_cache .ruff_cache .coverage
