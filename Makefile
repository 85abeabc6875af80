# `make help` lists the targets. Each sets up what it needs in .venv.
PYTHON ?= python3
DRIVE ?=
BIN := .venv/bin
PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check
# Every file that is installed must have a hash that stands in requirements/.
HASHED := $(PIP) --require-hashes --requirement
# pip 26.2 and later do not apply PIP_CONSTRAINT to builds from source; this variable does.
export PIP_BUILD_CONSTRAINT := $(CURDIR)/constraints.txt

# Test workers; each needs some 2 GB of memory. Three keep two cores busy, because many tests wait
# for a process. JOBS=0 runs all in one process.
JOBS ?= 3
# A worker that ends by a hanging test is replaced once; the second time, the run ends.
PYTEST := $(BIN)/python -m pytest --numprocesses $(JOBS) --dist loadfile --no-loadscope-reorder \
	--max-worker-restart 1
# Tests and the services that they start load compiled modules instead of compiling them again.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: demo serve test test-fast test-postgres lint format docs reference page install lock peers clean help

help:  ## Show this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 12

demo: .venv/demo.stamp  ## Run two robots and a service; DRIVE=path uses a recorded drive
	$(BIN)/placecell demo $(if $(DRIVE),--drive "$(DRIVE)")

serve: .venv/demo.stamp  ## Run a service on http://127.0.0.1:8000
	$(BIN)/placecell serve

test: install  ## Run all tests, with coverage; JOBS=N sets the parallel workers
	$(PYTEST) --hypothesis-profile=ci --cov --cov-report=term

FAST := tests/placecell tests/client tests/service
# Folders of the fast tests are in memory where that is possible: they need not survive.
IN_MEMORY := $(if $(wildcard /dev/shm),PYTEST_DEBUG_TEMPROOT=/dev/shm)
test-fast: install  ## Run the fast tests in a minute: core, client, HTTP routes
	$(IN_MEMORY) $(PYTEST) --hypothesis-profile=fast \
		-m "not slow and not integration and not recorded" $(FAST)

test-postgres: install  ## Run the tests of the service on PostgreSQL in place of SQLite
	PLACECELL_TEST_STORE=postgres $(PYTEST) --hypothesis-profile=fast -r s tests/service

lint: install  ## Check style and types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

format: install  ## Format the code
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

docs: .venv-docs/stamp  ## Build the documentation into site/; every warning is an error
	NO_MKDOCS_2_WARNING=1 .venv-docs/bin/python -m mkdocs build --strict --quiet

reference: install  ## Write the generated parts of docs/reference
	$(BIN)/python -m cli.reference

page: page/node_modules/.package-lock.json  ## Build the operator's page into service/page; needs Node
	cd page && npm run --silent check && npm run --silent build

page/node_modules/.package-lock.json: page/package.json page/package-lock.json
	cd page && npm ci --silent

install: .venv/development.stamp  ## Install all that the tests need, torch included

# The demo installs no torch. The installed build tools build the two packages without dependencies.
.venv/demo.stamp: pyproject.toml client/pyproject.toml requirements/build.txt requirements/demo.txt
	$(PYTHON) -m venv .venv
	$(HASHED) requirements/build.txt
	$(HASHED) requirements/demo.txt
	$(PIP) --no-build-isolation --no-deps --editable ./client --editable .
	touch $@

# torch has a build for each kind of machine, so it is pinned by version only.
.venv/development.stamp: .venv/demo.stamp requirements/development.txt constraints.txt
	$(HASHED) requirements/development.txt
	$(PIP) --constraint constraints.txt torch pytorch-metric-learning
	touch $@

lock: .venv-lock/stamp  ## Write requirements/*.txt after constraints.txt has changed
	.venv-lock/bin/python .ci/lock

.venv-lock/stamp:
	$(PYTHON) -m venv .venv-lock
	.venv-lock/bin/python -m pip install --quiet --disable-pip-version-check uv==0.13.9
	touch $@

# The site is built from the source files: nothing of ours is installed.
.venv-docs/stamp: requirements/docs.txt
	$(PYTHON) -m venv .venv-docs
	.venv-docs/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes --requirement requirements/docs.txt
	touch $@

# The compared systems pin other versions of NumPy.
peers: .venv-peers/stamp  ## Install the systems to compare with, for 'placecell bench peers'

.venv-peers/stamp: benchmarks/peers/requirements.txt
	$(PYTHON) -m venv .venv-peers
	.venv-peers/bin/python -m pip install --quiet --disable-pip-version-check --requirement $<
	touch $@

clean:  ## Remove environments, caches and the site
	rm -rf .venv .venv-docs .venv-lock .venv-peers site .mypy_cache .pytest_cache .ruff_cache .coverage
