#pragma once
// Exact motion of a mass matrix under linear springs and dampers, interval by interval.

#include <haptics/core/types.hpp>

#include <array>

#include "series.hpp"

namespace haptics::local {

inline constexpr int k_flow_freedoms = 24;
inline constexpr int k_flow_rows = 91;

using FlowVector = std::array<double, k_flow_freedoms>;

// One displacement d of the system, d' = row v - drive, and the spring-damper that may act along it: its
// force f = -stiffness d - damping d' accelerates the system by push f.
struct FlowRow {
    FlowVector row;
    FlowVector push;
    double stiffness{0.0};
    double damping{0.0};
    double drive{0.0};
    // d now
    double displacement{0.0};
    // |row| |push| in the metric of the mass matrix
    double mobility{0.0};
    bool acts{false};
};

// State of the motion, and the series of the interval that expand() looked at. Everything outside `freedoms`,
// `rows` and `terms` is not set.
struct Flow {
    int freedoms{0};
    int rows{0};
    FlowVector velocity;
    // acceleration by everything that is not a spring
    FlowVector free_acceleration;
    std::array<FlowRow, k_flow_rows> row;
    // how fast the acting springs can change the motion, 1/s; set by measure()
    double rate{0.0};

    // length of the interval, s, and its series in u = t / span: motion from its start, displacements
    double span{0.0};
    int terms{0};
    std::array<FlowVector, k_max_terms> motion;
    std::array<Series, k_flow_rows> shift;
};

// Bounds the rate of the motion for the springs that act now.
void measure(Flow& flow);

// Longest interval that one expansion covers.
double longest_span(const Flow& flow);

// Series of the coming interval; `span` at most longest_span.
void expand(Flow& flow, double span);

// Cuts the interval to its first `part`, 0 < part <= 1.
void shorten(Flow& flow, double part);

// Force of a row's spring-damper as a series, whether it acts or not; one term less than `terms`. Returns the
// size of what it was computed from.
double force_series(const Flow& flow, int row, Series& force);

// Goes to the end of the interval: velocity and displacements. Adds the motion to `moved` and its integral
// over time to `moved_time`. False, with nothing changed, when the end is not finite.
bool advance(Flow& flow, FlowVector& moved, FlowVector& moved_time);

} // namespace haptics::local
