# Thin: every command is a script in tools/ or a CMake preset.
SHELL := /bin/bash
.DEFAULT_GOAL := help
.PHONY: help demo test editor run build bench experiment1 experiment2 report latency sanitizers lint format clean

PRESET ?= release
OUT ?= build/run
SECONDS ?= 5

help: ## this list
	@awk -F ':.*## ' '/^[a-z0-9]+:.*## / { printf "  make %-8s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)
	@echo
	@echo "  Missing tools are fetched once into $${GODOT_HAPTICS_CACHE:-$${XDG_CACHE_HOME:-~/.cache}/godot-haptics}; GODOT=/path names a Godot of yours."

demo: ## the testbed: in a window where there is a display, else 10 s headless with a summary
	@tools/run/demo

test: ## all tests and checks (GUT=1: the suites through GUT itself, from addons/gut)
	@tools/run/test $(if $(filter 1,$(GUT)),--gut)

editor: ## the project in Godot's editor
	@tools/run/editor

run: ## a scene headless, measured: SCENE=res://… [SECONDS=5] [LOCKSTEP=1] [OUT=build/run] writes OUT/run.json, OUT/run.csv
	@tools/run/scene "$(SCENE)" --seconds=$(SECONDS) --out="$(OUT)" --summary $(if $(filter 1,$(LOCKSTEP)),--lockstep)

build: ## the native library and tests (PRESET=release|debug|asan|tsan|clang)
	@tools/run/build $(PRESET)

experiment1: ## experiment 1 of the paper: CSV, picture and table in build/experiment1
	@tools/run/experiment1

experiment2: ## experiment 2 of the paper: CSV, picture and table in build/experiment2
	@tools/run/experiment2

report: ## the laboratory report: error against run time, stability, plans; build/report/index.html (QUICK=1: coarser; KEEP=1: into docs/report; SCENE=res://… [SECONDS=3]: of that scene)
	@tools/run/report $(if $(filter 1,$(QUICK)),--quick) $(if $(filter 1,$(KEEP)),--keep) $(if $(SCENE),--scene="$(SCENE)" $(if $(filter command\ line,$(origin SECONDS)),--seconds="$(SECONDS)"))

bench: ## the benchmarks (ARGS="--benchmark_filter=…"); JSON in build/bench.json
	@tools/run/bench $(ARGS)

latency: ## how late the loop inside Godot is woken, beside cyclictest (SECONDS=20)
	@tools/run/latency $(if $(filter command\ line,$(origin SECONDS)),$(SECONDS),20)

sanitizers: ## the loop, its exchange and the session under address, undefined-behavior and thread checks
	@tools/run/test --only sanitizers

lint: ## room rules, formatting, clang-tidy, gdlint
	@tools/run/test --only lint

format: ## formats all C++ and GDScript
	@tools/lint/format

clean: ## removes what was built here; what was fetched stays in the cache
	rm -rf build .godot compile_commands.json addons/haptics/bin/*.so
