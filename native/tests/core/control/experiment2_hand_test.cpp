// Why nobody can keep a device's unknown mass from a hand of unknown mass.
//
// The controller sees the handle and the forces it sends, M a = u + f_h; the hand's own mass m pulls at the
// handle as f_h = (muscles) - m a. So only M + m is ever seen. Two devices of one assumed mass, with hands
// whose masses make up for the difference, move alike under every controller; the linkage without a device
// moves otherwise in one hand than in the other. The sum of both motion errors is at least that difference.

#include <haptics/shared/experiment2.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace haptics;
using shared::Experiment2Options;

namespace {

// 0.3 kg assumed
Experiment2Options observed(double device, double hand, double hand_inertia) {
    Experiment2Options o;
    o.observer = true;
    o.device_mass = device;
    o.mass_ratio = 0.3 / device;
    o.hand_mass = hand;
    o.hand_inertia = hand_inertia;
    o.seconds = 1.5;
    return o;
}

struct Runs {
    std::vector<Vec2> handle;
    std::vector<Vec2> ideal;
};

Runs run(const Experiment2Options& o) {
    shared::Experiment2 e(o);
    shared::IdealLinkage ideal(o);
    Runs r;
    for (int i = 0; i < static_cast<int>((1.0 + o.seconds) * o.rate_hz); ++i) {
        e.session->step();
        ideal.advance(1.0 / o.rate_hz);
        if (i < static_cast<int>(o.rate_hz))
            continue;
        r.handle.emplace_back(e.device->true_pose().head<2>());
        r.ideal.emplace_back(ideal.moved().head<2>());
    }
    return r;
}

double rms(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += (a[i] - b[i]).squaredNorm();
    return std::sqrt(sum / static_cast<double>(a.size()));
}

} // namespace

TEST_SUITE("experiment 2, whose mass") {
    TEST_CASE("a heavy device in a light hand moves as a light device in a heavy hand, and the linkage alone "
              "does not: 25 % of a device's mass cannot be told from the hand's") {
        const Runs light = run(observed(0.24, 0.21, 1.6e-4));
        const Runs heavy = run(observed(0.4, 0.05, 0.0));
        const double same = rms(light.handle, heavy.handle);
        const double apart = rms(light.ideal, heavy.ideal);
        MESSAGE("handles " << same * 1e6 << " um apart, ideal linkages " << apart * 1e6
                           << " um; motion errors " << rms(light.handle, light.ideal) * 1e6 << " and "
                           << rms(heavy.handle, heavy.ideal) * 1e6 << " um");
        CHECK(same < 1e-7);
        // so the larger of the two motion errors is at least half of this, whatever the controller
        CHECK(apart > 2.0 * 0.5e-3);
    }
}
