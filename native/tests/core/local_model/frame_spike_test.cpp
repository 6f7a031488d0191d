// Frames that come late: the scene's thread is blocked for 50 ms, 500 ms and 3 s, or draws 20 frames a second
// with 60 ticks, while the tool is pressed on what moves. Step by step the force is compared with that of the
// same motion undisturbed; nothing here depends on a real clock.

#include <doctest/doctest.h>

#include <string>

#include "frame_world.hpp"

using namespace haptics;
using namespace haptics::frames;

TEST_CASE(
    "a late frame changes the force in no step by more than 7 % or 0.05 N beyond what the motion does") {
    for (const Drift& drift : k_drifts)
        for (const Frames& frames : k_frames)
            for (const Reading reading : {Reading::last, Reading::each})
                for (const double phase : {0.0, 0.0057, 0.0131})
                    for (const double damping : {20.0, 100.0}) {
                        // a long block has time to forget how it began
                        if ((frames.block == 0.0 || frames.block > 0.1) && phase > 0.0)
                            continue;
                        if (reading == Reading::last && damping > 20.0)
                            continue;
                        const std::string motion = drift.name;
                        const std::string late = frames.name;
                        CAPTURE(motion);
                        CAPTURE(late);
                        CAPTURE(phase);
                        CAPTURE(damping);
                        LateFrameCase c{drift, frames, reading, phase};
                        c.damping = damping;
                        const Seen seen = compare(c);
                        CHECK(seen.ratio < 1.0);
                        // bounded, and neither lost nor thrown
                        CHECK(seen.largest < 1.1 * seen.largest_true);
                        CHECK(seen.smallest > 0.9 * seen.smallest_true);
                    }
}

// A body that came to rest while the scene stood still takes the tool along until it slips again: that is
// friction's own doing, and its force falls by what static friction is above the dynamic one.
TEST_CASE("after a long block a rough body that stopped is slipped on once more, and nothing else jumps") {
    for (const Drift& drift : k_drifts)
        for (const Reading reading : {Reading::last, Reading::each}) {
            const std::string motion = drift.name;
            CAPTURE(motion);
            LateFrameCase c{drift, k_frames[2], reading};
            c.dynamic = 0.75;
            const Seen seen = compare(c);
            const double drop = (1.0 - c.dynamic) * drift.friction * seen.largest_true;
            CHECK(seen.excess < 1.05 * drop + 0.05);
        }
}
