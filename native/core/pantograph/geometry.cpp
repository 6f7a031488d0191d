#include <haptics/core/pantograph/geometry.hpp>
#include <haptics/core/pantograph/kinematics.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace haptics {

namespace {

constexpr const char* k_side = "Set it to +1 or -1.";
constexpr const char* k_metres = "Give lengths in meters.";
constexpr const char* k_kilograms = "Give masses in kilograms and inertias in kg m^2.";

std::vector<FigureError> validate_bar(const FiveBarGeometry& bar, const std::string& prefix) {
    FigureCheck check(prefix);
    check.range("base_center.x", bar.base_center.x(), -1.0, 1.0, "m", k_metres);
    check.range("base_center.y", bar.base_center.y(), -1.0, 1.0, "m", k_metres);
    check.range("base_angle", bar.base_angle, -2.0 * std::numbers::pi, 2.0 * std::numbers::pi, "rad",
                "Give angles in radians.");
    check.range("base_spacing", bar.base_spacing, 0.0, 1.0, "m", k_metres);
    for (std::size_t k = 0; k < 2; ++k) {
        const std::string at = "[" + std::to_string(k) + "]";
        check.range(("proximal_length" + at).c_str(), bar.proximal_length[k], 0.005, 1.0, "m", k_metres);
        check.range(("distal_length" + at).c_str(), bar.distal_length[k], 0.005, 1.0, "m", k_metres);
        if (bar.elbow_side[k] != 1 && bar.elbow_side[k] != -1)
            check.inconsistent(("elbow_side" + at).c_str(), bar.elbow_side[k], -1.0, 1.0, "", k_side);
    }
    if (bar.end_side != 1 && bar.end_side != -1)
        check.inconsistent("end_side", bar.end_side, -1.0, 1.0, "", k_side);
    check.range("proximal_mass", bar.proximal_mass, 0.0, 5.0, "kg", k_kilograms);
    check.range("proximal_center", bar.proximal_center, 0.0, 1.0, "",
                "Give the center as a share of the link's length.");
    check.range("proximal_inertia", bar.proximal_inertia, 0.0, 1.0, "kg m^2", k_kilograms);
    check.range("distal_mass", bar.distal_mass, 0.0, 5.0, "kg", k_kilograms);
    check.range("distal_center", bar.distal_center, 0.0, 1.0, "",
                "Give the center as a share of the link's length.");
    check.range("distal_inertia", bar.distal_inertia, 0.0, 1.0, "kg m^2", k_kilograms);
    return check.take();
}

// an end point that both legs of a five-bar reach: rings around two axes that are `spacing` apart
void check_legs_meet(const FiveBarGeometry& bar, const std::string& prefix, FigureCheck& all) {
    const auto reach = [&bar](std::size_t k) { return bar.proximal_length[k] + bar.distal_length[k]; };
    const auto hole = [&bar](std::size_t k) {
        return std::abs(bar.proximal_length[k] - bar.distal_length[k]);
    };
    const double spacing = bar.base_spacing;
    FigureCheck check(prefix);
    if (spacing >= reach(0) + reach(1))
        check.inconsistent("base_spacing", spacing, 0.0, reach(0) + reach(1), "m",
                           "The two arms cannot meet: lengthen the links or bring the motor axes together.");
    else
        for (std::size_t k = 0; k < 2; ++k)
            if (hole(k) >= spacing + reach(1 - k)) {
                // the other arm ends before this one, folded, begins
                check.inconsistent(
                    ("distal_length[" + std::to_string(k) + "]").c_str(), bar.distal_length[k],
                    std::max(0.0, bar.proximal_length[k] - spacing - reach(1 - k)),
                    bar.proximal_length[k] + spacing + reach(1 - k), "m",
                    "The two arms cannot meet: make the links of this one more alike, or the other arm "
                    "longer.");
                break;
            }
    all.append(check.take());
}

} // namespace

std::vector<FigureError> validate(const PantographGeometry& geometry) {
    FigureCheck check;
    if (geometry.bar_count != 1 && geometry.bar_count != 2) {
        check.inconsistent("bar_count", geometry.bar_count, 1.0, 2.0, "",
                           "Use 1 for a five-bar, 2 for a twin.");
        return check.take();
    }
    for (std::size_t b = 0; b < static_cast<std::size_t>(geometry.bar_count); ++b) {
        check.append(validate_bar(geometry.bar[b], "bar[" + std::to_string(b) + "]."));
        for (int axis = 0; axis < 2; ++axis)
            check.range(("attachment[" + std::to_string(b) + (axis == 0 ? "].x" : "].y")).c_str(),
                        geometry.attachment[b][axis], -0.5, 0.5, "m", k_metres);
    }
    const MotorFigures& motor = geometry.motor;
    check.range("motor.torque_limit", motor.torque_limit, 1.0e-4, 50.0, "N m",
                "Take the limit from the motor's data sheet.");
    check.range("motor.torque_constant", motor.torque_constant, 1.0e-4, 10.0, "N m/A",
                "Take the constant from the motor's data sheet.");
    check.range("motor.rotor_inertia", motor.rotor_inertia, 0.0, 0.1, "kg m^2", k_kilograms);
    check.range("motor.counts_per_revolution", motor.counts_per_revolution, 16.0, 1.0e9, "1/rev",
                "Count all four quadrature edges over one turn of the joint.");
    check.range("motor.viscous_friction", motor.viscous_friction, 0.0, 10.0, "N m s/rad",
                "Use 0 when it is unknown.");
    check.range("motor.coulomb_friction", motor.coulomb_friction, 0.0, 10.0, "N m",
                "Use 0 when it is unknown.");
    for (std::size_t i = 0; i < static_cast<std::size_t>(geometry.motors()); ++i) {
        const std::string at = "[" + std::to_string(i) + "]";
        check.range(("gear_ratio" + at).c_str(), geometry.gear_ratio[i], 0.1, 500.0, "",
                    "Give motor turns per joint turn; 1 without a gear.");
        check.range(("encoder_offset" + at).c_str(), geometry.encoder_offset[i], -4.0 * std::numbers::pi,
                    4.0 * std::numbers::pi, "rad", "Give angles in radians.");
        if (geometry.encoder_direction[i] != 1 && geometry.encoder_direction[i] != -1)
            check.inconsistent(("encoder_direction" + at).c_str(), geometry.encoder_direction[i], -1.0, 1.0,
                               "", k_side);
    }
    check.range("handle_mass", geometry.handle_mass, 0.001, 10.0, "kg", k_kilograms);
    check.range("handle_inertia", geometry.handle_inertia, 1.0e-8, 1.0, "kg m^2", k_kilograms);
    check.range("rotation_limit", geometry.rotation_limit, 0.01, std::numbers::pi, "rad",
                "Give angles in radians.");
    for (int axis = 0; axis < 3; ++axis)
        check.range(axis == 0   ? "home.x"
                    : axis == 1 ? "home.y"
                                : "home.theta",
                    geometry.home[axis], -4.0, 4.0, axis == 2 ? "rad" : "m",
                    "Put home in the middle of the workspace.");
    if (!check.good())
        return check.take();

    // figures that are fine alone but not together
    for (std::size_t b = 0; b < static_cast<std::size_t>(geometry.bar_count); ++b)
        check_legs_meet(geometry.bar[b], "bar[" + std::to_string(b) + "].", check);
    if (geometry.bar_count == 1) {
        const double offset = geometry.attachment[0].norm();
        if (offset > 0.0)
            check.inconsistent("attachment[0]", offset, 0.0, 0.0, "m",
                               "A single five-bar cannot turn its handle: set the attachment to zero.");
    } else {
        const double apart = (geometry.attachment[1] - geometry.attachment[0]).norm();
        if (apart < 1.0e-3)
            check.inconsistent("attachment", apart, 1.0e-3, 1.0, "m",
                               "Let the two five-bars hold the handle at two different points.");
    }
    // home would only repeat it
    if (!check.good())
        return check.take();
    const PantographKinematics kinematics(geometry);
    const WorkspaceReport report = kinematics.workspace(geometry.home);
    const PantographState state = kinematics.locate(geometry.home);
    if (!state.closed || report.reach_margin < 0.0)
        check.inconsistent(
            "home", report.reach_margin, 0.0, 2.0, "m inside reach",
            "The arms do not reach the home pose: move home or the motors, or lengthen the links.");
    else if (!state.reachable)
        check.inconsistent(
            "home", 0.0, 1.0, 1.0, "of its assembly mode",
            "The end point is on the other side of the elbows there: change end_side, or move home.");
    else if (!report.inside)
        check.inconsistent("home", geometry.home.z(), -geometry.rotation_limit, geometry.rotation_limit,
                           "rad", "Turn home within rotation_limit.");
    else if (report.singularity < 0.01)
        check.inconsistent("home", report.singularity, 0.01, 1.0, "of singularity",
                           "Move home away from the pose in which the links line up.");
    return check.take();
}

} // namespace haptics
