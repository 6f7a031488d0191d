/// Collisions with known answers: single hits, closed forms, brute force over all active sets, the same bits
/// every time.

#include <haptics/shared/collision_scenes.hpp>
#include <haptics/shared/dense_algebra.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "support/allocation_guard.hpp"

namespace {

using namespace haptics;
using namespace haptics::shared;

struct SolverBench {
    CollisionScene scene;
    CollisionWorkspace workspace;
    CollisionSolution solution;

    CollisionProblem& problem() { return scene.problem; }
    const CollisionSolution& resolve(CollisionMethod method = CollisionMethod::poisson) {
        resolve_collisions(method, scene.problem, workspace, solution);
        return solution;
    }
};

/// Masses on a line; contact i is between mass i and mass i + 1, or before the first and after the last a
/// wall.
void line_of_masses(CollisionProblem& p, int masses, const double* mass, double restitution) {
    p.resize(masses, masses - 1);
    p.inverse_mass.setZero();
    p.normal_rows.setZero();
    p.tangent_rows.setZero();
    for (int i = 0; i < masses; ++i) {
        p.inverse_mass(i, i) = 1.0 / mass[i];
        p.velocity[i] = 0.0;
    }
    for (int i = 0; i + 1 < masses; ++i) {
        p.normal_rows(i, i) = -1.0;
        p.normal_rows(i, i + 1) = 1.0;
        p.restitution[i] = restitution;
    }
}

/// Rigid tool of 0.3 kg, 2e-4 kg m^2.
void rigid(SolverBench& b, int contacts) {
    b.scene.tool = {};
    b.scene.tool.mass.setZero(3, 3);
    b.scene.tool.mass.diagonal() << 0.3, 0.3, 2e-4;
    b.problem().resize(3, contacts);
    b.problem().inverse_mass.setZero();
    b.problem().inverse_mass.diagonal() << 1.0 / 0.3, 1.0 / 0.3, 1.0 / 2e-4;
}

/// All active sets: the motion whose impulses p >= 0, v + G p >= 0, p (v + G p) = 0 hold best. Rows are
/// scaled to effective mass 1; those that cannot be moved are left out.
FreedomVector brute_force_projection(const CollisionProblem& p, const FreedomVector& start) {
    const int m = p.contacts();
    const Eigen::MatrixXd w = p.inverse_mass;
    Eigen::MatrixXd j = p.normal_rows;
    Eigen::VectorXd v = j * start - p.wall_normal_velocity;
    const Eigen::VectorXd yield = (j * w * j.transpose()).diagonal();
    for (int i = 0; i < m; ++i) {
        const bool moves = yield[i] > 1e-14 * yield.maxCoeff() && j.row(i).cwiseAbs().maxCoeff() > 1e-12;
        j.row(i) *= moves ? 1.0 / std::sqrt(yield[i]) : 0.0;
        v[i] *= moves ? 1.0 / std::sqrt(yield[i]) : 0.0;
    }
    const Eigen::MatrixXd g = j * w * j.transpose();
    double best_violation = HUGE_VAL;
    FreedomVector best = start;
    for (unsigned set = 0; set < (1U << static_cast<unsigned>(m)); ++set) {
        std::vector<int> active;
        for (int i = 0; i < m; ++i)
            if ((set >> static_cast<unsigned>(i) & 1U) != 0)
                active.push_back(i);
        Eigen::VectorXd impulse = Eigen::VectorXd::Zero(m);
        if (!active.empty()) {
            const Eigen::MatrixXd ga = g(active, active);
            const Eigen::VectorXd pa = shared::least_squares(ga, -v(active));
            for (std::size_t k = 0; k < active.size(); ++k)
                impulse[active[k]] = pa[static_cast<Eigen::Index>(k)];
        }
        const Eigen::VectorXd after = v + g * impulse;
        double violation = std::max(-impulse.minCoeff(), -after.minCoeff());
        for (const int i : active)
            violation = std::max(violation, std::fabs(after[i]));
        if (violation < best_violation) {
            best_violation = violation;
            best = start + w * j.transpose() * impulse;
        }
    }
    return best;
}

} // namespace

TEST_CASE("a single frictionless hit leaves with exactly -e times its velocity and the impulse of its "
          "effective mass") {
    Dice dice(11);
    const auto b = std::make_unique<SolverBench>();
    CollisionMix mix;
    mix.most_contacts = 1;
    mix.friction = false;
    mix.singular = false;
    double worst = 0.0;
    int hits = 0;
    for (int k = 0; k < 20000; ++k) {
        mix.walls = k % 2 == 0 ? WallMotion::rest : WallMotion::apart;
        random_scene(dice, mix, b->scene);
        const CollisionProblem& p = b->problem();
        const double before = p.normal_rows.row(0).dot(p.velocity) - p.wall_normal_velocity[0];
        const double yield = p.normal_rows.row(0).dot(p.inverse_mass * p.normal_rows.row(0).transpose());
        const double across = p.tangent_rows.row(0).dot(p.inverse_mass * p.tangent_rows.row(0).transpose());
        const double size =
            p.normal_rows.row(0).cwiseAbs().dot(p.velocity.cwiseAbs()) + std::fabs(p.wall_normal_velocity[0]);
        if (before > -1e-3 * size || yield < 1e-4 * across)
            continue;
        const CollisionSolution& s = b->resolve();
        const double after = p.normal_rows.row(0).dot(s.velocity) - p.wall_normal_velocity[0];
        const double e = p.restitution[0];
        worst = std::max(worst, std::fabs(after + e * before) / -before);
        worst = std::max(worst, std::fabs(s.normal_impulse[0] * yield / (-before * (1.0 + e)) - 1.0));
        ++hits;
    }
    MESSAGE("single hits: " << hits << ", worst error of e " << worst);
    CHECK(hits > 10000);
    CHECK(worst < 1e-12);
}

TEST_CASE("sliding survives a frictionless hit") {
    const auto b = std::make_unique<SolverBench>();
    rigid(*b, 1);
    place_contact(b->scene, 0, 0, {0.0, -0.02}, {0.0, 1.0});
    b->problem().restitution[0] = 0.4;
    b->problem().velocity << 0.7, -0.3, 2.0;
    b->resolve();
    CHECK(b->solution.velocity[0] == 0.7);
    CHECK(b->solution.velocity[1] == doctest::Approx(0.12).epsilon(1e-14));
    CHECK(b->solution.velocity[2] == 2.0);

    // any tool: what the rows cannot see is kept (momentum along every motion with J x = 0)
    Dice dice(12);
    CollisionMix mix;
    mix.friction = false;
    double worst = 0.0;
    for (int k = 0; k < 5000; ++k) {
        random_scene(dice, mix, b->scene);
        b->resolve();
        const Eigen::MatrixXd j = b->problem().normal_rows;
        const Eigen::MatrixXd unseen = shared::kernel(j);
        const Eigen::VectorXd change = b->scene.tool.mass * (b->solution.velocity - b->problem().velocity);
        const double size = (b->scene.tool.mass * b->problem().velocity).norm();
        for (int c = 0; c < unseen.cols(); ++c)
            worst = std::max(worst, std::fabs(unseen.col(c).dot(change)) / size);
    }
    CHECK(worst < 1e-10);
}

TEST_CASE(
    "friction of a hit at the center: sticks inside the cone, else slows by mu times the normal impulse") {
    const auto b = std::make_unique<SolverBench>();
    rigid(*b, 1);
    // a point mass: the contact at the center
    place_contact(b->scene, 0, 0, {0.0, 0.0}, {0.0, 1.0});
    CollisionProblem& p = b->problem();
    p.restitution[0] = 0.5;
    p.friction[0] = 0.2;
    // the tangent is perpendicular(normal) = -x
    p.velocity << 1.0, -1.0, 0.0;
    b->resolve();
    CHECK(b->solution.velocity[0] == doctest::Approx(1.0 - 0.2 * 1.5).epsilon(1e-14));
    CHECK(b->solution.velocity[1] == doctest::Approx(0.5).epsilon(1e-14));
    CHECK(b->solution.tangent_impulse[0] ==
          doctest::Approx(0.2 * b->solution.normal_impulse[0]).epsilon(1e-14));
    p.velocity << 0.1, -1.0, 0.0;
    b->resolve();
    CHECK(std::fabs(b->solution.velocity[0]) < 1e-15);
    CHECK(b->solution.tangent_impulse[0] == doctest::Approx(0.03).epsilon(1e-12));
    // a belt drags the tool along, up to the cone
    p.velocity << 0.0, -1.0, 0.0;
    p.wall_tangent_velocity[0] = -2.0;
    b->resolve();
    CHECK(b->solution.velocity[0] == doctest::Approx(0.3).epsilon(1e-14));
}

TEST_CASE("a box that falls flat on two corners stops, bounces or slides as one point would") {
    const auto b = std::make_unique<SolverBench>();
    rigid(*b, 2);
    CollisionProblem& p = b->problem();
    for (const double e : {0.0, 0.6, 1.0}) {
        place_contact(b->scene, 0, 0, {-0.04, -0.02}, {0.0, 1.0});
        place_contact(b->scene, 1, 0, {0.04, -0.02}, {0.0, 1.0});
        p.restitution.setConstant(e);
        p.friction.setZero();
        p.velocity << 0.2, -0.5, 0.0;
        b->resolve();
        CHECK((b->solution.velocity - Vec3(0.2, 0.5 * e, 0.0)).norm() < 1e-14);
        CHECK(b->solution.normal_impulse[0] == doctest::Approx(b->solution.normal_impulse[1]).epsilon(1e-12));
    }
}

TEST_CASE("a chain of equal balls hit at one end: all of the chain moves, with its momentum and its energy") {
    const auto b = std::make_unique<SolverBench>();
    const std::array<double, 3> mass{1.0, 1.0, 1.0};
    line_of_masses(b->problem(), 3, mass.data(), 1.0);
    b->problem().velocity[0] = 1.0;
    b->resolve();
    CHECK((b->solution.velocity - Vec3(-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0)).norm() < 1e-14);
    // two balls do swap
    line_of_masses(b->problem(), 2, mass.data(), 1.0);
    b->problem().velocity[0] = 1.0;
    b->resolve();
    CHECK(b->solution.velocity[0] == doctest::Approx(0.0));
    CHECK(b->solution.velocity[1] == doctest::Approx(1.0));
}

TEST_CASE("a light ball leaves at (1 + e) times the speed of a heavy one, and stops as a wall when it is the "
          "heavy one") {
    const auto b = std::make_unique<SolverBench>();
    std::array<double, 2> mass{1000.0, 1.0};
    line_of_masses(b->problem(), 2, mass.data(), 0.7);
    b->problem().velocity[0] = 1.0;
    b->resolve();
    CHECK(b->solution.velocity[1] == doctest::Approx(1.7).epsilon(0.002));
    mass = {1.0, 1000.0};
    line_of_masses(b->problem(), 2, mass.data(), 0.7);
    b->problem().velocity[0] = 1.0;
    b->resolve();
    CHECK(b->solution.velocity[0] == doctest::Approx(-0.7).epsilon(0.01));
}

TEST_CASE(
    "a tool squeezed between closing walls gets bounded impulses, and the squeezed contact is reported") {
    const auto b = std::make_unique<SolverBench>();
    rigid(*b, 2);
    place_contact(b->scene, 0, 0, {0.04, 0.0}, {-1.0, 0.0});
    place_contact(b->scene, 1, 0, {-0.04, 0.0}, {1.0, 0.0});
    CollisionProblem& p = b->problem();
    p.wall_normal_velocity << 0.2, 0.1;
    p.velocity.setZero();
    for (const double mu : {0.0, 0.5}) {
        p.friction.setConstant(mu);
        b->resolve();
        CHECK(b->solution.squeezed == 1);
        CHECK(b->solution.velocity[0] == doctest::Approx(-0.2));
    }
}

TEST_CASE("rows of zeros, no contacts and contacts that only separate change nothing") {
    const auto b = std::make_unique<SolverBench>();
    rigid(*b, 1);
    CollisionProblem& p = b->problem();
    p.velocity << 0.1, -0.2, 0.3;
    p.normal_rows.setZero();
    p.tangent_rows.setZero();
    p.wall_normal_velocity[0] = 1.0;
    b->resolve();
    CHECK(b->solution.velocity == p.velocity);
    p.wall_normal_velocity[0] = 0.0;
    place_contact(b->scene, 0, 0, {0.0, 0.0}, {0.0, -1.0});
    b->resolve();
    CHECK(b->solution.velocity == p.velocity);
    CHECK(b->solution.normal_impulse[0] == 0.0);
    rigid(*b, 0);
    p.velocity << 0.1, -0.2, 0.3;
    for (const auto method :
         {CollisionMethod::poisson, CollisionMethod::mass_weighted, CollisionMethod::paper}) {
        b->resolve(method);
        CHECK(b->solution.velocity == p.velocity);
    }
}

TEST_CASE("the compression is the projection that brute force over all active sets finds") {
    Dice dice(13);
    const auto b = std::make_unique<SolverBench>();
    CollisionMix mix;
    mix.most_contacts = 6;
    mix.friction = false;
    mix.restitution = 0.0;
    double worst = 0.0;
    for (int k = 0; k < 3000; ++k) {
        mix.walls = k % 3 == 0 ? WallMotion::together : WallMotion::rest;
        random_scene(dice, mix, b->scene);
        b->resolve();
        if (b->solution.squeezed > 0)
            continue;
        const FreedomVector truth = brute_force_projection(b->problem(), b->problem().velocity);
        const FreedomVector off = b->solution.velocity - truth;
        const FreedomVector size = b->problem().velocity - b->scene.frame;
        worst = std::max(worst,
                         std::sqrt(off.dot(b->scene.tool.mass * off) / size.dot(b->scene.tool.mass * size)));
    }
    MESSAGE("worst distance to brute force, of the D-norm of the motion: " << worst);
    CHECK(worst < 1e-7);
}

TEST_CASE("with equal restitutions the bounce is the projection of the reflected motion") {
    Dice dice(14);
    const auto b = std::make_unique<SolverBench>();
    CollisionMix mix;
    mix.most_contacts = 6;
    mix.friction = false;
    double worst = 0.0;
    for (int k = 0; k < 2000; ++k) {
        mix.restitution = dice.uniform(0.0, 1.0);
        random_scene(dice, mix, b->scene);
        b->resolve();
        const FreedomVector& before = b->problem().velocity;
        const FreedomVector middle = brute_force_projection(b->problem(), before);
        const FreedomVector truth =
            brute_force_projection(b->problem(), middle + mix.restitution * (middle - before));
        const FreedomVector off = b->solution.velocity - truth;
        worst = std::max(
            worst, std::sqrt(off.dot(b->scene.tool.mass * off) / before.dot(b->scene.tool.mass * before)));
        CHECK(b->solution.restitution_scale > 1.0 - 1e-6);
    }
    CHECK(worst < 1e-6);
}

TEST_CASE("friction that the exact solver handles opposes the slip and is full where the contact slips") {
    Dice dice(15);
    const auto b = std::make_unique<SolverBench>();
    CollisionMix mix;
    mix.restitution = 0.0;
    mix.singular = false;
    double worst = 0.0;
    int above = 0;
    int contacts = 0;
    for (int k = 0; k < 20000; ++k) {
        random_scene(dice, mix, b->scene);
        const CollisionProblem& p = b->problem();
        const CollisionSolution& s = b->resolve();
        if (s.fell_back)
            continue;
        const double energy = 0.5 * p.velocity.dot(b->scene.tool.mass * p.velocity);
        for (int i = 0; i < p.contacts(); ++i) {
            const double slip = p.tangent_rows.row(i).dot(s.velocity);
            const double normal = p.normal_rows.row(i).dot(s.velocity);
            const double limit = p.friction[i] * s.normal_impulse[i];
            // complementarity as powers, against the energy of the motion
            const double miss = std::max(std::fabs(s.normal_impulse[i] * normal),
                                         s.tangent_impulse[i] * slip + limit * std::fabs(slip)) /
                                energy;
            worst = std::max(worst, miss);
            above += miss > 1e-8 ? 1 : 0;
            ++contacts;
        }
    }
    MESSAGE("worst complementarity of friction, of the kinetic energy: "
            << worst << "; above 1e-8 in " << above << " of " << contacts << " contacts");
    // tools wedged between nearly opposed walls take hundreds of times the impulse, and lose digits
    CHECK(worst < 1e-4);
    CHECK(above * 1000 < contacts);
}

TEST_CASE("collisions take nothing from the heap, and give the same bits every time") {
    const auto b = std::make_unique<SolverBench>();
    std::array<std::uint64_t, 2> hash{};
    for (std::uint64_t& h : hash) {
        Dice dice(16);
        h = 0xcbf29ce484222325ULL;
        for (int k = 0; k < 2000; ++k) {
            CollisionMix mix;
            mix.most_contacts = k % 50 == 0 ? 40 : 8;
            mix.walls = k % 3 == 0 ? WallMotion::apart : WallMotion::rest;
            random_scene(dice, mix, b->scene);
            for (const auto method :
                 {CollisionMethod::poisson, CollisionMethod::mass_weighted, CollisionMethod::paper}) {
                const testing::AllocationGuard guard;
                b->resolve(method);
                const std::uint64_t taken = guard.allocations();
                REQUIRE(taken == 0);
                for (int i = 0; i < b->solution.velocity.size(); ++i) {
                    std::uint64_t bits = 0;
                    std::memcpy(&bits, &b->solution.velocity[i], sizeof bits);
                    h = (h ^ bits) * 0x100000001b3ULL;
                }
            }
        }
    }
    CHECK(hash[0] == hash[1]);
    MESSAGE("hash of the results: " << hash[0]);
}
