// Impulses and work of a run, as integrals of the series of its intervals, and its results.

#include <algorithm>

#include "exact_run.hpp"

namespace haptics::local {
namespace {

// integral over u in [0, 1] of a product of two series
double product_area(const Series& a, const Series& b, int terms) {
    double sum = 0.0;
    for (int i = terms - 1; i >= 0; --i)
        for (int j = terms - 1; j >= 0; --j)
            sum += a[static_cast<std::size_t>(i)] * b[static_cast<std::size_t>(j)] / (i + j + 1);
    return sum;
}

} // namespace

void ExactRun::normal_series(int i, Series& sum, double& scale) const {
    const PatchRow& t = patch(i);
    sum.fill(0.0);
    Series force;
    for (int q = t.first_point; q < t.first_point + t.point_count; ++q) {
        if (!point(q).active)
            continue;
        scale += force_series(flow_, q, force);
        for (std::size_t j = 0; j + 1 < static_cast<std::size_t>(flow_.terms); ++j)
            sum[j] += force[j];
    }
}

double ExactRun::normal_now(int i) const {
    const PatchRow& t = patch(i);
    double sum = 0.0;
    for (int q = t.first_point; q < t.first_point + t.point_count; ++q) {
        const PointRow& p = point(q);
        const double rate = flow_dot(row(q).row, flow_.velocity, flow_.freedoms) - p.drive;
        if (p.active)
            sum += std::max(0.0, -p.stiffness * row(q).displacement - p.damping * rate);
    }
    return sum;
}

// Work on the tool of a movable on the other side, whose velocity along a row is drive - J_m v.
void ExactRun::book_work(int i, const Series& tangent) {
    PatchRow& t = patch(i);
    if (t.movable < 0)
        return;
    const MovableState& m = data_.movable[static_cast<std::size_t>(t.movable)];
    if (m.row < 0)
        return;
    const auto side = [&](const FlowRow& r, const Series& force) {
        Series speed;
        for (std::size_t j = 0; j + 1 < static_cast<std::size_t>(flow_.terms); ++j) {
            speed[j] = 0.0;
            for (auto k = static_cast<std::size_t>(m.row); k < static_cast<std::size_t>(m.row) + 3; ++k)
                speed[j] -= r.row[k] * flow_.motion[j + 1][k];
            speed[j] *= static_cast<double>(j + 1);
        }
        return product_area(force, speed, flow_.terms - 1);
    };
    Series force;
    for (int q = t.first_point; q < t.first_point + t.point_count; ++q) {
        if (!point(q).active)
            continue;
        force_series(flow_, q, force);
        t.movable_work += side(row(q), force);
    }
    if (t.mode != FrictionMode::off)
        t.movable_work += side(row(row_of_patch(i)), tangent);
}

// impulses of the interval
void ExactRun::book_interval() {
    const auto area = [&](const Series& force) {
        double sum = 0.0;
        for (int j = flow_.terms - 2; j >= 0; --j)
            sum += force[static_cast<std::size_t>(j)] / (j + 1);
        return flow_.span * sum;
    };
    Series force;
    for (int i = 0; i < s_.patches; ++i) {
        const PatchRow& t = patch(i);
        double normal = 0.0;
        for (int q = t.first_point; q < t.first_point + t.point_count; ++q) {
            if (!point(q).active)
                continue;
            force_series(flow_, q, force);
            const double impulse = area(force);
            normal_impulse_[static_cast<std::size_t>(q)] += impulse;
            normal += impulse;
        }
        if (normal == 0.0 && t.mode == FrictionMode::off)
            continue;
        pressed_ = true;
        Series tangent;
        if (t.mode == FrictionMode::stick) {
            force_series(flow_, row_of_patch(i), tangent);
            tangent_impulse_[static_cast<std::size_t>(i)] += area(tangent);
        } else if (slips(t.mode)) {
            double scale = 0.0;
            normal_series(i, tangent, scale);
            for (double& term : tangent)
                term *= slip_sign(t.mode) * t.dynamic_friction;
            tangent[0] += slip_sign(t.mode) * t.bound;
            tangent_impulse_[static_cast<std::size_t>(i)] +=
                slip_sign(t.mode) * (t.dynamic_friction * normal + t.bound * flow_.span);
        }
        book_work(i, tangent);
    }
}

void ExactRun::write_back(double done) {
    for (int k = 0; k < s_.freedoms; ++k)
        s_.velocity(k) = flow_.velocity[static_cast<std::size_t>(k)];
    for (int i = 0; i < s_.points; ++i) {
        PointRow& p = point(i);
        p.gap = row(i).displacement;
        p.force = normal_impulse_[static_cast<std::size_t>(i)] / done;
    }
    for (int i = 0; i < s_.patches; ++i) {
        PatchRow& t = patch(i);
        t.force = tangent_impulse_[static_cast<std::size_t>(i)] / done;
        t.was_sliding = slips(t.mode);
        if (t.mode == FrictionMode::stick)
            t.spring = row(row_of_patch(i)).displacement;
        else if (t.mode == FrictionMode::off || t.stiffness <= 0.0)
            t.spring = 0.0;
        else
            t.spring = -slip_sign(t.mode) * (t.dynamic_friction * normal_now(i) + t.bound) / t.stiffness;
    }
}

ExactStart::ExactStart(const ContactSystem& s)
    : velocity_(s.velocity) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(s.points); ++i)
        gap_[i] = s.point[i].gap;
    for (std::size_t i = 0; i < static_cast<std::size_t>(s.patches); ++i) {
        spring_[i] = s.row[i].spring;
        was_sliding_[i] = s.row[i].was_sliding;
    }
}

void ExactStart::restore(ContactSystem& s) const {
    s.velocity = velocity_;
    for (std::size_t i = 0; i < static_cast<std::size_t>(s.points); ++i)
        s.point[i].gap = gap_[i];
    for (std::size_t i = 0; i < static_cast<std::size_t>(s.patches); ++i) {
        s.row[i].spring = spring_[i];
        s.row[i].was_sliding = was_sliding_[i];
    }
}

} // namespace haptics::local
