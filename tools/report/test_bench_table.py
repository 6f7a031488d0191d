#!/usr/bin/env python3
"""Proves what bench_table.py says about reports made for it."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import bench_table  # noqa: E402


def runs(name: str, *times: float, unit: str = "ns") -> list[dict]:
    found = [
        {"name": name, "run_name": name, "run_type": "iteration", "cpu_time": time, "real_time": 9e9, "time_unit": unit}
        for time in times
    ]
    # what Google Benchmark adds by itself must not count as a repetition
    found.append({"name": name + "_mean", "run_name": name, "run_type": "aggregate", "cpu_time": 1e9, "time_unit": unit})
    return found


def report(*groups: list[dict], **context: str) -> dict:
    return {
        "context": {"core": "1", "load_avg": [0.5], **context},
        "benchmarks": [run for group in groups for run in group],
        "host_share": {"stolen_percent": 0.2, "own_percent": 99.0},
    }


class Table(unittest.TestCase):
    def test_takes_the_median_of_the_repetitions(self) -> None:
        text = bench_table.table(report(runs("dynamics/links:3", 30.0, 900.0, 35.0)))
        self.assertIn("35.0 (<= 40)", text)
        self.assertIn("Every bound that was timed is kept", text)

    def test_reads_other_units(self) -> None:
        self.assertIn("1500", bench_table.table(report(runs("detection/box", 1.5, unit="us"))))

    def test_names_a_missed_bound(self) -> None:
        text = bench_table.table(report(runs("tool/semi_implicit/contacts:16", 151.0)))
        self.assertIn("tool/semi_implicit/contacts:16: 151 ns, asked <= 150", text)

    def test_shows_peers_as_multiples_of_ours_and_names_a_ratio_that_is_too_small(self) -> None:
        text = bench_table.table(
            report(
                runs("dynamics/links:3", 30.0), runs("peer_mujoco/links:3", 300.0), runs("peer_box2d/links:3", 900.0), peer_mujoco="4.0"
            )
        )
        self.assertIn("300 = 10.0x (>= 20x)", text)
        self.assertIn("900 = 30.0x", text)
        self.assertIn("mujoco at 3 links: 10.0 times ours, asked >= 20", text)

    def test_says_which_peer_is_missing_and_why(self) -> None:
        text = bench_table.table(report(runs("dynamics/links:3", 30.0), peer_pinocchio="missing: no network"))
        self.assertIn("Pinocchio is missing: no network", text)

    def test_says_what_could_not_be_timed(self) -> None:
        broken = {"name": "tool/contacts:4", "run_name": "tool/contacts:4", "error_occurred": True, "error_message": "lost"}
        self.assertIn("tool/contacts:4: lost", bench_table.table(report([broken])))

    def test_doubts_a_core_whose_other_half_was_busy(self) -> None:
        shared = report(runs("yardstick/chained", 20.0), runs("yardstick/side_by_side", 10.0))
        alone = report(runs("yardstick/chained", 20.0), runs("yardstick/side_by_side", 5.2))
        self.assertIn("too long", bench_table.table(shared))
        self.assertNotIn("too long", bench_table.table(alone))

    def test_shows_the_part_that_the_host_took(self) -> None:
        self.assertIn("the host took 0.2 % of the machine", bench_table.table(report(runs("dynamics/links:3", 30.0))))

    def test_fails_on_what_is_no_report(self) -> None:
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            file.write("{")
            file.flush()
            command = [sys.executable, str(Path(bench_table.__file__)), file.name]
            result = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(result.returncode, 1)
        self.assertIn("no report of Google Benchmark", result.stderr)


if __name__ == "__main__":
    unittest.main()
