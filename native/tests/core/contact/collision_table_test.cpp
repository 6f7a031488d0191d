/// The same random states through all three methods: what fails, how often, how badly. The table of
/// docs/physics.md comes from here (support/doc_table.hpp).

#include <haptics/shared/collision_scenes.hpp>
#include <haptics/shared/dense_algebra.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/doc_table.hpp"

namespace {

using namespace haptics;
using namespace haptics::shared;

struct TableBench {
    CollisionScene scene;
    CollisionWorkspace workspace;
    CollisionSolution solution;
};

/// Failures of one method over one set of states; shares of the states in which some contact closes.
struct Failures {
    int states{0};
    int growing{0};
    double worst_growth{1.0};
    int pulling{0};
    int stopped{0};
    int closing{0};

    [[nodiscard]] double share(int count) const {
        return static_cast<double>(count) / static_cast<double>(states);
    }
};

double kinetic_of(const CollisionTool& tool, const FreedomVector& velocity) {
    return 0.5 * velocity.dot(tool.mass * velocity);
}

/// Momentum along the motions that no contact sees is kept by every impulse of contacts. True when less than
/// half is left.
bool kills_sliding(const TableBench& b) {
    const Eigen::MatrixXd rows = b.scene.problem.normal_rows;
    const Eigen::MatrixXd w = b.scene.problem.inverse_mass;
    const Eigen::MatrixXd g = rows * w * rows.transpose();
    // the D-orthogonal part outside the rows
    const auto outside = [&](const FreedomVector& velocity) {
        const Eigen::VectorXd inside = shared::least_squares(g, rows * velocity);
        return FreedomVector(velocity - w * rows.transpose() * inside);
    };
    const double before = kinetic_of(b.scene.tool, outside(b.scene.problem.velocity));
    const double after = kinetic_of(b.scene.tool, outside(b.solution.velocity));
    return before > 1e-3 * kinetic_of(b.scene.tool, b.scene.problem.velocity) && after < 0.25 * before;
}

Failures run(CollisionMethod method, const CollisionMix& mix, int states) {
    Dice dice(21);
    const auto b = std::make_unique<TableBench>();
    Failures f;
    while (f.states < states) {
        random_scene(dice, mix, b->scene);
        const CollisionProblem& p = b->scene.problem;
        if ((p.normal_rows * p.velocity).minCoeff() > -1e-6)
            continue;
        resolve_collisions(method, p, b->workspace, b->solution);
        const CollisionSolution& s = b->solution;
        ++f.states;
        const double ratio = kinetic_of(b->scene.tool, s.velocity) / kinetic_of(b->scene.tool, p.velocity);
        f.growing += ratio > 1.0 + 1e-9 ? 1 : 0;
        f.worst_growth = std::max(f.worst_growth, ratio);
        f.pulling += s.normal_impulse.minCoeff() < -1e-9 * s.normal_impulse.cwiseAbs().maxCoeff() ? 1 : 0;
        f.stopped += kills_sliding(*b) ? 1 : 0;
        f.closing += (p.normal_rows * s.velocity).minCoeff() < -1e-6 ? 1 : 0;
    }
    return f;
}

struct Set {
    const char* name;
    int states;
    CollisionMix mix;
};

std::vector<Set> sets() {
    CollisionMix one_contact;
    one_contact.most_contacts = 1;
    one_contact.friction = false;
    one_contact.singular = false;
    one_contact.restitution = 0.8;
    one_contact.fewest_links = 3;
    one_contact.most_links = 3;
    one_contact.no_rigid = true;
    CollisionMix equal;
    equal.least_contacts = 2;
    equal.most_contacts = 5;
    equal.friction = false;
    equal.singular = false;
    equal.restitution = 0.8;
    CollisionMix mixed = equal;
    mixed.restitution = -1.0;
    mixed.singular = true;
    return {{"3-link chain, 1 contact, e = 0.8", 20000, one_contact},
            {"tools and chains, 2-5 contacts, e = 0.8", 10000, equal},
            {"the same, restitutions differ, singular ones too", 10000, mixed}};
}

} // namespace

TEST_CASE("collision methods side by side: the paper's adds energy, pulls and stops sliding, the default "
          "does not") {
    std::string table =
        "| states | method | energy grows | worst ratio | pulls | stops free motion | leaves a contact "
        "closing |\n|---|---|---|---|---|---|---|\n";
    std::vector<Failures> paper;
    std::vector<Failures> weighted;
    for (const Set& set : sets()) {
        const std::pair<CollisionMethod, const char*> methods[] = {
            {CollisionMethod::poisson, "poisson"},
            {CollisionMethod::mass_weighted, "mass_weighted"},
            {CollisionMethod::paper, "paper"}};
        for (const auto& [method, name] : methods) {
            const Failures f = run(method, set.mix, set.states);
            char line[256];
            std::snprintf(line, sizeof line, "| %s | %s | %.2f %% | %.3g | %.2f %% | %.2f %% | %.2f %% |\n",
                          set.name, name, 100.0 * f.share(f.growing), f.worst_growth,
                          100.0 * f.share(f.pulling), 100.0 * f.share(f.stopped), 100.0 * f.share(f.closing));
            table += line;
            if (method == CollisionMethod::paper)
                paper.push_back(f);
            else if (method == CollisionMethod::mass_weighted)
                weighted.push_back(f);
            else {
                CHECK(f.growing == 0);
                CHECK(f.pulling == 0);
                CHECK(f.stopped == 0);
                CHECK(f.closing == 0);
            }
        }
    }
    MESSAGE("\n" << table);
    write_doc_table("collision_methods", [&](std::ostream& out) { out << table; });

    // one contact: eq. (5) adds energy in about one state of seven; the equality is then the right answer
    CHECK(paper[0].share(paper[0].growing) > 0.08);
    CHECK(paper[0].share(paper[0].growing) < 0.25);
    CHECK(paper[0].share(paper[0].stopped) > 0.2);
    CHECK(weighted[0].growing == 0);
    CHECK(weighted[0].pulling == 0);
    // several: both pull, and the equality grows energy only where restitutions differ
    CHECK(paper[1].share(paper[1].pulling) > 0.1);
    CHECK(weighted[1].share(weighted[1].pulling) > 0.1);
    CHECK(weighted[1].growing == 0);
    CHECK(weighted[2].growing > 0);
}
