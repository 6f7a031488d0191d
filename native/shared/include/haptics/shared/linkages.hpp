#pragma once
/// Linkages used by tests and benchmarks: door, drawer, 3-link arm, chains, rigid tool, random trees.

#include <haptics/core/dynamics/linkage_spec.hpp>

#include <numbers>
#include <random>

namespace haptics::shared {

/// A uniform rod of `length` (m) and `mass` (kg) along its frame's x axis, jointed at its near end.
inline LinkSpec rod(int parent, double length, double mass) {
    LinkSpec link;
    link.parent = parent;
    link.mass = mass;
    link.inertia = mass * length * length / 12.0;
    link.center = {0.5 * length, 0.0};
    return link;
}

/// A door: one revolute joint, 0.2 m and 0.3 kg.
inline LinkageSpec door() {
    LinkageSpec spec;
    spec.links.push_back(rod(-1, 0.2, 0.3));
    return spec;
}

/// A drawer: one prismatic joint along the scene's x axis, 0.3 kg.
inline LinkageSpec drawer() {
    LinkageSpec spec;
    LinkSpec link;
    link.mass = 0.3;
    link.inertia = 5e-4;
    link.joint.kind = JointKind::prismatic;
    spec.links.push_back(link);
    return spec;
}

/// A serial revolute chain of `count` rods of 0.1 m and 0.1 kg, grounded at the origin, or floating.
inline LinkageSpec chain(int count, BaseKind base = BaseKind::grounded) {
    LinkageSpec spec;
    spec.base = base;
    for (int i = 0; i < count; ++i) {
        LinkSpec link = rod(i - 1, 0.1, 0.1);
        if (i > 0) {
            link.joint.frame = {0.1, 0.0, 0.0};
        }
        spec.links.push_back(link);
    }
    return spec;
}

/// The paper's arm: 3 links, grounded.
inline LinkageSpec arm() {
    return chain(3);
}

/// A rigid tool: floating, one link, 0.3 kg, 8 cm x 4 cm.
inline LinkageSpec rigid_tool() {
    LinkageSpec spec;
    spec.base = BaseKind::floating;
    LinkSpec link;
    link.mass = 0.3;
    link.inertia = 0.3 * (0.08 * 0.08 + 0.04 * 0.04) / 12.0;
    spec.links.push_back(link);
    return spec;
}

/// Random numbers that are the same on every machine (the standard distributions are not).
class Random {
  public:
    explicit Random(std::uint64_t seed)
        : engine_(seed) {}
    /// Uniform in [low, high).
    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11U) * 0x1p-53);
    }
    /// Uniform in low..high.
    int integer(int low, int high) {
        return low + static_cast<int>(engine_() % static_cast<unsigned>(high - low + 1));
    }

  private:
    std::mt19937_64 engine_;
};

/// What random_linkage() draws from.
struct RandomLinkage {
    int links{3};
    BaseKind base{BaseKind::grounded};
    /// Serial instead of a tree.
    bool serial{false};
    /// Probability of prismatic and of fixed joints; the rest are revolute.
    double prismatic{0.2};
    double fixed{0.1};
};

/// A linkage with masses of 0.05-0.3 kg, sizes of 5-15 cm and any joint frames. Gravity on.
inline LinkageSpec random_linkage(Random& random, const RandomLinkage& kind) {
    LinkageSpec spec;
    spec.base = kind.base;
    spec.gravity = {random.uniform(-3.0, 3.0), random.uniform(-10.0, 3.0)};
    for (int i = 0; i < kind.links; ++i) {
        // one draw a statement: the order of arguments is the compiler's choice
        const int parent = i == 0 ? -1 : (kind.serial ? i - 1 : random.integer(0, i - 1));
        const double length = random.uniform(0.05, 0.15);
        const double mass = random.uniform(0.05, 0.3);
        LinkSpec link = rod(parent, length, mass);
        link.center = {random.uniform(0.0, 0.1), random.uniform(-0.03, 0.03)};
        if (i > 0) {
            link.joint.frame = {random.uniform(0.05, 0.15), random.uniform(-0.03, 0.03),
                                random.uniform(-std::numbers::pi, std::numbers::pi)};
            const double draw = random.uniform(0.0, 1.0);
            link.joint.kind = draw < kind.prismatic                ? JointKind::prismatic
                              : draw < kind.prismatic + kind.fixed ? JointKind::fixed
                                                                   : JointKind::revolute;
        }
        spec.links.push_back(link);
    }
    return spec;
}

} // namespace haptics::shared
