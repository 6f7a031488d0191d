// The sweep: its references against closed forms, the order of the integrators on smooth motion, its front
// and its verdicts.

#include <haptics/sweep/reference_disc.hpp>
#include <haptics/sweep/stability.hpp>
#include <haptics/sweep/work_precision.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace haptics;
using sweep::Method;
using sweep::Scheme;

TEST_SUITE("sweep") {
    TEST_CASE("runs made elsewhere are judged as the sweep's own, and no better than equal runs agree") {
        // motions that are off by their step times 1 mm, as a method of first order is
        const auto track = [](double rate) {
            sweep::Track t(50);
            for (std::size_t i = 0; i < t.size(); ++i)
                t[i].position = Vec2(std::sin(0.1 * static_cast<double>(i)) + 1.0 / rate, 0.0);
            return t;
        };
        const std::vector<sweep::ReferenceRuns> references{
            {Method::impulse, {track(16e3), track(32e3), track(64e3)}}};
        const auto run = [&](double rate, double ns) {
            return sweep::MeasuredRun{{Scheme::exact, Method::impulse, rate}, track(rate), {ns, ns, ns}};
        };
        std::vector<sweep::MeasuredRun> runs{run(500.0, 100.0), run(1000.0, 100.0), run(32e3, 100.0)};
        runs.push_back(run(2000.0, 100.0));
        runs.back().track.resize(20);
        runs.push_back(run(500.0, 100.0));
        runs.back().setting.method = Method::penalty;
        const sweep::WorkPrecision all = sweep::assess(references, runs, {}, 1e-3);
        REQUIRE(all.rows.size() == 4);
        CHECK(all.rows[0].error.position_rms == doctest::Approx(1.0 / 500.0 - 1.0 / 64e3));
        CHECK(all.rows[0].trust == sweep::Trust::seen);
        // 16 to 32 kHz changed 31 um
        CHECK(all.rows[2].error.position_max == doctest::Approx(10.0 / 32e3));
        CHECK(all.rows[2].trust == sweep::Trust::upper_bound);
        CHECK(std::isinf(all.rows[3].error.position_rms));
        CHECK(all.rows[1].recommended);
        CHECK(all.rows[1].second_us == doctest::Approx(100.0));
        const sweep::WorkPrecision restless = sweep::assess(references, runs, {0.01, 0.01, 0.0, 0.0}, 1e-3);
        CHECK(restless.rows[0].trust == sweep::Trust::not_converged);
        CHECK(restless.rows[0].error.position_rms == doctest::Approx(0.1));
    }

    TEST_CASE("the reference meets the closed form of a bounce with restitution by impulses") {
        sweep::ReferenceDisc disc{};
        disc.mass = 0.3;
        disc.radius = 0.01;
        disc.pose = Pose(0.0, 0.015, 0.0);
        disc.gravity = Vec2(0.0, -9.81);
        disc.collision_speed = 0.005;
        sweep::ReferenceWall wall{};
        wall.normal = Vec2(0.0, 1.0);
        wall.point = Vec2::Zero();
        wall.stiffness = 15000.0;
        wall.restitution = 0.7;
        disc.walls.push_back(wall);
        const double fall = std::sqrt(2.0 * 0.005 / 9.81);
        const double speed = 9.81 * fall;
        // 10 ms after the hit, before the next one
        disc.advance(fall + 0.01, 1e-4);
        CHECK(disc.pose.y() == doctest::Approx(0.01 + 0.7 * speed * 0.01 - 0.5 * 9.81 * 1e-4).epsilon(1e-9));
        CHECK(disc.walls[0].impulse.x() == doctest::Approx(0.3 * 1.7 * speed).epsilon(1e-9));
    }

    TEST_CASE("each integrator has its order on smooth motion") {
        const auto order = [](const sweep::Experiment& e, Scheme scheme, double rate) {
            const sweep::Track truth = e.reference(Method::penalty, 2);
            const double coarse = compare(follow(e, {scheme, Method::penalty, rate}), truth).position_max;
            const double fine = compare(follow(e, {scheme, Method::penalty, 2.0 * rate}), truth).position_max;
            return std::log2(coarse / fine);
        };
        const sweep::Experiment pulled = sweep::pulled_tool();
        CHECK(order(pulled, Scheme::semi_implicit, 2000.0) == doctest::Approx(1.0).epsilon(0.1));
        CHECK(order(pulled, Scheme::linearly_implicit, 2000.0) == doctest::Approx(1.0).epsilon(0.1));
        // exact but for the straight line that stands for the hand
        CHECK(order(pulled, Scheme::exact, 2000.0) == doctest::Approx(2.0).epsilon(0.1));
        const sweep::Experiment chain = sweep::swinging_chain();
        CHECK(order(chain, Scheme::adams_bashforth4, 2000.0) == doctest::Approx(4.0).epsilon(0.1));
        CHECK(order(chain, Scheme::runge_kutta4, 1000.0) == doctest::Approx(4.0).epsilon(0.1));
    }

    TEST_CASE("exact contacts meet the independent reference, the others do not") {
        for (const sweep::Experiment& e : {sweep::bouncing_tool(), sweep::pressing_tool()}) {
            CAPTURE(e.name);
            const sweep::Track truth = e.reference(Method::penalty, 2);
            CHECK(compare(follow(e, {Scheme::exact, Method::penalty, 500.0}), truth).position_max < 1e-8);
            CHECK(compare(follow(e, {Scheme::semi_implicit, Method::penalty, 500.0}), truth).position_max >
                  1e-6);
        }
    }

    TEST_CASE("the same sweep again gives the same errors to the last bit, and every row says what they are "
              "worth") {
        sweep::SweepOptions how;
        how.rates = {500.0};
        how.repeats = 1;
        const sweep::WorkPrecision first = sweep::sweep(sweep::bouncing_tool(), how);
        const sweep::WorkPrecision again = sweep::sweep(sweep::bouncing_tool(), how);
        REQUIRE(first.rows.size() == 9);
        REQUIRE(again.rows.size() == first.rows.size());
        for (std::size_t i = 0; i < first.rows.size(); ++i) {
            const sweep::WorkPrecisionRow& a = first.rows[i];
            const sweep::WorkPrecisionRow& b = again.rows[i];
            CAPTURE(i);
            CHECK(a.error.position_rms == b.error.position_rms);
            CHECK(a.error.position_max == b.error.position_max);
            CHECK(a.error.force_rms == b.error.force_rms);
            CHECK(a.error.energy_max == b.error.energy_max);
            CHECK(a.trust == b.trust);
            CHECK(a.error.position_max >= 10.0 * a.reference_difference);
            // lossless springs: the exact integrator is closer to the truth than its reference can tell
            if (a.setting.method == Method::penalty)
                CHECK((a.trust == sweep::Trust::upper_bound) == (a.setting.scheme == Scheme::exact));
        }
    }

    TEST_CASE("a reference that does not settle recommends nothing") {
        sweep::Experiment e = sweep::bouncing_tool();
        e.methods = {Method::penalty};
        e.reference = [last = e.reference](Method method, int refinement) {
            sweep::Track track = last(method, 2);
            for (sweep::Sample& s : track)
                s.position.y() += refinement == 2 ? 1e-3 : 0.0;
            return track;
        };
        sweep::SweepOptions how;
        how.rates = {500.0};
        how.repeats = 1;
        const sweep::WorkPrecision result = sweep::sweep(e, how);
        for (const sweep::WorkPrecisionRow& row : result.rows) {
            CHECK(row.trust == sweep::Trust::not_converged);
            CHECK_FALSE(row.front);
            CHECK_FALSE(row.recommended);
        }
        REQUIRE(result.reasons.size() == 1);
        CHECK(result.reasons[0].text.starts_with("None recommended: not converged"));
    }

    TEST_CASE("tracks that are not finite or too short are infinitely far away") {
        sweep::Track track(3);
        CHECK(compare(track, track).position_max == 0.0);
        sweep::Track broken = track;
        broken[1].energy = std::numeric_limits<double>::quiet_NaN();
        CHECK(std::isinf(compare(broken, track).position_rms));
        CHECK(std::isinf(compare(sweep::Track(2), track).force_rms));
    }

    TEST_CASE("the front holds what nothing else beats, and the cheapest good enough is recommended") {
        const double infinite = std::numeric_limits<double>::infinity();
        const std::vector<double> cost = {1.0, 2.0, 3.0, 2.0, 5.0, 2.0};
        const std::vector<double> error = {9.0, 4.0, 4.5, 6.0, 1.0, 4.0};
        const std::vector<bool> front = sweep::pareto_front(cost, error);
        CHECK(front == std::vector<bool>{true, true, false, false, true, false});
        CHECK(sweep::recommend(cost, error, front, 5.0) == 1);
        CHECK(sweep::recommend(cost, error, front, 0.5) == 4);
        CHECK(sweep::recommend({1.0}, {infinite}, sweep::pareto_front({1.0}, {infinite}), 1.0) == -1);
    }

    TEST_CASE("verdicts") {
        CHECK(sweep::classify(1.2, 0.5, 0.9) == sweep::Verdict::stable);
        CHECK(sweep::classify(1.2, 0.5, 1.02) == sweep::Verdict::chattering);
        CHECK(sweep::classify(3.0, 2.0, 0.9) == sweep::Verdict::chattering);
        CHECK(sweep::classify(99.0, 50.0, 0.9) == sweep::Verdict::unstable);
        CHECK(sweep::classify(1.0, std::numeric_limits<double>::quiet_NaN(), 0.9) ==
              sweep::Verdict::unstable);
    }

    TEST_CASE("semi-implicit steps lose stability at the bound of the linear analysis, the others nowhere") {
        for (const double stiffness : {1e4, 1e6}) {
            const double floor = sweep::semi_implicit_floor(stiffness, 20.0, 1e-3);
            CAPTURE(stiffness);
            CHECK(sweep::judge({Integrator::semi_implicit, stiffness, 20.0, 1000.0, 0.9 * floor}).verdict !=
                  sweep::Verdict::stable);
            CHECK(sweep::judge({Integrator::semi_implicit, stiffness, 20.0, 1000.0, 1.1 * floor}).residual <=
                  1.01);
            for (const Integrator integrator : {Integrator::linearly_implicit, Integrator::exact})
                CHECK(sweep::judge({integrator, stiffness, 20.0, 1000.0, 0.5 * floor}).verdict ==
                      sweep::Verdict::stable);
        }
    }

    TEST_CASE("spread") {
        const sweep::Spread s = sweep::spread_of({5.0, 1.0, 3.0, 2.0, 4.0});
        CHECK(s.low == 2.0);
        CHECK(s.median == 3.0);
        CHECK(s.high == 4.0);
        CHECK(sweep::spread_of({1.0, 2.0}).median == 1.5);
    }
}
