#pragma once
// What a row gives for a motion: the laws of normal force and friction that all solvers share (derivation in
// integrate.cpp).

#include <haptics/core/local_model/contact_system.hpp>

#include <algorithm>
#include <cmath>

namespace haptics::local {

// A point that is apart at the start has no damper in this step: it would pull the brake before the touch.
inline double damping_of(const PointRow& p) {
    return p.gap > 0.0 ? 0.0 : p.damping;
}

// Closing it is a hit: it was apart, or overlapped without having been in contact.
inline bool may_collide(const ContactSystem& s, const PointRow& p) {
    const PatchRow& t = s.row[static_cast<std::size_t>(p.patch)];
    return p.was_apart || (!t.continuing && !t.collided);
}

inline double normal_sum(const ContactSystem& s, const PatchRow& t) {
    double sum = 0.0;
    for (int k = 0; k < t.point_count; ++k)
        sum += s.point[static_cast<std::size_t>(t.first_point + k)].force;
    return sum;
}

inline bool has_friction(const PatchRow& t) {
    return t.static_friction > 0.0 || t.bound > 0.0;
}

// Coulomb bound that holds now: static while sticking, dynamic while sliding
inline double friction_bound(const PatchRow& t, double normal) {
    return (t.was_sliding ? t.dynamic_friction : t.static_friction) * normal + t.bound;
}

inline bool slips(FrictionMode mode) {
    return mode == FrictionMode::slip_forward || mode == FrictionMode::slip_backward;
}

inline double slip_sign(FrictionMode mode) {
    return mode == FrictionMode::slip_forward ? 1.0 : -1.0;
}

// mode that follows from the force that the stuck spring would give
inline FrictionMode next_mode(const PatchRow& t, double trial, double normal) {
    if (normal <= 0.0 && t.bound <= 0.0)
        return FrictionMode::off;
    const double bound = slips(t.mode) ? t.dynamic_friction * normal + t.bound : friction_bound(t, normal);
    if (std::abs(trial) <= bound)
        return FrictionMode::stick;
    return trial > 0.0 ? FrictionMode::slip_forward : FrictionMode::slip_backward;
}

inline double friction_force(const PatchRow& t, FrictionMode mode, double trial, double normal) {
    if (mode == FrictionMode::off)
        return 0.0;
    return mode == FrictionMode::stick ? trial : slip_sign(mode) * (t.dynamic_friction * normal + t.bound);
}

// mode that the forces of a projected solution amount to
inline FrictionMode settled_mode(const PatchRow& t, double normal) {
    if (!has_friction(t) || (normal <= 0.0 && t.bound <= 0.0))
        return FrictionMode::off;
    if (std::abs(t.force) < friction_bound(t, normal))
        return FrictionMode::stick;
    return t.force > 0.0 ? FrictionMode::slip_forward : FrictionMode::slip_backward;
}

} // namespace haptics::local
