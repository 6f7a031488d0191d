#!/usr/bin/env python3
"""lab_html.py FOLDER [BENCH.json]: writes FOLDER/index.html from the CSV files beside it, with all pictures inside the page; benchmarks of
other engines become FOLDER/peers.csv."""

from __future__ import annotations

import csv
import html
import json
import sys
from pathlib import Path

import bench_table
import docs_tables

STYLE = """body{font:15px/1.5 system-ui,sans-serif;max-width:1000px;margin:2em auto;padding:0 1em;color:#212529}
h1{font-size:1.6em}h2{margin-top:2em;border-bottom:1px solid #dee2e6}table{border-collapse:collapse;font-size:13px;margin:1em 0}
td,th{padding:.2em .7em;border-bottom:1px solid #e9ecef;text-align:left;vertical-align:top}img{max-width:100%}
.FAIL,.fail{color:#c92a2a;font-weight:600}.pass{color:#2b8a3e}.note{color:#495057}
@media print{body{max-width:none;margin:0}h2{break-after:avoid}img,tr{break-inside:avoid}}"""


def read(path: Path) -> list[dict[str, str]]:
    """The rows of a CSV file by column; none when there is no such file."""
    if not path.exists():
        return []
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def number(text: str) -> str:
    """A number as short as it may be; other text as it is."""
    try:
        return f"{float(text):.3g}"
    except ValueError:
        return text


def table(rows: list[dict[str, str]], columns: dict[str, str]) -> str:
    """An HTML table of `columns` (name in the file: heading)."""
    lines = ["<table><tr>" + "".join(f"<th>{html.escape(title)}</th>" for title in columns.values()) + "</tr>"]
    for row in rows:
        cells = []
        for name in columns:
            text = number(row[name])
            mark = f' class="{text}"' if text in ("pass", "FAIL") else ""
            cells.append(f"<td{mark}>{html.escape(text)}</td>")
        lines.append("<tr>" + "".join(cells) + "</tr>")
    return "\n".join([*lines, "</table>"])


def picture(png: str, words: str) -> str:
    return f'<img alt="{html.escape(words)}" src="data:image/png;base64,{png}">'


def header(folder: Path) -> str:
    rows = read(folder / "host.csv")
    return table(rows, {"what": "measured on", "value": ""}) if rows else '<p class="fail">host.csv is missing.</p>'


def error_part(folder: Path, pictures: dict[str, str]) -> str:
    rows = read(folder / "error_vs_runtime.csv")
    reasons = read(folder / "recommended.csv")
    if not rows:
        return '<p class="fail">Not measured in this run.</p>'
    parts = [
        "<p>Each point is one integrator, rate and method. The error is against a reference of its own method, refined twice; an error "
        "below ten times what these refinements still changed is only known to be below that, and drawn there (hollow triangles); crosses: not converged, the doubt "
        "itself could be felt, and the row is left out of the choice. The line is the front: nothing "
        "of the same method is both cheaper and more accurate. Ringed: recommended. Run time is the median of processor time; compare ratios, not absolute figures.</p>"
    ]
    for motion, words in (("smooth", "Smooth motion"), ("contact", "Motion with contact events")):
        parts.append(f"<h3>{words}</h3>")
        for name in dict.fromkeys(r["experiment"] for r in reasons if r["motion"] == motion):
            own = [r for r in reasons if r["experiment"] == name]
            parts.append(f"<h4>{html.escape(name)}</h4><p>{html.escape(own[0]['title'])}</p>")
            if f"error_{name}" in pictures:
                parts.append(picture(pictures[f"error_{name}"], f"error against run time of {name}"))
            parts.append(table(own, {"method": "method", "reason": "recommended"}))
    return "\n".join(parts)


def stability_part(folder: Path, pictures: dict[str, str]) -> str:
    if not read(folder / "stability.csv"):
        return '<p class="fail">Not measured in this run.</p>'
    parts = [
        "<p>Proxy alone, wall damping 20 N s/m. Stable: a disturbance under a 2 N push does not outlive its start, and a thrown tool "
        "brings back at most 1 % more energy than it had. Chattering: either fails but nothing grows. Unstable: it grows. The line is the bound of the linear analysis for "
        "semi-implicit steps, m = (K T² + 2 B T) / 4: below it they must be unstable.</p>"
    ]
    parts += [picture(pictures[name], "stability of the proxy alone") for name in pictures if name == "stability"]
    device = read(folder / "stability_device.csv")
    if device:
        parts.append(
            "<p>With the device in the loop (0.3 kg, 1 N s/m, a hand that pushes with 2 N): stable when the handle swings by less than 50 µm, "
            "unstable from 5 mm or a fault on. Two bounds are drawn over direct rendering. Colgate's: the device's own damping b pays for half a step and the delay. And K = 2 f / step, with the dry "
            "friction f of the device and the step of its encoder: left of either, rest on the wall is kept (Diolaiti and others, 2006); left of both it is passive (Abbott and Okamura, 2005, who "
            "count no delay). The tool of the map arrives in motion, where dry friction does not help: there Colgate's counts. Without dry friction the second is 0, and what is left is a swing of about an encoder step.</p>"
        )
        parts += [picture(pictures[name], "stability with the device in the loop") for name in pictures if name == "stability_device"]
        parts.append(table(stiffest_walls(device), WALL_COLUMNS))
    return "\n".join(parts)


WALL_COLUMNS = {
    "coupling": "coupling",
    "rate_hz": "rate Hz",
    "delay_steps": "delay, steps",
    "encoder_m": "encoder m",
    "wall": "stiffest wall up to which all are stable, N/m",
    "times_direct": "times direct rendering",
}


LOOP = ("coupling", "rate_hz", "delay_steps", "encoder_m")


def stiffest_walls(rows: list[dict[str, str]]) -> list[dict[str, str]]:
    """For each loop, over all errors of the device's mass: the stiffest wall up to which every one is stable."""
    groups: dict[tuple[str, ...], dict[float, bool]] = {}
    for row in rows:
        if float(row.get("coulomb_friction_n", 0.0)) > 0.0:
            continue
        walls = groups.setdefault(tuple(row[k] for k in LOOP), {})
        wall = float(row["stiffness_n_per_m"])
        walls[wall] = walls.get(wall, True) and row["verdict"] == "stable"
    found = {}
    for key, walls in groups.items():
        best = 0.0
        for wall in sorted(walls):
            if not walls[wall]:
                break
            best = wall
        found[key] = best
    result = []
    for key, best in found.items():
        direct = found.get(("direct", *key[1:]), 0.0)
        ratio = f"{best / direct:.3g}" if direct > 0.0 else "direct is nowhere stable"
        names = dict(zip(LOOP, key))
        result.append({**names, "wall": f"{best:.3g}" if best > 0.0 else "none", "times_direct": ratio})
    return result


def experiment1_part(folder: Path, pictures: dict[str, str]) -> str:
    rows = read(folder / "experiment1.csv")
    if not rows:
        return '<p class="fail">Not measured in this run.</p>'
    parts = [
        "<p>Experiment 1 of the paper: a steady 2 N on the handle of a device of 0.3 kg and 1 N s/m drive the tool into a wall of 15000 N/m and 20 N s/m; "
        "encoder 10 µm, one step of delay, the coupling follows the rate. Settled: the contact force stays within 0.2 N of the push. The picture: 500 Hz, semi-implicit, "
        "tool of 0.3 kg.</p>"
    ]
    parts += [picture(pictures[name], "experiment 1, force and position against time") for name in pictures if name == "experiment1"]
    columns = {
        "method": "contact",
        "integrator": "integrator",
        "rate_hz": "rate Hz",
        "tool_mass_kg": "tool kg",
        "coupling_stiffness_n_per_m": "coupling N/m",
        "settles_s": "settles s",
        "force_swing_n": "swing N",
        "handle_swing_m": "swing of the handle m",
        "energy_created_j": "energy created J",
    }
    return "\n".join([*parts, table(rows, columns)])


GOLDEN = Path(__file__).resolve().parents[2] / "tests" / "golden"


def feel_changes(folder: Path) -> list[dict[str, str]]:
    """For each scene: RMS change of force and handle against the trace that is kept."""
    now: dict[str, list[dict[str, str]]] = {}
    for row in read(folder / "feel.csv"):
        now.setdefault(row["scene"], []).append(row)
    changes = []
    for scene, rows in now.items():
        then = read(GOLDEN / f"feel_{scene}.csv")
        if len(then) != len(rows):
            changes.append({"scene": scene, "force": "no trace is kept", "position": "", "largest": ""})
            continue

        def rms(names: tuple[str, ...]) -> float:
            return (sum((float(a[n]) - float(b[n])) ** 2 for a, b in zip(rows, then) for n in names) / len(rows)) ** 0.5

        largest = max((float(r["force_x_n"]) ** 2 + float(r["force_y_n"]) ** 2) ** 0.5 for r in then)
        force, place = rms(("force_x_n", "force_y_n")), rms(("handle_x_m", "handle_y_m"))
        changes.append({"scene": scene, "force": f"{force:.3g}", "position": f"{place:.3g}", "largest": f"{largest:.3g}"})
    return changes


def feel_part(folder: Path, pictures: dict[str, str]) -> str:
    changes = feel_changes(folder)
    if not changes:
        return '<p class="fail">Not measured in this run.</p>'
    words = (
        "<p>Handle and force on the hand in scenes whose traces are kept in tests/golden. A native test fails beyond 3.5 % of the largest force "
        "(half of what a hand tells apart) or 10 µm, RMS.</p>"
    )
    columns = {"scene": "scene", "force": "change of force, N RMS", "position": "change of the handle, m RMS", "largest": "largest force kept, N"}
    shown = "".join(picture(pictures[name], "force now and as kept") for name in pictures if name == "feel")
    return words + shown + table(changes, columns)


def experiment2_part(folder: Path) -> str:
    rows = read(folder / "experiment2.csv")
    if not rows:
        return '<p class="fail">Not measured in this run.</p>'
    columns = {name: name.replace("_", " ") for name in rows[0]}
    return (
        "<p>Experiment 2 of the paper: a linkage of three links held by its third, swung at 2 Hz and up to 0.9 m/s. Motion error: against the same hand on the linkage "
        "without a device.</p>"
    ) + table(rows, columns)


def extreme_part(folder: Path) -> str:
    rows = read(folder / "extreme.csv")
    if not rows:
        return '<p class="fail">Not measured in this run.</p>'
    failed = [r for r in rows if r["result"] != "pass"]
    words = f"{len(rows) - len(failed)} of {len(rows)} pass" + ("; what fails comes first." if failed else ".")
    columns = {name: name.replace("_", " ") for name in rows[0]}
    return f"<p>{words} A case also fails when anything is not finite or when a force leaves the output gate above its limit.</p>" + table(
        failed + [r for r in rows if r["result"] == "pass"], columns
    )


def plan_part(folder: Path) -> str:
    rows = read(folder / "plan.csv")
    if not rows:
        return '<p class="fail">Not measured in this run.</p>'
    columns = {
        "scene": "scene",
        "integrator": "integrator",
        "bodies": "bodies",
        "bodies_sent": "sent",
        "ns_per_step_planned": "ns a step, planned",
        "ns_per_step_everything": "ns, everything on",
        "times_cheaper": "times cheaper",
        "largest_difference": "difference in motion",
        "left_out": "left out",
    }
    words = [
        "<p>Everything on: the whole scene is sent to the haptic loop and every stage of its step runs. Planned: what the scene really sends, the bodies within "
        "reach until its next tick, and the stages that have something to do.</p>"
    ]
    for row in rows:
        goal = float(row["times_asked"])
        if goal > 0.0:
            seen = float(row["times_cheaper"])
            mark = "pass" if seen >= goal else "fail"
            name = html.escape(f"{row['scene']}, {row['integrator'].replace('_', ' ')}")
            words.append(f'<p class="{mark}">{name}: {seen:.2g} times cheaper, wanted {goal:g}: {mark}.</p>')
    return "\n".join(words) + table(rows, columns)


def write_peers(bench: Path, out: Path) -> None:
    """The serial chains of a Google Benchmark result, ours and every other engine's, as rows; nothing without one."""
    if not bench.exists():
        return
    report = json.loads(bench.read_text(encoding="utf-8"))
    times, _ = bench_table.read(report)
    context = report.get("context", {})
    rows = []
    for links in bench_table.numbered(times, "dynamics/links:"):
        ours = times[f"dynamics/links:{links}"]
        for engine, name in bench_table.ENGINES.items():
            theirs = times.get(f"peer_{engine}/links:{links}")
            if theirs is None:
                continue
            asked = bench_table.RATIOS.get((engine, links), "")
            ratio = theirs.median / ours.median
            result = "" if asked == "" else "pass" if ratio >= asked else "FAIL"
            version, apart = (context.get(f"peer_{engine}{end}", "") for end in ("", "_difference"))
            rows.append([context.get("date", ""), links, name, version, apart, ours.median, ours.spread, theirs.median, theirs.spread, ratio, asked, result])
    missing = [name for engine, name in bench_table.ENGINES.items() if str(context.get(f"peer_{engine}", "")).startswith("missing")]
    rows += [["", "", name, "missing", "", "", "", "", "", "", "", ""] for name in missing]
    with open(out, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(PEER_COLUMNS)
        writer.writerows(rows)


PEER_COLUMNS = {
    "measured": "measured",
    "links": "links",
    "engine": "engine",
    "version": "version",
    "motion_differs_by": "its motion differs by",
    "ours_ns": "ours, ns",
    "ours_spread": "spread",
    "engine_ns": "engine, ns",
    "engine_spread": "spread",
    "times_ours": "times ours",
    "times_asked": "asked",
    "result": "result",
}


def peers_part(folder: Path) -> str:
    rows = read(folder / "peers.csv")
    if not rows:
        return "<p>Absent: no benchmark of other engines (build/bench.json of make bench) was there when this report was made.</p>"
    ahead = [f"{r['engine']} at {r['links']} links" for r in rows if r["times_ours"] and float(r["times_ours"]) < 1.0]
    words = f"<p class=\"fail\">Faster than ours: {html.escape(', '.join(ahead))}.</p>" if ahead else "<p>No engine measured is faster than ours.</p>"
    return words + (
        "<p>One semi-implicit step of a serial chain, accelerations with Coriolis terms included, in one run and on one core. Each engine has shown first that it "
        "computes our motion, and has what it does not need switched off (native/lab/peers says how). A spread is half of the range over the median.</p>"
    ) + table(rows, PEER_COLUMNS)


def doc_tables_part(folder: Path) -> str:
    parts = []
    for name, title in docs_tables.TABLES.items():
        rows = read(folder / f"{name}.csv")
        if rows:
            parts.append(f"<h3>{html.escape(title)}</h3>" + table(rows, {column: column for column in rows[0]}))
    return "\n".join(parts)


def page(folder: Path, pictures: dict[str, str]) -> str:
    """The whole page. `pictures`: name to base64 PNG."""
    import peers_html

    sections = [
        ("Other engines", peers_html.peers_part(folder) + peers_part(folder)),
        ("Error against run time", error_part(folder, pictures)),
        ("Experiment 1", experiment1_part(folder, pictures)),
        ("Experiment 2", experiment2_part(folder)),
        ("Stability", stability_part(folder, pictures)),
        ("Extreme cases", extreme_part(folder)),
        ("What a scene leaves out", plan_part(folder)),
        ("Regression of feel", feel_part(folder, pictures)),
    ]
    shown = doc_tables_part(folder)
    if shown:
        sections.append(("Tables of the documentation", shown))
    scene = next((r["value"] for r in read(folder / "scene.csv") if r["what"] == "scene"), "")
    if scene:
        import scene_html

        sections.insert(0, (html.escape(f"Scene {scene}"), scene_html.scene_part(folder, pictures)))
    body = "\n".join(f"<h2>{title}</h2>\n{text}" for title, text in sections)
    files = ", ".join(f'<a href="{p.name}">{p.name}</a>' for p in sorted(folder.glob("*.csv")))
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>Godot Haptics: laboratory report</title>'
        f"<style>{STYLE}</style></head><body>\n<h1>Laboratory report</h1>\n{header(folder)}\n"
        f'<p class="note">The figures behind it: {files}. docs/reports.md says how to read them.</p>\n{body}\n</body></html>\n'
    )


def main(folder: Path, bench: Path | None = None) -> None:
    import lab_plots

    if bench is not None:
        write_peers(bench, folder / "peers.csv")
    (folder / "index.html").write_text(page(folder, lab_plots.draw_all(folder)), encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    main(*map(Path, sys.argv[1:]))
