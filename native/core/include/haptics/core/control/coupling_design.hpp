#pragma once
/// Chooses the coupling and the observer of one axis by computing the closed loop, not by rule of thumb.

namespace haptics {

/// What the loop of one axis consists of. Translation in kg, m, N; rotation in kg m^2, rad, N m.
struct LoopFigures {
    /// Handle's mass as assumed, > 0.
    double mass{0.3};
    /// Period, s, and time from the motion that a reading shows to the start of the force that answers it, s.
    double step{0.001};
    double delay{0.0};
    /// Step of the reading; 0 for one that is exact.
    double quantum{1e-5};
    /// Largest force noise that the quantum may cause (standard deviation).
    double noise{0.05};
    /// True: forces are fed forward both ways, with proxies between the two masses, as multiples of the
    /// handle's.
    bool four_channel{false};
    /// With four_channel: acceleration feed-forward (shared_motion.hpp) in place of the S form, and the most
    /// of the device's mass to hide in free motion, 0 to 0.95.
    bool transparent{false};
    double hidden{0.0};
    double lightest_proxy{0.05};
    double heaviest_proxy{20.0};
    /// Stiffness and damping of hands that hold on: from none to these.
    double hand_stiffness{2000.0};
    double hand_damping{20.0};
    /// Largest relative error of the mass.
    double mass_error{0.25};
};

/// One choice and what the computed loop does with it.
struct CouplingDesign {
    double stiffness{0.0}; ///< N/m
    double damping{0.0};   ///< N s/m
    double bandwidth{0.0}; ///< of the observer, rad/s
    double noise{0.0};     ///< N, caused by the quantum
    double hidden{0.0};    ///< of the device's mass, beside a proxy without mass
    /// |hand force / handle motion| against a hard wall at 5 and 30 Hz, N/m.
    double stiffness_5_hz{0.0};
    double stiffness_30_hz{0.0};
};

/// The stiffest choice at 5 and 30 Hz that stays stable, with a margin, for every proxy, hand and error of
/// the mass named in `wanted`; where the quantum makes more noise than allowed whatever is chosen, the
/// stiffest with the least power-of-two multiple of it. Takes some 20 ms and allocates: not for the haptic
/// loop.
CouplingDesign design_coupling(const LoopFigures& wanted);

/// What the loop really meets: the handle's mass, the hand, and a proxy pressed against a hard wall or free.
struct LoopCase {
    double true_mass{0.3};      ///< kg
    double hand_stiffness{0.0}; ///< N/m
    double hand_damping{0.0};   ///< N s/m
    double proxy_mass{0.3};     ///< kg
    bool wall{true};
};
/// Spectral radius of one step of that loop; stable below 1. For tests and reports. Allocates.
double spectral_radius(const LoopFigures& figures, const CouplingDesign& design, const LoopCase& loop);

/// What the solver of the proxy has to use so that the coupling has these gains at the end of the step,
/// although the handle yields to the force while it acts. `mobility` is the handle's 1/m on that axis.
struct SolverGains {
    double stiffness{0.0};
    double damping{0.0};
};
SolverGains solver_gains(double stiffness, double damping, double mobility, double step);

} // namespace haptics
