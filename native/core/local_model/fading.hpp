#pragma once
// What appears or leaves while the tool stands in it.

#include <haptics/core/local_model/data.hpp>

namespace haptics::local {

// Whether the tool, or a movable that is joined to it, stands in neighbor `i`.
bool is_stood_in(const Data& data, std::int32_t i);

// Whether a contact with neighbor `i` goes on.
bool is_touched(const Data& data, std::int32_t i);

// Saves the neighbors that `next` no longer lists and that are touched or already fade into data.leavers.
void save_leavers(const BodySet& next, Data& data);

// Appends them to the neighbors again, behind those of the snapshot.
void append_leavers(Data& data);

// Forgets what has left, and ends the fade of what nothing stands in: before the contacts of a step are
// found.
void end_fades(Data& data);

// Sets how much of the fade is done, 0 (absent) to 1 (all there).
void set_presence(double u, Track& track, Body& body);

// Takes all fades on by `dt`.
void fade(double dt, Data& data);

// Share of stiffness and damping at the presence u, smooth at both ends.
inline double presence_weight(double u) {
    return u * u * (3.0 - 2.0 * u);
}

// Weighs the contacts with what fades: after they are found.
void weigh_contacts(Data& data);

} // namespace haptics::local
