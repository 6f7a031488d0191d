/// Angles, rates, sines and cosines of all bodies.
///
/// Planar angles add up: angle_s = angle_p + offset_s (+ q for a joint that turns), and so do the rates. In a
/// chain the sums of four neighbors are taken first and the sum of all before them is added last, so that one
/// addition a group waits for the group before; the sines follow in a loop of their own, four at a time.

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

/// Sums from the ground on: sum[i + 1] = part[0] + ... + part[i].
HAPTICS_ALWAYS_INLINE void add_up(int count, const double* part, double* sum) {
    double total = 0.0;
    int i = 0;
    for (; i + 4 <= count; i += 4) {
        const double two = part[i] + part[i + 1];
        const double three = two + part[i + 2];
        sum[i + 1] = total + part[i];
        sum[i + 2] = total + two;
        sum[i + 3] = total + three;
        total += three + part[i + 3];
        sum[i + 4] = total;
    }
    for (; i < count; ++i) {
        total += part[i];
        sum[i + 1] = total;
    }
}

/// Few bodies: their angles go from register to register, where a vector read of numbers that were just
/// written one by one would wait.
template <int N>
HAPTICS_ALWAYS_INLINE void rotate_few(const LinkageModel& model, LinkageData& data) {
    const double* q = data.position.data() + (model.floating ? 2 : 0);
    const double* v = data.velocity.data() + (model.floating ? 2 : 0);
    double angle[4] = {0.0, 0.0, 0.0, 0.0};
    double rate = 0.0;
    for (int i = 0; i < N; ++i) {
        const double turn = model.turn_offset[i + 1] + q[i];
        angle[i] = i > 0 ? angle[i - 1] + turn : turn;
        rate = i > 0 ? rate + v[i] : v[i];
        data.angle[i + 1] = angle[i];
        data.rate[i + 1] = rate;
    }
    store_sincos(angle[0], angle[1], angle[2], angle[3], data.sine.data() + 1, data.cosine.data() + 1);
}

HAPTICS_ALWAYS_INLINE void rotate_chain(const LinkageModel& model, LinkageData& data) {
    const int count = model.body_count;
    switch (count) {
    case 1:
        return rotate_few<1>(model, data);
    case 2:
        return rotate_few<2>(model, data);
    case 3:
        return rotate_few<3>(model, data);
    case 4:
        return rotate_few<4>(model, data);
    default:
        break;
    }
    const double* q = data.position.data() + (model.floating ? 2 : 0);
    double turn[k_body_slots];
    for (int i = 0; i < count; ++i) {
        turn[i] = model.turn_offset[i + 1] + q[i];
    }
    add_up(count, turn, data.angle.data());
    add_up(count, data.velocity.data() + (model.floating ? 2 : 0), data.rate.data());
    // the arrays are padded: the last group may reach beyond the last body
    bool in_range = true;
    for (int slot = 1; slot <= count; slot += 4) {
        Lanes x;
        std::memcpy(&x, data.angle.data() + slot, sizeof(x));
        Lanes s;
        Lanes c;
        detail::sincos_in_range<Lanes, LaneBits>(x, s, c);
        std::memcpy(data.sine.data() + slot, &s, sizeof(s));
        std::memcpy(data.cosine.data() + slot, &c, sizeof(c));
    }
    for (int slot = 1; slot <= count; ++slot) {
        in_range &= std::fabs(data.angle[slot]) < k_sincos_range;
    }
    if (!in_range) [[unlikely]] {
        for (int slot = 1; slot <= count; ++slot) {
            fast_sincos(data.angle[slot], data.sine[slot], data.cosine[slot]);
        }
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
