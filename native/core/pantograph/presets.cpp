// Where the figures come from. "Assumed" marks what no public description gives; replace it by what you
// measure.

#include <haptics/core/pantograph/presets.hpp>

#include <numbers>

namespace haptics {

namespace {

constexpr double k_degree = std::numbers::pi / 180.0;

// a thin rod about its middle, kg m^2
double rod(double mass, double length) {
    return mass * length * length / 12.0;
}

void set_links(FiveBarGeometry& bar, double proximal, double distal, double kilograms_per_meter) {
    bar.proximal_length = {proximal, proximal};
    bar.distal_length = {distal, distal};
    bar.proximal_mass = proximal * kilograms_per_meter;
    bar.distal_mass = distal * kilograms_per_meter;
    bar.proximal_inertia = rod(bar.proximal_mass, proximal);
    bar.distal_inertia = rod(bar.distal_mass, distal);
}

PantographGeometry haply(double spacing, double counts) {
    PantographGeometry g;
    // links 70/90 mm, spacing, counts and 0.123 N m at the joint as published; masses and inertias assumed
    set_links(g.bar[0], 0.070, 0.090, 0.25);
    g.bar[0].base_spacing = spacing;
    g.bar[0].base_center = Vec2(0.0, -0.100);
    g.motor.torque_limit = 0.123;
    g.motor.counts_per_revolution = counts;
    g.motor.rotor_inertia = 4.0e-6;
    g.handle_mass = 0.04;
    // as published: leg 0 is the left one here
    g.encoder_offset = {168.0 * k_degree, 12.0 * k_degree, 0.0, 0.0};
    g.encoder_direction = {+1, +1, +1, +1};
    return g;
}

} // namespace

PantographGeometry pantograph_mk2() {
    PantographGeometry g;
    // links 63/75 mm, motor axes 25 mm apart: published
    set_links(g.bar[0], 0.063, 0.075, 0.2);
    g.bar[0].base_spacing = 0.025;
    g.bar[0].base_center = Vec2(0.0, -0.090);
    // assumed: motor, encoder and masses
    g.motor.torque_limit = 0.15;
    g.motor.counts_per_revolution = 65536.0;
    g.motor.rotor_inertia = 3.0e-6;
    g.handle_mass = 0.03;
    return g;
}

PantographGeometry haply_2diy_v2() {
    return haply(0.0, 10752.0);
}

PantographGeometry haply_2diy_v3() {
    return haply(0.038, 4880.0);
}

PantographGeometry ubc_twin_pantograph() {
    PantographGeometry g;
    // only the layout is published (two five-bars that hold one handle, four motors): every figure below is
    // assumed
    g.bar_count = 2;
    for (std::size_t b = 0; b < 2; ++b) {
        set_links(g.bar[b], 0.140, 0.180, 0.2);
        g.bar[b].base_spacing = 0.060;
        g.bar[b].base_center = Vec2(b == 0 ? -0.200 : 0.200, 0.0);
        // the left five-bar works to the right, the right one to the left
        g.bar[b].base_angle = (b == 0 ? -90.0 : 90.0) * k_degree;
    }
    g.attachment = {Vec2(-0.030, 0.0), Vec2(0.030, 0.0)};
    g.motor.torque_limit = 0.6;
    g.motor.torque_constant = 0.06;
    g.motor.rotor_inertia = 1.0e-5;
    g.motor.counts_per_revolution = 262144.0;
    g.handle_mass = 0.10;
    g.handle_inertia = 6.0e-5;
    g.rotation_limit = 60.0 * k_degree;
    return g;
}

} // namespace haptics
