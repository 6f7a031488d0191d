#pragma once
/// Collision impulses on their way to the hand (eq. 7 of the paper, with actuators that have limits).
///
/// Eq. (7) turns an impulse into a force over one step. Real actuators saturate, so what does not fit is
/// spread over at most `k_spread` and dropped when the contact opens: felt later it would be a push out of
/// nothing. Invariant: delivered + pending + dropped = demanded.

#include <haptics/core/types.hpp>

namespace haptics {

class ImpulseChannel {
  public:
    /// An impulse is felt within this time or not at all, s.
    static constexpr double k_spread = 0.005;

    /// Adds an impulse (N s, N s, N m s).
    void demand(const Wrench& impulse);
    /// Mean force for the coming step of `dt` s, within `max_force` (N) and `max_torque` (N m).
    Wrench deliver(double dt, double max_force, double max_torque);
    /// What waits is dropped: the contact opened, or nobody holds the tool.
    void drop();

    [[nodiscard]] const Wrench& demanded() const { return demanded_; }
    [[nodiscard]] const Wrench& delivered() const { return delivered_; }
    [[nodiscard]] const Wrench& dropped() const { return dropped_; }
    [[nodiscard]] const Wrench& pending() const { return pending_; }

  private:
    Wrench demanded_{0.0, 0.0, 0.0};
    Wrench delivered_{0.0, 0.0, 0.0};
    Wrench dropped_{0.0, 0.0, 0.0};
    Wrench pending_{0.0, 0.0, 0.0};
    double time_left_{0.0};
};

} // namespace haptics
