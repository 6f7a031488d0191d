#!/usr/bin/env python3
"""Prints build/bench.json as a table: medians in nanoseconds, the bound that was asked for beside each, other engines as
multiples of ours. What a filter left out is left out here too. A bound that is missed is said at the end; the exit code
stays 0, because a time depends on the machine and on who else uses it."""

from __future__ import annotations

import argparse
import json
import statistics
import sys
from dataclasses import dataclass, field
from pathlib import Path

# largest median, ns
BOUNDS = {
    "dynamics/rigid_tool": 20.0,
    "dynamics/links:3": 40.0,
    "dynamics/links:48": 500.0,
    "tool/semi_implicit/contacts:4": 80.0,
    "tool/semi_implicit/contacts:16": 150.0,
    "tool/linearly_implicit/contacts:4": 100.0,
    "tool/linearly_implicit/contacts:16": 200.0,
}
# smallest multiple of ours
RATIOS = {("mujoco", 3): 20.0, ("mujoco", 48): 25.0}
ENGINES = {"mujoco": "MuJoCo", "mujoco_stages": "its stages", "pinocchio": "Pinocchio", "box2d": "Box2D"}
TO_NS = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}


@dataclass
class Times:
    """Repetitions of one benchmark, ns of processor time."""

    values: list[float] = field(default_factory=list)

    @property
    def median(self) -> float:
        return statistics.median(self.values)

    @property
    def spread(self) -> float:
        """Half of the range, as a part of the median."""
        return 0.5 * (max(self.values) - min(self.values)) / self.median


def read(report: dict) -> tuple[dict[str, Times], list[str]]:
    """Times by name, and what could not be timed."""
    times: dict[str, Times] = {}
    failed = []
    for run in report["benchmarks"]:
        name = run.get("run_name", run["name"])
        if run.get("error_occurred"):
            failed.append(f"{name}: {run.get('error_message', 'failed')}")
        elif run.get("run_type", "iteration") == "iteration":
            times.setdefault(name, Times()).values.append(run["cpu_time"] * TO_NS[run["time_unit"]])
    return times, failed


def number(value: float) -> str:
    return f"{value:.1f}" if value < 100.0 else f"{value:.0f}"


def cell(times: dict[str, Times], name: str) -> str:
    """The median, with its bound where there is one."""
    if name not in times:
        return "-"
    bound = BOUNDS.get(name)
    text = number(times[name].median)
    return text if bound is None else f"{text} (<= {bound:.0f})"


def layout(rows: list[list[str]]) -> list[str]:
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    lines = []
    for row in rows:
        first = row[0].ljust(widths[0])
        lines.append("  " + "  ".join([first, *(text.rjust(width) for text, width in zip(row[1:], widths[1:]))]).rstrip())
    return lines


def numbered(times: dict[str, Times], prefix: str) -> list[int]:
    return sorted(int(name.removeprefix(prefix)) for name in times if name.startswith(prefix))


def chains(times: dict[str, Times], context: dict[str, str]) -> list[str]:
    sizes = numbered(times, "dynamics/links:")
    engines = [engine for engine in ENGINES if numbered(times, f"peer_{engine}/links:")]
    if not sizes:
        return []
    heads = [f"{ENGINES[engine]} {context.get('peer_' + engine, '')}".strip() for engine in engines]
    rows = [["links", "ours", *heads]]
    for size in sizes:
        ours = times[f"dynamics/links:{size}"].median
        row = [str(size), cell(times, f"dynamics/links:{size}")]
        for engine in engines:
            peer = times.get(f"peer_{engine}/links:{size}")
            if peer is None:
                row.append("-")
                continue
            asked = RATIOS.get((engine, size))
            ratio = f"{peer.median / ours:.1f}x" + ("" if asked is None else f" (>= {asked:.0f}x)")
            row.append(f"{number(peer.median)} = {ratio}")
        rows.append(row)
    lines = ["Serial chains of rods: accelerations with Coriolis terms and one semi-implicit step, ns", *layout(rows)]
    if "dynamics/rigid_tool" in times:
        lines.append(f"  free rigid tool: {cell(times, 'dynamics/rigid_tool')}")
    return lines


def tool(times: dict[str, Times]) -> list[str]:
    columns = {
        "tool/": "tool (default)",
        "tool/semi_implicit/": "semi_implicit",
        "tool/linearly_implicit/": "linearly_implicit",
        "tool_held/": "held by a hand",
        "tool_step/": "whole step",
        "tool_detection/": "detection",
    }
    columns = {prefix: head for prefix, head in columns.items() if numbered(times, prefix + "contacts:")}
    if not columns:
        return []
    sizes = sorted({size for prefix in columns for size in numbered(times, prefix + "contacts:")})
    rows = [["contacts", *columns.values()]]
    rows += [[str(size), *(cell(times, f"{prefix}contacts:{size}") for prefix in columns)] for size in sizes]
    return ["Rigid tool with friction: one haptic step but for the search for contacts, the whole of it, and the search alone, ns", *layout(rows)]


def rest(times: dict[str, Times]) -> list[str]:
    shown = ("dynamics/", "peer_", "tool/", "tool_held/", "tool_step/", "tool_detection/", "yardstick/")
    names = [name for name in times if not name.startswith(shown)]
    if not names:
        return []
    rows = [[name, number(times[name].median), f"+-{100.0 * times[name].spread:.0f} %"] for name in names]
    return ["Parts, detection and collisions, ns", *layout(rows)]


def machine(report: dict, times: dict[str, Times]) -> list[str]:
    context = report["context"]
    lines = [f"core {context.get('core', '?')}, load {', '.join(f'{load:.1f}' for load in context.get('load_avg', [])[:1]) or '?'}"]
    share = report.get("host_share", {})
    if share:
        stolen = share.get("stolen_percent")
        lines[0] += f"; the host took {'an unknown part' if stolen is None else f'{stolen} %'} of the machine"
        lines[0] += f", other processes {100.0 - share['own_percent']:.0f} % of this core"
    if "yardstick/chained" in times and "yardstick/side_by_side" in times:
        chained = 64.0 / times["yardstick/chained"].median
        beside = 64.0 / times["yardstick/side_by_side"].median
        lines.append(f"it adds {chained:.1f} times a ns, and {beside:.1f} times when nothing waits: ratio {beside / chained:.1f}"
                     + (" (its other half was busy: all times are too long)" if beside / chained < 3.0 else ""))
    return lines


def peers(context: dict[str, str]) -> list[str]:
    lines = []
    for engine, name in ENGINES.items():
        version = context.get(f"peer_{engine}", "")
        difference = context.get(f"peer_{engine}_difference")
        if version.startswith("missing"):
            lines.append(f"{name} is {version}")
        elif difference:
            lines.append(f"{name} {version} computes our motion up to: {difference}")
    return lines


def missed(times: dict[str, Times]) -> list[str]:
    lines = [
        f"{name}: {number(times[name].median)} ns, asked <= {bound:.0f}"
        for name, bound in BOUNDS.items()
        if name in times and times[name].median > bound
    ]
    for (engine, size), asked in RATIOS.items():
        peer, ours = times.get(f"peer_{engine}/links:{size}"), times.get(f"dynamics/links:{size}")
        if peer and ours and peer.median / ours.median < asked:
            lines.append(f"{engine} at {size} links: {peer.median / ours.median:.1f} times ours, asked >= {asked:.0f}")
    return lines


def table(report: dict) -> str:
    times, failed = read(report)
    context = report["context"]
    parts = [machine(report, times), chains(times, context), peers(context), tool(times), rest(times)]
    if failed:
        parts.append(["NOT TIMED:", *(f"  {line}" for line in failed)])
    over = missed(times)
    asked = any(name in times for name in BOUNDS)
    if asked:
        parts.append(["Bounds missed:", *(f"  {line}" for line in over)] if over else ["Every bound that was timed is kept."])
    return "\n\n".join("\n".join(part) for part in parts if part)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("report", type=Path)
    options = parser.parse_args()
    try:
        report = json.loads(options.report.read_text())
        print(table(report))
    except (OSError, ValueError, KeyError) as problem:
        print(f"{options.report} is no report of Google Benchmark: {problem}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
