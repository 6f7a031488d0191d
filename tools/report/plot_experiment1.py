#!/usr/bin/env python3
"""plot_experiment1.py PENALTY.csv IMPULSE.csv OUT.png: force and position against time for both contact models."""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

PUSH_N = 2.0


def read(path):
    """The columns of a run.csv by name, as lists of numbers."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    return {name: [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


def main(penalty_path, impulse_path, out_path):
    runs = [("spring and damper alone", read(penalty_path)), ("with collision impulses", read(impulse_path))]
    figure, axes = plt.subplots(2, 2, figsize=(11, 6), sharex="col", sharey="row", constrained_layout=True)
    start = 1.0  # s: the hand begins to push
    for column, (title, run) in enumerate(runs):
        time = [t - start for t in run["t_s"]]
        force, position = axes[0][column], axes[1][column]
        force.set_title(title)
        force.plot(time, run["contact_force_y_n"], lw=0.8, color="#3b5bdb", label="contact force")
        force.axhline(PUSH_N, lw=1.0, ls="--", color="#868e96", label="push, 2 N")
        position.plot(time, [1e3 * y for y in run["device_y_m"]], lw=0.8, color="#e8590c", label="device")
        position.plot(time, [1e3 * y for y in run["proxy_y_m"]], lw=0.8, color="#3b5bdb", label="proxy")
        position.set_xlabel("time since the push began (s)")
        for axis in (force, position):
            axis.set_xlim(0.0, 2.0)
            axis.grid(alpha=0.25)
            axis.legend(loc="upper right", frameon=False)
    axes[0][0].set_ylabel("contact force (N)")
    axes[0][0].set_ylim(bottom=-1.0)
    axes[1][0].set_ylabel("height (mm)")
    figure.suptitle("2 N on a wall of 15000 N/m and 20 N s/m, 500 Hz, tool 1 kg, device 0.3 kg", fontsize=11)
    figure.savefig(out_path, dpi=110)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
