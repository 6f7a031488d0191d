#pragma once
/// All presets, and random poses well inside the workspace of each.

#include <haptics/core/pantograph/kinematics.hpp>
#include <haptics/core/pantograph/presets.hpp>

#include <vector>

#include "support/random.hpp"

namespace haptics::testing {

inline std::vector<PantographGeometry> all_presets() {
    return {pantograph_mk2(), haply_2diy_v2(), haply_2diy_v3(), ubc_twin_pantograph()};
}

/// A pose at least 3 mm inside reach, with singularity measure above 0.2.
inline Pose random_pose(const PantographKinematics& kinematics, Random& random) {
    for (;;) {
        Pose pose(random.uniform(-0.15, 0.15), random.uniform(-0.15, 0.15), 0.0);
        if (kinematics.freedoms() == 3)
            pose.z() = random.uniform(-1.0, 1.0);
        const WorkspaceReport report = kinematics.workspace(pose);
        if (report.inside && report.reach_margin > 0.003 && report.singularity > 0.2)
            return pose;
    }
}

} // namespace haptics::testing
