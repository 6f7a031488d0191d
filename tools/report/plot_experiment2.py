#!/usr/bin/env python3
"""plot_experiment2.py FREE.csv CONTACT.csv OUT.png: distance of handle and proxy, and the forces of contacts, against time."""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from plot_experiment1 import read

COLORS = {"wall_link_1_n": "#3b5bdb", "wall_link_2_n": "#e8590c", "object_link_3_n": "#2b8a3e"}
NAMES = {"wall_link_1_n": "link 1, wall", "wall_link_2_n": "link 2, wall", "object_link_3_n": "link 3, object"}


def main(free_path, contact_path, out_path):
    runs = [("nothing near", read(free_path)), ("a wall and an object in the way", read(contact_path))]
    figure, axes = plt.subplots(3, 2, figsize=(11, 7.5), sharex="col", sharey="row", constrained_layout=True)
    for column, (title, run) in enumerate(runs):
        time = [t - 1.0 for t in run["t_s"]]  # the hand begins to swing after a second
        place, error, force = (axes[row][column] for row in range(3))
        place.set_title(title)
        for name, label, color in (("device_x_m", "x", "#3b5bdb"), ("device_y_m", "y", "#e8590c")):
            place.plot(time, [1e3 * value for value in run[name]], lw=0.9, color=color, label=label)
        error.plot(time, [1e6 * value for value in run["error_m"]], lw=0.8, color="#495057")
        if column == 0:
            error.axhline(150.0, lw=1.0, ls="--", color="#868e96")
            error.annotate("150 µm", (0.03, 165.0), color="#868e96", fontsize=9)
        for name, color in COLORS.items():
            force.plot(time, run[name], lw=0.8, color=color, label=NAMES[name])
        force.set_xlabel("time since the swing began (s)")
        for axis in (place, error, force):
            axis.grid(alpha=0.25)
            axis.margins(x=0.01)
        if column == 1:
            place.legend(loc="upper right", frameon=False)
            force.set_ylim(top=29.0)
            force.legend(loc="upper center", frameon=False, ncol=3)
    axes[0][0].set_ylabel("handle (mm)")
    axes[1][0].set_ylabel("handle to proxy (µm)")
    axes[2][0].set_ylabel("contact force (N)")
    figure.suptitle("Three grounded links held by the third, 2 Hz and up to 0.9 m/s, observed at 1 kHz", fontsize=11)
    figure.savefig(out_path, dpi=110)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
