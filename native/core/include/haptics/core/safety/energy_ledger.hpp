#pragma once
/// Books the energy that crosses the device port, to tell whether the controller creates any.

#include <haptics/core/types.hpp>

namespace haptics {

/// Energy at the device port. With F_k the applied wrench (device on hand) held from sample k to k+1, x the
/// handle pose, S the energy in virtual springs and inertias as told by the caller, U the work that moving
/// walls, gravity and other sources put in:
///   delivered = sum F_k . (x_{k+1} - x_k)
///   created   = delivered + (S - S_0) - U
/// A passive controller has created <= 0 at all times; the shortfall was dissipated. Call order in a loop:
/// read pose, `book`, then compute and send the next force, `set_force`. Nothing allocates. Non-finite input
/// is ignored and counted.
class EnergyLedger {
  public:
    /// Starts anew at `pose` (m, rad) with `stored` J in the virtual springs and no force.
    void reset(const Pose& pose, double stored = 0.0);
    /// The wrench (N, N, N m) that left the gate for the time until the next `book`.
    void set_force(const Wrench& applied);
    /// The handle arrived at `pose`; `stored` J are in the virtual springs now; `source_work` J came from
    /// elsewhere since the last call.
    void book(const Pose& pose, double stored = 0.0, double source_work = 0.0);

    /// The wrench of the last set_force.
    [[nodiscard]] const Wrench& force() const { return force_; }
    /// Net energy given to the hand since reset, J; negative when the hand put more in.
    [[nodiscard]] double delivered() const { return delivered_; }
    /// Energy out of nothing since reset, J; negative when energy was dissipated.
    [[nodiscard]] double created() const { return created_; }
    /// Largest `created` so far, J, >= 0: the figure named energy_injected_j.
    [[nodiscard]] double injected() const { return peak_; }
    /// Largest rise of `created` over any interval, J, >= 0: sees energy made after a dissipating start.
    [[nodiscard]] double largest_gain() const { return gain_; }
    /// Calls ignored for non-finite input.
    [[nodiscard]] long ignored() const { return ignored_; }

  private:
    Wrench force_{0.0, 0.0, 0.0};
    Pose pose_{0.0, 0.0, 0.0};
    double stored_start_{0.0};
    double sources_{0.0};
    double delivered_{0.0};
    double created_{0.0};
    double lowest_{0.0};
    double peak_{0.0};
    double gain_{0.0};
    long ignored_{0};
};

} // namespace haptics
