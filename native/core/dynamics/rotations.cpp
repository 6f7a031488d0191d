/// Angles, rates, sines and cosines of all bodies.
///
/// Planar angles add up: angle_s = angle_p + offset_s (+ q for a joint that turns), and so do the rates. In a
/// chain the sums of four neighbors are taken first and the sum of all before them is added last, so that one
/// addition a group waits for the group before.

#include <haptics/core/dynamics/kinematics.hpp>
#include <haptics/core/dynamics/multiversion.hpp>
#include <haptics/core/dynamics/sincos.hpp>

namespace haptics {
namespace {

/// Sines and cosines of four angles, with the slow path beyond the fast range.
HAPTICS_ALWAYS_INLINE void store_sincos(double a0, double a1, double a2, double a3, double* sine,
                                        double* cosine) {
    const Lanes x = {a0, a1, a2, a3};
    Lanes s;
    Lanes c;
    detail::sincos_in_range<Lanes, LaneBits>(x, s, c);
    std::memcpy(sine, &s, sizeof(s));
    std::memcpy(cosine, &c, sizeof(c));
    const bool in_range = (std::fabs(a0) < k_sincos_range) & (std::fabs(a1) < k_sincos_range) &
                          (std::fabs(a2) < k_sincos_range) & (std::fabs(a3) < k_sincos_range);
    if (!in_range) [[unlikely]] {
        fast_sincos(a0, sine[0], cosine[0]);
        fast_sincos(a1, sine[1], cosine[1]);
        fast_sincos(a2, sine[2], cosine[2]);
        fast_sincos(a3, sine[3], cosine[3]);
    }
}

/// Writes angles, rates, sines and cosines of the four bodies from `slot` on; returns through the sums.
HAPTICS_ALWAYS_INLINE void chain_group(LinkageData& data, int slot, const double* turn, const double* spin,
                                       double& angle, double& rate) {
    const double turn01 = turn[0] + turn[1];
    const double spin01 = spin[0] + spin[1];
    const double turn012 = turn01 + turn[2];
    const double spin012 = spin01 + spin[2];
    const double a0 = angle + turn[0];
    const double a1 = angle + turn01;
    const double a2 = angle + turn012;
    const double a3 = angle + (turn012 + turn[3]);
    store_sincos(a0, a1, a2, a3, data.sine.data() + slot, data.cosine.data() + slot);
    data.angle[slot] = a0;
    data.angle[slot + 1] = a1;
    data.angle[slot + 2] = a2;
    data.angle[slot + 3] = a3;
    data.rate[slot] = rate + spin[0];
    data.rate[slot + 1] = rate + spin01;
    data.rate[slot + 2] = rate + spin012;
    rate += spin012 + spin[3];
    data.rate[slot + 3] = rate;
    angle = a3;
}

HAPTICS_ALWAYS_INLINE void rotate_chain(const LinkageModel& model, LinkageData& data) {
    const int count = model.body_count;
    const double* q = data.position.data() + (model.floating ? 2 : 0);
    const double* v = data.velocity.data() + (model.floating ? 2 : 0);
    const double* offset = model.turn_offset.data() + 1;
    double angle = 0.0;
    double rate = 0.0;
    int i = 0;
    for (; i + 4 <= count; i += 4) {
        const double turn[4] = {offset[i] + q[i], offset[i + 1] + q[i + 1], offset[i + 2] + q[i + 2],
                                offset[i + 3] + q[i + 3]};
        chain_group(data, i + 1, turn, v + i, angle, rate);
    }
    const int left = count - i;
    if (left > 0) {
        // the arrays are padded: the last group reaches beyond the last body
        const double turn[4] = {offset[i] + q[i], left > 1 ? offset[i + 1] + q[i + 1] : 0.0,
                                left > 2 ? offset[i + 2] + q[i + 2] : 0.0, 0.0};
        const double spin[4] = {v[i], left > 1 ? v[i + 1] : 0.0, left > 2 ? v[i + 2] : 0.0, 0.0};
        chain_group(data, i + 1, turn, spin, angle, rate);
    }
}

HAPTICS_ALWAYS_INLINE void rotate_tree(const LinkageModel& model, LinkageData& data) {
    const double* q = data.position.data();
    const double* v = data.velocity.data();
    for (int slot = 1; slot <= model.body_count; ++slot) {
        const int parent = model.turn_parent[slot];
        const int freedom = model.turn_freedom[slot];
        const double gain = model.turn_gain[slot];
        data.angle[slot] = data.angle[parent] + (model.turn_offset[slot] + gain * q[freedom]);
        data.rate[slot] = data.rate[parent] + gain * v[freedom];
    }
    for (int slot = 1; slot <= model.body_count; slot += 4) {
        store_sincos(data.angle[slot], data.angle[slot + 1], data.angle[slot + 2], data.angle[slot + 3],
                     data.sine.data() + slot, data.cosine.data() + slot);
    }
}

HAPTICS_ALWAYS_INLINE void run(const LinkageModel& model, LinkageData& data) {
    if (model.is_chain) {
        rotate_chain(model, data);
    } else {
        rotate_tree(model, data);
    }
}

HAPTICS_BASELINE void run_baseline(const LinkageModel& model, LinkageData& data) {
    run(model, data);
}

#if HAPTICS_MULTIVERSION
HAPTICS_AVX2 void run_avx2(const LinkageModel& model, LinkageData& data) {
    run(model, data);
}
#endif

} // namespace

void update_rotations(const LinkageModel& model, LinkageData& data) {
#if HAPTICS_MULTIVERSION
    if (k_has_avx2) {
        run_avx2(model, data);
        return;
    }
#endif
    run_baseline(model, data);
}

} // namespace haptics
