#pragma once
/// State of a linkage and what is computed from it in a step. Constants live in LinkageModel.

#include <haptics/core/dynamics/linkage_model.hpp>

namespace haptics {

/// State. `position` and `velocity` are the truth; the rest is refreshed by the update_* functions.
struct LinkageData {
    /// Coordinates (rad or m; a floating base has x, y in m and theta in rad of its center of mass) and their
    /// rates.
    LinkageVector position;
    LinkageVector velocity;

    /// Angle (rad), rate (rad/s), cosine and sine of each body, by update_rotations().
    BodyNumbers angle{}, rate{}, cosine{}, sine{};
    /// Origin of each body's frame (m) and its velocity (m/s), scene axes, by update_positions().
    BodyNumbers x{}, y{}, velocity_x{}, velocity_y{};
    /// From the parent's origin to the body's (m) and sliding direction, scene axes, by update_positions().
    BodyNumbers arm_x{}, arm_y{}, axis_x{}, axis_y{};
    /// Acceleration of each origin when all joint accelerations are zero (m/s^2), by update_bias().
    BodyNumbers bias_x{}, bias_y{};
};

/// Sizes the state for `model` and sets it to zero.
void reset(const LinkageModel& model, LinkageData& data);

} // namespace haptics
