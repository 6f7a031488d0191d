#pragma once
/// Linkages that nobody holds beside a held tool: all are stepped in turn, and a contact between two of them
/// is solved by the one whose turn comes first, at every haptic step. Loop thread; allocates nothing.

#include <haptics/core/local_model/data.hpp>

namespace haptics {

/// How a link answers the next wrench on its center of mass.
struct LinkResponse {
    /// Velocity (m/s, m/s, rad/s) for a unit impulse, symmetric; singular where joints forbid a motion.
    Mat3 mobility{Mat3::Zero()};
    /// Mean acceleration without that wrench, m/s^2, m/s^2, rad/s^2.
    Twist acceleration{0.0, 0.0, 0.0};
};

/// The answer of `link` over the next `dt` s, after a step: springs, dampers, limits and contacts of the
/// linkage go on as in that step, and what it was pushed with since end_pushes() acts. A link that the
/// linkage does not have yields to nothing.
LinkResponse link_response(const Model& model, const Data& data, int link, double dt);

/// From now on `wrench` acts on `link` of the linkage that is the tool of `data`, beside what does already.
void push_link(Data& data, int link, const Wrench& wrench);

/// None of those acts any more.
void end_pushes(Data& data);

/// Before a step of `dt` s of the model that `data` belongs to: its bodies that are links of the linkage
/// number `id` are where `linkage` has them, and yield as they do.
void follow_linkage(Data& data, std::uint64_t id, const Model& model, const Data& linkage, double dt);

/// After that step, before the linkage's own of the same length: hands over what the tool gave to its links.
void push_linkage(Data& data, std::uint64_t id, Data& linkage, double dt);

} // namespace haptics
