"""The pictures of the laboratory report, as base64 PNG by name."""

from __future__ import annotations

import base64
import io
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.colors import ListedColormap

from lab_html import GOLDEN, read

COLORS = {
    "semi_implicit": "#e8590c",
    "linearly_implicit": "#3b5bdb",
    "exact": "#2b8a3e",
    "adams_bashforth4": "#868e96",
    "runge_kutta4": "#ae3ec9",
    "dormand_prince8": "#0c8599",
}
METHODS = {"penalty": "springs alone", "penalty_impulse": "with collision impulses", "paper": "the paper's preset"}
# of the simulated device, N s/m
DEVICE_DAMPING = 1.0
VERDICTS = ["stable", "chattering", "unstable"]
VERDICT_COLORS = ListedColormap(["#b2f2bb", "#ffec99", "#ffc9c9"])


def encode(figure) -> str:
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=80)
    plt.close(figure)
    return base64.b64encode(buffer.getvalue()).decode("ascii")


def draw_error(rows) -> str:
    """One panel per method."""
    methods = list(dict.fromkeys(r["method"] for r in rows))
    figure, axes = plt.subplots(
        1, len(methods), figsize=(1.0 + 4.2 * max(2, len(methods)), 4.0), sharex=True, sharey=True, squeeze=False, layout="constrained"
    )
    for axis, method in zip(axes[0], methods):
        own = [r for r in rows if r["method"] == method]
        for scheme in dict.fromkeys(r["integrator"] for r in own):
            points = [r for r in own if r["integrator"] == scheme]
            cost = [float(r["us_per_simulated_s"]) for r in points]
            error = [float(r["position_rms_m"]) for r in points]
            axis.plot(cost, error, lw=0.8, alpha=0.5, color=COLORS[scheme])
            for worth, mark, face in (("seen", "o", COLORS[scheme]), ("upper_bound", "v", "none"), ("not_converged", "x", COLORS[scheme])):
                at = [i for i, r in enumerate(points) if r["error_is"] == worth]
                axis.scatter([cost[i] for i in at], [error[i] for i in at], s=26, marker=mark, edgecolors=None if mark == "x" else COLORS[scheme], facecolors=face, zorder=3)
            axis.plot([], [], "o-", ms=4, color=COLORS[scheme], label=scheme.replace("_", " "))
        front = sorted((float(r["us_per_simulated_s"]), float(r["position_rms_m"])) for r in own if r["front"] == "1")
        axis.step([p[0] for p in front], [p[1] for p in front], where="post", lw=1.6, color="#212529", label="front", zorder=1)
        for r in own:
            if r["recommended"] == "1":
                axis.scatter(
                    [float(r["us_per_simulated_s"])], [float(r["position_rms_m"])], s=170, facecolors="none", edgecolors="#212529", zorder=4
                )
                axis.annotate(f"{float(r['rate_hz']):g} Hz", (float(r["us_per_simulated_s"]), float(r["position_rms_m"])), (9, 9), textcoords="offset points")
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.grid(alpha=0.25)
        axis.set_title(METHODS[method], fontsize=10)
        axis.set_xlabel("run time, µs a simulated second")
    axes[0][0].set_ylabel("position error, m RMS")
    axes[0][-1].legend(fontsize=8, frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return encode(figure)


def edges(values):
    """Borders of the cells around values that grow by equal factors."""
    ratio = (values[1] / values[0]) ** 0.5 if len(values) > 1 else 2.0
    return [values[0] / ratio, *[v * ratio for v in values]]


def draw_map(axis, rows, x_name, y_name):
    """Verdicts over two logarithmic axes; the worst where several rows share a place."""
    x = sorted({float(r[x_name]) for r in rows})
    y = sorted({float(r[y_name]) for r in rows})
    grid = [[float("nan")] * len(x) for _ in y]
    for r in rows:
        if r["verdict"]:
            i, k = y.index(float(r[y_name])), x.index(float(r[x_name]))
            seen = float(VERDICTS.index(r["verdict"]))
            grid[i][k] = seen if grid[i][k] != grid[i][k] else max(grid[i][k], seen)
    axis.set_xscale("log")
    axis.pcolormesh(edges(x), range(len(y) + 1), grid, cmap=VERDICT_COLORS, vmin=-0.5, vmax=2.5, edgecolors="white", linewidth=0.3)
    axis.set_yticks([i + 0.5 for i in range(len(y))], [f"{v:g}" for v in y])
    return x, y


def draw_stability(rows) -> str:
    schemes = list(dict.fromkeys(r["integrator"] for r in rows))
    rates = list(dict.fromkeys(r["rate_hz"] for r in rows))
    figure, axes = plt.subplots(
        len(schemes), len(rates), figsize=(1.5 + 2.6 * len(rates), 7.5), sharex=True, sharey=True, squeeze=False, layout="constrained"
    )
    for i, scheme in enumerate(schemes):
        for k, rate in enumerate(rates):
            axis = axes[i][k]
            own = [r for r in rows if r["integrator"] == scheme and r["rate_hz"] == rate]
            x, masses = draw_map(axis, own, "stiffness_n_per_m", "mass_kg")
            if scheme == "semi_implicit":
                floor = {float(r["stiffness_n_per_m"]): float(r["semi_implicit_floor_kg"]) for r in own}
                line = [(s, place(floor[s], masses)) for s in x]
                axis.plot([p[0] for p in line], [p[1] for p in line], color="#212529", lw=1.4)
                if k == 0:
                    axis.text(0.97, 0.06, "line: K T² + 2 B T = 4 m", transform=axis.transAxes, ha="right", fontsize=8)
                axis.set_ylim(0, len(masses))
            axis.set_title(f"{scheme.replace('_', ' ')}, {float(rate):g} Hz", fontsize=9)
    for axis in axes[-1]:
        axis.set_xlabel("stiffness, N/m")
    for row in axes:
        row[0].set_ylabel("tool mass, kg")
    add_key(figure)
    return encode(figure)


def place(value, ticks):
    """Where a value falls among rows of cells at `ticks`, by its logarithm."""
    from math import log

    for i in range(len(ticks) - 1):
        if value <= ticks[i + 1] or i == len(ticks) - 2:
            return i + 0.5 + log(value / ticks[i]) / log(ticks[i + 1] / ticks[i])
    return 0.5


def add_key(figure):
    handles = [plt.Rectangle((0, 0), 1, 1, color=VERDICT_COLORS(i)) for i in range(3)]
    figure.legend(handles, VERDICTS, loc="outside upper center", ncols=3, frameon=False)


def loop_of(row) -> tuple[str, ...]:
    return (row["rate_hz"], row["delay_steps"], row["encoder_m"], row.get("coulomb_friction_n", "0"))


def pad(rows, loops):
    """Rows for every loop, so that the couplings share an axis: what was not measured stays white."""
    there = {r["loop"] for r in rows}
    first = rows[0]
    return rows + [{**first, "loop": str(i + 1), "verdict": ""} for i in range(len(loops)) if str(i + 1) not in there]


def draw_device(rows) -> str:
    couplings = list(dict.fromkeys(r["coupling"] for r in rows))
    loops = list(dict.fromkeys(loop_of(r) for r in rows))
    figure, axes = plt.subplots(1, len(couplings), figsize=(12, 1.6 + 0.28 * len(loops)), sharey=True, squeeze=False, layout="constrained")
    for axis, coupling in zip(axes[0], couplings):
        own = [
            {**r, "loop": str(loops.index(loop_of(r)) + 1)} for r in rows if r["coupling"] == coupling
        ]
        draw_map(axis, pad(own, loops), "stiffness_n_per_m", "loop")
        if coupling == "direct":
            for i, (rate, delay, encoder, friction) in enumerate(loops):
                bound = DEVICE_DAMPING * float(rate) / (0.5 + float(delay))
                axis.plot([bound, bound], [i, i + 1], color="#212529", lw=1.6)
                if float(friction) > 0.0:
                    bound = 2.0 * float(friction) / float(encoder)
                    axis.plot([bound, bound], [i, i + 1], color="#ae3ec9", lw=1.6)
            axis.plot([], [], color="#212529", lw=1.6, label="Colgate: K (T/2 + delay) = b")
            axis.plot([], [], color="#ae3ec9", lw=1.6, label="encoder and dry friction: K = 2 f / step")
            axis.legend(fontsize=7, loc="upper right")
        axis.set_title(coupling.replace("_", " "), fontsize=10)
        axis.set_xlabel("stiffness of the wall, N/m")
    names = [f"{float(r):g} Hz, {d} steps, {1e6 * float(e):g} µm" + (f", {float(f):g} N dry" if float(f) > 0.0 else "") for r, d, e, f in loops]
    axes[0][0].set_yticks([i + 0.5 for i in range(len(loops))], names, fontsize=8)
    add_key(figure)
    return encode(figure)


def draw_experiment1(rows) -> str:
    figure, axes = plt.subplots(1, 2, figsize=(11, 3.6), sharex=True, layout="constrained")
    for method, color in (("penalty", "#e8590c"), ("penalty_impulse", "#3b5bdb")):
        own = [r for r in rows if r["method"] == method]
        time = [float(r["t_s"]) for r in own]
        axes[0].plot(time, [float(r["contact_force_n"]) for r in own], lw=1.0, color=color, label=METHODS[method])
        axes[1].plot(time, [1e3 * float(r["tool_y_m"]) for r in own], lw=1.0, color=color, label=METHODS[method])
    axes[0].set_ylabel("contact force, N")
    axes[1].set_ylabel("tool above the wall, mm")
    for axis in axes:
        axis.set_xlabel("time, s")
        axis.grid(alpha=0.25)
        axis.legend(fontsize=8, frameon=False)
    return encode(figure)


def draw_feel(rows) -> str:
    scenes = list(dict.fromkeys(r["scene"] for r in rows))
    figure, axes = plt.subplots((len(scenes) + 1) // 2, 2, figsize=(11, 2.1 * ((len(scenes) + 1) // 2)), sharex=True, squeeze=False, layout="constrained")
    for axis in axes.flat[len(scenes) :]:
        axis.set_visible(False)
    for axis, scene in zip(axes.flat, scenes):
        own = [r for r in rows if r["scene"] == scene]
        for source, style, word in ((read(GOLDEN / f"feel_{scene}.csv"), {"lw": 3.0, "alpha": 0.35}, "kept"), (own, {"lw": 0.9}, "now")):
            for name, color, part in (("force_x_n", "#e8590c", "x"), ("force_y_n", "#3b5bdb", "y")):
                axis.plot([float(r["t_s"]) for r in source], [float(r[name]) for r in source], color=color, label=f"{part}, {word}", **style)
        axis.set_title(scene.replace("_", " "), fontsize=9)
        axis.set_ylabel("force, N")
        axis.set_xlabel("time, s")
        axis.grid(alpha=0.25)
    axes.flat[0].legend(fontsize=7, frameon=False, ncols=2)
    return encode(figure)


def draw_all(folder: Path) -> dict[str, str]:
    """All pictures whose table is there."""
    pictures = {}
    errors = read(folder / "error_vs_runtime.csv")
    for name in dict.fromkeys(r["experiment"] for r in errors):
        pictures[f"error_{name}"] = draw_error([r for r in errors if r["experiment"] == name])
    scene = read(folder / "scene_error.csv")
    if scene:
        pictures["scene_error"] = draw_error([{**r, "position_rms_m": r["position_rms_m"].replace("inf", "nan")} for r in scene])
    stability = read(folder / "stability.csv")
    if stability:
        pictures["stability"] = draw_stability(stability)
    trace = read(folder / "experiment1_trace.csv")
    if trace:
        pictures["experiment1"] = draw_experiment1(trace)
    feel = read(folder / "feel.csv")
    if feel:
        pictures["feel"] = draw_feel(feel)
    device = read(folder / "stability_device.csv")
    if device:
        pictures["stability_device"] = draw_device(device)
    return pictures
