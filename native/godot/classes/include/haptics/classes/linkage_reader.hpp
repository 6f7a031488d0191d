#pragma once
/// A linkage as the tool of a world, from the Dictionary of world_set_tool().

#include <haptics/classes/dictionary_reader.hpp>
#include <haptics/core/local_model/model.hpp>

namespace haptics {

struct LinkageTool {
    ToolModel tool;
    /// Coordinates at the start, and their rates.
    LinkageVector start;
    LinkageVector rates;
};

/// Reads keys `grounded`, `links` (parent, joint, frame, coordinate, rate, body, figures of the joint),
/// `base` (pose of the node of link 0 when it floats), `base_velocity` (of its center of mass), `grip_link`,
/// `grip_point` (axes of the link's node) and `grip_pose`. What is wrong is named as "links[2].mass" and so
/// on.
LinkageTool read_linkage_tool(const godot::Dictionary& from, Problems& problems);

} // namespace haptics
