// What the named scenes feel like, against traces that were kept (tests/golden/feel_*.csv).
// HAPTICS_WRITE_GOLDEN=1 keeps the present ones.

#include <haptics/shared/feel.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

using namespace haptics;
using shared::FeelSample;
using shared::FeelTrace;

namespace {

// Half of what a hand tells apart in force (7 %) is a change of feel that somebody should look at; the handle
// may be elsewhere by an encoder step.
constexpr double k_force_share = 0.035;
constexpr double k_position = 10e-6;
// of the lever that makes torque and angle comparable, m
constexpr double k_lever = 0.03;

std::filesystem::path golden_folder() {
    auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    while (!std::filesystem::exists(folder / "tests" / "golden") && folder.has_relative_path())
        folder = folder.parent_path();
    return folder / "tests" / "golden";
}

void keep(const FeelTrace& trace, const std::filesystem::path& path) {
    std::ofstream out(path);
    out << "t_s,handle_x_m,handle_y_m,handle_theta_rad,force_x_n,force_y_n,torque_nm\n";
    out.precision(8);
    for (const FeelSample& s : trace.sample)
        out << s.time << ',' << s.handle.x() << ',' << s.handle.y() << ',' << s.handle.z() << ','
            << s.force.x() << ',' << s.force.y() << ',' << s.force.z() << '\n';
}

std::vector<FeelSample> kept(const std::filesystem::path& path) {
    std::vector<FeelSample> samples;
    std::ifstream in(path);
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
        std::istringstream row(line);
        FeelSample s;
        char comma = 0;
        row >> s.time >> comma >> s.handle.x() >> comma >> s.handle.y() >> comma >> s.handle.z() >> comma >>
            s.force.x() >> comma >> s.force.y() >> comma >> s.force.z();
        samples.push_back(s);
    }
    return samples;
}

struct Change {
    double force{0.0};
    double position{0.0};
    double largest_force{0.0};
};

Change change_of(const std::vector<FeelSample>& now, const std::vector<FeelSample>& then) {
    Change c;
    for (std::size_t i = 0; i < now.size(); ++i) {
        const Wrench force = now[i].force - then[i].force;
        const Pose handle = now[i].handle - then[i].handle;
        c.force += force.head<2>().squaredNorm() + std::pow(force.z() / k_lever, 2);
        c.position += handle.head<2>().squaredNorm() + std::pow(handle.z() * k_lever, 2);
        c.largest_force = std::max(c.largest_force, then[i].force.head<2>().norm());
    }
    const auto count = static_cast<double>(now.size());
    c.force = std::sqrt(c.force / count);
    c.position = std::sqrt(c.position / count);
    return c;
}

} // namespace

TEST_CASE("scenes feel as they did: force within half of what is told apart, handle within an encoder step") {
    const std::filesystem::path folder = golden_folder();
    const bool write = std::getenv("HAPTICS_WRITE_GOLDEN") != nullptr;
    for (const FeelTrace& trace : shared::feel_traces()) {
        CAPTURE(trace.name);
        const std::filesystem::path path = folder / ("feel_" + trace.name + ".csv");
        if (write)
            keep(trace, path);
        const std::vector<FeelSample> then = kept(path);
        REQUIRE(then.size() == trace.sample.size());
        const Change change = change_of(trace.sample, then);
        CHECK(change.largest_force > 0.5);
        CHECK(change.force <= k_force_share * change.largest_force);
        CHECK(change.position <= k_position);
    }
}

TEST_CASE("a wall softer by a fifth is a change of feel") {
    const std::vector<FeelSample> then = kept(golden_folder() / "feel_experiment1_impulse.csv");
    shared::Experiment1Options o;
    shared::Experiment1 e(o);
    auto soft = shared::floor_of(1);
    soft->sequence = 2;
    soft->bodies.body[0].surface.stiffness *= 0.8;
    e.session->take(*soft);
    const FeelTrace now = shared::feel::record("soft", *e.session, *e.device, 3.0);
    REQUIRE(now.sample.size() == then.size());
    const Change change = change_of(now.sample, then);
    CHECK((change.force > k_force_share * change.largest_force || change.position > k_position));
}
