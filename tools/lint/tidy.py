#!/usr/bin/env python3
"""Runs clang-tidy on the native sources that ship, in parallel, only on those whose text, headers or rules changed since they last passed.

Uses the compile commands and the header lists of a finished build (build/release). A source that a previous run found clean
is skipped; what it passed with is remembered in build/tidy/.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# gcc's own flags, which clang does not know
GCC_ONLY = {"-fno-gnu-unique", "-Wduplicated-cond", "-Wlogical-op", "-Winvalid-pch"}


def headers_by_object(build: Path) -> dict[str, list[str]]:
    """Object file to the headers it was compiled from, as ninja recorded them."""
    text = subprocess.run(["ninja", "-C", str(build), "-t", "deps"], capture_output=True, text=True, check=True).stdout
    found: dict[str, list[str]] = {}
    current: list[str] = []
    for line in text.splitlines():
        if line.startswith("    "):
            current.append(line.strip())
        elif ": #deps" in line:
            current = found.setdefault(line.split(": #deps")[0], [])
    return found


def ships(source: Path) -> bool:
    """Tests, benchmarks and the report are held by the warnings of two compilers, and would double the time."""
    native = ROOT / "native"
    return source.is_relative_to(native) and not any(source.is_relative_to(native / part) for part in ("tests", "bench", "lab/report"))


def sources_of(file: Path) -> list[Path]:
    """The sources in a compiled file: itself, or what the build joined in it."""
    if "Unity" not in file.parts:
        return [file]
    return [Path(name) for name in re.findall(r'^#include "(.+\.cpp)"$', file.read_text(), re.MULTILINE)]


def prepare(build: Path, out: Path, only: set[Path]) -> list[tuple[Path, str]]:
    """Writes the compile commands without gcc's own flags; returns each compiled file with the mark of all that it depends on."""
    entries = json.loads((build / "compile_commands.json").read_text())
    headers = headers_by_object(build)
    rules = (ROOT / ".clang-tidy").read_bytes() + (ROOT / "tools/setup/versions.env").read_bytes()
    kept = []
    sources = []
    texts: dict[str, bytes] = {}
    for entry in entries:
        source = Path(entry["file"])
        inside = sources_of(source)
        if not all(ships(file) for file in inside) or (only and not only.intersection(inside)):
            continue
        words = [word for word in entry["command"].split() if word not in GCC_ONLY]
        # gcc's precompiled headers; without them a missing include shows here
        while "-include" in words and words[words.index("-include") + 1].endswith("cmake_pch.hxx"):
            at = words.index("-include")
            del words[at : at + 2]
        entry["command"] = " ".join(words)
        kept.append(entry)
        digest = hashlib.sha256(rules + entry["command"].encode())
        for name in sorted({str(source), *headers.get(words[words.index("-o") + 1], [])}):
            if name.startswith(str(ROOT)):
                if name not in texts:
                    texts[name] = Path(name).read_bytes() if Path(name).exists() else b""
                digest.update(texts[name])
        sources.append((source, digest.hexdigest()))
    out.mkdir(parents=True, exist_ok=True)
    (out / "compile_commands.json").write_text(json.dumps(kept))
    return sources


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=Path, default=ROOT / "build/release")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("files", nargs="*", type=Path, help="only these sources")
    options = parser.parse_args()
    out = ROOT / "build/tidy"
    sources = prepare(options.build, out, {file.resolve() for file in options.files})
    passed_with = out / "passed.json"
    passed: dict[str, str] = json.loads(passed_with.read_text()) if passed_with.exists() else {}
    todo = [(source, mark) for source, mark in sources if passed.get(str(source)) != mark]
    # long ones first, so that the last one does not keep a core waiting
    todo.sort(key=lambda pair: -sum(file.stat().st_size for file in sources_of(pair[0])))
    tool = subprocess.run([str(ROOT / "tools/setup/run_tool"), "--path", "clang-tidy"], capture_output=True, text=True, check=True)

    def tidy(pair: tuple[Path, str]) -> bool:
        source, mark = pair
        command = [tool.stdout.strip(), "-p", str(out), "--quiet", "--extra-arg=-Wno-unknown-warning-option", str(source)]
        result = subprocess.run(command, capture_output=True, text=True, cwd=ROOT)
        if result.returncode == 0:
            passed[str(source)] = mark
            return True
        noise = ("warnings generated", "warning generated", "Suppressed ", "Use -header-filter")
        complaint = "\n".join(line for line in result.stderr.splitlines() if not any(word in line for word in noise))
        print(result.stdout + complaint, flush=True)
        return False

    with ThreadPoolExecutor(options.jobs) as pool:
        results = list(pool.map(tidy, todo))
    passed_with.write_text(json.dumps(passed))
    print(f"clang-tidy: {len(sources)} sources, {len(sources) - len(todo)} unchanged, {results.count(False)} with complaints")
    if not sources:
        print("clang-tidy: nothing to check; build first", file=sys.stderr)
    return 1 if results.count(False) or not sources else 0


if __name__ == "__main__":
    sys.exit(main())
