// Readings phi_m = phi(q) + e + g(q) + s: e the errors of the zeros (constant), g what errors of lengths do,
// s rounding and skew. The least squares hides all of it but the part along n(q), the direction that no
// motion explains:
//   r = n . misfit = n . (e + g(q) + s)   to first order.
// Differentiating |P - E|^2 = L^2 of leg i, with e, d its links as vectors, at a fixed handle:
//   (e x d) dphi = -(d . e/|e|) dl - L dL - d . dB + d . R(theta) da
// for errors dl, dL of its links, dB of its axis and da of its attachment. So r is linear in all k causes p,
// r = sum_k c_k(q) p_k + n . s, with known c and |p_k| <= t_k. For two readings of an honest device
//   |r_1 - r_2| <= sum_k |c_k(q_1) - c_k(q_2)| t_k + noise_1 + noise_2,   noise = sum_i |n_i| (error + skew
//   |phi_i'|),
// and no smaller bound holds, as each p_k may take its worst value. The causes cancel where the poses agree,
// hence the comparison with readings of a moment ago; where the encoder that slips is hardly seen (n_i near
// 0) the slip comes to light later, against readings from before at poses where it is. One reading alone must
// satisfy |r| <= sum |c_k| t_k
// + noise. What the first order leaves out is second order in t: covered by enlarging t by a tenth.

#include <haptics/core/safety/encoder_check.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace haptics {

namespace {

constexpr double k_enlarged = 1.1;
// readings closer than that to a landmark add none (rad, all joints together)
constexpr double k_landmark_distance = 0.15;
// faster joints are no honest readings: the allowance for skew stops there (rad/s)
constexpr double k_fastest_joint = 50.0;
// how far, and how finely, smallest_slip looks (rad, ratio)
constexpr double k_largest_slip = 0.05;
constexpr double k_finer = 1.05;

} // namespace

std::vector<FigureError> validate(const EncoderCheckSettings& settings) {
    FigureCheck check;
    check.range("reading_error", settings.reading_error, 0.5, 20.0, "counts",
                "Rounding alone is 0.5; 0.75 allows for uneven lines.");
    check.range("offset_tolerance", settings.offset_tolerance, 0.0, 0.1, "rad",
                "Give how well homing finds the zeros; 1e-3 is usual.");
    check.range("length_tolerance", settings.length_tolerance, 0.0, 0.01, "m",
                "Give how well the links are made; 1e-4 is usual.");
    check.range("sampling_skew", settings.sampling_skew, 0.0, 1.0e-3, "s",
                "Give the time in which the encoders of one reading are sampled; 1e-6 is usual.");
    check.range("patience", settings.patience, 1.0, 20.0, "readings", "3 is the default.");
    return check.take();
}

EncoderCheck::EncoderCheck(const PantographKinematics& kinematics, const EncoderCheckSettings& settings)
    : kinematics_(kinematics)
    , settings_(settings)
    , count_(2.0 * std::numbers::pi / kinematics.geometry().motor.counts_per_revolution) {}

void EncoderCheck::reset() {
    recent_count_ = 0;
    newest_ = 0;
    landmark_count_ = 0;
    has_last_ = false;
    against_ = 0;
    residual_ = 0.0;
    strain_ = 0.0;
    slipped_ = false;
}

bool EncoderCheck::describe(const JointVector& angles, const PoseEstimate& estimate, Reading& reading) const {
    const PantographState state = kinematics_.locate(estimate.pose);
    const JointVector n = kinematics_.unexplained(state);
    // out of reach, singular, or the least squares did not come to an end
    reading.residual = n.dot(estimate.misfit);
    if (!state.closed || n.isZero(0.0) || (estimate.misfit - reading.residual * n).norm() >= 0.1 * count_)
        return false;
    reading.angles = angles;
    reading.weight = n.cwiseAbs().sum();
    const double zero = k_enlarged * settings_.offset_tolerance;
    const double length = k_enlarged * settings_.length_tolerance;
    reading.noise = reading.weight * settings_.reading_error * count_;
    for (int i = 0; i < k_max_motors; ++i) {
        const LegState& leg = state.leg[static_cast<std::size_t>(i)];
        // row i of the rates is d over e x d
        const Vec2 line = state.rates.row(i).head<2>();
        reading.causes[i] = n[i] * zero;
        const int first = 4 + 4 * i;
        reading.causes[first] = -n[i] * line.dot(leg.proximal.normalized()) * length;
        // L / (e x d), with the sign of e x d
        reading.causes[first + 1] = -n[i] * std::copysign(line.norm(), line.dot(leg.distal)) * length;
        reading.causes.segment<2>(first + 2) = -n[i] * line * length;
        // both legs of a five-bar share the attachment
        reading.causes.segment<2>(20 + 2 * (i / 2)) += n[i] * line * length;
    }
    return true;
}

double EncoderCheck::strain_against(const Reading& now, const Reading& then) const {
    const double bound = (now.causes - then.causes).cwiseAbs().sum() + now.noise + then.noise;
    return std::abs(now.residual - then.residual) / std::max(bound, 1.0e-12);
}

void EncoderCheck::keep(const Reading& reading) {
    newest_ = (newest_ + 1) % k_recent;
    // the oldest makes room; all since then agreed with it, so it may become a landmark
    const Reading& oldest = recent_[static_cast<std::size_t>(newest_)];
    bool is_new = recent_count_ == k_recent && landmark_count_ < k_landmarks;
    for (int i = 0; i < landmark_count_ && is_new; ++i)
        is_new =
            (landmark_[static_cast<std::size_t>(i)].angles - oldest.angles).norm() >= k_landmark_distance;
    if (is_new)
        landmark_[static_cast<std::size_t>(landmark_count_++)] = oldest;
    recent_[static_cast<std::size_t>(newest_)] = reading;
    recent_count_ = std::min(recent_count_ + 1, k_recent);
}

bool EncoderCheck::update(const JointVector& angles, const PoseEstimate& estimate, double dt) {
    if (!possible() || slipped_ || !angles.allFinite() || !(dt > 0.0))
        return slipped_;
    Reading now;
    if (!describe(angles, estimate, now)) {
        // nothing to say, unless the angles belong to no pose at all
        const double absurd = 100.0 * (settings_.offset_tolerance + settings_.reading_error * count_) + 0.02;
        against_ = estimate.residual > absurd ? against_ + 1 : 0;
        slipped_ = against_ >= settings_.patience;
        has_last_ = false;
        return slipped_;
    }
    const double moved = has_last_ ? (angles - last_angles_).cwiseAbs().maxCoeff() : 0.0;
    now.noise += now.weight * settings_.sampling_skew * std::min(moved / dt, k_fastest_joint);
    residual_ = now.residual;

    // until a few readings agree there is nothing to contradict: begin anew with this one
    if (against_ > 0 && recent_count_ < settings_.patience && landmark_count_ == 0)
        recent_count_ = 0;

    // alone, against a moment ago, against all over
    strain_ = std::abs(residual_) / std::max(now.causes.cwiseAbs().sum() + now.noise, 1.0e-12);
    for (int age = 0; age < recent_count_; ++age) {
        const int place = (newest_ - age + k_recent) % k_recent;
        strain_ = std::max(strain_, strain_against(now, recent_[static_cast<std::size_t>(place)]));
    }
    for (int i = 0; i < landmark_count_; ++i)
        strain_ = std::max(strain_, strain_against(now, landmark_[static_cast<std::size_t>(i)]));

    if (strain_ > 1.0) {
        slipped_ = ++against_ >= settings_.patience;
    } else {
        against_ = 0;
        keep(now);
    }
    last_angles_ = angles;
    has_last_ = true;
    return slipped_;
}

double EncoderCheck::smallest_slip(const JointVector& angles, int i) const {
    constexpr double k_never = std::numeric_limits<double>::infinity();
    Reading before;
    if (!possible() || i < 0 || i >= kinematics_.motors() || !angles.allFinite() ||
        !describe(angles, kinematics_.forward(angles), before))
        return k_never;
    const auto seen = [&](double slip) {
        JointVector moved = angles;
        moved[i] += slip;
        Reading after;
        return describe(moved, kinematics_.forward(moved), after) && strain_against(after, before) > 1.0;
    };
    // no slip of less than the noise can show; from `least` on all do
    double least = k_never;
    for (double slip = before.noise; slip < k_largest_slip; slip *= k_finer) {
        if (!seen(slip) || !seen(-slip))
            least = k_never;
        else if (least == k_never)
            least = slip;
    }
    return least;
}

} // namespace haptics
