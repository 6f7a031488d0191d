// The window of the velocity estimate without an observer: as long as the encoder asks for, and no longer.

#include <haptics/core/control/coupling.hpp>
#include <haptics/shared/observed_tool.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace haptics;
using shared::ObservedTool;
using shared::ObservedToolOptions;

namespace {

// an encoder's step that comes and goes, through the damper
double jump(const Mat3& mass, const Mat3& mobility, double period, double step, const VelocityWindow& w) {
    return default_gains(mass, mobility, period, 0.0, w.lag).damping.x() * step / (w.longest * period);
}

struct Leaning {
    double energy{0.0};
    /// RMS of the change of force from step to step, N, in how many.
    double noise{0.0};
    int pressed{0};
    Fault faults{Fault::none};
};

// ten seconds on the paper's wall at 2 kHz
Leaning lean(double encoder, double tool_mass, int window) {
    ObservedToolOptions o;
    o.rate_hz = 2000.0;
    o.delay_steps = 0;
    o.observer = false;
    o.encoder = encoder;
    o.tool_mass = tool_mass;
    o.velocity_window = window;
    std::vector<HandTarget> path;
    for (int i = 0; i <= 220; ++i) {
        const double t = 0.05 * i;
        const double y = t < 1.5 ? 0.0 : -0.01 + 0.008 * std::sin(1.9 * t);
        path.push_back({t, Pose(0.02 * std::sin(1.3 * t), y, 0.0)});
    }
    o.distance = 0.002;
    o.hand = path_hand(path);
    ObservedTool tool(o);
    tool.device->hand().set_grip(300.0, 5.0);
    Leaning result;
    double last = 0.0;
    for (int i = 0; i < 20000; ++i) {
        tool.session->step();
        const double force = tool.session->report().force.y();
        const double step = std::abs(force - last);
        last = force;
        // hits are steps of their own
        if (tool.session->report().contact.y() > 1.0 && step < 1.5) {
            result.noise += step * step;
            ++result.pressed;
        }
    }
    result.noise = std::sqrt(result.noise / std::max(result.pressed, 1));
    result.energy = tool.session->report().energy_injected;
    result.faults = tool.session->report().faults;
    return result;
}

} // namespace

TEST_SUITE("velocity window") {
    TEST_CASE(
        "it is the shortest with which the encoder's steps stay within the noise, two samples at least") {
        for (const double mass : {0.05, 0.3, 1.0})
            for (const double mobility : {0.0, 3.0})
                for (const double rate : {250.0, 500.0, 1000.0, 2000.0, 5000.0, 10000.0})
                    for (const double step : {0.0, 1e-6, 1e-5, 2.5e-5, 9e-5}) {
                        CAPTURE(mass);
                        CAPTURE(rate);
                        CAPTURE(step);
                        const Mat3 device = Vec3(mass, mass, 1e-3 * mass).asDiagonal();
                        const Mat3 tool = Vec3(mobility, mobility, 0.0).asDiagonal();
                        const VelocityWindow w = choose_velocity_window(device, tool, 1.0 / rate, 0.0,
                                                                        Vec3(step, step, step), 0.05, 1.0);
                        CHECK(w.longest >= 2);
                        CHECK(w.longest <= 63);
                        CHECK((w.longest == 63 || jump(device, tool, 1.0 / rate, step, w) <= 0.1));
                        if (w.longest > 2) {
                            const VelocityWindow shorter{w.longest - 1, std::max(2, w.longest / 2)};
                            CHECK(jump(device, tool, 1.0 / rate, step, shorter) > 0.1);
                        }
                    }
    }

    TEST_CASE(
        "leaning on a wall with a coarse encoder at a high rate is calm, and gives next to nothing away") {
        for (const double encoder : {1e-5, 2.5e-5})
            for (const double tool_mass : {0.1, 0.3, 1.0}) {
                CAPTURE(encoder);
                CAPTURE(tool_mass);
                const Leaning chosen = lean(encoder, tool_mass, 0);
                const Leaning two = lean(encoder, tool_mass, 2);
                MESSAGE("" << encoder * 1e6 << " um, tool " << tool_mass << " kg: " << chosen.noise
                           << " N RMS a step, " << chosen.energy * 1e3 << " mJ; two samples: " << two.noise
                           << " N, " << two.energy * 1e3 << " mJ");
                CHECK(chosen.energy < 3e-3);
                CHECK(chosen.pressed > 5000);
                CHECK(chosen.noise < 0.06);
                CHECK(chosen.noise < 0.5 * two.noise);
                CHECK(chosen.faults == Fault::none);
            }
    }
}
