// The figures of docs/devices.md, printed: haptics_tests -tc="figures of the devices*" -s

#include <haptics/core/pantograph/inertia.hpp>
#include <haptics/core/pantograph/presets.hpp>
#include <haptics/core/pantograph/torque_map.hpp>
#include <haptics/core/safety/encoder_check.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

using namespace haptics;

TEST_SUITE("device figures") {
    TEST_CASE("figures of the devices at their home pose") {
        const std::pair<std::string, PantographGeometry> devices[] = {{"Pantograph Mk-II", pantograph_mk2()},
                                                                      {"Haply 2DIY v2", haply_2diy_v2()},
                                                                      {"Haply 2DIY v3", haply_2diy_v3()},
                                                                      {"UBC twin", ubc_twin_pantograph()}};
        for (const auto& [name, g] : devices) {
            const PantographKinematics kinematics(g);
            const PantographState state = kinematics.locate(g.home);
            const WorkspaceReport workspace = kinematics.workspace(g.home, state);
            double force = 1.0e9;
            for (int degree = 0; degree < 360; ++degree) {
                const double angle = degree * std::numbers::pi / 180.0;
                const Wrench wrench(1.0e3 * std::cos(angle), 1.0e3 * std::sin(angle), 0.0);
                force = std::min(force, 1.0e3 * joint_torques(kinematics, state, wrench).scale);
            }
            const double count = 2.0 * std::numbers::pi / g.motor.counts_per_revolution;
            const double step = count * kinematics.jacobian(state).topRows<2>().colwise().norm().maxCoeff();
            const Mat3 mass = handle_mass_matrix(kinematics, state);
            const EncoderCheck check(kinematics);
            JointVector angles;
            kinematics.inverse(g.home, angles);
            double slip = 0.0;
            for (int i = 0; i < g.motors(); ++i)
                slip = std::max(slip, check.smallest_slip(angles, i));
            MESSAGE(name << ": least force " << force << " N, one count " << 1.0e6 * step << " um, mass "
                         << 1.0e3 * mass(0, 0) << " / " << 1.0e3 * mass(1, 1) << " g, margin "
                         << 1.0e3 * workspace.reach_margin << " mm, singularity " << workspace.singularity
                         << ", least slip " << slip / count << " counts");
            CHECK(workspace.inside);
            CHECK(force > 1.0);
            CHECK(std::isfinite(slip) == (g.bar_count == 2));
        }
    }
}
