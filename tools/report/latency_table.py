#!/usr/bin/env python3
"""Prints how late the haptic loop inside Godot and cyclictest were woken, from the turns that tools/run/latency made."""

from __future__ import annotations

import json
import sys
from pathlib import Path


def percentile(histogram: dict[int, int], share: float) -> int:
    """Smallest latency (us) that at least `share` of the samples do not exceed."""
    total = sum(histogram.values())
    seen = 0
    for latency in sorted(histogram):
        seen += histogram[latency]
        if seen >= share * total:
            return latency
    raise ValueError("no samples")


def read_cyclictest(text: str) -> dict[int, int]:
    """The histogram that cyclictest -h prints: latency in us, number of samples."""
    histogram: dict[int, int] = {}
    for line in text.splitlines():
        if line.startswith("# Histogram Overflows"):
            over = int(line.split(":")[1])
            if over:
                histogram[20000] = histogram.get(20000, 0) + over
        words = line.split()
        if len(words) == 2 and words[0].isdigit() and words[1].isdigit() and int(words[1]) > 0:
            histogram[int(words[0])] = histogram.get(int(words[0]), 0) + int(words[1])
    return histogram


def main() -> int:
    folder, target = Path(sys.argv[1]), Path(sys.argv[2])
    histograms = []
    ours = []
    for turn in sorted(folder.glob("*.cyclictest")):
        histograms.append(read_cyclictest(turn.read_text()))
        ours.append(json.loads((folder / turn.stem / "run.json").read_text()))
    if not histograms or not all(histograms):
        print("cyclictest counted nothing", file=sys.stderr)
        return 1
    names = {"p50": 0.5, "p99": 0.99, "p999": 0.999}
    # percentiles of turns cannot be added up: for both the median turn stands for all, the maximum is that of all
    middle = len(ours) // 2
    loop = {name: sorted(run["wake_latency_us"][name] for run in ours)[middle] for name in names}
    yardstick = {
        name: float(sorted(percentile(histogram, share) for histogram in histograms)[middle]) for name, share in names.items()
    }
    loop["max"] = max(run["wake_latency_us"]["max"] for run in ours)
    yardstick["max"] = float(max(max(histogram) for histogram in histograms))
    stolen = max((run.get("host_steal") or 0.0) for run in ours)
    result = {
        "loop_us": loop,
        "cyclictest_us": yardstick,
        "p99_ratio": loop["p99"] / max(yardstick["p99"], 1.0),
        "scheduling": ours[0]["scheduling"],
        "largest_host_steal": stolen,
        "turns": len(ours),
    }
    target.write_text(json.dumps(result, indent=1) + "\n")
    print(f"Wake latency at 1 kHz, us; {len(ours)} turns of 5 s each; {result['scheduling']}")
    print(f"{'':24}{'p50':>10}{'p99':>10}{'p99.9':>10}{'max':>10}")
    for title, row in (("haptic loop in Godot", loop), ("cyclictest", yardstick)):
        print(f"{title:24}" + "".join(f"{row[name]:10.0f}" for name in ("p50", "p99", "p999", "max")))
    print(f"p99 over cyclictest's: {result['p99_ratio']:.2f} (aim: 1.5 while the host steals nothing; it took {100.0 * stolen:.1f} % at most)")
    return 0


if __name__ == "__main__":
    sys.exit(main())
