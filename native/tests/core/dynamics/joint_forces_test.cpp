#include <haptics/core/dynamics/forward_dynamics.hpp>
#include <haptics/core/dynamics/joint_forces.hpp>
#include <haptics/core/dynamics/joint_rows.hpp>

#include "dynamics_fixture.hpp"

using namespace haptics;
using haptics::testing::Linkage;

namespace {

/// A drawer with everything that a joint can have.
Linkage equipped_drawer() {
    LinkageSpec spec = shared::drawer();
    JointSpec& joint = spec.links[0].joint;
    joint.lower_limit = -0.1;
    joint.upper_limit = 0.2;
    joint.limit_stiffness = 1000.0;
    joint.limit_damping = 5.0;
    joint.damping = 0.5;
    joint.friction = 0.3;
    joint.friction_band = 0.01;
    joint.spring_stiffness = 20.0;
    joint.spring_rest = 0.05;
    return Linkage(spec);
}

double force_at(Linkage& linkage, double q, double v) {
    linkage.data.position[0] = q;
    linkage.data.velocity[0] = v;
    LinkageVector force = LinkageVector::Zero(1);
    add_joint_forces(linkage.model, linkage.data, force);
    return force[0];
}

} // namespace

TEST_CASE("spring, damping, friction and limits of a joint add up as documented") {
    Linkage drawer = equipped_drawer();
    CHECK(force_at(drawer, 0.05, 0.0) == 0.0);
    CHECK(force_at(drawer, 0.15, 0.0) == doctest::Approx(-2.0));
    CHECK(force_at(drawer, 0.05, 0.005) == doctest::Approx(-0.5 * 0.005 - 0.15));
    CHECK(force_at(drawer, 0.05, 1.0) == doctest::Approx(-0.5 - 0.3));
    CHECK(force_at(drawer, -0.11, 0.0) == doctest::Approx(20.0 * 0.16 + 10.0));
    CHECK(force_at(drawer, 0.21, 0.0) == doctest::Approx(-20.0 * 0.16 - 10.0));
    // leaving fast, the limit lets go instead of pulling
    CHECK(force_at(drawer, -0.11, 10.0) == doctest::Approx(20.0 * 0.16 - 5.0 - 0.3));
}

TEST_CASE("limit rows name the nearer limit with its gap, friction rows their bound") {
    Linkage drawer = equipped_drawer();
    LimitRows rows;
    drawer.data.position[0] = 0.0;
    limit_rows(drawer.model, drawer.data, 0.01, rows);
    CHECK(rows.count == 0);
    drawer.data.position[0] = -0.095;
    limit_rows(drawer.model, drawer.data, 0.01, rows);
    REQUIRE(rows.count == 1);
    CHECK(rows.row[0].sign == 1.0);
    CHECK(rows.row[0].gap == doctest::Approx(0.005));
    drawer.data.position[0] = 0.21;
    limit_rows(drawer.model, drawer.data, 0.01, rows);
    REQUIRE(rows.count == 1);
    CHECK(rows.row[0].sign == -1.0);
    CHECK(rows.row[0].gap == doctest::Approx(-0.01));
    FrictionRows friction;
    friction_rows(drawer.model, friction);
    REQUIRE(friction.count == 1);
    CHECK(friction.row[0].bound == 0.3);
}

TEST_CASE(
    "the linearly implicit step stays stable at a limit 1e8 N/m stiff where the explicit one diverges") {
    for (const bool implicit : {true, false}) {
        LinkageSpec spec = shared::drawer();
        spec.links[0].joint.lower_limit = 0.0;
        spec.links[0].joint.limit_stiffness = 1e8;
        Linkage drawer(spec);
        drawer.data.position[0] = 0.001;
        drawer.data.velocity[0] = -0.5;
        ArticulatedFactor factor;
        LinkageVector acceleration;
        LinkageVector added;
        const double dt = 1e-3;
        double fastest = 0.0;
        for (int i = 0; i < 1000; ++i) {
            LinkageVector force = LinkageVector::Zero(1);
            update_kinematics(drawer.model, drawer.data);
            if (implicit) {
                add_joint_forces_implicit(drawer.model, drawer.data, dt, force, added);
                articulated_acceleration(drawer.model, drawer.data, force, &added, factor, acceleration);
            } else {
                add_joint_forces(drawer.model, drawer.data, force);
                articulated_acceleration(drawer.model, drawer.data, force, nullptr, factor, acceleration);
            }
            drawer.data.velocity += dt * acceleration;
            drawer.data.position += dt * drawer.data.velocity;
            fastest = std::max(fastest, std::fabs(drawer.data.velocity[0]));
        }
        if (implicit) {
            CHECK(fastest <= 0.5);
        } else {
            CHECK(fastest > 10.0);
        }
    }
}
