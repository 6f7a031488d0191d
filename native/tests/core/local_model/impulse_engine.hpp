#pragma once
/// A small rigid-body engine for the environment of tests, of the kind games have: at each tick contacts
/// become velocity constraints, solved by sequential impulses; overlap beyond a slop is pushed out slowly.

#include <haptics/core/contact/detection.hpp>

#include <algorithm>
#include <memory>
#include <vector>

namespace haptics::late {

class ImpulseEngine {
  public:
    double slop{7.5e-5};
    double push_out{0.2};
    int iterations{20};

    /// Moves the movable bodies of the set on by `dt`; impulses from outside are in their velocities already.
    void move(BodySet& set, double dt) {
        patches_->count = 0;
        detect_patches(none_, set, {0.002, dt, 0.00025}, *patches_, *patches_);
        rows_.clear();
        for (std::int32_t i = 0; i < patches_->count; ++i) {
            const Patch& p = patches_->patch[static_cast<std::size_t>(i)];
            for (std::int32_t k = 0; k < p.point_count; ++k)
                add(set, p, p.point[static_cast<std::size_t>(k)], dt);
        }
        for (int sweep = 0; sweep < iterations; ++sweep)
            for (Row& row : rows_)
                relax(row);
        for (std::int32_t i = 0; i < set.body_count; ++i) {
            Body& b = set.body[static_cast<std::size_t>(i)];
            if (b.kind == BodyKind::movable)
                b.pose += dt * b.velocity;
        }
    }

  private:
    struct Row {
        Body* a;
        Body* b;
        Vec3 on_a;
        Vec3 on_b;
        double bound; ///< lowest closing rate that is allowed
        double mobility;
        double impulse{0.0};
    };

    static Vec3 inverse(const Body& b) {
        return b.kind == BodyKind::movable ? Vec3(1.0 / b.mass, 1.0 / b.mass, 1.0 / b.inertia)
                                           : Vec3(Vec3::Zero());
    }

    void add(BodySet& set, const Patch& p, const PatchPoint& point, double dt) {
        Body& a = set.body[static_cast<std::size_t>(p.body_a)];
        Body& b = set.body[static_cast<std::size_t>(p.body_b)];
        Row row{&a, &b, Vec3::Zero(), Vec3::Zero(), 0.0, 0.0};
        const Vec2& n = p.normal;
        row.on_a << n, cross(point.position - a.pose.head<2>(), n);
        row.on_b << -n, -cross(point.position - b.pose.head<2>(), n);
        row.mobility =
            row.on_a.dot(inverse(a).cwiseProduct(row.on_a)) + row.on_b.dot(inverse(b).cwiseProduct(row.on_b));
        row.bound = point.gap > 0.0 ? -point.gap / dt : push_out * std::max(0.0, -point.gap - slop) / dt;
        if (row.mobility > 0.0)
            rows_.push_back(row);
    }

    static void relax(Row& row) {
        const double rate = row.on_a.dot(row.a->velocity) + row.on_b.dot(row.b->velocity);
        const double next = std::max(0.0, row.impulse - (rate - row.bound) / row.mobility);
        const double change = next - row.impulse;
        row.impulse = next;
        row.a->velocity += change * inverse(*row.a).cwiseProduct(row.on_a);
        row.b->velocity += change * inverse(*row.b).cwiseProduct(row.on_b);
    }

    BodySet none_;
    std::unique_ptr<PatchList> patches_{std::make_unique<PatchList>()};
    std::vector<Row> rows_;
};

} // namespace haptics::late
