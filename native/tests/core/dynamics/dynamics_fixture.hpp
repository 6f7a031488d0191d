#pragma once
/// What the dynamics tests share: building, random states, and the independent mass matrix.

#include <haptics/core/dynamics/energy.hpp>
#include <haptics/core/dynamics/jacobian.hpp>
#include <haptics/core/dynamics/kinematics.hpp>
#include <haptics/shared/linkages.hpp>

#include <doctest/doctest.h>

#include <memory>

namespace haptics::testing {

/// A model with its data.
struct Linkage {
    LinkageModel model;
    LinkageData data;

    explicit Linkage(const LinkageSpec& spec) {
        const auto faults = build_model(spec, model);
        for (const LinkageFault& fault : faults) {
            FAIL(describe(fault));
        }
        reset(model, data);
    }
};

inline LinkageVector random_vector(shared::Random& random, int size, double reach) {
    LinkageVector vector(size);
    for (int i = 0; i < size; ++i) {
        vector[i] = random.uniform(-reach, reach);
    }
    return vector;
}

/// Any state; every fourth is stretched, every fourth folded (angles 0 or pi).
inline void randomize(Linkage& linkage, shared::Random& random, int round) {
    const int n = linkage.model.freedoms;
    linkage.data.position = random_vector(random, n, 3.0);
    if (round % 4 == 1) {
        linkage.data.position.setZero();
    }
    if (round % 4 == 3) {
        for (int i = 0; i < n; ++i) {
            linkage.data.position[i] = random.integer(0, 1) == 0 ? 0.0 : std::numbers::pi;
        }
    }
    linkage.data.velocity = random_vector(random, n, 5.0);
    update_kinematics(linkage.model, linkage.data);
}

/// D as the sum of J^T diag(m, m, I) J over the links' centers of mass: independent of the composite method.
inline LinkageMatrix summed_mass_matrix(const Linkage& linkage) {
    const LinkageModel& model = linkage.model;
    LinkageMatrix mass;
    mass.setZero(model.freedoms, model.freedoms);
    for (int link = 0; link < model.link_count; ++link) {
        PointJacobian jacobian;
        const Vec2 center = link_center_pose(model, linkage.data, link).head<2>();
        point_jacobian(model, linkage.data, link, center, jacobian);
        const Vec3 weight(model.link[link].mass, model.link[link].mass, model.link[link].inertia);
        mass += (jacobian.transpose() * weight.asDiagonal() * jacobian).eval();
    }
    return mass;
}

/// C + G as the sum of J^T (m (J' q' - g), 0) over the links' centers.
inline LinkageVector summed_bias(const Linkage& linkage) {
    const LinkageModel& model = linkage.model;
    LinkageVector bias;
    bias.setZero(model.freedoms);
    for (int link = 0; link < model.link_count; ++link) {
        const Vec2 center = link_center_pose(model, linkage.data, link).head<2>();
        Vec3 acceleration = point_bias(model, linkage.data, link, center);
        if (!model.coriolis) {
            acceleration.setZero();
        }
        acceleration.head<2>() -= model.gravity;
        acceleration.z() = 0.0;
        add_wrench(model, linkage.data, link, center, model.link[link].mass * acceleration, bias);
    }
    return bias;
}

} // namespace haptics::testing
