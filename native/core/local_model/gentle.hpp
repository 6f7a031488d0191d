#pragma once
// How a path that a new snapshot corrects goes over to it where it is felt.

#include <haptics/core/local_model/data.hpp>

namespace haptics::local {

struct Blending {
    double time;
    // share of the correction that contacts feel as motion
    double felt;
};

// The shortest of the blends that last `least` s or more, up to `most` s, and that change the force of no
// contact with neighbor `i` faster than an update may. `by` is where the body is shown less where its new
// path has it, with the velocity that contacts feel.
Blending gentle_blending(const Data& data, std::int32_t i, const PathOffset& by, double least, double most);

// How long a body has to take to move by `distance`, m, with the tool that just touches it.
double gentle_time(const Data& data, const Surface& surface, double distance);

} // namespace haptics::local
