#pragma once
/// Takes back energy that the loop created, by damping the handle until the ledger is even.

#include <haptics/core/types.hpp>

namespace haptics {

/// Time-domain passivity controller (Hannaford and Ryu 2002) on top of EnergyLedger. Nothing allocates.
class PassivityController {
  public:
    /// Most of the handle's momentum that is taken per step: more would overshoot with a sample of delay.
    static constexpr double k_most = 0.2;

    /// `reading_error`: largest reading error (m, m, rad): the ledger is uncertain by force times twice that,
    /// and what lies within is left alone. `slack`: energy that is left alone as well, J, >= 0.
    explicit PassivityController(const Vec3& reading_error, double slack = 5e-5);

    /// The wrench to add to the command (N, N, N m) in this step. `created`: of the ledger, J. `force`: the
    /// wrench that acts now. `twist`, `mass`: of the handle, device frame. `step`: s, > 0.
    Wrench damp(double created, const Wrench& force, const Twist& twist, const Mat3& mass, double step);
    /// Forgets the largest force.
    void reset() {
        most_.setZero();
        known_ = false;
    }
    /// Energy taken since the start, as commanded, J.
    [[nodiscard]] double taken() const { return taken_; }

  private:
    Vec3 quantum_;
    double slack_;
    /// Largest force so far on each freedom.
    Vec3 most_{0.0, 0.0, 0.0};
    double taken_{0.0};
    /// Growth of what was created per step, a mean over k_mean steps, looked ahead by k_ahead of them.
    static constexpr double k_mean = 8.0;
    static constexpr double k_ahead = 4.0;
    double rise_{0.0};
    double last_{0.0};
    bool known_{false};
};

} // namespace haptics
