#pragma once
/// All figures of a planar pantograph: one five-bar (x, y; two motors) or two that hold one handle (x, y,
/// theta; four motors).

#include <haptics/core/figure_error.hpp>
#include <haptics/core/types.hpp>

#include <array>
#include <numbers>
#include <vector>

namespace haptics {

/// Motors of the largest pantograph.
inline constexpr int k_max_motors = 4;

/// One five-bar. In its own axes leg 0 starts at (-base_spacing/2, 0), leg 1 at (+base_spacing/2, 0), and the
/// end point works at positive y. Angles of the proximal links are counter-clockwise from the device's x
/// axis.
struct FiveBarGeometry {
    /// Middle between the two motor axes, device frame, m, each within 1 m of the origin.
    Vec2 base_center{0.0, 0.0};
    /// Turn of the five-bar's axes in the device frame, rad, -2 pi to 2 pi.
    double base_angle{0.0};
    /// Distance between the two motor axes, m, 0 (coaxial) to 1.
    double base_spacing{0.025};
    /// Length of the driven links of legs 0 and 1, m, 0.005 to 1.
    std::array<double, 2> proximal_length{0.063, 0.063};
    /// Length of the links from elbow to end point, m, 0.005 to 1.
    std::array<double, 2> distal_length{0.075, 0.075};
    /// Working mode: +1 has the elbow left of the ray from the motor axis to the end point, -1 right of it.
    std::array<int, 2> elbow_side{+1, -1};
    /// Assembly mode: +1 has the end point left of the ray from elbow 0 to elbow 1, -1 right of it.
    int end_side{+1};
    /// Mass of a driven link, kg, 0 to 5, its center along the link as a share of the length, 0 to 1, and its
    /// moment of inertia about that center, kg m^2, 0 to 1. The same for both legs.
    double proximal_mass{0.02};
    double proximal_center{0.5};
    double proximal_inertia{7.0e-6};
    /// The same for a link from elbow to end point.
    double distal_mass{0.02};
    double distal_center{0.5};
    double distal_inertia{9.0e-6};
};

/// Motor, gear and encoder, the same on all axes but for direction, offset and gear.
struct MotorFigures {
    /// Largest torque at the motor shaft, N m, 1e-4 to 50.
    double torque_limit{0.123};
    /// Torque per current, N m/A, 1e-4 to 10.
    double torque_constant{0.05};
    /// Inertia of the rotor about its shaft, kg m^2, 0 to 0.1.
    double rotor_inertia{4.0e-6};
    /// Encoder counts per turn of the joint (after quadrature and gear), 16 to 1e9.
    double counts_per_revolution{4880.0};
    /// Viscous friction at the joint, N m s/rad, 0 to 10.
    double viscous_friction{0.0};
    /// Coulomb friction at the joint, N m, 0 to 10.
    double coulomb_friction{0.0};
};

/// The whole device. Plain data; `validate` says what cannot be built.
struct PantographGeometry {
    /// 1: a single five-bar with two freedoms. 2: twin, three freedoms.
    int bar_count{1};
    /// Five-bars; only the first bar_count count.
    std::array<FiveBarGeometry, 2> bar{};
    /// Where the end point of each five-bar holds the handle, handle axes, m, each within 0.5 m. Both zero
    /// for a single five-bar.
    std::array<Vec2, 2> attachment{Vec2::Zero(), Vec2::Zero()};
    /// Motor, gear and encoder figures.
    MotorFigures motor{};
    /// Turns of the motor per turn of the joint, 0.1 to 500.
    std::array<double, k_max_motors> gear_ratio{1.0, 1.0, 1.0, 1.0};
    /// Joint angle at encoder count 0, rad, -4 pi to 4 pi.
    std::array<double, k_max_motors> encoder_offset{0.0, 0.0, 0.0, 0.0};
    /// +1 when counts grow counter-clockwise, -1 otherwise.
    std::array<int, k_max_motors> encoder_direction{+1, +1, +1, +1};
    /// Mass of the handle, kg, 0.001 to 10, and its moment of inertia about the reference point, kg m^2, 1e-8
    /// to 1.
    double handle_mass{0.05};
    double handle_inertia{1.0e-5};
    /// The handle's mechanical stop, rad, 0.01 to pi (twin only).
    double rotation_limit{std::numbers::pi / 3.0};
    /// Pose in the middle of the workspace, device frame (m, m, rad): where a simulated handle starts.
    Pose home{0.0, 0.0, 0.0};

    /// Motors in use: 2 or 4.
    [[nodiscard]] int motors() const { return bar_count == 2 ? 4 : 2; }
    /// Freedoms of the handle: 2 or 3.
    [[nodiscard]] int freedoms() const { return bar_count == 2 ? 3 : 2; }
    /// Largest torque of joint i, N m.
    [[nodiscard]] double joint_torque_limit(int i) const {
        return motor.torque_limit * gear_ratio[static_cast<std::size_t>(i)];
    }
};

/// Everything that makes the geometry unusable: figures out of range, and a home that the arms cannot reach.
/// Empty when usable. Allocates; not for the haptic loop.
std::vector<FigureError> validate(const PantographGeometry& geometry);

} // namespace haptics
