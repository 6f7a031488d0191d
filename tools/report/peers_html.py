"""The part of the laboratory report on other engines beyond the time of a step: which error costs how much, a peg and a wall."""

from __future__ import annotations

import html
from pathlib import Path

from lab_html import read, table

PRECISION_COLUMNS = {
    "motion": "motion",
    "error_asked_m": "error asked, m",
    "engine": "engine",
    "method": "method",
    "steps_per_s": "steps a second",
    "error_m": "error seen, m",
    "us_per_simulated_s": "µs a simulated s",
    "us_low": "quartiles",
    "us_high": "",
    "times_ours": "times ours",
}
CONTACT_COLUMNS = {
    "scene": "scene",
    "way": "engine",
    "deepest_m": "deepest, m",
    "behind_hand_m": "behind the hand, m",
    "ns_per_step": "ns a step",
    "ns_low": "quartiles",
    "ns_high": "",
    "setup": "set up as",
}


def cost(row: dict[str, str]) -> float:
    return float(row["us_per_simulated_s"]) if row["us_per_simulated_s"] else float("inf")


def with_ratios(rows: list[dict[str, str]]) -> list[dict[str, str]]:
    """Each row with its cost over the cheapest of ours for the same motion and error."""
    best: dict[tuple[str, str], float] = {}
    for row in rows:
        key = (row["motion"], row["error_asked_m"])
        if row["engine"] == "ours":
            best[key] = min(best.get(key, float("inf")), cost(row))
    result = []
    for row in rows:
        own = best.get((row["motion"], row["error_asked_m"]), float("inf"))
        times = f"{cost(row) / own:.3g}" if row["us_per_simulated_s"] and own < float("inf") else ""
        missing = row["us_per_simulated_s"] == "" and not row["method"].startswith("missing")
        result.append({**row, "times_ours": "not reached" if missing else times})
    return result


def goals(precision: list[dict[str, str]], contact: list[dict[str, str]]) -> list[tuple[bool, str]]:
    """What was asked for, and whether it holds."""
    said = []
    for motion in dict.fromkeys(r["motion"] for r in precision):
        for asked, method, wanted in (("1e-09", "Runge-Kutta 4", 30.0), ("0.001", "Euler", 100.0)):
            for row in precision:
                is_asked = row["motion"] == motion and row["error_asked_m"] == asked
                if is_asked and row["engine"].startswith("mujoco ") and row["method"] == method and row["times_ours"] not in ("", "not reached"):
                    seen = float(row["times_ours"])
                    said.append((seen >= wanted, f"{motion} 3-link chain to {asked} m: MuJoCo {method} takes {seen:.3g} times as long as ours, wanted {wanted:g}"))
    for row in contact:
        if row["scene"].startswith("peg") and row["way"].startswith("ours, linearly"):
            deepest, step = 1e6 * float(row["deepest_m"]), float(row["ns_per_step"])
            said.append((deepest <= 3.0, f"peg with 100 µm clearance at 500 Hz: {deepest:.3g} µm deepest, wanted at most 3"))
            said.append((step <= 600.0, f"peg with 100 µm clearance at 500 Hz: {step:.0f} ns a step, wanted at most 600"))
    return said


def ahead(precision: list[dict[str, str]], contact: list[dict[str, str]]) -> list[str]:
    """Where another engine is better than the best of ours."""
    found = [
        f"{r['engine']}, {r['method']}: {r['times_ours']} times our time to {r['error_asked_m']} m ({r['motion']})"
        for r in precision
        if r["engine"] != "ours" and r["times_ours"] not in ("", "not reached") and float(r["times_ours"]) < 1.0
    ]
    for scene in dict.fromkeys(r["scene"] for r in contact):
        rows = [r for r in contact if r["scene"] == scene and r["deepest_m"]]
        ours = [r for r in rows if r["way"].startswith("ours")]
        for name, words, scale, unit in (("deepest_m", "overlaps by at most", 1e6, "µm"), ("ns_per_step", "takes", 1.0, "ns a step")):
            best = min((float(r[name]) for r in ours), default=0.0)
            for r in rows:
                if r not in ours and float(r[name]) < best:
                    found.append(f"{r['way']} {words} {scale * float(r[name]):.3g} {unit} where ours has {scale * best:.3g} ({scene})")
    return found


def peers_part(folder: Path) -> str:
    precision = with_ratios(read(folder / "peers_precision.csv"))
    contact = read(folder / "peers_contact.csv") + read(folder / "peers_godot.csv")
    if not precision and not contact:
        return '<p class="fail">Error against run time, peg and wall in other engines: not measured in this run, because the benchmarks are not built (make bench builds them and fetches the engines).</p>'
    parts = [f'<p class="fail">Better than ours: {html.escape(words)}.</p>' for words in ahead(precision, contact)]
    for holds, words in goals(precision, contact):
        mark = "pass" if holds else "fail"
        parts.append(f'<p class="{mark}">{html.escape(words)}: {mark}.</p>')
    missing = {r["engine"]: r["method"] for r in precision if r["method"].startswith("missing")}
    parts += [f'<p class="fail">{html.escape(engine)} is {html.escape(why)}.</p>' for engine, why in missing.items()]
    if precision:
        doubt = max(float(r["truth_difference_m"]) for r in precision if r["truth_difference_m"])
        parts.append(
            "<h3>Which error costs how much</h3><p>Three rods that turn freely for a second from 3 to 5 rad/s (gentle) and 9 to 15 rad/s (swift), no gravity; the fewest steps with "
            f"which the tip stays within the error at ten moments. The truth is ours of eighth order, whose last refinement changed {doubt:.1g} m; every engine that takes part computes "
            "that motion. Features that an engine does not need are off (native/lab/peers says how); Pinocchio is compiled for this very processor.</p>"
        )
        parts.append(table([r for r in precision if not r["method"].startswith("missing")], PRECISION_COLUMNS))
    if contact:
        parts.append(
            "<h3>A peg in a hole, and a wall</h3><p>A box of 20 by 40 mm and 0.3 kg led by a hand of 1000 N/m, which is computed here and given to every engine as a force, in steps of "
            "2 ms; the overlap is computed here from its pose. Behind the hand: how far it lags in the direction in which nothing holds it.</p>"
        )
        parts.append(table(contact, CONTACT_COLUMNS))
    return "\n".join(parts) + "<h3>One step of a chain</h3>"
