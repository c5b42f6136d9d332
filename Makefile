# Every target works alone on a machine with Python 3.11 or newer and make: it makes .venv and installs what it needs.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
RUNTIME := $(VENV)/.installed
DEV := $(VENV)/.installed-dev
DEMO := runs/demo
COUNT ?= 1000
SEED ?= 1
PYTEST := $(BIN)/pytest -n auto --maxprocesses 8 --dist loadgroup --no-loadscope-reorder

# Without its bytecode every start of a process compiles the program and its libraries anew: more than a second.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.PHONY: help install demo test quick long times lint types arch check regression docs bench fuzz signs hidden trials browser constraints clean

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z]+:.*## / { printf "  make %-11s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

install: $(DEV) ## .venv with all that the other targets need

demo: $(RUNTIME) ## tune the bundled ship on its bundled trials and say where the report is
	$(BIN)/mmgtune fit --ar 0.5 --out $(DEMO) --force
	@report=$$(find $(CURDIR)/$(DEMO) -name '*.html' | sort | head -n 1); \
	if [ -z "$$report" ]; then echo "no HTML report was written to $(DEMO)" >&2; exit 1; fi; \
	echo; echo "HTML report: $$report"

test: $(DEV) ## run the tests, on all cores (those of the page need chromium: make browser)
	$(PYTEST)

quick: $(DEV) ## the tests of the edit loop: none that is slow or opens a page
	$(PYTEST) -q -m 'not slow and not browser and not long'

times: $(DEV) ## all tests, and how long they take into tests/times.json: twice after a change of the physics, which compiles
	$(PYTEST) --write-times

long: $(DEV) ## the tests left out of test: more of the same, on other ships, causes, seeds or pages
	$(PYTEST) -m long

lint: $(DEV) ## style and common mistakes
	$(BIN)/ruff check .
	$(BIN)/ruff format --check --quiet .

types: $(DEV) ## static types
	$(BIN)/mypy

arch: $(DEV) ## which module may use which
	$(BIN)/lint-imports --no-logo

regression: $(RUNTIME) ## does the bundled model still do on the bundled trials what it did?
	$(BIN)/mmgtune check suzaku suzaku --baseline trials/suzaku/check.json

check: ## lint, types, arch, regression and test
	@$(MAKE) --no-print-directory lint
	@$(MAKE) --no-print-directory types
	@$(MAKE) --no-print-directory arch
	@$(MAKE) --no-print-directory regression
	@$(MAKE) --no-print-directory test

docs: export NO_MKDOCS_2_WARNING = 1
docs: $(DEV) ## the site of the documents, into site/; a warning is an error
	$(BIN)/mkdocs build --strict --quiet
	@echo "site: $(CURDIR)/site/index.html"

hidden: $(RUNTIME) ## the full study of hidden effects, some hours; goes on where it was stopped
	$(BIN)/python -m tests.hidden.study
	$(BIN)/python -m tests.hidden.table
	$(BIN)/python tools/write_answers.py

signs: $(DEV) ## turn round every sign in the equations: do the tests notice? Takes long; goes on where it was stopped
	$(BIN)/python tools/mutate_signs.py

fuzz: $(DEV) ## hostile inputs, kills and interrupts: COUNT of each kind (1000), SEED (1); half an hour
	$(BIN)/python -m tests.fuzz --count $(COUNT) --seed $(SEED)
	$(BIN)/python -m tests.fuzz.interruptions --count $$(( $(COUNT) / 10 )) --seed $(SEED)

bench: $(RUNTIME) ## time the simulation and the fit
	$(BIN)/python -m tools.bench

trials: $(RUNTIME) ## write the bundled trials and voyages and the logs of the tutorial anew
	$(BIN)/python tools/generate_suzaku_trials.py
	$(BIN)/python tools/generate_suzaku_voyages.py
	$(BIN)/python -m tools.generate_tutorial_logs

browser: ## install Debian's chromium and axe-core for the tests of the pages, where that is possible
	@if command -v chromium >/dev/null; then \
		echo "chromium is installed"; \
	elif [ "$$(id -u)" -ne 0 ] || ! command -v apt-get >/dev/null; then \
		echo "chromium is missing: install it as root with apt-get, else the browser tests are skipped"; \
	else \
		export DEBIAN_FRONTEND=noninteractive; \
		apt-get update -q || true; \
		apt-get install -q -y --no-install-recommends chromium \
			|| echo "chromium could not be installed: the browser tests are skipped"; \
	fi
	@if command -v npm >/dev/null; then \
		npm install --silent --no-save --no-package-lock --no-audit --no-fund axe-core@4 \
			|| echo "axe-core could not be installed: its rules are not held against the pages"; \
	else \
		echo "npm is missing: the rules of axe-core are not held against the pages"; \
	fi

constraints: ## write constraints.txt anew: the newest releases that pyproject.toml allows
	@folder=$$(mktemp -d) && trap 'rm -rf "$$folder"' EXIT && $(PYTHON) -m venv "$$folder" \
	&& "$$folder/bin/python" -m pip install --quiet --disable-pip-version-check --editable '.[dev]' \
	&& { sed -n '/^#/p' constraints.txt; "$$folder/bin/python" -m pip freeze --exclude mmgtune; } > constraints.txt.part \
	&& mv constraints.txt.part constraints.txt
	@echo "constraints.txt is new: 'make check' installs and tests it"

clean: ## remove caches and built packages; .venv and runs stay
	rm -rf build dist site .hypothesis .import_linter_cache .mypy_cache .pytest_cache .ruff_cache
	find . -path ./$(VENV) -prune -o -path ./.git -prune -o -type d -name __pycache__ -exec rm -rf {} +

$(RUNTIME): pyproject.toml constraints.txt
	$(call install,.)
	@touch $@

$(DEV): pyproject.toml constraints.txt
	$(call install,.[dev])
	@touch $(RUNTIME) $@

define install
@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || { \
	echo "mmgtune needs Python 3.11 or newer, and '$(PYTHON)' is $$($(PYTHON) --version 2>&1 || echo not there)." >&2; \
	echo "Name one that is: make PYTHON=python3.11 ..." >&2; \
	exit 1; \
}
@$(PYTHON) -m venv $(VENV) || { \
	echo "'$(PYTHON)' cannot make a virtual environment; on Debian, install python3-venv." >&2; \
	exit 1; \
}
@echo "installing mmgtune into $(VENV): a minute or two, once"
@$(BIN)/python -m pip install --quiet --disable-pip-version-check \
	--no-compile --constraint constraints.txt --editable '$(1)'
endef
