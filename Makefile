# CombBench. `make run` serves the bench, `make test` checks all of it, `make help` lists the rest.

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
SHELL := /bin/sh
ARGS ?=
# Packages come without bytecode; where Python may not keep any, every start compiles them anew, for seconds.
unexport PYTHONDONTWRITEBYTECODE

PYTHON_STAMP  := .venv/.locked
KERNEL_STAMP  := .venv/.kernels
LOADED_STAMP  := .venv/.loaded
NODE_STAMP    := web/node_modules/.package-lock.json
PAGE          := web/dist/index.html
# Folders are listed with their files, so that a deleted file makes its target stale too.
KERNEL_SOURCE := $(shell find core scenarios -name __pycache__ -prune -o -print)
PAGE_SOURCE   := $(shell find web -name node_modules -prune -o -name dist -prune -o -name e2e -prune -o -name testing -prune -o \
                   -mindepth 1 -not -name '*.test.ts*' -not -name '*.tsbuildinfo' -print)

.PHONY: run classroom setup first-kernels test test-all flakes mutations check fix dev bench load class-load soak page-speed exhibit wheel image docs audit codegen digests lock clean help

run: $(PYTHON_STAMP)  ## Set everything up, serve the bench on http://127.0.0.1:8000 and print the link to open
	@$(MAKE) --no-print-directory -j2 $(PAGE) first-kernels $(LOADED_STAMP)
	@.venv/bin/combbench serve $(ARGS) || [ $$? -eq 130 ]

classroom: override ARGS += --classroom
classroom: run  ## The same for a class: students on this network join by a code

setup: $(PYTHON_STAMP)  ## Set everything up, serve nothing
	@$(MAKE) --no-print-directory -j2 $(PAGE) $(KERNEL_STAMP)

test: setup  ## Run the static checks and the short suite: Python, page, browser (ONLY=word: tests with that word)
	@.venv/bin/python scripts/run_tests.py short

test-all: setup  ## Run the long suite too: fifty seeds, fuzzers, kills, PostgreSQL, proxy, screens
	@.venv/bin/python scripts/run_tests.py all

flakes: setup  ## Run a suite again and again beside busy processes; list the tests that did not always pass
	@.venv/bin/python scripts/flakes.py $(ARGS)

mutations: setup  ## Plant known faults one by one, and see that the tests notice (ARGS=words of their names)
	@.venv/bin/python scripts/mutations.py $(ARGS)

check: $(PYTHON_STAMP) $(NODE_STAMP)  ## Run the static checks: format, lint, imports, types; list changed sentences for a second look
	@.venv/bin/python scripts/run_tests.py check

fix: $(PYTHON_STAMP) $(NODE_STAMP)  ## Format everything and mend what the linters can mend
	@.venv/bin/ruff check --fix-only --quiet . ; .venv/bin/ruff format .
	@scripts/npm --prefix web run fix

dev: setup  ## Serve the bench, with the page rebuilt in the browser at every edit
	@scripts/dev $(ARGS)

bench: $(PYTHON_STAMP)  ## Measure speed, each figure as a ratio to a peer in the same run
	@.venv/bin/combbench bench $(ARGS)

load: setup  ## Many watchers of one bench for 20 s: frame rate, latency, board timing
	@.venv/bin/python scripts/load.py pages $(ARGS)

page-speed: setup  ## How often eight scopes are drawn, what a frame costs, how soon a click acts, the heap over 30 min, campaigns
	@cd web && ../scripts/npm exec -- playwright test -c measure.config.ts $(ARGS)

class-load: setup  ## A class of 30 students and 60 watchers: joining, effects, memory
	@.venv/bin/python scripts/load.py class $(ARGS)

soak: setup  ## Eight benches and watchers for 30 minutes: memory and timing must stay flat
	@.venv/bin/python scripts/load.py pages --benches 8 --watchers 8 --seconds 1800 --flat $(ARGS)

exhibit: setup  ## Write the library as live pages into exhibit/, a folder for any static host (ARGS=ch3-*: these)
	@.venv/bin/combbench export --gallery exhibit $(ARGS)

wheel: $(PAGE) docs  ## Build a wheel with the page, the documents, and machine code for x86-64-v2, x86-64-v3 and aarch64 Linux
	@.venv/bin/uv build --wheel --no-build-isolation --quiet --out-dir dist

image: ## Build the container image, start it, ask for its health and stop it
	@scripts/image

docs: $(PYTHON_STAMP)  ## Build the site of the documents into docs/site, which the server shows at /docs; a warning is an error
	@PYTHONPATH=scripts .venv/bin/python -m manual

audit: $(PYTHON_STAMP) $(NODE_STAMP) ## List all packages into sbom/, and ask the indices whether one is known to be weak
	@.venv/bin/python scripts/audit.py python sbom
	@.venv/bin/python scripts/audit.py page sbom

codegen: $(PYTHON_STAMP) $(NODE_STAMP)  ## Regenerate the page's types, the answers its tests use, and the generated parts of the documents
	@.venv/bin/python -m server.openapi > web/openapi.json
	@scripts/npm --prefix web run codegen
	@.venv/bin/python scripts/record_answers.py
	@.venv/bin/python scripts/write_documents.py

digests: $(KERNEL_STAMP)  ## Renew the digests tests hold runs to (ARGS=--draw: with other benches)
	@.venv/bin/python -m tests.scenarios.digests --renew $(ARGS)

lock: $(PYTHON_STAMP)  ## Renew requirements.lock (ARGS=--upgrade for newer versions)
	@.venv/bin/uv pip compile --quiet --universal --fork-strategy fewest --generate-hashes --all-extras \
	  --custom-compile-command 'make lock' $(ARGS) --output-file requirements.lock pyproject.toml

clean:  ## Remove everything that was set up or built; recorded data stays
	@rm -rf .venv web/node_modules web/dist docs/site .mypy_cache .ruff_cache .pytest_cache .import_linter_cache .hypothesis
	@find . -name __pycache__ -type d -prune -exec rm -rf {} +

help:  ## Show this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "  make %-11s %s\n", $$1, $$2}' Makefile

$(PYTHON_STAMP): requirements.lock pyproject.toml scripts/venv
	@scripts/venv
	@touch $@

# The server starts with the kernels of one bench and compiles the others while it runs.
first-kernels: $(PYTHON_STAMP)
	@test $(KERNEL_STAMP) -nt $(PYTHON_STAMP) || .venv/bin/python -m scenarios.kernels first

# What the server loads gets its bytecode beside the page's build; bytecode of all packages would take ten times as long.
$(LOADED_STAMP): $(PYTHON_STAMP)
	@.venv/bin/python -c 'import server.app'
	@touch $@

$(KERNEL_STAMP): $(PYTHON_STAMP) $(KERNEL_SOURCE)
	@.venv/bin/python -m scenarios.kernels
	@touch $@

$(NODE_STAMP): web/package.json web/package-lock.json | $(PYTHON_STAMP)
	@echo "Installing the page's packages"
	@scripts/npm --prefix web ci
	@touch $@

$(PAGE): $(NODE_STAMP) $(PAGE_SOURCE)
	@echo "Building the page"
	@scripts/npm --prefix web run --silent build -- --logLevel warn
	@touch $@
