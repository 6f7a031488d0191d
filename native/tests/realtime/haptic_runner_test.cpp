#include <haptics/realtime/haptic_runner.hpp>
#include <haptics/shared/experiment1.hpp>

#include <doctest/doctest.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <support/realtime_guard.hpp>
#include <thread>

using namespace haptics;
using haptics::testing::RealtimeGuard;
using shared::Experiment1;
using shared::Experiment1Options;

namespace {

Experiment1Options soft() {
    Experiment1Options o;
    o.gain = 0.33;
    o.rate_hz = 1000.0;
    return o;
}

// two seconds of lock-step with a snapshot a tick, as text of the recording
std::string record() {
    Experiment1 e(soft());
    HapticRunner runner(std::move(e.session), nullptr);
    runner.record(2.0);
    const auto floor = shared::floor_of(1);
    for (int tick = 1; tick <= 120; ++tick) {
        runner.neighborhood() = *floor;
        runner.neighborhood().sequence = static_cast<std::uint64_t>(tick) + 1;
        runner.neighborhood().time = runner.now();
        runner.publish();
        runner.advance(1.0 / 60.0);
    }
    const std::string path = "runner_test.csv";
    std::string error;
    REQUIRE_MESSAGE(runner.write_recording(path, error), error);
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    std::remove(path.c_str());
    return text.str();
}

} // namespace

TEST_CASE("a lock-step run records one row a step and repeats bit for bit") {
    const std::string first = record();
    CHECK(std::count(first.begin(), first.end(), '\n') == 2001);
    CHECK(first.rfind("t_s,device_x_m,device_y_m,device_theta_rad,proxy_x_m", 0) == 0);
    CHECK(first == record());
}

TEST_CASE("samples of a recording are where the grip was, with the mean force since the one before") {
    Experiment1 e(soft());
    HapticRunner runner(std::move(e.session), nullptr);
    runner.record(2.0);
    const auto floor = shared::floor_of(1);
    for (int tick = 1; tick <= 120; ++tick) {
        runner.neighborhood() = *floor;
        runner.neighborhood().sequence = static_cast<std::uint64_t>(tick) + 1;
        runner.neighborhood().time = runner.now();
        runner.publish();
        runner.advance(1.0 / 60.0);
    }
    std::string error;
    const std::string rows = "runner_rows.csv";
    const std::string samples = "runner_samples.csv";
    CHECK_FALSE(runner.write_samples(samples, 0.0015, error));
    CHECK(error.find("multiple") != std::string::npos);
    REQUIRE_MESSAGE(runner.write_recording(rows, error), error);
    REQUIRE_MESSAGE(runner.write_samples(samples, 0.004, error), error);
    const auto read = [](const std::string& path) {
        std::ifstream file(path);
        std::vector<std::vector<double>> all;
        std::string line;
        std::getline(file, line);
        while (std::getline(file, line)) {
            std::stringstream fields(line);
            all.emplace_back();
            for (std::string field; std::getline(fields, field, ',');)
                all.back().push_back(std::stod(field));
        }
        std::remove(path.c_str());
        return all;
    };
    const auto all = read(rows);
    const auto thin = read(samples);
    REQUIRE(all.size() == 2000);
    REQUIRE(thin.size() == 500);
    double most = 0.0;
    for (std::size_t i = 0; i < thin.size(); ++i) {
        const auto& last = all[4 * i + 3];
        CHECK(thin[i][0] == doctest::Approx(last[0]));
        CHECK(thin[i][1] == last[4]);
        CHECK(thin[i][2] == last[5]);
        double force = 0.0;
        for (std::size_t k = 0; k < 4; ++k)
            force += 0.25 * all[4 * i + k][14];
        CHECK(thin[i][6] == doctest::Approx(force));
        most = std::max(most, std::abs(force));
    }
    CHECK(most > 1.0);
}

TEST_CASE("a whole haptic step neither allocates, locks nor blocks") {
    Experiment1 e(soft());
    HapticRunner runner(std::move(e.session), nullptr);
    runner.record(10.0);
    const auto floor = shared::floor_of(3);
    LockstepClock clock(1000.0);
    RealtimeGuard guard;
    for (int tick = 1; tick <= 90; ++tick) {
        runner.neighborhood() = *floor;
        runner.neighborhood().sequence = static_cast<std::uint64_t>(tick) + 1;
        runner.neighborhood().time = static_cast<double>(clock.scene_ns()) * 1e-9;
        runner.publish();
        if (tick % 20 == 0)
            runner.try_send(RunnerCommand::hold);
        for (int left = clock.begin_tick(1.0 / 60.0); left > 0; --left) {
            const StepTime time = clock.next();
            guard.begin();
            runner.step(time);
            guard.end();
        }
    }
    CHECK_MESSAGE(guard.violations() == 0, guard.first());
    CHECK(runner.latest_report().run.collisions > 0);
}

TEST_CASE("a thread runs the session, a stalled scene fades the force, and stopping zeroes it") {
    Experiment1 e(soft());
    SimulatedPantograph& device = *e.device;
    HapticRunner runner(std::move(e.session), nullptr);
    LoopOptions options;
    options.priority = 0;
    options.lock_memory = false;
    options.hold_cpu_latency = false;
    REQUIRE(runner.start(options));
    while (runner.statistics().steps < 200)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    CHECK(runner.latest_report().step > 0);
    CHECK(runner.try_send(RunnerCommand::stop));
    while (!has(runner.latest_report().faults, Fault::release_the_stop))
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    CHECK_FALSE(runner.latest_report().armed);
    runner.stop();
    CHECK_FALSE(runner.thread().running());
    device.advance(0.01);
    CHECK(device.motor_force().isZero(0.0));
}
