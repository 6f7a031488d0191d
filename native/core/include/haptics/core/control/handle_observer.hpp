#pragma once
/// Where the handle is when a force takes effect, how fast it moves, and how hard the hand pushes it: from
/// the encoders, the forces sent, and the device's mass. Derivation in handle_observer.cpp.

#include <haptics/core/types.hpp>

#include <array>

namespace haptics {

/// Observer of a handle's motion and of the force of the hand. Device frame. Loop thread only; nothing
/// allocates.
class HandleObserver {
  public:
    /// Most steps by which a device may be late.
    static constexpr int k_most_delay = 63;

    /// `step`: period of the loop, s, > 0. `delay`: time from the motion that a reading shows to the moment
    /// at which the force computed from it begins to act, s, 0 to k_most_delay steps (clamped). `bandwidth`:
    /// how fast the estimate of each freedom follows, rad/s, > 0.
    HandleObserver(double step, double delay, const Vec3& bandwidth);

    /// Forgets everything; the next sample is where the handle rests.
    void reset();
    /// A new sample. One that is not finite is left out.
    void correct(const Pose& measured);
    /// `applied` is sent to the device (N, N, N m) and acts `delay` later for one step; `mass` is the
    /// handle's mass matrix now. Ends the step: the next correct() is for the reading after it.
    void sent(const Wrench& applied, const Mat3& mass);

    /// Handle at the moment at which a force sent now begins to act (m, rad).
    [[nodiscard]] const Pose& pose() const { return pose_; }
    [[nodiscard]] const Twist& twist() const { return twist_; }
    /// Force of the hand, with the device's friction in it (N, N, N m).
    [[nodiscard]] const Wrench& hand_force() const { return hand_; }
    /// Handle one step after that moment, were no force sent: what a coupling that is solved for the end of
    /// the step has to aim at.
    [[nodiscard]] Pose pose_ahead() const;
    [[nodiscard]] Twist twist_ahead() const;
    /// False until the first sample.
    [[nodiscard]] bool started() const { return started_; }

  private:
    /// The state, all at the time of the reading.
    struct State {
        Pose pose{0.0, 0.0, 0.0};
        Twist twist{0.0, 0.0, 0.0};
    };
    void advance(State& state, const Wrench& force, double dt) const;
    /// The force sent `age` steps ago; 0 is the newest.
    [[nodiscard]] const Wrench& past(int age) const;
    void look_ahead();

    double step_;
    /// The force sent d steps ago acts for `part_` of the coming step, the one after it for the rest.
    int delay_{0};
    double part_{1.0};
    Vec3 gain_pose_;
    Vec3 gain_twist_;
    Vec3 gain_force_;
    Mat3 mass_{Mat3::Identity()};
    Mat3 mobility_{Mat3::Identity()};
    State state_;
    Wrench hand_{0.0, 0.0, 0.0};
    std::array<Wrench, k_most_delay + 1> ring_;
    int newest_{0};
    Pose pose_{0.0, 0.0, 0.0};
    Twist twist_{0.0, 0.0, 0.0};
    bool started_{false};
};

} // namespace haptics
