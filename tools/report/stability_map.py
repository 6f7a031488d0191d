#!/usr/bin/env python3
"""stability_map.py REPORT OUT.json: the maps of a full report's stability.csv and stability_device.csv as the stiffest wall that is stable for each
integrator, rate and tool mass, and for each coupling, rate, delay and encoder; small enough for the editor to carry."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from lab_html import read, stiffest_walls


def proxy(rows: list[dict[str, str]]) -> list[dict]:
    """For each integrator, rate and mass: the stiffest wall up to which all are stable; 0 for none."""
    groups: dict[tuple[str, float, float], dict[float, bool]] = {}
    for row in rows:
        key = (row["integrator"], float(row["rate_hz"]), float(row["mass_kg"]))
        groups.setdefault(key, {})[float(row["stiffness_n_per_m"])] = row["verdict"] == "stable"
    found = []
    for (integrator, rate, mass), walls in groups.items():
        best = 0.0
        for wall in sorted(walls):
            if not walls[wall]:
                break
            best = wall
        found.append({"integrator": integrator, "rate_hz": rate, "mass_kg": mass, "stiffest_n_per_m": float(f"{best:.4g}")})
    return found


def main(report: Path, out: Path) -> None:
    alone = read(report / "stability.csv")
    if not alone:
        sys.exit(f"no stability.csv in {report}: make a full report first")
    loops = [
        {
            "coupling": w["coupling"],
            "rate_hz": float(w["rate_hz"]),
            "delay_steps": int(w["delay_steps"]),
            "encoder_m": float(w["encoder_m"]),
            "stiffest_n_per_m": 0.0 if w["wall"] == "none" else float(w["wall"]),
        }
        for w in stiffest_walls(read(report / "stability_device.csv"))
    ]
    maps = {"damping_n_s_per_m": float(alone[0]["damping_n_s_per_m"]), "proxy": proxy(alone), "device": loops}
    lines = ["{", f'"damping_n_s_per_m": {maps["damping_n_s_per_m"]},']
    for name, comma in (("proxy", ","), ("device", "")):
        rows = ",\n".join(json.dumps(row) for row in maps[name])
        lines.append(f'"{name}": [\n{rows}\n]{comma}')
    out.write_text("\n".join([*lines, "}"]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*map(Path, sys.argv[1:]))
