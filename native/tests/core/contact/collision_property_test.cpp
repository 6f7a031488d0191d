/// What holds for every collision: 100,000 random states of rigid tools and chains, checked against the mass
/// matrix and the motion alone.

#include <haptics/shared/collision_scenes.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

namespace {

using namespace haptics;
using namespace haptics::shared;

struct Bench {
    CollisionScene scene;
    CollisionWorkspace workspace;
    CollisionSolution solution;
};

/// Worst values over a set, each of them a number that has to be small.
struct Worst {
    int states{0};
    int fell_back{0};
    int squeezed{0};
    int scaled{0};
    int moved{0};
    int most_iterations{0};
    /// By the momentum that the impulses make, and by the mass matrix: D D^-1 is the identity only to 1e-12
    /// for 12 links.
    double energy_growth{0.0};
    double energy_by_mass{0.0};
    double energy_report{0.0};
    double pull{0.0};
    double cone{0.0};
    double closing{0.0};
    double momentum{0.0};
    double smallest_scale{1.0};
};

double kinetic(const CollisionTool& tool, const FreedomVector& velocity) {
    return 0.5 * velocity.dot(tool.mass * velocity);
}

void look(const Bench& b, WallMotion walls, Worst& worst) {
    const CollisionProblem& p = b.scene.problem;
    const CollisionSolution& s = b.solution;
    const FreedomVector jump = s.velocity - p.velocity;
    ++worst.states;
    worst.fell_back += s.fell_back ? 1 : 0;
    worst.squeezed += s.squeezed > 0 ? 1 : 0;
    worst.scaled += s.restitution_scale < 1.0 - 1e-9 ? 1 : 0;
    worst.moved += s.normal_impulse.maxCoeff() > 0.0 ? 1 : 0;
    worst.smallest_scale = std::min(worst.smallest_scale, s.restitution_scale);
    worst.most_iterations = std::max(worst.most_iterations, s.iterations);

    // energy by the mass matrix, in the walls' frame where there is one, else less the work of the walls
    const FreedomVector& frame = b.scene.frame;
    double size = kinetic(b.scene.tool, p.velocity - frame);
    double gain = kinetic(b.scene.tool, s.velocity - frame) - size;
    if (walls == WallMotion::apart) {
        gain -= s.normal_impulse.dot(p.wall_normal_velocity) + s.tangent_impulse.dot(p.wall_tangent_velocity);
        size += kinetic(b.scene.tool, s.velocity) + s.normal_impulse.dot(p.wall_normal_velocity.cwiseAbs()) +
                s.tangent_impulse.cwiseAbs().dot(p.wall_tangent_velocity.cwiseAbs());
    }
    const double made_gain = 0.5 * s.momentum_change.dot((s.velocity - frame) + (p.velocity - frame));
    const double work = walls == WallMotion::apart ? s.normal_impulse.dot(p.wall_normal_velocity) +
                                                         s.tangent_impulse.dot(p.wall_tangent_velocity)
                                                   : 0.0;
    worst.energy_growth = std::max(worst.energy_growth, (made_gain - work) / size);
    worst.energy_by_mass = std::max(worst.energy_by_mass, gain / size);
    worst.energy_report = std::max(worst.energy_report, std::fabs(gain - s.energy_change) / size);

    // impulses
    const double top = std::max(s.normal_impulse.maxCoeff(), 1e-300);
    worst.pull = std::max(worst.pull, -s.normal_impulse.minCoeff() / top);
    worst.cone =
        std::max(worst.cone,
                 (s.tangent_impulse.cwiseAbs() - p.friction.cwiseProduct(s.normal_impulse)).maxCoeff() / top);

    // the change of momentum is made of these impulses and of nothing else
    const FreedomVector made =
        p.normal_rows.transpose() * s.normal_impulse + p.tangent_rows.transpose() * s.tangent_impulse;
    const FreedomVector momentum = b.scene.tool.mass * jump;
    const double momentum_size = (b.scene.tool.mass * p.velocity).norm() + momentum.norm();
    worst.momentum = std::max(worst.momentum, (made - s.momentum_change).norm() / momentum_size);
    worst.momentum = std::max(worst.momentum, (made - momentum).norm() / momentum_size);

    // no contact that can be moved closes
    if (s.squeezed > 0)
        return;
    for (int i = 0; i < p.contacts(); ++i) {
        const double yield = p.normal_rows.row(i).dot(p.inverse_mass * p.normal_rows.row(i).transpose());
        const double across = p.tangent_rows.row(i).dot(p.inverse_mass * p.tangent_rows.row(i).transpose());
        if (yield < (walls == WallMotion::rest ? 1e-13 : 1e-5) * across + 1e-13)
            continue;
        const double v = p.normal_rows.row(i).dot(s.velocity) - p.wall_normal_velocity[i];
        const double scale = std::sqrt(2.0 * size * yield) + std::fabs(p.wall_normal_velocity[i]);
        worst.closing = std::max(worst.closing, -v / scale);
    }
}

void report(const char* name, const Worst& w) {
    MESSAGE(name << ": " << w.states << " states, " << w.moved << " with impulses, fell back " << w.fell_back
                 << ", squeezed " << w.squeezed << ", restitution scaled " << w.scaled << " (least "
                 << w.smallest_scale << "), most iterations " << w.most_iterations << "; worst energy growth "
                 << w.energy_growth << " (by the mass matrix " << w.energy_by_mass
                 << "), reported energy off by " << w.energy_report << ", pull " << w.pull << ", cone "
                 << w.cone << ", closing " << w.closing << ", momentum " << w.momentum);
}

Worst run(std::uint64_t seed, int states, const CollisionMix& mix) {
    Dice dice(seed);
    const auto b = std::make_unique<Bench>();
    Worst worst;
    for (int k = 0; k < states; ++k) {
        random_scene(dice, mix, b->scene);
        resolve_collisions(CollisionMethod::poisson, b->scene.problem, b->workspace, b->solution);
        look(*b, mix.walls, worst);
    }
    return worst;
}

void check(const Worst& w, double closing = 1e-8) {
    CHECK(w.energy_growth <= 1e-12);
    CHECK(w.energy_by_mass <= 1e-11);
    CHECK(w.energy_report <= 1e-11);
    CHECK(w.pull == 0.0);
    CHECK(w.cone <= 1e-15);
    CHECK(w.closing <= closing);
    CHECK(w.momentum <= 1e-10);
}

} // namespace

TEST_CASE(
    "collisions with friction, any mix of contacts: no energy, no pull, inside the cone, nothing closes") {
    const Worst w = run(1, 60000, {});
    report("friction", w);
    check(w);
    CHECK(w.squeezed == 0);
}

TEST_CASE("collisions without friction, any mix of contacts: no energy, no pull, nothing closes") {
    CollisionMix mix;
    mix.friction = false;
    const Worst w = run(2, 60000, mix);
    report("frictionless", w);
    check(w);
    CHECK(w.squeezed == 0);
    CHECK(w.fell_back == 0);
}

TEST_CASE("collisions with walls that move as one: no energy in their frame") {
    CollisionMix mix;
    mix.walls = WallMotion::together;
    const Worst w = run(5, 30000, mix);
    report("walls together", w);
    check(w);
}

TEST_CASE("collisions with moving walls: no energy beyond the work of the walls, also when they squeeze") {
    CollisionMix mix;
    mix.walls = WallMotion::apart;
    const Worst w = run(3, 30000, mix);
    report("walls apart", w);
    check(w);
}

TEST_CASE("collisions of up to 64 contacts, most of them beyond the exact friction solver") {
    CollisionMix mix;
    mix.least_contacts = 9;
    mix.most_contacts = 64;
    const Worst w = run(4, 3000, mix);
    report("many", w);
    // tools held from all sides by more contacts than freedoms lose digits
    check(w, 1e-4);
}
