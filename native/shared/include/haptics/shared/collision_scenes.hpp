#pragma once
/// Random collision problems: rigid tools and serial chains of 2 to 12 rods, with contacts that approach,
/// rest, separate, oppose each other, rub, repeat each other, or cannot be moved. Mass matrices are built
/// densely here, apart from core/dynamics, so that the tests do not lean on what they share a library with.

#include <haptics/core/contact/collision.hpp>
#include <haptics/shared/dense_algebra.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace haptics::shared {

/// Small random generator (SplitMix64): the same numbers on every compiler and library.
class Dice {
  public:
    explicit Dice(std::uint64_t seed)
        : state_(seed) {}
    std::uint64_t bits() {
        state_ += 0x9e3779b97f4a7c15ULL;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
        return z ^ (z >> 31U);
    }
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(bits() >> 11U) * 0x1.0p-53;
    }
    /// low..high, both included.
    int integer(int low, int high) {
        return low + static_cast<int>(bits() % static_cast<std::uint64_t>(high - low + 1));
    }
    bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
    Vec2 direction() {
        const double angle = uniform(-std::numbers::pi, std::numbers::pi);
        return {std::cos(angle), std::sin(angle)};
    }

  private:
    std::uint64_t state_;
};

/// A tool at one moment: mass matrix, and where a point of a link moves.
struct CollisionTool {
    FreedomMatrix mass;
    /// Zero for a rigid tool, else rods.
    int links{0};
    double length{0.1};
    double half_width{0.04};
    double half_height{0.02};
    /// Absolute angles and near ends of the rods (joint coordinates are relative angles).
    double angle[16]{};
    Vec2 joint[17];
    Vec2 center{0.0, 0.0};

    [[nodiscard]] int freedoms() const { return links == 0 ? 3 : links; }

    /// Velocity of the point at `place` of a link for unit velocity of freedom `k`.
    [[nodiscard]] Vec2 point_column(int link, const Vec2& place, int k) const {
        if (links == 0)
            return k == 2 ? perpendicular(place) : Vec2(k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0);
        return k <= link ? perpendicular(place - joint[k]) : Vec2(0.0, 0.0);
    }
};

/// 0.05..1 kg box about its center.
inline CollisionTool random_rigid_tool(Dice& dice) {
    CollisionTool tool;
    const double mass = dice.uniform(0.05, 1.0);
    tool.half_width = dice.uniform(0.01, 0.08);
    tool.half_height = dice.uniform(0.01, 0.08);
    tool.mass.setZero(3, 3);
    tool.mass(0, 0) = mass;
    tool.mass(1, 1) = mass;
    tool.mass(2, 2) = mass * (tool.half_width * tool.half_width + tool.half_height * tool.half_height) / 3.0;
    return tool;
}

/// Rods of 0.1 m and 0.1 kg; stretched lays all of them along one line.
inline CollisionTool random_chain(Dice& dice, int links, bool stretched) {
    CollisionTool tool;
    tool.links = links;
    tool.joint[0] = {0.0, 0.0};
    for (int i = 0; i < links; ++i) {
        const double bend = stretched && i > 0 ? 0.0 : dice.uniform(-2.0, 2.0);
        tool.angle[i] = (i > 0 ? tool.angle[i - 1] : 0.0) + bend;
        tool.joint[i + 1] =
            tool.joint[i] + tool.length * Vec2(std::cos(tool.angle[i]), std::sin(tool.angle[i]));
    }
    const double mass = 0.1;
    const double inertia = mass * tool.length * tool.length / 12.0;
    tool.mass.setZero(links, links);
    for (int link = 0; link < links; ++link) {
        const Vec2 middle = 0.5 * (tool.joint[link] + tool.joint[link + 1]);
        for (int a = 0; a <= link; ++a)
            for (int b = 0; b <= link; ++b)
                tool.mass(a, b) +=
                    mass * tool.point_column(link, middle, a).dot(tool.point_column(link, middle, b)) +
                    inertia;
    }
    return tool;
}

/// Walls at rest, all moving as one frame that the tool could follow, or each on its own (they may squeeze).
enum class WallMotion : std::uint8_t { rest, together, apart };

/// What may occur in a random problem.
struct CollisionMix {
    int least_contacts{1};
    int most_contacts{8};
    bool friction{true};
    WallMotion walls{WallMotion::rest};
    /// Duplicate rows, opposed rows, zero rows, stretched chains.
    bool singular{true};
    /// All contacts of a problem have this restitution when >= 0.
    double restitution{-1.0};
    /// Links of the chains, at least 2; most_links 0 gives rigid tools only.
    int most_links{12};
    int fewest_links{2};
    /// Chains only.
    bool no_rigid{false};
};

struct CollisionScene {
    CollisionTool tool;
    CollisionProblem problem;
    /// Motion of the tool that keeps up with walls that move together.
    FreedomVector frame;
};

/// Sets contact i to a point of the tool with a normal; the tangent is perpendicular(normal).
inline void place_contact(CollisionScene& scene, int i, int link, const Vec2& place, const Vec2& normal) {
    for (int k = 0; k < scene.problem.freedoms(); ++k) {
        const Vec2 column = scene.tool.point_column(link, place, k);
        scene.problem.normal_rows(i, k) = normal.dot(column);
        scene.problem.tangent_rows(i, k) = perpendicular(normal).dot(column);
    }
}

/// A random problem.
inline void random_scene(Dice& dice, const CollisionMix& mix, CollisionScene& scene) {
    const bool rigid = mix.most_links < 2 || (!mix.no_rigid && dice.chance(0.4));
    scene.tool = rigid ? random_rigid_tool(dice)
                       : random_chain(dice, dice.integer(mix.fewest_links, mix.most_links),
                                      mix.singular && dice.chance(0.1));
    CollisionProblem& problem = scene.problem;
    const int n = scene.tool.freedoms();
    const int m = dice.integer(mix.least_contacts, mix.most_contacts);
    problem.resize(n, m);
    const Eigen::MatrixXd mobility = inverse(scene.tool.mass);
    problem.inverse_mass = 0.5 * (mobility + mobility.transpose());
    const double size = rigid ? 0.5 : 3.0;
    for (int k = 0; k < n; ++k)
        problem.velocity[k] = dice.uniform(-size, size);
    for (int i = 0; i < m; ++i) {
        const double kind = dice.uniform(0.0, 1.0);
        problem.restitution[i] = mix.restitution >= 0.0 ? mix.restitution
                                 : dice.chance(0.3)     ? 0.0
                                 : dice.chance(0.15)    ? 1.0
                                                        : dice.uniform(0.0, 1.0);
        problem.friction[i] = mix.friction && dice.chance(0.7) ? dice.uniform(0.0, 1.5) : 0.0;
        if (mix.walls == WallMotion::apart) {
            problem.wall_normal_velocity[i] = dice.uniform(-0.3, 0.3);
            problem.wall_tangent_velocity[i] = dice.uniform(-0.3, 0.3);
        }
        // singular companions of an earlier contact
        if (mix.singular && i > 0 && kind < 0.2) {
            const int other = dice.integer(0, i - 1);
            const double sign = kind < 0.1 ? 1.0 : -1.0;
            problem.normal_rows.row(i) = sign * problem.normal_rows.row(other);
            problem.tangent_rows.row(i) = sign * problem.tangent_rows.row(other);
            continue;
        }
        if (mix.singular && kind > 0.97) {
            problem.normal_rows.row(i).setZero();
            problem.tangent_rows.row(i).setZero();
            continue;
        }
        int link = 0;
        Vec2 place;
        Vec2 normal = dice.direction();
        if (rigid) {
            const double x = scene.tool.half_width;
            const double y = scene.tool.half_height;
            place = {dice.uniform(-x, x), dice.uniform(-y, y)};
            if (dice.chance(0.5)) // a corner against an upright wall
                place = {dice.chance(0.5) ? x : -x, dice.chance(0.5) ? y : -y};
            if (dice.chance(0.5))
                normal = dice.chance(0.5) ? Vec2(dice.chance(0.5) ? 1.0 : -1.0, 0.0)
                                          : Vec2(0.0, dice.chance(0.5) ? 1.0 : -1.0);
        } else {
            link = dice.integer(0, n - 1);
            place = scene.tool.joint[link] +
                    dice.uniform(0.0, 1.0) * (scene.tool.joint[link + 1] - scene.tool.joint[link]);
            if (dice.chance(0.3)) // along a rod: cannot be moved when stretched
                normal = {std::cos(scene.tool.angle[link]), std::sin(scene.tool.angle[link])};
        }
        place_contact(scene, i, link, place, normal);
        // most approach, some separate, some rest
        const double opening =
            problem.normal_rows.row(i).dot(problem.velocity) - problem.wall_normal_velocity[i];
        if (kind > 0.5 && opening > 0.0) {
            problem.normal_rows.row(i) *= -1.0;
            problem.tangent_rows.row(i) *= -1.0;
            problem.wall_normal_velocity[i] *= -1.0;
            problem.wall_tangent_velocity[i] *= -1.0;
        }
        if (kind > 0.4 && kind < 0.5) {
            // rest: take this contact's opening out of the motion
            const FreedomVector response = problem.inverse_mass * problem.normal_rows.row(i).transpose();
            const double yield = problem.normal_rows.row(i).dot(response);
            if (yield > 1e-8)
                problem.velocity -= opening / yield * response;
        }
    }
    // the same collision, seen from a frame that moves
    scene.frame.setZero(n);
    if (mix.walls == WallMotion::together) {
        for (int k = 0; k < n; ++k)
            scene.frame[k] = dice.uniform(-size, size);
        problem.velocity += scene.frame;
        problem.wall_normal_velocity = problem.normal_rows * scene.frame;
        problem.wall_tangent_velocity = problem.tangent_rows * scene.frame;
    }
}

} // namespace haptics::shared
