#pragma once
/// Pantographs that nobody designed: every figure random, no symmetry, all working and assembly modes. What
/// holds for these holds for more than the presets.

#include <haptics/core/pantograph/kinematics.hpp>

#include <cmath>

#include "support/random.hpp"

namespace haptics::testing {

/// One five-bar around an end point at the origin of its own axes' working side.
inline FiveBarGeometry random_bar(Random& random) {
    FiveBarGeometry bar;
    bar.base_spacing = random.below(4) == 0 ? 0.0 : random.uniform(0.01, 0.12);
    bar.base_angle = random.uniform(-3.1, 3.1);
    for (std::size_t k = 0; k < 2; ++k) {
        bar.proximal_length[k] = random.uniform(0.04, 0.16);
        bar.distal_length[k] = random.uniform(0.05, 0.18);
        bar.elbow_side[k] = random.below(2) == 0 ? +1 : -1;
    }
    bar.end_side = random.below(2) == 0 ? +1 : -1;
    const auto mass = [&random] { return random.uniform(0.003, 0.08); };
    bar.proximal_mass = mass();
    bar.proximal_center = random.uniform(0.1, 0.9);
    bar.proximal_inertia = random.uniform(1.0e-6, 6.0e-5);
    bar.distal_mass = mass();
    bar.distal_center = random.uniform(0.1, 0.9);
    bar.distal_inertia = random.uniform(1.0e-6, 6.0e-5);
    return bar;
}

/// A geometry that `validate` accepts, with home well inside: `bars` five-bars.
inline PantographGeometry random_geometry(Random& random, int bars) {
    for (;;) {
        PantographGeometry g;
        g.bar_count = bars;
        for (std::size_t b = 0; b < static_cast<std::size_t>(bars); ++b) {
            FiveBarGeometry& bar = g.bar[b] = random_bar(random);
            // the end point works somewhere in front of the motors
            const double reach = bar.proximal_length[0] + bar.distal_length[0];
            const Vec2 front = rotate(
                bar.base_angle, Vec2(random.uniform(-0.2, 0.2) * reach, random.uniform(0.3, 0.9) * reach));
            if (bars == 2)
                g.attachment[b] = Vec2(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05));
            bar.base_center = g.attachment[b] - front;
        }
        g.motor.torque_limit = random.uniform(0.05, 1.0);
        g.motor.rotor_inertia = random.uniform(1.0e-6, 2.0e-5);
        g.motor.counts_per_revolution = std::floor(random.uniform(4.0e3, 4.0e5));
        g.motor.viscous_friction = random.uniform(2.0e-4, 3.0e-3);
        g.motor.coulomb_friction = random.uniform(1.0e-3, 2.0e-2);
        for (std::size_t i = 0; i < k_max_motors; ++i) {
            g.gear_ratio[i] = random.uniform(0.5, 4.0);
            g.encoder_offset[i] = random.uniform(-3.0, 3.0);
            g.encoder_direction[i] = random.below(2) == 0 ? +1 : -1;
        }
        g.handle_mass = random.uniform(0.01, 0.2);
        g.handle_inertia = random.uniform(1.0e-6, 2.0e-4);
        g.rotation_limit = 1.0;
        if (!validate(g).empty())
            continue;
        const WorkspaceReport report = PantographKinematics(g).workspace(g.home);
        if (report.inside && report.reach_margin > 0.015 && report.singularity > 0.25)
            return g;
    }
}

/// A pose near home, at least 5 mm inside reach, with singularity measure above 0.15.
inline Pose pose_near_home(const PantographKinematics& kinematics, Random& random, double radius = 0.05) {
    for (;;) {
        Pose pose = kinematics.geometry().home;
        pose.x() += random.uniform(-radius, radius);
        pose.y() += random.uniform(-radius, radius);
        if (kinematics.freedoms() == 3)
            pose.z() += random.uniform(-0.6, 0.6);
        const WorkspaceReport report = kinematics.workspace(pose);
        if (report.inside && report.reach_margin > 0.005 && report.singularity > 0.15)
            return pose;
    }
}

} // namespace haptics::testing
