"""The part of the laboratory report on a scene of the user's."""

from __future__ import annotations

import html
from pathlib import Path

from lab_html import picture, read, table

ERROR_COLUMNS = {
    "method": "contact",
    "integrator": "integrator",
    "rate_hz": "rate Hz",
    "position_rms_m": "position error m RMS",
    "position_max_m": "largest m",
    "force_rms_n": "force error N RMS",
    "energy_max_j": "energy made, error J",
    "error_is": "error is",
    "ns_per_step": "ns a step",
    "ns_per_step_low": "quartiles",
    "ns_per_step_high": "",
    "us_per_simulated_s": "µs a simulated s",
}
LOOP_COLUMNS = {
    "integrator": "integrator",
    "rate_hz": "rate Hz",
    "walls_stiffer": "walls times as stiff",
    "verdict": "verdict",
    "shaking_m": "shaking m",
    "energy_created_j": "energy made J",
    "largest_force_n": "largest force N",
    "deepest_m": "deepest m",
    "fault": "fault",
}
WALL_COLUMNS = {
    "wall": "wall",
    "stiffness_n_per_m": "N/m",
    "damping_n_s_per_m": "N s/m",
    "mass_kg": "tool kg",
    "integrator": "integrator",
    "stable": "stable at Hz",
    "other": "not stable at Hz",
    "floor": "semi-implicit steps need, kg (slowest rate)",
}


def walls(rows: list[dict[str, str]]) -> list[dict[str, str]]:
    """One row for each wall and integrator: the rates at which the tool alone is stable on it."""
    found: dict[tuple[str, str], dict[str, str]] = {}
    for row in rows:
        line = found.setdefault((row["wall"], row["integrator"]), {**row, "stable": "", "other": "", "floor": row["semi_implicit_floor_kg"]})
        if row["verdict"] == "stable":
            line["stable"] += f"{row['rate_hz']} "
        else:
            line["other"] += f"{row['rate_hz']} ({row['verdict']}) "
    return list(found.values())


def plan(folder: Path, about: list[dict[str, str]]) -> str:
    rows = read(folder / "scene_plan.csv")
    if not rows:
        return '<p class="fail">Not measured: the scene did not run to its end with everything on.</p>'
    columns = {
        "bodies": "bodies in the scene",
        "bodies_sent": "sent at most",
        "ns_per_step_planned": "ns a step, planned",
        "ns_per_step_everything": "ns, everything on",
        "times_cheaper": "times cheaper",
        "largest_difference_m": "difference in motion m",
    }
    parts = [table(rows, columns)]
    without_place = float(rows[0]["bodies_without_place"])
    if without_place > 0.0:
        parts.append(f'<p class="note">{without_place:g} bodies had no place when everything was sent.</p>')
    left_out = [r for r in about if r["what"].startswith("left out: ")]
    items = "".join(f"<li>{html.escape(r['what'].removeprefix('left out: '))}: {html.escape(r['value'])}</li>" for r in left_out)
    return "\n".join(parts) + f"<p>Left out at the end of the run:</p><ul>{items}</ul>"


def scene_part(folder: Path, pictures: dict[str, str]) -> str:
    about = read(folder / "scene.csv")
    rows = read(folder / "scene_error.csv")
    reasons = read(folder / "scene_recommended.csv")
    parts = [table([r for r in about if r["what"] != "note" and not r["what"].startswith("left out")], {"what": "", "value": ""})]
    parts += [f'<p class="note">Note: {html.escape(r["value"])}.</p>' for r in about if r["what"] == "note"]
    apart = max((float(r["repeats_within_m"]) for r in reasons), default=0.0)
    if apart > 0.0:
        parts.append(
            f'<p class="fail">Two equal runs of the scene are up to {apart:.3g} m apart: something in it looks at the clock or draws lots. '
            "Errors below ten times that cannot be told.</p>"
        )
    parts.append("<h3>Error against run time</h3>")
    parts.append(
        "<p>Each run with the coupling that the scene's own rate gets and with exact encoders, so that all rates approach one motion; the reference is the scene itself "
        "with the exact integrator at 16, 32 and 64 kHz, where the loop's delay of one step is gone. Forces are those on the hand, energy what the controller made. Run time is "
        "that of a haptic step without what simulates device and hand.</p>"
    )
    parts += [picture(pictures[name], "error against run time of the scene") for name in pictures if name == "scene_error"]
    parts.append(table(reasons, {"method": "contact", "reason": "recommended"}))
    parts.append(table(rows, ERROR_COLUMNS))
    parts.append("<h3>Stability of the scene's loop</h3>")
    parts.append(
        "<p>The scene with its own device and encoders, its coupling as each rate gets it, and its walls as they are and stiffer. Unstable: a fault, or the grip shakes by more than 0.5 mm; "
        "chattering: more than 50 µm, or a millijoule made. Tiles keep their stiffness.</p>"
    )
    parts.append(table(read(folder / "scene_loop.csv"), LOOP_COLUMNS))
    stability = read(folder / "scene_stability.csv")
    parts.append("<h3>Stability at its walls, without a device</h3>")
    if stability:
        parts.append("<p>A disc of the tool's mass on each surface that was touched, judged as in the maps below.</p>")
        parts.append(table(walls(stability), WALL_COLUMNS))
    else:
        parts.append("<p>Nothing was touched.</p>")
    parts.append("<h3>What the scene leaves out</h3>")
    parts.append(plan(folder, about))
    return "\n".join(parts)
